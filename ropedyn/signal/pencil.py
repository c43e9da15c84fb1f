"""Decaying modes in equally spaced samples: y_j = sum_k size_k e^(log_k j) and noise.

The matrix pencil method tells how many modes there are and about where; least squares refine them,
and what they leave tells how well they are known.

Y. Hua, T. K. Sarkar, IEEE Transactions on Acoustics, Speech, and Signal Processing 38 (1990)
814-824; the number of modes by G. Schwarz, Annals of Statistics 6 (1978) 461-464.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Real

MOST = 12  # So many modes at most are fitted together.
ROWS = 150  # The matrix whose column space tells the rates has so many rows at most.
PARTS = (1, 2, 4, 8)  # Modes are estimated from the first of so many parts of the record.
LEAST = 16  # A part has so many samples at least.
ROUNDS = 30  # Modes are refined in so many rounds at most.
EXACT = 1e-26  # Where less than this share of the energy is left, more modes would fit rounding.


class DecayingModes(NamedTuple):
    """What decays."""

    log: Complex  # rate times the step of the samples
    size: Complex  # at the first sample
    variance: Real  # of each log: E |error|^2
    residual: float  # rms of what no mode explains, over that of the samples


class PencilTrial(NamedTuple):
    """Modes with how well they explain samples."""

    log: Complex
    left: float  # share of the energy
    criterion: float  # of Schwarz, 0 of no modes, the less the better


NOTHING = PencilTrial(np.zeros(0, np.complex128), 1.0, 0.0)


def decaying(y: Complex, noise: Real) -> DecayingModes | None:
    """Return as many modes as explain the samples best, None where noise explains them as well.

    What decays soon drowns in the noise of a long record: parts of it are looked at too.
    """
    # as many samples would tell as much if their noise were independent
    samples = len(y) / (1 + 2 * float((noise[1:] ** 2).sum()))
    best = NOTHING
    for part in PARTS:
        if (n := len(y) // part) < LEAST:
            break
        found = _trial(y, _chosen(y[:n], samples / part).log, samples)
        best = min(best, found, key=_criterion)
        if part == 1 and found.left < EXACT:
            break
    return _refined(y, best.log, noise) if len(best.log) else None


def _chosen(y: Complex, samples: float) -> PencilTrial:
    """Return as many modes as explain y best."""
    space, best = _column_space(y), NOTHING
    for number in range(1, min(MOST, int(samples / 4)) + 1):
        found = _trial(y, _logarithms(space[:, :number], len(y)), samples)
        best = min(best, found, key=_criterion)
        if found.left < EXACT:
            break
    return best


def _trial(y: Complex, log: Complex, samples: float) -> PencilTrial:
    if not len(log):
        return NOTHING
    left = y - _powers(log, len(y)) @ _size(y, log)
    share = float(np.vdot(left, left).real / np.vdot(y, y).real)
    # rate and amplitude of a mode are four real numbers, a sample is two
    criterion = 2 * samples * np.log(max(share, np.finfo(float).tiny))
    return PencilTrial(log, share, float(criterion + 4 * len(log) * np.log(2 * samples)))


def _criterion(trial: PencilTrial) -> float:
    return trial.criterion


def _column_space(y: Complex) -> Complex:
    """Return what spans the windows of y, the strongest first: of modes, as many as there are."""
    from scipy.linalg import hankel

    rows = min(len(y) // 2, ROWS)
    windows = hankel(y[:rows], y[rows - 1 :])
    # of NumPy throughout: threads of SciPy's own BLAS would wait on the same cores
    triangle = np.asarray(np.linalg.qr(windows.conj().T, mode="r"))
    return np.asarray(np.linalg.svd(triangle.conj().T, full_matrices=False)[0])


def _logarithms(space: Complex, n: int) -> Complex:
    """Return the logarithms of what shifts the space by one sample."""
    shift = np.linalg.lstsq(space[:-1], space[1:], rcond=None)[0]
    ratio = np.linalg.eigvals(shift)
    # what is gone at once, or overflows, is no mode
    return np.asarray(np.log(ratio[(np.abs(ratio) > 1e-3) & (np.abs(ratio) ** n < 1e6)]))


def _powers(log: Complex, n: int) -> Complex:
    return np.exp(np.outer(np.arange(n), log))


def _size(y: Complex, log: Complex) -> Complex:
    """Return the amplitudes of least squares."""
    return np.asarray(np.linalg.lstsq(_powers(log, len(y)), y, rcond=None)[0])


def _refined(y: Complex, log: Complex, noise: Real) -> DecayingModes:
    """Return the modes of least squares, by Gauss and Newton, with their variance."""
    # with the slopes J and G = J^+ of least squares, noise of covariance s^2 R moves modes by that
    # of s^2 G R G^H, and leaves s^2 (tr R - tr J G R) of the samples
    from scipy.linalg import matmul_toeplitz

    j, modes = np.arange(len(y)), len(log)
    size, aim, whole = _size(y, log), np.inf, float(np.vdot(y, y).real)
    for _ in range(ROUNDS):
        with np.errstate(over="ignore", invalid="ignore"):
            powers = _powers(log, len(y))
            left = y - powers @ size
            now = float(np.vdot(left, left).real)
        if not now < aim:
            break
        found, rest = (log, size), now
        slopes = np.hstack([powers, j[:, None] * powers * size])
        scale = np.linalg.norm(slopes, axis=0)
        scale[scale == 0] = 1.0
        inverse = np.linalg.pinv(slopes / scale) / scale[:, None]
        move = inverse @ left
        # a move that gains nothing, or where rounding is left, is the last
        aim = now * (1 - 1e-9) if now > EXACT * whole else 0.0
        size, log = size + move[:modes], log + move[modes:]
    spread = matmul_toeplitz(noise, inverse.conj().T)
    free = len(y) - float(np.einsum("jk,jk->", slopes, spread.conj()).real)
    variance = np.einsum("kj,jk->k", inverse, spread).real[modes:] * rest / free
    return DecayingModes(*found, variance, float(np.sqrt(rest / whole)))
