"""Hill's matrix: motion exp(s t) sum_h v_h exp(i h Omega t) under a tension that pulsates.

    [(s + i h Omega)^2 + C (s + i h Omega) + Lambda] v_h + (a/2) Gamma (v_{h-1} + v_{h+1}) = 0

Without damping and with s = i nu Omega it is real and symmetric: at every phase 2 pi nu by which
motion turns in a period it has bands of eigenvalues Omega^2,

    [Lambda delta + (a/2) Gamma] v = Omega^2 (h + nu)^2 v,

and instability begins where a band is flat: G. W. Hill, Acta Mathematica 8 (1886) 1-36.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..base.array import Complex, Real
from ..base.computed import computed
from ..motion.modal_system import ModalSystem

Numbers = NDArray[Any]  # Real where motion turns without damping, complex elsewhere.
EPS = float(np.finfo(float).eps)
BEYOND = 12  # So many harmonics are added above the frequency of the stiffest mode,
MORE = 2  # and this many times as many where that was not enough.
OUTER = 1e-9  # The two outer harmonics on each side hold less than this part of a motion.
INVERSE = 8  # So many steps of inverse iteration lead to the nearest bands.
BESIDE = 1 + 1e-6  # Inverse iteration so far beside a band leaves the other one what it is.
STEPS = 6  # So many lead to where two bands nearly meet,
COUNTS = (4, 8, 16)  # So many are looked for, until one is no neighbour:
APART = 1e-3  # farther away than this part of Omega^2.
PAIRS = 2  # Two that meet are among so many to either side of the nearest.
BENT = 30  # each of so many among the bands that lie together.
SYMMETRIC = 1e-9  # Bands are flat at phases 0 and pi.
MOVES = 1e-8  # Where a band is flat it lies so close to where it was looked for, in parts of it.
SAMPLES = 8  # The highest harmonic is looked at so many times a turn, the first time after
BETWEEN = 0.3  # this part of the time between two looks.
SETTLED = 1e-14  # Phases are known so well, in turns.


@dataclass(frozen=True, eq=False)
class Hill:
    """Hill's matrix of some harmonics."""

    system: ModalSystem
    amplitude: float  # of the tension [N]
    harmonic: Real  # (h,) from -H to H

    @classmethod
    def of(cls, system: ModalSystem, amplitude: float, period: float) -> Hill:
        """Return one with harmonics enough for a guess."""
        stiffest = np.abs(system.eigenvalue).max() + amplitude * np.abs(system.geometric).max()
        most = math.ceil(math.sqrt(stiffest) * period / (2 * math.pi)) + BEYOND
        return cls(system, amplitude, np.arange(-most, most + 1.0))

    def larger(self) -> Hill:
        """Return one with more harmonics."""
        most = MORE * self.harmonic[-1]
        return Hill(self.system, self.amplitude, np.arange(-most, most + 1))

    @computed
    def _still(self) -> Real:
        """The matrix by its diagonals, without rates."""
        k, h = len(self.system.eigenvalue), len(self.harmonic)
        wide = 2 * k - 1
        band = np.zeros((2 * wide + 1, k * h))
        i, j = np.indices((k, k))
        start = k * np.arange(h)[:, None, None]
        side = self.amplitude / 2 * self.system.geometric
        band[wide + i - j - k, start[1:] + j] = side
        band[wide + i - j + k, start[:-1] + j] = side
        band[wide] += np.tile(self.system.eigenvalue, h)
        return band

    def bands(self, rate: Numbers) -> Numbers:
        """Return the matrix by its diagonals, of rates s + i h Omega; real where it is."""
        k, resists = len(self.system.eigenvalue), self.system.damping.any()
        square: Numbers = np.repeat(rate * rate, k)
        wide = 2 * k - 1
        if not resists and not rate.real.any():
            square = square.real
        band = self._still.astype(square.dtype)
        band[wide] += square
        if resists:
            i, j = np.indices((k, k))
            start = k * np.arange(len(rate))[:, None, None]
            band[wide + i - j, start + j] += rate[:, None, None] * self.system.damping
        return band

    def solve(self, rate: Numbers, right: Numbers) -> Numbers:
        """Return the matrix' inverse times columns."""
        from scipy.linalg import solve_banded

        wide = 2 * len(self.system.eigenvalue) - 1
        return solve_banded((wide, wide), self.bands(rate), right, check_finite=False)

    def times(self, rate: Numbers, motion: Numbers) -> Numbers:
        """Return the matrix times columns."""
        system, m = self.system, motion.shape[1]
        v = motion.reshape(len(rate), -1, m)
        square = (rate * rate)[:, None, None]
        out = (system.eigenvalue[:, None] + (square if np.iscomplexobj(v) else square.real)) * v
        if system.damping.any():
            out = out + rate[:, None, None] * (system.damping @ v)
        side = self.amplitude / 2 * (system.geometric @ v)
        out[1:] += side[:-1]
        out[:-1] += side[1:]
        return out.reshape(-1, m)

    def enough(self, motion: Numbers) -> bool:
        """Return whether the outer harmonics of motions, columns, hold next to nothing."""
        size = np.abs(motion.reshape(len(self.harmonic), -1, motion.shape[1])).max(axis=1)
        outer = np.concatenate([size[:2], size[-2:]])
        return bool((outer < OUTER * size.max(axis=0)).all())


