"""What least squares say about how well numbers are known."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...base.array import Flags, Real
from ..fitting.minimum import Minimum, told

# A number that has more than this share in directions that nothing tells is not told itself.
APART = 1e-6


def freedom_of(minimum: Minimum, peaks: int) -> float:
    """Return the degrees of freedom that residuals of peaks, the first rows, have.

    Each peak has one less its leverage: with nothing known beforehand peaks less unknowns.
    """
    basis = told(minimum.slope)
    directions, _ = np.linalg.qr(minimum.slope @ basis)
    used = np.abs(minimum.slope[:peaks]).any(axis=1)
    return float(used.sum() - np.sum(directions[:peaks][used] ** 2))


def quantile(level: float, freedom: float | None) -> float:
    """Return how many standard deviations an interval reaches to either side.

    Of Student's t where the noise was estimated with so many degrees of freedom.
    """
    from scipy.special import ndtri, stdtrit

    upper = (1 + level) / 2
    return float(ndtri(upper) if freedom is None else stdtrit(freedom, upper))


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Linear statistics of the variables u."""

    slope: Real  # (m, p) of residuals; 0 of numbers that are at a bound
    noise: float  # standard deviation of residuals; infinite where nothing tells it

    @cached_property
    def basis(self) -> Real:
        """Directions that are told, shape (p, r)."""
        return told(self.slope)

    @property
    def blind(self) -> Flags:
        """Numbers that are not told, shape (p,)."""
        return 1 - np.sum(self.basis**2, axis=1) > APART

    @cached_property
    def unit(self) -> Real:
        """Covariance of u for a noise of 1, of least norm where some are not told, (p, p)."""
        half = self.basis @ np.linalg.pinv(self.slope @ self.basis)
        return half @ half.T

    @property
    def std(self) -> Real:
        """Standard deviation of u, shape (p,)."""
        told_ones = ~self.blind
        std = np.full(len(self.unit), np.inf)
        if np.isfinite(self.noise):
            std[told_ones] = self.noise * np.sqrt(np.diag(self.unit)[told_ones])
        return std

    @property
    def correlation(self) -> Real:
        """Between numbers, NaN where one of them is not told, shape (p, p)."""
        size = np.sqrt(np.diag(self.unit))
        size[self.blind] = np.nan
        correlation = self.unit / np.outer(size, size)
        np.fill_diagonal(correlation, 1.0)
        return correlation
