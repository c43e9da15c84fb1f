"""`rounding_error` of a response bounds the true error and is no useless bound.

Of random lines, and of undamped ones at and next to frequencies where a response changes its sign,
through 0 or infinity.
"""

import mpmath
import numpy as np
import pytest
from conftest import EPS
from exact_chain import DIGITS, Exact, condition, omega_of, response
from random_scene import random_line
from resonant_line import error_and_limit, exact_line, kept_lines

import ropedyn as rd

FEW, MANY, RESONANT_MANY = 100, 10_000, 5_000
RESONANT = 1e11
"""Condition of an answer that may be refused: times the n eps of a long chain it has no digit."""
EXACT = "mpmath, 60 digits, from the numbers of the scene: tests/support/exact_chain.py"


def answer(line, solver):
    """Value and estimated relative error."""
    x = line.model.x.tolist()
    (c, i), (d, j) = line.drive, line.response
    frf = line.model.frf(
        line.frequency, drive=(c, x[i]), response=(d, x[j]), threads=1, solver=solver
    )
    return frf.value[0, 0], frf.rounding_error[0, 0]


def has_no_answer(exact, line):
    """Whether motion of the driven node changes by all its digits with the model's numbers."""
    omega, node = omega_of(line.frequency), line.drive[1]
    for c in exact.coordinates:
        try:
            if condition(exact, omega, (c, node), (c, node)) > RESONANT:
                return True
        except ZeroDivisionError:
            return True
    return False


def error_and_estimate(seed, solver="sweep"):
    """Both over the value itself, (0, 1) where a resonance was refused rightly."""
    line = random_line(seed)
    with mpmath.workdps(DIGITS):
        exact = Exact(line.model, line.model.component_of(line.drive[0]))
        try:
            value, estimate = answer(line, solver)
        except rd.SolveError:
            assert has_no_answer(exact, line), f"refused without need: {seed}"
            return 0.0, 1.0
        h = response(exact, line.frequency, line.drive, line.response)
        if value == 0:
            # 0, or less than there are numbers
            return (0.0 if abs(h) < np.finfo(float).tiny else np.inf), estimate
        return float(abs(h / mpmath.mpmathify(complex(value)) - 1)), estimate


def sample(count):
    """Errors and estimates of so many lines."""
    return np.array([error_and_estimate(seed) for seed in range(count)]).T


def median_of_ratio(error, estimate):
    # an error below half an ulp is luck, and a refusal estimates nothing
    some = estimate < 1
    return np.median(estimate[some] / np.maximum(error[some], EPS / 2))


@pytest.fixture(scope="module")
def few():
    return sample(FEW)


@pytest.fixture(scope="module")
def many():
    return sample(MANY)


@pytest.mark.claim(
    f"rounding_error of an FRF bounds the true error: share of {FEW} random lines beyond it",
    reference=EXACT,
    accepted=0.0,
)
def test_rounding_error_bounds_the_true_error_of_random_lines(few, claim):
    error, estimate = few
    claim(np.mean(error > estimate))


@pytest.mark.claim(
    f"rounding_error of an FRF over the true error, median of {FEW} random lines",
    reference=EXACT,
    accepted=100.0,
)
def test_rounding_error_is_no_useless_bound(few, claim):
    claim(median_of_ratio(*few))


@pytest.mark.slow
@pytest.mark.claim(
    f"rounding_error of an FRF bounds the true error: share of {MANY} random lines beyond it",
    reference=EXACT,
    accepted=1e-3,
)
def test_rounding_error_bounds_the_true_error_of_very_many_lines(many, claim):
    error, estimate = many
    claim(np.mean(error > estimate))


@pytest.mark.slow
@pytest.mark.claim(
    f"rounding_error of an FRF over the true error, median of {MANY} random lines",
    reference=EXACT,
    accepted=1e3,
)
def test_rounding_error_of_very_many_lines_is_no_useless_bound(many, claim):
    claim(median_of_ratio(*many))


@pytest.mark.parametrize(
    "seed",
    [
        pytest.param(500288, id="bending fades within an element"),
        pytest.param(501668, id="pushed, twist and bending nearly one"),
        pytest.param(503597, id="twist and pull nearly one"),
    ],
)
def test_rounding_error_bounds_what_the_band_finds_where_little_is_left(seed):
    # by forces and motion as unknowns these lines are right to the last digits
    line = random_line(seed)
    (value, estimate), (other, wrong) = (answer(line, solver) for solver in ("sweep", "band"))
    assert wrong < 0.1 * estimate
    assert abs(value - other) <= (estimate + wrong) * abs(other)


