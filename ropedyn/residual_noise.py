"""Noise on the lines of a measured frequency response, as a fit leaves it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .measured import Measured

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]

LEAST = 1e-12
"""Of a line: less is rounding."""

TURNS = 100
"""Most of the iterations."""


def line_std(measured: Measured, off: Complex) -> Real:
    """Estimate the standard deviation of real and imaginary part of each line.

    Each response has noise of its own, the sum of two kinds whose sizes a and b the differences
    tell: equal on all lines, and in proportion to the amplitude,

        var = a^2 + b^2 |H|^2.

    Where coherence C was measured the first kind is what that tells, a^2 |H|^2 (1 - C)/C, as of n
    averages with a^2 = 1/2n (J. S. Bendat, A. G. Piersol, Random Data, 2010, section 9.2).

    Parameters
    ----------
    measured : Measured
    off : ndarray of complex, shape (responses, f)
        Differences of a fitted response.

    Returns
    -------
    ndarray, shape (responses, f)
        Infinite where the coherence is 0.
    """
    std = np.empty(off.shape)
    for r, value in enumerate(measured.value):
        power = np.abs(value) ** 2
        first = np.full(power.shape, power.mean())
        if measured.coherence is not None:
            share = measured.coherence[r]
            with np.errstate(divide="ignore"):
                first = power * np.where(share > 0, (1 - share) / share, np.inf)
        told = np.isfinite(first) & (power > 0)
        std[r] = np.inf
        size = _most_likely(np.stack([first[told], power[told]]), np.abs(off[r][told]) ** 2 / 2)
        std[r, told] = np.sqrt(size @ np.stack([first[told], power[told]]))
    return std


def _most_likely(kinds: Real, square: Real) -> Real:
    """Return the sizes of kinds of variance, (2,), that make squares of differences most likely.

    Expectation and maximisation: each square is shared out as its variances are. The squares are
    means of two, those of the real and of the imaginary part.

    Parameters
    ----------
    kinds : ndarray, shape (2, m)
    square : ndarray, shape (m,)
    """
    present = kinds.max(axis=1, initial=0.0) > 0
    size = np.where(present, 1.0, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = np.where(kinds > 0, 1 / kinds, 0.0)
    size *= np.array([np.median(square * one) for one in inverse]) if square.size else 0.0
    least = LEAST**2
    size = np.where(present, np.maximum(size, least), 0.0)
    for _ in range(TURNS):
        parts = size[:, None] * kinds
        total = parts.sum(axis=0)
        share = parts / total
        # of each kind: what of the square is its own, and what its own variance leaves open
        own = share**2 * square + share * (total - parts)
        counted = kinds > 0
        with np.errstate(divide="ignore", invalid="ignore"):
            each = np.where(counted, own / kinds, 0.0)
        after = each.sum(axis=1) / np.maximum(counted.sum(axis=1), 1)
        after = np.where(present, np.maximum(after, least), 0.0)
        if np.allclose(after, size, rtol=1e-3):
            break
        size = after
    return size
