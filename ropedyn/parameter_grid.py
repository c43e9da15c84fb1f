"""Frequencies calculated once at a grid of parameters."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from .errors import RopedynError, SolveError
from .rayleigh import Quotients

Real = NDArray[np.float64]
Whole = NDArray[np.int64]

Calculated = Callable[[Real, int], tuple[Real, Real]]
"""Takes parameters, shape (p,), and how many modes; see `ropedyn.order_search.search`."""

STEP = 10.0
"""Factor between neighbours on the grid."""

COARSE = 0.01
"""Relative error of Rayleigh's quotients half a step from a point of the grid.

1.1 % at most for ten modes of a clamped rope of any T L^2/B, when tension or stiffness changes.
"""

MOST = 81
"""Points of the grid; more parameters have wider steps."""

COMMON = 1e-6
"""Relative difference of the sums of shares that are the same."""


@dataclass(frozen=True, eq=False)
class Grid:
    """Points around a start with Rayleigh's quotients of their shapes.

    Where a common factor of all parameters changes all frequencies alike (tension and all
    stiffnesses together), one point stands for all that differ by such a factor. So it is, by
    Euler, where the sum of a mode's shares is the same for all modes.

    Attributes
    ----------
    parameters : ndarray, shape (points, p)
    quotients : Quotients
        Of each point.
    power : float
        Of the common factor that f^2 follows; 0 if there is none.
    """

    parameters: Real
    quotients: Quotients
    power: float

    @classmethod
    def of(cls, calculated: Calculated, start: Real, reach: Real, count: int) -> Grid:
        """Calculate; points where that fails are left out."""
        power = _common_power(quotients_at(calculated, start, count))
        points, found = [], []
        for factors in _factors(reach, common=power > 0):
            quotients = quotients_at(calculated, start * factors, count)
            if quotients is not None:
                points.append(start * factors)
                found.append(quotients)
        if not found:
            raise SolveError("no frequencies could be calculated at any of the parameters tried")
        fewest = min(len(one.frequency) for one in found)
        stacked = Quotients(
            np.stack([one.frequency[:fewest] for one in found]),
            np.stack([one.share[:fewest] for one in found]),
        )
        return cls(np.stack(points), stacked, power)

    def centre(self, at: NDArray[np.intp], measured: Real, orders: Whole) -> Real:
        """Return the ratio to expect at points `at`, from peaks of these orders, shape (h,)."""
        if self.power == 0:
            return np.ones(len(at))
        used, mode = orders > 0, np.maximum(orders - 1, 0)
        calculated = np.take_along_axis(self.quotients.frequency[at], mode, axis=-1)
        lift = np.where(used, np.log(measured / calculated), 0.0).sum(axis=-1)
        return np.exp(2 * lift / (self.power * np.maximum(used.sum(axis=-1), 1)))


def quotients_at(calculated: Calculated, parameters: Real, count: int) -> Quotients | None:
    """Return those of the shapes at these parameters, or None where there are no frequencies."""
    try:
        frequency, jacobian = calculated(parameters, count)
    except RopedynError:
        return None
    if len(frequency) == 0 or not (frequency > 0).all():
        return None
    return Quotients.of(parameters, frequency, jacobian)


def _common_power(quotients: Quotients | None) -> float:
    if quotients is None:
        return 0.0
    total = quotients.share.sum(axis=-1)
    same = np.ptp(total) <= COMMON * np.abs(total).max()
    return float(total[0]) if same else 0.0


def _factors(reach: Real, common: bool) -> Real:
    """Return ratios of the grid's points to the start, shape (points, p), nearest first."""
    step = np.log(STEP)
    while True:
        # half a step beyond the last point is within reach
        halves = np.ceil(np.log(reach) / step - 0.5 - 1e-9).astype(int)
        points = np.array(list(product(*[step * np.arange(-h, h + 1) for h in halves])))
        if common:
            shifted = points - points.mean(axis=1, keepdims=True)
            points = np.unique(np.round(shifted, 9), axis=0)
        if len(points) <= MOST:
            break
        step *= 1.2
    return np.exp(points[np.argsort((points**2).sum(axis=1), kind="stable")])
