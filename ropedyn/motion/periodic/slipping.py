"""Steady states with friction that slips: exact phases until nothing changes, or steps."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ...base.answer import Cost
from ...base.array import Complex, Real
from ...base.errors import SolveError
from ...chain.port import Point, moving
from ...eigen.damped.residue import spread
from ...response.frf import FRF
from ...scene.force import Sine
from ...signal.spectrum import amplitudes
from ..coupled.steps import Stepper
from ..coupled.system import CoupledSystem, moving_together
from ..moved import of_kinds
from ..phases.components import Look, Moving, moving_components, rest, why_not_events
from ..phases.pieces import pieces
from ..phases.walk import PhaseWalk, Visit
from ..request import Run
from ..smooth.system import OutputTimes
from .asked import SteppedSine

WINDOW = 8  # The amplitude is looked at after so many periods at least.
LOOKS = 4  # So many looks in a row must agree, and as many once more: what is slow shows late.
LONGEST = 100_000  # A motion that changes after so many periods is said not to settle.
DECAY = 4.0  # After so many time constants the changes are compared with those before,
LEAST = 256  # and not before so many periods;
UNDAMPED = 4096  # after so many where nothing but friction damps.
DISTURBED = 1e-6  # Of the motion, how it is disturbed once: it must come back.
ALIKE = 1e-4  # Periods that differ by less than this part of what is asked differ by rounding.
FURTHER = 8.0  # What is told for longer than was seen counts so many times.
AS_BEFORE = 0.9  # Changes that are not below so much of those before do not decay.
TOLERANCE = 1e-3  # Of the steady state where none is given.
SAMPLES = 1024  # Of a period, in exact phases: what slips has harmonics that fall as 1/k^3.
MODES = 64  # Of continuous spans; half of them tell the error.
COUNTS = 128, 282, 620, 1364, 3000, 6600, 14520, 31944  # Steps of a period, in two runs: ends of
FINER = 2.2  # steps attract turns, and are half a step further in the second.
ROUNDING = 1e-12  # Of what responses are added up of: modes are known to so much.


class MeanAmplitudes(NamedTuple):
    """Mean amplitudes over some periods."""

    watched: Complex  # (mine,)
    modes: Complex  # (k, periods) all of the motion in each of them
    parts: Real  # (mine,) magnitudes that are added up to what is watched
    folded: Real | float = 0.0  # (mine,) what harmonics beyond the samples may be in it


class Settled(NamedTuple):
    """Where a motion stays."""

    value: Complex  # (responses,)
    error: Real  # (responses,)
    repeats: bool  # whether after one period, or turn


def slipping(asked: SteppedSine, turn: Callable[[float], int]) -> FRF:
    """Follow the motion through the frequencies in their order, see `Model.stepped_sine`.

    `turn` says after how many periods of a frequency everything that acts begins anew.
    """
    run = Run(asked.model, np.array([0.0, 1.0]), (asked.drive,), (), asked.responses)
    push = Sine(asked.amplitude, float(asked.frequency[0]), phase=math.pi / 2)
    exact = not why_not_events(run)
    found: Iterator[Settled]
    found = _by_phases(asked, run, push) if exact else _by_steps(asked, run, push, turn)
    value = np.zeros((len(asked.responses), len(asked.frequency)), dtype=np.complex128)
    error = np.zeros(value.shape)
    stable = np.zeros(len(asked.frequency), dtype=np.bool_)
    for k, one in enumerate(found):
        size = np.abs(one.value)
        value[:, k], stable[k] = one.value / asked.amplitude, one.repeats
        error[:, k] = np.divide(one.error, size, out=np.zeros_like(size), where=size > 0)
        asked.progress((k + 1) / len(asked.frequency))
    cost = Cost("events" if exact else "steps", len(asked.model.x) - 1, asked.model.size)
    return asked.answer(asked.frequency, value, error, cost, stable)


# --- exact phases ---------------------------------------------------------------------------------


class PhasesGoOn:
    """One component from event to event."""

    def __init__(self, one: Moving, push: Sine, points: Sequence[Point]) -> None:
        # sigma: how modes decay where nothing holds; mine: which of the responses it has
        self.one, self.push, self.sigma = one, push, one.system.states.sigma
        ((self.rows, self.mine),) = one.watched
        held, before = one.system.laws.frictions, len(one.system.laws.contacts)
        self.grip = {
            row: before + k
            for row, mine in enumerate(self.mine)
            for k, friction in enumerate(held)
            if friction.point == points[mine]
        }
        alike = [[law[0] == points[k][0] for law in one.system.laws.points] for k in self.mine]
        self.alike = np.array(alike).reshape(len(self.mine), -1)
        self.walk: PhaseWalk | None = None
        self.now = rest(one, 0.0)
        self.mode: tuple[int, ...] | None = None

    def disturb(self, speed: Real) -> None:
        """Let the modes move faster by these, (k,)."""
        self.now = self.now._replace(v=self.now.v + speed)

    def _over(self, span: float) -> PhaseWalk:
        """Return the walk over such a time, of which what is slow and what is at once are parts."""
        if self.walk is None or self.walk.system.span != span:
            self.walk = PhaseWalk(dataclasses.replace(self.one.system, span=span))
        return self.walk

    def window(self, frequency: float, periods: range) -> MeanAmplitudes:
        """Follow some periods."""
        number, own = SAMPLES * len(periods), len(self.mine)
        time = np.arange(number + 1) / (SAMPLES * frequency)
        force = [Sine(self.push.amplitude, frequency, phase=self.push.phase)]
        states = self.one.system.states
        value = np.zeros((own + states.modes, number))
        slips = set[int]()
        last: Visit | None = None
        for visit in self._over(float(time[-1])).visits(self.now, pieces(force, time), self.mode):
            i, j = np.searchsorted(time[:-1], [visit.start, visit.stop])
            course = visit.outputs.some(self.rows).beside(
                visit.state().some(slice(0, states.modes))
            )
            value[:, i:j] = course.at(time[i:j] - visit.start)
            slips |= {row for row, k in self.grip.items() if visit.phase.mode[k]}
            last = visit
        assert last is not None
        self.now, self.mode = last.end(), last.phase.mode
        each = amplitudes(value, SAMPLES)
        found = each.mean(axis=1)
        parts = np.abs(states.seen) @ np.abs(found[own:])
        parts += np.abs(states.now + states.late)[:, 0] * self.push.amplitude
        # what symmetry leaves still is rounded beside what moves
        beside = np.where(self.alike, parts[self.one.system.responses :], 0.0)
        beside = beside.max(axis=1, initial=0.0)
        parts = np.maximum(parts[self.rows], beside)
        # where friction holds all the time nothing moves
        found[list(self.grip.keys() - slips)] = 0.0
        # where forces jump harmonics fall as 1/k
        folded = np.abs(found - amplitudes(value[:, ::2], SAMPLES // 2).mean(axis=1))[:own]
        return MeanAmplitudes(found[:own], each[own:], parts, folded)


def _by_phases(asked: SteppedSine, run: Run, push: Sine) -> Iterator[Settled]:
    """Yield where the motion of one frequency after another stays."""

    def of(modes: int) -> list[PhasesGoOn]:
        given = Run(run.model, run.time, run.drives, (push,), run.responses)
        look = Look(run.responses, run.time, 0)
        found = moving_components(given, [look], modes)
        return [PhasesGoOn(one, push, run.responses) for one in found]

    rows = of(MODES)
    fewer = None if all(each.one.is_whole for each in rows) else of(MODES // 2)
    for f in asked.frequency.tolist():
        found = _settled(asked, rows, f, 1)
        if fewer is not None:
            apart = np.abs(_settled(asked, fewer, f, 1).value - found.value)
            found = found._replace(error=found.error + 2 * apart)
        yield found


# --- steps ----------------------------------------------------------------------------------------


class StepsGoOn:
    """One component in steps of all its modes."""

    def __init__(self, system: CoupledSystem, mine: list[int], push: Sine) -> None:
        self.system, self.mine, self.push = system, mine, push
        self.sigma = system.modes.sigma
        self.state = np.zeros((2, len(system.modes.sigma)))  # all of the motion
        self.count = COUNTS[0]  # steps of a period,
        self.late = 0.0  # which begins so much of one later

    def disturb(self, speed: Real) -> None:
        """Let the modes move faster by these, (k,)."""
        self.state[1] += speed

    def window(self, frequency: float, periods: range) -> MeanAmplitudes:
        """Follow some periods."""
        modes, omega, count = self.system.modes, 2 * np.pi * frequency, self.count
        h = 1 / (frequency * count)
        begin = periods[0] / frequency + self.late * h
        turn = np.exp(2j * np.pi / count * (self.late + np.arange(count * len(periods) + 1)))
        still = modes.square - omega**2 + 2j * omega * modes.sigma
        own = self.push.amplitude * self.system.push.sum(axis=0) / still
        known, rate = (own * turn[:, None]).real, (1j * omega * own * turn[:, None]).real
        first = np.stack([known[0], rate[0]])
        stepper = Stepper(self.system, self.state - first)
        found = stepper.take(begin, h, known)
        if found.error is not None:
            raise SolveError(f"frequency {frequency!r} Hz: a step does not converge")
        self.state = stepper.state + first
        Q, V = found.state[:-1].transpose(1, 2, 0) + np.stack([known, rate])[:, :-1].transpose(
            0, 2, 1
        )
        of = slice(len(modes.sigma), None)
        seen = modes.seen[of] @ Q + modes.swept[of] @ V
        time = np.asarray(begin + h * np.arange(len(turn) - 1.0))
        seen += self.system.pull(time, Q)
        each = amplitudes(np.concatenate([seen, Q]), count) / turn[0]
        found, own = each.mean(axis=1), len(self.mine)
        parts = np.abs(modes.seen[of]) @ np.abs(found[own:])
        return MeanAmplitudes(found[:own], each[own:], parts)


def _by_steps(
    asked: SteppedSine, run: Run, push: Sine, turn: Callable[[float], int]
) -> Iterator[Settled]:
    """Yield where the motion of one frequency after another stays."""
    given = Run(run.model, run.time, run.drives, (push,), run.responses)
    rows = []
    for component in moving_together(asked.model):
        mine = [k for k, point in enumerate(asked.responses) if moving(point) in component]
        points = [asked.responses[k] for k in mine]
        look = OutputTimes(slice(0, len(points)), run.time, 0)
        system = CoupledSystem.coupled(given, component, points, [look])
        if len(system.push) or any(one.law.call for one in system.laws):
            rows.append(StepsGoOn(system, mine, push))
    for f in asked.frequency.tolist():
        yield _stepped(asked, rows, f, turn(f))


def _stepped(asked: SteppedSine, rows: Sequence[StepsGoOn], frequency: float, turn: int) -> Settled:
    """Follow the motion in shorter and shorter steps."""
    before: Complex | None = None
    apart = np.zeros(len(asked.responses))
    for count, late in zip(COUNTS, spread(len(COUNTS)).tolist()):
        both = []
        for later in (late, late + 0.5):
            for one in rows:
                one.count, one.late = count, later
            both.append(_settled(asked, rows, frequency, turn))
        value = (both[0].value + both[1].value) / 2
        most, error = np.abs(value).max(), np.maximum(both[0].error, both[1].error)
        apart = np.maximum(np.abs(both[0].value - value), apart / FINER)
        if before is not None:
            apart = np.maximum(apart, np.abs(value - before))
            if (2 * apart + error <= (asked.tolerance or TOLERANCE) * most).all():
                return Settled(value, 2 * apart + error, both[0].repeats and both[1].repeats)
        before = value
    raise SolveError(
        f"frequency {frequency!r} Hz: with {COUNTS[-1]} steps a period the amplitude is still "
        f"known to {float((apart / most).max()):.1e} only: ask for a larger tolerance"
    )


# --- until nothing changes ------------------------------------------------------------------------

Goes = PhasesGoOn | StepsGoOn
"""A component's motion that goes on from look to look."""


