"""Strings and beams that carry parts, in many digits: derivatives by any of their numbers.

The state (z, F) of a string, (z, beta, F, M) of a beam, goes along a span by the exponential of its
rate and grows by N z, N = k - lambda m - lambda M/(1 - lambda/w^2) at a part; see exact_span.py.
"""

import mpmath
import numpy as np
from mpmath import mpf

import ropedyn as rd

DIGITS = 80
"""Waves grow by exp(40) along these ropes, which takes 17 digits twice; steps take 24."""

PATHS = {
    "T": "tension",
    "L": "length",
    "x0": "parts[0].x",
    "m": "parts[0].mass",
    "x1": "parts[1].x",
    "k": "parts[1].stiffness",
    "x2": "parts[2].x",
    "start": "parts[3].start",
    "density": "parts[3].density",
}
"""Numbers of these scenes that derivatives are taken by."""


def random_carrier(random, *, bends):
    """Numbers of a clamped rope with a mass, a spring, a resonator and a stretch, however light."""
    stop = random.uniform(0.7, 0.95)
    x0, x1, x2, start = np.sort(random.uniform(0.05, 0.65, 4))
    return {
        "B": 10 ** random.uniform(-1, 2) if bends else None,
        "T": 10 ** random.uniform(1, 3),
        "L": 1.0,
        "mu": 0.1,
        "x0": x0,
        "m": 10 ** random.uniform(-12, 1),
        "x1": x1,
        "k": 10 ** random.uniform(-9, 5),
        "x2": x2,
        "M": 10 ** random.uniform(-10, -1),
        "f": 10 ** random.uniform(0, 2),
        "start": start,
        "stop": stop,
        "density": 1 + random.choice([-1, 1]) * 10 ** random.uniform(-6, -1),
    }


def scene_of(given):
    """The scene with these numbers."""
    one = {name: None if value is None else float(value) for name, value in given.items()}
    parts = (
        rd.PointMass(one["x0"], one["m"]),
        rd.Spring(one["x1"], one["k"]),
        rd.Resonator(one["x2"], one["M"], one["f"]),
        rd.LocalChange(one["start"], one["stop"], density=one["density"]),
    )
    rope = rd.Rope(one["L"], one["mu"], bending_stiffness=one["B"])
    return rd.Scene(rope, tension=one["T"], parts=parts)


def _rate(given, value, changed):
    mu = given["mu"] * (given["density"] if changed else 1)
    if given["B"] is None:
        return mpmath.matrix([[0, 1 / given["T"]], [-value * mu, 0]])
    return mpmath.matrix(
        [[0, 1, 0, 0], [0, 0, 0, 1 / given["B"]], [-value * mu, 0, 0, 0], [0, given["T"], -1, 0]]
    )


def _resistance(given, value):
    own = (2 * mpmath.pi * given["f"]) ** 2
    return {
        "x0": -value * given["m"],
        "x1": given["k"],
        "x2": -value * given["M"] / (1 - value / own),
    }


def _right_end(given, value, push=None, watch=None):
    """Return what the right end does by the states at the left one and by a push; watched too."""
    n = 2 if given["B"] is None else 4
    state = mpmath.zeros(n, n // 2 + 1)
    for i in range(n // 2):
        state[n // 2 + i, i] = 1
    stops = {given[name]: N for name, N in _resistance(given, value).items()}
    at, seen = mpf(0), None
    for x in sorted({*stops, given["start"], given["stop"], given["L"]} | {push, watch} - {None}):
        inside = given["start"] <= at < given["stop"]
        state = mpmath.expm(_rate(given, value, inside) * (x - at)) * state
        at = x
        seen = state[0, :] if x == watch else seen
        state[n // 2, :] += stops.get(x, 0) * state[0, :]
        if x == push:
            state[n // 2, n // 2] -= 1
    return state, seen


def determinant(given, value):
    """Zero at the eigenvalues, less what is infinite at the resonator's own."""
    state, _ = _right_end(given, value)
    n = state.rows // 2
    return mpmath.det(state[:n, :n])


def eigenvalue_slope(given, near, name):
    """The eigenvalue next to a number, and its derivative by what is named."""
    with mpmath.workdps(DIGITS):
        exact = {key: None if one is None else mpf(float(one)) for key, one in given.items()}
        value = mpmath.findroot(
            lambda x: determinant(exact, x), (mpf(near), near * (1 + mpf(10) ** -9)), tol=1e-90
        )
        by_p = _slope(lambda p: determinant(exact | {name: p}, value), exact[name])
        by_value = _slope(lambda x: determinant(exact, x), value)
        return float(value), float(-by_p / by_value)


def receptance_slope(given, frequency, push, watch, name):
    """The receptance between two places, and its derivative by what is named."""

    def at(p):
        numbers = exact | {name: p}
        value = (2 * mpmath.pi * mpf(frequency)) ** 2
        state, seen = _right_end(numbers, value, mpf(push), mpf(watch))
        n = state.rows // 2
        left = mpmath.lu_solve(state[:n, :n], -state[:n, n])
        return seen[n] + sum(seen[i] * left[i] for i in range(n))

    with mpmath.workdps(DIGITS):
        exact = {key: None if one is None else mpf(float(one)) for key, one in given.items()}
        return float(at(exact[name])), float(_slope(at, exact[name]))


def _slope(function, p):
    step = abs(p) * mpf(10) ** -24
    return (function(p + step) - function(p - step)) / (2 * step)
