"""Responses at s = i omega + decay: of force and motion that an exponential window weights."""

import re
from functools import partial

import mpmath
import numpy as np
import pytest
from conftest import EVERYTHING
from mpmath import mpc, mpf

import ropedyn as rd

LENGTH, DENSITY, BENDING, TENSION = 1.3, 0.1, 2.0, 300.0
DRIVE, RESPONSE = 0.3, 0.9
FREQUENCY = np.array([0.0, 0.7, 21.0, 55.5, 140.0, 333.0])
DECAY = 37.0
DIGITS = 40
EXACT = 1e-13
"""Relative, of closed forms in double precision: 4e-15 measured."""
PINNED = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING)
STRING = rd.Rope(LENGTH, DENSITY)


def worst(value, expected):
    """Return the largest error in units of the largest expected."""
    return np.abs(value - expected).max() / np.abs(expected).max()


# --- closed forms -------------------------------------------------------------------------------


def string(s, T=TENSION, c=0):
    """Receptance of a held string with drag c: sinh(p x) sinh(p (L - y))/(T p sinh(p L))."""
    p = mpmath.sqrt((s * s * DENSITY + s * c) / T)
    across = mpmath.sinh(p * DRIVE) * mpmath.sinh(p * (LENGTH - mpf(RESPONSE)))
    return across / (T * p * mpmath.sinh(p * LENGTH))


def beam(s, T=TENSION, B=BENDING, gamma=0, eta=0, mass=0, stiffness=0, c=0):
    """The same of a pinned beam: B w'''' - T w'' + m w = 0 has the exponents a and b."""
    B = B * (1 + s * (gamma + stiffness) + 1j * eta)
    T = T * (1 + s * stiffness)
    m = DENSITY * (s * s + s * mass) + s * c
    root = mpmath.sqrt(T * T / 4 - m * B)
    a, b = mpmath.sqrt((T / 2 + root) / B), mpmath.sqrt((T / 2 - root) / B)

    def part(e):
        across = mpmath.sinh(e * DRIVE) * mpmath.sinh(e * (LENGTH - mpf(RESPONSE)))
        return across / (e * mpmath.sinh(e * LENGTH))

    return (part(b) - part(a)) / (B * (a * a - b * b))


def exact(receptance):
    """Return it at all lines."""
    with mpmath.workdps(DIGITS):
        lines = [mpc(DECAY, 2 * mpmath.pi * mpf(f)) for f in FREQUENCY]
        return np.array([complex(receptance(s)) for s in lines])


CASES = {
    "string": (STRING, None, string),
    "string in water": (STRING, rd.ViscousDamping(0.7), partial(string, c=0.7)),
    "beam": (PINNED, None, beam),
    "stiffness": (PINNED, rd.StiffnessDamping(1e-4), partial(beam, gamma=1e-4)),
    "loss": (PINNED, rd.LossFactor(0.05), partial(beam, eta=0.05)),
    "rayleigh": (PINNED, rd.RayleighDamping(9.0, 1e-4), partial(beam, mass=9.0, stiffness=1e-4)),
    "drag": (PINNED, rd.ViscousDamping(0.7), partial(beam, c=0.7)),
}
"""Rope, damping, receptance."""


def scene_of(rope, damping):
    return rd.Scene(rope, tension=TENSION, ends=("pinned", "pinned"), damping=damping)


@pytest.mark.parametrize("case", CASES)
def test_spans_answer_at_complex_frequencies_in_every_damping(case):
    rope, damping, receptance = CASES[case]
    model = scene_of(rope, damping).compile()
    found = model.frf(FREQUENCY, drive=("z", DRIVE), response=("z", RESPONSE), decay=DECAY)
    assert found.decay == DECAY
    off = np.abs(found.value[0] / exact(receptance) - 1)
    assert off.max() < EXACT
    assert (off <= found.rounding_error[0] + 1e-15).all()


SLOPES = {
    "tension": ("drag", "tension", lambda s, p: beam(s, T=p, c=0.7), TENSION),
    "drag": ("drag", "damping.coefficient", lambda s, p: beam(s, c=p), 0.7),
    "gamma": ("stiffness", "damping.gamma", lambda s, p: beam(s, gamma=p), 1e-4),
    "eta": ("loss", "damping.eta", lambda s, p: beam(s, eta=p), 0.05),
    "alpha": ("rayleigh", "damping.mass", lambda s, p: beam(s, mass=p, stiffness=1e-4), 9.0),
}
"""Case, path, receptance by the number, the number."""


