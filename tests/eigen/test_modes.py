"""Modes: energies, families, damping, buckling, rigid motion, massless coordinates, extremes."""

import math

import numpy as np
import pytest
from conftest import BENDING, EPS, LAID, LENGTH, MASS, beam, dense, pinned_rigid_chain

import ropedyn as rd

N = 8
SPACING = LENGTH / N
EULER = (math.pi / LENGTH) ** 2 * BENDING
"""Critical load of the pinned beam [N]; of the clamped one four times that."""


# energies ------------------------------------------------------------------------------------


def test_strain_and_kinetic_fractions_are_whole():
    scene = rd.Scene(LAID, tension=60.0, parts=[rd.Spring(0.4, 200.0)])
    modes = scene.compile(elements=10, element="rigid").modes(12)
    assert set(modes.energy) == {
        *("bending", "twist", "stretch", "lay", "tension", "spring"),
        *("x", "z", "alpha", "beta"),
    }
    strain = sum(modes.energy[k] for k in modes.energy if k not in modes.coordinates)
    kinetic = sum(modes.energy[k] for k in modes.coordinates)
    np.testing.assert_allclose(strain, 1, rtol=10 * EPS)
    np.testing.assert_allclose(kinetic, 1, rtol=10 * EPS)
    # a diagonal mass has no negative share
    assert all((modes.energy[k] >= 0).all() for k in modes.coordinates)


@pytest.mark.parametrize("without", ["tension", "spring"])
def test_share_of_an_effect_is_what_its_stiffness_stores(without):
    scene = rd.Scene(LAID, tension=60.0, parts=[rd.Spring(0.4, 200.0)])
    model = scene.compile(elements=10, element="rigid")
    # the station of the spring stays, so that the nodes are the same
    bare = scene.replace(parts=[rd.PointMass(0.4, 0), *scene.parts]).without(without)
    K, share = (
        m.compile(elements=10, element="rigid").stiffness_matrix().toarray() for m in (scene, bare)
    )
    modes = model.modes(8)
    u = modes.shape[:, 1:-1].reshape(8, -1)
    total = np.einsum("ki,ij,kj->k", u, K, u)
    rest = np.einsum("ki,ij,kj->k", u, share, u)
    # differences of K u cancel by 50 n^4/pi^4 = 5e3
    np.testing.assert_allclose(modes.energy[without], (total - rest) / total, rtol=0, atol=1e-11)


def test_string_stores_tension_alone_and_moves_in_z_alone():
    modes = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0).compile(elements=6, element="rigid").modes(3)
    assert set(modes.energy) == {"tension", "z"}
    assert (modes.energy["tension"] == 1).all()
    assert (modes.energy["z"] == 1).all()


def test_rotation_without_inertia_has_no_kinetic_energy():
    # the end correction of tensed chains couples z and beta: it is inertia of z
    scene = beam(8, tension=300.0, rotary=False, parts=[rd.PointMass(0.4, 0.01)])
    modes = scene.compile(elements=9, element="tensed").modes(5)
    assert (modes.energy["beta"] == 0).all()
    assert (modes.energy["z"] == 1).all()


@pytest.mark.parametrize("k", [1, 2, 3])
def test_pinned_tensed_chain_shares_energy_as_its_waves_do(k):
    # z rises by 2 sin(k pi/2n) cos(..) a node: tension stores 2 (1 - c) T/a, the total is lambda
    # times the inertia of z and beta
    n, T = 8, 900.0
    modes = (
        beam(n, tension=T, ends=("pinned", "pinned")).compile(elements=n, element="rigid").modes(k)
    )
    lam = pinned_rigid_chain(n, k, T)[0]
    mass, a = MASS / n, LENGTH / n
    versed, s = 2 * math.sin(k * math.pi / (2 * n)) ** 2, math.sin(k * math.pi / n)
    unit = BENDING / a**3
    turned = 12 * s / (12 - 4 * versed - lam * mass / unit / 12)
    kinetic = 1 + turned**2 / 12
    tension = 2 * versed * T / a / (lam * mass * kinetic)
    # the shape loses 50 n^4/pi^4 eps
    assert modes.energy["tension"][k - 1] == pytest.approx(tension, rel=1e-11)
    assert modes.energy["beta"][k - 1] == pytest.approx(turned**2 / 12 / kinetic, rel=1e-11)


