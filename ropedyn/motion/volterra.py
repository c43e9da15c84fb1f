"""Motion under laws of points of any linear model: Volterra's equation for their forces.

    u(t) = linear(t) + integral of S'(t - s) f(s) ds,   f = law(t, u, u'),

u of the laws' points, S what steps of force move them. `linear` and S are linear motion, by modes
or by the line: any damping, continuous spans, structures, moved ends. In each step the forces are
constant and a law sees the means of the step (csrc/volterra), so that friction holds without
creeping. The forces, as straight lines through them, then drive the linear model. Three runs tell
the error, each with steps half as long as the one before.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from .. import _core
from ..base.answer import Cost
from ..base.array import Flags, Real
from ..base.computed import changed, computed
from ..base.errors import SolveError
from ..base.progress import silent
from ..chain.port import Point
from ..scene.force import Samples, Step
from .acting import ActingLaw, acting_laws, core_laws, held_of
from .coupled.energy import of_chain
from .history import History, ended_by
from .line.grid import is_even
from .linear import nearest, snapshots_of, within_tolerance
from .modal.expansion import refuse_losses
from .moved import Moved, against_spans, of_kinds
from .request import TOLERANCE, Run
from .smooth.laws import LawFailure
from .smooth.passage import Runs, since_they_differ
from .smooth.smooth import allowed

FIRST, MOST_STEPS = 512, 1 << 16  # Steps of a record, of a second run at least and at most, or
RUNS = 6  # so many times those of the first: three runs.
SHARPER = 0.05  # Linear motion is known to this part of the tolerance, if it can be,
SHAPED = 0.25  # from shapes and velocities to this.
TIMES = 2.0  # A run is off by so many times its distance to one with steps twice as long, or what
FALLS = 2.0  # that run was off over this.
BLOCK = 2048  # So many steps are taken at a time.
STOPS = (Exception, KeyboardInterrupt)  # May end a run early and leave an answer.
NONE = np.zeros(0)


# --- one run --------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class Stepped:
    """Forces of the laws in steps of one length."""

    run: Run
    laws: list[ActingLaw]
    count: int
    tolerance: float

    @property
    def points(self) -> tuple[Point, ...]:
        """Where the laws act."""
        return tuple(one.point for one in self.laws)

    @property
    def accuracy(self) -> float:
        """To which linear motion is known, if it can be."""
        return SHARPER * self.tolerance

    @property
    def time(self) -> Real:
        """When steps begin and end [s]."""
        begin, end = float(self.run.time[0]), float(self.run.time[-1])
        return np.asarray(begin + (end - begin) / self.count * np.arange(self.count + 1))

    def moved(self) -> Moved:
        """Return the motion of the responses."""
        return self._nearest(self.pushed().but(least=np.where(self.held, self.free, 0.0)))

    def pushed(self) -> Run:
        """Return the linear run that the laws' forces drive too."""
        force = self.force
        node = np.concatenate([force[:, :1], (force[:, 1:] + force[:, :-1]) / 2, force[:, -1:]], 1)
        run, time = self.run, self.time
        drives = (*run.drives, *self.points)
        return run.but(drives=drives, forces=(*run.forces, *(Samples(time, f) for f in node)))

    def _nearest(self, run: Run) -> Moved:
        if run.coarse is None:
            return nearest(run, self.accuracy)
        return within_tolerance(run.but(tolerance=SHAPED * self.tolerance))

    def _linear(self, **asked: Any) -> Real:
        """Return how the points move without the laws, or as something else drives them."""
        plain = {"responses": self.points, "order": 0, "snapshots": NONE, "progress": silent}
        some = self.run.but(time=self.time, **(plain | asked))
        if not some.places:
            return np.zeros((len(self.points), self.count + 1))
        return self._nearest(some).value

    @computed
    def force(self) -> Real:
        """The forces of the laws in each step, (laws, steps)."""
        run, count = self.run, len(self.laws)
        linear = self._linear()
        step = Step(1.0, time=float(run.time[0]))
        alone: dict[str, Any] = {"forces": (step,), "loads": {}, "kicks": {}, "coarse": None}
        answer = np.stack([self._linear(drives=(point,), **alone) for point in self.points], axis=1)
        kernel = np.ascontiguousarray(np.diff(answer, axis=2)[..., ::-1])
        force, motion = np.zeros((count, self.count)), np.zeros((count, self.count + 1))
        motion[:, 0] = linear[:, 0]
        h, size = float(self.time[1] - self.time[0]), np.zeros(count)
        known = core_laws(self.laws), float(run.time[0]), h, kernel, linear, force, motion, size
        made = 0
        try:
            for first in range(0, self.count, BLOCK):
                until = min(first + BLOCK, self.count)
                made, residual, failure = _core.volterra(*known, first, until)
                if made < until:
                    raise self._error(failure, float(self.time[made]), residual)
                run.progress(until / self.count)
        except STOPS as error:
            raise Ended(error, float(self.time[made])) from error
        return force

    @computed
    def held(self) -> Flags:
        """Which responses friction holds all the time."""
        largest = np.abs(self.force).max(axis=1)
        return held_of(self.run.responses, self.laws, largest)

    @computed
    def free(self) -> Real:
        """What responses of each kind move at most without laws, where friction holds some."""
        run = self.run
        if not self.held.any():
            return np.zeros(len(run.responses))
        moved = self._linear(responses=run.responses, order=run.order)
        return of_kinds(np.abs(moved).max(axis=1), run.responses)

    def _error(self, failure: Any, when: float, residual: float) -> BaseException:
        if failure is not None:
            return LawFailure(*failure).told(self.laws)
        return Unsettled(
            f"the laws of {', '.join(dict.fromkeys(law.name for law in self.laws))} do not "
            f"converge at t = {when!r} s in steps of {self.time[1] - self.time[0]:.3g} s: the "
            f"residual is {residual:.3g} of their forces"
        )


