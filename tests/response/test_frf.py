"""Frequency response at nodes: exact discrete values, damping, reciprocity, resonances."""

import math

import mpmath
import numpy as np
import pytest
from conftest import BENDING, EPS, LENGTH, beam, reference
from scipy.linalg import eigh

import ropedyn as rd

REFERENCE = reference("frf_tensed_beam")


@pytest.mark.parametrize("coordinate", ["z", "beta"])
@pytest.mark.parametrize("case", REFERENCE["n8"], ids=lambda case: f"{case['f']:g} Hz")
@pytest.mark.claim(
    "Damped FRF of a clamped tensed beam of 8 rigid elements, relative to the largest response",
    reference="stored, mpmath: frf_tensioned_beam.json",
    accepted=9e-13,
)
def test_rigid_chain_responds_exactly(case, coordinate, claim):
    scene = beam(8, tension=300.0, damping=rd.RayleighDamping(0, 1e-4))
    frf = scene.compile(elements=8, element="rigid").frf(
        case["f"],
        drive=("z", REFERENCE["n8_drive"]),
        response=[(coordinate, x) for x in case["x"]],
    )
    exact = np.array(case[coordinate]) @ [1, 1j]
    # K/(K - omega^2 M): its condition 50 n^4/pi^4 = 2e3, times 1/(omega gamma) = 30 at most near
    # a resonance, times eps; relative to the largest of the responses
    error = np.abs(frf.value[:, 0] - exact)
    claim(error.max() / np.abs(exact).max())


def string_receptance(n, drive, response, stiffness, lam):
    """u_response for a unit force at node drive: T/a (2 u_j - u_j-1 - u_j+1) = m lam u_j + f_j.

    With 2 - 2 cos p = m lam/(T/a): sin(p j) sin(p (n - k))/((T/a) sin p sin(p n)), j <= k; p is
    complex beyond the highest frequency and with damping.
    """
    p = np.arccos(1 - lam / 2 + 0j)
    j, k = min(drive, response), max(drive, response)
    return np.sin(p * j) * np.sin(p * (n - k)) / (stiffness * np.sin(p) * np.sin(p * n))


N, TENSION, DENSITY = 10, 80.0, 0.05
SPACING = 1.0 / N
TOP = math.sqrt(TENSION / (DENSITY * SPACING**2)) / math.pi
"""Highest frequency a chain can carry [Hz]."""
DAMPINGS = {
    "none": None,
    "stiffness": rd.StiffnessDamping(2e-3),
    "rayleigh": rd.RayleighDamping(3.0, 2e-3),
    "sum": (rd.RayleighDamping(3.0, 0), rd.StiffnessDamping(5.0), rd.RayleighDamping(0, 2e-3)),
}


@pytest.mark.parametrize("damping", DAMPINGS)
@pytest.mark.parametrize("part_of_top", [0.03, 0.4, 0.98, 1.5, 4.0])
@pytest.mark.parametrize("response", [1, 3, 5])
def test_string_chain_responds_as_its_green_function(damping, part_of_top, response):
    f = part_of_top * TOP
    omega = 2 * math.pi * f
    scene = rd.Scene(rd.Rope(1.0, DENSITY), tension=TENSION, damping=DAMPINGS[damping])
    frf = scene.compile(elements=N, element="rigid").frf(
        f, drive=("z", 0.3), response=("z", response / N)
    )
    # stiffness damping leaves the tension alone: design.md, section 3
    mass, stiffness = (3.0, 2e-3) if damping in ("rayleigh", "sum") else (0.0, 0.0)
    string = TENSION / SPACING * (1 + 1j * omega * stiffness)
    lam = DENSITY * SPACING * (omega**2 - 1j * omega * mass) / string
    exact = string_receptance(N, 3, response, string, lam)
    # condition (2 n/pi)^2 = 40 away from a resonance, a few eps; below 1.5 TOP responses
    # elsewhere are not much smaller than the drive's
    scale = max(abs(exact), abs(string_receptance(N, 3, 3, string, lam)))
    assert abs(frf.value[0, 0] - exact) <= 500 * EPS * scale
    if damping in ("none", "stiffness"):
        assert frf.value[0, 0].imag == 0


def test_stiffness_damping_damps_all_but_the_tension():
    f, gamma = 37.0, 3e-4
    turning = 1 + 2j * math.pi * f * gamma
    damped = beam(8, tension=300.0, damping=rd.StiffnessDamping(gamma)).compile(
        elements=8, element="rigid"
    )
    K = beam(8, tension=300.0).compile(elements=8, element="rigid").stiffness_matrix().toarray()
    elastic = beam(8).compile(elements=8, element="rigid").stiffness_matrix().toarray()
    M = damped.mass_matrix().toarray()
    D = K + (turning - 1) * elastic - (2 * math.pi * f) ** 2 * M
    at = 2 * 3 - 2
    exact = np.linalg.inv(D)[at, at]
    value = damped.frf(f, drive=("z", 3 * LENGTH / 8)).value[0, 0]
    # condition of the scaled chain, 50 n^4/pi^4 = 2e3
    assert abs(value / exact - 1) <= 1e-11


