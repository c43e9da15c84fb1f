"""Sinusoids of constant amplitude in recorded motion: found, and taken away."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Real

TAPERS = 7
BANDWIDTH = (TAPERS + 1) / 2  # Half the width that the tapers see, times the duration.
PADDING = 6  # Spectra are so many times as fine as the lines of the duration.
CHANCE = 0.01  # Records of noise alone that show a line.


class SteadyLine(NamedTuple):
    """A sinusoid."""

    frequency: float  # [Hz]
    std: float  # [Hz]
    shape: Real  # (channels,) of unit length, with signs
    signal: float  # density that it would have in a band of one over the duration, over the noise


def take_lines(
    pieces: Sequence[Real], rate: float, lowest: float, below: float
) -> tuple[list[SteadyLine], list[Real]]:
    """Find the sinusoids between two frequencies, and return the pieces (channels, t) without."""
    # harmonic analysis: D. J. Thomson, Proceedings of the IEEE 70 (1982) 1055-1096, section XIII
    longest = max(pieces, key=lambda piece: piece.shape[1])
    spectrum = _Tapered.of(longest, rate)
    found = []
    rest = list(pieces)
    for frequency in _significant(spectrum, lowest, below):
        exact = _refined(longest, rate, frequency)
        found.append(_described(longest, rate, exact, spectrum))
        rest = [_without(piece, rate, exact) for piece in rest]
    return found, rest


class _Tapered(NamedTuple):
    """What several tapers say of each frequency."""

    frequency: Real  # (f,) [Hz]
    ratio: Real  # (f,) of a steady part over the rest, as Fisher and Snedecor have it
    density: Real  # (channels, f) one-sided, of the rest

    @classmethod
    def of(cls, piece: Real, rate: float) -> _Tapered:
        from scipy import fft

        n = piece.shape[1]
        size = fft.next_fast_len(PADDING * n, real=True)
        # sine tapers: K. S. Riedel, A. Sidorenko, IEEE Transactions on Signal Processing 43 (1995)
        # 188-195. What is steady is mu times the sum of each taper
        angle = np.pi * np.arange(1, n + 1) / (n + 1)
        steady, power, square = 0.0, 0.0, 0.0
        for k in range(1, TAPERS + 1):
            taper = np.sqrt(2 / (n + 1)) * np.sin(k * angle)
            spectrum, weight = fft.rfft(taper * piece, size), taper.sum()
            steady, square = steady + weight * spectrum, square + weight**2
            power = power + np.abs(spectrum) ** 2
        explained = np.abs(steady) ** 2 / square
        rest = np.maximum(power - explained, 1e-12 * power + np.finfo(float).tiny)
        ratio = (TAPERS - 1) * explained / rest
        frequency = fft.rfftfreq(size, 1 / rate)
        return cls(frequency, ratio.max(axis=0), 2 * rest / (TAPERS - 1) / rate)


def _significant(spectrum: _Tapered, lowest: float, below: float) -> list[float]:
    """Return where no noise would be so steady."""
    from scipy.signal import find_peaks
    from scipy.stats import f as fisher

    inside = (spectrum.frequency >= lowest) & (spectrum.frequency <= below)
    tries = len(spectrum.density) * max(1, int(inside.sum()))
    least = fisher.isf(CHANCE / tries, 2, 2 * (TAPERS - 1))
    # the tapers see a line in all of their width
    apart = round(BANDWIDTH * PADDING)
    at, _ = find_peaks(np.where(inside, spectrum.ratio, 0.0), height=least, distance=apart)
    return spectrum.frequency[at].tolist()


def _refined(piece: Real, rate: float, frequency: float) -> float:
    """Return the frequency at which the sinusoid is largest."""
    from scipy.optimize import minimize_scalar
    from scipy.signal.windows import hann

    n = piece.shape[1]
    weighted, time = piece * hann(n, sym=False), np.arange(n) / rate

    def power(f: float) -> float:
        return -float(np.sum(np.abs(weighted @ np.exp(-2j * np.pi * f * time)) ** 2))

    line = rate / n
    near = (frequency - 0.5 * line, frequency + 0.5 * line)
    found = minimize_scalar(power, bounds=near, method="bounded", options={"xatol": 1e-4 * line})
    return float(found.x)


def _described(piece: Real, rate: float, frequency: float, spectrum: _Tapered) -> SteadyLine:
    n = piece.shape[1]
    duration = n / rate
    noise = spectrum.density[:, np.abs(spectrum.frequency - frequency).argmin()]
    size = _amplitude(piece, rate, frequency)
    # Cramer and Rao: var f = 3 G/(pi^2 A^2 T^3), G the one-sided density of the noise
    strength = float(np.sum(np.abs(size) ** 2 / noise))
    turned = np.real(size * np.exp(-1j * np.angle(size[np.abs(size).argmax()])))
    return SteadyLine(
        frequency=frequency,
        std=float(np.sqrt(3 / (np.pi**2 * strength * duration**3))),
        shape=turned / np.linalg.norm(turned),
        signal=strength * duration / 2,
    )


def _basis(n: int, rate: float, frequency: float) -> Real:
    angle = 2 * np.pi * frequency / rate * np.arange(n)
    return np.stack([np.cos(angle), np.sin(angle)])


def _amplitude(piece: Real, rate: float, frequency: float) -> Complex:
    basis = _basis(piece.shape[1], rate, frequency)
    cosine, sine = np.linalg.lstsq(basis.T, piece.T, rcond=None)[0]
    return cosine - 1j * sine


def _without(piece: Real, rate: float, frequency: float) -> Real:
    basis = _basis(piece.shape[1], rate, frequency)
    return piece - np.linalg.lstsq(basis.T, piece.T, rcond=None)[0].T @ basis