def test_modal_mass_belongs_to_the_shape_given():
    model = rd.Scene(LAID, tension=60.0).compile(elements=10, element="rigid")
    modes = model.modes(9)
    _, M, _ = dense(model)
    u = modes.shape[:, 1:-1].reshape(9, -1)
    np.testing.assert_allclose(modes.modal_mass, np.einsum("ki,ij,kj->k", u, M, u), rtol=20 * EPS)


# families ------------------------------------------------------------------------------------


def test_uncoupled_waves_are_four_families_in_order_of_frequency():
    rope = LAID.replace(lay_coupling=None, lay_slope=None)
    model = rd.Scene(rope, tension=60.0).compile(elements=4, element="rigid")
    modes = model.modes(12)
    assert sorted(modes.family.tolist()) == sorted(
        3 * ["transverse", "bending rotation", "torsional", "axial"]
    )
    assert (np.diff(modes.frequency) >= 0).all()
    own = {"transverse": 1, "bending rotation": 3, "torsional": 2, "axial": 0}
    for k, family in enumerate(modes.family):
        assert np.abs(modes.shape[k, :, own[family]]).max() == 1.0
        assert modes.shape[k, :, own[family]].max() == 1.0
        most = max(modes.coordinates, key=lambda c: modes.energy[c][k])
        assert modes.coordinates.index(most) == own[family]


def test_equal_frequencies_of_two_components_stay_apart():
    # twist and stretch with one speed of waves: each pair is one twist and one stretch
    rope = rd.Rope(1.0, 0.25, axial_stiffness=1024.0, torsional_stiffness=0.5, polar_inertia=2**-13)
    modes = rd.Scene(rope).compile(elements=8, element="rigid").modes(6)
    # the condition of eight elements, (2 n/pi)^2 = 26, for each of the two
    np.testing.assert_allclose(modes.frequency[::2], modes.frequency[1::2], rtol=100 * EPS)
    for k in range(0, 6, 2):
        assert {*modes.family[k : k + 2].tolist()} == {"axial", "torsional"}
    assert set(np.unique([modes.energy["x"], modes.energy["alpha"]])) == {0.0, 1.0}


# damping -------------------------------------------------------------------------------------


def test_rayleigh_damping_ratio_is_exact():
    alpha, beta = 3.0, 2e-5
    scene = beam(N, tension=300.0, damping=rd.RayleighDamping(alpha, beta))
    modes = scene.compile(elements=N, element="rigid").modes(5)
    omega = 2 * math.pi * modes.frequency
    # the stiffness part is read from energies of the shape: 50 n^4/pi^4 eps
    np.testing.assert_allclose(modes.damping_ratio, (alpha / omega + beta * omega) / 2, rtol=1e-11)


def test_stiffness_damping_ratio_leaves_out_the_share_of_the_tension():
    gamma = 2e-5
    scene = beam(N, tension=3000.0, damping=rd.StiffnessDamping(gamma))
    modes = scene.compile(elements=N, element="rigid").modes(5)
    omega = 2 * math.pi * modes.frequency
    expected = gamma * omega / 2 * (1 - modes.energy["tension"])
    np.testing.assert_allclose(modes.damping_ratio, expected, rtol=1e-11)
    assert (modes.energy["tension"] > 0.05).all()


def test_damping_ratio_agrees_with_the_damping_matrix():
    scene = rd.Scene(
        LAID,
        tension=60.0,
        parts=[rd.Spring(0.5, 300.0)],
        damping=(rd.StiffnessDamping(1e-5), rd.RayleighDamping(2.0, 1e-6)),
    )
    model = scene.compile(elements=8, element="rigid")
    modes = model.modes(8)
    _, M, C = dense(model)
    u = modes.shape[:, 1:-1].reshape(8, -1)
    lost, mass = (np.einsum("ki,ij,kj->k", u, A, u) for A in (C, M))
    expected = lost / (2 * 2 * math.pi * modes.frequency * mass)
    np.testing.assert_allclose(modes.damping_ratio, expected, rtol=1e-11)


