"""The rates on a line Re s = a at which motion over a record is looked at."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...base.array import Complex, Index, Real
from ...base.computed import computed
from ...base.errors import SolveError

PERIODS = ((1e-5, (1.25, 1e-9)), (1e-6, (1.4, 1e-9)), (0.0, (2.0, 1e-11)))
"""From this tolerance on the period is so much longer than the record, and this alias is left."""
LONGEST = 2.0  # It is this long at most: what moves longer before its cause is no motion of ropes.
FADED = 16.0  # The next period's motion before its cause has faded by e^-16, and by its decay.
EVEN = 1e-6  # Times that are off by this part of a step are even,
SHARE = 0.1  # or by this part of a tolerance, or by
ROUNDED = 4 * np.finfo(float).eps  # this part of the latest.
FINEST = 64  # Lines reach so many times as far as the times resolve at first, at most.
LEAST = 256  # Other times are looked at by so many even steps at least.
MOST = 1 << 22  # So many numbers are computed at a time.
FEW = 9  # So many rates tell roughly what all do.
SLOWER = 64  # Later motion is seen where it fades so much slower.


def is_even(time: Real, tolerance: float = math.inf) -> bool:
    """Whether times are in equal steps, as near as a tolerance asks."""
    rounded = ROUNDED * np.abs(time[[0, -1]]).max() * (len(time) - 1) / float(time[-1] - time[0])
    return off(time) <= max(min(EVEN, SHARE * tolerance), rounded)


def off(time: Real) -> float:
    """Return how far times are from ones in equal steps, over a step."""
    even, step = np.linspace(time[0], time[-1], len(time), retstep=True)
    return float(np.abs(time - even).max() / step)


@dataclass(frozen=True, eq=False)
class Grid:
    """Rates s_k = a + 2 pi i k/P, of motion over a period P that begins with the record.

    y(t) = e^(a t)/P sum over all k of y(s_k) e^(2 pi i k t/P) is the motion and e^(-a P) times that
    of a period later.
    """

    time: Real  # (t,) when motion is asked for [s]
    even: bool  # whether in equal steps
    steps: int  # of equal length, that the record has
    count: int  # and the period: an even number
    a: float  # [1/s]
    finer: int  # lines reach so many times as far as these steps resolve
    decay: float  # e^(-a P), but for growth
    ahead: float  # how fast motion fades before its cause [1/s]

    @classmethod
    def over(
        cls,
        time: Real,
        tolerance: float,
        *,
        growth: float,
        ahead: float,
        omega: float = 0.0,
        least: int = 1,
    ) -> Grid:
        """Return one whose lines reach so many times as far as the times resolve, and to omega.

        Motion grows and fades before its cause at these rates [1/s].
        """
        from scipy.fft import next_fast_len

        longer, decay = next(pair for most, pair in PERIODS if tolerance >= most)
        steps = len(time) - 1
        span = float(time[-1] - time[0])
        rest = (FADED - math.log(decay)) / (ahead - growth) if ahead > growth else math.inf
        longer = max(longer, 1 + rest / span)
        if longer > LONGEST:
            raise SolveError(
                'elements must be more or element "rigid": the end correction leaves lumps of '
                f"negative inertia, which move at {ahead:.3g} 1/s, within what the times tell"
            )
        even = is_even(time, tolerance)
        if not even:
            steps = max(steps, LEAST)
        count = 2 * next_fast_len(math.ceil(longer * (steps + 1) / 2), real=True)
        a = growth - math.log(decay) * steps / (count * span)
        resolved = math.pi * steps / span
        finer = max(least, math.ceil(min(omega / resolved, FINEST)), math.ceil(2 * LEAST / count))
        return cls(time, even, steps, count, a, finer, decay, ahead)

    @property
    def begin(self) -> float:
        """The first time [s]."""
        return float(self.time[0])

    @property
    def step(self) -> float:
        """Of the even times [s]."""
        return float(self.time[-1] - self.time[0]) / self.steps

    @property
    def period(self) -> float:
        """P [s]."""
        return self.step * self.count

    @property
    def lines(self) -> int:
        """How many rates there are beside a."""
        return self.finer * self.count // 2

    @property
    def omega(self) -> float:
        """The highest angular frequency [rad/s]."""
        return 2 * math.pi * self.lines / self.period

    @computed
    def s(self) -> Complex:
        """The rates, shape (lines + 1,)."""
        return np.asarray(self.a + 2j * math.pi / self.period * np.arange(self.lines + 1))

    @computed
    def few(self) -> Index:
        """Which rates tell roughly what all do, from the slowest to the fastest."""
        return np.unique(np.geomspace(1, self.lines, FEW).astype(np.intp))

    @computed
    def slow(self) -> Grid:
        """Rates at which later motion has hardly faded."""
        a = self.a + math.log(self.decay) / self.period * (1 - 1 / SLOWER)
        return replace(self, a=a, finer=1)

    def exponentials(self, since: Real, weight: Real, rates: range) -> Complex:
        """Return the sum of weight e^(-s t) at some rates, of times (n,) since the first."""
        low, high = _digits(rates)
        turn = -2j * math.pi / self.period
        total = np.zeros((len(high), len(low)), dtype=np.complex128)
        most = max(1, MOST // (len(low) + len(high)))
        for k in range(0, len(since), most):
            t = since[k : k + most]
            size = weight[k : k + most] * np.exp(-self.a * t)
            far = np.exp(turn * np.multiply.outer(high, t)) * size
            total += far @ np.exp(turn * np.multiply.outer(t, low))
        return total.ravel()[: len(rates)]

    def summed(self, spectrum: Complex, since: Real) -> Real:
        """Return the motion of spectra (r, lines + 1) at times (n,) since the first, (r, n)."""
        low, high = _digits(range(len(self.s)))
        table = np.zeros((len(spectrum), len(high) * len(low)), dtype=np.complex128)
        table[:, : len(self.s)] = spectrum * (2 / self.period)
        table[:, 0] /= 2
        table = table.reshape(-1, len(low))
        turn = 2j * math.pi / self.period
        value = np.empty((len(spectrum), len(since)))
        most = max(1, MOST // (len(table) + len(low)))
        for k in range(0, len(since), most):
            t = since[k : k + most]
            near = table @ np.exp(turn * np.multiply.outer(low, t))
            far = np.exp(turn * np.multiply.outer(high, t))
            near = near.reshape(len(spectrum), len(high), len(t))
            wave = np.einsum("rot,ot->rt", near, far).real
            value[:, k : k + most] = np.exp(self.a * t) * wave
        return value

    def finely(self, spectrum: Complex) -> Real:
        """Return the motion of spectra at so many even times of the period, (.., 2 lines)."""
        from scipy.fft import irfft

        return np.asarray(self._growth * irfft(spectrum, 2 * self.lines, axis=-1))

    @computed
    def _growth(self) -> Real:
        """What these times make of sums of e^(2 pi i k t/P)/(2 lines)."""
        count = 2 * self.lines
        step = self.period / count
        return np.asarray(np.exp(self.a * step * np.arange(count)) / step)


def _digits(numbers: range) -> tuple[Index, Index]:
    """Return numbers of which these are the sums: low ones, and high ones in even steps."""
    inner = math.isqrt(len(numbers)) + 1
    return np.arange(inner), numbers.start + np.arange(-(-len(numbers) // inner)) * inner
