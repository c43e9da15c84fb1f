"""Polynomials through values at Chebyshev's nodes of the first kind, from 0 to 1."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.polynomial import chebyshev

from .array import Real


def nodes_of(count: int) -> Real:
    """Return where they are, increasing, from 0 to 1: the middle where there is one."""
    angle = (2 * np.arange(count) + 1) * np.pi / (2 * count)
    return np.array((1 - np.cos(angle)) / 2, dtype=np.float64)


@lru_cache(64)
def fitted(count: int) -> Real:
    """Return Chebyshev coefficients, in x from -1 to 1, of what is 1 at one node, in columns."""
    at_nodes = chebyshev.chebvander(2 * nodes_of(count) - 1, count - 1)
    return np.array(np.linalg.inv(at_nodes), dtype=np.float64)


def weights(count: int, places: Real) -> Real:
    """Return what nodes count for at places from 0 to 1, shape places + (count,).

    By the barycentric formula (Berrut and Trefethen 2004).
    """
    angle = (2 * np.arange(count) + 1) * np.pi / (2 * count)
    far = np.asarray(places)[..., None] - nodes_of(count)
    own = far == 0
    weight = np.sin(angle) * (-1.0) ** np.arange(count) / np.where(own, 1.0, far)
    weight = np.where(own.any(axis=-1, keepdims=True), own, weight)
    found: Real = weight / weight.sum(axis=-1, keepdims=True)
    return found
