"""One component from event to event: which stops are met, where friction holds, and the motion."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...base.array import Complex, Real
from ...base.errors import SolveError
from .course import Course, Crossing
from .driven import Forcing, UnderDrives, drive
from .phase import Matrices, PhaseSystem, matrices
from .pieces import ForcePiece
from .poles import Poles, poles_of

AT_ONCE = 64  # Events so close to each other, at most,
INSTANT = 1e-11  # of the time that is asked for,
QUICK = 1e-5  # or of a radian of the fastest mode.
UNMOVED = 1e-12  # A blow that moves a point by less of what modes move it does not.
SHARE = 1 / 16  # Of products that rounding adds up, beside their sum.


@dataclass(frozen=True, eq=False)
class Phase:
    """One phase: what each visit takes."""

    mode: tuple[int, ...]  # 1 of stops in contact; of friction the direction it slips in, or 0
    matrices: Matrices
    poles: Poles
    seen: Complex  # (outputs, j)
    driven: Complex  # (j, drives)
    held: Complex  # (j, 1 + frictions)
    loss: Real  # (j, n) magnitude of what z is told by

    @classmethod
    def of(cls, system: PhaseSystem, mode: tuple[int, ...], off: float) -> Phase:
        """Assemble it and find its poles, or such as are off."""
        m = matrices(system, mode)
        poles = poles_of(m.A, m.E.shape[1], system.span, off=off)
        left = poles.left
        return cls(mode, m, poles, m.Y @ poles.right, left @ m.Bd, left @ m.Bs, np.abs(left))

    def outputs(self, driven: UnderDrives) -> Course:
        """Return responses, displacements and forces of laws."""
        return driven.seen(self.seen, self.matrices.Dd, self.matrices.Ds)

    def state(self, driven: UnderDrives, hold: Real) -> Course:
        """Return q, q' and e."""
        m, n = self.matrices, self.matrices.E.shape[1]
        right = self.poles.right
        rows = np.concatenate([m.E @ right[:n], m.E @ right[n : 2 * n], right[2 * n :]])
        shift = np.zeros((len(rows), 1 + len(hold)))
        shift[: len(m.b), 1:] = m.b
        return driven.seen(rows, np.zeros((len(rows), m.Bd.shape[1])), shift)


class Instant(NamedTuple):
    """A state at a time."""

    q: Real  # (k,)
    v: Real  # (k,)
    e: Real  # (extras,)
    hold: Real  # (frictions,) where friction holds, or would [m, rad]


class Visit(NamedTuple):
    """A phase while it lasts."""

    start: float  # since the first time [s]
    stop: float
    phase: Phase
    driven: UnderDrives  # since its start
    outputs: Course  # responses, displacements and forces of laws, since the start
    hold: Real  # (frictions,) where friction holds

    def size(self, seen: Real, order: int) -> Real:
        """Return what the modes that outputs are the sum of move them at the start, at most."""
        m, poles = self.phase.matrices, self.phase.poles
        q = np.abs(m.E @ poles.right[: m.E.shape[1]])
        moves = np.maximum(np.abs(self.driven.own), self.driven.first)
        each = q @ (moves * np.abs(poles.rate) ** order)
        return np.asarray(np.abs(seen) @ (each + np.abs(m.b @ self.hold)))

    def state(self) -> Course:
        """Return q, q' and e, one after another, since the start."""
        return self.phase.state(self.driven, self.hold)

    def end(self) -> Instant:
        """Return the state that it ends in, before what happens then."""
        x = self.state().at(np.array([self.stop - self.start]))[:, 0]
        k = self.phase.matrices.E.shape[0]
        return Instant(x[:k], x[k : 2 * k], x[2 * k :], self.hold)


