"""Confidence bounds by profile likelihood."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...base.array import Flags, Real
from ...base.errors import SceneError, SolveError
from ..fitting.minimum import Minimum, minimise, told_directions
from ..fitting.misfit import Misfit

CLOSE = 1e-3  # A bound is known to this share of its distance: 1e-4 of what is covered.
ACCEPTED = 0.02  # A linear step may take off this share of the growth and leaves its square.
OTHERS = (-0.9, 9.0)  # Relative changes that others are guessed to have are between these.


@dataclass(frozen=True, eq=False)
class Profile:
    """How the least sum of squares grows as a number moves off (Bates, Watts 1988, section 6.1)."""

    misfit: Misfit
    minimum: Minimum
    i: int  # the number
    path: Real  # (p,) change of the best others, linearly, for a change of 1 of it
    by_factor: Flags  # (p,) numbers sought by logarithms, followed by their relative changes
    limit: float  # largest distance, of a logarithm or another variable

    def bound(self, side: int, root: float, step: float) -> float:
        """Return u_i where the root of the growth has a value."""

        def off(distance: float) -> float:
            return self._root(side * distance, ACCEPTED * root**2)

        most = self.limit
        if self.by_factor[self.i]:
            most = 1.0 if side < 0 else float(np.expm1(self.limit))
        distance = _crossing(off, root, min(step, 1.0), most)
        if np.isinf(distance):
            return side * np.inf
        return float(self._at(side * distance)[self.i])

    def _at(self, distance: float) -> Real:
        """Return the variables at a distance, the others next to where they are best."""
        change = np.where(self.by_factor, np.clip(distance * self.path, *OTHERS), 0.0)
        change[self.i] = 0.0
        moved = np.where(self.by_factor, np.log1p(change), distance * self.path)
        if self.by_factor[self.i]:
            least = np.expm1(-self.limit)
            moved[self.i] = np.log1p(max(distance, least))
        return self.minimum.u + moved

    def _root(self, distance: float, accepted: float) -> float:
        """Return the root of the growth at a distance, infinite where there is no scene."""
        others = np.delete(np.eye(len(self.path)), self.i, axis=1)
        start = self._at(distance)
        try:
            residual, slope = self.misfit(start)
            free = slope @ others
            along, _ = np.linalg.qr(free @ told_directions(free))
            left, less = float(residual @ residual), float(np.sum((along.T @ residual) ** 2))
            if less > accepted:
                left, less = minimise(self.misfit, start, others).cost, 0.0
        except (SceneError, SolveError):
            return np.inf
        return float(np.sqrt(max(left - less - self.minimum.cost, 0.0)))


def _crossing(root: Callable[[float], float], target: float, step: float, limit: float) -> float:
    """Return where an increasing function that is 0 at 0 is `target`, infinite beyond a limit."""
    low, at_low, high, at_high = 0.0, 0.0, np.inf, np.inf
    below, above, leap = 0, 0, 3.0
    while True:
        value = root(step)
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
