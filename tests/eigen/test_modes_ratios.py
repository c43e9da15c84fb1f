"""Modes where stiffnesses, inertias and lengths differ by up to 10^12: right and certified."""

import math

import numpy as np
import pytest
from conftest import BENDING, LAID, LENGTH, MASS, beam
from exact_counts import ExactChain, certified_modes

import ropedyn as rd

ELEMENTS = pytest.mark.parametrize("element", ["rigid", "tensed"])
RATIOS = pytest.mark.parametrize("ratio", [1e-12, 1e-6, 1e6, 1e12])
DENSITY = MASS / LENGTH
ROPE = rd.Rope(LENGTH, DENSITY, bending_stiffness=1.54)
N = 16


def modes_of(scene, element, relative=2e-12, n=N):
    return certified_modes(scene.compile(elements=n, element=element), 8, relative)


# tension ----------------------------------------------------------------------------------------


@ELEMENTS
@pytest.mark.parametrize("ends", ["clamped", "pinned", "free"])
@pytest.mark.parametrize("xi", [1e-4, 1.0, 1e2, 1e4])
def test_any_tension_over_bending(xi, ends, element):
    # xi = L sqrt(T/B)
    scene = rd.Scene(ROPE, tension=xi**2 * 1.54 / LENGTH**2, ends=(ends, ends))
    modes = modes_of(scene, element, n=24)
    if xi == 1e4:
        # a string between held or free ends: k/2L sqrt(T/mu), lumped: (k pi/2n)^2/6 lower
        first = math.sqrt(scene.tension / DENSITY) / (2 * LENGTH)
        elastic = modes.frequency[modes.frequency > 0]
        assert elastic[0] == pytest.approx(first, rel=1e-2)


# inertia ----------------------------------------------------------------------------------------


@ELEMENTS
@RATIOS
def test_any_rotary_inertia(ratio, element):
    scene = rd.Scene(ROPE.replace(rotary_inertia=DENSITY * ratio), tension=100.0)
    modes_of(scene, element)


@ELEMENTS
@RATIOS
@pytest.mark.parametrize("turning", [0.0, 1.0])
@pytest.mark.parametrize("place", [0.25, 1.0])
@pytest.mark.parametrize("ends", ["clamped", "free"])
def test_any_mass_at_a_node(ends, place, turning, ratio, element):
    mass = rd.PointMass(place * LENGTH, MASS * ratio, rotary_inertia=turning * MASS * ratio)
    scene = rd.Scene(ROPE, tension=100.0, ends=("clamped", ends), parts=[mass])
    modes_of(scene, element)


@ELEMENTS
def test_masses_from_one_gram_to_a_million_tons_beside_each_other(element):
    parts = [rd.PointMass(LENGTH * k / 8, mass) for k, mass in enumerate((1e-3, 1e9, 1e-3, 1e9), 2)]
    modes_of(rd.Scene(ROPE, tension=100.0, parts=parts), element)


# stiffness --------------------------------------------------------------------------------------


@ELEMENTS
@RATIOS
@pytest.mark.parametrize("tension", [0.0, 100.0])
@pytest.mark.parametrize("ends", ["pinned", "free"])
@pytest.mark.parametrize("coordinate", ["z", "beta"])
def test_any_spring(coordinate, ends, tension, ratio, element):
    spring = rd.Spring(LENGTH / 4, 100.0 * ratio, coordinate=coordinate)
    scene = rd.Scene(ROPE, tension=tension, ends=(ends, "free"), parts=[spring])
    modes_of(scene, element)


@ELEMENTS
@RATIOS
def test_spring_at_a_free_end(ratio, element):
    end = rd.End(z="free", beta="free", spring={"z": 100.0 * ratio, "beta": ratio})
    modes_of(rd.Scene(ROPE, tension=100.0, ends=(end, "free")), element)


@ELEMENTS
@pytest.mark.parametrize("stiffness", [-10.0, -300.0, -1e4, -1e6])
def test_negative_spring_drives_one_mode_away(stiffness, element):
    scene = rd.Scene(ROPE, tension=100.0, parts=[rd.Spring(LENGTH / 4, stiffness)])
    model = scene.compile(elements=N, element=element)
    modes = certified_modes(model, 4)
    # tension and bending hold a point at L/4 with some 1e3 N/m
    growing = ExactChain(model.chain).count(-1e-30)
    assert growing == (stiffness < -3e3)
    assert (modes.growth > 0).tolist() == [k < growing for k in range(4)]