# resonances and antiresonances -------------------------------------------------------------------


@pytest.fixture(scope="module", params=["chain", "span"])
def resonant(request):
    return np.array([error_and_limit(*line) for line in kept_lines(request.param)]).T


@pytest.mark.claim(
    "rounding_limit of an FRF at and next to resonances and antiresonances: share of a few lines "
    "beyond it",
    reference=EXACT,
    accepted=0.0,
)
def test_rounding_limit_bounds_the_true_error_where_a_response_changes_its_sign(resonant, claim):
    error, limit, _ = resonant
    assert len(error) >= 5
    claim(np.mean(error > limit))


@pytest.mark.claim(
    "rounding_limit of an FRF at and next to resonances and antiresonances over the true error, "
    "median of a few lines",
    reference=EXACT,
    # of real numbers errors are smaller than of complex ones, which the bound is calibrated by
    accepted=100.0,
)
def test_rounding_limit_is_no_useless_bound_where_a_response_changes_its_sign(resonant, claim):
    error, limit, value = resonant
    claim(np.median(limit / np.maximum(error, EPS / 2 * value)))


@pytest.mark.slow
@pytest.mark.claim(
    f"rounding_limit of an FRF at and next to resonances and antiresonances: share of the lines of "
    f"{RESONANT_MANY} random scenes of each kind beyond it",
    reference=EXACT,
    accepted=0.0,
)
@pytest.mark.parametrize("kind", ["chain", "span"])
def test_rounding_limit_bounds_very_many_lines_where_a_response_changes_its_sign(kind, claim):
    lines = (exact_line(seed, kind) for seed in range(10_000, 10_000 + RESONANT_MANY))
    error, limit, _ = np.array([error_and_limit(*line) for line in lines if line]).T
    claim(np.mean(error > limit))


DRIVE = ("z", 0.5)


@pytest.mark.parametrize("beside", [1e-3, 1e-5, 1e-6, 1e-9, 0.0])
def test_antiresonance_of_a_loaded_string_is_known_to_its_rounding_error(beside):
    # the part of the string to the right of its middle is half a wave long at 100 Hz
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0, parts=[rd.PointMass(0.3, 0.1)])
    f = 100.0 * (1 + beside)
    frf = scene.compile().frf(f, drive=DRIVE)
    with mpmath.workdps(40):
        h = _loaded_string(mpmath.mpf(f), mpmath.mpf(0.3), mpmath.mpf(0.1))
        error = float(abs(mpmath.mpf(frf.value[0, 0].real) - h))
    assert error <= frf.rounding_limit[0, 0] <= 200 * EPS * 1e-4
    assert frf.rounding_error[0, 0] >= error / abs(frf.value[0, 0])


def _loaded_string(f, at, mass):
    """z(0.5) per force there of a string of 1 m, 0.1 kg/m, 1000 N with a mass."""
    tension, omega = mpmath.mpf(1000), 2 * mpmath.pi * f
    k = omega * mpmath.sqrt(mpmath.mpf(0.1) / tension)
    # stiffness left of the middle, carried over the mass, and right of it
    left = tension * k * mpmath.cot(k * at) - mass * omega**2
    gap, wave = mpmath.mpf(0.5) - at, tension * k
    s, c = mpmath.sin(k * gap), mpmath.cos(k * gap)
    left = wave * (left * c - wave * s) / (left * s + wave * c)
    return 1 / (left + wave * mpmath.cot(k / 2))


def test_response_that_is_0_has_an_infinite_relative_and_a_finite_absolute_bound():
    frf = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile().frf(30.0, drive=DRIVE)
    nothing = type(frf.rounding).of(np.zeros((1, 1), dtype=complex), frf.rounding_limit)
    assert np.isinf(nothing.rounding_error).all()
    assert np.isfinite(nothing.rounding_limit).all()


def test_bounds_follow_the_quantity():
    frf = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile().frf([30.0, 70.0], drive=DRIVE)
    asked, turned = (
        rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0)
        .compile()
        .frf([30.0, 70.0], drive=DRIVE, quantity="accelerance"),
        frf.to("accelerance"),
    )
    np.testing.assert_allclose(turned.rounding_limit, asked.rounding_limit, rtol=1e-14)
    np.testing.assert_allclose(turned.rounding_error, frf.rounding_error, rtol=1e-14)
