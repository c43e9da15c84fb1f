"""Resonances of several responses as one list."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .resonance import Resonances

Real = NDArray[np.float64]


class Merged(NamedTuple):
    """Peaks of all responses, one for each mode, lowest first."""

    frequency: Real
    """(k,) [Hz]."""
    std: Real
    """(k,) [Hz], NaN where it is not known."""
    damping_ratio: Real
    """(k,) NaN where it is not known."""


def merged(found: Sequence[Resonances]) -> Merged:
    """Merge what lies within the half widths of both: means weighted with squares of amplitudes."""
    frequency, ratio = (
        np.concatenate([getattr(one, name) for one in found])
        for name in ("frequency", "damping_ratio")
    )
    scaled = [one.amplitude / one.amplitude.max(initial=0.0) for one in found]
    weight = np.concatenate(scaled) ** 2
    # between two resonances an amplitude may have a hump that is none
    order = np.argsort(frequency, kind="stable")
    order = order[np.abs(ratio[order]) < 0.5]
    frequency, ratio, weight = frequency[order], ratio[order], weight[order]
    width = np.abs(ratio) * frequency
    apart = np.diff(frequency) > width[1:] + width[:-1]
    group = np.append(0, np.cumsum(apart))[: len(frequency)]
    total = np.bincount(group, weight)
    return Merged(
        np.bincount(group, weight * frequency) / total,
        np.full(len(total), np.nan),
        np.bincount(group, weight * ratio) / total,
    )
