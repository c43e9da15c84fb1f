"""Least squares of many rows side by side, in the directions that what was measured tells."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from typing import NamedTuple

import numpy as np

from ...base.array import Flags, Index, Integer, Real
from ...base.computed import computed
from ...base.errors import SolveError
from .misfit import Misfit

TINY = float(np.finfo(float).tiny)
BLIND = 1e-8  # Singular values below this share of the largest are the rounding of derivatives.
ROUNDING = 1e-14  # Below this share of it no step goes along their directions.
FARTHEST = 23.0  # A variable leaves its start by at most so much, a logarithm of ten decades.
# ftol is the square of 1e-4 standard deviations, gtol the rounding of relative residuals.
DIGITS = {"ftol": 1e-8, "gtol": 1e-14, "xtol": 1e-13}
# The trust region measures first by factors e, then, for narrow valleys, by what residuals feel.
SCALES = ("factors", "slopes")
EVALUATIONS = 50  # With each of the scales residuals are computed so often at most.
NEARLY = 1.01  # A step that is longer than the trust region by less is within it.


class NotConverged(SolveError):
    """Of a row that needs more steps than it is given; users are told a `SolveError`."""


class Directions(NamedTuple):
    """Directions of the variables that change residuals, and how much."""

    of_rows: Real  # (n, m, q) orthonormal, of the residuals
    size: Real  # (n, q) singular values, the largest first; 0 where a direction is not told
    direction: Real  # (n, q, p) orthonormal, of the variables

    @classmethod
    def of(cls, slope: Real, least: float = BLIND) -> Directions:
        """Take the singular values of slopes, shape (n, m, p), those above a share of the first."""
        return cls(*np.linalg.svd(slope, full_matrices=False)).above(least)

    def above(self, least: float) -> Directions:
        """Return what is told by more than a share of the first."""
        floor = least * np.maximum(self.size[:, :1], TINY)
        return self._replace(size=self.size * (self.size > floor))

    def along(self, residual: Real) -> Real:
        """Return the parts of residuals that these directions change, shape (n, q)."""
        return np.einsum("nmq,nm->nq", self.of_rows, residual) * (self.size > 0)

    @property
    def inverse(self) -> Real:
        """1 over each singular value, 0 where that is, shape (n, q)."""
        return np.divide(1.0, self.size, out=np.zeros_like(self.size), where=self.size > 0)

    def basis(self, free: Flags | None = None) -> Real:
        """Return the directions as columns, shape (n, p, p): axes where all that is free is told.

        Columns are 0 beyond what is told.
        """
        n, q, p = self.direction.shape
        axes = np.ones((n, p)) if free is None else free.astype(float)
        basis = np.eye(p) * axes[:, None, :]
        partly = np.flatnonzero((self.size > 0).sum(axis=1) < axes.sum(axis=1))
        if len(partly):
            basis[partly] = 0.0
            shown = (self.size[partly] > 0)[:, :, None]
            basis[partly, :, :q] = (self.direction[partly] * shown).swapaxes(1, 2)
            basis[partly] *= axes[partly][:, :, None]
        return basis


@dataclass(frozen=True, eq=False)
class Point:
    """Where the residuals of rows were computed; NaN of rows that have none there."""

    u: Real  # (n, p)
    residual: Real  # (n, m)
    slope: Real  # (n, m, p)

    @computed
    def told(self) -> Directions:
        """What residuals tell there, above rounding."""
        return Directions.of(self.slope, ROUNDING)

    @classmethod
    def of(cls, misfit: Misfit, rows: Index, u: Real) -> Point:
        """Compute them."""
        return cls(u, *misfit(rows, u))

    def take(self, some: Index | Flags) -> Point:
        """Return some of the rows."""
        return Point(self.u[some], self.residual[some], self.slope[some])

    def put(self, some: Index, other: Point) -> None:
        """Replace some of the rows."""
        self.u[some], self.residual[some] = other.u, other.residual
        self.slope[some] = other.slope

    def copy(self) -> Point:
        """Return one that can be changed."""
        return Point(self.u.copy(), self.residual.copy(), self.slope.copy())


@dataclass(frozen=True, eq=False)
class Minimum:
    """Where the sum of squares of each row is least."""

    u: Real  # (n, p)
    residual: Real  # (n, m)
    slope: Real  # (n, m, p)
    evaluations: Integer  # (n,) of the residuals and their slopes
    reached: Flags  # (n,) whether it is one: False where the steps did not suffice

    @property
    def cost(self) -> Real:
        """Sum of squares, shape (n,)."""
        return np.einsum("nm,nm->n", self.residual, self.residual)

    @property
    def point(self) -> Point:
        """Where it is."""
        return Point(self.u, self.residual, self.slope)

    def take(self, some: Index) -> Minimum:
        """Return some of the rows."""
        return Minimum(*(getattr(self, item.name)[some] for item in fields(self)))

    def put(self, some: Index, other: Minimum) -> None:
        """Replace some of the rows."""
        for item in fields(self):
            getattr(self, item.name)[some] = getattr(other, item.name)

    def refusal(self, row: int) -> NotConverged:
        """Say that a row was not reached."""
        return NotConverged(
            f"identification must converge within {len(SCALES) * EVALUATIONS} steps, the last "
            f"ended at a sum of squares of {self.cost[row]:.3g}: give the scene better guesses"
        )


def minimise(
    misfit: Misfit,
    rows: Index,
    start: Point,
    free: Flags | None = None,
    *,
    digits: Mapping[str, float] = DIGITS,
) -> Minimum:
    """Find the least sums of squares of rows along directions that change residuals at the start.

    Variables that are not free, shape (n, p), stay.
    """
    told = start.told if free is None else Directions.of(start.slope * free[:, None, :], ROUNDING)
    descent = _Descent(misfit, rows, start, told.above(BLIND).basis(free), digits)
    descent.ahead = told if descent.plain else None
    going = np.flatnonzero(descent.basis.any(axis=(1, 2)))
    for scale in SCALES:
        if len(going):
            going = descent.along(going, scale)
    reached = np.ones(len(rows), dtype=bool)
    reached[going] = False
    here = descent.point
    return Minimum(here.u, here.residual, here.slope, descent.evaluations, reached)


@dataclass(eq=False)
class _Descent:
    """Steps of many rows along bases, y = 0 at the start; each has a trust region of its own.

    The steps are those of Branch, Coleman and Li, SIAM J. Sci. Comput. 21, p. 1, without bounds.
    """

    misfit: Misfit
    rows: Index  # (n,)
    start: Point
    basis: Real  # (n, p, p)
    digits: Mapping[str, float]
    plain: bool = field(init=False)  # whether the bases are axes
    ahead: Directions | None = field(default=None, init=False)  # where the next step begins
    evaluations: Integer = field(init=False)  # (n,)
    point: Point = field(init=False)  # the best
    y: Real = field(init=False)  # (n, p) of it
    unit: Real = field(init=False)  # (n, p) how far y goes for a step of 1
    radius: Real = field(init=False)  # (n,) of the trust region
    size: Real = field(init=False)  # (n,) of the largest slope at the start

    def __post_init__(self) -> None:
        n, p = self.start.u.shape
        self.plain = bool((self.basis == np.eye(p)).all())
        self.evaluations, self.point = np.zeros(n, dtype=np.int64), self.start.copy()
        self.y, self.unit, self.radius = np.zeros((n, p)), np.ones((n, p)), np.ones(n)
        self.size = self._felt(np.arange(n)).max(axis=1)

    def along(self, going: Index, scale: str) -> Index:
        """Take steps by a scale; return the rows that need more."""
        if scale == "slopes":
            self.unit[going] = np.inf
            self._measure(going)
            far = np.linalg.norm(self.y[going] / self.unit[going], axis=1)
            self.radius[going] = np.where(far > 0, far, 1.0)
        for _ in range(EVALUATIONS):
            going = self._step(going)
            if not len(going):
                break
            if scale == "slopes":
                self._measure(going)
        return going

    def _measure(self, going: Index) -> None:
        """Let steps be as long as what residuals feel of them, at their largest slope so far."""
        felt = self._felt(going) / self.size[going, None]
        unit = np.divide(1.0, felt, out=np.ones_like(felt), where=felt > 0)
        self.unit[going] = np.minimum(self.unit[going], unit)

    def _felt(self, going: Index) -> Real:
        """Return what residuals feel of each direction of the bases, shape (k, p)."""
        slope = self._slope(going)
        return np.sqrt(np.einsum("nmp,nmp->np", slope, slope))

    def _slope(self, going: Index) -> Real:
        """Return slopes along the bases, shape (k, m, p)."""
        slope = self.point.slope[going]
        return slope if self.plain else slope @ self.basis[going]

    def _step(self, going: Index) -> Index:
        """Try a step of each row; return the rows that need another."""
        told, self.ahead = self.ahead, None
        if told is None:
            told = Directions.of(self._slope(going) * self.unit[going, None, :], ROUNDING)
        residual = self.point.residual[going]
        cost, along = np.einsum("nm,nm->n", residual, residual), told.along(residual)
        # end where a linear step would gain too little
        gain = np.where(told.size > BLIND * told.size[:, :1], along, 0.0)
        enough = self.digits["ftol"] * cost + (self.digits["gtol"] * self.size[going]) ** 2
        more = np.einsum("nq,nq->n", gain, gain) > enough
        if not more.all():
            if not more.any():
                return going[:0]
            going, cost, along = going[more], cost[more], along[more]
            told = Directions(*(one[more] for one in told))
        radius = self.radius[going]
        step = _within(told, along, radius)
        length, bent = np.linalg.norm(step, axis=1), told.size * step
        expected = -np.einsum("nq,nq->n", bent, bent / 2 + along)
        moved = np.einsum("nqp,nq->np", told.direction, step) * self.unit[going]
        gained = (cost - self._try(going, moved, cost)) / 2
        ratio = np.divide(gained, expected, out=np.zeros_like(gained), where=expected > 0)
        narrow, wide = ~(ratio >= 0.25), (ratio > 0.75) & (length > 0.95 * radius)
        self.radius[going] = np.where(narrow, length / 4, np.where(wide, 2 * radius, radius))
        tiny = self.digits["xtol"] * (self.digits["xtol"] + np.linalg.norm(self.y[going], axis=1))
        flat = (gained < self.digits["ftol"] * cost / 2) & (ratio > 0.25)
        settled = np.linalg.norm(moved, axis=1) < tiny
        return going[~np.isfinite(gained) | ~(flat | settled)]

    def _try(self, going: Index, moved: Real, cost: Real) -> Real:
        """Move rows where that makes their sums of squares less; return these."""
        y = self.y[going] + moved
        start = self.start.u[going]
        u = start + (y if self.plain else np.einsum("npq,nq->np", self.basis[going], y))
        held = np.clip(u, start - FARTHEST, start + FARTHEST)
        there = Point.of(self.misfit, self.rows[going], held)
        self.evaluations[going] += 1
        anew = np.einsum("nm,nm->n", there.residual, there.residual)
        anew[~np.isfinite(anew + there.slope.sum(axis=(1, 2)))] = np.inf
        better = anew < cost
        at, there, clipped = going[better], there.take(better), (held != u)[better]
        if clipped.any():
            row, i = np.nonzero(clipped)
            there.slope[row, :, i] = 0.0
        self.y[at] = y[better]
        self.point.put(at, there)
        return anew


def _within(told: Directions, along: Real, radius: Real) -> Real:
    """Return the best steps that are no longer than a radius, by directions, shape (n, q).

    Of min |S w + along|^2 + alpha |w|^2 the length falls as alpha grows; 1/length is nearly linear
    and concave, so that Newton's steps from alpha = 0 come from one side (More, Lecture Notes in
    Mathematics 630, p. 105).
    """
    square, alpha = told.size**2, np.zeros(len(radius))
    shown = told.size > 0
    while True:
        share = square + alpha[:, None]
        w = np.divide(told.size * along, share, out=np.zeros_like(along), where=shown)
        length = np.linalg.norm(w, axis=1)
        far = length > NEARLY * radius
        if not far.any():
            return -w * np.minimum(1.0, radius / np.maximum(length, radius))[:, None]
        bend = np.sum(np.divide(w * w, share, out=np.zeros_like(w), where=shown), axis=1)
        change = (length / radius - 1) * length**2 / np.where(far, bend, 1.0)
        alpha = alpha + np.where(far, change, 0.0)
