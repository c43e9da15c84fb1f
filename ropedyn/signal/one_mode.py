"""Fit of one mode to the lines of a frequency response around a peak."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Real

POWERS = np.arange(3)
"""Powers of the numerator: a mode as accelerance has a square, so has a constant beside it."""
UNKNOWN = 2 + 2 * len(POWERS)  # Pole and numerator are so many real unknowns.
LEAST = UNKNOWN // 2 + 2  # So few lines, each with two numbers, can be fitted.
STEPS = 20  # Gauss and Newton take so many steps at most.
SETTLED = 1e-10  # A step of the pole in half widths of the window after which there is none.
FARTHEST = 1.0  # The pole is no farther from the middle of the window, in its half widths.
WIDEST = 4.0  # A peak is no wider, in half widths of the window.
QUIETEST = 1e-3  # Noise of a line in that of the loudest at least, where it is said to have none.


class OneMode(NamedTuple):
    """The mode that fits best."""

    omega: float  # undamped, of the standard error `omega_std` [rad/s]
    ratio: float  # of damping, of the standard error `ratio_std`
    omega_std: float
    ratio_std: float
    # what the sum of the squared distances is less than that of a curve without a pole, over the
    # square of the largest line
    gain: float

    def without(self, decay: float) -> OneMode:
        """Return it without the window e^(-decay t), which moves a pole by -decay [1/s]."""
        # with a = zeta omega and the same omega^2 - a^2: omega' = sqrt(omega^2 - a^2 + (a - d)^2)
        if decay == 0:
            return self
        loss = self.ratio * self.omega - decay
        omega = float(np.hypot(self.omega * np.sqrt(max(1 - self.ratio**2, 0.0)), loss))
        spread = np.hypot(self.ratio_std * self.omega, self.ratio * self.omega_std)
        return self._replace(omega=omega, ratio=loss / omega, ratio_std=float(spread / omega))


class _Window(NamedTuple):
    """Lines about a peak in units of their own."""

    h: Complex  # (n,) response over its largest
    t: Real  # (n,) (omega - middle)/half, from -1 to 1
    bend: Real  # (n,) (omega^2 - middle^2)/(2 middle half)
    lean: Complex  # (n,) i omega/middle
    powers: Real  # (n, 3) of t


def fit(omega: Real, value: Complex, noise: Real | None) -> OneMode | None:
    """Fit one mode beside a constant by least squares."""
    # H = (b_0 + b_1 t + b_2 t^2)/(omega_0^2 - omega^2 + 2 i zeta omega_0 omega), b complex. First H
    # times the denominator less the numerator, each line weighted by |H| (E. C. Levy, IRE
    # Transactions on Automatic Control AC-4 (1959) 37-43), then, by Gauss and Newton, H itself. The
    # numerator is linear and is solved for in each step. The covariance is that of linear least
    # squares (J^T J)^-1 J^T S J (J^T J)^-1, with S from the noise of each line where it is known,
    # times what the fit leaves in units of S where that is more than 1; and from what it leaves
    # alone where the noise is not known
    middle, half = (omega[-1] + omega[0]) / 2, (omega[-1] - omega[0]) / 2
    scale = np.abs(value).max()
    t = (omega - middle) / half
    narrow = half / middle
    powers = t[:, np.newaxis] ** POWERS
    lines = _Window(value / scale, t, t * (1 + narrow * t / 2), 1j * (1 + narrow * t), powers)
    with np.errstate(all="ignore"):
        pole = _pole(lines)
        if pole is None:
            return None
        columns, rest = _linearised(lines, pole)
        square = _covariance(columns, rest, None if noise is None else noise / scale)
    if square is None or not middle + 2 * half * pole[0] > 0:
        return None
    natural = float(np.sqrt(middle * (middle + 2 * half * pole[0])))
    return OneMode(
        omega=natural,
        ratio=float(pole[1] * half / natural),
        omega_std=float(np.sqrt(square[0]) * middle * half / natural),
        ratio_std=float(np.sqrt(square[1]) * half / natural),
        gain=_smooth(lines) - float(rest @ rest),
    )


def _pole(lines: _Window) -> Real | None:
    """Return (omega_0^2 - middle^2)/(2 middle half) and zeta omega_0/half, or None."""
    try:
        pole = _levy(lines)
        for _ in range(STEPS):
            columns, rest = _linearised(lines, pole)
            step = np.linalg.lstsq(columns, rest, rcond=None)[0][:2]
            pole = pole + step
            if not np.abs(step).max() > SETTLED:
                break
    except np.linalg.LinAlgError:
        return None
    return pole if abs(pole[0]) <= FARTHEST and abs(pole[1]) <= WIDEST else None


def _levy(lines: _Window) -> Real:
    """Return where Gauss and Newton start."""
    h, weight = lines.h, np.abs(lines.h)
    columns = np.column_stack([h, lines.lean * h, -lines.powers, -1j * lines.powers])
    left = _stacked(columns * weight[:, np.newaxis])
    found = np.linalg.lstsq(left, _stacked(h * lines.bend * weight), rcond=None)[0]
    return np.asarray(found[:2], dtype=np.float64)


def _linearised(lines: _Window, pole: Real) -> tuple[Real, Real]:
    """Return the derivatives by pole and numerator, (2n, 8), and what the best numerator leaves."""
    below = pole[0] + lines.lean * pole[1] - lines.bend
    shape = lines.powers / below[:, np.newaxis]
    found = shape @ np.linalg.lstsq(shape, lines.h, rcond=None)[0]
    slope = -found / below
    columns = np.column_stack([slope, lines.lean * slope, shape, 1j * shape])
    return _stacked(columns), _stacked(lines.h - found)


def _covariance(columns: Real, rest: Real, noise: Real | None) -> Real | None:
    """Return the variances of the pole."""
    try:
        spread = np.linalg.pinv(columns)[:2]
    except np.linalg.LinAlgError:
        return None
    square = float(rest @ rest) / (len(rest) - UNKNOWN) * _alike(rest)
    each = np.full(len(rest), square)
    if noise is not None and noise.any():
        known = np.tile(np.maximum(noise, QUIETEST * noise.max()), 2) ** 2
        each = known * max(1.0, square / float(np.mean(known)))
    variance: Real = spread**2 @ each
    return variance


def _alike(rest: Real) -> float:
    """Return how many lines count as one, by the likeness rho of neighbours: (1 + rho)/(1 - rho).

    Noise of lines is independent, what other modes bend is smooth: more lines do not average it.
    """
    parts = rest.reshape(2, -1)
    whole = float(np.sum(parts**2))
    rho = float(np.sum(parts[:, 1:] * parts[:, :-1])) / whole if whole > 0 else 0.0
    return max(1.0, (1 + rho) / (1 - rho))


def _smooth(lines: _Window) -> float:
    """Return what the best curve of as many unknowns without a pole leaves."""
    powers = lines.t[:, np.newaxis] ** np.arange(UNKNOWN // 2)
    rest = lines.h - powers @ np.linalg.lstsq(powers, lines.h, rcond=None)[0]
    return float(np.sum(np.abs(rest) ** 2))


def _stacked(rows: Complex) -> Real:
    """Return real and imaginary parts one under the other."""
    return np.concatenate([rows.real, rows.imag])
