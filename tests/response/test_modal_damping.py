"""Modal damping in responses: a sum over modes against complete sums."""

import numpy as np
import pytest
import scipy.linalg
from conftest import EPS, LAID
from random_scene import DENSITY, LENGTH, WIDTHS, taut_scene

import ropedyn as rd

T, MU, L = 100.0, 0.1, 1.0
STRING = rd.Rope(L, MU)
ZETA = 0.01
FREQUENCY = np.array([0.0, 1.0, 15.8, 20.0, 47.0, 111.0])
MANY = 10**5
"""Modes of a complete sum: what is left, zeta omega/omega_1/MANY^2, is below 1e-9 of the static."""


def string_sum(ends, x, y, zeta=ZETA):
    """The sum over the modes of a string, and the static part of those left out in closed form."""
    k = np.arange(1, MANY + 1)
    own = k * np.pi / L * np.sqrt(T / MU)
    shape, sign = (np.sin, -1) if ends == "clamped" else (np.cos, 1)
    share = 2 / (MU * L) * shape(k * np.pi * x) * shape(k * np.pi * y)

    def series(angle):  # sum of cos(k angle)/k^2
        return np.pi**2 / 6 - np.pi * angle / 2 + angle**2 / 4

    static = (series(np.pi * abs(x - y)) + sign * series(np.pi * (x + y))) / (np.pi**2 * T / L)
    value = []
    for f in FREQUENCY:
        omega = 2 * np.pi * f
        lost = 2j * zeta * own * omega
        rigid = 0.0 if ends == "clamped" or f == 0 else -1 / (MU * L * omega**2)
        dynamic = share * (omega**2 - lost) / (own**2 - omega**2 + lost) / own**2
        value.append(static + rigid + dynamic.sum())
    return np.array(value)


def left_out(zeta):
    """What modes beyond the 64th give at most: static 2 L/(pi^2 T) sum 1/k^2, times what g is."""
    r = 2 * np.pi * FREQUENCY / (64 * np.pi / L * np.sqrt(T / MU))
    rest = 2 * L / (np.pi**2 * T) / 63
    # of a free string about the first imaginary frequency, r = 1/64
    return rest * np.hypot(r**2 + 64.0**-2, 2 * zeta * r) / (1 - r**2)


@pytest.mark.parametrize("ends", ["clamped", "free"])
@pytest.mark.parametrize("zeta", [1e-6, 0.01, 0.3])
@pytest.mark.claim(
    "FRF of a string with modal damping, held and free: error over what rounding_error and "
    "mesh_error say",
    reference="10^5 modes and the closed form of the rest: tests/response/test_modal_damping.py",
    accepted=1.0,
)
def test_string_responds_as_the_complete_sum_over_its_modes(ends, zeta, claim):
    scene = rd.Scene(STRING, tension=T, ends=(ends, ends), damping=rd.ModalDamping(zeta))
    f = slice(0 if ends == "clamped" else 1, None)  # a free string has no static response
    frf = scene.compile().frf(FREQUENCY[f], drive=("z", 0.3), response=[("z", 0.3), ("z", 0.72)])
    covered = []
    for k, x in enumerate((0.3, 0.72)):
        exact = string_sum(ends, x, 0.3, zeta)[f]
        # what the sum itself leaves out
        rest = (1e-9 * zeta + 1e-13) / T
        known = np.abs(exact) * (frf.rounding_error + frf.mesh_error)[k] + rest
        covered.append(np.abs(frf.value[k] - exact) / known)
        assert (frf.mesh_error[k] * np.abs(frf.value[k]) <= left_out(zeta)[f] * (1 + 1e-9)).all()
    claim(np.max(covered))


def dense_sum(model, f, zeta, drive, response):
    """The sum over all modes of the assembled matrices, at degrees of freedom."""
    K, M = model.stiffness_matrix().toarray(), model.mass_matrix().toarray()
    eigenvalue, shape = scipy.linalg.eigh(K, M)
    own = np.sqrt(np.maximum(eigenvalue, 0.0))
    omega = 2 * np.pi * f
    modal = shape[drive] * shape[response]
    return (modal / (eigenvalue - omega**2 + 2j * zeta * own * omega)).sum()


