"""Fit of one mode to the lines of a frequency response around a peak."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Real

FEWEST, MOST = 3, 8
"""Powers of the numerator: a mode as accelerance has a square, so has a constant beside it; what
other modes add takes more, as many as the lines prove."""
POLE = 2  # So many real numbers are the pole's, and twice the powers are the numerator's.
LEAST = FEWEST + POLE // 2 + 2  # So few lines, each with two numbers, can be fitted.
FREEDOM = 2  # So many numbers more than unknowns are there at least where powers are tried.
CHANCE = 0.05  # A power is taken where noise alone gains as much more seldom.
LEVEL = 0.95  # Of the interval of 1.96 standard uncertainties about an estimate.
STEPS = 20  # Gauss and Newton take so many steps at most.
SETTLED = 1e-10  # A step of the pole in half widths of the window after which there is none.
FARTHEST = 1.0  # The pole is no farther from the middle of the window, in its half widths.
WIDEST = 4.0  # A peak is no wider, in half widths of the window.
ROUNDING = 4 * float(np.finfo(np.float64).eps)  # Relative standard uncertainty at least.
QUIETEST = 1e-3  # Noise of a line in that of the loudest at least, where it is said to have none.


class OneMode(NamedTuple):
    """The mode that fits best."""

    omega: float  # undamped, of the standard uncertainty `omega_std` [rad/s]
    ratio: float  # of damping, of the standard uncertainty `ratio_std`
    omega_std: float
    ratio_std: float
    # what the sum of the squared distances is less than that of a curve without a pole, over the
    # square of the largest line; and how often chance alone gains as much
    gain: float
    chance: float

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

    def powers(self, count: int) -> Real:
        """Return powers of t from 0, shape (n, count)."""
        return self.t[:, np.newaxis] ** np.arange(count)


class _Fit(NamedTuple):
    """A pole and what goes with it."""

    pole: Real  # (2,) (omega_0^2 - middle^2)/(2 middle half) and zeta omega_0/half
    columns: Real  # (2n, unknowns) derivatives
    rest: Real  # (2n,) what is left

    @property
    def left(self) -> float:
        """Sum of squares of what is left."""
        return float(self.rest @ self.rest)

    @property
    def freedom(self) -> int:
        """How many numbers there are more than unknowns."""
        return len(self.rest) - self.columns.shape[1]


def fit(omega: Real, value: Complex, noise: Real | None) -> OneMode | None:
    """Fit one mode beside what others add by least squares."""
    # H = sum b_k t^k/(omega_0^2 - omega^2 + 2 i zeta omega_0 omega), b complex. First H times the
    # denominator less the numerator, each line weighted by |H| (E. C. Levy, IRE Transactions on
    # Automatic Control AC-4 (1959) 37-43), then, by Gauss and Newton, H itself. The numerator is
    # linear and is solved for in each step
    middle, half = (omega[-1] + omega[0]) / 2, (omega[-1] - omega[0]) / 2
    scale = np.abs(value).max()
    noise = noise / scale if noise is not None and noise.any() else None
    t = (omega - middle) / half
    narrow = half / middle
    lines = _Window(value / scale, t, t * (1 + narrow * t / 2), 1j * (1 + narrow * t))
    with np.errstate(all="ignore"):
        try:
            first = _solved(lines, FEWEST, None)
            if first is None:
                return None
            found, square = _richer(lines, first, noise)
        except np.linalg.LinAlgError:
            return None
    if not middle + 2 * half * found.pole[0] > 0:
        return None
    natural = float(np.sqrt(middle * (middle + 2 * half * found.pole[0])))
    smooth = _smooth(lines)
    return OneMode(
        omega=natural,
        ratio=float(found.pole[1] * half / natural),
        omega_std=max(float(np.sqrt(square[0])) * middle * half / natural, ROUNDING * natural),
        ratio_std=max(float(np.sqrt(square[1])) * half / natural, ROUNDING),
        gain=smooth - first.left,
        chance=_chance(smooth, first),
    )


def _richer(lines: _Window, chosen: _Fit, noise: Real | None) -> tuple[_Fit, Real]:
    """Return the fit with as many powers as the lines prove, and the variances of its pole."""
    # the variances are those of the fit, and how far the next power, or the last one, moves the
    # pole, or how much more than the noise does where that is known: what other modes bend and the
    # powers do not follow
    beside = None
    for powers in range(FEWEST + 1, MOST + 1):
        if 2 * len(lines.h) - POLE - 2 * powers < FREEDOM:
            break
        more = _solved(lines, powers, chosen.pole)
        if more is None:
            break
        if _chance(chosen.left, more) > CHANCE:
            beside = more
            break
        chosen, beside = more, chosen
    variance = _variance(chosen, noise)
    if beside is None:
        return chosen, variance
    moved = (beside.pole - chosen.pole) ** 2
    if noise is not None:
        moved = np.maximum(moved - np.abs(_variance(beside, noise) - variance), 0.0)
    return chosen, variance + moved


def _solved(lines: _Window, powers: int, pole: Real | None) -> _Fit | None:
    """Fit a mode with so many powers from a pole on, or None where it is none of these lines."""
    powered = lines.powers(powers)
    pole = _levy(lines, powered) if pole is None else pole
    for _ in range(STEPS):
        columns, rest = _linearised(lines, powered, pole)
        step = np.linalg.lstsq(columns, rest, rcond=None)[0][:POLE]
        pole = pole + step
        if not np.abs(step).max() > SETTLED:
            break
    if not (abs(pole[0]) <= FARTHEST and abs(pole[1]) <= WIDEST):
        return None
    return _Fit(pole, *_linearised(lines, powered, pole))


def _levy(lines: _Window, powers: Real) -> Real:
    """Return where Gauss and Newton start."""
    h, weight = lines.h, np.abs(lines.h)
    columns = np.column_stack([h, lines.lean * h, -powers, -1j * powers])
    left = _stacked(columns * weight[:, np.newaxis])
    found = np.linalg.lstsq(left, _stacked(h * lines.bend * weight), rcond=None)[0]
    return np.asarray(found[:POLE], dtype=np.float64)


def _linearised(lines: _Window, powers: Real, pole: Real) -> tuple[Real, Real]:
    """Return the derivatives by pole and numerator, and what the best numerator leaves."""
    below = pole[0] + lines.lean * pole[1] - lines.bend
    shape = powers / below[:, np.newaxis]
    found = shape @ np.linalg.lstsq(shape, lines.h, rcond=None)[0]
    slope = -found / below
    columns = np.column_stack([slope, lines.lean * slope, shape, 1j * shape])
    return _stacked(columns), _stacked(lines.h - found)


def _variance(found: _Fit, noise: Real | None) -> Real:
    """Return the variances of the pole whose 1.96 standard uncertainties are its 95 % interval."""
    # that of linear least squares, (J^T J)^-1 J^T S J (J^T J)^-1, with S from the noise of each
    # line where it is known, times what the fit leaves in units of S where that is more than chance
    # leaves; and from what it leaves alone, with Student's t, where the noise is not known
    from scipy.special import chdtrc, ndtri, stdtrit

    spread = np.linalg.pinv(found.columns)[:POLE]
    square = found.left / found.freedom * _alike(found.rest)
    if noise is None:
        upper = (1 + LEVEL) / 2
        wide = float(stdtrit(found.freedom, upper) / ndtri(upper)) ** 2
        return np.asarray(square * wide * np.sum(spread**2, axis=1))
    known = np.tile(np.maximum(noise, QUIETEST * noise.max()), 2) ** 2
    mean = float(np.mean(known))
    by_chance = chdtrc(found.freedom, found.left / mean) > CHANCE
    return np.asarray(spread**2 @ known * (1.0 if by_chance else max(1.0, square / mean)))


def _alike(rest: Real) -> float:
    """Return how many lines count as one, by the likeness rho of neighbours: (1 + rho)/(1 - rho).

    Noise of lines is independent, what other modes bend is smooth: more lines do not average it.
    """
    parts = rest.reshape(2, -1)
    whole = float(np.sum(parts**2))
    rho = float(np.sum(parts[:, 1:] * parts[:, :-1])) / whole if whole > 0 else 0.0
    return max(1.0, (1 + rho) / (1 - rho))


def _chance(before: float, found: _Fit) -> float:
    """Return how often noise alone lets two more real numbers gain as much."""
    from scipy.special import fdtrc

    gain, left = (before - found.left) / 2, found.left / found.freedom
    return float(fdtrc(2, found.freedom, max(gain, 0.0) / left)) if left > 0 else 0.0


def _smooth(lines: _Window) -> float:
    """Return what the best curve without a pole leaves, of as many unknowns as the first fit."""
    powered = lines.powers(FEWEST + POLE // 2)
    rest = lines.h - powered @ np.linalg.lstsq(powered, lines.h, rcond=None)[0]
    return float(np.sum(np.abs(rest) ** 2))


def _stacked(rows: Complex) -> Real:
    """Return real and imaginary parts one under the other."""
    return np.concatenate([rows.real, rows.imag])
