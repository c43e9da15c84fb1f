"""The search: candidates of a lattice, fitted, and what is near the best of them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Integer, Real
from .chances import Chances
from .evidence import NOISES, Evidence
from .lattice import Lattice, nearest
from .standardised import Standardised

CANDIDATES, CANDIDATES_ALONE = 150, 16  # That are fitted: rows in closed form, and one by one.
BEST, BEST_ALONE = 12, 2  # Of so many fitted ones what is near is fitted too,
ROUNDS = 2  # so often.
FINEST = 2e-4  # Relative standard deviation of a peak at least.
DOUBLE = 0.005  # That of two modes in one peak is larger by this.
TYPICAL = NOISES[2]  # Of peaks that have none, where candidates are sought.
MODEST = 12.0  # What is less likely than the best by more powers of e is not looked around.


@dataclass(frozen=True, eq=False)
class SortedPeaks:
    """Peaks in increasing order, as numberings see them."""

    log_frequency: Real  # (k,) of Hz
    std: Real | None  # (k,) of that

    @classmethod
    def of(cls, frequency: Real, std: Real | None, double: Real, model_std: float) -> SortedPeaks:
        """Take frequencies and standard deviations [Hz]."""
        if std is None:
            return cls(np.log(frequency), None)
        least = FINEST**2 + model_std**2 + (DOUBLE * double) ** 2
        return cls(np.log(frequency), np.sqrt((std / frequency) ** 2 + least))

    @property
    def typical(self) -> Real:
        """Standard deviations to look for candidates with, (k,)."""
        return np.full(len(self.log_frequency), TYPICAL) if self.std is None else self.std


def search(standardised: Standardised, peaks: SortedPeaks, chances: Chances) -> Evidence:
    """Find orders and their evidence with what is known of modes and strays, likeliest first."""
    closed = standardised.closed
    number, best = (CANDIDATES, BEST) if closed else (CANDIDATES_ALONE, BEST_ALONE)
    lattice = Lattice.of(standardised, len(chances.visible))
    orders, start = lattice.candidates(peaks.log_frequency, peaks.typical, chances, number)
    found = Evidence.none(peaks.log_frequency, len(standardised))
    for _ in range(1 + ROUNDS):
        orders, start = found.new(orders, start)
        if not len(orders):
            break
        fitted = Evidence.of(standardised, peaks.log_frequency, peaks.std, orders, start)
        found = found.joined(fitted.with_chances(chances))
        orders, start = _around(found.best(best, MODEST), standardised, peaks, chances)
    return found


def _around(
    best: Evidence, standardised: Standardised, peaks: SortedPeaks, chances: Chances
) -> tuple[Integer, Real]:
    """Return orders near the best: the nearest modes of each, and those without one peak."""
    (h, k), v = best.orders.shape, best.v
    log_frequency, _ = standardised(v, len(chances.visible))
    at = np.where(np.isfinite(log_frequency), log_frequency, np.inf)
    anew, _ = nearest(at, np.zeros_like(at), peaks.log_frequency, peaks.typical, chances)
    without = np.repeat(best.orders, k, axis=0)
    without[np.arange(h * k), np.tile(np.arange(k), h)] = 0
    return np.concatenate([anew, without]), np.concatenate([v, np.repeat(v, k, axis=0)])
