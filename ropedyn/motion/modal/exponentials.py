"""A motion as a sum of exponentials: Re sum_j weight_j e^(rate_j t)."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import NamedTuple, TypeVar

import numpy as np

from ...base.array import Complex, Flags, Index, Real

Value = TypeVar("Value", Real, Complex)
Numerator = Callable[[Complex, Index], Complex]

BLOCK = 128
"""Powers of so many times are tabled, and of the blocks of them: n of a grid are n products."""
SHARES = tuple(2**k for k in range(2, 40))
"""From these blocks on terms that have decayed are left out."""
NOTHING = 1e-20  # A term has decayed when it is less than this part of the largest one at first.
SLICE = 1 << 16  # So many exponentials are computed at once where times are not a grid.
FEW, SIDE_BY_SIDE = 512, 8  # A grid is looked for among so many times, and so many grids in them.
DIGITS = 38.0  # A circle around poles is right to so many digits, as a natural logarithm.
MOST = 4096  # A circle has so many nodes at most, also of numbers near the end of their range.
SMALL, TERMS = 0.5, 14  # Up to this |z| a ramp is Taylor's series of so many terms.
CLOSE = 0.5  # Poles nearer than this part of what time and decay tell apart share a circle.


class Oscillators(NamedTuple):
    """Modes q'' + 2 sigma q' + square q = f that move responses by a q + b q'."""

    sigma: Real  # (k,) [1/s]
    square: Real  # (k,) [rad^2/s^2]
    a: Real  # (responses, k)
    b: Real  # (responses, k)

    def derivative(self) -> tuple[Oscillators, Real]:
        """Return those of the responses' derivative, and what f itself adds, (responses,)."""
        a, b = -self.b * self.square, self.a - 2 * self.sigma * self.b
        return self._replace(a=a, b=b), self.b.sum(axis=1)


class Exponentials(NamedTuple):
    """Terms Re(weight e^(rate t)), each of one mode."""

    rate: Complex  # (j,) [1/s]
    weight: Complex  # (j,)
    mode: Index  # (j,)

    def state(self, part: Complex, modes: int) -> tuple[Real, Real]:
        """Return q and q' of each mode, of terms that have these values."""
        each = [part.real, (part * self.rate).real]
        q, v = (np.bincount(self.mode, one, modes).astype(np.float64) for one in each)
        return q, v


def rates(sigma: Real, square: Real) -> Complex:
    """Return the two zeros of s^2 + 2 sigma s + square, shape (k, 2), neither by cancellation."""
    split = np.sqrt(np.abs(sigma**2 - square))
    swings = square > sigma**2
    far = -(sigma + np.copysign(split, sigma))
    near = np.divide(square, far, out=np.zeros_like(far), where=far != 0)
    first = np.where(swings, -sigma + 1j * split, near)
    return np.stack([first, np.where(swings, np.conj(first), far)], axis=1)


def invert(poles: Complex, numerator: Numerator, span: float) -> Exponentials:
    """Return what functions of time have the transforms numerator/prod_i (s - pole_i).

        q(t) = 1/(2 pi i) sum over poles of the integral around them of Q(s) e^(s t) ds

    A simple pole gives one term, its residue. Around poles that nearly or wholly meet residues
    cancel: the trapezoidal rule on a circle around all of them gives as many terms as it has nodes,
    and its error falls as a power of their number (L. N. Trefethen, J. A. C. Weideman, SIAM Review
    56 (2014) 385).
    """
    apart = ~_close(poles, span).any(axis=(1, 2))
    parts = [_residues(poles, numerator, np.flatnonzero(apart))]
    for k in np.flatnonzero(~apart).tolist():
        parts.extend(_circled(poles[k], numerator, k, span))
    rate, weight, mode = (np.concatenate(each) for each in zip(*parts))
    return Exponentials(rate, weight, mode)


def unity(s: Complex, k: Index) -> Complex:
    """Return the numerator of a blow of 1."""
    return np.ones(len(k), dtype=complex)


def ramp(z: Value) -> Value:
    """Return the integral of (1 - u) e^(z u) from 0 to 1, (e^z - 1 - z)/z^2."""
    small = np.abs(z) < SMALL
    result = np.empty_like(z)
    near, far = z[small], z[~small]
    total, term = np.zeros_like(near), np.full_like(near, 0.5)
    for n in range(TERMS):
        total += term
        term *= near / (n + 3)
    result[small] = total
    result[~small] = (np.expm1(far) - far) / far**2
    return result


