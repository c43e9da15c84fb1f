"""Forces as functions of time."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY, dataclass
from typing import Protocol

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.errors import SceneError
from ..base.parameter import Description, number

HALVES = 2.0**27 + 1  # Parts numbers in halves whose products are exact: Dekker (1971).
ANY = "N or N m or m or rad"
"""What drives is a force, a moment, or the motion of an end, and has one of these units."""


def rotation(frequency: float, time: Real | float, phase: float) -> Real:
    """Return 2 pi frequency time + phase [rad] less whole turns, to the last digit at any time."""
    (f, by_f), (t, by_t) = np.frexp(frequency), np.frexp(time)
    (high_f, low_f), (high_t, low_t) = _halves(f), _halves(t)
    product = f * t
    lost = ((high_f * high_t - product) + high_f * low_t + low_f * high_t) + low_f * low_t
    turns = np.fmod(np.ldexp(product, by_f + by_t), 1.0) + np.ldexp(lost, by_f + by_t)
    return np.asarray(2 * np.pi * turns + phase)


def _halves(number: Real) -> tuple[Real, Real]:
    """Return two halves of the digits."""
    high = HALVES * number - (HALVES * number - number)
    return high, number - high


class Force(Protocol):
    """What the analyses ask of a force, or of the motion of an end, in time.

    >>> import ropedyn as rd
    >>> rd.Step(10.0, time=0.5).value(np.array([0.0, 0.5, 1.0]))
    array([ 0., 10., 10.])
    >>> rd.Sine(10.0, 0.5).rate(np.array([0.0, 1.0])).round(4)
    array([ 31.4159, -31.4159])
    >>> rd.Sine(10.0, 70.0).bandwidth, rd.Impulse(0.1, time=0.5).blows
    (70.0, ((0.5, 0.1),))
    >>> rd.Chirp(10.0, 20.0, 400.0, 2.0).breaks, rd.Chirp(10.0, 20.0, 400.0, 2.0).highest
    ((2.0,), 400.0)
    """

    def value(self, time: Real) -> Real:
        """Return it at times [s], of the time's shape; from the right where it jumps."""

    def rate(self, time: Real) -> Real:
        """Return its derivative at times [s], of the time's shape; from the right at `breaks`."""

    @property
    def breaks(self) -> tuple[float, ...]:
        """When it jumps or bends [s], the times of samples apart."""
        return ()

    @property
    def blows(self) -> tuple[tuple[float, float], ...]:
        """Impulses at one instant: when [s] and how much [N s, N m s]."""
        return ()

    @property
    def highest(self) -> float:
        """Frequency that steps must resolve to see it at all [Hz]; 0 of what only breaks."""
        return 0.0

    @property
    def bandwidth(self) -> float:
        """Frequency up to which modes must reach to follow it between its breaks [Hz]."""
        return self.highest


class Sine(Description, Force):
    """amplitude sin(2 pi frequency t + phase), from t = 0 on.

    Parameters
    ----------
    amplitude : float
        [N, N m; m or rad as motion of an end].
    frequency : float
        [Hz].
    phase : float
        [rad].

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite or the frequency is negative.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.Sine(10.0, 70.0).frequency
    70.0
    """

    amplitude: float = number(ANY)
    frequency: float = number("Hz", sign="nonnegative")
    _: KW_ONLY
    phase: float = number("rad", default=0.0)

    def value(self, time: Real) -> Real:
        """Return it at times [s]."""
        angle = rotation(self.frequency, time, self.phase)
        return np.asarray(self.amplitude * np.sin(angle))

    def rate(self, time: Real) -> Real:
        """Return its derivative at times [s]."""
        angle = rotation(self.frequency, time, self.phase)
        return np.asarray(self.amplitude * 2 * np.pi * self.frequency * np.cos(angle))

    @property
    def highest(self) -> float:
        """Its frequency."""
        return self.frequency