@pytest.mark.parametrize("solver", ["sweep", "band", "lapack"])
@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_a_chain_responds_as_the_sum_over_all_its_modes(element, solver):
    scene = rd.Scene(LAID, tension=40.0, damping=rd.ModalDamping(0.03))
    model = scene.compile(elements=6, element=element)
    drive, response = ("z", float(model.x[2])), ("alpha", float(model.x[4]))
    at = {
        name: (node - 1) * 4 + model.coordinates.index(name)
        for name, node in (("z", 2), ("alpha", 4))
    }
    for f in (0.0, 7.0, 300.0):
        frf = model.frf(f, drive=drive, response=response, solver=solver)
        exact = dense_sum(model, f, 0.03, at["z"], at["alpha"])
        # eigh of 20 unknowns: eps times its condition, 1e6 from the stretching mode to the first
        assert frf.value[0, 0] == pytest.approx(exact, rel=1e-8)
        assert frf.rounding_error[0, 0] < 1e-8


def test_a_chain_with_all_its_modes_leaves_nothing_out():
    model = rd.Scene(STRING, tension=T, damping=rd.ModalDamping(ZETA)).compile(elements=10)
    n = 10
    theta = np.arange(1, n) * np.pi / n
    own = 2 * np.sin(theta / 2) * np.sqrt(T / MU) * n / L
    shape = np.sin(3 * theta) * np.sqrt(2 / n / (MU * L / n))
    omega = 2 * np.pi * FREQUENCY[:, None]
    exact = (shape**2 / (own**2 - omega**2 + 2j * ZETA * own * omega)).sum(axis=1)
    frf = model.frf(FREQUENCY, drive=("z", 0.3))
    assert (np.abs(frf.value[0] / exact - 1) <= frf.rounding_error[0] + 64 * EPS).all()
    assert frf.rounding_error.max() < 1e-10


def test_each_mode_may_have_its_own_ratio():
    ratio = 0.02 / np.arange(1, 10)
    model = rd.Scene(STRING, tension=T, damping=rd.ModalDamping(ratio)).compile(elements=10)
    theta = np.arange(1, 10) * np.pi / 10
    own = 2 * np.sin(theta / 2) * np.sqrt(T / MU) * 10 / L
    shape = np.sin(3 * theta) * np.sqrt(2 / (MU * L))
    omega = 2 * np.pi * FREQUENCY[:, None]
    exact = (shape**2 / (own**2 - omega**2 + 2j * ratio * own * omega)).sum(axis=1)
    frf = model.frf(FREQUENCY, drive=("z", 0.3))
    assert (np.abs(frf.value[0] / exact - 1) <= frf.rounding_error[0] + 64 * EPS).all()


def test_ratios_count_the_modes_of_all_components():
    # twist at sqrt(C/p)/2L = 5 Hz and its multiples, the string at 15.8 Hz between 15 and 20 Hz
    rope = rd.Rope(L, MU, torsional_stiffness=1.0, polar_inertia=0.01)
    scene = rd.Scene(rope, tension=T)
    ratio = [0.01, 0.02, 0.03, 0.04, 0.05]  # twist, twist, twist, z, twist
    frf = scene.replace(damping=rd.ModalDamping(ratio)).compile().frf(16.0, drive=("z", 0.3))
    same = scene.replace(damping=rd.ModalDamping(0.04)).compile().frf(16.0, drive=("z", 0.3))
    # one mode against 64: the others are static, within what is said
    allowed = frf.mesh_error[0, 0] + 2 * same.mesh_error[0, 0]
    assert abs(frf.value[0, 0] / same.value[0, 0] - 1) <= allowed
    wrong = scene.replace(damping=rd.ModalDamping(0.01)).compile().frf(16.0, drive=("z", 0.3))
    assert abs(frf.value[0, 0] / wrong.value[0, 0] - 1) > 0.1