class HillMotion(NamedTuple):
    """HillMotion exp(s t) sum_h v_h exp(i h Omega t)."""

    rate: complex  # s [1/s]
    error: float  # of rounding [1/s]
    start: Complex  # (2k,) q and q' at the beginning of a period
    harmonics: int  # h in all


def motion_next_to(
    system: ModalSystem, amplitude: float, period: float, rate: complex
) -> HillMotion | None:
    """Return the motion whose rate is next to a given one, None if it leads to none."""
    hill, k = Hill.of(system, amplitude, period), len(system.eigenvalue)
    for _ in range(STEPS):
        turning = 2j * np.pi / period * hill.harmonic
        column: Numbers = np.random.default_rng(0).normal(size=(k * len(turning), 1))
        try:
            for _ in range(2):
                column = hill.solve(rate + turning, column)
                column /= np.linalg.norm(column)
        except np.linalg.LinAlgError:
            return None  # motion that does not feel the pulsation, as rigid motion
        if not hill.enough(column):
            hill = hill.larger()
            continue
        each, v = np.repeat(rate + turning, k)[:, None], column.reshape(-1, k)
        # the matrix is symmetric: a motion is its own left one
        slope = complex((2 * each * column**2).sum() + np.einsum("hi,ij,hj", v, system.damping, v))
        change = complex((column * hill.times(rate + turning, column)).sum()) / slope
        rate -= change
        stiff = np.abs(each) ** 2 + np.abs(system.eigenvalue).max()
        error = EPS * float((stiff * np.abs(column) ** 2).sum()) / abs(slope)
        if abs(change) <= max(error, EPS * abs(rate)):
            start = np.concatenate([v.sum(axis=0), ((rate + turning)[:, None] * v).sum(axis=0)])
            return HillMotion(rate, error, start, len(turning))
    return None


def turns(system: ModalSystem, amplitude: float, period: float) -> int:
    """Return how many bands lie above Omega^2 at phase 0: multipliers that have come through 1."""
    from scipy.linalg import eigvals_banded

    hill = Hill.of(system, amplitude, period)
    rate = 2j * np.pi / period * hill.harmonic
    half = 2 * len(system.eigenvalue) - 1
    lower = hill.bands(rate)[half:]
    return int((eigvals_banded(lower, lower=True, check_finite=False) > 0).sum())


def order_of(rate: Numbers, motion: Numbers, nu: float) -> int:
    """Return n of the resonance n Omega = omega_i + omega_j of two that meet, columns of motions.

    The mean rate of the one that turns forward and of the other, by the action they carry; even
    where they meet at phase 0 and odd at pi, where one mode passes its rest n times in a period.
    """
    turning = rate.imag * (len(rate) - 1) / (rate.imag[-1] - rate.imag[0])
    is_real = abs(math.remainder(nu, 0.5)) <= SYMMETRIC
    if is_real and len(motion) == len(rate):
        return _passages(turning, motion[:, 0])
    size = (np.abs(motion.reshape(len(rate), -1)) ** 2).sum(axis=1)
    forward, backward = size * (turning > 0), size * (turning < 0)
    means = [(turning**2 @ part) / (np.abs(turning) @ part) for part in (forward, backward)]
    mean, odd = float(sum(means)), round(2 * nu) % 2
    return odd + 2 * round((mean - odd) / 2) if is_real else round(mean)


def _passages(turning: Real, motion: Numbers) -> int:
    """Return how often a motion, but for a factor real, changes its sign in a period."""
    count = SAMPLES * len(motion)
    # by symmetry it is at rest when the tension is largest or least: beside that
    turn = np.exp(2j * np.pi / count * np.multiply.outer(np.arange(count + 1) + BETWEEN, turning))
    value = turn @ motion
    return int((np.diff(np.sign((value * value[np.abs(value).argmax()].conj()).real)) != 0).sum())


class Flat(NamedTuple):
    """Where bands that meet are flat."""

    period: Real  # (1,) or (2,) [s], of the upper band first
    order: int


class _Bands(NamedTuple):
    """The bands next to a period at a phase, as many as may lie there together."""

    rate: Numbers  # (h,) of the harmonics [1/s]
    motion: Real  # (h k, m)
    level: Real  # (m,) Omega^2 beside that of the period, the highest first
    slope: Real  # (m, m) -d Omega^2/d nu

    @property
    def nearest(self) -> int:
        """The one next to the period."""
        return int(np.abs(self.level).argmin())

    @property
    def beside(self) -> range:
        """Those of which the next lower one may meet it there."""
        last = len(self.level) - 1
        return range(max(self.nearest - PAIRS, 0), min(self.nearest + PAIRS, last))

    def flat(self, number: int, beside: int | None = None) -> tuple[float, float] | None:
        """Return where a band is flat next to the phase: its level, and how far away.

        It bends at the one that is given, else at the one that bends it most.
        """
        x = 0.0
        for _ in range(BENT):
            level, mixed = np.linalg.eigh(np.diag(self.level) - x * self.slope)
            level, mixed = level[::-1], mixed[:, ::-1]
            slope = mixed.T @ self.slope @ mixed
            other = _bending(level, slope, number) if beside is None else beside
            step = _to_flat(level, slope, number, other)
            if step is None:
                return None
            x += step
            if abs(step) <= SETTLED:
                break
        return float(level[number]), x