def test_nothing_damps_an_undamped_rope():
    assert (beam(N).compile(elements=N, element="rigid").modes(4).damping_ratio == 0).all()


# compression ---------------------------------------------------------------------------------


def critical(n):
    """Critical load of the clamped rigid chain: it buckles as 1 - cos(2 pi j/n) [N].

    The determinant of the static waves is 0: tau = -6 (1 - c)/(2 + c), c = cos(2 pi/n).
    """
    c = math.cos(2 * math.pi / n)
    return -6 * (1 - c) / (2 + c) * BENDING / (LENGTH / n) ** 2


@pytest.mark.parametrize(("n", "printed"), [(4, "1.216"), (8, "1.052"), (64, "1.0008")])
@pytest.mark.parametrize("beyond", [-1e-6, 1e-6])
def test_rigid_chain_buckles_at_its_own_critical_load(n, printed, beyond):
    # design.md, section 5, in parts of Euler's
    ratio = critical(n) / (-4 * EULER)
    assert f"{ratio:.{len(printed) - 2}f}" == printed
    modes = (
        beam(n, tension=(1 + beyond) * critical(n)).compile(elements=n, element="rigid").modes(2)
    )
    assert modes.eigenvalue[1] > 0
    # lambda falls nearly in a straight line from (45 Hz 2 pi)^2 = 8e4 at T = 0 to nothing
    assert modes.eigenvalue[0] == pytest.approx(-beyond * 8e4, rel=0.2)


@pytest.mark.parametrize("k", [0, 1, 2])
@pytest.mark.parametrize("load", [1.5, 5.0, 12.0])
def test_motion_beyond_the_critical_load_grows(load, k):
    tension = -load * EULER
    modes = (
        beam(N, tension=tension, ends=("pinned", "pinned"))
        .compile(elements=N, element="rigid")
        .modes(3)
    )
    exact = np.sort([pinned_rigid_chain(N, j, tension)[0] for j in range(1, 8)])[k]
    # K has |B/a^3 48| where waves need (pi/n)^4: relative to the first eigenvalue at rest
    scale = pinned_rigid_chain(N, 1)[0]
    assert modes.eigenvalue[k] == pytest.approx(exact, abs=1e-11 * scale, rel=1e-11)
    if exact < 0:
        assert modes.frequency[k] == 0
        assert modes.growth[k] == math.sqrt(-modes.eigenvalue[k])
        assert modes.damping_ratio[k] == 0
    else:
        assert modes.growth[k] == 0
        assert modes.frequency[k] == pytest.approx(math.sqrt(exact) / (2 * math.pi), rel=1e-11)


def test_growing_modes_are_below_any_frequency():
    # five half waves buckle below 12 x Euler's load... of the chain: three
    tension = -12.0 * EULER
    model = beam(N, tension=tension, ends=("pinned", "pinned")).compile(elements=N, element="rigid")
    exact = np.sort([pinned_rigid_chain(N, j, tension)[0] for j in range(1, 8)])
    modes = model.modes(below=1e-3)
    assert len(modes.eigenvalue) == (exact < 0).sum() == 3
    assert (modes.growth > 0).all()


@pytest.mark.parametrize("load", [0.5, 2.5])
def test_compressed_chain_swings_about_a_mass_of_any_shift(load):
    # indefinite K, with twist beside it that stays positive: the order is by eigenvalue
    rope = rd.Rope(
        LENGTH, 0.1, bending_stiffness=BENDING, torsional_stiffness=1.0, polar_inertia=1e-4
    )
    scene = rd.Scene(rope, tension=-load * EULER, ends=("pinned", "pinned"))
    modes = scene.compile(elements=N, element="rigid").modes(4)
    assert (np.diff(modes.eigenvalue) >= 0).all()
    assert (modes.eigenvalue[0] < 0) == (load > 1)
    assert "torsional" in modes.family


