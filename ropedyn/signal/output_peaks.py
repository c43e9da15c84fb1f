"""Peaks of motion that nobody has driven on purpose: candidates, their modes, their kinds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Real
from .band_fit import USUAL_RATIO, BandMode, FourierLines, fit_band, unfitted
from .record_lines import Density, density, floor_of, lines_of, without_drift
from .steady_lines import BANDWIDTH, SteadyLine, take_lines

SEGMENTS = 12  # Candidates are sought with segments of this part of the longest piece.
STANDING, PROMINENT = 8.0, 6.0
"""A candidate is as high over the median, and over what is beside it, as one and so many standard
deviations of a mean."""
WIDTHS, RESOLUTIONS = 8.0, 12.0
"""Half a band is so many zeta f, or so many over the duration where that is more."""
MOMENT = 40.0  # Amplitudes are compared that so many seconds have each.
PASSES = 2  # The second knows the damping and the neighbours.
STEADY, CALM = 0.12, 0.3
"""Variation of the amplitudes of a line, and of one that is narrow besides; noise in a narrow band
has 0.52 (Rayleigh)."""
NARROW, NARROWEST = 3.0, 0.5
"""Radians of 2 pi zeta f T that a line has less than: its amplitude hardly has the time to change,
and has none."""
LEAST_RISE, LEAST_GAIN = 2.5, 8.0
"""Of a mode over the ends of its band, and of the logarithm of the posterior over none."""
WIDEST, QUIETEST, VAGUEST = 0.03, 2.0, 0.01
"""A mode has less damping, more density over all else, and a smaller relative uncertainty."""
TWO = 0.2  # Where the second singular value has this share of the first, there are two modes.


class OutputPeak(NamedTuple):
    """One peak."""

    frequency: float  # [Hz]
    std: float  # [Hz]
    ratio: float  # of damping; 0 of a sinusoid
    ratio_std: float
    kind: str
    shape: Real  # (channels,) of unit length, the largest > 0
    signal: float  # density over that of the noise
    low: float  # band of the fit [Hz]
    high: float
    gain: float  # of the logarithm of the posterior, over none

    @classmethod
    def of(cls, mode: BandMode, band: tuple[float, float], kind: str) -> OutputPeak:
        """Return what was fitted in a band."""
        std, ratio_std = mode.frequency * mode.log_std[0], mode.ratio * mode.log_std[1]
        seen = (kind, mode.shape, mode.signal, *band, mode.gain)
        return cls(mode.frequency, std, mode.ratio, ratio_std, *seen)

    @classmethod
    def steady(cls, line: SteadyLine, duration: float) -> OutputPeak:
        """Return a sinusoid, whose damping the duration could hide."""
        f, side = line.frequency, BANDWIDTH / duration
        hidden = 1 / (2 * np.pi * f * duration)
        seen = ("line", line.shape, line.signal, f - side, f + side, np.inf)
        return cls(f, line.std, 0.0, hidden, *seen)


class Sought(NamedTuple):
    """Where peaks are sought, and of what."""

    quantity: str  # "displacement", "velocity" or "acceleration"
    lowest: float  # [Hz]
    below: float  # [Hz]


def output_peaks(
    pieces: Sequence[Real], rate: float, search: Sought, report: Callable[[float], object]
) -> list[OutputPeak]:
    """Find the peaks of pieces (channels, t) of a record, by rising frequency."""
    longest = max(piece.shape[1] for piece in pieces)
    duration = longest / rate
    span = (search.lowest, search.below)
    steady, level = take_lines(without_drift(pieces, rate, search.lowest), rate, *span)
    averaged = density(level, rate, longest // SEGMENTS, "hann")
    floor = floor_of(averaged.power, averaged.frequency[1])
    candidates, second = _candidates(averaged, floor, search)
    fitted = _fitted(lines_of(level, rate), candidates, search, duration, report)
    moments = _Moments.of(level, rate)
    peaks = [
        OutputPeak.of(mode, band, _kind(mode, two, moments.variation(mode), duration))
        for (mode, band), two in zip(fitted, (second > TWO).tolist())
    ]
    return _merged([*peaks, *(OutputPeak.steady(line, duration) for line in steady)])


def _fitted(
    lines: FourierLines,
    candidates: Real,
    search: Sought,
    duration: float,
    report: Callable[[float], object],
) -> list[tuple[BandMode, tuple[float, float]]]:
    """Return the modes at candidates with their bands."""
    guess = [(f, max(USUAL_RATIO, 1 / (f * duration))) for f in candidates.tolist()]
    kept: list[tuple[BandMode, tuple[float, float]]] = []
    for turn in range(PASSES):
        kept = []
        for k, (one, band) in enumerate(zip(guess, _bands(guess, duration, search.lowest))):
            mode = fit_band(lines.within(*band), search.quantity, *one)
            kept.append((mode or unfitted(lines, one[0], 1 / duration), band))
            report((turn + (k + 1) / len(guess)) / PASSES)
        guess = [(mode.frequency, mode.ratio) for mode, _ in kept]
    return kept


def _candidates(averaged: Density, floor: Real, search: Sought) -> tuple[Real, Real]:
    """Return where the first singular value of the densities has a maximum.

    With it comes what the second has there of the first, 0 where it does not stand out.
    """
    # frequency domain decomposition: R. Brincker, L. Zhang, P. Andersen, Smart Materials and
    # Structures 10 (2001) 441-445; each channel in units of its own floor
    from scipy.signal import find_peaks

    f, scale = averaged.frequency, np.sqrt(floor)
    whitened = averaged.value / (scale[:, np.newaxis] * scale[np.newaxis])
    size = np.linalg.eigvalsh(np.moveaxis(whitened, -1, 0))
    first, second = size[:, -1], size[:, -2] if len(scale) > 1 else np.zeros(len(f))
    inside = (f >= search.lowest) & (f <= search.below)
    if not inside.any():
        return np.empty(0), np.empty(0)
    root = np.sqrt(averaged.averages)
    stands, leaps = 1 + STANDING / root, np.log1p(PROMINENT / root)
    at, _ = find_peaks(
        np.log(first), height=np.log(np.median(first[inside]) * stands), prominence=leaps
    )
    at = at[inside[at]]
    seen = second[at] > np.median(second[inside]) * stands
    return f[at], np.where(seen, second[at] / first[at], 0.0)


def _bands(
    guess: Sequence[tuple[float, float]], duration: float, lowest: float
) -> list[tuple[float, float]]:
    """Return the band of each peak, which ends half-way to its neighbours."""
    f = np.array([one for one, _ in guess])
    half = np.array([max(WIDTHS * ratio * f, RESOLUTIONS / duration) for f, ratio in guess])
    middle = (f[1:] + f[:-1]) / 2
    low = np.maximum(f - half, np.concatenate([[lowest / 2], middle]))
    high = np.minimum(f + half, np.concatenate([middle, [np.inf]]))
    return list(zip(low.tolist(), high.tolist()))


def _kind(mode: BandMode, two: bool, varies: float, duration: float) -> str:
    """Say what a peak is."""
    turns = 2 * np.pi * mode.ratio * mode.frequency * duration
    if turns < NARROWEST or varies < STEADY or (varies < CALM and turns < NARROW):
        return "line"
    weak = (
        mode.rise < LEAST_RISE,
        mode.gain < LEAST_GAIN,
        mode.ratio > WIDEST,
        mode.signal < QUIETEST,
        mode.log_std[0] > VAGUEST,
    )
    return "double" if two else "weak" if any(weak) else "mode"


class _Moments(NamedTuple):
    """Spectra of short segments one after the other."""

    frequency: Real
    value: Complex  # (channels, f, segments)

    @classmethod
    def of(cls, pieces: Sequence[Real], rate: float) -> _Moments:
        from scipy import signal

        length = min(round(MOMENT * rate), max(piece.shape[1] for piece in pieces) // 4)
        parts = [
            signal.stft(
                piece, rate, "hann", length, noverlap=0, boundary=None, padded=False, detrend=False
            )
            for piece in pieces
            if piece.shape[1] >= length
        ]
        return cls(parts[0][0], np.concatenate([part[2] for part in parts], axis=-1))

    def variation(self, mode: BandMode) -> float:
        """Return how much the amplitudes of a mode vary, in their mean."""
        at = np.abs(self.frequency - mode.frequency).argmin()
        size = np.abs(mode.shape @ self.value[:, at])
        return float(size.std() / size.mean())


def _merged(peaks: Sequence[OutputPeak]) -> list[OutputPeak]:
    """Return the peaks by frequency, two that have come to one as a double."""
    found: list[OutputPeak] = []
    for one in sorted(peaks, key=lambda peak: peak.frequency):
        last = found[-1] if found else None
        if last is not None and one.frequency - last.frequency < _apart(last, one):
            better = max(last, one, key=lambda peak: peak.gain)
            found[-1] = better._replace(kind="double" if better.kind == "mode" else better.kind)
        else:
            found.append(one)
    return found


def _apart(a: OutputPeak, b: OutputPeak) -> float:
    """Return how far two peaks must be to be two [Hz]."""
    half = 0.5 * min(a.ratio * a.frequency, b.ratio * b.frequency)
    return max(3 * float(np.hypot(a.std, b.std)), half)