@pytest.mark.parametrize("slope", SLOPES)
def test_derivatives_are_those_at_complex_frequencies(slope):
    case, path, receptance, at = SLOPES[slope]
    rope, damping, _ = CASES[case]
    model = scene_of(rope, damping).compile()
    found = model.frf(FREQUENCY, drive=("z", DRIVE), response=("z", RESPONSE), decay=DECAY)
    expected = exact(lambda s: mpmath.diff(lambda p: mpc(receptance(s, p)), at))
    # products of two fields
    assert worst(found.derivative(path)[0], expected) < EXACT


@pytest.mark.parametrize("quantity, times", [("mobility", 1), ("accelerance", 2)])
def test_velocity_and_acceleration_are_s_times_the_displacement(quantity, times):
    model = scene_of(PINNED, rd.ViscousDamping(0.7)).compile()
    ask = partial(model.frf, FREQUENCY, drive=("z", DRIVE), decay=DECAY)
    receptance, found = ask(), ask(quantity=quantity)
    s = 2j * np.pi * FREQUENCY + DECAY
    np.testing.assert_allclose(found.value, receptance.value * s**times, rtol=1e-15)
    np.testing.assert_allclose(found.to("receptance").value, receptance.value, rtol=1e-14)
    np.testing.assert_allclose(receptance.to(quantity).value, found.value, rtol=1e-15)


def test_a_moved_end_is_felt_at_complex_frequencies():
    model = scene_of(STRING, None).compile()
    found = model.frf(FREQUENCY, drive=("end", 0, "z"), response=("z", RESPONSE), decay=DECAY)
    p = (2j * np.pi * FREQUENCY + DECAY) * np.sqrt(DENSITY / TENSION)
    expected = np.sinh(p * (LENGTH - RESPONSE)) / np.sinh(p * LENGTH)
    # sinh of double precision loses the phase p L, 9 at most here
    np.testing.assert_allclose(found.value[0], expected, rtol=1e-13)


# --- chains -------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", ["sweep", "band", "lapack"])
def test_chains_answer_as_their_matrices_do(solver):
    scene = rd.Scene(
        PINNED,
        tension=TENSION,
        ends=("pinned", rd.End(z="free", beta="held", dashpot={"z": 0.4}, mass={"z": 0.01})),
        damping=rd.RayleighDamping(2.0, 1e-5),
        parts=[rd.PointMass(0.65, 0.02), rd.Dashpot(0.325, 0.3), rd.Spring(0.975, 50.0)],
    )
    model = scene.compile(elements=4, element="rigid")
    found = model.frf(FREQUENCY, drive=("z", 0.325), decay=DECAY, solver=solver)
    K, C, M = (
        one.toarray()
        for one in (model.stiffness_matrix(), model.damping_matrix(), model.mass_matrix())
    )
    s = 2j * np.pi * FREQUENCY + DECAY
    force = np.zeros(len(K))
    # unknowns node by node: the rotation of the first, then z and rotation of the second
    force[1] = 1.0
    expected = [np.linalg.solve(K + one * C + one * one * M, force)[1] for one in s]
    # dense elimination of a stiffness with a condition of 1e5 has lost five digits
    np.testing.assert_allclose(found.value[0], expected, rtol=1e-11)


@pytest.mark.parametrize("solver", ["sweep", "band"])
def test_chains_of_everything_agree_between_solvers(solver):
    scene = EVERYTHING
    ask = partial(scene.compile(elements=16).frf, np.array([3.0, 40.0, 90.0]), decay=11.0)
    drive = ("z", 0.5 * scene.rope.length)
    found, other = ask(drive=drive, solver=solver), ask(drive=drive, solver="lapack")
    assert worst(found.value, other.value) < 10 * other.rounding_error.max() + 1e-12


# --- sums over modes ----------------------------------------------------------------------------


