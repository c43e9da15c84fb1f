"""Differences of natural frequencies from measured peaks, with their slopes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Index, Real
from ...base.errors import SolveError
from .natural_frequencies import NaturalFrequencies


@dataclass(frozen=True, eq=False)
class PeakMisfit:
    """Differences of natural frequencies from measured peaks."""

    calculated: NaturalFrequencies  # the frequencies
    measured: Real  # (k,) [Hz]
    weight: Real  # (k,) by which differences are divided [Hz]
    orders: Index  # (k,) from 1; 0 of a peak that is no mode, whose difference is 0

    def __call__(self, u: Real) -> tuple[Real, Real]:
        """Return the residuals and their slopes."""
        frequency, slope = self.partners(u)
        used = self.orders > 0
        residual = np.where(used, (frequency - self.measured) / self.weight, 0.0)
        return residual, np.where(used, slope.T / self.weight, 0.0).T

    def partners(self, u: Real) -> tuple[Real, Real]:
        """Return the calculated frequency of each peak [Hz] and its slope; any where it is none."""
        most = int(self.orders.max())
        frequency, slope = self.calculated(u, most)
        if len(frequency) < most:
            raise SolveError(
                f"the scene must have {most} modes for these orders, got {len(frequency)}"
            )
        return frequency[self.orders - 1], slope[self.orders - 1]
