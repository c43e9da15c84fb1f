"""Estimate of the frequency response from motion over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import check
from ..base.array import Flags, Real
from ..base.errors import SceneError
from ..base.unit import MOTIONS, QUANTITIES
from ..curves.measured import Measured
from .spectrum import time_step, window_weights

if TYPE_CHECKING:
    from ..motion.history import History

OVERLAPPING = 0.53
"""Segments of Hann's window that half overlap count so many times as independent ones: Bendat and
Piersol (2010), section 11.5.2.2."""

FLOOR = 1e-3
"""Lines where the force is less than this part of its largest line are left out."""


def estimate(
    history: History, drive: int, segments: int, window: str | None, band: Any
) -> Measured:
    """Estimate the response per force; see `History.frf`."""
    from scipy import signal

    step, n = time_step(history.time), len(history.time)
    force = _force(history, drive)
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
    frequency, cross = signal.csd(force, history.value, **how)
    _, power = signal.welch(force, **how)
    kept = _kept(frequency, power, _band(band), history.quantity)
    coherence = None
    if segments > 1:
        # rounding may lift it above 1
        coherence = np.minimum(signal.coherence(force, history.value, **how)[1][:, kept], 1.0)
    names = {times: name for name, times in QUANTITIES.items()}
    return Measured(
        frequency=frequency[kept],
        value=cross[:, kept] / power[kept],
        drive=(history.drive[drive],),
        response=history.response,
        quantity=names[MOTIONS[history.quantity]],
        coherence=coherence,
        averages=OVERLAPPING * segments if coherence is not None and window == "hann" else None,
    )


def _force(history: History, drive: int) -> Real:
    """Return the force that alone drives."""
    if not history.drive:
        raise SceneError("drive must be there for a response per force: the motion is free")
    check.count(drive, "drive", least=0, most=len(history.drive) - 1)
    for k, force in enumerate(history.force):
        if k != drive and force.any():
            raise SceneError(f"force must be 0 at other drives than {drive}, got some at {k}")
    if not history.force[drive].any():
        raise SceneError(
            f"force of drive {drive} must be known at the times, got 0 at all of them: "
            "a blow needs a duration"
        )
    return history.force[drive]


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


def _kept(
    frequency: Real,
    power: Real,
    band: Real | None,
    quantity: str,
) -> Flags:
    """Return which lines are told: those of the band, or where the force is not small."""
    if band is None:
        kept = power > FLOOR**2 * power.max()
    else:
        kept = (frequency >= band[0]) & (frequency <= band[1]) & (power > 0)
    # a velocity at 0 Hz says nothing of the displacement there
    kept &= (frequency > 0) | (quantity == "displacement")
    if not kept.any():
        raise SceneError(f"band must hold a frequency the force has, got {check.shown(band)}")
    return kept
