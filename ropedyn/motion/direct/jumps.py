"""What happens at a time where forces begin, jump or strike."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...base.array import Flags, Real
from ...scene.force import Force
from .march import FORGETS, KEEPS, Motion, Push, Stride
from .timeline import Timeline

SHORT = 1e-4
"""Blows last, ends jump and what has no inertia follows for this part of a step: less is rounding.
"""
PROBE = 1e-6  # So far of a step is looked ahead for what holds at one time.
STEPS = 3  # What has no inertia follows in so many: one for the jump, two for its rate.
LEAST = 1e-12  # Jumps smaller than this part of what jumps are rounding.


class Jump(NamedTuple):
    """How functions of time change at one time, each shape (functions,)."""

    value: Real  # After it
    jump: Real
    rate: Real  # After it [1/s]
    bend: Flags  # Whether the rate jumps


@dataclass(frozen=True, eq=False)
class Onset:
    """The jumps and blows of one chain at one time."""

    motion: Motion  # of the chain
    time: float  # just after which [s]
    h: float  # of the steps that follow [s]
    force: Jump  # of the forces and of ends that are moved
    ends: Jump  # of the forces and of ends that are moved
    blow: Real  # (drives,) impulses [N s, N m s]
    jumps: bool  # whether something must follow at once

    def happen(self) -> Real:
        """Let it happen; return the energies of what led there, shape (.., 5)."""
        if self.jumps:
            energy = self._settle().energy
        for place, rate in zip(self.motion.lumps.moved, self.ends.rate):
            self.motion.state.v[tuple(place)] = rate
        return self.probe().energy if self.ends.bend.any() or not self.jumps else energy

    def _settle(self) -> Stride:
        """Let blows, jumps of ends and what has no inertia happen within three short steps."""
        e = SHORT * self.h
        push = self._push(STEPS, e, FORGETS)
        push.force[0] += self.blow / e
        push.speed[0] += self.ends.jump / e
        stride = self.motion.advance(push, self._times(STEPS, e), e, FORGETS, refined=True)
        if stride.error is not None:
            raise stride.error
        self.motion.late = STEPS * e
        return stride

    def probe(self) -> Stride:
        """Return what holds at this time."""
        e = PROBE * self.h
        stride = self.motion.probe(self._push(1, e, KEEPS), self._times(1, e), e)
        if stride.error is not None:
            raise stride.error
        return stride

    def values(self, order: int) -> Real:
        """Return the responses at this time, motion as the state has it."""
        rows, state = self.motion.lumps.readout.ports, self.motion.state
        told = order < 2 and rows.force is None
        read = np.zeros((1, 3, len(rows.node))) if told else self.probe().read
        moves = rows.row.any(axis=(1, 2))
        for k, motion in enumerate((state.u, state.v)):
            pair = np.stack([motion[rows.node], motion[rows.node + 1]], axis=1)
            read[0, k, moves] = np.einsum("rsc,rsc->r", rows.row, pair)[moves]
        read[0, 0, moves] -= self.motion.late * read[0, 1, moves]
        values = self.motion.lumps.values(read, np.array([self.time]), order)
        return np.asarray(values[0], dtype=np.float64)

    def _times(self, steps: int, h: float) -> Real:
        return np.asarray(self.time + h * np.arange(steps + 1), dtype=np.float64)

    def _push(self, steps: int, h: float, g: float) -> Push:
        """Return the forces of this time, which grow as they do there."""
        stages = self._times(steps, h)[:-1, None] + h * np.array([g, 1 - g])
        force = self.force.value + self.force.rate * (stages - self.time)[..., None]
        speed = np.tile(self.ends.rate, (steps, 2, 1))
        pulsation = self.motion.lumps.pulsation
        return Push(force, speed, None if pulsation is None else pulsation(stages))


def onset(motion: Motion, line: Timeline, mark: int) -> Onset:
    """Return what happens to a chain at a mark."""
    lumps = motion.lumps
    time, near = float(line.mark[mark]), 2 * line.near
    before, after = (None if mark == 0 else time - near), time + near
    force = _change(lumps.forces, before, after)
    ends = _change(lumps.motions, before, after)
    blows = ([size for at, size in f.blows if line.at(at) == mark] for f in lumps.forces)
    blow = np.array([sum(sizes) for sizes in blows], dtype=np.float64)
    bare = lumps.is_bare & ((force.jump != 0) | force.bend)
    jumps = bool(blow.any() or ends.jump.any() or bare.any())
    if lumps.massless.any():
        turned = mark == 0 and lumps.pulsation is not None and not motion.rests
        jumps = jumps or bool(ends.bend.any()) or turned
    jumps = jumps or (mark == 0 and lumps.released)
    return Onset(motion, after, float(line.h[mark]), force, ends, blow, jumps)


def _change(functions: tuple[Force, ...], before: float | None, after: float) -> Jump:
    """Return how functions change; before the motion begins they are 0."""

    def at(time: float | None, verb: str) -> Real:
        if time is None:
            return np.zeros(len(functions))
        now = [float(getattr(one, verb)(np.array(time))) for one in functions]
        return np.array(now, dtype=np.float64)

    value, rate = at(after, "value"), at(after, "rate")
    jump, bend = value - at(before, "value"), rate - at(before, "rate")
    size = np.abs(value) + np.abs(value - jump)
    drift = 0.0 if before is None else (after - before) * (np.abs(rate) + np.abs(rate - bend))
    jump[np.abs(jump) <= LEAST * size + drift] = 0.0
    return Jump(value, jump, rate, np.abs(bend) > 1e-6 * (np.abs(rate) + np.abs(rate - bend)))
