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
BATCH = 1 << 15  # Numbers of matrices that are solved together.
AHEAD = 1e-5  # Forces are looked at so much farther along a branch, in its steps.
BENDS = 2.0  # Near a fold a frequency that is off by df moves along it by sqrt(BENDS df/SCALE f).
TIMES = 4.0  # Steps of branches are off by so much more: where they are steep, all of it is seen.
FALLS = 4.0  # Twice as many harmonics change a motion by so much less at most, as far as is known.
CORNER = 1e-6  # Forces without corners have less than this part of them in the last harmonics.
LEFT = 2.0  # They are off by so many times what the last ones change.
TWICE = 2  # What others change by chance by nothing is told by so many changes.
ALIKE = 0.1  # More harmonics that move a motion by more may have found another one.


class SteadyState(NamedTuple):
    """A steady state."""

    balance: HarmonicBalance
    place: Place  # over the base frequency
    kind: str = "asked"  # an "asked" frequency, a "step" of a branch or a "fold" of it
    push: Complex = np.zeros(0, dtype=np.complex128)
    """The forces of points at the frequency of the drive, per amplitude, (points,)."""
    change: Complex = np.zeros(0, dtype=np.complex128)
    """Of them, by the last harmonics, at the same frequency."""
    across: Complex = np.zeros(0, dtype=np.complex128)
    """Of them, across the branch."""
    turns: bool = False  # whether it is near a fold, where frequencies tell little
    moved: float = 0.0  # how far they moved a step or fold [Hz]
    doubled: int = 0  # how often there were twice as many
    is_sure: bool = True  # whether what the last ones changed tells how far it is off

    @property
    def frequency(self) -> float:
        """Of the drive [Hz]."""
        return self.place.p * self.balance.turn / (2 * np.pi)


def by_frequency(driven: Driven, balance: HarmonicBalance) -> Branch:
    """Return a branch over the base frequency, that nowhere begins yet."""

    def linearise(x: Real, omega: Real | float) -> tuple[Real, Real, Real]:
        about, _ = balance.at(x, omega)
        return about.gap, about.jacobian, about.slope

    def called(omega: float) -> str:
        return f"{omega * balance.turn / (2 * np.pi):.6g} Hz"

    omega = 2 * np.pi * float(driven.asked.frequency.mean()) / balance.turn
    nowhere = Place(np.zeros(0), omega, np.zeros(0), 0.0)
    return Branch(linearise, nowhere, SCALE * omega, SMALL * driven.size, called)


