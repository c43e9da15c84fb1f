"""Forces as functions of the rate s: f(s) = integral of f(t) e^(-s (t - begin)) from `begin` on."""

from __future__ import annotations

import math

import numpy as np

from ...base.array import Complex, Real
from ...scene.force import Chirp, Force, Samples, Sum
from ..modal import chirp
from ..modal.convolution import SinePiece, pieces
from ..modal.exponentials import ramp
from .grid import MOST, ROUNDED, Grid, is_even

ORDER = 16  # The highest of rates of one order over the lowest.
WIDE = 0.5  # Half a hat that begins before the first sample is e^(a h) times as large as others.
SPREAD = 7  # Terms of a jump spread over 1/omega.


def transform(force: Force, grid: Grid) -> Complex:
    """Return the transform of a force at the rates of a grid, shape (lines,)."""
    if isinstance(force, Sum):
        return np.asarray(sum(transform(one, grid) for one in force.forces))
    if isinstance(force, Samples):
        few = grid.a * float(force.time[-1] - force.time[0]) > WIDE * (len(force.time) - 1)
        if grid.even and len(force.time) == len(grid.time) and not few:
            return _of_samples(force, grid)
        return (_of_hats if is_even(force.time, 0.0) and not few else _of_corners)(force, grid)
    if isinstance(force, Chirp):
        return chirp.transform(force, grid.s, grid.begin, grid.begin + grid.period)
    turns = pieces(force, grid.begin)
    return _of_sines([one for one in turns if one.start <= grid.time[-1]], grid)


def _of_sines(turns: list[SinePiece], grid: Grid) -> Complex:
    """Transform pieces of sines, each until the next one."""
    s = grid.s
    total = np.zeros(len(s), dtype=np.complex128)
    for piece, following in zip(turns, [*turns[1:], None]):
        now = np.exp(-s * (piece.start - grid.begin))
        total += now * piece.kick
        w = piece.frequency
        if piece.cosine == 0 and piece.sine == 0:
            continue
        both = s * s + w * w
        total += now * (piece.cosine * s + piece.sine * w) / both
        if following is not None:
            at = np.array([following.start])
            value, rate = (float(piece.value(at, k)[0]) for k in range(2))
            total -= np.exp(-s * (following.start - grid.begin)) * (value * s + rate) / both
    return total


def _of_samples(force: Samples, grid: Grid) -> Complex:
    """Transform straight lines between even samples: hats, half of one at the first."""
    # after the last sample the force goes to 0 smoothly
    h, count, given = grid.step, grid.count, len(force.sample)
    spare = (count - given) // 2
    f = np.zeros(count)
    fading = (1 + np.cos(np.pi * np.arange(1, spare + 1) / (spare + 1))) / 2
    f[:given], f[given : given + spare] = force.sample, force.sample[-1] * fading
    spectrum = np.fft.fft(f * np.exp(-grid.a * h * np.arange(count)))
    z = grid.s * h
    # what e^z makes comes back with the samples; z does not
    hats = np.resize(spectrum[: len(z)] * (2 * np.sinh(z[:count] / 2)) ** 2, len(z))
    total = np.resize(spectrum, len(z))
    np.divide(hats, z * z, out=total, where=z != 0)
    if force.sample[0]:
        total -= force.sample[0] * ramp(z)
    return np.asarray(h * total if is_even(force.time, 0.0) else h * total + _off_even(force, grid))


def _off_even(force: Samples, grid: Grid) -> Complex:
    """Transform what straight lines between nearly even times add to those between even ones."""
    even = np.linspace(force.time[0], force.time[-1], len(force.time))
    corners = (
        np.diff(np.diff(force.sample) / np.diff(time), prepend=0.0, append=0.0)
        for time in (even, force.time)
    )
    before, corner = (one * np.exp(-grid.a * (even - grid.begin)) for one in corners)
    here, later = np.fft.fft([corner - before, corner * (force.time - even)], grid.count)
    size = len(grid.s)
    return np.asarray((np.resize(here, size) / grid.s - np.resize(later, size)) / grid.s)


def _of_hats(force: Samples, grid: Grid) -> Complex:
    """Transform straight lines between even samples of other steps than the grid's."""
    time, sample, s = force.time - grid.begin, force.sample, grid.s
    h, left = float(time[-1] - time[0]) / (len(time) - 1), float(grid.period - time[-1])
    z = s * h
    hats = (np.sinh(z / 2) / (z / 2)) ** 2 * _of_blows(force, grid)
    # half of one at the first; after the last the force goes to 0 on a straight line
    last = sample[-1] * np.exp(-s * time[-1]) * (left * ramp(-s * left) - h * ramp(-z))
    return np.asarray(h * (hats - sample[0] * ramp(z)) + last)


def _of_blows(force: Samples, grid: Grid) -> Complex:
    """Transform even samples as blows: at once where they stand on even steps that the grid has."""
    time, steps = force.time - grid.begin, len(force.time) - 1
    ends, both = [0, -1], math.lcm(steps, grid.steps)
    alike = np.allclose(force.time[ends], grid.time[ends], rtol=4 * ROUNDED, atol=0.0)
    if not alike or both > MOST:
        return grid.exponentials(time, force.sample, range(len(grid.s)))
    blow = np.zeros(grid.count * (both // grid.steps))
    blow[: both + 1 : both // steps] = force.sample * np.exp(-grid.a * time)
    return np.resize(np.fft.fft(blow), len(grid.s))


def _of_corners(force: Samples, grid: Grid) -> Complex:
    """Transform samples at any times: jumps over s and corners over s^2."""
    time = np.append(force.time - grid.begin, grid.period)
    sample = np.append(force.sample, 0.0)
    total = np.asarray(sample[0] / grid.s)
    # corners cancel where times are within a turn: rates of one order are told together
    end = len(grid.s)
    while end:
        rates = range(end // ORDER, end)
        total[rates.start : end] += _of_rises(time, sample, grid, rates)
        end = rates.start
    return total


def _of_rises(time: Real, sample: Real, grid: Grid, rates: range) -> Complex:
    """Transform the slope of straight lines over s: those within a turn as jumps spread evenly."""
    s = grid.s[rates.start : rates.stop]
    step, rise = np.diff(time), np.diff(sample)
    short = step * abs(s[-1]) <= 1
    corner = np.diff(np.where(short, 0.0, rise / step), prepend=0.0, append=0.0)
    total = grid.exponentials(time, corner, rates) / s**2
    middle, half, jump = time[:-1][short] + step[short] / 2, step[short] / 2, rise[short]
    for m in range(SPREAD if short.any() else 0):
        share = jump * half ** (2 * m) / math.factorial(2 * m + 1)
        total += grid.exponentials(middle, share, rates) * s ** (2 * m - 1)
    return np.asarray(total)
