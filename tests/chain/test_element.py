"""One element: flexibility, stiffness, tension in parallel, rigid motion, its other end."""

import math

import numpy as np
import pytest
from conftest import EPS, reference

import ropedyn as rd

REFERENCE = reference("element_flexibility")
LENGTH, B, C = REFERENCE["length"], REFERENCE["B"], REFERENCE["C"]


def one_element(*, element="rigid", tension=0.0, ends=("clamped", "free"), length=LENGTH, **rope):
    scene = rd.Scene(rd.Rope(length, 1.0, **rope), tension=tension, ends=ends)
    return scene.compile(elements=1, element=element)


def literal(slope, **more):
    """The study's section: the normalised one with C and B divided by 1 + H^2 (design.md, 2)."""
    return one_element(
        bending_stiffness=B / (1 + slope**2),
        torsional_stiffness=C / (1 + slope**2),
        lay_slope=slope,
        **more,
    )


def laid(**more):
    """A rope with every stiffness and both couplings."""
    rope = {
        "bending_stiffness": 1.7,
        "torsional_stiffness": 0.6,
        "axial_stiffness": 90.0,
        "lay_coupling": -3.0,
        "lay_slope": 0.3,
    }
    return one_element(**(rope | more))


@pytest.mark.parametrize("element", ["difference", "rigid"])
@pytest.mark.parametrize("case", REFERENCE["cases"], ids=lambda case: f"H={case['H']}")
@pytest.mark.claim(
    "Flexibility of one element of the 2015 study, entry by entry",
    reference="closed form, stored with 50 digits: element_flexibility.json",
    accepted=1e-14,
)
def test_flexibility_agrees_with_the_closed_form(case, element, claim):
    G = literal(case["H"], element=element).triples.G[0]
    exact = np.array(case["G"])
    zero = exact == 0
    assert (G[zero] == 0).all()
    # each entry is a handful of products: a few eps, relative
    claim(np.abs(G[~zero] / exact[~zero] - 1).max())


@pytest.mark.parametrize("case", REFERENCE["cases"], ids=lambda case: f"H={case['H']}")
def test_stiffness_of_a_cantilever_agrees_with_the_closed_form(case):
    K = literal(case["H"]).stiffness_matrix().toarray()
    # relative to sqrt(K_ii K_jj): G scaled to a unit diagonal has a condition of about 14, so
    # its inverse keeps 14 times a few eps; K12 = 0 exactly
    size = np.sqrt(np.diag(K))
    np.testing.assert_allclose(K / np.outer(size, size), case["K"] / np.outer(size, size), 0, 1e-14)


def test_difference_element_is_the_inverse_flexibility_between_both_ends():
    # F = I: K_e = [[1, -1], [-1, 1]] x G^-1, so even its own end bears no lever
    model = literal(0.01, element="difference", ends=("free", "free"))
    K = model.stiffness_matrix().toarray()
    corner = REFERENCE["cases"][0]["K"]
    size = np.sqrt(np.diag(K))
    expected = np.kron([[1, -1], [-1, 1]], corner) / np.outer(size, size)
    np.testing.assert_allclose(K / np.outer(size, size), expected, rtol=0, atol=1e-14)


def test_flexibility_is_the_integral_of_the_section_flexibility():
    # axial: F_x; torque: M_alpha; moment: s F_z + M_beta. Two Gauss points integrate s^2 exactly
    slope, EA, D, C_, B_ = 0.3, 90.0, -3.0, 0.6, 1.7
    own = np.zeros((3, 3))
    own[:2, :2] = np.linalg.inv([[EA, D], [D, C_]])
    own[2, 2] = 1 / B_
    tilt = np.array([[math.hypot(1, slope), 0, 0], [0, 1, slope], [0, -slope, 1]])
    tilt /= math.hypot(1, slope)
    S = tilt.T @ own @ tilt
    expected = np.zeros((4, 4))
    for s in LENGTH / 2 * (1 + np.array([-1, 1]) / math.sqrt(3)):
        P = np.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, s, 0, 1]])
        expected += P.T @ S @ P * LENGTH / 2
    # sums of at most eight products: a few eps of the largest in each row and column
    np.testing.assert_allclose(laid().triples.G[0], expected, rtol=20 * EPS)


