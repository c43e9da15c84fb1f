"""Strings with masses that hang between two points: their curve, and elements on it."""

import itertools
import math

import numpy as np
import scipy.optimize
from hung_rods import SHARE


def at_rest(scene):
    """Level tension [N], upward force at the left end [N] and arc length [m], by shooting."""
    rope, g = scene.rope, scene.gravity.g
    w, psi, L = rope.linear_density * g, scene.gravity.inclination, rope.length
    tension = getattr(scene.tension, "mean", scene.tension)
    share = SHARE[getattr(scene.tension, "at", "middle")]

    def end_of(level, up, long):
        """Where a rope of this arc length ends, leg by leg: dX/ds = H/T and dZ/ds = V/T."""
        place, before = np.zeros(2), 0.0
        for at, mass in [*((p.x / L, p.mass) for p in scene.parts), (1.0, 0.0)]:
            below, up = up, up + w * long * (at - before)
            climbs = np.arcsinh(np.array([below, up]) / level)
            place += level / w * np.array([np.ptp(climbs), np.diff(np.cosh(climbs))[0]])
            up, before = up + mass * g, at
        return place

    def force_at(level, up, long):
        hangs = sum(p.mass for p in scene.parts if p.x <= share * L)
        up += w * share * long + g * hangs
        return level * math.cos(psi) + up * math.sin(psi)

    def missed(unknown):
        level, up, long = unknown * [tension, tension, L]
        wrong = end_of(level, up, long) / L - [math.cos(psi), math.sin(psi)]
        return [*wrong, force_at(level, up, long) / tension - 1]

    start = [math.cos(psi), math.sin(psi) - 0.5 * w * L / tension, 1.01]
    found, _, done, _ = scipy.optimize.fsolve(missed, start, xtol=1e-13, full_output=True)
    assert done == 1 and np.abs(missed(found)).max() < 1e-11
    return found * [tension, tension, L]


def frequencies(scene, solve, *, number, each=4):
    """Frequencies of one plane [Hz], of so many elements between masses."""
    level, up, long = at_rest(scene)
    rope, g = scene.rope, scene.gravity.g
    w = rope.linear_density * g
    places = long * np.array([p.x / rope.length for p in scene.parts])
    weights = np.array([p.mass * g for p in scene.parts])

    def rest(s):
        force = up + w * s + weights @ (places[:, None] < s)
        return (
            np.hypot(level, force),
            np.arctan2(force, level),
            rope.linear_density,
            rope.axial_stiffness,
        )

    # equal steps of the slope's angle, and so of the curvature
    edges = [0.0]
    for k, (a, b) in enumerate(itertools.pairwise([0.0, *places, long])):
        less = up + weights[:k].sum()
        climb = np.arcsinh((less + w * np.array([a, b])) / level)
        edges += [*((level * np.sinh(np.linspace(*climb, each + 1)[1:-1]) - less) / w), b]
    edges = np.array(edges)
    mass = np.zeros(len(edges) - 2)
    mass[each - 1 :: each] = [p.mass for p in scene.parts]
    return solve(edges, rest, mass, number=number)
