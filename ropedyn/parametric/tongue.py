"""Where instability begins in the plane of frequency and amplitude of the tension."""

from __future__ import annotations

import math
from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np

from ..base.array import Flags, Index, Real
from .modal_system import ModalSystem
from .monodromy import ANGLE, exponent, periods, rates, scales

HIGHEST_ORDER = 4  # Resonances up to this order are looked for.
NEUTRAL = 1e-6
"""Growth ln|multiplier| over a period is seen above this where undamped motion keeps its size: two
multipliers that meet on the unit circle are the root of 1e-16 off it by rounding."""
PARTS = 8  # So many parts of an interval near a resonance are looked at together.
SECTIONS = 4  # An interval around a boundary is cut into so many.
CLOSE = 1e-10  # The last interval around a boundary has this relative width,
ROUGH = 1e-6  # and this one around a boundary that is looked at again, with damping.
LEAST = 1e-8  # A tongue is looked for where a power of the relative pulsation is above this.
PART = 0.05  # A mode with less of the energy of a motion belongs to another one.
ZOOMS = 3  # Where growth is largest is looked at so often, ever closer.


class Tongue(NamedTuple):
    """A region of instability, by where it begins at no amplitude."""

    modes: tuple[int, int]  # two numbers of modes, from 1; the same twice where one alone grows
    order: int  # n of n f = f_i + f_j
    frequency: float  # of the tension [Hz]
    # how far each side of it goes per amplitude, |Gamma_ij|/(4 pi sqrt(omega_i omega_j)), without
    # damping and to first order [Hz/N]; 0 of orders above 1, which widen more slowly
    spread: float

    @property
    def kind(self) -> str:
        """One of "principal", "sum" and "secondary"."""
        if self.order > 1:
            return "secondary"
        return "principal" if self.modes[0] == self.modes[1] else "sum"

    @property
    def label(self) -> str:
        """Such as "2 f1", "f1 + f2" or "(f1 + f2)/2"."""
        i, j = self.modes
        share = "" if self.order == 1 else f"/{self.order}"
        if i != j:
            return f"(f{i} + f{j}){share}" if share else f"f{i} + f{j}"
        if self.order % 2:
            return f"2 f{i}{share}"
        return f"f{i}" if self.order == 2 else f"f{i}/{self.order // 2}"


def tongues_of(system: ModalSystem, low: float, high: float) -> tuple[Tongue, ...]:
    """Return the tongues between two frequencies [Hz], lowest first."""
    # those of order 1 need the coupling of their modes, those of others some coupling
    found = []
    pairs = (p for block in system.blocks for p in combinations_with_replacement(block.tolist(), 2))
    for i, j in pairs:
        if system.eigenvalue[i] <= 0:
            continue
        together = float(system.omega[i] + system.omega[j]) / (2 * math.pi)
        mean = math.sqrt(system.omega[i] * system.omega[j])
        spread = float(abs(system.geometric[i, j])) / (4 * math.pi * mean)
        orders = range(1 if spread else 2, HIGHEST_ORDER + 1)
        found += [
            Tongue((i + 1, j + 1), order, together / order, spread if order == 1 else 0.0)
            for order in orders
            if low <= together / order <= high
        ]
    return tuple(sorted(found, key=lambda one: (one.frequency, one.order)))


def threshold(system: ModalSystem, frequency: Real) -> Real:
    """Return the growth ln|multiplier| over a period that counts as growth, as frequency [Hz]."""
    # where all motion decays by itself, multipliers do not meet on the circle, and any is growth
    decay = -np.linalg.eigvals(rates(system)).real.max() / frequency
    return np.where(decay > NEUTRAL, 0.0, NEUTRAL)


def boundaries(system: ModalSystem, frequency: Real, amplitude: float) -> Real:
    """Return the frequencies where stability changes at an amplitude."""
    still = ModalSystem(system.eigenvalue, system.geometric, np.zeros_like(system.damping))
    looked = np.union1d(frequency, _near_resonances(still, frequency, amplitude))
    if system.damping.any():
        edge, grows = _changes(still, looked, amplitude, close=ROUGH)
        if len(edge):
            begin = np.append([] if grows[0] else frequency[0], edge[grows])
            end = np.append(edge[~grows], frequency[-1] if grows[-1] else [])
            closer = _within(system, begin, end, amplitude)
            looked = np.union1d(frequency, np.clip(closer, frequency[0], frequency[-1]))
    return _changes(system, looked, amplitude)[0]


def _changes(
    system: ModalSystem, looked: Real, amplitude: float, close: float = CLOSE
) -> tuple[Real, Flags]:
    """Return where stability changes between given frequencies; whether motion grows beyond."""
    # where what grows is of another kind there may be a gap between two tongues
    kind = _growing(system, looked, amplitude)
    while True:
        apart = np.diff(looked) > close * looked[1:]
        at = np.flatnonzero(apart & (kind[1:] != kind[:-1]))
        if len(at) == 0:
            break
        more = np.linspace(looked[at], looked[at + 1], SECTIONS + 1, axis=1)[:, 1:-1].ravel()
        every = np.concatenate([looked, more])
        looked, first = np.unique(every, return_index=True)
        kind = np.concatenate([kind, _growing(system, more, amplitude)])[first]
    grows = kind != 0
    at = np.flatnonzero(grows[1:] != grows[:-1])
    return (looked[at] + looked[at + 1]) / 2, grows[at + 1]


