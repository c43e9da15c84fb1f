"""Bayesian fit of one mode to the Fourier lines of a band of recorded motion."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Real
from ..base.unit import MOTIONS

USUAL_RATIO, RATIO_SPREAD = 0.004, 1.5
"""Before anything is measured ln zeta is normal about the logarithm of the first, with the second
as standard deviation."""
SLOPE_SPREAD = 2.0
"""Standard deviation of the power of frequency that the load may have more than a white one."""
USUAL_REST, REST_SPREAD = 1e-3, 3.0
"""As of damping, of what other modes have of the density at the peak."""
LEAN_SPREAD = 0.2
"""Standard deviation of what other modes under the same load add to the amplitude of a peak, in
its own: one point of a rope that is driven alone has such zeros beside its peaks."""
FALL_SPREAD = 15.0  # The same of the power of frequency with which other modes fall.
NOISE_SPREAD = 4.0  # The same of ln Se: one channel does not tell it from what others have.
USUAL = (np.log(USUAL_RATIO), 0.0, 0.0, np.log(USUAL_REST), 0.0, 0.0)
SPREADS = (np.inf, RATIO_SPREAD, np.inf, NOISE_SPREAD, SLOPE_SPREAD, REST_SPREAD)
PRECISION = 1 / np.array([*SPREADS, LEAN_SPREAD, FALL_SPREAD])
"""What is usual of the numbers of `_value` but for the first and the noise, and how precisely."""
STEP = 1e-3  # Of the differences that give the Hessian, in standard deviations of the minimum.
FEWEST = 8  # Lines that a fit needs.
FARTHEST = 30.0  # No logarithm goes farther from where it starts.
SETTLED = 1e-4  # Slope by standard deviations at the minimum.


class FourierLines(NamedTuple):
    """Fourier lines of all pieces of a record, by rising frequency."""

    frequency: Real  # (k,) [Hz]
    duration: Real  # (k,) of the piece that each is of [s]
    value: Complex  # (channels, k): the mean square of its modulus is half a one-sided density

    def within(self, low: float, high: float) -> FourierLines:
        """Return the lines of a band."""
        start, stop = np.searchsorted(self.frequency, [low, high])
        return FourierLines(
            self.frequency[start:stop], self.duration[start:stop], self.value[:, start:stop]
        )


class BandMode(NamedTuple):
    """The mode that a band of lines shows."""

    frequency: float  # [Hz]
    ratio: float  # of damping
    log_std: tuple[float, float]  # of the logarithms of both
    signal: float  # density of the mode at its frequency over that of the noise
    rise: float  # density at the frequency over the larger at the ends of the band
    gain: float  # of the logarithm of the posterior, over the same without a mode
    shape: Real  # (channels,) of unit length


def fit_band(lines: FourierLines, quantity: str, frequency: float, ratio: float) -> BandMode | None:
    """Fit one mode to the lines of a band, from a guess; None where there is none.

    E_k = (S f^p |H_k + A|^2 + R f^q) phi phi^T + Se I: the load is S f^p, H_k the amplification of
    the quantity, "displacement", "velocity" or "acceleration"; A is what other modes add under the
    same load, R under other loads, and Se the noise in every channel.
    """
    # the function that is least at the best numbers, S. K. Au, Journal of Engineering
    # Mechanics 137 (2011) 214-226, here with noise that is not small and other modes beside,
    #   (n - 1) N ln Se + sum_k ln(S_k + Se) + (d - lambda_max(M))/Se,
    #   S_k = S f^p |H_k + A|^2 + R f^q,
    #   M = sum_k S_k/(S_k + Se) Re F_k F_k^*,  d = sum_k F_k^* F_k,
    # and the squares of the priors; phi is the eigenvector of lambda_max. Its slopes are those with
    # phi held, since it is least with respect to phi
    if len(lines.frequency) < FEWEST:
        return None
    band = _Band.of(lines, quantity)
    known = (np.log(frequency), np.log(ratio), band.loud(frequency), band.quiet)
    start = np.array([*known, *USUAL[2:]])
    few = 1 / np.sqrt(band.channels * len(band.frequency))
    unit = np.array([0.3 * ratio, 0.3, 0.3, few, 0.5, 1.0, 0.05, 5.0])
    best, value = _least(lambda x: _value(band, x), start, unit)
    if not band.log_frequency[0] < best[0] < band.log_frequency[-1]:
        return None
    covariance = _covariance(band, best)
    return None if covariance is None else _mode(band, best, covariance, _without(band) - value)


class _Band(NamedTuple):
    """Lines as the likelihood takes them."""

    frequency: Real  # (k,) [Hz]
    log_frequency: Real
    duration: Real  # (k,) [s]
    square: Real  # (k, channels, channels): Re F F^*
    power: float  # sum of F^* F
    quiet: float  # guess of ln Se
    order: int  # how often the displacement is differentiated

    @classmethod
    def of(cls, lines: FourierLines, quantity: str) -> _Band:
        f, value = lines.frequency, lines.value.T
        square = np.real(value[:, :, np.newaxis] * value[:, np.newaxis].conj())
        total = np.sum(np.abs(value) ** 2, axis=1)
        # the quietest lines, or what the other directions have
        quiet = np.quantile(total, 0.2)
        if value.shape[1] > 1:
            quiet = np.linalg.eigvalsh(square.mean(axis=0))[:-1].mean()
        least = np.log(max(float(quiet), 1e-12 * float(total.max())))
        order = MOTIONS[quantity]
        return cls(f, np.log(f), lines.duration, square, float(total.sum()), least, order)

    @property
    def channels(self) -> int:
        """How many there are."""
        return self.square.shape[1]

    def loud(self, frequency: float) -> float:
        """Guess the logarithm of the density at the peak."""
        total = np.trace(self.square, axis1=1, axis2=2)
        near = np.argsort(np.abs(self.frequency - frequency))[: max(3, len(total) // 20)]
        return float(np.log(total[near].mean()))

    def amplified(self, x: Real) -> tuple[Real, Real]:
        """Return the power of the mode over that at its peak, and its slopes (3, k).

        They are those by ln f_0, ln zeta and A.
        """
        # |H + A|^2 with H = 2 zeta/(b^2 - 1 + 2 i zeta b), the largest of which is 1
        ratio, lean = np.exp(x[1]), x[6]
        away = x[0] - self.log_frequency  # ln(f_0/f)
        sign = 1.0 if self.order == 2 else -1.0
        b2 = np.exp(sign * 2 * away)
        off = b2 - 1
        below = off**2 + 4 * ratio**2 * b2
        peak, leaning = 4 * ratio**2 / below, 1 + lean * off / ratio
        by_frequency = -sign * (4 * b2 * off + 8 * ratio**2 * b2) / below
        by_ratio = 2 - 8 * ratio**2 * b2 / below
        power = peak * leaning + lean**2
        slopes = np.array(
            [
                peak * (by_frequency * leaning + lean / ratio * sign * 2 * b2),
                peak * (by_ratio * leaning - lean * off / ratio),
                peak * off / ratio + 2 * lean,
            ]
        )
        # of a velocity two powers more than of a displacement
        tilt = x[4] + (2.0 if self.order == 1 else 0.0)
        blur, more, wider = self.blurred(x)
        factor = np.exp(-tilt * away) * blur
        slopes[0] += power * (more - tilt)
        slopes[1] += power * wider
        return power * factor, slopes * factor

    def blurred(self, x: Real) -> tuple[Real, Real, Real]:
        """Return what a finite duration makes of a resonance, and the slopes of its logarithm."""
        # a decay exp(-u |t|), u = zeta omega_0 + i (omega - omega_0), seen through a duration T:
        # Re[1/u - (1 - exp(-u T))/(u^2 T)] in place of Re 1/u (A. M. Sykulski and others,
        # Biometrika 106 (2019) 251-266, "debiased Whittle likelihood")
        omega, ratio = 2 * np.pi * np.exp(x[0]), np.exp(x[1])
        u = ratio * omega + 1j * (2 * np.pi * self.frequency - omega)
        ut = u * self.duration
        fade = np.exp(-ut)
        seen = 1 / u - (1 - fade) / (u * ut)
        by_seen = (2 * (1 - fade) / ut - 1 - fade) / u**2
        whole, by_whole = np.real(1 / u), -1 / u**2
        by_frequency, by_ratio = (
            np.real(by_seen * turn) / np.real(seen) - np.real(by_whole * turn) / whole
            for turn in ((ratio - 1j) * omega, ratio * omega)
        )
        return np.real(seen) / whole, by_frequency, by_ratio


def _likelihood(band: _Band, signal: Real, log_noise: float) -> tuple[float, Real, float]:
    """Return its negative logarithm, and the slopes by the signal of each line and by ln Se."""
    noise = np.exp(log_noise)
    whole = signal + noise
    share = signal / whole
    count, n = len(signal), band.channels
    values, vectors = np.linalg.eigh(np.tensordot(share, band.square, axes=1))
    along = np.einsum("i,kij,j->k", vectors[:, -1], band.square, vectors[:, -1])
    left = (band.power - float(values[-1])) / noise
    value = (n - 1) * count * log_noise + float(np.log(whole).sum()) + left
    # by the signal of a line: 1/(S_k + Se) - |phi^T F_k|^2/(S_k + Se)^2
    by_signal = (1 - along / whole) / whole
    by_noise = (n - 1) * count - left + float((noise + share * along) @ (1 / whole))
    return value, by_signal, by_noise


def _value(band: _Band, x: Real) -> tuple[float, Real]:
    """Return the negative logarithm of the posterior and its slopes by the eight numbers."""
    # x = ln f_0, ln zeta, ln of S/(4 zeta^2), ln Se, p, ln of R over the third, A, q
    shape, by_mode = band.amplified(x)
    ahead = band.log_frequency - x[0]
    top = np.exp(x[2])
    mode, rest = top * shape, top * np.exp(x[5] + x[7] * ahead)
    value, each, by_noise = _likelihood(band, mode + rest, x[3])
    slopes = np.array(
        [
            each @ (top * by_mode[0] - x[7] * rest),
            each @ (top * by_mode[1]),
            each @ (mode + rest),
            by_noise,
            each @ (mode * ahead),
            each @ rest,
            each @ (top * by_mode[2]),
            each @ (rest * ahead),
        ]
    )
    away = (x - np.array([0.0, *USUAL[:2], band.quiet, *USUAL[2:]])) * PRECISION
    return value + 0.5 * float(away @ away), slopes + away * PRECISION


def _without(band: _Band) -> float:
    """Return the negative logarithm of the posterior without a mode: R f^q and noise."""
    ahead = band.log_frequency - band.log_frequency.mean()

    def value(y: Real) -> tuple[float, Real]:
        rest = np.exp(y[0] + y[1] * ahead)
        value, each, by_noise = _likelihood(band, rest, y[2])
        away = np.array([0.0, y[1] / FALL_SPREAD, (y[2] - band.quiet) / NOISE_SPREAD])
        slopes = np.array([each @ rest, each @ (rest * ahead), by_noise])
        spread = np.array([1.0, FALL_SPREAD, NOISE_SPREAD])
        return value + 0.5 * float(away @ away), slopes + away / spread

    count = len(ahead)
    start = np.array([np.log(band.power / count), 0.0, band.quiet])
    few = 1 / np.sqrt(band.channels * count)
    return _least(value, start, np.array([1 / np.sqrt(count), 1.0, few]))[1]


def _least(
    function: Callable[[Real], tuple[float, Real]], start: Real, unit: Real
) -> tuple[Real, float]:
    """Return the numbers of the least value, and that; unit is about a standard deviation each."""
    from scipy.optimize import minimize

    def scaled(y: Real) -> tuple[float, Real]:
        x = start + unit * y
        if np.abs(x - start).max() > FARTHEST:
            return np.inf, np.zeros(len(unit))
        value, slopes = function(x)
        return value, slopes * unit

    how = {"gtol": SETTLED}
    found = minimize(scaled, np.zeros(len(unit)), jac=True, method="BFGS", options=how)
    return start + unit * found.x, float(found.fun)


def _covariance(band: _Band, best: Real) -> Real | None:
    """Return the inverse of the Hessian, by differences of the slopes."""
    width = np.full(len(best), STEP)
    width[0] *= np.exp(best[1])
    hessian = np.empty((len(best), len(best)))
    for k, step in enumerate(width):
        ahead, behind = best.copy(), best.copy()
        ahead[k] += step
        behind[k] -= step
        hessian[k] = (_value(band, ahead)[1] - _value(band, behind)[1]) / (2 * step)
    # in units of the diagonal: the frequency is known far better than the rest
    diagonal = np.diag(hessian)
    if not (diagonal > 0).all():
        return None
    unit = np.sqrt(np.outer(diagonal, diagonal))
    try:
        inverse = np.linalg.inv((hessian + hessian.T) / 2 / unit) / unit
    except np.linalg.LinAlgError:
        return None
    return inverse if (np.diag(inverse)[:2] > 0).all() else None


def _mode(band: _Band, best: Real, covariance: Real, gain: float) -> BandMode:
    """Say what the best numbers mean."""
    form = band.amplified(best)[0]
    top, noise = np.exp(best[2]), np.exp(best[3])
    other = top * np.exp(best[5]) + noise
    share = 1 - noise / (top * form + other)
    vectors = np.linalg.eigh(np.tensordot(share, band.square, axes=1))[1]
    edge = top * max(form[0], form[-1])
    return BandMode(
        frequency=float(np.exp(best[0])),
        ratio=float(np.exp(best[1])),
        log_std=(float(np.sqrt(covariance[0, 0])), float(np.sqrt(covariance[1, 1]))),
        signal=float(top * form.max() / other),
        rise=float((top * form.max() + other) / (edge + other)),
        gain=gain,
        shape=_turned(vectors[:, -1]),
    )


def _turned(shape: Real) -> Real:
    """Return a shape whose largest component is positive."""
    return shape * np.sign(shape[np.abs(shape).argmax()])


def unfitted(lines: FourierLines, frequency: float, width: float) -> BandMode:
    """Return what is known where no mode could be fitted: no more than the place."""
    value = lines.value[:, np.abs(lines.frequency - frequency) <= width]
    shape = np.linalg.eigh(np.real(value @ value.conj().T))[1][:, -1]
    relative = width / frequency
    return BandMode(frequency, relative, (relative, 1.0), 0.0, 1.0, 0.0, _turned(shape))
