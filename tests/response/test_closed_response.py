"""Responses in closed form: the errors they state hold, and other lines are walked."""

import os
from unittest.mock import patch

import mpmath as mp
import numpy as np
import pytest
from exact_span_response import exact_span_response

import ropedyn as rd
from ropedyn import _core
from ropedyn.response import solvers

INF = float("inf")


def random_case(rng):
    """A span on springs of both signs, in tension and compression, with losses; two points."""
    L, mu, B = 10 ** rng.uniform(-1, 1, 3)
    p = 10 ** rng.uniform(-2, 5) if rng.random() < 0.7 else -(10 ** rng.uniform(-2, 2))
    number = [L, mu, p * B / L**2, B]
    for unit in (B / L**3, B / L) * 2:
        kind = rng.random()
        spring = rng.choice([-1, 1, 1, 1]) * 10 ** rng.uniform(-3, 4) * unit
        number.append(INF if kind < 0.3 else 0.0 if kind < 0.5 else spring)
    omega = 10 ** rng.uniform(-2, 5) * np.sqrt(B / mu) / L**2
    losses = rng.choice([0, 1e-3, 0.1], 3)
    factor = np.array([*(1 + 1j * losses), -(omega**2), 1j * omega])
    drag = rng.choice([0.0, 0.1, 1.0]) * np.sqrt(B * mu) / L**2
    return np.array(number), factor, drag, *rng.uniform(0, L, 2)


def check_errors(seed, count):
    """Return how many cases are certain; the errors of these cover what 60 digits say."""
    rng, certain = np.random.default_rng(seed), 0
    for _ in range(count):
        number, factor, drag, x0, x1 = random_case(rng)
        points = np.array([x0]), np.array([x1])
        value, error, sure = _core.closed_response(number[None], factor[:, None], drag, *points)
        if sure[0, 0]:
            true = exact_span_response(number, factor, drag, x0, x1)
            off = abs(mp.mpc(complex(value[0, 0, 0, 0])) - true) / abs(true)
            assert off <= error[0, 0, 0, 0], (number, factor, drag, x0, x1)
            certain += 1
    return certain


def test_the_errors_of_random_lines_cover_the_truth():
    assert check_errors(seed=17, count=80) > 40


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(5))
def test_the_errors_of_many_random_lines_cover_the_truth(seed):
    fresh = int(os.environ.get("ROPEDYN_SEED", "0")) + seed
    assert check_errors(seed=fresh, count=2000) > 1000


def test_the_error_covers_an_antiresonance():
    # bisect the response of an undamped span to where it changes its sign
    number = np.array([1.0, 1.0, 30.0, 1.0, INF, INF, INF, INF])
    points = np.array([0.21]), np.array([0.34])

    def at(omega):
        factor = np.array([[1], [1], [1], [-(omega**2)], [1j * omega]], dtype=complex)
        value, error, sure = _core.closed_response(number[None], factor, 0.0, *points)
        return value[0, 0, 0, 0].real, error[0, 0, 0, 0], sure[0, 0], factor[:, 0]

    grid = np.linspace(1.0, 400.0, 400)
    sign = np.sign([at(omega)[0] for omega in grid])
    seen = 0
    for k in np.flatnonzero(np.diff(sign)):
        low, high = grid[k], grid[k + 1]
        for _ in range(45):
            middle = (low + high) / 2
            low, high = (middle, high) if np.sign(at(middle)[0]) == sign[k] else (low, middle)
            value, error, sure, factor = at(middle)
            if sure:
                true = exact_span_response(number, factor, 0.0, *(p[0] for p in points))
                assert abs(value - true) <= error * abs(value)
        if abs(value) < 1e-9:
            assert not sure
            seen += 1
    assert seen > 2


def test_lines_that_are_not_certain_are_walked():
    rope = rd.Rope(1.0, 1.0, bending_stiffness=1.0)
    scene = rd.Scene(rope, tension=20.0, damping=rd.ViscousDamping(0.3))
    model, f = scene.compile(), np.linspace(0.0, 40.0, 101)
    asked = {"drive": ("z", 0.3), "response": [("z", 0.3), ("z", 0.8)]}
    found = model.frf(f, **asked)
    with patch.object(solvers, "closed_lines", lambda *_: None):
        walked = model.frf(f, **asked)
    assert (found.value[:, 0] == walked.value[:, 0]).all()
    assert (found.value != walked.value).any()
    off = np.abs(found.value - walked.value) / np.abs(walked.value)
    assert (off <= found.rounding_error + walked.rounding_error).all()


@pytest.mark.parametrize("response", [("z", 0.0), ("z", 1.0), ("beta", 0.4), ("F_z", 0.4)])
def test_other_points_are_walked(response):
    scene = rd.Scene(rd.Rope(1.0, 1.0, bending_stiffness=1.0), tension=20.0)
    frf = scene.compile().frf([1.0, 2.0], drive=("z", 0.3), response=response)
    with patch.object(solvers, "closed_lines", lambda *_: None):
        walked = scene.compile().frf([1.0, 2.0], drive=("z", 0.3), response=response)
    np.testing.assert_array_equal(frf.value, walked.value)