def test_modal_damping_has_its_poles_at_complex_frequencies():
    ratio, many = 0.02, 20_000
    model = scene_of(STRING, rd.ModalDamping(ratio)).compile()
    found = model.frf(FREQUENCY, drive=("z", DRIVE), response=("z", RESPONSE), decay=DECAY)
    s = 2j * np.pi * FREQUENCY + DECAY
    k = np.arange(1, many + 1)[:, None]
    own = k * np.pi / LENGTH * np.sqrt(TENSION / DENSITY)
    shape = np.sin(k * np.pi * DRIVE / LENGTH) * np.sin(k * np.pi * RESPONSE / LENGTH)
    moved = shape * (1 / (own**2 + 2 * ratio * own * s + s**2) - 1 / own**2)
    static = DRIVE * (LENGTH - RESPONSE) / (TENSION * LENGTH)
    expected = static + 2 / (DENSITY * LENGTH) * moved.sum(axis=0)
    bound = found.mesh_error[0] + found.rounding_error[0]
    off = np.abs(found.value[0] / expected - 1)
    assert (off <= bound).all()
    # what modes beyond the 64th add, |s| (2 ratio w_k + |s|)/w_k^2 of their share of the static
    assert bound.max() < 1e-2


def test_modal_damping_has_derivatives_at_complex_frequencies():
    def at(ratio, tension):
        scene = scene_of(PINNED, rd.ModalDamping(ratio)).replace(tension=tension)
        return scene.compile().frf(FREQUENCY, drive=("z", DRIVE), decay=DECAY)

    found = at(0.02, TENSION)
    # central differences with steps of 1e-4: 9e-11 and, of the third derivative, 3e-8 measured
    by_ratio = (at(0.02 + 2e-6, TENSION).value - at(0.02 - 2e-6, TENSION).value) / 4e-6
    by_tension = (at(0.02, TENSION + 0.03).value - at(0.02, TENSION - 0.03).value) / 0.06
    assert worst(found.derivative("damping.ratio"), by_ratio) < 5e-9
    assert worst(found.derivative("tension"), by_tension) < 1e-6


# --- meshes, limits, files ----------------------------------------------------------------------


def test_mesh_error_is_the_distance_to_spans_at_the_same_decay():
    scene = scene_of(PINNED, rd.ViscousDamping(0.7))
    chain = scene.compile(elements=32).frf(FREQUENCY, drive=("z", DRIVE), decay=DECAY)
    true = scene.compile().frf(FREQUENCY, drive=("z", DRIVE), decay=DECAY)
    off = np.abs(chain.value - true.value) / np.abs(chain.value)
    # the error also holds what rounding does to the spans
    np.testing.assert_allclose(chain.mesh_error, off, atol=1e-11)


def test_without_decay_no_bit_changes():
    for damping in (None, rd.ViscousDamping(0.7), rd.ModalDamping(0.02)):
        model = scene_of(PINNED, damping).compile()
        ask = partial(model.frf, FREQUENCY, drive=("z", DRIVE), quantity="accelerance")
        assert ask().value.tobytes() == ask(decay=0.0).value.tobytes()


def test_a_free_rope_has_a_response_at_rest_where_it_decays():
    ends = (rd.End(z="free", beta="free"), rd.End(z="free", beta="free"))
    model = rd.Scene(STRING, tension=TENSION, ends=ends).compile()
    found = model.frf([0.0], drive=("z", 0.65), decay=1e-3)
    # so slow a rope moves as a body, 1/(m s^2), but for (s L/c)^2
    assert abs(found.value[0, 0] * DENSITY * LENGTH * 1e-6 - 1) < 1e-8


@pytest.mark.parametrize(
    "decay, error, words",
    [
        (-1.0, rd.SceneError, "decay must be a finite number >= 0 [1/s], got -1.0"),
        (float("nan"), rd.SceneError, "decay must be a finite number >= 0 [1/s], got nan"),
        ("fast", TypeError, "decay must be"),
    ],
)
def test_a_decay_that_means_nothing_is_refused(decay, error, words):
    model = scene_of(STRING, None).compile()
    with pytest.raises(error, match=re.escape(words)):
        model.frf([10.0], drive=("z", DRIVE), decay=decay)


@pytest.mark.parametrize("suffix", [".csv", ".uff"])
def test_files_keep_the_decay(tmp_path, suffix):
    model = scene_of(STRING, rd.ViscousDamping(0.7)).compile()
    frf = model.frf(np.arange(1.0, 9.0), drive=("z", DRIVE), decay=DECAY)
    frf.write(tmp_path / f"response{suffix}")
    assert rd.Measured.read(tmp_path / f"response{suffix}").decay == DECAY
    frf.save(tmp_path / "response.nc")
    assert rd.load(tmp_path / "response.nc").decay == DECAY