def evaluate(rate: Complex, coefficient: Complex, time: Real) -> Real:
    """Return Re sum_j coefficient[r, j] e^(rate_j t), shape (r, t); not finite if it overflows."""
    acts = coefficient.any(axis=0)
    if not acts.any():
        return np.zeros((len(coefficient), len(time)))
    rate, where = np.unique(rate[acts], return_inverse=True)
    merged = np.zeros((len(rate), len(coefficient)), dtype=complex)
    np.add.at(merged, where, coefficient[:, acts].T)
    if is_uniform(time):
        return _on_grid(rate, merged.T, time)
    out = np.empty((len(coefficient), len(time)))
    for part in _grids(time):
        on_grid = is_uniform(time[part])
        out[:, part] = (_on_grid if on_grid else _anywhere)(rate, merged.T, time[part])
    return out


def _grids(time: Real) -> Iterator[slice]:
    """Yield times that are a grid, as every fifth of the stages of equal steps, and the rest."""
    begin, step, same = 0, np.diff(time), 2 * np.spacing(np.abs(time[-1:]))
    while len(time) - begin > FEW:
        left = step[begin:]
        again = np.flatnonzero(np.abs(left[1 : SIDE_BY_SIDE + 1] - left[0]) <= same)
        if not len(again):
            break
        count = int(again[0]) + 1
        differs = np.flatnonzero(np.abs(left[count:] - left[:-count]) > same)
        stop = begin + count + int(differs[0]) + 1 if len(differs) else len(time)
        if stop - begin < FEW:
            break
        yield from (slice(begin + k, stop, count) for k in range(count))
        begin = stop
    if begin < len(time):
        yield slice(begin, None)


def is_uniform(time: Real) -> bool:
    """Say whether times are a grid, up to their rounding."""
    if len(time) < 2:
        return False
    grid = np.linspace(time[0], time[-1], len(time))
    return bool(np.all(np.abs(time - grid) <= 2 * np.spacing(np.abs(time[-1]))))


