"""Gauss points for products of waves and of what decays from the ends of a stretch of rope."""

from __future__ import annotations

import functools
import math

import numpy as np

from ..base.array import Real

DEEP = 40.0
"""What decays as exp(-s) is nothing beyond: 4e-18."""

MOST = 128
"""Radians in one panel."""


def rule(waves: float, decay: float) -> tuple[Real, Real]:
    """Return points and weights that integrate products of two such functions to rounding.

    n points are exact up to the degree 2 n - 1. Products of waves, exp(2 i k x) over a length h,
    are polynomials of degree k h and some (k h)^(1/3) more, those of what decays, exp(-2 a x), of
    degree 8 sqrt(a h), to 1e-16. Layers that are thin beside the stretch get panels of their own.
    """
    points, weights = [], []
    for begin, end, deep in _panels(decay):
        wide = waves * (end - begin)
        count = max(1, math.ceil(wide / MOST))
        each, width = wide / count, (end - begin) / count
        x, w = _gauss(math.ceil(6 + each / 2 + 5 * np.cbrt(each) + 4 * math.sqrt(deep)))
        points += [begin + width * (k + x) for k in range(count)]
        weights += [width * w] * count
    return np.concatenate(points), np.concatenate(weights)


def _panels(decay: float) -> list[tuple[float, float, float]]:
    """Return begin, end and how much decays within, layers and what lies between them."""
    if decay <= 4 * DEEP:
        return [(0.0, 1.0, decay)]
    layer = DEEP / decay
    return [(0.0, layer, DEEP), (layer, 1 - layer, 0.0), (1 - layer, 1.0, DEEP)]


@functools.lru_cache(maxsize=128)
def _gauss(n: int) -> tuple[Real, Real]:
    """Return Gauss points and weights on (0, 1)."""
    x, w = np.polynomial.legendre.leggauss(n)
    return (1 + x) / 2, w / 2
