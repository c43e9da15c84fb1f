"""Resonances that show as peaks of a frequency response."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ..base.answer import Answer, axes
from ..base.array import Complex, Index, Real
from ..base.table import Table
from ..base.unit import QUANTITIES
from ..signal import one_mode

LEVEL = 0.4
"""Lines as high as this part of a peak, and not below, are fitted: 2.3 half widths to each side."""
SIDE = 4  # Lines to each side that are fitted at least, unless another peak is near.
STANDING = 8.0
"""Prominence of a measured peak in standard deviations of the noise at least: what noise alone
shows among a million lines."""
GAIN = 50.0  # What a pole explains at least and a smooth curve does not, in variances of the noise.
SMOOTH = 2e-3  # What a pole explains and a smooth curve does not, chance does more seldom.
NEGATIVE = -3.0  # Damping ratio in its standard uncertainties at least: what rests does not grow.
ROUNDING = 1e-12  # Damping ratios as far below 0 are 0.
UNCERTAIN = 0.5  # A frequency is known to this part of half the lines that are fitted.


@dataclass(frozen=True, eq=False)
class Resonances(Answer):
    """Peaks of one frequency response.

    Attributes
    ----------
    label : str
        Of the response.
    frequency : ndarray, shape (k,)
        Undamped natural frequency of the one-mode fit [Hz].
    amplitude : ndarray, shape (k,)
        Largest computed or measured amplitude.
    damping_ratio : ndarray, shape (k,)
        Of the one-mode fit. A window over time makes measured peaks as wide as a few lines: the
        ratio is then too large.
    std, damping_ratio_std : ndarray, shape (k,)
        Standard uncertainty of frequency [Hz] and damping ratio: standard error of the fit to the
        lines, which grows with their spacing, with the noise and with what other modes bend. Where
        lines are too few for a fit, that of a frequency anywhere between two lines, their distance
        over sqrt(12) (JCGM 100:2008, 4.3.7), and infinite.
    left_out : tuple of str
        Maxima that stand out and are no resonances, each with the reason: no mode fits them, a
        smooth curve fits as well, their damping is negative, or their frequency is not told.
    """

    label: str
    frequency: Real = field(metadata=axes("peak", unit="Hz"))
    amplitude: Real = field(metadata=axes("peak"))
    damping_ratio: Real = field(metadata=axes("peak"))
    std: Real = field(metadata=axes("peak", unit="Hz"))
    damping_ratio_std: Real = field(metadata=axes("peak"))
    left_out: tuple[str, ...] = ()

    def table(self) -> Table:
        """Return one row for each peak."""
        columns = {
            "frequency [Hz]": self.frequency,
            "std [Hz]": self.std,
            "amplitude": self.amplitude,
            "damping ratio": self.damping_ratio,
            "std of damping ratio": self.damping_ratio_std,
        }
        return Table.of(f"peaks of {self.label}", columns)


class _Peak(NamedTuple):
    """What is known of one."""

    omega: float
    ratio: float
    omega_std: float
    ratio_std: float


def resonances(
    frequency: Real,
    value: Complex,
    quantity: str,
    label: str,
    noise: Real | None = None,
    *,
    known: Real | None = None,
    decay: float = 0.0,
) -> Resonances:
    """Find local maxima of the amplitude and fit one mode to each."""
    from scipy.signal import find_peaks

    frequency, first = np.unique(frequency, return_index=True)
    value = value[first]
    noise, known = (None if each is None else each[first] for each in (noise, known))
    omega, size = 2 * np.pi * frequency, np.abs(value)
    at, _ = find_peaks(size, prominence=None if noise is None else (STANDING * noise, None))
    found: list[tuple[int, _Peak]] = []
    left_out: list[str] = []
    for k, (start, stop) in zip(at.tolist(), _windows(size, at)):
        lines = slice(start, stop + 1)
        if stop - start + 1 >= one_mode.LEAST:
            mode = one_mode.fit(omega[lines], value[lines], None if known is None else known[lines])
            mode = mode and mode.without(decay)
            share = 0.0 if noise is None else noise[k] / size[lines].max()
            peak = _checked(mode, omega[lines], share)
        else:
            peak = _by_three(omega, value, quantity, k, decay)
        if isinstance(peak, str):
            left_out.append(f"the maximum at {frequency[k]:.6g} Hz of {label} is no peak: {peak}")
        else:
            found.append((k, peak))
    return Resonances(
        label=label,
        frequency=np.array([peak.omega for _, peak in found]) / (2 * np.pi),
        amplitude=size[[k for k, _ in found]],
        damping_ratio=np.array([peak.ratio for _, peak in found]),
        std=np.array([peak.omega_std for _, peak in found]) / (2 * np.pi),
        damping_ratio_std=np.array([peak.ratio_std for _, peak in found]),
        left_out=tuple(left_out),
    )


def _windows(size: Real, at: Index) -> list[tuple[int, int]]:
    """Return the first and the last line that are fitted for each peak."""
    last = len(size) - 1
    middle = (at[:-1] + at[1:]) // 2
    lowest, highest = np.append(0, middle), np.append(middle, last)
    windows = []
    for k, low, high in zip(at.tolist(), lowest.tolist(), highest.tolist()):
        below = np.flatnonzero(size < LEVEL * size[k])
        where = int(np.searchsorted(below, k))
        left = below[where - 1] + 1 if where > 0 else 0
        right = below[where] - 1 if where < len(below) else last
        windows.append((max(low, min(int(left), k - SIDE)), min(high, max(int(right), k + SIDE))))
    return windows


def _checked(mode: one_mode.OneMode | None, omega: Real, noise: float) -> _Peak | str:
    """Return the peak that a mode is, or why it is none; noise in parts of the largest line."""
    if mode is None:
        return "no mode fits it"
    if mode.chance > SMOOTH or not mode.gain > GAIN * noise**2:
        return "a smooth curve fits it as well as a mode"
    if mode.ratio < min(NEGATIVE * mode.ratio_std, -ROUNDING):
        return f"its damping ratio would be {mode.ratio:.3g} (std {mode.ratio_std:.2g})"
    if mode.omega_std > UNCERTAIN * (omega[-1] - omega[0]) / 2:
        return f"its frequency is not told (std {mode.omega_std / (2 * np.pi):.2g} Hz)"
    return _Peak(mode.omega, max(mode.ratio, 0.0), mode.omega_std, mode.ratio_std)


def _by_three(omega: Real, value: Complex, quantity: str, k: int, decay: float) -> _Peak | str:
    """Return the mode through line k and its neighbours, or why it is none."""
    # of one mode 1/receptance = (omega_0^2 - omega^2 + 2 i zeta omega_0 omega)/A, a parabola in
    # omega: the one through the three lines about the maximum has its root there at the pole
    # omega_0 (sqrt(1 - zeta^2) + i zeta), whose modulus and argument are the two unknowns. Exact
    # for one mode; others tilt it a little
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = (1j * omega + decay) ** QUANTITIES[quantity] / value
    pole = _pole(omega, inverse, k) - 1j * decay
    ratio = pole.imag / abs(pole)
    if not ratio >= -ROUNDING:
        return f"its damping ratio would be {ratio:.3g}"
    spacing = (omega[k + 1] - omega[k - 1]) / 2
    return _Peak(abs(pole), max(ratio, 0.0), spacing / np.sqrt(12), np.inf)


def _pole(omega: Real, inverse: Complex, k: int) -> complex:
    """Return the root of the parabola through line k and its neighbours [rad/s]."""
    # at 0 Hz a velocity or an acceleration is 0 and says nothing: the parabola then goes through
    # what lies above, and where there is nothing more it is a straight line
    first = k - 1 if np.isfinite(inverse[k - 1]) else k
    x, f = omega[first : first + 3], inverse[first : first + 3]
    slope = np.diff(f) / np.diff(x)
    bend = (slope[1] - slope[0]) / (x[2] - x[0]) if len(x) > 2 else 0.0
    # about x[j], the maximum: f + t steep + t^2 bend = 0, the root t that is near
    j = k - first
    steep = slope[0] + bend * (2 * x[j] - x[0] - x[1])
    root = np.sqrt(steep**2 - 4 * bend * f[j])
    far = max(steep + root, steep - root, key=abs)
    return complex(x[j] - 2 * f[j] / far)
