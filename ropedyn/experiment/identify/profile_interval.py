"""Confidence bounds by profile likelihood, many side by side."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...base.array import Flags, Index, Real
from ..fitting.minimum import Point, Told, minimise
from ..fitting.misfit import Misfit

CLOSE = 1e-3  # A bound is known to this share of its distance: 1e-4 of what is covered.
ACCEPTED = 0.02  # A linear step may take off this share of the growth and leaves its square.
OTHERS = (-0.9, 9.0)  # Relative changes that others are guessed to have are between these.


@dataclass(frozen=True, eq=False)
class Profile:
    """How least sums of squares grow as numbers move off (Bates, Watts 1988, section 6.1)."""

    misfit: Misfit
    rows: Index  # (n,) of the misfit, one for each bound
    best: Real  # (n, p) variables where the sum of squares is least
    least: Real  # (n,) that
    i: Index  # (n,) the number
    path: Real  # (n, p) change of the best others, linearly, for a change of 1 of it
    by_factor: Flags  # (p,) numbers sought by logarithms, followed by their relative changes
    limit: Real  # (n,) largest distance, of a logarithm or another variable

    def bounds(self, side: NDArray[np.int_], root: Real, step: Real) -> Real:
        """Return u_i on one side, -1 or 1, where the root of the growth has a value, shape (n,)."""
        way = side.astype(float)
        most = np.where(side < 0, 1.0, np.expm1(self.limit))
        most = np.where(self.by_factor[self.i], most, self.limit)
        crossing = Crossing.of(root, np.minimum(step, 1.0), most)
        while len(crossing.going):
            at = crossing.going
            crossing.take(self._root(at, way[at] * crossing.step[at], ACCEPTED * root[at] ** 2))
        there = np.isfinite(crossing.found)
        each = np.arange(len(self.i))
        u = self._at(each, way * np.where(there, crossing.found, 0.0))[each, self.i]
        return np.where(there, u, way * np.inf)

    def _at(self, some: Index, distance: Real) -> Real:
        """Return the variables at distances, the others next to where they are best, (k, p)."""
        each, i = np.arange(len(some)), self.i[some]
        straight = distance[:, None] * self.path[some]
        change = np.where(self.by_factor, np.clip(straight, *OTHERS), 0.0)
        change[each, i] = 0.0
        moved = np.where(self.by_factor, np.log1p(change), straight)
        least = np.expm1(-self.limit[some])
        held = np.log1p(np.maximum(distance, least))
        moved[each, i] = np.where(self.by_factor[i], held, straight[each, i])
        return self.best[some] + moved

    def _root(self, some: Index, distance: Real, accepted: Real) -> Real:
        """Return the roots of the growth at distances, infinite where there is no scene, (k,)."""
        rows = self.rows[some]
        start = Point.of(self.misfit, rows, self._at(some, distance))
        cost = np.einsum("nm,nm->n", start.residual, start.residual)
        there = np.flatnonzero(np.isfinite(cost + start.slope.sum(axis=(1, 2))))
        left = np.full(len(some), np.inf)
        if not len(there):
            return left
        free = np.ones(self.path[some].shape, dtype=bool)
        free[np.arange(len(some)), self.i[some]] = False
        slope = start.slope[there] * free[there][:, None, :]
        along = Told.of(slope).along(start.residual[there])
        less = np.einsum("nq,nq->n", along, along)
        linear = less <= accepted[there]
        left[there[linear]] = cost[there[linear]] - less[linear]
        far = there[~linear]
        if len(far):
            found = minimise(self.misfit, rows[far], start.take(far), free[far])
            left[far] = np.where(found.reached, found.cost, np.inf)
        return np.sqrt(np.maximum(left - self.least[some], 0.0))


@dataclass(eq=False)
class Crossing:
    """Where increasing functions that are 0 at 0 have a value, infinite beyond a limit."""

    target: Real  # (n,)
    limit: Real  # (n,)
    step: Real  # (n,) where each is asked next
    found: Real  # (n,)
    going: Index  # that are not found
    low: Real  # (n,) below, with the values there
    at_low: Real
    high: Real  # (n,) above
    at_high: Real
    below: NDArray[np.int_]  # (n,) how often in a row it was below
    above: NDArray[np.int_]
    leap: Real  # (n,) by which it goes on at most

    @classmethod
    def of(cls, target: Real, step: Real, limit: Real) -> Crossing:
        """Begin with steps."""
        n = len(target)
        low, at_low = np.zeros(n), np.zeros(n)
        high, at_high = np.full(n, np.inf), np.full(n, np.inf)
        below, above = np.zeros(n, dtype=int), np.zeros(n, dtype=int)
        found, leap = np.full(n, np.nan), np.full(n, 3.0)
        each = low, at_low, high, at_high, below, above, leap
        return cls(target, limit, step.copy(), found, np.arange(n), *each)

    def take(self, value: Real) -> None:
        """Take the values where each was asked, and choose where to ask next."""
        at = self.going
        close = np.abs(value - self.target[at]) <= CLOSE * self.target[at]
        self.found[at[close]] = self.step[at[close]]
        at, value = at[~close], value[~close]
        under = value < self.target[at]
        self.low[at[under]], self.at_low[at[under]] = self.step[at[under]], value[under]
        self.high[at[~under]], self.at_high[at[~under]] = self.step[at[~under]], value[~under]
        self.below[at] = np.where(under, self.below[at] + 1, 0)
        self.above[at] = np.where(under, 0, self.above[at] + 1)
        held = np.isfinite(self.high[at])
        shut = held & (self.high[at] - self.low[at] <= 1e-6 * self.high[at])
        ends = at[shut]
        self.found[ends] = np.where(np.isfinite(self.at_high[ends]), self.high[ends], np.inf)
        beyond = ~held & (self.low[at] >= self.limit[at])
        self.found[at[beyond]] = np.inf
        self._narrow(at[held & ~shut])
        self._leap(at[~held & ~beyond])
        self.going = at[~(shut | beyond)]

    def _narrow(self, at: Index) -> None:
        """Ask between both sides."""
        low, high, at_low = self.low[at], self.high[at], self.at_low[at]
        halve = np.maximum(self.below[at], self.above[at]) > 2
        halve |= ~np.isfinite(self.at_high[at])
        rise = np.where(halve, 1.0, self.at_high[at] - at_low)
        secant = np.where(halve, 0.5, (self.target[at] - at_low) / rise)
        self.step[at] = low + (high - low) * np.clip(secant, 0.02, 0.98)

    def _leap(self, at: Index) -> None:
        """Ask further on."""
        low, at_low = self.low[at], self.at_low[at]
        rises = at_low > 0
        ahead = np.where(rises, low * self.target[at] / np.where(rises, at_low, 1.0), np.inf)
        ahead = np.minimum(np.maximum(ahead, 1.1 * low), self.leap[at] * low)
        self.step[at] = np.minimum(ahead, self.limit[at])
        self.leap[at] = np.minimum(self.leap[at] ** 2, 1e4)