@ELEMENTS
@RATIOS
def test_any_torsional_stiffness_with_lay(ratio, element):
    rope = ROPE.replace(torsional_stiffness=0.15 * ratio, polar_inertia=1e-6, lay_slope=0.3)
    # a section without torsional stiffness twists instead of bending: six frequencies within 1e-4
    # of each other, whose gaps counts tell apart to 1e-9
    scene = rd.Scene(rope, tension=100.0)
    relative = 1e-9 if ratio < 1e-9 else 2e-12
    if element == "tensed":
        # the inverse of such a section loses half of the digits of its determinant, times 55
        loss = scene.compile(elements=N, element=element).chain.section_loss
        relative += 128 * np.finfo(float).eps * math.sqrt(loss)
    modes_of(scene, element, relative)


@ELEMENTS
@RATIOS
def test_any_axial_stiffness_with_lay(ratio, element):
    EA, C = 100.0 * ratio, 0.1
    rope = ROPE.replace(
        axial_stiffness=EA,
        torsional_stiffness=C,
        polar_inertia=1e-6,
        lay_slope=0.3,
        lay_coupling=0.3 * math.sqrt(EA * C),
    )
    modes_of(rd.Scene(rope, tension=100.0), element)


@ELEMENTS
def test_unequal_spans(element):
    # a span of 1e-6 of the rope beside the rest
    parts = [rd.PointMass(LENGTH * 1e-6, 1e-3)]
    modes_of(rd.Scene(ROPE, tension=100.0, ends=("pinned", "free"), parts=parts), element, 6)


@ELEMENTS
def test_every_element_different(element):
    # lengths from half to one and a half of the mean, a mass at every node
    n = 120
    random = np.random.default_rng(1)
    x = LENGTH * (np.arange(1, n) + random.uniform(-0.25, 0.25, n - 1)) / n
    mass = MASS / n * random.uniform(0, 1, n - 1)
    parts = [rd.PointMass(*pair) for pair in zip(x.tolist(), mass.tolist())]
    scene = rd.Scene(ROPE, tension=2830.0, parts=parts)
    model = scene.compile(elements=n, element=element)
    assert len(model.chain.length) > n - 10
    certified_modes(model, 10)


@ELEMENTS
@pytest.mark.parametrize("stiffness", [0.0, 1e-6, 1.0, 1e6])
@pytest.mark.parametrize("ends", ["clamped", "pinned", "free"])
def test_hinged_rope(ends, stiffness, element):
    hinges = [rd.Hinge(LENGTH / 4, stiffness=stiffness), rd.Hinge(LENGTH / 2)]
    scene = rd.Scene(ROPE, tension=100.0, ends=(ends, ends), parts=hinges)
    modes_of(scene, element)


def test_free_hinge_in_a_free_rope_is_one_more_rigid_motion():
    scene = rd.Scene(ROPE, ends=("free", "free"), parts=[rd.Hinge(LENGTH / 2)])
    modes = scene.compile(elements=N).modes(4, solver="sweep")
    assert modes.certified
    assert (modes.frequency == 0).tolist() == [True, True, True, False]


# coordinates without inertia --------------------------------------------------------------------


@ELEMENTS
@pytest.mark.parametrize(
    ("ends", "finite"), [("clamped", N - 1), ("pinned", N - 1), ("free", N + 1)]
)
def test_modes_of_massless_rotations_do_not_exist(ends, finite, element):
    model = beam(N, tension=300.0, ends=(ends, ends), rotary=False).compile(
        elements=N, element=element
    )
    certified_modes(model, finite, relative=1e-11)
    with pytest.raises(rd.SolveError, match=rf"at most {finite}\b.*got {finite + 1}"):
        model.modes(finite + 1, solver="sweep")


def test_shaft_with_one_disc_has_one_mode():
    C, J = 2.0, 1e-3
    rope = rd.Rope(1.0, 0.1, torsional_stiffness=C)
    scene = rd.Scene(rope, parts=[rd.PointMass(0.25, 0, polar_inertia=J)])
    model = scene.compile(elements=4)
    modes = certified_modes(model, 1)
    # J u" = -(C/a + C/(L - a)) u
    exact = math.sqrt((C / 0.25 + C / 0.75) / J) / (2 * math.pi)
    assert modes.frequency[0] == pytest.approx(exact, rel=1e-14)
    with pytest.raises(rd.SolveError, match=r"at most 1\b.*got 2"):
        model.modes(2, solver="sweep")