class PhaseWalk:
    """Motion of one component from event to event."""

    def __init__(self, system: PhaseSystem, off: float = 0.0) -> None:
        self.system, self.off = system, off
        self.phases: dict[tuple[int, ...], Phase] = {}
        self.events: list[tuple[float, int]] = []  # when [s], and of which law

    def visits(
        self, start: Instant, pieces: Iterator[ForcePiece], mode: tuple[int, ...] | None = None
    ) -> Iterator[Visit]:
        """Yield one phase after another, from one that goes on if a mode is given."""
        now, mode = start, self._first(start) if mode is None else mode
        for piece in pieces:
            if piece.kick.any():
                now, mode = self._struck(now, mode, piece)
            if piece.start == piece.stop:
                yield self._instant(now, mode, piece)
                return
            time, forcing, crowd = piece.start, piece.push, 0
            while time < piece.stop:
                left = piece.stop - time
                phase, driven = self._enter(now, mode, forcing, left)
                whole = phase.outputs(driven)
                outputs = whole.some(slice(self.system.responses, None))
                event = self._event(phase, driven, outputs, left)
                last = left if event is None else event.time
                if last > 0:
                    # what lasts to the end of a piece ends there, to the last digit
                    stop = piece.stop if event is None else time + last
                    yield Visit(time, stop, phase, driven, whole, now.hold)
                now = self._leave(phase, driven, now, last)
                if event is None:
                    break
                law = self._law(mode, event.which)
                soon = QUICK / np.abs(phase.poles.rate).max(initial=QUICK)
                crowd = 0 if last > max(INSTANT * self.system.span, soon) else crowd + 1
                if crowd > AT_ONCE:
                    raise _unsettled(self.system.begin + time)
                time, forcing = time + last, _later(forcing, last)
                self.events.append((self.system.begin + time, law))
                now, mode = self._changed(
                    now, mode, law=law, guard=event.which, outputs=outputs, time=last
                )

    def _instant(self, now: Instant, mode: tuple[int, ...], piece: ForcePiece) -> Visit:
        """Return the phase that begins at the last time, and what is there then."""
        for _ in range(AT_ONCE):
            phase, driven = self._enter(now, mode, piece.push, self.system.span)
            whole = phase.outputs(driven)
            outputs = whole.some(slice(self.system.responses, None))
            event = self._event(phase, driven, outputs, INSTANT * self.system.span)
            if event is None or event.time > 0:
                return Visit(piece.start, piece.stop, phase, driven, whole, now.hold)
            law = self._law(mode, event.which)
            now, mode = self._changed(
                now, mode, law=law, guard=event.which, outputs=outputs, time=0.0
            )
        raise _unsettled(self.system.begin + piece.start)

    def _first(self, start: Instant) -> tuple[int, ...]:
        """Return the phase before the first event: stops that are met, friction that holds."""
        laws = self.system.laws
        u = self.system.states.seen[self.system.responses :] @ start.q
        met = [int(c.side * u[k] > c.gap) for k, c in enumerate(laws.contacts)]
        return (*met, *(0 for _ in laws.frictions))

    def _enter(
        self, now: Instant, mode: tuple[int, ...], forcing: Forcing, ahead: float
    ) -> tuple[Phase, UnderDrives]:
        if mode not in self.phases:
            self.phases[mode] = Phase.of(self.system, mode, self.off)
        phase = self.phases[mode]
        m = phase.matrices
        x = np.concatenate([m.E.T @ (now.q - m.b @ now.hold), m.E.T @ now.v, now.e])
        fixed = np.concatenate([[1.0], now.hold])
        z = phase.poles.left @ x
        held = phase.held @ fixed
        p = phase.poles.rate
        driven = drive(p, phase.driven, z, forcing, fixed=fixed, held=held, ahead=ahead)
        return phase, driven._replace(first=np.abs(z) + SHARE * (phase.loss @ np.abs(x)))

    def _leave(self, phase: Phase, driven: UnderDrives, now: Instant, time: float) -> Instant:
        m, n = phase.matrices, phase.matrices.E.shape[1]
        x = (phase.poles.right @ driven.at(time)).real
        q, v = m.E @ x[:n] + m.b @ now.hold, m.E @ x[n : 2 * n]
        return Instant(q, v, x[2 * n :], now.hold)

    def _event(
        self, phase: Phase, driven: UnderDrives, outputs: Course, end: float
    ) -> Crossing | None:
        """Return what ends a phase first, if something does."""
        guards = self._guards(phase.mode, outputs)
        return guards.first_crossing(self._scale(phase, driven, phase.mode), end)

    def _guards(self, mode: tuple[int, ...], outputs: Course) -> Course:
        """Return what stays above zero while the phase lasts."""
        laws = self.system.laws
        count, contacts = len(laws.points), len(laws.contacts)
        u, force = outputs.some(slice(0, count)), outputs.some(slice(count, None))
        found = []
        for k, stop in enumerate(laws.contacts):
            sign = 1.0 if mode[k] else -1.0
            found.append(_scaled(u.some(slice(k, k + 1)), sign * stop.side, -sign * stop.gap))
        for k, friction in enumerate(laws.frictions, contacts):
            one = slice(k, k + 1)
            if mode[k]:
                found.append(_scaled(u.some(one).derivative(), float(mode[k]), 0.0))
            else:
                found += [_scaled(force.some(one), sign, friction.force) for sign in (1.0, -1.0)]
        return _stacked(found, outputs)

    def _scale(self, phase: Phase, driven: UnderDrives, mode: tuple[int, ...]) -> Real:
        """Return the size of the numbers that each guard is a difference of."""
        laws, first, m = self.system.laws, self.system.responses, phase.matrices
        size = np.abs(phase.seen) * driven.first
        value = size.sum(axis=1) + np.abs(m.Ds) @ np.abs(driven.fixed)
        value += np.abs(m.Dd) @ np.abs(driven.push.level)
        # what acts may cancel friction
        with np.errstate(over="ignore"):
            acts = np.abs(phase.driven) @ np.abs(driven.push.level)
            acts += np.abs(phase.held) @ np.abs(driven.fixed)
            speed = size @ np.abs(phase.poles.rate) + np.abs(phase.seen) @ acts
        contacts, count = len(laws.contacts), len(laws.points)
        found = (value[first : first + contacts] + [c.gap for c in laws.contacts]).tolist()
        for k, friction in enumerate(laws.frictions, contacts):
            held = float(value[first + count + k]) + friction.force
            found += [float(speed[first + k])] if mode[k] else [held, held]
        return np.array(found)

    def _law(self, mode: tuple[int, ...], guard: int) -> int:
        """Return which law a guard is of."""
        each = [1] * len(self.system.laws.contacts)
        each += [1 if one else 2 for one in mode[len(each) :]]
        return int(np.searchsorted(np.cumsum(each), guard, side="right"))

    def _changed(
        self,
        now: Instant,
        mode: tuple[int, ...],
        *,
        law: int,
        guard: int,
        outputs: Course,
        time: float,
    ) -> tuple[Instant, tuple[int, ...]]:
        """Return the state and the phase after an event."""
        contacts, new = len(self.system.laws.contacts), list(mode)
        if law < contacts:
            new[law] = 1 - mode[law]
        elif mode[law]:
            new[law] = 0
            hold = now.hold.copy()
            u = outputs.some(slice(law, law + 1)).at(np.array([time]))
            hold[law - contacts] = u[0, 0]
            now = now._replace(hold=hold)
        else:
            # the force that holds reaches its largest: from below, it slips against it
            same = [k for k in range(guard + 1) if self._law(mode, k) == law]
            new[law] = 1 if len(same) == 1 else -1
        return now, tuple(new)

    def _struck(
        self, now: Instant, mode: tuple[int, ...], piece: ForcePiece
    ) -> tuple[Instant, tuple[int, ...]]:
        """Let blows act: friction on nothing but mass slips at once."""
        system, st = self.system, self.system.states
        contacts = len(system.laws.contacts)
        kick = st.push[:, : system.drives] @ piece.kick
        v, e = now.v + kick, now.e.copy()
        if system.late:
            e[: system.drives] += piece.kick / st.gamma
        new, soft = list(mode), system.soft
        for k in range(contacts, contacts + len(system.laws.frictions)):
            push = st.push[:, system.first + k]
            # modes that strike a point and cancel leave what it did
            if not soft[k] and abs(push @ kick) > UNMOVED * (np.abs(push) @ np.abs(kick)):
                new[k] = int(np.sign(push @ v))
        return now._replace(v=v, e=e), tuple(new)


def _unsettled(time: float) -> SolveError:
    """Return what is said where events at once do not end."""
    return SolveError(f"stops and friction find no lasting phase at t = {time:g} s")


def _scaled(course: Course, factor: float, shift: float) -> Course:
    """Return factor y + shift."""
    a = factor * course.a
    a[:, 0] += shift
    return Course(course.rate, factor * course.c, factor * course.d, a)


def _stacked(found: list[Course], like: Course) -> Course:
    if not found:
        return like.some(slice(0, 0))
    parts = zip(*((one.c, one.d, one.a) for one in found))
    return Course(like.rate, *(np.concatenate(part) for part in parts))


def _later(forcing: Forcing, time: float) -> Forcing:
    """Return the same since a later time."""
    return forcing._replace(
        wave=forcing.wave * np.exp(forcing.rate * time), level=forcing.level + forcing.slope * time
    )
