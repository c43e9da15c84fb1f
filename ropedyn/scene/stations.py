"""Where the nodes of a chain stand."""

from __future__ import annotations

import heapq
from collections.abc import Iterable, Sequence

import numpy as np

from ..base.array import Index, Real
from ..base.check import NEAR
from ..base.errors import SceneError


def stations_at(length: float, positions: Iterable[float]) -> Real:
    """Return the ends and the positions of parts in order, near ones merged."""
    margin = NEAR * length
    inner = sorted(x for x in positions if margin < x < length - margin)
    kept = [0.0]
    for x in inner:
        if x - kept[-1] > margin:
            kept.append(x)
    return np.array([*kept, length])


def nearest(stations: Real, positions: Sequence[float]) -> Index:
    """Return the number of the station next to each position."""
    between = (stations[1:] + stations[:-1]) / 2
    return between.searchsorted(positions)


def shares(lengths: Real, elements: int) -> Index:
    """Share out elements over spans so that the longest element is as short as can be."""
    if elements < len(lengths):
        raise SceneError(
            f"elements must be at least {len(lengths)}, one for each stretch between stations, "
            f"got {elements}"
        )
    # every span has at least this many in the end
    counts = np.floor(lengths / lengths.sum() * (elements - len(lengths))).astype(np.intp)
    counts = np.maximum(counts, 1)
    left = elements - int(counts.sum())
    # only so many of the longest can have one more
    longest = np.argsort(-lengths / counts, kind="stable")[:left]
    heap = [(-float(lengths[i] / counts[i]), int(i)) for i in longest]
    for _ in range(left):
        _, i = heap[0]
        counts[i] += 1
        heapq.heapreplace(heap, (-float(lengths[i] / counts[i]), i))
    return counts