def _on_grid(rate: Complex, coefficient: Complex, time: Real) -> Real:
    """Evaluate by blocks: e^(z (a BLOCK + b) h) is a product, the sum over z one of matrices."""
    # terms leave from the block on in which they have decayed to nothing
    h = (time[-1] - time[0]) / (len(time) - 1)
    blocks = -(-len(time) // BLOCK)
    within = _powers(rate, h, min(BLOCK, len(time)))
    last = _lasts(rate, coefficient, time, h * BLOCK)
    values = np.zeros((len(coefficient), blocks, within.shape[1]))
    for first, stop in pairwise(np.unique(np.minimum([0, *SHARES, blocks], blocks)).tolist()):
        z = np.flatnonzero(last >= first)
        if len(z) == 0:
            break
        begin = coefficient[:, z] * np.exp(rate[z] * (time[0] + h * BLOCK * first))
        left = begin[:, :, None] * _powers(rate[z], h * BLOCK, stop - first)
        left = left.transpose(0, 2, 1)
        left = np.concatenate([left.real, -left.imag], axis=2)
        right = np.concatenate([within[z].real, within[z].imag])
        values[:, first:stop] = (
            left @ right
        )  # each response by itself: bits do not depend on others
    return values.reshape(len(coefficient), -1)[:, : len(time)]


def _powers(rate: Complex, step: float, count: int) -> Complex:
    """Return e^(rate step n), n < count, shape (j, count), as products of few exponentials."""
    low = math.isqrt(count - 1) + 1
    near = np.exp(np.multiply.outer(rate, step * np.arange(low)))
    far = np.exp(np.multiply.outer(rate, step * low * np.arange(-(-count // low))))
    return (far[:, :, None] * near[:, None]).reshape(len(rate), -1)[:, :count]


def _lasts(rate: Complex, coefficient: Complex, time: Real, block: float) -> Real:
    """Return the last block [of a length in s] in which each term is seen beside the largest."""
    size = np.abs(coefficient) * np.exp(rate.real * time[0])
    largest = size.max(axis=1, keepdims=True)
    share = np.divide(size, largest, out=np.zeros_like(size), where=largest > 0).max(axis=0)
    seen = np.log(np.maximum(share, NOTHING) / NOTHING)
    decay = np.maximum(-rate.real, 0.0) * block
    return np.divide(seen, decay, out=np.full(len(rate), np.inf), where=decay > 0)


def _anywhere(rate: Complex, coefficient: Complex, time: Real) -> Real:
    out = np.empty((len(coefficient), len(time)))
    step = max(1, SLICE // len(rate))
    for first in range(0, len(time), step):
        now = slice(first, first + step)
        power = np.exp(np.multiply.outer(rate, time[now]))
        out[:, now] = coefficient.real @ power.real - coefficient.imag @ power.imag
    return out


def _close(poles: Complex, span: float) -> Flags:
    """Say which poles of a mode cancel, shape (k, m, m), the diagonal False."""
    one, other = poles[..., :, None], poles[..., None, :]
    close = np.abs(one - other) < CLOSE * _width(one + other, span)
    diagonal = np.arange(poles.shape[-1])
    close[..., diagonal, diagonal] = False
    return close


def _width(twice: Complex, span: float) -> Real:
    """Return how far rates around a mean differ in what they do: over the span, or before decay."""
    return 1 / span + np.maximum(-twice.real, 0) / 4


def _residues(poles: Complex, numerator: Numerator, modes: Index) -> Exponentials:
    rate, weight, mode = [], [], []
    for i in range(poles.shape[1]):
        pole = poles[modes, i]
        use = pole.imag >= 0
        z, k = pole[use], modes[use]
        others = np.delete(poles[k], i, axis=1)
        rate.append(z)
        weight.append(_both(z) * numerator(z, k) / np.prod(z[:, None] - others, axis=1))
        mode.append(k)
    return Exponentials(np.concatenate(rate), np.concatenate(weight), np.concatenate(mode))


def _both(rate: Complex) -> Real:
    """Return the share of a term that stands for its conjugate as well."""
    return np.where(rate.imag > 0, 2.0, 1.0)


def _circled(poles: Complex, numerator: Numerator, k: int, span: float) -> list[Exponentials]:
    """Return the terms of a mode some of whose poles are close."""
    parts = []
    for inside in _groups(poles, span):
        center = poles[inside].mean()
        if center.imag < 0:
            continue
        if inside.sum() == 1:
            one = np.concatenate([poles[inside], poles[~inside]])[None]
            at = np.zeros(1, dtype=np.intp)
            weight = _both(center) * numerator(one[:, 0], at + k)
            weight /= np.prod(one[0, 0] - one[0, 1:])
            parts.append(Exponentials(one[:, 0], weight, at + k))
            continue
        radius, nodes = _circle(poles, inside, span)
        angle = 2 * np.pi * (np.arange(nodes) + 0.5) / nodes
        arm = radius * np.exp(1j * angle if center.imag else 1j * angle[: nodes // 2])
        at = np.full(len(arm), k)
        z = center + arm
        weight = 2 * arm * numerator(z, at) / np.prod(z[:, None] - poles, axis=1) / nodes
        parts.append(Exponentials(z, weight, at))
    return parts


def _groups(poles: Complex, span: float) -> list[Flags]:
    """Return which poles one circle goes around: those that are close, and what is in its way."""
    reach = np.linalg.matrix_power(_close(poles, span) + np.eye(len(poles)), len(poles)) > 0
    while True:
        groups = list(np.unique(reach, axis=0))
        for inside in groups:
            center = poles[inside].mean()
            inner, outer = _ring(poles, inside)
            if outer < 1.4 * inner:
                near = np.abs(poles - center) < 1.4 * inner * (1 + 1e-9)
                joined = reach[near].any(axis=0) if center.imag == 0 else near | True
                reach[np.ix_(joined, joined)] = True
                break
        else:
            return groups


def _ring(poles: Complex, inside: Flags) -> tuple[float, float]:
    """Return how far the farthest of some poles is from their mean, and the nearest other."""
    away = np.abs(poles - poles[inside].mean())
    return float(away[inside].max()), float(away[~inside].min(initial=math.inf))


def _circle(poles: Complex, inside: Flags, span: float) -> tuple[float, int]:
    """Return the radius of a circle around some poles, and how many nodes it takes."""
    # with n nodes the poles add (inner/radius)^n and (radius/outer)^n, the exponential its term
    # (radius t)^n/n! of Taylor's series, which decay keeps below (radius/decay)^n.
    inner, outer = _ring(poles, inside)
    center = poles[inside].mean()
    width = float(_width(2 * center, span))
    low, high = max(inner, min(width, outer) / 4), min(outer, 4 * max(width, inner))
    radius = math.sqrt(low) * math.sqrt(high)
    ratio = max(inner / radius, radius / outer)
    nodes = 2 * math.ceil(DIGITS / math.log(1 / ratio) / 2) if ratio > 0 else 2
    decay = max(-center.real, 0)
    slow = math.log(decay / radius) if decay > radius else 0.0
    turn = math.log(radius * span)
    while max(slow * nodes, math.lgamma(nodes + 1) - nodes * turn) < DIGITS and nodes < MOST:
        nodes += 2
    return radius, nodes
