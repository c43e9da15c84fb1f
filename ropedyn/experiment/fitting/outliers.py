"""Peaks that are off what the others say, by leaving one out: externally studentised residuals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Flags, Real
from ...scene.path import unit_of
from .minimum import TINY, Directions
from .unknown import CALIBRATION, Unknowns

LEVEL = 0.01  # Of so many ropes without an outlier a peak is named.
ALONE = 1e-6  # Of a peak whose leverage is nearer to 1 the others say nothing.
ROUNDING = 1e-30  # Sums of squares below this share of a larger one are rounding.
LEAST_FREEDOM = 0.5  # Of fewer degrees of freedom nothing tells the noise.
RIVAL = float(np.log(20.0))  # A peak that is a twentieth as likely the one may be it.
SHARE = 3  # Where more than one in so many of what is left over is off, the fit is, not a peak.


@dataclass(frozen=True, eq=False)
class Outlier:
    """A peak that is off what the others of its rope say."""

    row: int  # of its rope
    peak: int  # from 0
    off: float  # in standard deviations of what the others say, with its sign
    freedom: float  # of Student's t that this is; infinite where the noise was given
    probability: float  # that chance makes any of the peaks so far off
    rivals: tuple[int, ...]  # peaks of which one may be it instead
    change: Real  # (p,) of the variables without it and the outliers named before

    def sentence(self, frequency: Real, unknowns: Unknowns, u: Real) -> str:
        """Say which, how far, and what the first number is without it; Hz, and u of the fit."""
        shown = " or ".join(f"peak {i + 1} ({frequency[i]:.6g} Hz)" for i in self._named)
        student = f" of {self.freedom:.3g} degrees of freedom" if np.isfinite(self.freedom) else ""
        off = f"{abs(self.off):.2g} standard deviations{student}"
        if self.rivals:
            return f"{shown} is {off} off what the others say; they do not tell which"
        path = unknowns.paths[0]
        unit = "" if path == CALIBRATION else unit_of(unknowns.places[0][0])
        value = f"{unknowns.value(u + self.change)[0]:.4g} {unit}".strip()
        return f"{shown} is {off} off what the others say; without it {path} is {value}"

    @property
    def _named(self) -> tuple[int, ...]:
        return tuple(sorted((self.peak, *self.rivals)))


def outliers(
    residual: Real,
    slope: Real,
    noise_is_given: Flags,
    *,
    peaks: int | None = None,
    level: float = LEVEL,
) -> list[Outlier]:
    """Name peaks of many ropes, one after the other, by linear least squares.

    Residuals, (n, m), over their noise where that is given, in any unit where not, and their slopes
    (n, m, p); the first `peaks` of m are peaks, others what was known beforehand. Where slopes are
    all 0 it is no mode. A peak is named if chance makes any of the peaks of its rope so far off
    with less than the level (Student's t or normal, Bonferroni). Where more are off than a third of
    the degrees of freedom none is: then it is the fit that is off.
    """
    peaks = residual.shape[1] if peaks is None else peaks
    kept = np.asarray(slope.any(axis=2))
    most = np.maximum((kept[:, :peaks].sum(axis=1) - slope.shape[2]) // SHARE, 1)
    found: dict[int, list[Outlier]] = {}
    going = np.arange(len(residual))
    while len(going):
        left = _Left.of(residual[going], slope[going], kept[going], noise_is_given[going], peaks)
        named = left.named(level)
        for i, peak in named.items():
            row = int(going[i])
            found.setdefault(row, []).append(left.outlier(i, peak, row))
            kept[row, peak] = False
        for row in going[list(named)].tolist():
            if len(found[row]) > most[row]:
                del found[row]
        going = np.array([row for row in going[list(named)] if row in found], dtype=np.intp)
    told = []
    for row in sorted(found):  # to the first that may be another: then no further one is told
        rivals = (i + 1 for i, one in enumerate(found[row]) if one.rivals)
        told += found[row][: next(rivals, None)]
    return told


@dataclass(frozen=True, eq=False)
class _Left:
    """What the others say of each peak of some ropes."""

    change: Real  # (n, p) of the variables to their least squares
    pull: Real  # (n, k, p) further change without each peak
    t: Real  # (n, k) externally studentised residuals; 0 where the others say nothing
    told: Flags  # (n, k) whether they do
    freedom: Real  # (n,) of Student's t; infinite where the noise was given
    likelihood: Real  # (n, k) logarithm of the greatest one where this peak alone is off

    @classmethod
    def of(cls, residual: Real, slope: Real, kept: Flags, given: Flags, peaks: int) -> _Left:
        """Leave out each by the closed form (Cook, Weisberg, Residuals and Influence, 2.2)."""
        slope, residual = slope * kept[:, :, None], residual * kept
        told = Directions.of(slope)
        inverse = told.direction.swapaxes(1, 2) * told.inverse[:, None, :]
        along = np.einsum("npq,nq->np", inverse, told.along(residual))
        of_rows = told.of_rows * (told.size > 0)[:, None, :]
        rest = (residual - np.einsum("nmq,nq->nm", of_rows, told.along(residual)))[:, :peaks]
        free = np.where(kept, 1 - np.sum(of_rows**2, axis=2), 0.0)[:, :peaks]
        freedom, square = free.sum(axis=1) - 1, np.sum(rest**2, axis=1)[:, None]
        seen = (free > ALONE) & (given | (freedom >= LEAST_FREEDOM))[:, None]
        room = np.where(seen, free, 1.0)
        gain = rest**2 / room
        # without a peak the sum of squares is less by its gain
        least = np.maximum(square - gain, ROUNDING * square) + TINY
        others = least / np.where(given, 1.0, np.maximum(freedom, LEAST_FREEDOM))[:, None]
        noise = np.where(given[:, None], 1.0, np.sqrt(others))
        many = kept[:, :peaks].sum(axis=1)[:, None]
        return cls(
            change=-along,
            pull=np.einsum("npq,nkq->nkp", inverse, of_rows[:, :peaks]) * (rest / room)[:, :, None],
            t=np.where(seen, rest / np.sqrt(room) / noise, 0.0),
            told=seen,
            freedom=np.where(given, np.inf, freedom),
            likelihood=np.where(given[:, None], gain / 2, -many / 2 * np.log(least)),
        )

    @property
    def probability(self) -> Real:
        """That chance makes any peak so far off as each is, (n, k)."""
        from scipy.special import ndtr, stdtr

        given = np.isinf(self.freedom)
        freedom = np.where(given, 1.0, np.maximum(self.freedom, LEAST_FREEDOM))[:, None]
        below = -np.abs(self.t)
        each = 2 * np.where(given[:, None], ndtr(below), stdtr(freedom, below))
        return np.minimum(1.0, each * self.told.sum(axis=1, keepdims=True))

    def named(self, level: float) -> dict[int, int]:
        """Return the likeliest peak of each rope that has one that is off."""
        likelihood = np.where(self.told, self.likelihood, -np.inf)
        likeliest = likelihood.argmax(axis=1)
        every = np.arange(len(likeliest))
        off = self.told.any(axis=1) & (self.probability[every, likeliest] < level)
        return {i: int(likeliest[i]) for i in np.flatnonzero(off).tolist()}

    def outlier(self, i: int, peak: int, row: int) -> Outlier:
        """Return what there is to say of a peak that is off."""
        close = self.told[i] & (self.likelihood[i] > self.likelihood[i, peak] - RIVAL)
        close[peak] = False
        return Outlier(
            row=row,
            peak=peak,
            off=float(self.t[i, peak]),
            freedom=float(self.freedom[i]),
            probability=float(self.probability[i, peak]),
            rivals=tuple(np.flatnonzero(close).tolist()),
            change=self.change[i] + self.pull[i, peak],
        )