def test_left_hand_lay_reverses_the_coupling_of_twist_alone():
    right, left = literal(0.01).triples.G[0], literal(-0.01).triples.G[0]
    odd = np.array([[1, -1, 1], [-1, 1, -1], [1, -1, 1]])
    np.testing.assert_array_equal(left, odd * right)


@pytest.mark.parametrize("slope", [0.01, 0.3, 1.0])
def test_equal_stiffnesses_leave_nothing_to_couple(slope):
    rope = {"bending_stiffness": 2.0, "torsional_stiffness": 2.0}
    coupled = one_element(**rope, lay_slope=slope).triples.G[0]
    # cos^2 + sin^2 is 1 to rounding; the coupling B - C is exactly 0
    np.testing.assert_allclose(coupled, one_element(**rope).triples.G[0], rtol=4 * EPS, atol=0)


def test_infinite_lay_slope_swaps_bending_and_twist():
    # H to infinity turns the section axes by 90 degrees: B and C change places
    steep = one_element(bending_stiffness=2.0, torsional_stiffness=5.0, lay_slope=1e8)
    swapped = one_element(bending_stiffness=5.0, torsional_stiffness=2.0)
    G, expected = steep.triples.G[0], swapped.triples.G[0]
    # what is left of the tilt is of the order 1/H = 1e-8, even in the diagonal 1e-16
    np.testing.assert_allclose(np.diag(G), np.diag(expected), rtol=4 * EPS)
    np.testing.assert_allclose(G, expected, rtol=8 * EPS, atol=1e-8)


@pytest.mark.parametrize("tension", [-40.0, 0.0, 700.0, 1e6])
def test_assembled_element_is_the_beam_with_a_string_in_parallel(tension):
    length = 0.4
    t = tension / length
    model = one_element(
        length=length, bending_stiffness=3.0, tension=tension, ends=("free", "free")
    )
    hermite = np.array([[12, 6, -12, 6], [6, 4, -6, 2], [-12, -6, 12, -6], [6, 2, -6, 4]])
    size = np.array([1, length, 1, length])
    expected = 3.0 / length**3 * hermite * np.outer(size, size)
    expected[np.ix_([0, 2], [0, 2])] += t * np.array([[1, -1], [-1, 1]])
    # the inverse of the flexibility loses its condition of 14; and the string's rows cancel
    scale = np.sqrt(np.diag(np.abs(expected)))
    K = model.stiffness_matrix().toarray()
    np.testing.assert_allclose(
        K / np.outer(scale, scale), expected / np.outer(scale, scale), 0, 1e-14
    )


@pytest.mark.parametrize("tension", [-40.0, 0.0, 700.0, 1e6])
def test_triple_assembles_to_the_stiffness(tension):
    model = laid(tension=tension, ends=("free", "free"))
    F, G, Q = (matrix[0] for matrix in model.triples[:3])
    inverse = np.linalg.inv(G)
    expected = np.block([[Q + F.T @ inverse @ F, -F.T @ inverse], [-inverse @ F, inverse]])
    scale = np.sqrt(np.abs(np.diag(expected)))
    K = model.stiffness_matrix().toarray()
    # G scaled to a unit diagonal: its condition is the factor
    unit = np.sqrt(np.diag(G))
    condition = np.linalg.cond(G / np.outer(unit, unit))
    np.testing.assert_allclose(
        K / np.outer(scale, scale), expected / np.outer(scale, scale), 0, 10 * EPS * condition
    )


