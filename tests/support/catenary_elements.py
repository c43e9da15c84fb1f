"""In-plane frequencies of a string that hangs, by Legendre elements on its true curve."""

import math

import numpy as np
import scipy.linalg
from numpy.polynomial import legendre


def integrated(degree, at):
    """Integrated Legendre polynomials, the ends' first, and their derivatives on [-1, 1]."""
    value, rate = np.zeros((2, degree + 1, len(at)))
    value[0], value[1], rate[0], rate[1] = (1 - at) / 2, (1 + at) / 2, -0.5, 0.5
    unit = np.eye(degree + 1)
    for k in range(2, degree + 1):
        value[k] = legendre.legval(at, unit[k] - unit[k - 2]) / math.sqrt(2 * (2 * k - 1))
        rate[k] = math.sqrt((2 * k - 1) / 2) * legendre.legval(at, unit[k - 1])
    return value, rate


def elements(edges, rest, mass=(), *, number, degree=12):
    """Frequencies [Hz] of a string in its plane: `rest` gives T, the slope and mu and EA at s."""
    at, weight = legendre.leggauss(degree + 6)
    value, rate = integrated(degree, at)
    count = len(edges) - 1
    nodes = count * degree + 1
    stiff, heavy = np.zeros((2, 2 * nodes, 2 * nodes))
    for k in range(count):
        half = (edges[k + 1] - edges[k]) / 2
        tension, slope, density, axial = rest(edges[k] + half * (1 + at))
        own = np.array([k * degree, (k + 1) * degree, *(k * degree + np.arange(1, degree))])
        both = np.concatenate([own, own + nodes])
        cos, sin, d = np.cos(slope), np.sin(slope), rate / half
        strain, turn = np.concatenate([cos * d, sin * d]), np.concatenate([-sin * d, cos * d])
        energy = (strain * axial * weight) @ strain.T + (turn * tension * weight) @ turn.T
        stiff[np.ix_(both, both)] += half * energy
        for one in (own, own + nodes):
            heavy[np.ix_(one, one)] += half * (value * density * weight) @ value.T
    for k, one in enumerate(mass, start=1):
        for node in (k * degree, k * degree + nodes):
            heavy[node, node] += one
    held = [0, nodes - 1, nodes, 2 * nodes - 1]
    free = np.setdiff1d(np.arange(2 * nodes), held)
    return lowest(stiff[np.ix_(free, free)], heavy[np.ix_(free, free)], number)


def aside(edges, rest, mass=(), *, number, degree=12):
    """Frequencies [Hz] of the same string out of that plane, where the tension alone pulls back."""
    at, weight = legendre.leggauss(degree + 6)
    value, rate = integrated(degree, at)
    nodes = (len(edges) - 1) * degree + 1
    stiff, heavy = np.zeros((2, nodes, nodes))
    for k in range(len(edges) - 1):
        half = (edges[k + 1] - edges[k]) / 2
        tension, _, density, _ = rest(edges[k] + half * (1 + at))
        own = np.array([k * degree, (k + 1) * degree, *(k * degree + np.arange(1, degree))])
        stiff[np.ix_(own, own)] += (rate * tension * weight) @ rate.T / half
        heavy[np.ix_(own, own)] += half * (value * density * weight) @ value.T
    for k, one in enumerate(mass, start=1):
        heavy[k * degree, k * degree] += one
    free = np.setdiff1d(np.arange(nodes), [0, nodes - 1])
    return lowest(stiff[np.ix_(free, free)], heavy[np.ix_(free, free)], number)


def lowest(stiff, heavy, number):
    """The lowest frequencies [Hz], as largest of the inverse: rounding goes with the largest."""
    last = len(stiff) - 1
    value = scipy.linalg.eigh(
        heavy, stiff, eigvals_only=True, subset_by_index=[last - number + 1, last]
    )
    return 1 / np.sqrt(value[::-1]) / (2 * math.pi)


def of_catenary(scene, *, number, count=4, solve=elements):
    """Frequencies on the catenary between the ends, in closed form."""
    rope, gravity = scene.rope, scene.gravity
    turned, w = gravity.inclination, rope.linear_density * gravity.g
    level = scene.tension * math.cos(turned)
    c, chord = level / w, rope.length
    span, rise = chord * math.cos(turned), chord * math.sin(turned)
    middle = c * math.asinh(rise / (2 * c * math.sinh(span / (2 * c))))
    start, stop = (c * math.sinh((middle + side * span / 2) / c) for side in (-1, 1))

    def rest(s):
        return np.hypot(level, w * s), np.arctan(w * s / level), rope.linear_density, axial

    axial = rope.axial_stiffness
    return solve(np.linspace(start, stop, count + 1), rest, number=number)