# rigid motion --------------------------------------------------------------------------------


@pytest.mark.parametrize("n", [1, 3, 8, 40])
@pytest.mark.parametrize("tension", [0.0, 50.0])
def test_free_rope_has_its_rigid_motions_at_exactly_zero(tension, n):
    # tension turns with nothing: it resists a rotation of the whole rope
    rope = LAID.replace(lay_coupling=None, lay_slope=None)
    scene = rd.Scene(rope, tension=tension, ends=("free", "free"))
    rigid = 4 if tension == 0 else 3
    modes = scene.compile(elements=n, element="rigid").modes(rigid + 1)
    assert (modes.eigenvalue[:rigid] == 0).all()
    assert (modes.frequency[:rigid] == 0).all()
    assert (modes.growth == 0).all()
    assert modes.eigenvalue[rigid] > 1.0
    assert (modes.rounding_error >= 0).all()
    strain = [modes.energy[e] for e in modes.energy if e not in modes.coordinates]
    assert (np.array(strain)[:, :rigid] == 0).all()


def test_rigid_motions_of_a_free_beam_are_lines():
    modes = beam(N, ends=("free", "free")).compile(elements=N, element="rigid").modes(2)
    z, beta = modes.shape[:, :, 0], modes.shape[:, :, 1]
    slope = (z[:, -1] - z[:, 0]) / LENGTH
    for k in range(2):
        # K + shift M with the shift near the first elastic eigenvalue: 5e3 eps
        np.testing.assert_allclose(z[k], z[k, 0] + slope[k] * modes.x, rtol=0, atol=1e-11)
        np.testing.assert_allclose(beta[k], slope[k], rtol=0, atol=1e-11)


def test_laid_free_rope_keeps_its_four_rigid_motions():
    modes = rd.Scene(LAID, ends=("free", "free")).compile(elements=6, element="rigid").modes(5)
    assert (modes.frequency[:4] == 0).all()
    assert modes.frequency[4] > 1.0


def test_hinged_rope_swings_about_its_pin_without_frequency():
    modes = beam(N, ends=("pinned", "free")).compile(elements=N, element="rigid").modes(2)
    assert modes.frequency[0] == 0
    z = modes.shape[0, :, 0]
    np.testing.assert_allclose(z, modes.x / LENGTH * z[-1], rtol=0, atol=1e-11)
    assert modes.frequency[1] > 10


# massless coordinates ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("scene", "finite"),
    [
        (beam(N), 14),
        (beam(N, rotary=False), 7),
        (beam(N, rotary=False, ends=("free", "free")), 9),
        (rd.Scene(rd.Rope(1.0, 0.1), tension=1.0), 7),
        # a shaft without inertia has none; one disc on it has one
        (rd.Scene(rd.Rope(1.0, 0.1, torsional_stiffness=2.0)), 0),
        (
            rd.Scene(
                rd.Rope(1.0, 0.1, torsional_stiffness=2.0),
                parts=[rd.PointMass(0.5, 0, polar_inertia=1e-3)],
            ),
            1,
        ),
        (beam(N, rotary=False, parts=[rd.PointMass(LENGTH / 2, 0, rotary_inertia=1e-5)]), 8),
        (rd.Scene(LAID.replace(rotary_inertia=None)), 21),
    ],
)
def test_asking_for_more_modes_than_there_are_says_how_many(scene, finite):
    model = scene.compile(elements=N, element="rigid")
    if finite:
        assert len(model.modes(finite).frequency) == finite
        assert np.isfinite(model.modes(finite).frequency).all()
    with pytest.raises(rd.SolveError, match=rf"at most {finite}\b.*got {finite + 1}"):
        model.modes(finite + 1)


def test_massless_rotation_follows_statically():
    # condensed by hand: K_zz - K_zb K_bb^-1 K_bz
    model = beam(N, tension=100.0, rotary=False).compile(elements=N, element="rigid")
    K, M, _ = dense(model)
    z, b = slice(0, None, 2), slice(1, None, 2)
    condensed = K[z, z] - K[z, b] @ np.linalg.solve(K[b, b], K[b, z])
    exact = np.linalg.eigvalsh(condensed) / M[0, 0]
    # both lose 50 n^4/pi^4 eps of the lowest
    np.testing.assert_allclose(model.modes(7).eigenvalue, exact, rtol=1e-10)