def test_without_tension_both_dampings_of_stiffness_are_one():
    frequency = np.linspace(0, 400, 41)
    one, other = (
        beam(8, damping=damping)
        .compile(elements=8, element="rigid")
        .frf(frequency, drive=("z", LENGTH / 2))
        .value
        for damping in (rd.StiffnessDamping(1e-4), rd.RayleighDamping(0, 1e-4))
    )
    np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize(("quantity", "power"), [("mobility", 1), ("accelerance", 2)])
def test_velocity_and_acceleration_are_derivatives_of_the_motion(quantity, power):
    frequency = np.array([0.0, 3.0, 70.0])
    model = beam(8, tension=300.0, damping=rd.StiffnessDamping(1e-4)).compile(
        elements=8, element="rigid"
    )
    receptance = model.frf(frequency, drive=("z", 0.5))
    derived = model.frf(frequency, drive=("z", 0.5), quantity=quantity)
    expected = (2j * math.pi * frequency) ** power * receptance.value
    np.testing.assert_allclose(derived.value, expected, rtol=4 * EPS)
    np.testing.assert_allclose(receptance.to(quantity).value, expected, rtol=4 * EPS)


@pytest.mark.parametrize("pair", [("z", "z"), ("z", "beta"), ("beta", "z"), ("alpha", "z")])
def test_force_and_response_can_change_places(pair):
    rope = rd.Rope(
        1.0, 0.1, bending_stiffness=5.0, torsional_stiffness=1.0, lay_slope=0.2, polar_inertia=1e-6
    )
    scene = rd.Scene(
        rope,
        tension=50.0,
        ends=("clamped", "pinned"),
        parts=[rd.PointMass(0.25, 0.03), rd.Spring(0.75, -30.0)],
        damping=rd.StiffnessDamping(1e-4),
    )
    here, there = (pair[0], 0.25), (pair[1], 0.625)
    model = scene.compile(elements=8, element="rigid")
    frequency = np.linspace(1, 500, 23)
    forth = model.frf(frequency, drive=here, response=there)
    back = model.frf(frequency, drive=there, response=here)
    # both err by what they say they do
    error = (forth.rounding_error + back.rounding_error) * np.abs(forth.value)
    assert (np.abs(forth.value - back.value) <= error).all()
    assert np.abs(forth.value).min() > 0


@pytest.mark.parametrize("damping", [rd.StiffnessDamping(1e-4), rd.RayleighDamping(2.0, 1e-6)])
@pytest.mark.parametrize("drive", [("z", LENGTH / 2), ("beta", LENGTH / 8)])
def test_passive_rope_takes_in_power_at_the_drive_point(damping, drive):
    frequency = np.linspace(0.5, 900, 301)
    model = beam(8, tension=300.0, damping=damping).compile(elements=8, element="rigid")
    assert (model.frf(frequency, drive=drive).value.imag < 0).all()


@pytest.mark.parametrize("k", [0, 1, 2])
def test_peaks_recover_frequency_and_damping_of_the_modes(k):
    scene = beam(16, tension=300.0, damping=rd.RayleighDamping(0.0, 2e-6))
    model = scene.compile(elements=16, element="rigid")
    modes = model.modes(3)
    # at the largest deflection of each mode
    drive = ("z", float(modes.x[np.abs(modes.shape[k, :, 0]).argmax()]))
    frequency = modes.frequency[k] * np.linspace(0.998, 1.002, 401)
    peak = model.frf(frequency, drive=drive).peaks()[0]
    # the other modes, of the order of the static flexibility, tilt the line by their share of the
    # peak: the damping by as much, the frequency by zeta times that
    static = model.frf(0.0, drive=drive).value[0, 0].real
    tilt, ratio = 2 * static / peak.amplitude[0], modes.damping_ratio[k]
    assert len(peak.frequency) == 1
    assert tilt < 0.05
    assert peak.damping_ratio[0] == pytest.approx(ratio, rel=tilt)
    assert peak.frequency[0] == pytest.approx(modes.frequency[k], rel=ratio * tilt)


@pytest.mark.parametrize("k", [0, 1, 2])
@pytest.mark.parametrize(
    "scene",
    [rd.Scene(rd.Rope(1.0, 0.1), tension=100.0), beam(16, tension=300.0), beam(16)],
    ids=["string", "tensed beam", "beam"],
)
def test_frequency_on_an_undamped_resonance_is_refused_by_name(scene, k):
    model = scene.compile(elements=16, element="rigid")
    f = float(model.modes(3).frequency[k])
    with pytest.raises(rd.SolveError, match=f"{f!r}"):
        model.frf([1.0, f, 2000.0], drive=("z", 0.3 * scene.rope.length))


