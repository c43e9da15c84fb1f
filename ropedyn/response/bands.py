"""Bands of lines, of which a few tell the others: what is interpolated ends below resonances."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..base.array import Index, Real
from ..base.chebyshev import nodes_of, weights

FEW = 64  # Lines that are as soon solved one by one.
REACH = 16.0  # Between the highest and the lowest that are crossed by the same parts.


def bands(frequency: Real, *, few: int = FEW) -> Iterator[Index]:
    """Yield lines by increasing frequency, no less than a share of their highest but for a few."""
    left = np.argsort(frequency, kind="stable")
    while len(left):
        below = int((frequency[left] < frequency[left[-1]] / REACH).sum())
        begin = below if below >= few else 0
        yield left[begin:]
        left = left[:begin]


def is_many(frequency: Real) -> bool:
    """Whether increasing frequencies are many, and not one."""
    return len(frequency) >= FEW and bool(frequency[0] < frequency[-1])


def between(frequency: Real, count: int) -> tuple[Real, Real]:
    """Return nodes [Hz] of the band of increasing frequencies, and what they count for at each."""
    low, width = frequency[0], np.ptp(frequency)
    return low + width * nodes_of(count), weights(count, (frequency - low) / width)