def test_disc_without_mass_turns_between_two_shafts():
    # J u" = -(C/a + C/(L - a)) u
    C, J, a = 2.0, 1e-3, 0.25
    scene = rd.Scene(
        rd.Rope(1.0, 0.1, torsional_stiffness=C),
        parts=[rd.PointMass(a, 0, polar_inertia=J)],
    )
    exact = math.sqrt((C / a + C / (1 - a)) / J) / (2 * math.pi)
    modes = scene.compile(elements=4, element="rigid").modes(1)
    # condition of four elements
    assert modes.frequency[0] == pytest.approx(exact, rel=40 * EPS)
    np.testing.assert_allclose(modes.shape[0, :, 0], [0, 1, 2 / 3, 1 / 3, 0], atol=40 * EPS)


def test_point_mass_of_nothing_changes_nothing():
    scene = beam(N, tension=300.0)
    still = scene.replace(parts=[rd.PointMass(LENGTH / 2, 0)])
    one, other = (s.compile(elements=N, element="rigid").modes(5) for s in (scene, still))
    # the spans' lengths differ by rounding at most
    np.testing.assert_allclose(one.frequency, other.frequency, rtol=1e-11)


def test_negative_spring_on_a_massless_rotation_is_refused():
    # nothing could make K + s M positive definite: the rotation would leave at once
    n = 4
    K = beam(n, rotary=False).compile(elements=n, element="rigid").stiffness_matrix().toarray()
    too_much = -2.0 * K[3, 3]
    scene = beam(n, rotary=False, parts=[rd.Spring(LENGTH / 2, too_much, coordinate="beta")])
    with pytest.raises(rd.SolveError, match="without mass"):
        scene.compile(elements=n, element="rigid").modes(1)


# below ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("number", [0, 1, 4, 9])
def test_modes_below_a_frequency_are_the_lowest_ones(number):
    model = rd.Scene(LAID, tension=60.0).compile(elements=8, element="rigid")
    all_modes = model.modes(12)
    f = np.concatenate([[0], all_modes.frequency])
    modes = model.modes(below=(f[number] + f[number + 1]) / 2)
    assert len(modes.frequency) == number
    # another path through LAPACK: its own digits, of the largest 1/lambda
    np.testing.assert_allclose(modes.frequency, all_modes.frequency[:number], rtol=1e-11)
    assert modes.shape.shape == (number, 9, 4)


def test_modes_below_everything_are_all_there_are():
    model = beam(N).compile(elements=N, element="rigid")
    assert len(model.modes(below=1e9).frequency) == 14


def test_rigid_motions_are_below_any_frequency():
    model = beam(N, ends=("free", "free")).compile(elements=N, element="rigid")
    modes = model.modes(below=1e-2)
    np.testing.assert_array_equal(modes.frequency, [0, 0])


# extremes ------------------------------------------------------------------------------------


@pytest.mark.parametrize("mass", [1e6, 1e12])
def test_rope_carries_a_mass_beyond_all_measure(mass):
    model = beam(N, parts=[rd.PointMass(LENGTH / 2, mass)]).compile(elements=N, element="rigid")
    modes = model.modes(1)
    exact = math.sqrt(192 * BENDING / LENGTH**3 / (mass + 0.4 * MASS)) / (2 * math.pi)
    # the rope's own share of the mass is between 0 and 0.5 of MASS; and 5e3 eps
    assert modes.frequency[0] == pytest.approx(exact, rel=0.1 * MASS / mass + 1e-11)