@pytest.mark.parametrize("away", [1e-9, -1e-9, 1e-6])
@pytest.mark.parametrize(("solver", "most"), [("lapack", 8), ("sweep", 1e3)])
def test_frequency_next_to_an_undamped_resonance_has_the_digits_left(solver, most, away):
    # string of two elements: one mass, h = 1/(4 T/L - omega^2 mu L/2)
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
    model = scene.compile(elements=2, element="rigid")
    f = float(model.modes(1).frequency[0]) * (1 + away)
    # 400 - omega^2 0.05, without rounding of the difference: f is exact as given
    with mpmath.workdps(40):
        exact = float(1 / (400 - (2 * mpmath.pi * f) ** 2 / 20))
    frf = model.frf(f, drive=("z", 0.5), solver=solver)
    assert abs(frf.value[0, 0] / exact - 1) <= frf.rounding_error[0, 0] <= most * EPS / abs(away)


@pytest.mark.parametrize("solver", ["sweep", "band", "lapack"])
@pytest.mark.parametrize("mode", [2, 4])
def test_force_at_a_node_of_the_resonant_mode_is_answered(solver, mode):
    # half way, even modes stand still; the response there is that of the odd ones alone
    model = beam(16, tension=300.0).compile(elements=16, element="rigid")
    f = float(model.modes(mode).frequency[mode - 1])
    square, shape = eigh(model.stiffness_matrix().toarray(), model.mass_matrix().toarray())
    middle, other = shape[len(shape) // 2 - 1], np.arange(len(square)) != mode - 1
    exact = (middle**2 / (square - (2 * np.pi * f) ** 2))[other].sum()
    frf = model.frf([0.9 * f, f, f, 1.1 * f], drive=("z", LENGTH / 2), solver=solver)
    assert frf.value[0, 1] == frf.value[0, 2]
    # the eigenvalues of the check keep 13 digits beside the largest, 10 beside these
    assert abs(frf.value[0, 1] / exact - 1) <= 1e-10
    assert frf.rounding_error[0, 1] <= 1e-9


@pytest.mark.parametrize("watched", [0.3, 0.5])
def test_spans_answer_where_a_node_of_the_resonant_mode_is_driven(watched):
    # the limit of sin(k a) sin(k (L - x))/(T k sin(k L)) at k L = 2 pi
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile()
    frf = model.frf(100.0, drive=("z", 0.5), response=("z", watched))
    # mu is no number of 2 digits: the mode lies 3e-17 beside
    with mpmath.workdps(60):
        k = 200 * mpmath.pi * mpmath.sqrt(mpmath.mpf(0.1) / 1000)
        a, x = mpmath.mpf(min(watched, 0.5)), mpmath.mpf(max(watched, 0.5))
        exact = mpmath.sin(k * a) * mpmath.sin(k * (1 - x)) / (1000 * k * mpmath.sin(k))
        error = float(abs(mpmath.mpf(frf.value[0, 0].real) - exact))
    assert error <= frf.rounding_limit[0, 0] <= 1e-17


def test_a_line_alone_at_a_node_has_its_bound_beside_structures_too():
    resonator = rd.Resonator(0.5, 0.01, 40.0)
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0, parts=[resonator]).compile()
    # the second mode of the rope alone, in which the resonator stands still
    frf = model.frf([100.0], drive=("z", 0.5), response=("z", 0.3))
    beside = model.frf([100.0 - 1e-3, 100.0 + 1e-3], drive=("z", 0.5), response=("z", 0.3))
    # curvature over (1e-5)^2
    assert frf.value[0, 0] == pytest.approx(beside.value[0].mean(), rel=1e-8)
    assert frf.rounding_error[0, 0] <= 1e-11


def test_static_limit_of_a_clamped_beam_is_the_textbook_value():
    frf = beam(8).compile(elements=8, element="rigid").frf(0.0, drive=("z", LENGTH / 2))
    # F L^3/192 B; condition 50 n^4/pi^4 times eps
    assert frf.value[0, 0] == pytest.approx(LENGTH**3 / (192 * BENDING), rel=1e-12)


def test_high_frequency_limit_is_the_mass_alone():
    # far above every mode the driven node is free: h = -1/(omega^2 m), the rest 1/omega^2 less
    model = beam(8, tension=300.0).compile(elements=8, element="rigid")
    f = 1e7
    value = model.frf(f, drive=("z", LENGTH / 2)).value[0, 0]
    mass = 0.13725 / 8
    K = model.stiffness_matrix().toarray()
    rest = K[6, 6] / (mass * (2 * math.pi * f) ** 2)
    assert value == pytest.approx(-1 / ((2 * math.pi * f) ** 2 * mass), rel=2 * rest)


def test_result_does_not_depend_on_how_many_frequencies_are_asked():
    model = beam(8, tension=300.0, damping=rd.StiffnessDamping(1e-4)).compile(
        elements=8, element="rigid"
    )
    frequency = np.linspace(1, 700, 300)
    many = model.frf(frequency, drive=("z", 0.5)).value
    one = [model.frf(f, drive=("z", 0.5)).value[0, 0] for f in frequency[::50]]
    np.testing.assert_array_equal(many[0, ::50], one)