@pytest.mark.parametrize("elements", [2, 6, None])
def test_ratios_of_two_planes_with_equal_modes_come_in_the_order_of_coordinates(elements):
    # each plane had that of the other too: which is below which was a toss of two counts
    ratio = (0.02, 0.1) * (elements - 1 if elements else 200)
    scene = rd.Scene(STRING, tension=T)
    both = scene.replace(planes="both", damping=rd.ModalDamping(ratio)).compile(elements=elements)
    assert both.coordinates == ("y", "z")
    f = both.modes(2).frequency[:1]
    for c, zeta in (("y", 0.02), ("z", 0.1)):
        one = scene.replace(damping=rd.ModalDamping(zeta)).compile(elements=elements)
        alone = one.frf(f, drive=("z", 0.5))
        found = both.frf(f, drive=(c, 0.5))
        np.testing.assert_allclose(found.value, alone.value, rtol=1e-10)


def test_equal_modes_are_summed_up_together():
    # two spans apart but for a mass that is too heavy to move: pairs of equal frequencies
    parts = [rd.PointMass(0.5, 1e12)]
    frf = (
        rd.Scene(STRING, tension=T, parts=parts, damping=rd.ModalDamping(ZETA))
        .compile()
        .frf([20.0, 31.6, 50.0], drive=("z", 0.2))
    )
    half = rd.Scene(rd.Rope(0.5, MU), tension=T, damping=rd.ModalDamping(ZETA)).compile()
    alone = half.frf([20.0, 31.6, 50.0], drive=("z", 0.2))
    # the heavy mass gives as 1/(omega^2 m) = 1e-16; both leave different modes out
    allowed = frf.rounding_error + frf.mesh_error + alone.rounding_error + alone.mesh_error
    assert (np.abs(frf.value / alone.value - 1) <= allowed + 1e-12).all()
    assert frf.rounding_error.max() < 1e-6


def test_zero_modal_damping_is_none():
    scene = rd.Scene(STRING, tension=T)
    one, other = (
        s.compile().frf(FREQUENCY, drive=("z", 0.3))
        for s in (scene, scene.replace(damping=rd.ModalDamping([0.0, 0.0])))
    )
    np.testing.assert_array_equal(one.value, other.value)


def test_mesh_error_of_a_chain_is_its_distance_to_the_continuum():
    scene = rd.Scene(STRING, tension=T, damping=rd.ModalDamping(ZETA))
    frf = scene.compile(elements=50).frf(FREQUENCY, drive=("z", 0.3))
    exact = string_sum("clamped", 0.3, 0.3)
    distance = np.abs(frf.value[0] - exact) / np.abs(frf.value[0])
    assert (distance <= frf.mesh_error[0] * (1 + 1e-6) + frf.rounding_error[0]).all()
    # no more than that and what both leave out
    allowed = distance + 2 * left_out(ZETA) / np.abs(frf.value[0]) + frf.rounding_error[0]
    assert (frf.mesh_error[0] <= allowed).all()


@pytest.mark.parametrize("seed", range(24))
def test_the_least_damping_changes_no_random_response(seed):
    # zeta = 1e-13 moves h by that times its condition: what is left is what the sum leaves out
    random = np.random.default_rng(seed)
    width = int(random.choice(list(WIDTHS)))
    scene = taut_scene(random, width, most=100.0).replace(damping=None)
    stiffness = abs(scene.tension) + 10 * (scene.rope.bending_stiffness or 0.0) / LENGTH**2
    f = np.sqrt(stiffness / DENSITY) / (2 * LENGTH) * random.uniform(0.3, 3.0)
    drive, response = ((str(random.choice(WIDTHS[width])), x) for x in random.uniform(0, LENGTH, 2))
    plain, damped = (
        one.compile().frf(f, drive=drive, response=response)
        for one in (scene, scene.replace(damping=rd.ModalDamping(1e-13)))
    )
    allowed = plain.rounding_error + damped.rounding_error + damped.mesh_error
    assert (np.abs(plain.value - damped.value) <= allowed * np.abs(damped.value)).all()


