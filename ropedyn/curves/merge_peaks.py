"""Peaks of several responses as one list."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..base.array import Real
from ..base.errors import SceneError
from .curves import Curves
from .resonance import Resonances

APART = 3.0  # Peaks that differ by less than so many standard uncertainties are one.


class Merged(NamedTuple):
    """Each is (k,), over peaks of rising frequency."""

    frequency: Real
    std: Real
    damping_ratio: Real


class _ResponsePeak(NamedTuple):
    """A peak of one response."""

    frequency: float
    std: float
    ratio: float
    ratio_std: float
    response: int
    near: float  # another response may have the same peak so far from here [Hz]


def merge_peaks(source: Curves | Sequence[Resonances]) -> Merged:
    """Return the peaks of all responses, those of one mode as their weighted mean."""
    # peaks of different responses are of one mode if they are nearer than a line, or than half the
    # width of the peak at half its power, or than 3 of their standard uncertainties. Its
    # uncertainty is that of the mean, by the scatter where that is more (R. T. Birge, Physical
    # Review 40 (1932) 207-227)
    if isinstance(source, Curves):
        peaks = [one for d in range(len(source.drive)) for one in source.peaks(d)]
        lines = np.unique(source.frequency)
    else:
        peaks, lines = list(source), np.zeros(1)
    seen = sorted(s for r, one in enumerate(peaks) for s in _seen(one, r, lines))
    if not seen:
        raise SceneError("measured must have at least one peak, got none")
    means = [_mean(group) for group in _groups(seen)]
    return Merged(*(np.array(column) for column in zip(*means)))


def _seen(peaks: Resonances, response: int, lines: Real) -> list[_ResponsePeak]:
    found = []
    for f, std, ratio, ratio_std in zip(
        peaks.frequency.tolist(),
        peaks.std.tolist(),
        peaks.damping_ratio.tolist(),
        peaks.damping_ratio_std.tolist(),
    ):
        at = min(max(int(np.searchsorted(lines, f)), 1), len(lines) - 1)
        spacing = float(lines[at] - lines[at - 1]) if len(lines) > 1 else 0.0
        if f > 0:
            found.append(
                _ResponsePeak(f, std, ratio, ratio_std, response, max(spacing, abs(ratio) * f))
            )
    return found


def _groups(seen: Sequence[_ResponsePeak]) -> list[list[_ResponsePeak]]:
    """Put peaks of one mode together, one of each response at most."""
    groups: list[list[_ResponsePeak]] = []
    for one in seen:
        last = groups[-1] if groups else []
        if last and one.response not in {other.response for other in last}:
            before = last[-1]
            far = max(one.near, before.near, APART * float(np.hypot(one.std, before.std)))
            if one.frequency - before.frequency <= far:
                last.append(one)
                continue
        groups.append([one])
    return groups


def _mean(group: Sequence[_ResponsePeak]) -> tuple[float, float, float]:
    """Return the weighted mean of frequency, its uncertainty, and that of the damping ratio."""
    if len(group) == 1:
        (one,) = group
        return one.frequency, one.std, one.ratio
    f, std = np.array([s.frequency for s in group]), np.array([s.std for s in group])
    # what a fit of clean numbers leaves is 0
    std = np.maximum(std, np.finfo(float).eps * f)
    weight = 1 / std**2
    mean = float(np.average(f, weights=weight))
    error = 1 / np.sqrt(weight.sum())
    scatter = float(np.sum(weight * (f - mean) ** 2)) / (len(group) - 1)
    error *= max(1.0, np.sqrt(scatter))
    return mean, float(error), _ratio(group)


def _ratio(group: Sequence[_ResponsePeak]) -> float:
    ratio = np.array([s.ratio for s in group])
    std = np.array([s.ratio_std for s in group])
    weight = 1 / np.maximum(std, np.finfo(float).eps) ** 2
    return float(np.average(ratio, weights=weight if weight.any() else None))
