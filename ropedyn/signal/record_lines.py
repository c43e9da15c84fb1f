"""Pieces of a record as Fourier lines and as averaged densities."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..base.array import Complex, Real
from .band_fit import FourierLines
from .spectrum import window_weights

DRIFT_CUT = 1 / 3  # Drift is taken away below this part of the lowest frequency.
ENOUGH = 4.0  # Samples in a cycle of the highest frequency; fewer fold something onto it.
FLOOR_SHARE, FLOOR_WIDTH, FLOOR_LINES = 35.0, 1.0, 31
"""Floor: this percentile of the lines around, over so many Hz, or lines where these are more."""


class Density(NamedTuple):
    """One-sided cross densities of channels, as means over segments."""

    frequency: Real  # (f,) [Hz]
    value: Complex  # (channels, channels, f)
    averages: int  # segments that half overlap

    @property
    def power(self) -> Real:
        """Densities of each channel, (channels, f)."""
        return np.real(np.einsum("iif->if", self.value)).copy()


def without_drift(pieces: Sequence[Real], rate: float, lowest: float) -> list[Real]:
    """Return pieces (channels, t) without what is slower than a third of the lowest frequency."""
    from scipy import signal

    # forth and back: no phase, and twice the order
    filtering = signal.butter(2, DRIFT_CUT * lowest, "highpass", fs=rate, output="sos")
    level = [signal.detrend(piece, axis=-1) for piece in pieces]
    return [signal.sosfiltfilt(filtering, piece, axis=-1) for piece in level]


def resampled(pieces: Sequence[Real], rate: float, below: float) -> tuple[list[Real], float]:
    """Return pieces with no more samples than frequencies up to a highest one need."""
    from scipy import signal

    fewer = int(rate / (ENOUGH * below))
    if fewer < 2:
        return list(pieces), rate
    thin = [signal.resample_poly(piece, 1, fewer, axis=1, padtype="line") for piece in pieces]
    return thin, rate / fewer


def lines_of(pieces: Sequence[Real], rate: float) -> FourierLines:
    """Return the lines of all pieces, each of its whole length without a taper."""
    from scipy import fft

    frequency = [fft.rfftfreq(piece.shape[1], 1 / rate) for piece in pieces]
    value = [fft.rfft(piece) / np.sqrt(piece.shape[1] * rate) for piece in pieces]
    duration = np.repeat([piece.shape[1] / rate for piece in pieces], [len(f) for f in frequency])
    every = np.concatenate(frequency)
    order = np.argsort(every, kind="stable")
    return FourierLines(every[order], duration[order], np.concatenate(value, axis=1)[:, order])


def density(pieces: Sequence[Real], rate: float, length: int, window: str) -> Density:
    """Return the means over segments of so many samples that half overlap (Welch)."""
    from scipy import signal

    weights = window_weights(window, length)
    how: dict[str, Any] = {"fs": rate, "window": weights, "detrend": "constant"}
    long = [piece for piece in pieces if piece.shape[1] >= length]
    counts = [(piece.shape[1] - length // 2) // (length - length // 2) for piece in long]
    each = [signal.csd(piece[:, np.newaxis], piece[np.newaxis], **how) for piece in long]
    mean = np.average([value for _, value in each], axis=0, weights=counts)
    return Density(each[0][0], mean, sum(counts))


def floor_of(power: Real, step: float) -> Real:
    """Return what lies under the peaks of densities (channels, f) at lines of this distance."""
    from scipy.ndimage import percentile_filter

    size = max(FLOOR_LINES, round(FLOOR_WIDTH / step))
    return percentile_filter(power, FLOOR_SHARE, size=(1, size), mode="nearest")