def settled(driven: Driven, states: list[SteadyState]) -> list[SteadyState] | None:
    """Add harmonics until they change nothing; None where they lead to another motion.

    States have as many harmonics at first.
    """
    tolerance, balance = driven.asked.tolerance or TOLERANCE, states[0].balance
    exact = _exact(by_frequency(driven, balance), states, [one.place for one in states])
    if exact is None:
        return None
    states = [one._replace(place=place) for one, place in zip(states, exact)]
    force = _forces(states)
    unmoved = np.zeros(balance.points, dtype=np.complex128)
    found = [
        one._replace(push=push, change=unmoved, across=unmoved)
        for one, push in zip(states, _per_amplitude(balance, force))
    ]
    rough = np.flatnonzero(force.any(axis=(1, 2)))
    left = np.full(len(rough), np.inf)
    while len(rough):
        if 2 * balance.harmonics > MOST * balance.turn:
            # of a step nobody asked for, its error across the branch is said
            each = (found[k] for k in rough)
            lost = [s if s.kind == "asked" else s._replace(change=s.across) for s in each]
            left = _felt(driven, lost) if np.isfinite(left).all() else left
            if (left > tolerance).any():
                raise SolveError(
                    f"frequency {lost[int(left.argmax())].frequency:.9g} Hz: with "
                    f"{balance.harmonics} harmonics the amplitude is still known to "
                    f"{left.max():.1e} only: ask for a larger tolerance"
                )
            break
        balance = driven.balance(2 * balance.harmonics // balance.turn, balance.turn)
        finer = _finer(driven, balance, [found[k] for k in rough])
        if finer is None:
            return None
        for k, one in zip(rough.tolist(), finer):
            found[k] = one
        left = _felt(driven, finer)
        on = (left > tolerance) | ~np.array([one.is_sure for one in finer])
        rough, left = rough[on], left[on]
    return found


def _finer(
    driven: Driven, balance: HarmonicBalance, states: list[SteadyState]
) -> list[SteadyState] | None:
    """Return states with more harmonics, None where they lead to another motion."""
    narrow, branch = states[0].balance, by_frequency(driven, balance)
    near = [_wider(narrow, one.place, balance.harmonics) for one in states]
    places = _exact(branch, states, near)
    if places is None:
        return None
    for k, one in enumerate(states):
        if one.kind != "asked":
            # across the branch: its place may move along it
            reached = branch.reached(places[k], 0.0)
            place = reached[0] if reached is not None else None
            if place is not None and one.kind == "fold":
                place = branch.fold_near(place)
            if place is None:
                return None
            places[k] = place
    finer = [one._replace(balance=balance, place=place) for one, place in zip(states, places)]
    force, slopes = _forces(finer), _slopes(balance, finer)
    found = []
    for one, before, harmonics, slope in zip(finer, states, force, slopes):
        push, is_smooth = _per_amplitude(balance, harmonics), _is_smooth(harmonics)
        start = narrow.wider(before.place.x, balance.harmonics)
        if np.linalg.norm(one.place.x - start) > ALIKE * np.linalg.norm(start):
            return None
        off = one.place.p - before.place.p
        # along the branch by so much, back to the frequency that it had
        most = np.sqrt(BENDS * abs(off) / branch.scale)
        back = off / one.place.up if one.kind == "step" and off else 0.0
        across, moved = push - before.push, abs(off) / (2 * np.pi)
        change = across - slope * float(np.clip(back, -most, most))
        if one.kind != "asked":
            change, moved = TIMES * change, max(TIMES * moved, before.moved / FALLS)
        # forces with corners fall by chance
        if one.kind == "step":
            change = _by_chance(change, before.change)
        elif one.kind == "asked" and not is_smooth:
            change = LEFT * _by_chance(change, before.across)
        own = one._replace(push=push, change=change, across=across, moved=moved)
        own = own._replace(doubled=before.doubled + 1, turns=bool(abs(back) > most))
        found.append(own._replace(is_sure=is_smooth or own.doubled >= TWICE))
    return found


def _by_chance(change: Complex, before: Complex) -> Complex:
    """Return changes, or where they are less by chance what they are at most as far as is known."""
    return np.where(np.abs(before) > FALLS * np.abs(change), before / FALLS, change)


def _is_smooth(force: Complex) -> bool:
    """Whether the last harmonics of forces, (points, K + 1), are next to nothing."""
    size = np.abs(force)
    return bool((size[:, -(size.shape[1] // 4) :] <= CORNER * size.max()).all())


def _wider(narrow: HarmonicBalance, place: Place, harmonics: int) -> Place:
    """Return a place with more harmonics, the new ones 0."""
    x, along = (narrow.wider(one, harmonics) for one in (place.x, place.along))
    return place._replace(x=x, along=along)


def _slopes(balance: HarmonicBalance, states: list[SteadyState]) -> Complex:
    """Return how the forces of steps change along the branch, as they are per amplitude."""
    slopes = np.zeros((len(states), balance.points), dtype=np.complex128)
    steps = [k for k, one in enumerate(states) if one.kind == "step"]
    if not steps:
        return slopes
    x, p, along, up = (np.array(one) for one in zip(*(states[k].place for k in steps)))
    here, there = (
        _per_amplitude(balance, balance.forces(x + d * along, p + d * up)) for d in (0.0, AHEAD)
    )
    slopes[steps] = (there - here) / AHEAD
    return slopes


def _exact(branch: Branch, states: list[SteadyState], near: list[Place]) -> list[Place] | None:
    """Return places, exact at frequencies that are asked; None where one of these is not found."""
    places = near.copy()
    asked = [k for k, one in enumerate(states) if one.kind == "asked"]
    most = max(1, BATCH // len(near[0].x) ** 2)
    for these in (asked[k : k + most] for k in range(0, len(asked), most)):
        each = [near[k] for k in these]
        x, is_found = branch.settled(np.array([one.x for one in each]), _rates(each))
        if not is_found.all():
            return None
        for k, one in zip(these, x):
            places[k] = near[k]._replace(x=one)
    return places


def _rates(places: list[Place]) -> Real:
    return np.array([one.p for one in places])


def _forces(states: list[SteadyState]) -> Complex:
    """Return the harmonics of the forces, (states, points, K + 1)."""
    places = [one.place for one in states]
    return states[0].balance.forces(np.array([one.x for one in places]), _rates(places))


def _per_amplitude(balance: HarmonicBalance, force: Complex) -> Complex:
    return np.asarray(force[..., balance.turn] / (balance.amplitude / 2))


def _felt(driven: Driven, states: list[SteadyState]) -> Real:
    """Return what the last harmonics moved the points by, relative to the largest motion."""
    omega = 2 * np.pi * np.array([one.frequency for one in states])
    H = driven.transfer.at(omega)[:, : len(driven.points)]
    push, change = (np.array([getattr(one, name) for one in states]) for name in ("push", "change"))
    for k, one in enumerate(states):
        if one.turns:  # `fold_error` tells how far its frequency is off
            change[k] = one.across
    motion = np.einsum("fip,fp->fi", H[..., :-1], push) + H[..., -1]
    moved = np.einsum("fip,fp->fi", np.abs(H[..., :-1]), np.abs(change))
    return np.asarray(moved.max(axis=1) / np.abs(motion).max(axis=1))
