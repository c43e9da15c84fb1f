"""Frequencies calculated once at a grid of parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np

from ...base.array import Index, Integer, Real
from ...base.errors import RopedynError, SolveError
from .rayleigh import Quotients

# Takes parameters, shape (p,), and how many modes; see `order_search.search`.
Calculated = Callable[[Real, int], tuple[Real, Real]]
STEP = 10.0  # Neighbours on the grid are a factor of this apart.
# Half a step from a point of the grid Rayleigh's quotients are off by this share (1.1 % at most for
# ten modes of a clamped rope of any T L^2/B, when tension or stiffness changes).
COARSE = 0.01
MOST = 81  # The grid has at most so many points; more parameters have wider steps.
COMMON = 1e-6  # Shares below this part of the largest are none.


@dataclass(frozen=True, eq=False)
class Grid:
    """Points around a start with Rayleigh's quotients of their shapes.

    Directions that change all frequencies alike need no points: steps v of the logarithms do so
    where the shares s of a mode have the same s v for all modes (Euler).
    """

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
