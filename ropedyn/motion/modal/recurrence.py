"""Modes under a force of straight lines, from time to time without error of the step."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ... import _core
from ...base.array import Real
from ...scene.force import Samples
from .exponentials import Oscillators, is_uniform, ramp, rates

SLICE = 256  # The core takes so many blocks in one call: a look for Ctrl-C every millisecond.
BLOCK, LONG = 16, 8192
"""Even steps are taken so many at a time, twice as many of more samples than this."""
FREE, HELD, RAMP = [0, 1, 4, 5], [2, 6], [3, 7]
"""Changes by the state, under the force at the beginning, and under what it grows by."""
LANES = 8  # Modes of the core come in multiples of this.
SHORT = 1.5  # Taylor's series gives the change up to this rate times step,
TERMS = 23  # by so many terms,
WEIGHTS = np.array([[1.0, 1 / (n + 1), 1 / ((n + 1) * (n + 2))] for n in range(1, TERMS)]).T
"""which count so much in it and in its integrals."""


def straight_lines(modes: Oscillators, rest: Real, force: Samples, time: Real, order: int) -> Real:
    """Return the responses to a force by its samples, from rest at the first time."""
    inside = force.time[(force.time > time[0]) & (force.time < time[-1])]
    grid = time if np.array_equal(inside, time[1:-1]) else np.union1d(time, inside)
    sample = force.value(grid)
    slope = np.diff(sample) / np.diff(grid)
    slope = np.append(slope, slope[-1])
    followed = (sample, slope, np.zeros_like(slope))
    value = rest * followed[order]
    for k in range(order):
        modes, direct = modes.derivative()
        value = value + direct[:, None] * followed[order - 1 - k]
    value += _followed(modes, grid, sample)
    return value if len(grid) == len(time) else value[:, np.searchsorted(grid, time)]


def _followed(modes: Oscillators, grid: Real, sample: Real) -> Real:
    """Return a q + b q' at all times."""
    spare = -len(modes.sigma) % LANES
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
    size = min(BLOCK * (1 + (len(sample) > LONG)), len(sample))
    blocks = -(-len(sample) // size)
    padded = np.append(sample, np.full(blocks * size + 1 - len(sample), sample[-1]))
    force = np.lib.stride_tricks.sliding_window_view(padded, size + 1)[::size]
    slope = np.diff(force, axis=1)
    given = np.concatenate([force[:, :1], slope[:, :1], np.diff(slope, axis=1)], axis=1)
    count = np.arange(1.0, size + 1)
    part = changes(modes.sigma, modes.square, np.asarray(h * count))
    change = np.ascontiguousarray(part[-1:, FREE])
    held, grown = part[:, HELD], part[:, RAMP] * count[:, None, None]
    gain = np.concatenate([held[-1:], grown[::-1]]).reshape(size + 1, -1)
    seen = np.stack([modes.a, modes.b], axis=1)
    free = part[:-1, FREE].reshape(size - 1, 2, 2, -1)
    read = np.concatenate([seen[None], seen + np.einsum("rck,mcdk->mrdk", seen, free)])
    local = np.zeros((len(seen), size + 1, size))
    local[:, 0, 1:] = np.einsum("rck,mck->rm", seen, held[:-1])
    ramps = np.einsum("rck,mck->rm", seen, grown)
    for m in range(1, size):
        local[:, 1 : m + 1, m] = ramps[:, m - 1 :: -1]
    read = read.reshape(size, len(seen), -1)
    state, value = np.zeros((2, len(modes.sigma))), []
    for begin in range(0, blocks, SLICE):
        now = given[begin : begin + SLICE]
        push = (now @ gain).reshape(len(now), *state.shape)
        states = _core.recurrence(change, np.zeros(len(now), dtype=np.int32), push, state)
        before, state = states[:-1].reshape(len(now), -1), states[-1]
        each = [before @ read[:, r].T + now @ local[r] for r in range(len(seen))]
        value.append(np.stack([one.ravel() for one in each]))
    return np.concatenate(value, axis=1)[:, : len(sample)]


def _step_by_step(modes: Oscillators, h: Real, sample: Real) -> Real:
    """Follow steps of any lengths."""
    state, value = np.zeros((2, len(modes.sigma))), [np.zeros((len(modes.a), 1))]
    for begin in range(0, len(h), SLICE):
        lengths, which = np.unique(h[begin : begin + SLICE], return_inverse=True)
        part = changes(modes.sigma, modes.square, lengths)
        force = sample[begin : begin + SLICE + 1]
        push = part[which][:, HELD] * force[:-1, None, None]
        push += part[which][:, RAMP] * np.diff(force)[:, None, None]
        change = np.ascontiguousarray(part[:, FREE])
        states = _core.recurrence(change, which.astype(np.int32), push, state)
        after, state = states[1:], states[-1]
        value.append(modes.a @ after[:, 0].T + modes.b @ after[:, 1].T)
    return np.concatenate(value, axis=1)


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