@pytest.mark.parametrize("tension", [-40.0, 700.0])
def test_tension_resists_one_bending_rotation_alone(tension):
    # Q' = T l/(1 + G_zz T/l) at (beta, beta), G_zz = l^3/3B: design.md, section 2
    length, B_ = 0.4, 3.0
    Q = one_element(length=length, bending_stiffness=B_, tension=tension).triples.Q[0]
    expected = tension * length / (1 + length**2 / (3 * B_) * tension)
    np.testing.assert_allclose(Q, [[0, 0], [0, expected]], rtol=8 * EPS, atol=0)


def test_string_element_is_its_tension():
    F, G, Q, _ = one_element(length=0.4, tension=80.0).triples
    assert (F[0, 0, 0], G[0, 0, 0], Q[0, 0, 0]) == (1.0, 0.4 / 80.0, 0.0)


def test_untensed_rigid_element_carries_its_tip_like_a_rigid_body():
    F, _, Q, _ = laid().triples
    expected = np.eye(4)
    expected[1, 3] = LENGTH
    np.testing.assert_array_equal(F[0], expected)
    np.testing.assert_array_equal(Q[0], np.zeros((4, 4)))


def rigid_motion(kind):
    """Both nodes of a unit motion over (x, z, alpha, beta)."""
    left, right = np.zeros(4), np.zeros(4)
    at = {"x": 0, "z": 1, "alpha": 2, "rotation": 3, "beta": 3}[kind]
    left[at] = right[at] = 1
    if kind == "rotation":
        right[1] = LENGTH
    return np.concatenate([left, right])


# (element, motion): the study's kinematics has beta alone as a motion without strain
@pytest.mark.parametrize(
    ("element", "kind"),
    [("rigid", k) for k in ("x", "z", "alpha", "rotation")]
    + [("difference", k) for k in ("x", "z", "alpha", "beta")],
)
def test_rigid_motion_costs_no_force(element, kind):
    K = laid(element=element, ends=("free", "free")).stiffness_matrix().toarray()
    u = rigid_motion(kind)
    # sums that cancel: a few eps of their terms
    assert (np.abs(K @ u) <= 20 * EPS * (np.abs(K) @ np.abs(u))).all()


def test_difference_kinematics_resists_a_rigid_rotation():
    # why refining the 2015 study's chain leads away (design.md, section 8)
    K = laid(element="difference", ends=("free", "free")).stiffness_matrix().toarray()
    u = rigid_motion("rotation")
    assert u @ K @ u == pytest.approx(K[1, 1] * LENGTH**2, rel=1e-14)


@pytest.mark.parametrize("tension", [-20.0, 0.0, 700.0])
def test_rigid_element_turned_half_about_z_is_itself(tension):
    # half a turn about z swaps the ends and the signs of x, alpha and beta
    K = laid(tension=tension, ends=("free", "free")).stiffness_matrix().toarray()
    turn = np.kron([[0, 1], [1, 0]], np.diag([-1, 1, -1, -1]))
    size = np.sqrt(np.abs(np.diag(K)))
    # the inverse of the scaled flexibility errs by its condition, some 20, times a few eps
    np.testing.assert_allclose(
        turn @ K @ turn / np.outer(size, size), K / np.outer(size, size), 0, 1e-13
    )


def test_difference_element_swapped_is_itself():
    K = laid(element="difference", ends=("free", "free")).stiffness_matrix().toarray()
    swap = np.kron([[0, 1], [1, 0]], np.eye(4))
    np.testing.assert_array_equal(swap @ K @ swap, K)


def test_critical_load_of_one_element_has_no_triple():
    # 1 + G_zz T/l = 0 at T = -3 B/l^2; the assembled stiffness knows nothing of it
    model = one_element(length=1.0, bending_stiffness=1.0, tension=-3.0)
    with pytest.raises(rd.SolveError, match="critical"):
        _ = model.triples
    assert model.stiffness_matrix()[0, 0] == pytest.approx(12.0 - 3.0, rel=1e-14)
