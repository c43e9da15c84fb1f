"""Modes under a force of straight lines, from time to time without error of the step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ...base.array import Real
from ...scene.force import Samples
from .exponentials import Oscillators, is_uniform, ramp, rates

SLICE = 1 << 20  # The core takes so many samples of modes in one call: a look for Ctrl-C,
KINDS = 256  # or so many steps that may be of different lengths.
BLOCK = 8  # Even steps are taken so many at a time.
FREE, HELD, RAMP = [0, 1, 4, 5], [2, 6], [3, 7]
"""Changes by the state, under the force at the beginning, and under what it grows by."""
QUAD = 4  # Modes of the core come in groups of so many.
SHORT = 1.5  # Taylor's series gives the change up to this rate times step,
TERMS = 23  # by so many terms,
WEIGHTS = np.array([[1.0, 1 / (n + 1), 1 / ((n + 1) * (n + 2))] for n in range(1, TERMS)]).T
"""which count so much in it and in its integrals."""


def straight_lines(modes: Oscillators, rest: Real, force: Samples, time: Real, order: int) -> Real:
    """Return the responses to a force by its samples, from rest at the first time."""
    grid = _with_corners(force.time, time)
    sample = force.value(grid)

    def derived(order: int) -> Real | float:
        if order > 1:
            return 0.0
        slope = np.diff(sample) / np.diff(grid) if order else sample
        return np.append(slope, slope[-1]) if order else slope

    at_once = [(rest, order)]
    for k in range(order):
        modes, direct = modes.derivative()
        at_once.append((direct[:, None], order - 1 - k))
    value = _followed(modes, grid, sample)
    for size, kind in at_once:
        if size.any():
            value += size * derived(kind)
    return value if len(grid) == len(time) else value[:, np.searchsorted(grid, time)]


def _with_corners(corner: Real, time: Real) -> Real:
    """Return times and what corners are between them."""
    if corner is time:
        return time
    inside = corner[np.searchsorted(corner, time[0], "right") : np.searchsorted(corner, time[-1])]
    return time if np.array_equal(inside, time[1:-1]) else np.union1d(time, inside)


def _followed(modes: Oscillators, grid: Real, sample: Real) -> Real:
    """Return a q + b q' at all times."""
    spare = -len(modes.sigma) % QUAD
    wide = Oscillators(
        *(np.concatenate([each, np.zeros((*each.shape[:-1], spare))], axis=-1) for each in modes)
    )
    if is_uniform(grid):
        return _in_blocks(wide, (grid[-1] - grid[0]) / (len(grid) - 1), sample)
    return _step_by_step(wide, np.diff(grid), sample)


