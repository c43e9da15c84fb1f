"""Frequencies calculated at a grid of parameters, and Rayleigh's quotients between."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from ...base.array import Index, Integer, Real
from ...base.errors import RopedynError, SolveError

# Takes parameters (p,) and how many modes; returns frequencies (m,) [Hz] and their slopes (m, p).
Calculated = Callable[[Real, int], tuple[Real, Real]]
STEP = 10.0  # Neighbours on the grid are a factor of this apart.
# Half a step from a point of the grid Rayleigh's quotients are off by this share (1.1 % at most for
# ten modes of a clamped rope of any T L^2/B, when tension or stiffness changes).
COARSE = 0.01
MOST = 81  # The grid has at most so many points; more parameters have wider steps.
COMMON = 1e-6  # Shares below this part of the largest are none.
STEPS = 3  # Gauss and Newton take so many steps; for stiffnesses alone the first is exact.
STEEPEST = 4.0  # f^2 may follow at most this power of a parameter: that of the length of a beam.
LEAST = 0.01  # A side of the quotient that falls to less of itself is beyond what shapes tell.
ROUNDING = 1e-13  # Normal equations have this relative rounding.
FIRM = 1e4  # The pull that holds a ratio at its bound is so many times narrower.


@dataclass(frozen=True, eq=False)
class Quotients:
    """Quotients u^T K u/(u^T M u) with shapes u that stay, over ratios r of the parameters.

    Shares s_j = dln(f^2)/dln(p_j) of stiffnesses are positive, of inertias negative:

        f(r)^2/f(1)^2 = (1 + sum_stiff s_j (r_j - 1))/(1 + sum_inert |s_j| (r_j - 1)),

    exact where shapes do not change. Of a share beyond 1, as that of a length, r is a power.
    """

    frequency: Real  # (..., m) f(1) [Hz], positive
    share: Real  # (..., m, p) of the power
    power: Real  # (..., p) from 1 to 4

    @classmethod
    def of(cls, parameters: Real, frequency: Real, jacobian: Real) -> Quotients:
        """Take the derivatives of frequencies, shape (m, p), at parameters of shape (p,)."""
        share = 2 * parameters * jacobian / frequency[:, None]
        power = np.clip(np.abs(share).max(axis=0), 1.0, STEEPEST)
        return cls(frequency, share / power, power)

    @classmethod
    def stack(cls, some: Sequence[Quotients], modes: int) -> Quotients:
        """Join those of several parameters, of the lowest modes."""
        return cls(
            np.stack([one.frequency[:modes] for one in some]),
            np.stack([one.share[:modes] for one in some]),
            np.stack([one.power for one in some]),
        )

    def take(self, which: Index) -> Quotients:
        """Return those of some of the calculated parameters."""
        return Quotients(self.frequency[which], self.share[which], self.power[which])

    def at(self, ratio: Real) -> Real:
        """Return frequencies at ratios of shape (..., p); infinite where the quotient has none."""
        stiff, inert = self._sides(self.share, ratio**self.power)
        fit = (stiff > 0) & (inert > 0)
        quotient = np.divide(stiff, inert, out=np.full(fit.shape, np.inf), where=fit)
        return self.frequency * np.sqrt(quotient)

    def fit(
        self,
        measured: Real,
        weight: Real,
        orders: Integer,
        pull: tuple[Real, float],
        bounds: tuple[Real, Real],
    ) -> Real:
        """Return ratios that fit measured frequencies, by Gauss-Newton for f(r)^2/measured^2."""
        mode = np.maximum(orders - 1, 0)
        calculated = np.take_along_axis(self.frequency, mode, axis=-1)
        share = np.take_along_axis(self.share, mode[..., None], axis=-2)
        stiff, inert = np.maximum(share, 0), np.maximum(-share, 0)
        lift = (calculated / measured) ** 2
        scale = np.where(orders > 0, weight / 2, 0.0)
        centre, low, high = (one**self.power for one in (pull[0], *bounds))
        tight = 1 / (centre * pull[1])
        ratio = np.clip(centre, low, high)
        for _ in range(STEPS):
            a, b = (np.maximum(side, LEAST) for side in self._sides(share, ratio))
            square = lift * a / b
            rows = (scale * lift / b)[..., None] * (stiff - inert * (a / b)[..., None])
            right = scale * (1 - square) + (rows * ratio[..., None, :]).sum(axis=-1)
            ratio = _solved(rows, right, (centre, tight), (low, high))
        return ratio ** (1 / self.power)

    @staticmethod
    def _sides(share: Real, ratio: Real) -> tuple[Real, Real]:
        """Return stiff(r) and inert(r)."""
        change = ratio[..., None, :] - 1
        stiff = 1 + (np.maximum(share, 0) * change).sum(axis=-1)
        return stiff, 1 + (np.maximum(-share, 0) * change).sum(axis=-1)


def _solved(rows: Real, right: Real, pull: tuple[Real, Real], bounds: tuple[Real, Real]) -> Real:
    """Minimise |rows r - right|^2 + |tight (r - centre)|^2 within bounds."""
    (centre, tight), (low, high) = pull, bounds
    ratio = _minimum(rows, right, centre, tight)
    held = np.clip(ratio, low, high)
    if (held == ratio).all():
        return ratio
    # once more for the others, with those at a bound there
    firm = np.where(held == ratio, tight, FIRM * (tight + np.abs(rows).max(axis=-2)))
    ratio = _minimum(rows, right, np.where(held == ratio, centre, held), firm)
    return np.clip(ratio, low, high)


def _minimum(rows: Real, right: Real, centre: Real, tight: Real) -> Real:
    rows = rows / tight[..., None, :]
    off = right - (rows * (tight * centre)[..., None, :]).sum(axis=-1)
    normal = np.einsum("...kp,...kq->...pq", rows, rows)
    # rounding must not swallow the pull where rows are large and tell one direction alone
    least = np.maximum(1.0, ROUNDING * np.trace(normal, axis1=-2, axis2=-1))
    normal += least[..., None, None] * np.eye(rows.shape[-1])
    vector = np.einsum("...kp,...k->...p", rows, off)
    return centre + np.linalg.solve(normal, vector[..., None])[..., 0] / tight


@dataclass(frozen=True, eq=False)
class Grid:
    """Points around a start; steps v with the same s v for the shares s of all modes need none."""

    parameters: Real  # (points, p)
    quotients: Quotients  # of each point
    lift: Real  # (p,) shortest step of the logarithms that adds 1 to all ln(f^2), or 0

    @classmethod
    def of(cls, calculated: Calculated, start: Real, reach: Real, count: int) -> Grid:
        """Calculate; points where that fails are left out."""
        first = quotients_at(calculated, start, count)
        common = np.zeros((0, len(start))) if first is None else _common(first.share)
        steep = np.ones(len(start)) if first is None else first.power
        points, found = [], []
        for factors in _factors(reach, common, steep):
            quotients = quotients_at(calculated, start * factors, count)
            if quotients is not None:
                points.append(start * factors)
                found.append(quotients)
        if not found:
            raise SolveError("no frequencies could be calculated at any of the parameters tried")
        fewest = min(len(one.frequency) for one in found)
        lift = np.zeros(len(start))
        if first is not None and len(common):
            # the modes agree: their mean is what each does
            rise = common @ first.share.mean(axis=0)
            if np.abs(rise).max() > COMMON:
                lift = common.T @ rise / (rise @ rise)
        return cls(np.stack(points), Quotients.stack(found, fewest), lift)

    def centre(self, at: Index, measured: Real, orders: Integer) -> Real:
        """Return ratios to expect at points `at`, from peaks of these orders, shape (h, p)."""
        used, mode = orders > 0, np.maximum(orders - 1, 0)
        calculated = np.take_along_axis(self.quotients.frequency[at], mode, axis=-1)
        rise = np.where(used, 2 * np.log(measured / calculated), 0.0).sum(axis=-1)
        return np.exp(np.outer(rise / np.maximum(used.sum(axis=-1), 1), self.lift))


def quotients_at(calculated: Calculated, parameters: Real, count: int) -> Quotients | None:
    """Return those of the shapes at these parameters, or None where there are no frequencies."""
    try:
        frequency, jacobian = calculated(parameters, count)
    except RopedynError:
        return None
    if len(frequency) == 0 or not (frequency > 0).all():
        return None
    return Quotients.of(parameters, frequency, jacobian)


def _common(share: Real) -> Real:
    """Return orthonormal steps that change all modes alike, shape (directions, p)."""
    _, size, direction = np.linalg.svd(share - share.mean(axis=0))
    rank = int((size > COMMON * np.abs(share).max()).sum())
    return direction[rank:]


def _factors(reach: Real, common: Real, steep: Real) -> Real:
    """Return ratios of the grid's points to the start, shape (points, p), nearest first."""
    step = np.log(STEP) / steep
    while True:
        # half a step beyond the last point is within reach
        halves = np.ceil(np.log(reach) / step - 0.5 - 1e-9).astype(int)
        lines = [one * np.arange(-h, h + 1) for one, h in zip(step, halves)]
        points = np.array(list(product(*lines)))
        points = np.unique(np.round(points - points @ common.T @ common, 9), axis=0)
        if len(points) <= MOST:
            break
        step = 1.2 * step
    return np.exp(points[np.argsort((points**2).sum(axis=1), kind="stable")])
