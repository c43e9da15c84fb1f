"""A run under smooth laws with steps of one length at most."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np

from ... import _core
from ...base.array import Real
from ...base.errors import SolveError
from ..modal.exponentials import is_uniform
from .collocation import HIGHEST, STAGES, nodes, tables
from .laws import LawFailure, smooth_laws
from .system import LawSystem, OutputTimes

BLOCK = 1 << 18  # So many numbers of states are kept at a time,
ROWS = 4096  # and how so many places within a step are seen.
TIMES, MORE = 3.0, 12.0  # The finer of two runs is off by so many times their distance at most, or
# by so many over what half the step divides errors by, where that is little.
SAME = 1e-9  # Runs that are apart by less than this part of the largest value do not differ yet.
FORGETS = 4.0  # What runs before were apart counts, this much less with each half of the step.
SOON = 1e-15  # What breaks within this part of a run does so when it begins.
SNAP = 1e-9  # Times closer to the end of a step than this part of it are there.


class Steps(NamedTuple):
    """Equal steps one after another."""

    begin: float  # [s]
    h: float  # [s]
    number: int

    @property
    def end(self) -> float:
        """When the last one ends [s]."""
        return self.begin + self.h * self.number

    def parts(self, most: int) -> Iterable[Steps]:
        """Yield them, at most so many at once, in blocks alike."""
        blocks = -(-self.number // most)
        for k in range(blocks):
            first, until = (self.number * one // blocks for one in (k, k + 1))
            yield Steps(self.begin + self.h * first, self.h, until - first)


def steps_between(time: Real, breaks: Iterable[float], h: float) -> list[Steps]:
    """Return steps of at most h from the first time to the last, with breaks at ends of steps."""
    # where times are even, steps are so many of their intervals or parts of one: then few places
    # within steps are looked at. What is left before a break are two or three shorter ones in turn,
    # so that runs that are compared differ there too
    pieces = 2 + round(math.log2(float(time[-1] - time[0]) / h)) % 2
    if is_uniform(time):
        dt = float(time[-1] - time[0]) / (len(time) - 1)
        h = dt * math.floor(h / dt * (1 + SNAP)) if h >= dt else dt / math.ceil(dt / h)
    first, last = float(time[0]), float(time[-1])
    inside = [at for at in breaks if SOON * (last - first) < at - first < last - first]
    edges = np.unique([first, *inside, last])
    near = SNAP * h
    found: list[Steps] = []
    for begin, end in zip(edges[:-1].tolist(), edges[1:].tolist()):
        count = math.floor((end - begin) / h * (1 + SNAP))
        left = end - begin - count * h
        if count:
            found.append(Steps(begin, h, count))
        if left > near or not count:
            found.append(Steps(end - left, left / pieces, pieces))
    return found


class Passed(NamedTuple):
    """What a run with steps of one length found."""

    looked: list[Real]  # what laws add to each look, (outputs, t)
    reached: float  # until when it looked [s]
    stages: int
    error: BaseException | None = None  # what ended it early
    settles: bool = True  # whether Newton's method found the forces
    bent: Real = np.zeros(0)  # the highest degree of laws' forces in steps, relative, (laws,)
    largest: Real = np.zeros(0)  # forces of laws, (laws,)
    size: Real = np.zeros((3, 0))  # of laws' displacements, velocities and forces, (3, laws)


class Runs:
    """How far two runs are apart, in turn."""

    def __init__(self) -> None:
        self.kept: Real | float = np.inf

    def apart(self, found: Real, before: Real, falls: float) -> Real:
        """Return it, as found (outputs, t); half the step divides errors by `falls` at least."""
        # where velocities turn or contact begins, two runs may agree by chance
        last = self.kept / falls if np.isfinite(falls) else 0.0
        now = np.maximum.accumulate(np.abs(found - before), axis=1)
        self.kept = np.maximum(now, np.where(np.isfinite(self.kept), self.kept, 0.0) / FORGETS)
        return np.maximum(now, last)


def since_they_differ(apart: Real, found: Real) -> Real:
    """Return the largest distance of two runs from where they differ on, which never falls.

    They may see a turn alike, and agree by chance for a while.
    """
    differ = apart > SAME * np.abs(found).max(axis=1, initial=0.0)[:, None]
    return np.where(differ, apart[:, -1:], apart)


def reach(falls: float) -> float:
    """Return by how many times their distance the finer of two runs is off at most."""
    return max(TIMES, MORE / falls)


class LawPassage:
    """A run with steps of one length at most."""

    def __init__(self, system: LawSystem, h: float) -> None:
        self.system = system
        self.all_steps = steps_between(system.time, system.breaks, h)
        self.looked = [np.zeros((o.stop - o.start, len(t))) for o, t, _ in system.looks]
        self._next = [0] * len(self.looked)  # which time of each look comes next
        self._rows: dict[tuple[float, float, int], tuple[Real, Real]] = {}
        self.reached, self.stages = float(system.time[0]), 0  # seen until when [s], in so many

    def passed(self, progress: Callable[[float], object]) -> Passed:
        """Take all steps, or whole blocks of them until Ctrl-C."""
        try:
            return self.through(progress)
        except KeyboardInterrupt as error:
            return Passed(self.looked, self.reached, self.stages, error)

    def through(self, progress: Callable[[float], object]) -> Passed:
        """Take all steps."""
        system, n, k = self.system, len(self.system.laws), len(self.system.modes.sigma)
        known = self._known()
        size = np.concatenate([np.abs(known).max(axis=(0, 1)), np.zeros((1, n))])
        laws = smooth_laws(system.laws, system.time, size)
        points = system.modes.some(system.points, system.points)
        force, state = np.zeros((STAGES, n)), np.zeros((n, 2, k))
        done, before, table, bent = 0, math.nan, None, np.zeros(n)
        for block in self._blocks(max(BLOCK // (2 * n * k), 1)):
            if table is None or block.h != before:
                table = tables(points, block.h, before if done else block.h)
            begin = block.begin + block.h * np.arange(block.number, dtype=np.float64)
            now = known[done : done + block.number]
            found = _core.collocate(table, laws, begin, now, force, state, size)
            forces, motions, _, (size,), made, _, residual, failure = found
            done, before = done + made, block.h
            highest = np.abs(np.tensordot(HIGHEST, forces[1:], (0, 1)))
            bent = np.maximum(bent, highest.max(axis=0, initial=0.0))
            is_last = made == block.number and done == len(known)
            self._look(block._replace(number=made), forces[1:], motions, is_last)
            self.stages = done * STAGES
            if made < block.number:
                error = self._failed(block.begin + made * block.h, residual, failure)
                settles = failure is not None
                return Passed(self.looked, self.reached, self.stages, error, settles)
            force, state = forces[-1], motions[-1]
            progress(done / len(known))
        bent /= np.maximum(size[2], np.finfo(float).tiny)
        return Passed(self.looked, float(system.time[-1]), done * STAGES, bent=bent, size=size)

    def _blocks(self, most: int) -> Iterator[Steps]:
        for whole in self.all_steps:
            yield from whole.parts(most)

    def _known(self) -> Real:
        """Return how the laws' points move without laws at all stages, (steps, stages, 2, laws)."""
        system = self.system
        stages = [
            np.add.outer(s.begin + s.h * np.arange(s.number), s.h * nodes(STAGES)).ravel()
            for s in self.all_steps
        ]
        time = np.concatenate([system.time[:1], *stages])
        both = [system.linear(system.points, time, order)[:, 1:] for order in range(2)]
        value = np.stack(both).reshape(2, len(both[0]), -1, STAGES)
        return np.ascontiguousarray(value.transpose(2, 3, 0, 1))

    def _failed(self, when: float, residual: float, failure: tuple[Any, ...] | None) -> Any:
        """Return why a step has no forces."""
        if failure is not None:
            return LawFailure(*failure).told(self.system.laws)
        names = ", ".join(dict.fromkeys(law.name for law in self.system.laws))
        return SolveError(
            f"the force of {names or 'the tension'} does not converge at t = {when!r} s: the "
            f"residual is {residual:.3g} of the forces; laws without jumps do, in short steps"
        )

    # --- what is looked at ----------------------------------------------------------------------

    def _look(self, steps: Steps, force: Real, state: Real, is_last: bool) -> None:
        """Add what laws move at the times within some steps, at the end of the last alone."""
        if steps.number == 0:
            return
        self.reached = steps.end - (0.0 if is_last else 2 * SNAP * steps.h)
        for number, look in enumerate(self.system.looks):
            # whatever rounding makes of ends and begins, each time is seen once
            until = steps.begin + steps.h * (steps.number - SNAP)
            stop = len(look.time) if is_last else int(np.searchsorted(look.time, until))
            at = np.arange(self._next[number], max(stop, self._next[number]))
            self._next[number] += len(at)
            since = (look.time[at] - steps.begin) / steps.h
            step = np.clip(np.floor(since + SNAP).astype(np.intp), 0, steps.number - 1)
            theta = np.round(np.clip(since - step, 0.0, 1.0), 10)
            for one in np.unique(theta).tolist():
                some = theta == one
                own, forced = self._row(number, steps.h, one)
                moved = own @ state[step[some]].reshape(-1, own.shape[1]).T
                moved += forced @ force[step[some]].reshape(-1, forced.shape[1]).T
                self.looked[number][:, at[some]] = moved

    def _row(self, number: int, h: float, theta: float) -> tuple[Real, Real]:
        """Return what a look sees per state at the beginning of a step, and per force in it."""
        if (h, theta, number) not in self._rows:
            if len(self._rows) > ROWS:
                self._rows.clear()
            rows = self._sees(self.system.looks[number], h, theta)
            own, forced = (one.reshape(len(one), -1) for one in rows)
            self._rows[h, theta, number] = own, forced
        return self._rows[h, theta, number]

    def _sees(self, look: OutputTimes, h: float, theta: float) -> tuple[Real, Real]:
        some = self.system.modes.some(self.system.points, look.output)
        return some.rows(some.reached(h, theta), look.order, h)
