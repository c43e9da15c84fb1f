"""Motion over time of scenes whose laws are linear between events."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from ...base.answer import Cost
from ...base.array import Real
from ...base.errors import SceneError, SolveError
from ...eigen.vectors import within
from ...response.deflection import POINTS
from ..history import History, ended_by
from ..modal.convolution import refuse_infinite
from ..moved import against_spans
from ..request import TOLERANCE, Run
from ..undamped import ROUND
from .components import Look, moving_components, rest, why_not_events
from .energy import balance
from .pieces import pieces
from .walk import PhaseWalk, Visit

MODES, MOST = 64, 128  # Of continuous spans and long chains, at first and at most.
ROUGH = 4.0  # Rounding moves other states by more than this part of what it does.
NUDGE = 1e-11 / ROUGH  # It is at most 1e-11 of what drives.
OFF = 64 * np.finfo(float).eps  # Squares of poles are known to this part.
MARGIN = 2.0  # Half the modes are off by more than all of them, at least by this.
ROUNDED = 256 * np.finfo(float).eps  # Of the modes that move a point, what rounding moves it.
HELD = 1e-9  # Of the modes that move a point: where it moves less, it is held.
FIRST = 8  # So many times tell together how far the first of them are off.


class Followed(NamedTuple):
    """A motion."""

    seen: list[Real]  # (points, t) of each look
    # (3, points) of the modes that these are the sum of, what rounding of shapes does to these, and
    size: list[Real]  # of as much as these may move
    events: list[float]  # [s]
    whole: bool  # whether no mode is left out
    modes: int
    until: float = math.inf  # when Ctrl-C ended it [s]


def follow(run: Run, looks: Sequence[Look], modes: int, nudge: float = 0.0) -> Followed:
    """Return what is seen, (points, t) of each look, of a motion whose push is nudged."""
    seen = [np.zeros((len(one.points), len(one.time))) for one in looks]
    sizes = [np.zeros((3, len(one.points))) for one in looks]
    events: list[float] = []
    first = float(run.time[0])  # ulps of late times would be rounding of the motion
    looks = [one._replace(time=one.time - first) for one in looks]
    whole, until = True, math.inf
    components = moving_components(run, looks, modes, other=nudge > 0)
    for one in components:
        walk, reached = PhaseWalk(one.system, OFF if nudge else 0.0), 0.0
        forces, st = [run.forces[k] for k in one.drives], one.system.states
        shapes = np.stack([st.seen, st.wrong * st.seen, st.reach])
        try:
            for visit in walk.visits(rest(one, nudge), pieces(forces, run.time, nudge)):
                is_last = visit.stop >= one.system.span
                for look, value, size, (rows, which) in zip(looks, seen, sizes, one.watched):
                    moved = visit.size(shapes[:, rows], look.order)
                    size[:, which] = np.maximum(size[:, which], moved)
                    _record(visit, look, value, rows=rows, which=which, last=is_last)
                reached = visit.stop
                run.progress(min(1.0, reached / one.system.span))
        except KeyboardInterrupt:
            # of components that were not followed nothing is known
            until = first + (reached if one is components[-1] else 0.0)
            break
        events += [at for at, _ in walk.events]
        whole = whole and one.is_whole
    return Followed(seen, sizes, sorted(events), whole, modes, until)


def _record(
    visit: Visit, look: Look, value: Real, *, rows: slice, which: list[int], last: bool
) -> None:
    """Keep what a look sees of a phase."""
    i = int(np.searchsorted(look.time, visit.start))
    j = int(np.searchsorted(look.time, visit.stop, side="right" if last else "left"))
    if i == j or not which:
        return
    course = visit.outputs.some(rows)
    for _ in range(look.order):
        course = course.derivative()
    moved = course.at(look.time[i:j] - visit.start)
    value[which, i:j] = refuse_infinite(moved, look.time[i:j])


# --- how far it is right ------------------------------------------------------------------------


def solve_events(run: Run, *, whole: bool = False) -> History:
    """Follow the motion from event to event, `whole` or not at all; see `Model.transient`."""
    why = why_not_events(run)
    if why:
        raise SceneError(f'{why} where the method is "events"')
    asked, run = run, run.struck
    x = within(run.model.x, POINTS) if run.model.element == "continuous" else run.model.x
    points = tuple((c, float(at)) for at in x for c in run.model.coordinates)
    looks = [Look(run.responses, run.time, run.order)]
    if len(run.snapshots):
        looks.append(Look(points, run.snapshots, 0))
    found, error = _within(run, looks)
    sure = _sure_until(run, found, error)
    error[:, run.time > sure] = np.inf
    width = len(run.model.coordinates)
    kept = found.seen[1] if len(looks) > 1 else np.zeros((len(points), 0))
    stopped = KeyboardInterrupt() if math.isfinite(found.until) else None
    known, shown = run.time < found.until, run.snapshots < found.until
    if stopped is not None and not (run.partial and known.any()):
        raise stopped
    run = run.but(time=run.time[known], snapshots=run.snapshots[shown])
    asked = asked.but(time=run.time, snapshots=run.snapshots)
    value, error, kept = found.seen[0][:, known], error[:, known], kept[:, shown[: kept.shape[1]]]
    history = History(
        **asked.kept.told,
        value=value,
        x=x,
        snapshot=np.ascontiguousarray(kept.T).reshape(-1, len(x), width),
        cost=Cost("events", len(run.model.x) - 1, found.modes),
        balance=partial(balance, run.kept, found.modes),
        error=error,
        mesh_error=partial(against_spans, asked.kept.but(partial=True), value, solve_events),
        sure_until=sure,
        stopped=ended_by(stopped),
    )
    if stopped is not None or math.isinf(sure) or (run.partial and not whole):
        return history
    least, many = run.tolerance or TOLERANCE, len(found.events)
    why = (
        "what is left out and rounding grow from contact to contact. A larger tolerance or a "
        "shorter time help"
        if many
        else "what these leave out is more. A larger tolerance or a smoother force help"
    )
    refusal = SolveError(
        f"the motion is known to {least:g} of its largest value until t = {sure:.6g} s, by "
        f"{found.modes} modes and {many} events: {why}, and partial=True returns it with infinite "
        "errors after that"
    )
    refusal.history = history
    raise refusal


def _within(run: Run, looks: Sequence[Look]) -> tuple[Followed, Real]:
    """Return the motion and the error that modes and rounding cause, as its first look.

    It is followed once more, with half the modes, or where there are all with other rounding.
    """
    least = run.tolerance or TOLERANCE
    modes = run.modes or MODES
    coarse = follow(run, looks[:1], max(modes // 2, 1), NUDGE)
    if math.isfinite(coarse.until):
        seen = [np.zeros((len(one.points), len(one.time))) for one in looks[1:]]
        found = coarse._replace(seen=[*coarse.seen, *seen])
        return found, np.full(found.seen[0].shape, np.inf)
    if coarse.whole:
        found = follow(run, looks, modes // 2)
        return found, _running(ROUGH * (found.seen[0] - coarse.seen[0])) + _rounding(found)
    while True:
        found = follow(run, looks, modes)
        error = _running(MARGIN * (found.seen[0] - coarse.seen[0])) + _rounding(found)
        ends = bool(run.modes) or 2 * modes > MOST or math.isfinite(found.until)
        if ends or (error <= _allowed(found, least)).all():
            return found, error
        coarse, modes = found, 2 * modes


def _running(difference: Real) -> Real:
    """Return the largest difference up to each time: what is off does not come back.

    At the first times alone it may be small by chance.
    """
    size = np.abs(difference)
    size[:, :FIRST] = size[:, :FIRST].max(axis=1, keepdims=True, initial=0.0)
    return np.maximum.accumulate(size, axis=1)


def _rounding(found: Followed) -> Real:
    """Return what rounding leaves of modes that cancel, as where a point is held."""
    size, shaped, _ = found.size[0]
    return (ROUNDED * size + shaped)[:, None]


def _allowed(found: Followed, tolerance: float) -> Real:
    """Return the error within a tolerance, (responses, 1); of what is still what makes it so."""
    value, (size, _, reach) = np.abs(found.seen[0]).max(axis=1, initial=0.0), found.size[0]
    nothing = np.maximum(HELD * size, ROUND * reach)
    return np.where(value > nothing, tolerance * value, nothing)[:, None]


def _sure_until(run: Run, found: Followed, error: Real) -> float:
    """Return the last time at which the error of every response is within the tolerance."""
    wrong = ~(error <= _allowed(found, run.tolerance or TOLERANCE)).all(axis=0)
    if not wrong.any():
        return math.inf
    return float(run.time[max(int(wrong.argmax()) - 1, 0)])
