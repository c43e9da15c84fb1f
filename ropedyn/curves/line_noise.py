"""Noise on the lines of a measured frequency response."""

from __future__ import annotations

import numpy as np

from ..base.array import Complex, Real

AROUND = 41
"""Lines that the median of the differences goes over: narrow peaks are few of them."""

LEAST = 12
"""Lines below which nothing is said."""


def by_coherence(value: Complex, coherence: Real, averages: float) -> Real:
    """Return the standard deviation of real and of imaginary part of each line.

    var |H|/|H|^2 = (1 - gamma^2)/(2 n gamma^2) for n averages, and as much for the phase: J. S.
    Bendat, A. G. Piersol, Random Data (2010), table 9.6.
    """
    share = np.maximum(coherence, np.finfo(float).tiny)
    return np.abs(value) * np.sqrt((1 - coherence) / (2 * averages * share))


def by_differences(value: Complex) -> Real | None:
    """Estimate that from the lines alone, None where they are too few.

    What is smooth has small third differences y_0 - 3 y_1 + 3 y_2 - y_3, noise large ones: |.|^2 is
    distributed as 40 sigma^2 times an exponential variable, whose median is ln 2.
    """
    from scipy.ndimage import median_filter

    if len(value) < LEAST:
        return None
    size = np.abs(np.diff(value, 3)) / np.sqrt(40 * np.log(2))
    return np.pad(median_filter(size, AROUND, mode="nearest"), (1, 2), mode="edge")