def _bands(hill: Hill, square: float, nu: float) -> _Bands:
    """Return the bands next to Omega^2 at a phase in turns, all of those that lie together."""
    most = 2 * len(hill.system.eigenvalue)
    for count in (*(one for one in COUNTS if one < most), most):
        found = _next_to(hill, square, nu, count)
        if np.abs(found.level).max() > APART * square:
            break
    return found


def _next_to(hill: Hill, square: float, nu: float, count: int) -> _Bands:
    """Return so many bands next to Omega^2 at a phase, by inverse iteration."""
    from scipy.linalg import eigh

    k = len(hill.system.eigenvalue)
    rate = 1j * math.sqrt(square) * (hill.harmonic + nu)
    turning = np.repeat(hill.harmonic + nu, k)[:, None]
    basis = np.random.default_rng(0).normal(size=(len(turning), count))
    for _ in range(INVERSE):
        basis = np.linalg.qr(hill.solve(BESIDE * rate, turning**2 * basis))[0]
    level, mixed = eigh(basis.T @ hill.times(rate, basis), basis.T @ (turning**2 * basis))
    motion = (basis @ mixed)[:, ::-1]
    slope = 2 * square * (motion.T @ (turning * motion))
    return _Bands(rate, motion, level[::-1], slope)


def _bending(level: Real, slope: Real, number: int) -> int:
    """Return the band that bends another one most."""
    apart = np.abs(level[number] - level)
    bend = np.divide(slope[number] ** 2, apart, out=np.full(len(level), np.inf), where=apart > 0)
    bend[number] = -1.0
    return int(bend.argmax())


def _to_flat(level: Real, slope: Real, number: int, other: int) -> float | None:
    """Return how far away a band is flat beside one other, None where both turn the same way."""
    # mean - drift x +- sqrt(r^2 (x - middle)^2 + gap^2)
    drift = (slope[number, number] + slope[other, other]) / 2
    tilt = (slope[number, number] - slope[other, other]) / 2
    half, r = (level[number] - level[other]) / 2, math.hypot(tilt, slope[number, other])
    if r <= abs(drift):
        return None
    gap = half * abs(slope[number, other]) / r
    return float(half * tilt / r**2 + drift * gap / (r * math.sqrt(r * r - drift * drift)))


def _enough(system: ModalSystem, amplitude: float, period: float, nu: float) -> tuple[Hill, _Bands]:
    """Return Hill's matrix with harmonics enough, and its bands next to a period and a phase."""
    hill = Hill.of(system, amplitude, period)
    while True:
        bands = _bands(hill, (2 * np.pi / period) ** 2, nu)
        if hill.enough(bands.motion[:, [bands.nearest]]):
            return hill, bands
        hill = hill.larger()


def flat_band(system: ModalSystem, amplitude: float, period: float, phase: float) -> Flat:
    """Return where the band next to a period and a phase is flat."""
    nu, square = phase / (2 * np.pi), (2 * np.pi / period) ** 2
    _, bands = _enough(system, amplitude, period, nu)
    which = bands.nearest
    level = float(bands.level[which])
    # at phases 0 and pi by symmetry
    if abs(math.remainder(nu, 0.5)) > SYMMETRIC and (flat := bands.flat(which)) is not None:
        level = flat[0] if abs(flat[0] - level) < MOVES * square else level
    found = np.array([2 * np.pi / math.sqrt(square + level)])
    return Flat(found, order_of(bands.rate, bands.motion[:, [which]], nu))


def flat_pair(system: ModalSystem, amplitude: float, period: float, phase: float) -> Flat | None:
    """Return where two bands that nearly meet at a period and a phase are flat, if they are."""
    nu, square = phase / (2 * np.pi), (2 * np.pi / period) ** 2
    hill, bands = _enough(system, amplitude, period, nu)
    for _ in range(STEPS):
        found = []
        for upper in bands.beside:
            each = bands.flat(upper, upper + 1), bands.flat(upper + 1, upper)
            flats = [one for one in each if one is not None]
            if len(flats) == 2:
                level, away = np.transpose(flats)
                found.append((float(np.abs(level).min()), upper, level, float(away.mean())))
        if not found:
            return None
        _, upper, level, step = min(found, key=lambda one: one[0])
        if abs(step) <= SETTLED:
            break
        nu += step
        bands = _bands(hill, square, nu)
    order = order_of(bands.rate, bands.motion[:, upper : upper + 2], nu)
    return Flat(2 * np.pi / np.sqrt(square + level), order)
