"""Evidence of orders: the likelihood of the peaks over all that is not known, by Laplace.

With chi2 the least sum of squares of (ln f - ln f*)/s over m peaks that are modes the likelihood is
Student's of nu degrees of freedom for all together; at its maximum with |v|^2/2, what is known,

    ln Z = ln t_nu(chi2; m) - sum ln s - |v|^2/2 - ln det(I + a J^T J)/2, a = (nu + m)/(nu + chi2)

(D. MacKay, Information Theory, Inference, and Learning Algorithms, 2003, ch. 27 and 28).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Index, Integer, Real
from ...base.errors import RopedynError, SolveError
from ..fitting.minimum import Minimum, Point, minimise
from .chances import Chances
from .standardised import Standardised

FREEDOM = 10.0  # nu
ENOUGH = {"ftol": 1e-4, "gtol": 1e-9, "xtol": 1e-6}
"""Fits end where a step would gain 1e-4 of the sum of squares."""
NOISES = (0.0003, 0.001, 0.003, 0.01)
"""Relative standard deviations of peaks that have none, as probable as each other."""


@dataclass(frozen=True, eq=False)
class RatioMisfit:
    """Differences of ln f of many orders from the same peaks, and of v from what is expected."""

    standardised: Standardised
    log_measured: Real  # (k,)
    std: Real  # (k,) relative
    orders: Integer  # (h, k) from 1; 0 of a peak that is no mode, whose difference is 0

    def __call__(self, rows: Index, u: Real) -> tuple[Real, Real]:
        """Return residuals (n, k + p) and their slopes."""
        orders = self.orders[rows]
        log_frequency, slope = self.standardised(u, int(orders.max(initial=1)))
        at, used = np.maximum(orders - 1, 0), orders > 0
        off = np.take_along_axis(log_frequency, at, 1) - self.log_measured
        slope = np.take_along_axis(slope, at[:, :, None], 1) / self.std[:, None]
        off, slope = np.where(used, off / self.std, 0.0), np.where(used[:, :, None], slope, 0.0)
        unit = np.broadcast_to(np.eye(u.shape[1]), (len(u), u.shape[1], u.shape[1]))
        return np.concatenate([off, u], axis=1), np.concatenate([slope, unit], axis=1)

    def refusal(self, row: int, u: Real) -> RopedynError:
        """Say why orders have none."""
        return SolveError(f"the scene must have {self.orders[row].max()} modes for these orders")


@dataclass(frozen=True, eq=False)
class Evidence:
    """Orders and how likely the peaks are with them, the likeliest first."""

    orders: Integer  # (h, k)
    v: Real  # (h, p) the likeliest
    likelihood: Real  # (h,) ln

    @classmethod
    def none(cls, log_measured: Real, variables: int) -> Evidence:
        """Return that of no orders."""
        orders = np.zeros((0, len(log_measured)), dtype=np.int64)
        return cls(orders, np.zeros((0, variables)), np.zeros(0))

    def new(self, orders: Integer, start: Real) -> tuple[Integer, Real]:
        """Return the different orders of two modes at least that are not among these."""
        known = {one.tobytes() for one in self.orders}
        kept = []
        for i, one in enumerate(orders):
            key = one.tobytes()
            if key not in known and np.count_nonzero(one) > 1:
                known.add(key)
                kept.append(i)
        return orders[kept], start[kept]

    def with_chances(self, chances: Chances) -> Evidence:
        """Return the same with the probabilities of orders."""
        return Evidence(self.orders, self.v, self.likelihood + chances(self.orders))

    def best(self, number: int, within: float) -> Evidence:
        """Return at most so many, not less likely than the first by more powers of e."""
        near = np.flatnonzero(self.likelihood[:number] > self.likelihood[:1] - within)
        return Evidence(self.orders[near], self.v[near], self.likelihood[near])

    def joined(self, other: Evidence) -> Evidence:
        """Return both, the likeliest first."""
        likelihood = np.concatenate([self.likelihood, other.likelihood])
        ranked = np.argsort(-likelihood, kind="stable")
        orders = np.concatenate([self.orders, other.orders])[ranked]
        return Evidence(orders, np.concatenate([self.v, other.v])[ranked], likelihood[ranked])

    @classmethod
    def of(
        cls,
        standardised: Standardised,
        log_measured: Real,
        std: Real | None,
        orders: Integer,
        start: Real,
    ) -> Evidence:
        """Fit all that is not known to each of the orders."""
        noises = np.ones(1) if std is not None else np.array(NOISES) / NOISES[0]
        scale = np.full(len(log_measured), NOISES[0]) if std is None else std
        misfit = RatioMisfit(standardised, log_measured, scale, orders)
        rows = np.arange(len(orders))
        begin = Point.of(misfit, rows, start)
        there = np.flatnonzero(np.isfinite(begin.residual.sum(1) + begin.slope.sum((1, 2))))
        rows, begin = rows[there], begin.take(there)
        found = minimise(misfit, rows, begin, digits=ENOUGH)
        each = [_laplace(found, orders[rows], noise * scale, noise) for noise in noises]
        ln = np.logaddexp.reduce(each, axis=0) - np.log(len(noises))
        return cls(orders[rows], found.u, ln)


def _laplace(found: Minimum, orders: Integer, std: Real, noise: float) -> Real:
    """Return ln Z of each row, with standard deviations so many times those of the fit."""
    from scipy.special import gammaln

    k, used = orders.shape[1], orders > 0
    m = used.sum(axis=1)
    off, v, J = found.residual[:, :k] / noise, found.residual[:, k:], found.slope[:, :k] / noise
    square = np.einsum("hk,hk->h", off, off)
    student = (
        gammaln((FREEDOM + m) / 2)
        - gammaln(FREEDOM / 2)
        - m / 2 * np.log(np.pi * FREEDOM)
        - (FREEDOM + m) / 2 * np.log1p(square / FREEDOM)
        - used @ np.log(std)
    )
    a = (FREEDOM + m) / (FREEDOM + square)
    curvature = np.eye(J.shape[2]) + a[:, None, None] * np.einsum("hki,hkj->hij", J, J)
    _, volume = np.linalg.slogdet(curvature)
    return student - 0.5 * np.einsum("hp,hp->h", v, v) - 0.5 * volume
