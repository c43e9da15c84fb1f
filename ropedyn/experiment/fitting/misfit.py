"""What least squares make small: what was measured and what was known beforehand."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from ...base.array import Index, Real
from ...base.errors import SolveError
from .natural_frequencies import NaturalFrequencies
from .unknown import Unknowns

# Takes variables u, shape (p,); returns residuals (m,) and their slopes (m, p).
Misfit = Callable[[Real], tuple[Real, Real]]


@dataclass(frozen=True, eq=False)
class PriorMisfit:
    """What is known beforehand: values and their standard deviations."""

    unknowns: Unknowns  # what is sought
    at: Index  # (q,) which of it
    value: Real  # (q,)
    std: Real  # (q,)

    @classmethod
    def of(cls, unknowns: Unknowns, prior: Mapping[str, tuple[float, float]]) -> PriorMisfit | None:
        """Return what is known of these unknowns, if anything is."""
        at = [i for i, path in enumerate(unknowns.paths) if path in prior]
        if not at:
            return None
        value, std = zip(*(prior[unknowns.paths[i]] for i in at))
        return cls(unknowns, np.array(at, dtype=np.intp), np.array(value), np.array(std))

    def __call__(self, u: Real) -> tuple[Real, Real]:
        """Return (p - value)/std and its slopes."""
        residual = (self.unknowns.value(u)[self.at] - self.value) / self.std
        slope = np.zeros((len(self.at), len(u)))
        slope[np.arange(len(self.at)), self.at] = self.unknowns.slope(u)[self.at] / self.std
        return residual, slope


def unseen_of(slope: Real, known: PriorMisfit | None) -> Index:
    """Return which numbers change no residual and are not known beforehand."""
    unseen = np.asarray(~slope.any(axis=0))
    if known is not None:
        unseen[known.at] = False
    return np.flatnonzero(unseen)


@dataclass(frozen=True, eq=False)
class JointMisfit:
    """What was measured and what was known, the last in units of the noise of the first."""

    measured: Misfit
    known: PriorMisfit
    noise: float

    def __call__(self, u: Real) -> tuple[Real, Real]:
        """Return the residuals of both and their slopes."""
        (first, of_first), (second, of_second) = self.measured(u), self.known(u)
        return (
            np.concatenate([first, self.noise * second]),
            np.concatenate([of_first, self.noise * of_second]),
        )


@dataclass(frozen=True, eq=False)
class PeakMisfit:
    """Differences of natural frequencies from measured peaks."""

    calculated: NaturalFrequencies  # the frequencies
    measured: Real  # (k,) [Hz]
    weight: Real  # (k,) by which differences are divided [Hz]
    orders: Index  # (k,) from 1; 0 of a peak that is no mode, whose difference is 0

    def __call__(self, u: Real) -> tuple[Real, Real]:
        """Return the residuals and their slopes."""
        frequency, slope = self.of_peaks(u)
        used = self.orders > 0
        residual = np.where(used, (frequency - self.measured) / self.weight, 0.0)
        return residual, np.where(used, slope.T / self.weight, 0.0).T

    def of_peaks(self, u: Real) -> tuple[Real, Real]:
        """Return the calculated frequency of each peak [Hz] and its slope; any where it is none."""
        most = int(self.orders.max())
        frequency, slope = self.calculated(u, most)
        if len(frequency) < most:
            raise SolveError(
                f"the scene must have {most} modes for these orders, got {len(frequency)}"
            )
        return frequency[self.orders - 1], slope[self.orders - 1]
