"""What changes along a piece, by a polynomial through its values at samples."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from ..base.array import Real
from ..base.chebyshev import fitted, nodes_of, weights

SAMPLES = 14
"""Of a piece along which something changes."""
NODES = 14
"""Between which triples of its parts are interpolated."""
ORDERS = 14
"""Of a part's series."""
ROUNDED = 1e-15
"""Coefficients that are less, of the largest value, are none."""
NOTHING = 1e-19
"""Terms of a part's series that are less, relative, are none."""


def resampled(values: Real, begin: Real, end: Real) -> Real:
    """Return the samples (pieces, samples, ..) of a part of each, begin and end from 0 to 1."""
    samples = values.shape[1]
    if samples == 1:
        return values
    places = begin[:, None] + (end - begin)[:, None] * nodes_of(samples)
    found: Real = np.einsum("pts,ps...->pt...", weights(samples, places), values)
    return found


def tail(values: Real) -> float:
    """Return how large the last two coefficients are beside the largest value, of axis 0."""
    coefficients = np.tensordot(fitted(len(values)), values, axes=1)
    size = np.abs(values).max(axis=0)
    least = np.abs(coefficients[-2:]).max(axis=0)
    return float(np.divide(least, size, where=size > 0, out=np.zeros_like(size)).max())


def coefficients(values: Any) -> Any:
    """Return Chebyshev coefficients of samples, axis -4 of matrices (3, 6, 6); none of rounding.

    Their series about an end would multiply what is of rounding by up to 3 + sqrt(8) to the order.
    """
    samples = values.shape[-4]
    if samples == 1:
        return values
    rows = np.ascontiguousarray(values).reshape(*values.shape[:-3], -1)
    found = (fitted(samples) @ rows.view(np.float64)).view(rows.dtype).reshape(values.shape)
    parts = [found.real, found.imag] if np.iscomplexobj(found) else [found]
    for part, given in zip(parts, [values.real, values.imag]):
        part[np.abs(part) <= ROUNDED * np.abs(given).max(axis=-4, keepdims=True)] = 0.0
    return found


def series_of(length: float, halved: int, samples: int, equal: int = 1) -> Real:
    """Return the series of the parts of a piece that begin its doubling, as the core takes them.

    They are the halved ones of so many equal parts, (nodes, samples, ORDERS): of Chebyshev's
    polynomials, by powers of s from the left end.
    """
    scale = float(length) ** -np.arange(ORDERS)
    found: Real = _unit_series(int(halved), samples, equal) * scale
    return found


@lru_cache(64)
def _unit_series(halved: int, samples: int, equal: int) -> Real:
    if samples == 1:
        return np.eye(1, ORDERS)[None]
    part = 0.5**halved / equal
    few = halved < 30 and equal * 2**halved <= NODES
    node = np.cos((2 * np.arange(NODES) + 1) * np.pi / (2 * NODES))
    begin = part * np.arange(equal * 2**halved) if few else (1 - part) * (1 + node) / 2
    series = np.zeros((len(begin), samples, ORDERS))
    own: Any = np.eye(samples)
    factor = 1.0
    for k in range(min(samples, ORDERS)):
        # powers of s - begin, in lengths of the piece, where x runs twice as fast
        value = factor * chebyshev.chebval(2 * begin - 1, own).T
        series[:, :, k] = np.where(np.abs(value) * part**k > NOTHING, value, 0.0)
        own, factor = chebyshev.chebder(own, axis=0), factor * 2 / (k + 1)
    return series
