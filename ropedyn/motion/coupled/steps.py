"""Steps in which what couples modes pushes them by constant forces; see csrc/volterra/modal.h."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ... import _core
from ...base.array import Real
from ..acting import core_laws
from ..smooth.passage import LawPassage, Passed, Steps
from ..smooth.system import OutputTimes
from .system import CoupledSystem

BLOCK = 1 << 18  # So many numbers of states are kept at a time.


class Stepper:
    """Steps of a system, one after another, from a state that it keeps."""

    def __init__(self, system: CoupledSystem, state: Real | None = None) -> None:
        self.system = system
        count, laws = len(system.modes.sigma), len(system.laws)
        self.state = np.zeros((2, count)) if state is None else state
        self.pushed, self.force = np.zeros(count), np.zeros(laws)
        self.largest, self.size = np.zeros(1), np.zeros(laws)
        self._laws = core_laws(system.laws)
        self._step: tuple[float, Real, Real] | None = None

    def take(self, begin: float, h: float, known: Real) -> StepsTaken:
        """Take steps from `begin`; known (steps + 1, k) is how the modes move by themselves."""
        system, number = self.system, len(known) - 1
        if self._step is None or self._step[0] != h:
            reached = system.modes.reached(h, 1.0)
            self._step = h, reached.change, reached.pushed.sum(axis=0)
        added = system.added(begin + h * np.arange(number + 1.0))
        state, pushed, force = (
            np.concatenate([one[None], np.zeros((number, *one.shape))])
            for one in (self.state, self.pushed, self.force)
        )
        made, residual, failure = _core.modal_steps(
            (begin, *self._step),
            self._laws,
            (
                system.row,
                system.form,
                system.coupling,
                (added[1:] + added[:-1]) / 2,
                system.stretching,
            ),
            np.ascontiguousarray(known),
            state,
            pushed,
            force,
            self.largest,
            self.size,
        )
        self.state, self.pushed, self.force = state[made], pushed[made], force[made]
        found = StepsTaken(state[: made + 1], pushed[1 : made + 1], force[1 : made + 1])
        return found if made == number else found._replace(error=(residual, failure))


class StepsTaken(NamedTuple):
    """What steps found."""

    state: Real  # (steps + 1, 2, k)
    pushed: Real  # (steps, k)
    force: Real  # (steps, laws)
    error: tuple[float, Any] | None = None  # the residual and the failure of the step after them


class CoupledPassage(LawPassage):
    """A run with steps of one length at most."""

    system: CoupledSystem

    def through(self, progress: Callable[[float], object]) -> Passed:
        """Take all steps."""
        system, done = self.system, 0
        edges = self._edges()
        known = system.linear(system.points, edges, 0).T
        stepper = Stepper(system)
        for block in self._blocks(max(BLOCK // (2 * known.shape[1]), 1)):
            found = stepper.take(block.begin, block.h, known[done : done + block.number + 1])
            made = len(found.pushed)
            done += made
            is_last = made == block.number and done == len(known) - 1
            self._record(block._replace(number=made), found, known[done - made : done + 1], is_last)
            if found.error is not None:
                when = block.begin + made * block.h
                error = self._failed(when, *found.error)
                settles = found.error[1] is not None
                return Passed(self.looked, self.reached, done, error, settles)
            self.stages = done
            progress(done / (len(known) - 1))
        return Passed(self.looked, float(system.time[-1]), done, largest=stepper.size)

    def _edges(self) -> Real:
        """Return when steps begin, and the last one ends."""
        begins = [s.begin + s.h * np.arange(s.number) for s in self.all_steps]
        return np.concatenate([*begins, self.system.time[-1:]])

    def _record(self, block: Steps, found: StepsTaken, known: Real, is_last: bool) -> None:
        """Keep what is asked for of some steps."""
        # accelerations are of forces on straight lines through the middles of steps
        rise = np.gradient(found.pushed, axis=0) if len(found.pushed) > 1 else 0 * found.pushed
        both = np.concatenate([found.pushed, rise], axis=1)
        self._look(block, both, found.state[:-1], is_last)

    def _sees(self, look: OutputTimes, h: float, theta: float) -> tuple[Real, Real]:
        some = self.system.modes.some(slice(0, 0), look.output)
        own, forced = some.modal_rows(some.reached(h, theta), look.order, h)
        rise = (theta - 0.5) * some.seen if look.order == 2 else np.zeros_like(some.seen)
        return own, np.concatenate([forced.sum(axis=1), rise], axis=1)
