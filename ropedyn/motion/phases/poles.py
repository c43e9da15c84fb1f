"""The poles of a phase x' = A x, x = (r, r', e)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.array import Complex, Real
from ..modal.exponentials import rates

DOUBLE = 1e-10  # Equal poles are split by this share of their modulus squared.
SHARE = 0.25  # Stiffness of coupled modes is known to this times a part of its largest.
STILL = 1e-5  # A pole that is 0 turns by this angle over the record.


class Poles(NamedTuple):
    """x = Re(right z), z = left x, z' = rate z: one of two conjugate poles each."""

    rate: Complex  # (j,)
    right: Complex  # (n, j)
    left: Complex  # (j, n)


def poles_of(A: Real, modes: int, span: float, *, off: float = 0.0) -> Poles:
    """Return the poles of a phase, in closed form where its modes stay uncoupled, or some off."""
    S, C = -A[modes:, :modes], -A[modes:, modes : 2 * modes]
    if A.shape[0] == 2 * modes:
        if not _off(C).any() and not _off(S).any():
            return _oscillators(np.diag(C) / 2, (1 + off) * np.diag(S), np.eye(modes), span)
        damping = np.diag(C)
        size = 64 * np.finfo(float).eps * np.abs(damping).max(initial=0.0)
        if np.ptp(damping) <= size and (np.abs(_off(C)) <= size).all():
            square, W = np.linalg.eigh((S + S.T) / 2 + _astray(S, off))
            # of modes that are alike one more than the other, so that they part too
            each = off * (1 + 0.5 * (-1.0) ** np.arange(modes))
            square = (1 + each) * square + SHARE * each * np.abs(square).max(initial=0.0)
            return _oscillators(np.full(modes, damping.mean() / 2), square, W, span)
    if off:
        A = A.copy()
        A[modes : 2 * modes, :modes] -= _astray(S[:modes], off)
    rate, right = np.linalg.eig(A)
    left = np.linalg.inv(right)
    kept = rate.imag >= 0
    rate = rate + np.where(rate.imag > 0, 1j * off * np.abs(rate).max(initial=0.0), 0.0)
    weight = np.where(rate[kept].imag > 0, 2.0, 1.0)
    return Poles(
        rate[kept].astype(np.complex128),
        (right[:, kept] * weight).astype(np.complex128),
        left[kept].astype(np.complex128),
    )


def _astray(S: Real, off: float) -> Real:
    """Return what rounding may add to a stiffness, which turns shapes."""
    noise = np.random.default_rng(0).standard_normal(S.shape)
    most = np.abs(S).max(initial=0.0)
    return np.asarray(SHARE * off * most * (noise + noise.T) / np.sqrt(4 * len(S) or 1))


def _off(matrix: Real) -> Real:
    return np.asarray(matrix - np.diag(np.diag(matrix)))


def _oscillators(sigma: Real, square: Real, W: Real, span: float) -> Poles:
    """Return the poles of r'' + 2 sigma r' + square r, with q = W r."""
    least = np.maximum(DOUBLE * np.maximum(sigma**2, np.abs(square)), (STILL / span) ** 2)
    square = np.where(np.abs(square - sigma**2) < least, sigma**2 + least, square)
    swings, (one, other) = square > sigma**2, rates(sigma, square).T
    # r = z_1 + z_2, r' = p_1 z_1 + p_2 z_2, and of two conjugate poles one stands for both
    twice = np.where(swings, 2.0, 1.0)
    p = np.concatenate([one, other[~swings]])
    twin = np.concatenate([other, one[~swings]])
    shape = np.concatenate([W, W[:, ~swings]], axis=1)
    weight = np.concatenate([twice, np.ones(int((~swings).sum()))])
    right = np.concatenate([shape, shape * p]) * weight
    left = np.concatenate([-twin[:, None] * shape.T, shape.T.astype(np.complex128)], axis=1)
    return Poles(p, right, left / (p - twin)[:, None])