def test_rope_without_any_inertia_in_twist_has_no_mode():
    model = rd.Scene(rd.Rope(1.0, 0.1, torsional_stiffness=2.0)).compile(elements=4)
    with pytest.raises(rd.SolveError, match=r"at most 0\b.*got 1"):
        model.modes(1, solver="sweep")
    assert len(model.modes(below=1e6, solver="sweep").frequency) == 0


# rigid motion -----------------------------------------------------------------------------------


@ELEMENTS
@pytest.mark.parametrize("n", [1, 2, 16, 1000, 1_000_000])
@pytest.mark.parametrize(
    ("ends", "tension", "rigid"),
    [
        (("free", "free"), 0.0, 2),
        (("free", "free"), 100.0, 1),
        (("free", "free"), 1e6, 1),
        (("free", "pinned"), 0.0, 1),
        (("free", "pinned"), 100.0, 0),
        (("clamped", "free"), 0.0, 0),
    ],
)
def test_rigid_motion_has_frequency_zero(ends, tension, rigid, n, element):
    scene = rd.Scene(ROPE.replace(rotary_inertia=0.1), tension=tension, ends=ends)
    modes = scene.compile(elements=n, element=element).modes(2, solver="sweep")
    assert modes.certified
    assert (modes.frequency == 0).tolist() == [k < rigid for k in range(2)]
    assert (modes.eigenvalue[:rigid] == 0).all()
    assert (modes.growth == 0).all()


@ELEMENTS
@pytest.mark.parametrize(("tension", "rigid"), [(0.0, 4), (60.0, 3)])
def test_free_laid_rope_has_its_rigid_motions(tension, rigid, element):
    scene = rd.Scene(LAID.replace(rotary_inertia=None), tension=tension, ends=("free", "free"))
    modes = scene.compile(elements=N, element=element).modes(rigid + 1, solver="sweep")
    assert modes.certified
    assert (modes.frequency == 0).tolist() == [*[True] * rigid, False]


@ELEMENTS
@pytest.mark.parametrize("n", [2, 8, 1000])
def test_shapes_of_rigid_motion_are_straight_and_orthogonal(n, element):
    scene = rd.Scene(ROPE, ends=("free", "free"))
    model = scene.compile(elements=n, element=element)
    modes = model.modes(2, solver="sweep")
    z, beta = modes.shape[:, :, 0], modes.shape[:, :, 1]
    slope = (z[:, -1] - z[:, 0]) / LENGTH
    np.testing.assert_allclose(z, z[:, :1] + slope[:, None] * model.x, atol=1e-13)
    np.testing.assert_allclose(beta, np.repeat(slope[:, None], n + 1, axis=1), atol=1e-13)
    mass = model.mass_matrix()
    u = modes.shape.reshape(2, -1)
    assert abs(u[0] @ (mass @ u[1])) < 1e-13 * math.sqrt(modes.modal_mass.prod())


# size -------------------------------------------------------------------------------------------


@ELEMENTS
@pytest.mark.parametrize("n", [1000, 1_000_000])
def test_long_chains_with_parts_agree_with_short_ones(n, element):
    # a uniform million between two masses: the mesh error of 1000 is 2e-6 (rigid, second order)
    parts = [rd.PointMass(LENGTH / 4, 0.05), rd.PointMass(LENGTH / 2, 0.2)]
    scene = rd.Scene(ROPE, tension=2830.0, parts=parts)
    fine = scene.compile(elements=4_000_000, element="tensed").modes(10, solver="sweep")
    modes = scene.compile(elements=n, element=element).modes(10, solver="sweep")
    assert modes.certified
    relative = np.abs(modes.frequency / fine.frequency - 1)
    # leading errors (k pi/n)^2 of rigid and (kappa L/n)^4/720 of tensed elements; n eps of rounding
    allowed = (10 * math.pi / n) ** 2 if element == "rigid" else (10 * math.pi / n) ** 4
    assert (relative < allowed + 2e-12).all()


def test_bending_of_a_million_elements_is_the_beams():
    # B of a steel rod, no tension: 4.73004074486^2/(2 pi L^2) sqrt(B/mu), lumps of fourth order
    scene = beam(1_000_000, rotary=False)
    modes = scene.compile(elements=1_000_000, element="tensed").modes(1, solver="sweep")
    root = 4.730040744862704
    exact = root**2 / (2 * math.pi * LENGTH**2) * math.sqrt(BENDING / DENSITY)
    assert modes.certified
    assert modes.frequency[0] == pytest.approx(exact, rel=1e-12)
