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
    time: Real, value: Real, push: Callable[[Real], Complex], *, band: Any, at_rest: bool
) -> tuple[Estimate, float]:
    """Estimate responses (responses, t) per force whose transform at angular frequencies is known.

    Of the whole record; and how much what lies above half the rate of the times may add to a line,
    in parts of the largest: the motion in the last eighth of the lines, which falls on from there.
    """
    step, n = time_step(time), len(time)
    frequency: Real = np.fft.rfftfreq(n, step).astype(np.float64)
    omega = 2 * np.pi * frequency
    moved = step * np.fft.rfft(value, axis=1) * np.exp(-1j * omega * time[0])
    pushed = push(omega)
    if not pushed.any():
        raise SceneError("force must drive within the times, got 0")
    kept = _kept(frequency, np.abs(pushed) ** 2, _band(band), at_rest)
    found = moved[:, kept] / pushed[kept]
    above = np.abs(moved[:, -max(1, n // 16) :]).max(axis=1, keepdims=True)
    size, most = np.abs(found).max(), np.max(above / np.abs(pushed[kept]))
    return Estimate(frequency[kept], found, None, None), float(most / size) if size > 0 else 0.0


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
    if not kept.any():
        raise SceneError(f"band must hold a frequency the force has, got {check.shown(band)}")
    return kept
