"""A straight line by least squares."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...base.array import Real


class Line(NamedTuple):
    """y = offset + slope x."""

    slope: float  # of least squares; an offset that was given is itself
    offset: float  # of least squares; an offset that was given is itself
    std: float  # standard error of the slope, infinite where no y is left over to tell it
    residual: Real  # (k,) y less the line
    # degrees of freedom of the standard error, infinite where that of each y was given
    freedom: float

    @staticmethod
    def through(x: Real, y: Real, *, offset: float | None, std: float | None) -> Line:
        """Return the line of k points; x must not be constant, nor 0 where the offset is given.

        With A = [x, 1], or x alone where the offset is given, the covariance is s^2 (A^T A)^-1; s
        is the standard uncertainty of each y, where that is left out the root of the sum of squared
        residuals per degree of freedom (Draper and Smith, Applied Regression Analysis, 3rd ed.,
        section 1.4).
        """
        width = float(np.abs(x).max())
        A = (x / width)[:, None]
        if offset is None:
            A = np.stack([A[:, 0], np.ones_like(x)], axis=1)
        known = 0.0 if offset is None else offset
        found = np.linalg.lstsq(A, y - known)[0]
        residual = y - known - A @ found
        freedom = len(x) - A.shape[1]
        if std is not None:
            s, freedom = std, math.inf
        else:
            s = math.sqrt(residual @ residual / freedom) if freedom > 0 else math.inf
        share = np.linalg.inv(A.T @ A)[0, 0]
        return Line(
            slope=float(found[0]) / width,
            offset=known if offset is not None else float(found[1]),
            std=s * math.sqrt(share) / width,
            residual=residual,
            freedom=freedom,
        )

    def interval(self, confidence: float) -> tuple[float, float]:
        """Return the two-sided confidence interval of the slope, by Student's t."""
        from scipy.special import ndtri, stdtrit

        if not math.isfinite(self.std):
            return -math.inf, math.inf
        p = (1 + confidence) / 2
        t = ndtri(p) if math.isinf(self.freedom) else stdtrit(self.freedom, p)
        half = float(t) * self.std
        return self.slope - half, self.slope + half