def _growing(system: ModalSystem, frequency: Real, amplitude: float) -> Index:
    """Return a number for what grows, 0 for nothing."""
    # counts multipliers beyond 1, beyond -1, and outside the unit circle elsewhere
    kind = np.zeros(len(frequency), dtype=np.intp)
    least = np.exp(threshold(system, frequency))
    base = 2 * len(system.eigenvalue) + 1
    given = np.full((len(frequency), 1), amplitude)
    for modes in system.blocks:
        for these, matrix in periods(system.only(modes), frequency, given, ANGLE):
            value = np.linalg.eigvals(matrix[:, 0])
            outside = np.abs(value) > least[these, None]
            turning = np.abs(value.imag) > NEUTRAL * np.abs(value)
            for power, which in enumerate((~turning & (value.real > 0), ~turning, turning)):
                kind[these] += base**power * (outside & which).sum(axis=1)
    return kind


def _within(system: ModalSystem, begin: Real, end: Real, amplitude: float) -> Real:
    """Return frequencies where damped motion grows, as far as it does, and beside them."""
    # they lie in the tongues without damping, or not far from them where modes are damped unlike;
    # at the tip of a tongue, close to where growth is largest.
    middle, half = (begin + end) / 2, (end - begin) / 2
    looked = []
    for _ in range(ZOOMS):
        point = middle[:, None] + half[:, None] * np.linspace(-2.0, 2.0, 2 * PARTS + 1)
        looked.append(point.ravel())
        growth = exponent(system, looked[-1], np.full((point.size, 1), amplitude))
        largest = growth.reshape(point.shape).argmax(axis=1)
        middle, half = point[np.arange(len(point)), largest], half / PARTS * 2
    return np.concatenate(looked)


def _near_resonances(system: ModalSystem, frequency: Real, amplitude: float) -> Real:
    """Return frequencies in each undamped tongue, as far as it is wide enough, and beside."""
    # tongues of order n are some e^n of their frequency wide, with e the relative pulsation of the
    # stiffness, and move by e^2.
    low, high = float(frequency[0]), float(frequency[-1])
    size = np.sqrt(np.abs(np.diag(system.geometric)))
    points = [np.zeros(0)]
    for number in system.blocks:
        pairs, windows = [], []
        for tongue in tongues_of(system, low / 2, 2 * high):
            i, j = (one - 1 for one in tongue.modes)
            e = amplitude * size[i] * size[j] / (system.omega[i] * system.omega[j])
            if i in number and e**tongue.order > LEAST:
                reach = 2 * (amplitude * tongue.spread + e**2 * tongue.frequency)
                pairs.append(np.searchsorted(number, (i, j)))
                windows.append((tongue.frequency - reach, tongue.frequency + reach))
        if pairs:
            window = np.clip(windows, low, high)
            points.append(_closing_in(system.only(number), np.array(pairs), window, amplitude))
    return np.concatenate(points)


def _closing_in(system: ModalSystem, pair: Index, window: Real, amplitude: float) -> Real:
    """Return the frequencies that a search for growth of pairs of modes in windows looked at."""
    # the phases by which two modes turn in a period add up to whole turns at a resonance: the sign
    # of what is left is not lost where a tongue is narrow.
    looked = [np.zeros(0)]
    while len(pair):
        edge = np.linspace(window[:, 0], window[:, 1], PARTS + 1, axis=1)
        looked.append(edge.ravel())
        turn, grows = _turns(system, np.repeat(pair, PARTS + 1, axis=0), edge.ravel(), amplitude)
        turn, grows = turn.reshape(edge.shape), grows.reshape(edge.shape)
        passes = (turn[:, 1:] * turn[:, :-1] < 0) & (np.abs(np.diff(turn)) < np.pi)
        wide = np.diff(edge) > NEUTRAL / PARTS * edge[:, 1:]
        which, at = np.nonzero(passes & wide & ~grows[:, 1:] & ~grows[:, :-1])
        pair, window = pair[which], np.stack([edge[which, at], edge[which, at + 1]], axis=1)
    return np.concatenate(looked)


def _turns(
    system: ModalSystem, pair: Index, frequency: Real, amplitude: float
) -> tuple[Real, Flags]:
    """Return by how much pairs of modes turn in a period beside whole turns [rad]; if they grow."""
    # of each conjugate pair of motions one goes round as a mode without pulsation does: its q' is
    # ahead of q.
    turn, grows = np.empty(len(frequency)), np.empty(len(frequency), dtype=np.bool_)
    k = len(system.eigenvalue)
    given = np.full((len(frequency), 1), amplitude)
    for these, matrix in periods(system, frequency, given, ANGLE):
        value, vector = np.linalg.eig(matrix[:, 0])
        q, v = vector[:, :k], vector[:, k:]
        part = np.abs(q) ** 2 + np.abs(v) ** 2
        forward = (q.conj() * v / scales(system)[:, None]).imag.sum(axis=1) > 0
        rows = np.arange(len(these))
        both = part[rows[:, None], pair[these]]
        which = np.where(forward[:, None], both, 0.0).argmax(axis=2)
        angle = np.angle(value[rows[:, None], which]).sum(axis=1)
        turn[these] = np.angle(np.exp(1j * angle))
        own = (both > PART).all(axis=1) & (np.abs(value) > 1 + NEUTRAL)
        grows[these] = own.any(axis=1)
    return turn, grows