class Chirp(Description, Force):
    """amplitude sin(phase(t)), whose frequency grows or falls steadily; nothing after it.

    phase(t) = phase + 2 pi (start t + (stop - start) t^2/(2 duration)) for t from 0 to `duration`.

    Parameters
    ----------
    amplitude : float
        [N, N m; m or rad as motion of an end].
    start, stop : float
        Frequency at t = 0 and at the end [Hz].
    duration : float
        [s].
    phase : float
        At t = 0 [rad].

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite, a frequency is negative or the duration is not positive.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.Chirp(10.0, 20.0, 400.0, 2.0).stop
    400.0
    """

    amplitude: float = number(ANY)
    start: float = number("Hz", sign="nonnegative")
    stop: float = number("Hz", sign="nonnegative")
    duration: float = number("s", sign="positive")
    _: KW_ONLY
    phase: float = number("rad", default=0.0)

    def value(self, time: Real) -> Real:
        """Return it at times [s]."""
        rate = (self.stop - self.start) / self.duration
        angle = 2 * np.pi * (self.start + rate * time / 2) * time + self.phase
        acts = (time >= 0) & (time < self.duration)
        return np.where(acts, self.amplitude * np.sin(angle), 0.0)

    def rate(self, time: Real) -> Real:
        """Return its derivative at times [s]."""
        rate = (self.stop - self.start) / self.duration
        omega = 2 * np.pi * (self.start + rate * time)
        angle = 2 * np.pi * (self.start + rate * time / 2) * time + self.phase
        acts = (time >= 0) & (time < self.duration)
        return np.where(acts, self.amplitude * omega * np.cos(angle), 0.0)

    @property
    def breaks(self) -> tuple[float, ...]:
        """Its end."""
        return (self.duration,)

    @property
    def highest(self) -> float:
        """The higher of its frequencies."""
        return max(self.start, self.stop)


class Step(Description, Force):
    """A force that is there from a time on.

    Parameters
    ----------
    amplitude : float
        [N, N m; m or rad as motion of an end].
    time : float
        When it begins [s].

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite or the time is negative.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.Step(10.0).time
    0.0
    """

    amplitude: float = number(ANY)
    _: KW_ONLY
    time: float = number("s", sign="nonnegative", default=0.0)

    def value(self, time: Real) -> Real:
        """Return it at times [s]."""
        return np.where(time >= self.time, self.amplitude, 0.0)

    def rate(self, time: Real) -> Real:
        """Return its derivative at times [s]."""
        return np.zeros_like(time)

    @property
    def breaks(self) -> tuple[float, ...]:
        """Its time."""
        return (self.time,)


class Impulse(Description, Force):
    """A blow: an impulse at one instant, or a half sine of the same impulse.

    A blow at an instant makes a string jump and a beam's velocity infinite where it hits; that of a
    hammer lasts 0.1 to 5 ms.

    Parameters
    ----------
    impulse : float
        Integral of the force [N s, N m s].
    time : float
        When it begins [s].
    duration : float
        0: at an instant [s].

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite, or a time is negative.

    Examples
    --------
    >>> import ropedyn as rd
    >>> print(rd.Impulse(0.01, duration=1e-3).amplitude.round(3))
    15.708
    """

    impulse: float = number("N s or N m s")
    _: KW_ONLY
    time: float = number("s", sign="nonnegative", default=0.0)
    duration: float = number("s", sign="nonnegative", default=0.0)

    @property
    def amplitude(self) -> float:
        """Largest force [N, N m]; infinite at an instant."""
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.float64(self.impulse) * math.pi / 2 / self.duration

    def value(self, time: Real) -> Real:
        """Return it at times [s]; 0 of a blow at an instant."""
        if self.duration == 0:
            return np.zeros_like(time)
        since = time - self.time
        acts = (since >= 0) & (since < self.duration)
        return np.where(acts, self.amplitude * np.sin(np.pi * since / self.duration), 0.0)

    def rate(self, time: Real) -> Real:
        """Return its derivative at times [s]."""
        if self.duration == 0:
            return np.zeros_like(time)
        since = time - self.time
        acts = (since >= 0) & (since < self.duration)
        slope = self.amplitude * np.pi / self.duration * np.cos(np.pi * since / self.duration)
        return np.where(acts, slope, 0.0)

    @property
    def breaks(self) -> tuple[float, ...]:
        """Where it begins and ends."""
        return (self.time, self.time + self.duration)

    @property
    def blows(self) -> tuple[tuple[float, float], ...]:
        """Itself, at an instant."""
        return ((self.time, self.impulse),) if self.duration == 0 else ()

    @property
    def bandwidth(self) -> float:
        """That of its half sine."""
        return 1 / (2 * self.duration) if self.duration > 0 else 0.0


