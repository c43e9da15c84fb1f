"""A steady state, with as many harmonics as it needs."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.array import Complex, Real
from ...base.errors import SolveError
from .balance import HarmonicBalance
from .continuation import Branch, Place
from .driven import Driven

HARMONICS, MOST = 8, 256  # Of the drive, that branches are followed with and answered, at most.
TOLERANCE = 1e-5  # Of the steady state where none is given.
SCALE = 0.05  # Of a frequency: steps of a branch are measured in it.
SMALL = 1e-6  # Motion below this part of that of the linear scene is as good as none.
ALIKE = 0.1  # More harmonics that move a motion by more may have found another one.


class SteadyState(NamedTuple):
    """A steady state."""

    balance: HarmonicBalance
    place: Place  # over the base frequency
    kind: str = "asked"  # an "asked" frequency, a "step" of a branch or a "fold" of it
    change: Complex = np.zeros(
        0, dtype=np.complex128
    )  # of the forces of points, by the last harmonics
    moved: float = 0.0  # how far they moved a step or fold [Hz]

    @property
    def frequency(self) -> float:
        """Of the drive [Hz]."""
        return self.place.p * self.balance.turn / (2 * np.pi)

    @property
    def push(self) -> Complex:
        """The forces of points at the frequency of the drive, per amplitude, (points,)."""
        force = self.balance.forces(self.place.x, self.place.p)[:, self.balance.turn]
        return np.asarray(force / (self.balance.amplitude / 2))


def by_frequency(driven: Driven, balance: HarmonicBalance) -> Branch:
    """Return a branch over the base frequency, that nowhere begins yet."""

    def linearise(x: Real, omega: float) -> tuple[Real, Real, Real]:
        about, _ = balance.at(x, omega)
        return about.gap, about.jacobian, about.slope

    omega = 2 * np.pi * float(driven.asked.frequency.mean()) / balance.turn
    nowhere = Place(np.zeros(0), omega, np.zeros(0), 0.0)
    return Branch(linearise, nowhere, SCALE * omega, SMALL * driven.size)


def settled(driven: Driven, state: SteadyState, least: int = 0) -> SteadyState | None:
    """Add harmonics until they change nothing; None where they lead to another motion.

    `least`: so many of the drive are known not to be enough.
    """
    tolerance, balance = driven.asked.tolerance or TOLERANCE, state.balance
    if not balance.forces(state.place.x, state.place.p).any():
        return state._replace(change=np.zeros(balance.points, dtype=np.complex128))
    if least * balance.turn > balance.harmonics:
        finer = _finer(driven, state, least)
        if finer is None:
            return None
        state, balance = finer, finer.balance
    while 2 * balance.harmonics <= MOST * balance.turn:
        finer = _finer(driven, state, 2 * balance.harmonics // balance.turn)
        if finer is None:
            return None
        left = np.abs(_felt(driven, finer)).max()
        if left <= tolerance:
            return finer
        state, balance = finer, finer.balance
    raise SolveError(
        f"frequency {state.frequency:.9g} Hz: with {balance.harmonics} harmonics the amplitude is "
        f"still known to {left:.1e} only: ask for a larger tolerance"
    )


def _finer(driven: Driven, state: SteadyState, harmonics: int) -> SteadyState | None:
    """Return a state with more harmonics, None where they lead to another motion."""
    narrow, place = state.balance, state.place
    balance = driven.balance(harmonics, narrow.turn)
    branch = by_frequency(driven, balance)
    start = narrow.wider(place.x, balance.harmonics)
    if state.kind == "asked":
        x = branch.settle(start, place.p)
        found = None if x is None else place._replace(x=x)
    else:
        # across the branch: its place may move along it
        along = narrow.wider(place.along, balance.harmonics)
        reached = branch.reached(Place(start, place.p, along, place.up), 0.0)
        found = None if reached is None else reached[0]
    if found is None or np.linalg.norm(found.x - start) > ALIKE * np.linalg.norm(start):
        return None
    wide = SteadyState(balance, found, state.kind, moved=abs(found.p - place.p) / (2 * np.pi))
    return wide._replace(change=wide.push - state.push)


def _felt(driven: Driven, state: SteadyState) -> Complex:
    """Return what the last harmonics moved the points by, relative to the largest motion."""
    omega = state.place.p * state.balance.turn
    H = driven.transfer.at(np.array([omega]))[0, : len(driven.points)]
    motion = H[:, :-1] @ state.push + H[:, -1]
    return np.asarray(H[:, :-1] @ state.change / np.abs(motion).max())
