"""Where instability begins in the plane of frequency and amplitude of the tension."""

from __future__ import annotations

import math
from itertools import combinations_with_replacement
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .modal_system import ModalSystem
from .monodromy import exponent, rates

Real = NDArray[np.float64]

HIGHEST_ORDER = 4
"""Of resonances that are looked for."""

FINE = 0.6
"""Of the highest mode in a step [rad]."""

NEUTRAL = 1e-6
"""Growth ln|multiplier| over a period that is seen where undamped motion keeps its size: two
multipliers that meet on the unit circle are the root of 1e-16 off it by rounding."""

DECAYING = 1e-10
"""The same where motion decays by itself, and multipliers do not meet on the circle."""

POINTS = 40
"""To either side of a resonance that are looked at."""

PARTS = 8
"""Of a bracket that are looked at together."""

CLOSE = 1e-11
"""Relative width of the last bracket."""


class Tongue(NamedTuple):
    """A region of instability, by where it begins at no amplitude.

    Attributes
    ----------
    modes : tuple of int
        Two numbers of modes, from 1; the same twice where one alone grows.
    order : int
        n of n f = f_i + f_j.
    frequency : float
        Of the tension [Hz].
    """

    modes: tuple[int, int]
    order: int
    frequency: float

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
        if self.order == 1:
            return f"2 f{i}" if i == j else f"f{i} + f{j}"
        if i == j:
            return f"f{i}" if self.order == 2 else f"2 f{i}/{self.order}"
        return f"(f{i} + f{j})/{self.order}"


def tongues_of(system: ModalSystem, low: float, high: float) -> tuple[Tongue, ...]:
    """Return the tongues between two frequencies [Hz], lowest first.

    Those of order 1 need the coupling of their modes, those of others some coupling.
    """
    found = []
    for block in system.blocks:
        for i, j in combinations_with_replacement(block.tolist(), 2):
            if system.eigenvalue[i] <= 0:
                continue
            together = float(system.omega[i] + system.omega[j]) / (2 * math.pi)
            for order in range(1, HIGHEST_ORDER + 1):
                coupled = order > 1 or system.geometric[i, j] != 0
                if coupled and low <= together / order <= high:
                    found.append(Tongue((i + 1, j + 1), order, together / order))
    return tuple(sorted(found, key=lambda one: one.frequency))


def threshold(system: ModalSystem, frequency: Real) -> Real:
    """Return the growth ln|multiplier| over a period that counts as growth, as frequency [Hz]."""
    decay = -np.linalg.eigvals(rates(system)).real.max() / frequency
    return np.where(decay > NEUTRAL, DECAYING, NEUTRAL)


def boundaries(system: ModalSystem, frequency: Real, amplitude: float) -> Real:
    """Return the frequencies where stability changes at an amplitude.

    Parameters
    ----------
    system : ModalSystem
        What moves.
    frequency : ndarray, shape (f,)
        That are looked at, beside those near resonances between them [Hz].
    amplitude : float
        [N].

    Returns
    -------
    ndarray
        [Hz], increasing.
    """
    looked = _looked_at(system, frequency, amplitude)
    grows = _grows(system, looked, amplitude)
    at = np.flatnonzero(grows[1:] != grows[:-1])
    low, high, rising = looked[at], looked[at + 1], grows[at + 1]
    share = np.arange(1, PARTS) / PARTS
    while len(at) and (high - low > CLOSE * high).any():
        inside = low[:, None] + (high - low)[:, None] * share
        known = _grows(system, inside.ravel(), amplitude).reshape(inside.shape)
        edge = np.column_stack([low, inside, high])
        # the first part with a change: as many as the same as its left end
        first = (known == rising[:, None]).argmax(axis=1)
        first = np.where((known == rising[:, None]).any(axis=1), first, PARTS - 1)
        rows = np.arange(len(at))
        low, high = edge[rows, first], edge[rows, first + 1]
    return np.asarray((low + high) / 2)


def _grows(system: ModalSystem, frequency: Real, amplitude: float) -> NDArray[np.bool_]:
    growth = exponent(system, frequency, np.full((len(frequency), 1), amplitude), angle=FINE)
    return np.asarray(growth[:, 0] > threshold(system, frequency))


def _looked_at(system: ModalSystem, frequency: Real, amplitude: float) -> Real:
    """Return frequencies close enough for every tongue of first and second order.

    A tongue of order 1 is 2 delta = amplitude |Gamma_ij|/sqrt(omega_i omega_j) wide, and moves by
    what is of second order in the amplitude; those of higher orders are so wide at most.
    """
    low, high = float(frequency.min()), float(frequency.max())
    omega, coupling = system.omega, np.abs(system.geometric)
    share = np.linspace(-1.0, 1.0, 2 * POINTS + 1)
    points = [frequency]
    for tongue in tongues_of(system, low / 2, 2 * high):
        i, j = (one - 1 for one in tongue.modes)
        mean = omega[i] * omega[j]
        relative = amplitude * max(coupling[[i, j]].max(axis=0) / mean)
        second = relative**2 * tongue.frequency
        if tongue.order == 1:
            first = amplitude * coupling[i, j] / math.sqrt(mean) / (4 * math.pi)
            points.append(tongue.frequency + 1.5 * first * share)
            second += 2 * first
        points.append(tongue.frequency + 2 * second * share)
    every = np.unique(np.concatenate(points))
    return every[(every >= low) & (every <= high)]
