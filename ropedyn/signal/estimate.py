"""Estimate of the frequency response from motion over time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.array import Complex, Flags, Real
from ..base.errors import SceneError
from .spectrum import time_step, window_weights
from .transfer import ESTIMATORS, Spectra, coherence_of, forced

OVERLAPPING = 0.53
"""Segments of Hann's window that half overlap count so many times as independent ones: Bendat and
Piersol (2010), section 11.5.2.2."""
FOLDED = (1, 2, 3)  # So many rates above, what folds into the lines is added up.
STEEPER = 2  # So many powers of the frequency more, a beam's responses fall than a string's.
OVER = 4  # Responses may be so many times as large above half the rate as in the octave below it.
DRIVEN = 0.1  # Lines with less of the largest force tell more of what folded into them.


class Estimate(NamedTuple):
    """Responses per force."""

    frequency: Real  # (f,) [Hz]
    value: Complex  # (responses, f)
    coherence: Real | None  # (responses, f), of several segments
    averages: float | None  # as so many independent ones, where the window tells


def estimate(
    time: Real,
    value: Real,
    force: Real,
    *,
    drive: int,
    segments: int,
    window: str | None,
    band: Any,
    at_rest: bool,
    estimator: str = "H1",
) -> Estimate:
    """Estimate responses (responses, t) per force of one of the drives (drives, t)."""
    # see `History.frf`; the line at 0 Hz is left out unless it says what holds at rest
    from scipy import signal

    step, n = time_step(time), len(time)
    push = _alone(force, drive)
    most = max(1, n // 8)
    length = int(2 * n // (check.count(segments, "segments", most=most) + 1))
    if segments == 1:
        length = n
    if window is None:
        window = "boxcar" if segments == 1 else "hann"
    how = {
        "fs": 1 / step,
        "window": window_weights(window, length),
        "noverlap": 0 if segments == 1 else length // 2,
        "detrend": False,
    }
    frequency, cross = signal.csd(push, value, **how)
    _, power = signal.welch(push, **how)
    _, motion = signal.welch(value, **how)
    kept = _kept(frequency, power, _band(band), at_rest)
    spectra = Spectra(power[kept], cross[:, kept], motion[:, kept])
    coherence = averages = None
    if segments > 1:
        coherence = coherence_of(spectra)
        averages = OVERLAPPING * segments if window == "hann" else None
    return Estimate(frequency[kept], ESTIMATORS[estimator](spectra), coherence, averages)


def estimate_known(
    time: Real,
    value: Real,
    push: Callable[[Real], Complex],
    *,
    error: Real,
    falls: int,
    band: Any,
    at_rest: bool,
) -> tuple[Estimate, float, float]:
    """Estimate responses (responses, t) per force whose transform at angular frequencies is known.

    Of the whole record; with how much a line may have too much, in parts of the largest: of what
    folds, where responses fall with such a power of the frequency, and of the error of the motion.
    """
    step, n = time_step(time), len(time)
    frequency: Real = np.fft.rfftfreq(n, step).astype(np.float64)
    omega = 2 * np.pi * frequency
    moved = step * np.fft.rfft(value, axis=1) * np.exp(-1j * omega * time[0])
    pushed = push(omega)
    if not pushed.any():
        raise SceneError("force must drive within the times, got 0")
    kept = _kept(frequency, np.abs(pushed) ** 2, _band(band), at_rest)
    found, least = moved[:, kept] / pushed[kept], np.abs(pushed[kept])
    above = _above(frequency, moved, pushed, push, half=0.5 / step, falls=falls)
    folded = np.max(above[kept] / least)
    missed = step * np.max(error.sum(axis=1)) / least.min()
    size = np.abs(found).max() or np.inf
    return Estimate(frequency[kept], found, None, None), float(folded / size), float(missed / size)


def _above(
    frequency: Real,
    moved: Complex,
    pushed: Complex,
    push: Callable[[Real], Complex],
    *,
    half: float,
    falls: int,
) -> Real:
    """Guess what lies above half the rate of the times and folds into each line.

    The force is known there, and responses fall on from the two octaves below.
    """
    size, high = np.abs(pushed), []
    for least, most in ((half / 4, half / 2), (half / 2, half)):
        within = (frequency >= least) & (frequency <= most)
        driven = within & (size > 0) & (size >= DRIVEN * size[within].max(initial=0.0))
        high.append(np.abs(moved[:, driven] / size[driven]).max(initial=0.0))
    steep = np.log2(high[0] / high[1]) if min(high) > 0 else falls
    fall = float(np.clip(steep, falls, falls + STEEPER))
    total = np.zeros(frequency.shape)
    for one in (k * 2 * half + sign * frequency for k in FOLDED for sign in (-1, 1)):
        total += np.abs(push(2 * np.pi * one)) * (half / one) ** fall
    return OVER * high[1] * total


def _alone(force: Real, drive: int) -> Real:
    """Return the force that alone drives."""
    if len(force) == 0:
        raise SceneError("drive must be there for a response per force: the motion is free")
    check.count(drive, "drive", least=0, most=len(force) - 1)
    for k, other in enumerate(force):
        if k != drive and other.any():
            raise SceneError(f"force must be 0 at other drives than {drive}, got some at {k}")
    if not force[drive].any():
        raise SceneError(
            f"force of drive {drive} must be known at the times, got 0 at all of them: "
            "a blow needs a duration"
        )
    return np.asarray(force[drive])


def _band(given: Any) -> Real | None:
    """Return the lowest and the highest frequency that are asked for [Hz]."""
    if given is None:
        return None
    band = check.numbers(given, "band", "Hz", sign="nonnegative")
    if len(band) != 2 or not band[0] < band[1]:
        raise SceneError(
            f"band must be two frequencies that increase [Hz], got {check.shown(given)}"
        )
    return band


def _kept(frequency: Real, power: Real, band: Real | None, at_rest: bool) -> Flags:
    """Return which lines are told: those of the band, or where the force is not small."""
    if band is None:
        kept = forced(power)
    else:
        kept = (frequency >= band[0]) & (frequency <= band[1]) & (power > 0)
    # a velocity at 0 Hz says nothing of the displacement there
    kept &= (frequency > 0) | at_rest
    if not kept.any() and band is None:
        raise SceneError(
            "band must be given for responses of velocity or acceleration where the force has "
            "little above 0 Hz, as one that stays"
        )
    if not kept.any():
        raise SceneError(f"band must hold a frequency the force has, got {check.shown(band)}")
    return kept
