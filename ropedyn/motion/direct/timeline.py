"""When motion is looked at, when what pushes it breaks, and the steps between."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ...base.array import Flags, Index, Real

ROUNDING = 16 * np.finfo(float).eps  # Times closer than this part of the last one are one time.


class Block(NamedTuple):
    """Equal steps one after another."""

    first: int  # Interval that they begin in
    steps: int
    h: float  # [s]
    time: Real  # (steps + 1,) where they begin and end [s]
    # (marks,) step after which a mark is reached, of the marks after `first` one by one
    ends: Index


@dataclass(frozen=True, eq=False)
class Timeline:
    """Marks that steps end at, and how many steps lie between two of them."""

    mark: Real  # (marks,) [s], increasing
    asked: Index  # (marks,) number of the time that is there, -1 where there is none
    seen: Index  # (marks,) number of the snapshot, likewise
    breaks: Flags  # (marks,) where forces jump or bend; the first mark is one
    count: Index  # (marks - 1,) steps in each interval
    h: Real  # (marks - 1,) their length [s], the same number where it differs by rounding

    @property
    def near(self) -> float:
        """What times are known to [s]."""
        return float(ROUNDING * self.mark[-1])

    @property
    def steps(self) -> int:
        """How many there are."""
        return int(self.count.sum())

    def finer(self, factor: int) -> Timeline:
        """Return it with each step cut into so many."""
        return replace(self, count=self.count * factor, h=self.h / factor)

    def at(self, when: float) -> int:
        """Return the mark at a time, -1 where there is none."""
        k = int(np.abs(self.mark - when).argmin())
        return k if abs(self.mark[k] - when) <= 2 * self.near else -1

    def blocks(self, most: int) -> Iterator[Block]:
        """Yield the steps in order, at most so many at once, with breaks and snapshots between."""
        begins = np.ones(len(self.mark), dtype=np.bool_)
        stops = self.breaks | (self.seen >= 0)
        same = (np.diff(self.h) == 0) & (np.diff(self.count) == 0)
        begins[1:-1] = stops[1:-1] | ~same
        edges = np.flatnonzero(begins)
        for i, j in zip(edges[:-1].tolist(), edges[1:].tolist()):
            count = int(self.count[i])
            if count > most:
                for k in range(i, j):
                    yield from self._parts(k, most)
                continue
            for k in range(i, j, most // count):
                yield self._whole(k, min(k + most // count, j))

    def _whole(self, i: int, j: int) -> Block:
        """Return the steps of the intervals from mark i to mark j."""
        count = int(self.count[i])
        each = np.diff(self.mark[i : j + 1]) / count
        time = (self.mark[i:j, None] + each[:, None] * np.arange(count)).ravel()
        time = np.append(time, self.mark[j])
        ends = count * np.arange(1, j - i + 1) - 1
        return Block(i, len(time) - 1, float(self.h[i]), time, ends)

    def _parts(self, i: int, most: int) -> Iterator[Block]:
        """Yield the steps of one interval."""
        count, start, stop = int(self.count[i]), self.mark[i], self.mark[i + 1]
        each = (stop - start) / count
        for k in range(0, count, most):
            last = min(k + most, count)
            time = start + each * np.arange(k, last + 1)
            ends = np.array([last - k - 1] if last == count else [], dtype=np.intp)
            if last == count:
                time[-1] = stop
            yield Block(i, last - k, float(self.h[i]), time, ends)


def timeline(
    time: Real, snapshots: Real, breaks: Iterable[float], most: Callable[[Real, Real], Real]
) -> Timeline:
    """Return when to stop and how many steps to take between."""
    near = float(ROUNDING * time[-1])
    extra: list[float] = []
    for at in sorted((*snapshots.tolist(), *breaks)):
        k = int(np.searchsorted(time, at))
        beside = time[max(k - 1, 0) : k + 1]
        is_new = not extra or at - extra[-1] > near
        if is_new and time[0] < at < time[-1] and (np.abs(beside - at) > near).all():
            extra.append(at)
    mark = np.sort(np.concatenate([time, extra]))
    count = np.ceil(np.diff(mark) / most(mark[:-1], mark[1:]) * (1 - 1e-9)).astype(np.intp)
    count = np.maximum(count, 1)
    return Timeline(
        mark=mark,
        asked=_numbers(mark, time, near),
        seen=_numbers(mark, snapshots, near),
        breaks=_numbers(mark, np.array([time[0], *breaks]), near) >= 0,
        count=count,
        h=_alike(np.diff(mark) / count, near),
    )


def _numbers(mark: Real, when: Real, near: float) -> Index:
    """Return the number of the time at each mark, -1 where there is none."""
    number = np.full(len(mark), -1, dtype=np.intp)
    if len(when) == 0:
        return number
    right = np.searchsorted(mark, when).clip(1, len(mark) - 1)
    at = np.where(np.abs(mark[right] - when) <= np.abs(when - mark[right - 1]), right, right - 1)
    close = np.abs(mark[at] - when) <= near
    number[at[close]] = np.flatnonzero(close)
    return number


def _alike(length: Real, near: float) -> Real:
    """Return lengths with one number, their mean, for those that differ by rounding."""
    order = np.argsort(length, kind="stable")
    group = np.empty(len(length), dtype=np.intp)
    group[order] = np.cumsum(np.diff(length[order], prepend=0.0) > near)
    size = np.bincount(group)
    with np.errstate(invalid="ignore"):
        mean = np.bincount(group, length) / size
    return np.asarray(mean[group])
