"""Noise on the lines of a measured frequency response, as a fit leaves it."""

from __future__ import annotations

import numpy as np

from ...base.array import Complex, Real
from ...curves.measured import Measured

LEAST = 1e-12  # Noise below this share of a line is rounding.
LIKELIER = 2.0  # Two kinds of noise are likelier than one by at least this logarithm (Akaike: 1).
FAINT = 1e-12  # A kind of noise that has less than this part is none.


def line_std(measured: Measured, off: Complex) -> Real:
    """Estimate the standard deviation of real and imaginary part of each line, a^2 + b^2 |H|^2.

    Where coherence C was measured the first kind is what that tells, a^2 |H|^2 (1 - C)/C, as of n
    averages with a^2 = 1/2n (J. S. Bendat, A. G. Piersol, Random Data, 2010, section 9.2).
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

    A second kind that is not there would be found where a few high lines happen to be off by more.
    """
    each = np.array([_alone(kind, square) for kind in kinds])
    alone = [np.array([each[0], 0.0]), np.array([0.0, each[1]])]
    likeliest = min(alone, key=lambda size: _unlikely(size, kinds, square)[0])
    both = _together(kinds, square, each)
    gain = _unlikely(likeliest, kinds, square)[0] - _unlikely(both, kinds, square)[0]
    return both if gain > LIKELIER else likeliest


def _alone(kind: Real, square: Real) -> float:
    """Return the likeliest size of one kind."""
    there = kind > 0
    return max(float(np.mean(square[there] / kind[there])), LEAST**2) if there.any() else 0.0


def _together(kinds: Real, square: Real, start: Real) -> Real:
    """Return the likeliest sizes of both, sought by their logarithms from less than either."""
    from scipy.optimize import minimize

    if not start.all():
        return start

    def of(u: Real) -> tuple[float, Real]:
        size = start * np.exp(u)
        value, slope = _unlikely(size, kinds, square)
        return value, slope * size

    bounds = [(np.log(FAINT), 0.0)] * 2
    found = minimize(of, np.full(2, -1.0), jac=True, method="L-BFGS-B", bounds=bounds)
    return np.asarray(start * np.exp(found.x))


def _unlikely(size: Real, kinds: Real, square: Real) -> tuple[float, Real]:
    """Return -ln of the likelihood, sum of ln v + square/v, and its slopes by the sizes."""
    variance = size @ kinds
    if not (variance > 0).all():
        return np.inf, np.zeros(2)
    slope = kinds @ (1 / variance - square / variance**2)
    return float(np.sum(np.log(variance) + square / variance)), slope
