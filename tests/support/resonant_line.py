"""Random undamped lines at, and next to, frequencies where a response vanishes or has no bound."""

import typing

import mpmath
import numpy as np
from exact_chain import Exact, omega_of
from exact_span import Continuum, Law, coupled
from mpmath import mpf
from random_scene import random_line, random_spans
from stored import stored

import ropedyn as rd

GRID, STEPS = 12, 56
MOST_ELEMENTS = 32
MOST_RADIANS = 200.0
"""Of the waves on a rope of 1 m."""


class Resonant(typing.NamedTuple):
    """A line, and what answers it exactly."""

    model: rd.Model
    frequency: float
    drive: tuple[str, float]
    response: tuple[str, float]
    exact: mpf


@stored
def crossing(exact, drive, response, low, high, which):
    """The double next to a frequency where a real response changes its sign, None without any.

    It passes 0 at an antiresonance and infinity at a resonance.
    """

    def sign(f):
        try:
            return mpmath.sign(exact.receptance(omega_of(f), drive, [response])[0])
        except ZeroDivisionError:
            return 0

    grid = np.geomspace(low, high, GRID).tolist()
    signs = [sign(f) for f in grid]
    changes = [k for k in range(GRID - 1) if signs[k] * signs[k + 1] < 0]
    if not changes:
        return None
    k = changes[int(which * len(changes))]
    a, b = mpf(grid[k]), mpf(grid[k + 1])
    for _ in range(STEPS):
        middle = (a + b) / 2
        if sign(middle) == signs[k]:
            a = middle
        else:
            b = middle
    return float(a)


@stored
def exact_value(exact, f, drive, response):
    """The response, None on a resonance."""
    try:
        return exact.receptance(omega_of(f), drive, [response])[0]
    except ZeroDivisionError:
        return None


def slowed(scene, coordinates, f):
    """A frequency, less by decades where the waves on the rope are more than some."""
    while Law(scene, coordinates, 1, 1, -(omega_of(f) ** 2)).wavenumber > MOST_RADIANS:
        f /= 10
    return f


def resonant_line(seed, kind):
    """A line of a random chain or of random continuous spans, None where none is found."""
    random = np.random.default_rng([seed, 20])
    share, side, power = random.uniform(), random.choice([-1, 1]), random.uniform(2, 17)
    if kind == "chain":
        line = random_line(seed)
        count = min(len(line.model.x) - 1, MOST_ELEMENTS)
        if count < len(line.model.x) - 1:
            return None
        model = line.model.scene.replace(damping=None).compile(
            elements=count, element=line.model.element
        )
        x = model.x.tolist()
        nodes = line.drive, line.response
        points = [(c, x[k]) for c, k in nodes]
        exact, f = Exact(model, model.component_of(line.drive[0])), line.frequency
    else:
        scene, f, *points = random_spans(seed)
        scene = scene.replace(damping=None)
        model, nodes = scene.compile(), points
        exact = Continuum(scene, coupled(scene, points[0][0]))
    f = slowed(model.scene, exact.coordinates, f or 1.0)
    with mpmath.workdps(60):
        at = crossing(exact, *nodes, f / 3, f, share)
        if at is None:
            return None
        f = at * (1 + float(side) * 10**-power)
        h = exact_value(exact, f, *nodes)
    return None if h is None else Resonant(model, f, *points, h)