def _in_blocks(modes: Oscillators, h: float, sample: Real) -> Real:
    """Follow even steps: only the state at the beginning of each block goes on to the next.

    Within a block a force is what it is at the beginning, f, and a change c_i of its slope times h
    at the i-th sample. With S, P, R as in `changes` that adds at the m-th sample

        q: P_m f + sum_i R_(m-i) c_i/h,    v: S_m f + sum_i P_(m-i) c_i/h

    to the free motion, in which the same P and S balance a force at rest to the last digit.
    """
    size = min(BLOCK, len(sample))
    count = np.arange(1.0, size + 1)
    part = changes(modes.sigma, modes.square, np.asarray(h * count))
    held, grown = part[:, HELD], part[:, RAMP] * count[:, None, None]
    seen = _seen(modes)
    free = part[:-1, FREE].reshape(size - 1, 2, 2, -1)
    read = np.concatenate([seen[None], seen + np.einsum("rck,mcdk->mrdk", seen, free)])
    local = np.zeros((size, len(seen), size))
    local[1:, :, 0] = np.einsum("rck,mck->mr", seen, held[:-1])
    ramps = np.einsum("rck,mck->mr", seen, grown)
    for m in range(1, size):
        local[m, :, 1 : m + 1] = ramps[m - 1 :: -1].T
    blocks = -(-len(sample) // size)
    padded = np.append(sample, np.full(blocks * size + 1 - len(sample), sample[-1]))
    kind, state = np.zeros(blocks, dtype=np.int32), np.zeros((2, len(modes.sigma)))
    gain = np.concatenate([held[-1:], grown[::-1]])[None]
    table = _Blocks(part[-1:, FREE], gain, read, local)
    return table.followed(kind, padded, state)[0][:, : len(sample)]


def _step_by_step(modes: Oscillators, h: Real, sample: Real) -> Real:
    """Follow steps of any lengths."""
    seen, value = _seen(modes), []
    state, read, local = np.zeros((2, len(modes.sigma))), seen[None], np.zeros((1, len(seen), 1))
    for begin in range(0, len(h), KINDS):
        lengths, which = np.unique(h[begin : begin + KINDS], return_inverse=True)
        part = changes(modes.sigma, modes.square, lengths)
        gain = np.stack([part[:, HELD], part[:, RAMP]], axis=1)
        table = _Blocks(part[:, FREE], gain, read, local)
        now = sample[begin : begin + KINDS + 1]
        found, state = table.followed(which.astype(np.int32), now, state)
        value.append(found)
    last = np.einsum("rck,ck->r", seen, state)
    return np.concatenate([*value, last[:, None]], axis=1)


def _seen(modes: Oscillators) -> Real:
    """Return what responses have of q and of v, (responses, 2, k)."""
    return np.stack([modes.a, modes.b], axis=1)


class _Blocks(NamedTuple):
    """Blocks of samples that modes go through, of some kinds; see csrc/base/recurrence.h."""

    change: Real  # (kinds, 4, k)
    gain: Real  # (kinds, size + 1, 2, k)
    read: Real  # (size, responses, 2, k)
    local: Real  # (size, responses, size)

    def followed(self, kind: NDArray[np.int32], sample: Real, state: Real) -> tuple[Real, Real]:
        """Return responses at all samples but the last, and the state there, (2, k)."""
        size, modes = len(self.local), state.shape[-1]
        change, gain, read, state = map(_grouped, (self.change, self.gain, self.read, state))
        most, value = max(1, SLICE // (max(modes, 1) * size)), []
        for begin in range(0, len(kind), most):
            now = kind[begin : begin + most]
            force = sample[begin * size : (begin + len(now)) * size + 1]
            found, state = _core.recurrence(change, gain, read, self.local, now, force, state)
            value.append(found)
        return np.concatenate(value, axis=1), np.moveaxis(state, 0, -2).reshape(2, modes)


def _grouped(table: Real) -> Real:
    """Return a table of modes (.., k) with groups of them first, (groups, .., QUAD)."""
    parted = table.reshape(*table.shape[:-1], -1, QUAD)
    return np.ascontiguousarray(np.moveaxis(parted, -2, 0))


def changes(sigma: Real, square: Real, h: Real) -> Real:
    """Return how steps of each length change q and v of each mode, shape (h, 8, k).

    With S, the motion after a blow of 1, its first and second integrals P and R, and a force from f
    to f + d,

        q: -square P q + S v + P f + R d/h
        v: -square S q - (2 sigma S + square P) v + S f + P d/h
    """
    S, P, R = _integrals(sigma, square, h)
    rise = 1 / h[:, None]
    parts = [-square * P, S, P, R * rise]
    parts += [-square * S, -(2 * sigma * S + square * P), S, P * rise]
    return np.ascontiguousarray(np.stack(parts, axis=1))


class _Advance(NamedTuple):
    """Modes and times, any one shape."""

    sigma: Real  # [1/s]
    square: Real  # [rad^2/s^2]
    split: Real  # |sigma^2 - square|^(1/2) [1/s]
    near: Real  # The real rates, or the real part of both [1/s]
    far: Real
    t: Real  # [s]


def _integrals(sigma: Real, square: Real, h: Real) -> tuple[Real, Real, Real]:
    """Return S, P and R at times h, shape (h, k) each."""
    own = rates(sigma, square)
    split = np.sqrt(np.abs(sigma**2 - square))
    near, far = own.real.T
    steps = _Advance(*np.broadcast_arrays(sigma, square, split, near, far, h[:, None]))
    result = np.empty((3, len(h), len(sigma)))
    swings = np.broadcast_to(square > sigma**2, result.shape[1:])
    short = np.abs(own).max(axis=1) * steps.t <= SHORT
    slow = ~swings & (np.abs(near) * steps.t <= SHORT / 2)
    for use, integrals in (
        (short, _series),
        (~short & swings, _swinging),
        (~short & slow, _creeping),
        (~short & ~swings & ~slow, _falling),
    ):
        if use.any():
            result[:, use] = integrals(_Advance(*(one[use] for one in steps)))
    return result[0], result[1], result[2]


def _series(steps: _Advance) -> Real:
    """Sum S = sum_n c_n, (n + 1) c_n = -2 sigma t c_(n-1) - square t^2/n c_(n-2), and integrals."""
    t = steps.t
    drag, spring = 2 * steps.sigma * t, steps.square * t * t
    term = np.zeros((TERMS, len(t)))
    term[1] = t
    for n in range(1, TERMS - 1):
        term[n + 1] = (drag * term[n] + spring / n * term[n - 1]) / -(n + 1)
    return np.asarray(WEIGHTS @ term[1:] * np.stack([np.ones_like(t), t, t * t]))


def _swinging(steps: _Advance) -> Real:
    """Return S = e^(-sigma t) sin(w t)/w, and its integrals."""
    t, turn = steps.t, steps.split * steps.t
    decay = np.exp(-steps.sigma * t)
    return _integrated(steps, decay * t * np.sinc(turn / np.pi), decay * np.cos(turn))


def _falling(steps: _Advance) -> Real:
    """Return the same where both rates are real."""
    t = steps.t
    slower = np.exp(np.maximum(steps.near, steps.far) * t)
    apart = -2 * steps.split * t
    return _integrated(steps, slower * t * _mean(apart), slower * (1 + np.expm1(apart) / 2))


def _integrated(steps: _Advance, S: Real, C: Real) -> Real:
    """Integrate S'' + 2 sigma S' + square S = 0 with S' = C - sigma S, once and twice."""
    P = (1 - C - steps.sigma * S) / steps.square
    return np.stack([S, P, (steps.t - 2 * steps.sigma * P - S) / steps.square])


def _creeping(steps: _Advance) -> Real:
    """Return them where one rate is nearly 0: divided differences of e^(s t) and its integrals."""
    t = steps.t
    one, other = (
        np.stack([np.exp(z), t * _mean(z), t * t * ramp(z)])
        for z in (steps.near * t, steps.far * t)
    )
    return (one - other) / (steps.near - steps.far)


def _mean(z: Real) -> Real:
    """Return the integral of e^(z u) from 0 to 1."""
    return np.divide(np.expm1(z), z, out=np.ones_like(z), where=z != 0)
