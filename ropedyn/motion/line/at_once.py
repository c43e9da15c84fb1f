"""What a transfer function does at once: its course beyond the rates that are looked at.

With H(s) = h_0 + h_1/s + h_2/s^2 + .. beyond them, a force that jumps makes motion jump by h_0 of
it, its velocity by h_1 and its acceleration by h_2. Motion of two overdamped oscillators,
known in closed form, does the same up to h_4; what is left is smooth, so its spectrum ends soon.
"""

from __future__ import annotations

import math

import numpy as np

from ...base.array import Complex, Real
from ..modal.expansion import Expansion

LOOKS = 2.0 ** np.arange(4) * np.exp(0.25j * math.pi)
"""H is looked at here over the highest rate: away from real rates and from resonances."""
TERMS = 7  # It is fitted by so many terms, of which the first ORDER + 1 count,
ORDER = 4
FLOOR = 1e-6  # relative to each value, this part of the largest at least.
TINY = 1e-300  # What is less is 0.
PAIRS = np.array([[1.0, 2.0], [1.5, 3.0]])  # Rates at which each decays, over the slowest.
SLOWER = (64.0, 32.0, 16.0, 8.0, 4.0)  # The highest rate over the slowest is the first of these
LARGE = 4.0  # with which slow forces are followed by at most so much more than the whole does.


def at_once(value: Complex, omega: float, slow: Complex) -> Expansion:
    """Return oscillators that do it, from values at omega LOOKS and at the least rate, slow."""
    h = _fitted(value)
    for slower in SLOWER:
        still = h[..., 0] + (h[..., 1:] * slower ** np.arange(1, ORDER + 1) * AT_REST).sum(axis=-1)
        if (np.abs(still) <= LARGE * np.abs(slow)).all():
            break
    return _oscillators(h, omega, slower)


def _oscillators(h: Real, omega: float, slower: float) -> Expansion:
    """Return oscillators of rates from omega/slower on, from h_m/omega^m."""
    slow = omega / slower
    # row by row: a response has the same bits beside others
    terms = h[..., 1:] * slower ** np.arange(1, ORDER + 1)
    ab = (terms[..., None, :] * MATCHED).sum(axis=-1)
    b, a = (np.asarray(ab[..., k::2] * slow ** (k + 1), dtype=np.float64) for k in range(2))
    sigma = np.asarray(slow * PAIRS.mean(axis=1), dtype=np.float64)
    square = np.asarray(slow**2 * PAIRS.prod(axis=1), dtype=np.float64)
    return Expansion(sigma, square, a, b, h[..., 0], np.zeros(h.shape[:2]))


def _fitted(value: Complex) -> Real:
    """Return h_m/omega^m, shape (.., ORDER + 1)."""
    size = np.abs(value)
    most = size.max(axis=-1, keepdims=True)
    weight = 1 / np.where(most > TINY, size + FLOOR * most, 1.0)
    rows = weight[..., None] * LOOKS[:, None] ** -np.arange(TERMS)
    right = weight * value
    rows = np.concatenate([rows.real, rows.imag], axis=-2)
    right = np.concatenate([right.real, right.imag], axis=-1)
    return np.asarray((np.linalg.pinv(rows, rcond=1e-13) @ right[..., None])[..., : ORDER + 1, 0])


def _matching() -> Real:
    """Return the terms 1/s^m of s/((s + p)(s + q)) and 1/((s + p)(s + q)), a column each."""
    m = np.arange(ORDER)[:, None]
    p, q = PAIRS.T
    terms = (-1.0) ** m * (q ** (m + 1) - p ** (m + 1)) / (q - p)
    late = np.concatenate([np.zeros((1, len(PAIRS))), terms[:-1]])
    return np.stack([terms, late], axis=2).reshape(ORDER, -1)


MATCHED = np.linalg.inv(_matching())
"""From terms 1/s^m to the oscillators that have them,"""
AT_REST = (1 / PAIRS.prod(axis=1)) @ MATCHED[1::2]
"""and to what these do at rest."""


def response(oscillators: Expansion, s: Complex) -> Complex:
    """Return the transfer functions of the oscillators, shape (drives, responses, n)."""
    sigma, square = oscillators.sigma[:, None], oscillators.square[:, None]
    turn = 1 / (s * s + 2 * sigma * s + square)
    moving = oscillators.a @ turn + oscillators.b @ (s * turn)
    return np.asarray(moving + oscillators.rest[..., None])


def at_once_by(oscillators: Expansion) -> Real:
    """Return h_0, h_1 and h_2 of the oscillators, shape (drives, responses, 3)."""
    a, b, sigma = oscillators.a, oscillators.b, oscillators.sigma
    return np.stack([oscillators.rest, b.sum(axis=-1), (a - 2 * sigma * b).sum(axis=-1)], axis=-1)
