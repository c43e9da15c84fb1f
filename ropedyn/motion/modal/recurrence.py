"""Modes under a force of straight lines, from time to time without error of the step."""

from __future__ import annotations

import numpy as np

from ... import _core
from ...base.array import Complex, Real
from ...scene.force import Samples
from .exponentials import Oscillators, invert, is_uniform, rates, unity

STEPS = 2048  # The core takes so many steps in one call: a look for Ctrl-C every millisecond.
LANES = 8  # Modes of the core come in multiples of this.
SHORT = 1.5  # Taylor's series gives the change up to this rate times step,
TERMS = 30  # by so many terms.


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
    value[:, 1:] += _followed(modes, grid, sample)
    return value if len(grid) == len(time) else value[:, np.searchsorted(grid, time)]


def _followed(modes: Oscillators, grid: Real, sample: Real) -> Real:
    """Return a q + b q' at all times but the first."""
    spare = -len(modes.sigma) % LANES
    wide = Oscillators(*(np.pad(each, [(0, 0)] * (each.ndim - 1) + [(0, spare)]) for each in modes))
    seen = np.ascontiguousarray(np.stack([wide.a, wide.b], axis=1))
    state = np.zeros((2, len(wide.sigma)))
    h, uniform = np.diff(grid), is_uniform(grid)
    if uniform:
        h[:] = (grid[-1] - grid[0]) / len(h)
    value = []
    known, change = np.zeros(0), np.zeros(0)
    for first in range(0, len(h), STEPS):
        now = h[first : first + STEPS]
        lengths, which = now[:1], np.zeros(len(now), dtype=np.intp)
        if not uniform:
            lengths, which = np.unique(now, return_inverse=True)
        if not np.array_equal(lengths, known):
            known, change = lengths, changes(wide.sigma, wide.square, lengths)
        force = sample[first : first + STEPS + 1]
        part, state = _core.recurrence(change, seen, which.astype(np.int32), force, state)
        value.append(part)
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


def _integrals(sigma: Real, square: Real, h: Real) -> tuple[Real, Real, Real]:
    """Return S, P and R at times h, shape (h, k) each."""
    size = np.abs(rates(sigma, square)).max(axis=1)
    result = np.empty((3, len(h), len(sigma)))
    octaves = np.frexp(h)[1]  # lengths within a factor of 2 are taken together
    for octave in (np.flatnonzero(octaves == each) for each in np.unique(octaves)):
        short = size * h[octave].max() <= SHORT
        for use, found in ((short, _series), (~short, _inverted)):
            at = np.ix_(octave, np.flatnonzero(use))
            for whole, part in zip(result, found(sigma[use], square[use], h[octave])):
                whole[at] = part
    return result[0], result[1], result[2]


def _series(sigma: Real, square: Real, h: Real) -> Real:
    """Sum S = sum_n c_n, (n + 1) c_n = -2 sigma h c_(n-1) - square h^2/n c_(n-2), and integrals."""
    t = h[:, None]
    before, term = np.zeros((len(h), len(sigma))), np.broadcast_to(t, (len(h), len(sigma)))
    result = np.zeros((3, len(h), len(sigma)))
    for n in range(1, TERMS):
        result += np.stack([term, term * t / (n + 1), term * t * t / ((n + 1) * (n + 2))])
        drag, spring = -2 * sigma * t * term, -square * t * t * before
        before, term = term, (drag + spring / n) / (n + 1)
    return result


def _inverted(sigma: Real, square: Real, h: Real) -> Real:
    """Invert 1, 1/s and 1/s^2 times the transform of S; R'' + 2 sigma R' + square R = h as well."""
    result = np.zeros((3, len(h), len(sigma)))
    own = rates(sigma, square)
    for k in range(2):
        result[k] = _inverted_over(own, k, h)
    slow = np.abs(own).min(axis=1) * h.min() < SHORT / 2
    result[2][:, slow] = _inverted_over(own[slow], 2, h)
    S, P = result[:2, :, ~slow]
    result[2][:, ~slow] = (h[:, None] - 2 * sigma[~slow] * P - S) / square[~slow]
    return result


def _inverted_over(own: Complex, power: int, h: Real) -> Real:
    """Invert 1/s^power of each mode's own, shape (h, k)."""
    result = np.zeros((len(h), len(own)))
    if len(own):
        poles = np.concatenate([own, np.zeros((len(own), power))], axis=1)
        terms = invert(poles, unity, float(h.max()))
        parts = (np.exp(np.multiply.outer(h, terms.rate)) * terms.weight).real
        np.add.at(result.T, terms.mode, parts.T)
    return result
