"""What peaks tell of numbers of a rope, with all that is not known of the rest."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...base import check
from ...base.answer import Answer, Cost, axes
from ...base.array import Integer, Real
from ...base.computed import computed
from ...base.errors import SceneError
from ...base.named import Named
from ...base.table import Table, numbers
from .ends_told import EndsTold
from .mixture import quantile

HALF = 1.959963984540054
"""Half of the 95 % interval of a normal distribution, in standard deviations."""


@dataclass(frozen=True, eq=False)
class Posterior(Answer):
    """Numbers of a scene after its peaks were measured: points of equal weight.

    Attributes
    ----------
    unknown : tuple of str
        Paths of the numbers.
    sample, scale : ndarray, shape (n, p)
        Numbers of each point, and where peaks fix them by a point alone the scale of Student's
        distribution of their logarithm about it, else 0.
    sample_freedom : float
        Degrees of freedom of that distribution.
    reaches : ndarray, shape (p, 2)
        Shares of the points below and above which a number is no longer told but limited by what
        was assumed: 0 and 1 where it is told to the last point.
    budget : dict of str to float
        Half-widths of the 95 % interval of the tension, or of the first number, over its median, by
        their cause: "ends", "mass", "length", "peaks", "model", other paths.
    orders : ndarray of int, shape (k,)
    measured, calculated : ndarray, shape (k,)
        [Hz], the last of the likeliest point; NaN of a peak that is no mode.
    chi_square, freedom, probability : float
        Of the likeliest point, what noise leaves of it, and how often that would be exceeded;
        `freedom` alone is not NaN where the noise was estimated.
    ends : EndsTold
        What the peaks say of unknown ends.
    assumed, notes : tuple of str
        Everything taken for granted, and what the peaks cannot tell.
    cost : Cost
    """

    unknown: tuple[str, ...]
    sample: Real = field(metadata=axes("point", "unknown"))
    scale: Real = field(metadata=axes("point", "unknown"))
    sample_freedom: float
    reaches: Real = field(metadata=axes("unknown", "side"))
    budget: dict[str, float]
    orders: Integer = field(metadata=axes("peak"))
    measured: Real = field(metadata=axes("peak", unit="Hz"))
    calculated: Real = field(metadata=axes("peak", unit="Hz"))
    chi_square: float
    freedom: float
    probability: float
    assumed: tuple[str, ...]
    notes: tuple[str, ...]
    cost: Cost
    ends: EndsTold = field(metadata={"nested": EndsTold})

    @computed
    def value(self) -> Named:
        """Median of each number, shape (p,)."""
        return Named([self._quantile(i, 0.5) for i in range(len(self.unknown))], self.unknown)

    @computed
    def std(self) -> Named:
        """Half of `interval(0.95)` over 1.96, shape (p,); NaN where that is open."""
        bounds = np.asarray(self.interval())
        open_ = np.isinf(bounds[:, 1]) | ((bounds[:, 0] == 0) & (self.reaches[:, 0] > 0))
        half = np.where(open_, np.nan, bounds[:, 1] - bounds[:, 0]) / 2
        return Named(half / HALF, self.unknown)

    @computed
    def correlation(self) -> Real:
        """Of logarithms, of numbers that are not all positive of these, shape (p, p)."""
        positive = (self.sample > 0).all(axis=0)
        each = np.where(positive, np.log(np.where(positive, self.sample, 1.0)), self.sample)
        nu = self.sample_freedom
        # the variance of Student's distribution, or its scale where there is none
        within = (nu / (nu - 2) if nu > 2 else 1.0) * self.scale.T @ self.scale / len(each)
        covariance = np.atleast_2d(np.cov(each.T, bias=True)) + within
        root = np.sqrt(np.diag(covariance))
        return covariance / np.outer(root, root)

    def interval(self, level: float = 0.95) -> Named:
        """Return bounds between which numbers are with a probability, shape (p, 2).

        They have equal shares beyond both bounds. A bound that only what was assumed sets is 0 or
        infinite.

        Raises
        ------
        SceneError
            If the level is not between 0 and 1.
        """
        level = check.number(level, "level")
        if not 0 < level < 1:
            raise SceneError(f"level must be a number between 0 and 1, got {level:g}")
        shares = (1 - level) / 2, (1 + level) / 2
        return Named([self._bounds(i, *shares) for i in range(len(self.unknown))], self.unknown)

    def _bounds(self, i: int, low: float, high: float) -> tuple[float, float]:
        least, most = self.reaches[i]
        return (
            self._quantile(i, low) if low >= least else 0.0,
            self._quantile(i, high) if high <= most else np.inf,
        )

    def _quantile(self, i: int, share: float) -> float:
        return quantile(self.sample[:, i], self.scale[:, i], self.sample_freedom, share)

    def table(self) -> Table:
        """Return one row for each number, with its interval of 95 %."""
        low, high = self.interval().T.tolist()
        columns: dict[str, Any] = {"number": self.unknown, "median": np.asarray(self.value)}
        columns |= {"std": numbers(np.asarray(self.std)), "95 % from": low, "to": high}
        return Table.of("posterior", columns)