def _settled(asked: SteppedSine, rows: Sequence[Goes], frequency: float, turn: int) -> Settled:
    """Follow the motion until it stays."""
    periods, share, calm = math.ceil(WINDOW / turn) * turn, (asked.tolerance or TOLERANCE) / 2, 0
    decays = Decays(max(_longest(rows, frequency) // periods, 4))
    # changes of what is seen, of all motion and of how periods differ from their mean
    watched, moves, differs = changes = list[float](), list[float](), list[float]()
    of_each: list[Real] = []  # of the responses of its kind
    before: tuple[Complex, ...] = ()
    for k in range(max(LONGEST // periods, LOOKS + 1)):
        found = np.zeros(len(asked.responses), dtype=np.complex128)
        rounded, folded = np.zeros((2, len(found)))
        each = [one.window(frequency, range(k * periods, (k + 1) * periods)) for one in rows]
        for one, now in zip(rows, each):
            found[one.mine], rounded[one.mine] = now.watched, ROUNDING * now.parts
            folded[one.mine] = now.folded
        modes = np.concatenate([now.modes for now in each])
        motion = modes.mean(axis=1)
        unlike = modes.reshape(len(modes), -1, turn).mean(axis=2) - motion[:, None]
        if before:
            of_each.append(of_kinds(np.abs(found - before[0]), asked.responses))
        for past, was, now in zip(changes, before, (found, motion, unlike)):
            past.append(float(np.abs(now - was).max(initial=0.0)))
        before = found, motion, unlike
        if k == 0:  # what symmetry keeps at rest may grow too
            speed = DISTURBED * 2 * math.pi * frequency * np.abs(motion).max(initial=0.0)
            for one in rows:
                one.disturb(speed * np.random.default_rng(0).normal(size=len(one.sigma)))
        if not decays.go_on(moves):
            break
        if len(moves) < LOOKS:
            continue
        most = share * np.abs(motion).max()
        ahead, apart = _left(moves, ALIKE * most), np.abs(unlike).max(initial=0.0)
        # a mean may stay while every second period departs from the others
        if ahead > most or _left(differs, ALIKE * most) > most:
            continue
        # amplitudes may hang back for a while, as where friction just begins to slip
        goes = ahead / max(moves[-LOOKS:]) if ahead > 0 else 0.0
        asks, least = (of_kinds(of, asked.responses) for of in (share * np.abs(found), rounded))
        left = _seen_left(watched, max(ALIKE * asks.max(), least.max()), goes)
        is_calm = left <= max(asks.max(), least.max())
        calm += is_calm
        if is_calm and calm > LOOKS:
            # rotations may be far larger, in their unit, than displacements
            kinds = zip(np.transpose(of_each).tolist(), np.maximum(ALIKE * asks, least))
            own = [_seen_left(*kind, goes) for kind in kinds]
            error = np.maximum(np.minimum(own, left), rounded) + folded
            return Settled(found, np.where(found == 0, 0.0, error), bool(apart <= most))
    change = moves[-1] / np.abs(motion).max()
    raise SolveError(
        f"frequency {frequency!r} Hz has no steady state of its period: after "
        f"{(k + 1) * periods} periods the motion changes by {change:.1e} of itself in "
        f"{periods} periods"
    )


def _seen_left(changes: Sequence[float], least: float, goes: float) -> float:
    """Return what changes of what is seen add up to, or as much as all motion still does."""
    return max(_left(changes, least), goes * max(changes[-LOOKS:]))


def _longest(rows: Sequence[Goes], frequency: float) -> int:
    """Return the periods after which what is left of the beginning must have become less."""
    sigma = np.concatenate([one.sigma for one in rows])
    sigma = sigma[sigma > 0]
    least = max(LEAST, DECAY * frequency / sigma.min()) if len(sigma) else UNDAMPED
    return int(min(least, LONGEST))


class Decays:
    """Whether motion changes less and less: at `next` looks, and whenever they have doubled."""

    def __init__(self, first: int) -> None:
        self.next, self.as_before = first, False

    def go_on(self, changes: Sequence[float]) -> bool:
        """Whether the last two times that it was asked the changes had not stayed as before."""
        if len(changes) < self.next - 1:
            return True
        half = self.next // 2
        late, early = max(changes[half:]), max(changes[half // 2 : half])
        before, self.as_before = self.as_before, late > AS_BEFORE * early
        self.next *= 2
        return not (before and self.as_before)


def _left(changes: Sequence[float], least: float) -> float:
    """Return what changes add up to from now on, infinite where they grow; few are rounding."""
    last, half, looks = changes[-LOOKS:], LOOKS // 2, len(changes)
    late, middle = max(last[half:]), looks // 2
    if late <= least:
        return late
    # each with one so many looks before: the first may have been far larger for another reason, as
    # where friction held until then, and what swings falls sooner and later
    pairs = [
        (late, max(last[:half]), half),
        (last[-1], last[half - 1], half),
        (late, max(changes[middle : middle + half]), max(looks - half - middle, half)),
    ]
    ratio = max((b / a) ** (1 / n) if a > 0 else math.inf for b, a, n in pairs)
    if ratio >= 1:
        return math.inf
    ahead = ratio / (1 - ratio)
    return late * max(1.0, ahead * (1.0 if ahead <= looks else FURTHER))