@dataclass(frozen=True, eq=False)
class Samples(Force):
    """A force by its samples, a straight line between two of them."""

    time: Real  # (t,) when [s]
    sample: Real  # (t,) what [N, N m; m or rad as motion of an end]

    def value(self, time: Real) -> Real:
        """Return it at times [s]."""
        return self.sample if time is self.time else np.interp(time, self.time, self.sample)

    def rate(self, time: Real) -> Real:
        """Return its derivative at times [s]."""
        slope = np.diff(self.sample) / np.diff(self.time)
        at = np.searchsorted(self.time, time, side="right") - 1
        return np.asarray(slope[np.clip(at, 0, len(slope) - 1)])


@dataclass(frozen=True)
class Sum(Force):
    """Several forces at once."""

    forces: tuple[Force, ...]

    def value(self, time: Real) -> Real:
        """Return it at times [s]."""
        return np.sum([force.value(time) for force in self.forces], axis=0)

    def rate(self, time: Real) -> Real:
        """Return its derivative at times [s]."""
        return np.sum([force.rate(time) for force in self.forces], axis=0)

    @property
    def breaks(self) -> tuple[float, ...]:
        """Those of each."""
        return tuple(at for force in self.forces for at in force.breaks)

    @property
    def blows(self) -> tuple[tuple[float, float], ...]:
        """Those of each."""
        return tuple(blow for force in self.forces for blow in force.blows)

    @property
    def highest(self) -> float:
        """The highest of each."""
        return max((force.highest for force in self.forces), default=0.0)

    @property
    def bandwidth(self) -> float:
        """The highest of each."""
        return max((force.bandwidth for force in self.forces), default=0.0)


def peak(force: Force, time: Real) -> float:
    """Return the largest value from the first of some times to the last, of parts together."""
    if isinstance(force, Sum):
        return sum(peak(one, time) for one in force.forces)
    begin, end = float(time[0]), float(time[-1])
    breaks = np.array([begin, *(at for at in force.breaks if begin < at < end), end])
    at = np.concatenate([time, (breaks[1:] + breaks[:-1]) / 2])
    value = np.abs(force.value(at))
    if force.highest > 0:  # times may be those where a sine is zero
        rate = np.abs(force.rate(at))
        whole = np.hypot(value, rate / (2 * np.pi * force.highest))
        value = np.minimum(whole, value + rate * (end - begin))
    return float(value.max())


def is_sampled(force: Force) -> bool:
    """Whether it bends at every time that is asked for."""
    if isinstance(force, Sum):
        return any(map(is_sampled, force.forces))
    return isinstance(force, Samples)


KINDS = (Sine, Chirp, Step, Impulse)  # What users give beside arrays.


def forces(given: object, name: str, time: Real, unit: str = ANY) -> Force:
    """Return a force from one of `KINDS`, an array over time or a sequence of these."""
    if isinstance(given, KINDS):
        return given
    if isinstance(given, (tuple, list)) and any(isinstance(one, KINDS) for one in given):
        return Sum(tuple(forces(one, f"{name}[{k}]", time, unit) for k, one in enumerate(given)))
    sample = check.numbers(given, name, unit)
    if sample.shape != time.shape:
        raise SceneError(
            f"{name} must be one number for each of the {len(time)} times, got {len(sample)}"
        )
    return Samples(time, sample)
