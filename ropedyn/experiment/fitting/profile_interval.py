"""Confidence bounds by profile likelihood, many side by side."""

from __future__ import annotations

from collections.abc import Generator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...base.array import Flags, Index, Real
from .minimum import Directions, Point, minimise
from .misfit import Misfit

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
        found = np.zeros(len(root))
        searches = list(map(_crossing, root, np.minimum(step, 1.0), most))
        asked = np.array([next(search) for search in searches])
        going = np.arange(len(root))
        while len(going):
            value = self._root(going, (way * asked)[going], ACCEPTED * root[going] ** 2)
            ends = np.zeros(len(going), dtype=bool)
            for j, (k, one) in enumerate(zip(going, value.tolist())):
                try:
                    asked[k] = searches[k].send(one)
                except StopIteration as end:
                    found[k], ends[j] = end.value, True
            going = going[~ends]
        there = np.isfinite(found)
        each = np.arange(len(found))
        u = self._at(each, way * np.where(there, found, 0.0))[each, self.i]
        return np.where(there, u, way * np.inf)

    def _at(self, some: Index, distance: Real) -> Real:
        """Return the variables at distances, the others next to where they are best, (k, p)."""
        each, i = np.arange(len(some)), self.i[some]
        straight = distance[:, None] * self.path[some]
        change = np.where(self.by_factor, np.clip(straight, *OTHERS), 0.0)
        change[each, i] = 0.0
        moved = np.where(self.by_factor, np.log1p(change), straight)
        with np.errstate(divide="ignore"):
            held = np.maximum(np.log1p(np.maximum(distance, -1.0)), -self.limit[some])
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
        along = Directions.of(slope).along(start.residual[there])
        less = np.einsum("nq,nq->n", along, along)
        linear = less <= accepted[there]
        left[there[linear]] = cost[there[linear]] - less[linear]
        far = there[~linear]
        if len(far):
            found = minimise(self.misfit, rows[far], start.take(far), free[far])
            left[far] = np.where(found.reached, found.cost, np.inf)
        return np.sqrt(np.maximum(left - self.least[some], 0.0))


def _crossing(target: float, step: float, limit: float) -> Generator[float, float, float]:
    """Ask values of an increasing function that is 0 at 0, and return where it is `target`.

    Infinite beyond a limit.
    """
    low, at_low, high, at_high = 0.0, 0.0, np.inf, np.inf
    below, above, leap = 0, 0, 3.0
    while True:
        value = yield step
        if abs(value - target) <= CLOSE * target:
            return step
        if value < target:
            low, at_low, below, above = step, value, below + 1, 0
        else:
            high, at_high, below, above = step, value, 0, above + 1
        if np.isfinite(high):
            if high - low <= 1e-6 * high:
                return high if np.isfinite(at_high) else np.inf
            halve = max(below, above) > 2 or not np.isfinite(at_high)
            secant = 0.5 if halve else (target - at_low) / (at_high - at_low)
            step = low + (high - low) * min(max(secant, 0.02), 0.98)
        elif low >= limit:
            return np.inf
        else:
            ahead = low * target / at_low if at_low > 0 else np.inf
            step, leap = min(max(ahead, 1.1 * low), leap * low, limit), min(leap**2, 1e4)
