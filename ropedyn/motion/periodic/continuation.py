"""Branches of solutions of G(x, p) = 0, by pseudo-arclength.

A step goes along the tangent, bent as it was on the step before, and returns to the curve in the
plane across it. It is accepted while the tangent turns little: that alone tells whether a resonance
was passed.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...base.array import Flags, Real
from ...base.errors import SolveError

TURN, SLIGHT = 0.5, 0.25  # The tangent turns by at most so much a step; by less it grows [rad].
GROWTH = 1.6  # So much.
LONGEST, SHORTEST = 1.0, 1e-9  # Steps, in parts of the motion and of the scale of the parameter.
ASTRAY, FAR = 0.5, 0.25  # A step returns to the curve from this part of its length, and at most.
NEWTON = 10  # Steps of Newton's method at most.
ENOUGH = 1e-7  # Its last one, relative: what it leaves is about the square of that.
ROUGHLY = 3e-3  # Its last one of what is only on the way, over the length of the step.
SHARPLY = 1e-10  # On a fold its tangent, which is that of the step before, has to be known.
BESIDE = (1e-4, 1e-3, 1e-2, 1e-1)  # So far to both sides a fold is looked for again.
PLENTY = 3  # A step that takes more is not followed by a longer one.

Linearise = Callable[[Real, Any], tuple[Real, Real, Real]]
"""From x and p to G, dG/dx and dG/dp; from several, (b, n) and (b,), to as many of each."""


class Place(NamedTuple):
    """A point of a branch."""

    x: Real
    p: float
    along: Real  # tangent, of x
    up: float  # tangent, of p


class Stuck(SolveError):
    """Raised where a branch cannot be followed on."""


@dataclass(eq=False)
class Branch:
    """A curve, followed."""

    linearise: Linearise
    place: Place
    scale: float  # of p
    small: float  # motion that is as good as none
    called: Callable[[float], str]  # what p is
    step: float = 0.05  # the next one
    bend: Real | float = 0.0  # how the tangent changed along the last one, of x and p

    def advance(self) -> Place:
        """Take one step, however short it must be; return where it ends."""
        before = self.place
        while self.step >= SHORTEST:
            reached = self.reached(before, self.step, self.bend, ROUGHLY * self.step)
            if reached is not None:
                place, turns, off = reached
                angle = self._angle(before, place)
                if angle <= TURN and off <= min(ASTRAY * self.step, FAR):
                    turned = np.append(place.along - before.along, place.up - before.up)
                    self.bend = turned / self.step
                    if angle <= SLIGHT and turns <= PLENTY:
                        self.step = min(GROWTH * self.step, LONGEST)
                    self.place = place
                    return place
            self.step /= 2
        where = self.called(before.p)
        raise Stuck(f"steady motion cannot be followed beyond {where}: no step is short enough")

    def reached(
        self, before: Place, step: float, bend: Real | float = 0.0, enough: float = ENOUGH
    ) -> tuple[Place, int, float] | None:
        """Return where a step along the tangent leads, its Newton steps and how far it was off."""
        size = self._size(before.x)
        ahead = step * np.append(before.along, before.up) + step**2 / 2 * bend
        x, p = before.x + ahead[:-1], before.p + float(ahead[-1])
        row = np.append(before.along / size**2, before.up / self.scale**2)
        off, n = np.zeros(len(x) + 1), len(x) + 1
        matrix, right = np.zeros((n, n)), np.zeros((n, 2))
        matrix[-1], right[-1, 1] = row, 1.0
        for turn in range(NEWTON):
            G, J, by_p = self.linearise(x, p)
            matrix[:-1, :-1], matrix[:-1, -1], right[:-1, 0] = J, by_p, -G
            try:
                change, tangent = np.linalg.solve(matrix, right).T
            except np.linalg.LinAlgError:
                return None
            x, p, off = x + change[:-1], p + float(change[-1]), off + change
            far = np.hypot(np.linalg.norm(change[:-1]) / size, change[-1] / self.scale)
            if not far < 1e3 * max(step, 1.0) or not p > 0:
                return None
            if far <= enough:
                away = np.hypot(np.linalg.norm(off[:-1]) / size, off[-1] / self.scale)
                return self._unit(x, p, tangent), turn + 1, float(away)
        return None

    def turned(self, up: float) -> None:
        """Begin where the branch is, so that p goes up or down."""
        place = self.place
        _, J, by_p = self.linearise(place.x, place.p)
        tangent = np.append(np.linalg.solve(J, -by_p), 1.0) * up
        self.place, self.bend = self._unit(place.x, place.p, tangent), 0.0

    def settle(self, x: Real, p: float) -> Real | None:
        """Return roughly the solution at p near x, None if Newton's method finds none."""
        found, is_found = self.settled(x[None], np.array([p]), ROUGHLY)
        return found[0] if is_found[0] else None

    def settled(self, x: Real, p: Real, enough: float = ENOUGH) -> tuple[Real, Flags]:
        """Return the solutions at each p near each x, (b, n), and which of them were found."""
        x, is_found, left = x.copy(), np.zeros(len(p), dtype=np.bool_), np.arange(len(p))
        for _ in range(NEWTON):
            G, J, _ = self.linearise(x[left], p[left])
            change = _solved(J, -G)
            x[left] += change
            far = np.linalg.norm(change, axis=-1)
            far /= np.maximum(np.linalg.norm(x[left], axis=-1), self.small)
            is_found[left] = far <= enough
            left = left[(far > enough) & np.isfinite(far)]
            if not len(left):
                break
        return x, is_found

    def between(self, before: Place, after: Place, p: float) -> Real:
        """Return about the solution at p between two places, by Hermite's cubic."""
        d = after.p - before.p
        s = (p - before.p) / d if d else 0.0
        slopes = [place.along * (d / place.up) if place.up else 0.0 for place in (before, after)]
        guess = (1 + 2 * s) * (1 - s) ** 2 * before.x + s**2 * (3 - 2 * s) * after.x
        guess = guess + s * (1 - s) ** 2 * slopes[0] - s**2 * (1 - s) * slopes[1]
        if not np.linalg.norm(guess - before.x) <= 2 * np.linalg.norm(after.x - before.x):
            guess = before.x + s * (after.x - before.x)
        return np.asarray(guess)

    def fold(self, before: Place, after: Place, *, enough: float = ENOUGH) -> Place | None:
        """Return where p turns between two places, None where steps do not lead there."""
        from scipy.optimize import brentq

        size = self._size(before.x)
        whole = np.dot(after.x - before.x, before.along) / size**2
        whole += (after.p - before.p) * before.up / self.scale**2
        found: dict[float, Place] = {0.0: before, float(whole): after}

        def up(step: float) -> float:
            if step not in found:
                reached = self.reached(before, step, enough=enough)
                if reached is None:
                    raise SolveError("a step leads nowhere")
                found[step] = reached[0]
            return found[step].up

        try:
            root = brentq(up, 0.0, float(whole), xtol=1e-2 * enough, rtol=1e-2 * enough, maxiter=50)
        except (SolveError, ValueError):
            return None
        up(float(root))
        return found[float(root)]

    def fold_near(self, place: Place) -> Place | None:
        """Return where p turns beside a place, None where it does not."""
        for step in BESIDE:
            both = [self.reached(place, way) for way in (-step, step)]
            if both[0] is None or both[1] is None:
                return None
            if both[0][0].up * both[1][0].up < 0:
                return self.fold(both[0][0], both[1][0], enough=SHARPLY)
        return None

    def _size(self, x: Real) -> float:
        return max(float(np.linalg.norm(x)), self.small)

    def _unit(self, x: Real, p: float, tangent: Real) -> Place:
        long = np.hypot(np.linalg.norm(tangent[:-1]) / self._size(x), tangent[-1] / self.scale)
        return Place(x, p, tangent[:-1] / long, float(tangent[-1] / long))

    def _angle(self, before: Place, after: Place) -> float:
        """Return by how much the tangent turned [rad]."""
        size = self._size(before.x)
        a = np.append(before.along / size, before.up / self.scale)
        b = np.append(after.along / size, after.up / self.scale)
        a, b = a / np.linalg.norm(a), b / np.linalg.norm(b)
        return float(2 * np.arctan2(np.linalg.norm(a - b), np.linalg.norm(a + b)))


def _solved(J: Real, right: Real) -> Real:
    """Solve systems, (b, n, n) and (b, n); what is singular has no number."""
    try:
        return np.asarray(np.linalg.solve(J, right[..., None])[..., 0])
    except np.linalg.LinAlgError:
        if len(J) == 1:
            return np.full_like(right, np.nan)
        return np.concatenate([_solved(J[k : k + 1], right[k : k + 1]) for k in range(len(J))])