# refused -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "other",
    [
        rd.StiffnessDamping(1e-4),
        rd.RayleighDamping(1.0, 0.0),
        rd.LossFactor(0.01),
        rd.ViscousDamping(0.1),
    ],
)
def test_other_damping_beside_modal_damping_is_refused(other):
    scene = rd.Scene(STRING, tension=T, damping=(rd.ModalDamping(ZETA), other))
    with pytest.raises(rd.SceneError, match=f"damping must be modal alone .* got {other.kind}"):
        scene.compile().frf([1.0], drive=("z", 0.3))
    # but not one of 0
    scene.replace(damping=(rd.ModalDamping(ZETA), rd.StiffnessDamping(0.0))).compile().frf(
        [1.0], drive=("z", 0.3)
    )


def test_dashpots_beside_modal_damping_are_refused():
    scene = rd.Scene(STRING, tension=T, damping=rd.ModalDamping(ZETA), parts=[rd.Dashpot(0.3, 1.0)])
    with pytest.raises(rd.SceneError, match="got dashpot"):
        scene.compile().frf([1.0], drive=("z", 0.3))


def test_internal_forces_are_refused():
    model = rd.Scene(STRING, tension=T, damping=rd.ModalDamping(ZETA)).compile()
    with pytest.raises(rd.SceneError, match=r"response must be a motion .* got \('F_z', 0.5\)"):
        model.frf([1.0], drive=("z", 0.3), response=("F_z", 0.5))


def test_modes_without_a_ratio_below_the_highest_frequency_are_refused():
    model = rd.Scene(STRING, tension=T, damping=rd.ModalDamping([0.01, 0.02])).compile()
    assert np.isfinite(model.frf([40.0], drive=("z", 0.3)).value).all()
    with pytest.raises(rd.SceneError, match=r"damping ratio must be .* got 2 for .* up to 50"):
        model.frf([1.0, 50.0], drive=("z", 0.3))


@pytest.mark.parametrize("f", [1e7, 1e100])
def test_more_modes_than_can_be_summed_up_are_refused(f):
    model = rd.Scene(STRING, tension=T, damping=rd.ModalDamping(ZETA)).compile()
    with pytest.raises(rd.SolveError, match="too high"):
        model.frf([f], drive=("z", 0.3))


def test_a_frequency_on_a_mode_without_damping_is_refused():
    model = rd.Scene(STRING, tension=T, damping=rd.ModalDamping([0.01, 0.0, 0.01])).compile()
    f = float(model.modes(2).frequency[1])
    with pytest.raises(rd.SolveError, match=rf"frequency {f!r} Hz .* undamped resonance"):
        model.frf([1.0, f], drive=("z", 0.3))


def test_rigid_motion_at_rest_is_refused():
    model = rd.Scene(STRING, tension=T, ends=("free", "free"), damping=rd.ModalDamping(ZETA))
    with pytest.raises(rd.SolveError, match=r"frequency 0\.0 Hz"):
        model.compile().frf([0.0, 1.0], drive=("z", 0.3))


def test_motion_without_inertia_is_static():
    rope = rd.Rope(L, MU, torsional_stiffness=2.0)
    model = rd.Scene(rope, tension=T, damping=rd.ModalDamping(ZETA)).compile()
    # alpha per moment at 0.25 of a shaft held at both ends: 0.25 0.75 L/C
    frf = model.frf([0.0, 3.0], drive=("alpha", 0.25))
    np.testing.assert_allclose(frf.value, 0.25 * 0.75 / 2.0, rtol=16 * EPS)


def test_modal_damping_is_refused_beside_structures_with_damping_of_their_own():
    carried = [rd.Resonator(0.3, 0.1, 5.0, damping_ratio=0.1)]
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.ModalDamping(0.01), parts=carried)
    with pytest.raises(rd.SceneError, match=r"damping must be modal alone .* got resonator"):
        scene.compile().frf([4.5], drive=("z", 0.5))


def test_modal_damping_is_refused_where_the_tip_of_a_wire_is_asked_for():
    wire = rd.BrokenWire(0.3, 0.2, 1e-3, radius=0.0)
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.ModalDamping(0.01), parts=[wire])
    with pytest.raises(rd.SceneError, match="must not be modal where the tip of a wire"):
        scene.compile().frf([4.5], drive=("z", 0.5), response=("wire", 0))
