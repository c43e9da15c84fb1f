"""Motion over time under smooth laws of points.

What drives moves the linear rope in closed form; what the forces of the laws add is found by
collocation (collocation.py), which leaves them alone unknown. Two runs, one with steps half as
long, tell the error of the steps, and of continuous spans a run with half of the modes that of the
modes that are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ...base.answer import Cost
from ...base.array import Flags, Real
from ...base.errors import SceneError, SolveError
from ...chain.compiled import Compiled
from ...chain.port import Point, is_force, locate, moving
from ...chain.tip import carrier
from ...eigen.damped.proportional import proportional
from ...eigen.damped.rates import Rates
from ...eigen.vectors import within
from ...response.deflection import POINTS
from ...response.moved_end import is_end
from ..acting import ActingLaw, acting_laws
from ..coupled.energy import of_chain
from ..coupled.steps import CoupledPassage
from ..coupled.system import CoupledSystem, moving_together, refuse_points, tension_of
from ..history import History, ended_by
from ..linear import solve_linear
from ..moved import against_spans, of_kinds
from ..request import TOLERANCE, Run
from ..states import LARGEST, softens, without_dashpots
from ..undamped import losses_of
from .laws import laws_on, why_not_smooth
from .passage import LawPassage, Runs, reach, since_they_differ
from .stretching import StretchedPassage
from .system import LawSystem, OutputTimes

MODES, MOST_MODES = 64, 4096  # Of continuous spans and long chains, at first and at most,
MOST_WORK = 5e7  # if a run with half of them has not had so many times stages: some seconds.
AT_ONCE = 1e-3  # Of such a time: sooner after a jump it is still to come.
MORE = 16  # What jumps is off by as much with so many times the modes.
HALVED = 2.5  # A run is off by so many times its distance to one with half: errors fall as 1/modes.
NEAR = 2.0  # Radians of the first mode left out in which a front passes, halfway the same in both.
FEW, FAR = 8, 4  # Where times are so few, so many times as far before and after them is looked too.
MOST_STEPS = 2_000_000  # A run takes so many steps at most,
HARD = 10  # or so many halvings of steps that do not converge.
BENDS = 8.0  # Half the step divides the highest degree of smooth forces by as much at least;
BENT_FALLS = 2.0  # of others it divides errors by so much.
NOTHING = 1e-9  # Responses smaller than this part of the largest are rounding.
ROUNDING = 1e-12  # Of the largest value and of each radian that it turns, what rounding leaves.
STOPS = (Exception, KeyboardInterrupt)  # May end a run early and leave an answer.


# --- what is taken ------------------------------------------------------------------------------


def takes(run: Run) -> bool:
    """Whether modes are followed: the tension varies, laws are smooth, or a chain has all modes."""
    model = run.model
    if not is_constant(model):
        return True
    return run.coarse is None and (_is_smooth(run) or _is_told(run))


def _is_smooth(run: Run) -> bool:
    """Whether laws are smooth and act on modes that nothing else couples."""
    model = run.model
    if why_not_smooth(model) or losses_of(model):
        return False
    told = any(map(is_force, run.responses))
    for component in model.components:
        moved = any(is_end(place) and moving(place) in component for place in run.places)
        if not _is_taken(model, component) or (moved and told and softens(model, component)):
            return False
    return True


def _is_told(run: Run) -> bool:
    """Whether all modes of a chain tell the motion under any laws and dampers."""
    model, chain = run.model, run.model.chain
    if losses_of(model) or not model.separable or chain.spurious or chain.free > LARGEST:
        return False
    places = [*run.places, *(one.point for one in acting_laws(model))]
    try:
        refuse_points(model, places, run.responses, run.order)
    except SceneError:
        return False
    return True


def is_constant(model: Compiled) -> bool:
    """Whether the tension that acts on a model is the same at all times."""
    return not any(tension_of(model, component) for component in model.components)


def _is_taken(model: Compiled, component: tuple[str, ...]) -> bool:
    laws = laws_on(model, component)
    if not laws:
        return True
    plain = without_dashpots(model, component)[0].chain.only(component)
    if model.chain.only(component).spurious or _has_no_inertia(model, component, laws):
        return False
    return proportional(plain, Rates.of(model.scene.dampings)) is not None


def _has_no_inertia(model: Compiled, component: tuple[str, ...], laws: list[ActingLaw]) -> bool:
    chain = model.chain.only(component)
    if chain.inertia is not None:
        return False
    for law in laws:
        name, x = law.point
        node, inside = locate(model.x, x)
        at = component.index(name)
        if inside is not None or not chain.mass[chain.term_of[node], at, at] > 0:
            return True
    return False


# --- runs that agree ----------------------------------------------------------------------------


@dataclass(eq=False)
class Agreed:
    """Motion of a component, and how far it is off."""

    looked: list[Real]  # of each look, (outputs, t)
    step_error: Real  # of the first look
    truncation: Real  # (outputs of the first look,)
    h: float  # [s]
    reached: float  # [s]
    stages: int
    modes: int
    error: BaseException | None = None  # what ended it early
    by_steps: bool = False  # whether forces are constant in steps


def allowed(
    value: Real,
    tolerance: float,
    responses: Sequence[Point],
    *,
    driven: Real | float = 0.0,
    held: Flags | bool = False,
    rests: bool = False,
) -> Real:
    """Return the error of each response within a tolerance, beside what drives alone move.

    What is held counts beside the others; where all may rest, what is nothing may be all off.
    """
    most = np.abs(value).max(axis=1, initial=0.0)
    if rests:
        largest = of_kinds(np.maximum(most, driven), responses)
    else:
        largest = np.maximum(of_kinds(most, responses), driven)
    nothing = np.maximum(NOTHING * largest, np.finfo(float).tiny)
    own = tolerance * np.maximum(most, nothing)
    own = np.where(most <= nothing, nothing, own) if rests else own
    return np.maximum(np.where(held, tolerance * largest, own), np.finfo(float).tiny)


def rounding(value: Real, time: Real) -> Real:
    """Return what rounding leaves, as value: of what moves fast, phases are known to less."""
    most = np.abs(value).max(axis=1, initial=0.0)[:, None]
    slope = np.abs(np.diff(value) / np.diff(time)).max(axis=1, initial=0.0)[:, None]
    return np.asarray(ROUNDING * (most + slope * (time - time[0])))


def agree(
    system: LawSystem,
    tolerance: float,
    run: Run,
    watched: Sequence[Point],
    passage: type[LawPassage] = LawPassage,
) -> Agreed:
    """Halve the steps until two runs agree within the tolerance, and return the finer."""
    time, (system, own) = system.looks[0].time, system.looking_between()
    linear, h, every = system.without_laws(), system.first_step, system.looks[0].time
    driven = np.abs(linear[0][:, own]).max(axis=1, initial=0.0)
    span, worst = float(system.time[-1] - system.time[0]), np.inf
    coarse: Real | None = None
    last: Agreed | None = None
    runs, bent = Runs(), np.zeros(0)
    stages = hard = 0
    if span / h > MOST_STEPS:
        raise SolveError(f"{span:g} s take {span / h:.2g} steps at least, above {MOST_STEPS}")
    while True:
        passed = passage(system, h).passed(run.progress)
        if last is not None and isinstance(passed.error, KeyboardInterrupt):
            last.error = passed.error
            return last
        stages += passed.stages
        between, *looked = system.told([one + more for one, more in zip(linear, passed.looked)])
        looked = [between[:, own], *looked]
        found = Agreed(
            looked,
            np.full(looked[0].shape, np.inf),
            np.zeros(len(looked[0])),
            h,
            passed.reached,
            stages,
            len(system.modes.sigma),
            passed.error,
            passage is CoupledPassage,
        )
        if passed.error is None and coarse is not None:
            held = system.held(watched, passed.largest)
            rests = system.is_sharp
            most = allowed(looked[0], tolerance, watched, driven=driven, held=held, rests=rests)
            bends = (passed.bent > np.maximum(bent / BENDS, NOTHING)).any()
            falls = BENT_FALLS if bends else system.falls
            wrong = runs.apart(between, coarse, falls)
            if system.is_sharp and not system.jumps:
                wrong = since_they_differ(wrong, between)
            # of the step that is longer at a time, what came within it
            soon = np.searchsorted(every, time + system.finer * h, side="right") - 1
            found.step_error = reach(falls) * wrong[:, soon] + rounding(looked[0], time)
            found.step_error += system.unmoved(h, passed.size)[:, None]
            worst = tolerance * float((found.step_error / most[:, None]).max(initial=0.0))
            if worst <= tolerance:
                return _cancelled(found, system, tolerance, held)
        hard += not passed.settles
        if passed.error is not None and (passed.settles or hard > HARD):
            return found
        last = found if passed.error is None else None
        coarse, bent = between if passed.error is None else None, passed.bent
        h /= system.finer
        if span / h > MOST_STEPS:
            off = f"the error is {worst:.3g}" if worst <= 1 else "no digit of the motion is known"
            found.error = SolveError(
                f"tolerance {tolerance:g} needs more than {MOST_STEPS} steps: with "
                f"{round(span / h / system.finer)} {off}"
            )
            return found


def _cancelled(found: Agreed, system: LawSystem, tolerance: float, held: Flags) -> Agreed:
    """Add what rounding leaves of modes that cancel, as where motion has hardly begun."""
    size = system.sizes().sum(axis=1)
    found.step_error = found.step_error + ROUNDING * size[:, None]
    # what moves less is held
    most = np.maximum(np.abs(found.looked[0]).max(axis=1, initial=0.0), NOTHING * size)
    lost = (ROUNDING * size > tolerance * most) & ~held
    if lost.any():
        found.error = SolveError(
            f"of modes that cancel rounding leaves up to "
            f"{(ROUNDING * size[lost] / most[lost]).max():.1e} of the motion, not {tolerance:g}: "
            "it has hardly begun, or a mass holds it"
        )
    return found


def component_motion(
    run: Run, component: tuple[str, ...], points: list[Point], looks: list[OutputTimes]
) -> Agreed:
    """Take more modes until those left out do not show, where there are endless many."""
    tolerance = TOLERANCE if run.tolerance is None else run.tolerance
    watched = points[looks[0].output]
    if tension_of(run.model, component) is not None or not _is_smooth(run):
        coupled = CoupledSystem.coupled(run, component, points, looks)
        passage = StretchedPassage if coupled.is_plain else CoupledPassage
        return agree(coupled, tolerance, run, watched, passage)
    laws = laws_on(run.model, component)
    of = partial(LawSystem.of, run, component, laws, points, looks=looks)
    system = of(count=MODES)
    if not np.isfinite(system.beyond):
        return agree(system, tolerance, run, watched, LawPassage)
    return _of_endless(of, tolerance, run, watched)


def _of_endless(
    of: Callable[..., LawSystem], tolerance: float, run: Run, watched: list[Point]
) -> Agreed:
    """Take more of endless many modes until those left out do not show."""
    count = MODES
    _refuse_jumps(of, tolerance, watched, at_last=True)
    while True:
        system = of(count=count)
        near = _near(system, watched)
        found = agree(system.looking(near), tolerance, run, watched, LawPassage)
        if found.error is not None:
            found.looked.pop()
            return found
        fewer = of(count=count // 2).looking(near)
        passed = LawPassage(fewer, found.h).passed(run.progress)
        found.stages += passed.stages
        looked = [own + more for own, more in zip(fewer.without_laws(), passed.looked)]
        apart = _apart(looked, found.looked)
        found.looked.pop()
        found.truncation = HALVED * apart if passed.error is None else np.full(len(apart), np.inf)
        wrong = found.truncation + found.step_error.max(axis=1, initial=0.0)
        most = allowed(found.looked[0], tolerance, watched)
        worst = tolerance * float((wrong / most).max(initial=0.0))
        found.error = passed.error if passed.settles else None
        if found.error is not None or worst <= tolerance:
            return found
        if count == MODES:
            _refuse_jumps(of, tolerance, watched, at_last=False)
        if count >= MOST_MODES or count * found.stages > MOST_WORK:
            found.error = SolveError(
                f"tolerance {tolerance:g} needs more than {count} modes: with these the error is "
                f"{worst:.3g}"
            )
            return found
        count *= 2


def _apart(looked: list[Real], other: list[Real]) -> Real:
    """Return how far two runs are apart in what is asked for and near its times, (outputs,)."""
    both = [looked[k] - other[k] for k in (0, -1)]
    return np.asarray(np.abs(np.concatenate(both, axis=1)).max(axis=1, initial=0.0))


def _refuse_jumps(
    of: Callable[..., LawSystem], tolerance: float, watched: list[Point], *, at_last: bool
) -> None:
    """Refuse what drives alone make jump at a time that is asked for: no number of modes knows."""
    system = of(count=MODES)
    end = float(system.time[-1])
    jumps_last = _is_steep(system, watched) and system.pushed_at_once(
        end - NEAR / system.beyond, end
    )
    if jumps_last != at_last:
        return
    apart = []
    for count in (MODES, MORE * MODES):
        near = _near(of(count=count), watched, at_last)
        whole, half = (of(count=n).looking(near).without_laws() for n in (count, count // 2))
        apart.append(_apart(whole, half))
    jumps = apart[1] > np.maximum(apart[0] / 2, allowed(whole[0], tolerance, watched))
    if jumps.any():
        k = int(jumps.argmax())
        raise SolveError(
            f"what drives makes {watched[k]} jump at a time that is asked for: {MORE * MODES} "
            f"modes know it to {apart[1][k]:.1e}, half of them to as much; other times are answered"
        )


def _is_steep(system: LawSystem, watched: Sequence[Point]) -> bool:
    """Whether what is looked at may jump where forces do: displacements only bend."""
    return system.looks[0].order > 0 or any(map(is_force, watched))


def _near(system: LawSystem, watched: Sequence[Point], at_last: bool = False) -> Real:
    """Return times at which modes left out show too: before and after those of the first look."""
    time, begin, end = system.looks[0].time, float(system.time[0]), float(system.time[-1])
    step = NEAR / system.beyond
    breaks = np.sort(system.breaks)
    # of few between two jumps, such as after the last one, none may show them by chance
    piece = np.searchsorted(breaks, time, side="right")
    few = time[np.bincount(piece)[piece] < FEW]
    steps = step * np.arange(2, FAR + 1)
    near = np.concatenate([time + step, time - step, *(few + k for k in (*steps, *-steps))])
    # so short after a jump, or at its very time, no number of modes knows of it
    until = end if at_last else end - AT_ONCE * step
    past = _is_steep(system, watched) and system.pushed_at_once(end - step, until)
    return np.unique(np.clip(near, begin, end + step if past else end))


# --- the answer ---------------------------------------------------------------------------------


def collocate(run: Run) -> History:
    """Find the motion under smooth laws; see `Model.transient`."""
    model = run.model
    x = within(model.x, POINTS) if model.element == "continuous" else model.x
    answer = _Answer(run, x)
    for component in moving_together(model):
        answer.take(component)
    history = answer.history()
    error = answer.error
    if error is not None and (len(history.time) == 0 or not isinstance(error, STOPS)):
        raise error
    if error is not None and not run.partial:
        if isinstance(error, SolveError):
            error.history = history
        raise error
    return history


class _Answer:
    """What is asked, filled component by component."""

    def __init__(self, run: Run, x: Real) -> None:
        self.run, self.x = run, x
        shape = (len(run.responses), len(run.time))
        self.value, self.step_error = np.zeros(shape), np.zeros(shape)
        self.truncation = np.zeros(len(run.responses))
        seen = len(run.snapshots)
        self.snapshot = np.zeros((seen, len(x), len(run.model.coordinates)))
        self.stages = self.modes = 0
        self.method = "collocation"
        self.reached = float(run.time[-1])
        self.error: BaseException | None = None

    def take(self, component: tuple[str, ...]) -> None:
        """Add the motion of a component."""
        run = self.run
        acted = bool(acting_laws(run.model, component)) or tension_of(run.model, component)
        watched = [k for k, r in enumerate(run.responses) if carrier(run.model, r) in component]
        at = [run.model.coordinates.index(c) for c in component]
        if not acted:
            self._linear(component, watched, at)
            return
        seen = [(c, float(x)) for x in self.x for c in component] if len(run.snapshots) else []
        points = [*(run.responses[k] for k in watched), *seen]
        looks = [
            OutputTimes(slice(0, len(watched)), run.time, run.order),
            OutputTimes(slice(len(watched), len(points)), run.snapshots, 0),
        ]
        looks = [look for look in looks if look.output.start < look.output.stop]
        if not looks:
            return
        found = component_motion(run, component, points, looks)
        if watched:
            self.value[watched], self.step_error[watched] = found.looked[0], found.step_error
            self.truncation[watched] = found.truncation
        if seen:
            self.snapshot[:, :, at] = found.looked[-1].T.reshape(-1, len(self.x), len(component))
        self.stages, self.modes = self.stages + found.stages, self.modes + found.modes
        self.method = "steps" if found.by_steps else self.method
        if found.error is not None and found.reached < self.reached:
            self.reached = found.reached
        self.error = self.error or found.error

    def _linear(self, component: tuple[str, ...], watched: list[int], at: list[int]) -> None:
        run = self.run
        driven = [k for k, d in enumerate(run.drives) if moving(d) in component]
        loads = {p: load for p, load in run.loads.items() if p[0] in component}
        kicks = {p: kick for p, kick in run.kicks.items() if p[0] in component}
        if not driven and not loads and not kicks:
            return
        some = replace(
            run,
            drives=tuple(run.drives[k] for k in driven),
            forces=tuple(run.forces[k] for k in driven),
            responses=tuple(run.responses[k] for k in watched),
            loads=loads,
            kicks=kicks,
        )
        found = solve_linear(some)
        self.value[watched], self.step_error[watched] = found.value, found.error
        self.snapshot[:, :, at] = found.snapshot[:, :, at]
        self.modes += found.cost.unknowns

    def history(self) -> History:
        """Return all of it until the end that was reached."""
        run = self.run.kept
        kept = run.time <= self.reached if self.error is not None else np.isfinite(run.time)
        seen = run.snapshots <= self.reached
        asked = replace(run, time=run.time[kept], snapshots=run.snapshots[seen])
        value = self.value[:, kept]
        elements = len(run.model.x) - 1
        return History(
            **asked.told,
            value=value,
            x=self.x,
            snapshot=self.snapshot[seen],
            cost=Cost(self.method, elements, self.modes, self.stages),
            balance=partial(of_chain, asked),
            error=self.step_error[:, kept] + self.truncation[:, None],
            mesh_error=partial(against_spans, asked.kept, value, collocate),
            stopped=ended_by(self.error),
        )