@pytest.mark.parametrize("mass", [1e6, 1e12])
def test_ropes_on_both_sides_of_a_heavy_mass_swing_as_if_held(mass):
    # its rotation is free: even and odd modes of two equal spans are nearly one frequency apart
    heavy = rd.PointMass(LENGTH / 2, mass, rotary_inertia=mass)
    model = beam(N, parts=[heavy]).compile(elements=N, element="rigid")
    held = [rd.Support(LENGTH / 2), rd.Support(LENGTH / 2, coordinate="beta")]
    exact = beam(N, parts=held).compile(elements=N, element="rigid").modes(4).frequency
    # alone on its springs: 192 B/L^3 and, turning, 2 x 4 B/(L/2)
    own = np.sqrt(BENDING / mass * np.array([16 / LENGTH, 192 / LENGTH**3])) / (2 * math.pi)
    exact = np.concatenate([own, exact])
    try:
        modes = model.modes(6)
    except rd.SolveError as error:
        # the assembled path may give up, but must say so
        assert "digit" in str(error)
        return
    # moves by MASS/mass; what the mass hides of the other digits rounding_error must say
    error = np.abs(modes.frequency - exact)
    assert (error <= modes.rounding_error + exact * (MASS / mass + 1e-11)).all()


@pytest.mark.parametrize("part", [-2.0, -1.0 - 1e-6, -1.0 + 1e-6, -0.5, 0.5, 3.0])
def test_spring_of_either_sign_adds_to_the_stiffness(part):
    # one mass on two strings: 4 T/L (1 + part)
    T, density = 25.0, 0.2
    scene = rd.Scene(rd.Rope(1.0, density), tension=T, parts=[rd.Spring(0.5, 4 * T * part)])
    modes = scene.compile(elements=2, element="rigid").modes(1)
    exact = 4 * T * (1 + part) / (density / 2)
    # 1 + part cancels to 1e-6 of two numbers with eps each
    assert modes.eigenvalue[0] == pytest.approx(exact, abs=8 * EPS * 4 * T / (density / 2) * 3)
    assert (modes.growth[0] > 0) == (exact < 0)


def test_negative_spring_cancels_a_beam_to_zero_frequency():
    scene = beam(N, parts=[rd.Spring(LENGTH / 2, -192 * BENDING / LENGTH**3)])
    modes = scene.compile(elements=N, element="rigid").modes(2)
    # exactly 0 to within what it says rounding can do
    assert modes.eigenvalue[0] == 0 or abs(modes.eigenvalue[0]) < 1e-9 * modes.eigenvalue[1]


def test_nearly_rigid_spring_is_a_support():
    k = 1e12
    stiff = beam(N, parts=[rd.Spring(LENGTH / 2, k)]).compile(elements=N, element="rigid").modes(4)
    held = beam(N, parts=[rd.Support(LENGTH / 2)]).compile(elements=N, element="rigid").modes(4)
    # its own yield: stiffness of the two spans, 24 B (n/L)^3, over k
    assert (
        np.abs(stiff.frequency / held.frequency - 1) <= 24 * BENDING * (N / LENGTH) ** 3 / k + 1e-11
    ).all()


def test_everything_held_has_no_mode():
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=1.0).compile(elements=1, element="rigid")
    assert model.size == 0
    with pytest.raises(rd.SolveError, match="at most 0"):
        model.modes(1)
    assert len(model.modes(below=10.0).frequency) == 0


def test_shape_survives_a_step_that_hits_its_frequency_to_the_last_bit():
    # the third frequency of this chain is found so well that nothing drives the last iteration
    parts = (rd.PointMass(0.25, 0.363202), rd.Support(0.77, coordinate="x"))
    scene = rd.Scene(rd.Rope(1.0, 1.0, axial_stiffness=10.0), ends=("free", "clamped"), parts=parts)
    model = scene.compile(elements=7, element="rigid")
    modes = model.modes(5)
    K, M = model.stiffness_matrix().toarray(), model.mass_matrix().toarray()
    free = model.chain.held[model.chain.term_of][:, 0] == 0
    for eigenvalue, shape in zip(modes.eigenvalue, modes.shape[:, free, 0]):
        off = K @ shape - eigenvalue * (M @ shape)
        # rounding of a product with K
        assert np.abs(off).max() <= 8 * np.finfo(float).eps * np.abs(K).max()
