"""Quantiles of numbers whose points are each a Student's distribution of their logarithm."""

from __future__ import annotations

import numpy as np

from ...base.array import Real


def quantile(value: Real, scale: Real, freedom: float, share: float) -> float:
    """Return that of points of equal weight, values and scales of their logarithms (n,)."""
    if not scale.any():
        return float(np.quantile(value, share))
    from scipy.optimize import brentq
    from scipy.special import stdtr, stdtrit

    middle = np.log(value)
    ends = middle + scale * float(stdtrit(freedom, share))

    def excess(x: float) -> float:
        return float(stdtr(freedom, (x - middle) / scale).mean()) - share

    low, high = float(ends.min()), float(ends.max())
    if excess(low) >= 0 or excess(high) <= 0:
        return float(np.exp(low if excess(low) >= 0 else high))
    return float(np.exp(brentq(excess, low, high, xtol=1e-10, rtol=1e-12)))


def variance_of(scale: Real, freedom: float) -> float:
    """Return the mean variance of Student's distributions, of their scales where there is none."""
    return float(np.mean(scale**2)) * (freedom / (freedom - 2) if freedom > 2 else 1.0)
