"""`rounding_error` of a response bounds the true error and is no useless bound: random lines."""

import mpmath
import numpy as np
import pytest
from conftest import EPS
from exact_chain import DIGITS, Exact, condition, omega_of, response
from random_scene import random_line

import ropedyn as rd

FEW, MANY = 100, 10_000
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
    accepted=1e3,
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
