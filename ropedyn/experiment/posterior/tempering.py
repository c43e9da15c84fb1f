"""Points that follow a density from what was known beforehand to what is known after."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Index, Real
from .ridge import Cloud, Ridge

KEPT = 0.8  # A stage is as long as leaves this share of the points in effect.
FIRST = 4  # So many times the points are drawn beforehand: narrow valleys are seen by some.
ENDING = 3  # Rounds of moves after the last stage.
LEAP = 0.1  # Share of the differential moves that lead from one valley to another.
LENGTH = 2.4  # Longest move in units of the local metric, by the root of the variables.


@dataclass(frozen=True, eq=False)
class Tempered:
    """Points of equal weight, and how they came about."""

    cloud: Cloud
    stages: int
    accepted: float  # share of the moves after the last stage
    refused: float  # share of the first points that are no rope


def tempered(ridge: Ridge, n: int, rng: np.random.Generator) -> Tempered:
    """Draw points beforehand and lead them to what is known after (Del Moral, Doucet and Jasra).

    Raises
    ------
    RopedynError
        If none of the first points is a rope that the family can solve.
    """
    space = ridge.space
    u, tied = space.draw(rng, FIRST * n, ridge.freedom)
    here = ridge.cloud(u, tied, np.full(len(u), np.log(space.tension)))
    there = np.isfinite(here.likelihood)
    if not there.any():
        raise ridge.refusal(here)
    walk = _Walk(ridge, rng, here)
    walk.advance(n, n)
    stages = 1
    while walk.power < 1.0:
        walk.move()
        walk.advance(n, KEPT * n)
        stages += 1
    walk.tried = walk.taken = 0
    for _ in range(ENDING):
        walk.move()
    return Tempered(walk.here, stages, walk.taken / max(walk.tried, 1), 1.0 - float(there.mean()))


@dataclass(eq=False)
class _Walk:
    """Points, and the power of the likelihood that they feel."""

    ridge: Ridge
    rng: np.random.Generator
    here: Cloud
    power: float = 0.0
    tried: int = 0
    taken: int = 0

    def advance(self, n: int, least: float) -> None:
        """Let the points feel more of the likelihood, and draw n of them by it."""
        gain = self.here.likelihood - self.here.likelihood.max()
        step = _step(gain, 1.0 - self.power, least)
        self.power = min(1.0, self.power + step)
        self.here = self.here.take(_drawn(np.exp(step * gain), n, self.rng))

    def move(self) -> None:
        """Try to move every point in two ways."""
        if not self.ridge.space.size:
            return
        n = len(self.here)
        some = self.rng.permutation(n)
        one, other = some[: n // 2], some[n // 2 :]
        self._differential(one, other)
        self._differential(other, one)
        for tied in (False, True):
            self._local(np.flatnonzero(self.here.tied == tied), tied=tied)

    def _differential(self, mine: Index, theirs: Index) -> None:
        """Move by differences of two others (ter Braak, Statistics and Computing 16, p. 239)."""
        space, (u, tied) = self.ridge.space, (self.here.u, self.here.tied)
        length = np.where(self.rng.random(len(mine)) < LEAP, 1.0, 2.38 / np.sqrt(2 * space.size))
        move = np.zeros((len(mine), space.size))
        for alike in (False, True):
            some, others = np.flatnonzero(tied[mine] == alike), theirs[tied[theirs] == alike]
            if len(others) >= 2:
                first, second = others[self.rng.integers(0, len(others), (2, len(some)))]
                move[some] = u[first] - u[second]
        self._try(mine, space.reflected(u[mine] + length[:, None] * move))

    def _local(self, some: Index, *, tied: bool) -> None:
        """Move by the local covariance of least squares (Girolami, Calderhead, without drift).

        J. R. Stat. Soc. B 73, p. 123.
        """
        if not len(some):
            return
        free = self.ridge.space.directions(tied=tied)
        n, d = len(some), free.shape[1]
        factor = self._metric(self.here.take(some), free)
        length = self.rng.uniform(0.1, 1.0, n) * LENGTH / np.sqrt(d)
        step = self.rng.standard_normal((n, d)) * length[:, None]
        move = np.linalg.solve(factor.swapaxes(1, 2), step[:, :, None])[:, :, 0]
        there = self._cloud(some, self.here.u[some] + move @ free.T)
        back = self._metric(there, free)
        returning = np.einsum("nij,ni->nj", back, move)
        off = (returning**2 - step**2).sum(axis=1) / length**2
        self._accept(some, there, _log_size(back) - _log_size(factor) - off / 2)

    def _metric(self, cloud: Cloud, free: Real) -> Real:
        """Return the Cholesky factors of what is known of free directions, shape (n, d, d)."""
        slope = np.where(np.isfinite(cloud.slope), cloud.slope, 0.0) @ free
        known = free.T @ self.ridge.space.precision @ free
        told = known + self.power * slope.swapaxes(1, 2) @ slope
        return np.asarray(np.linalg.cholesky(told), float)

    def _cloud(self, some: Index, u: Real) -> Cloud:
        return self.ridge.cloud(u, self.here.tied[some], self.here.log_tension[some])

    def _try(self, some: Index, u: Real) -> None:
        self._accept(some, self._cloud(some, u), np.zeros(len(some)))

    def _accept(self, some: Index, there: Cloud, returning: Real) -> None:
        """Take what Metropolis and Hastings take; `returning` is ln of the ratio of proposals."""
        here = self.here.take(some)
        gain = there.base - here.base + self.power * (there.likelihood - here.likelihood)
        taken = np.log(self.rng.random(len(some))) < gain + returning
        self.here.put(some[taken], there.take(taken))
        self.tried, self.taken = self.tried + len(some), self.taken + int(taken.sum())


def _log_size(factor: Real) -> Real:
    return np.log(np.diagonal(factor, axis1=1, axis2=2)).sum(axis=1)


def _step(gain: Real, most: float, least: float) -> float:
    """Return the power at which weights leave so many points in effect (Kish), at most `most`."""
    from scipy.optimize import brentq

    finite = gain[np.isfinite(gain)]
    least = min(least, KEPT * len(finite))

    def excess(power: float) -> float:
        weight = np.exp(power * finite)
        return float(weight.sum() ** 2 / (weight**2).sum() - least)

    return most if excess(most) >= 0 else float(brentq(excess, 0.0, most, rtol=1e-6))


def _drawn(weight: Real, n: int, rng: np.random.Generator) -> Index:
    """Draw n points by their weights, systematically."""
    edge = np.cumsum(weight)
    at = (rng.random() + np.arange(n)) / n * edge[-1]
    return np.minimum(np.searchsorted(edge, at, side="right"), len(weight) - 1)