class Unsettled(SolveError):
    """Forces of a step that were not found."""


class Ended(Exception):
    """What ended a run early, and when [s]."""

    def __init__(self, error: BaseException, when: float) -> None:
        super().__init__(when)
        self.error, self.when = error, when


# --- runs that agree ------------------------------------------------------------------------------


def integrate(run: Run) -> History:
    """Find the motion under laws of points; see `Model.transient`."""
    refuse_losses(run.model)
    tolerance = TOLERANCE if run.tolerance is None else run.tolerance
    try:
        stepped, moved, stopped = _agreed(run, tolerance)
    except Ended as ended:
        return _ended(run, ended)
    x, snapshot = snapshots_of(stepped.pushed().but(tolerance=tolerance))
    kept, elements = run.kept, len(run.model.x) - 1
    return History(
        **kept.told,
        value=moved.value,
        x=x,
        snapshot=snapshot,
        cost=Cost("volterra", elements, moved.modes, stepped.count),
        error=moved.error,
        mesh_error=partial(against_spans, kept, moved.value, integrate),
        balance=partial(of_chain, kept, integrate),
        stopped=ended_by(stopped),
    )


def _ended(run: Run, ended: Ended) -> History:
    """Return what was before a run ended, where that is wanted, or raise what ended it."""
    known, error = run.time <= ended.when, ended.error
    history = None
    if known.sum() > 1:
        seen = run.snapshots[run.snapshots <= ended.when]
        before = run.but(time=run.time[known], snapshots=seen, progress=silent, partial=False)
        with suppress(SolveError):
            history = changed(integrate(before), stopped=ended_by(error))
    if run.partial and history is not None:
        return history
    if isinstance(error, SolveError):
        error.history = history
    raise error


def _agreed(run: Run, tolerance: float) -> tuple[Stepped, Moved, BaseException | None]:
    """Halve the steps until two runs agree within the tolerance, or until Ctrl-C."""
    count, coarse = _first(run), None
    most_steps = max(MOST_STEPS, RUNS * count)
    runs = Runs()
    laws = acting_laws(run.model)
    sharp = any(one.is_sharp for one in laws)
    while True:
        more = _finer(run, laws, count)
        stepped = Stepped(run, laws, count, tolerance)
        try:
            found = stepped.moved()
        except (KeyboardInterrupt, Ended) as ended:
            error = ended.error if isinstance(ended, Ended) else ended
            if isinstance(error, KeyboardInterrupt) and coarse is not None and run.partial:
                stepped, found = coarse
                return stepped, found._replace(error=np.full(found.value.shape, np.inf)), error
            if not isinstance(error, Unsettled) or more > most_steps:
                raise
            count, runs, coarse = more, Runs(), None
            continue
        if coarse is not None:
            before = coarse[1]
            both = runs.apart(found.value, before.value, FALLS)
            known = found._replace(error=found.error + TIMES * both)
            free, held = stepped.free, stepped.held
            most = allowed(found.value, tolerance, run.responses, driven=free, held=held)[:, None]
            if (known.error <= most).all():
                if sharp:
                    both = since_they_differ(both, found.value)
                    known = found._replace(error=found.error + TIMES * both)
                return stepped, known, None
            # shorter steps do not help where linear motion is not known
            if more > most_steps or (np.minimum(found.error, before.error) > most).any():
                seen = np.where(np.isfinite(both), both, runs.kept)
                known = found._replace(error=found.error + TIMES * seen)
                raise _unknown(run, tolerance, count, known, most)
        count, coarse = more, (stepped, found)


def _finer(run: Run, laws: list[ActingLaw], count: int) -> int:
    """Return how many steps the next run takes: ends of others would see a turn as they did."""
    times = len(run.time) - 1
    is_sharp = any(one.is_sharp for one in laws)
    if not is_sharp or (is_even(run.time) and count < times):
        return 2 * count
    return 2 * count + (times if is_even(run.time) else 1)


def _first(run: Run) -> int:
    """Return how many steps a first run takes: it or the second as many in each of even times."""
    times = len(run.time) - 1
    highest = max((force.highest for force in run.forces), default=0.0)
    least = max(FIRST, 4 * math.ceil(highest * float(run.time[-1] - run.time[0])))
    steps = times * -(-least // times) if is_even(run.time) else max(least, times)
    return steps if steps % 2 else steps // 2


def _unknown(run: Run, tolerance: float, count: int, known: Moved, most: Real) -> SolveError:
    late = (known.error > most).any(axis=0)
    until = float(run.time[max(int(late.argmax()) - 1, 0)])
    helps = "or an earlier end help" if until > run.time[0] else "or a smoother force help"
    return SolveError(
        f"the motion is known to {tolerance:g} of its largest value until t = {until:.4g} s only: "
        f"with {count} steps the error is up to {tolerance * (known.error / most).max():.1e}. "
        f"A larger tolerance {helps}"
    )
