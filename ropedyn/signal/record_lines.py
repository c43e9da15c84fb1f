"""Pieces of a record as Fourier lines and as averaged densities."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Real
from .band_fit import Lines
from .spectrum import window_weights

DRIFT_CUT = 1 / 3  # Drift is taken away below this part of the lowest frequency.
FLOOR_SHARE, FLOOR_WIDTH, FLOOR_LINES = 35.0, 1.0, 31
"""Floor: this percentile of the lines around, over so many Hz, or lines where these are more."""


class Density(NamedTuple):
    """One-sided cross densities of channels, as means over segments."""

    frequency: Real  # (f,) [Hz]
    value: Complex  # (channels, channels, f)
    averages: float  # segments that half overlap


def without_drift(pieces: Sequence[Real], rate: float, lowest: float) -> list[Real]:
    """Return pieces (channels, t) without what is slower than a third of the lowest frequency."""
    from scipy import signal

    # forth and back: no phase, and twice the order
    filtering = signal.butter(2, DRIFT_CUT * lowest, "highpass", fs=rate, output="sos")
    level = [signal.detrend(piece, axis=-1) for piece in pieces]
    return [signal.sosfiltfilt(filtering, piece, axis=-1) for piece in level]


def lines_of(pieces: Sequence[Real], rate: float) -> Lines:
    """Return the lines of all pieces, each of its whole length without a taper."""
    from scipy import fft

    frequency = [fft.rfftfreq(piece.shape[1], 1 / rate) for piece in pieces]
    value = [fft.rfft(piece) / np.sqrt(piece.shape[1] * rate) for piece in pieces]
    duration = np.repeat([piece.shape[1] / rate for piece in pieces], [len(f) for f in frequency])
    every = np.concatenate(frequency)
    order = np.argsort(every, kind="stable")
    return Lines(every[order], duration[order], np.concatenate(value, axis=1)[:, order])


def density(pieces: Sequence[Real], rate: float, length: int, window: str) -> Density:
    """Return the means over segments of so many samples that half overlap (Welch)."""
    from scipy import signal

    total, count = 0.0, 0
    weights = window_weights(window, length)
    for piece in pieces:
        segments = (piece.shape[1] - length // 2) // (length - length // 2)
        if segments < 1:
            continue
        frequency, value = signal.csd(
            piece[:, np.newaxis], piece[np.newaxis], fs=rate, window=weights
        )
        total, count = total + segments * value, count + segments
    return Density(frequency, total / count, count)


def floor_of(power: Real, step: float) -> Real:
    """Return what lies under the peaks of densities (channels, f) at lines of this distance."""
    from scipy.ndimage import percentile_filter

    size = max(FLOOR_LINES, round(FLOOR_WIDTH / step))
    return percentile_filter(power, FLOOR_SHARE, size=(1, size), mode="nearest")
