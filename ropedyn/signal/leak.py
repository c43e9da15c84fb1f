"""How much of the motion a record of a hit lacks behind its end, and had before its beginning.

At a resonance a record is A e^(-g t): what its last fifth and the fifth before it add to the
transform are as q = e^(-g T/5) to 1, and all that comes behind them, q + q^2 + .. times the last
one, is what it lacks. What moved before shows in the fifth before the record, beside its first one.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Index, Real

PARTS = 5  # A record has so many.
HIGH = 0.2  # Peaks that are as high as this part of the highest are looked at.
PUSHED = 0.1  # Lines with less than this part of the largest force are not.
TINY = float(np.finfo(float).tiny)
SLOWEST = 0.9  # The motion is said to decay by this factor at least from part to part.


class Leak(NamedTuple):
    """What records have too little or too much."""

    share: float  # the most at a peak, in parts of the response
    size: Real  # (responses, lines) at each line, as the response


def lacking(force: Complex, moved: Real, lines: Index) -> Leak:
    """Return what comes behind records of motion, (hits, responses, t).

    The force is the transform of each hit, (hits, f), of which some lines are looked at.
    """
    n = moved.shape[-1]
    part = n // PARTS
    power = (np.abs(force) ** 2).sum(axis=0)
    whole, last, before = (
        np.abs(np.einsum("hf,hrf->rf", force.conj(), np.fft.rfft(moved * _only(n, *which))))
        for which in ((0, n), (n - part, n), (n - 2 * part, n - part))
    )
    share, more = 0.0, 0.0
    for peaks, row, end, earlier in zip(_peaks(whole, power, lines), whole, last, before):
        q = np.minimum(end[peaks] / np.maximum(earlier[peaks], TINY), SLOWEST)
        more = max(more, float((q / (1 - q)).max(initial=0.0)))
        lost = end[peaks] / row[peaks] * q / (1 - q)
        share = max(share, float(lost.max(initial=0.0)))
    return Leak(min(share, 1.0), (more * last / power)[:, lines])


def carried(force: Complex, moved: Real, prior: Sequence[Real], lines: Index) -> Leak:
    """Return what of the motion was there before, (responses, t) before each hit."""
    n = moved.shape[-1]
    part = n // PARTS
    power = (np.abs(force) ** 2).sum(axis=0)
    whole = np.abs(np.einsum("hf,hrf->rf", force.conj(), np.fft.rfft(moved)))
    first = _rms(np.fft.rfft(moved[..., :part], n))
    early = _rms(np.stack([np.fft.rfft(one[:, -part:], n) for one in prior]))
    share = 0.0
    for peaks, one, row in zip(_peaks(whole, power, lines), early, first):
        share = max(share, float((one[peaks] / row[peaks]).max(initial=0.0)))
    size = early / np.sqrt(power / len(moved))
    return Leak(min(share, 1.0), size[:, lines])


def _rms(each: Complex) -> Real:
    """Return the root mean square over hits."""
    return np.asarray(np.sqrt((np.abs(each) ** 2).mean(axis=0)))


def _only(n: int, first: int, stop: int) -> Real:
    """Return 1 for some of n samples, 0 for the others."""
    weight = np.zeros(n)
    weight[first:stop] = 1.0
    return weight


def _peaks(whole: Real, power: Real, lines: Index) -> list[Index]:
    """Return at which lines each response, (responses, f), has its high peaks."""
    from scipy.signal import find_peaks

    lines = lines[power[lines] > PUSHED**2 * power.max()]
    found = []
    for row in whole[:, lines] / power[lines]:
        at, _ = find_peaks(row, height=HIGH * row.max(), prominence=HIGH * row.max() / 2)
        found.append(lines[at])
    return found
