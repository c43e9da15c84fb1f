"""Which method follows a motion."""

from __future__ import annotations

from contextlib import suppress
from typing import cast

from ..base.check import NEAR
from ..base.errors import SceneError, SolveError
from .history import History
from .linear import resists_beside_ratios, solve_linear
from .modal.convolution import refuse_infinite
from .phases.components import why_not_events
from .phases.events import solve_events
from .request import EVENTS, Run
from .smooth.smooth import collocate, takes
from .volterra import integrate


def _by_events(run: Run) -> History:
    """Return the motion from event to event, or by another method that is sure of all of it."""
    try:
        return solve_events(run, whole=True)
    except SolveError as refusal:
        with suppress(SceneError, SolveError):
            return integrate(run.but(partial=False))
        if run.partial and refusal.history is not None:
            return cast("History", refusal.history)
        raise


def _refuse_last_blow(run: Run) -> None:
    """Refuse a blow after which no law is asked any more."""
    last = float(run.time[-1])
    near = last - NEAR * (last - float(run.time[0]))
    for k, force in enumerate(run.forces):
        if any(near <= when <= last for when, _ in force.blows):
            raise SceneError(
                f"force[{k}] must not be a blow at the last time where motion is not linear, got "
                f"one at {last!r} s: a later time tells what it does"
            )


def follow_motion(run: Run) -> History:
    """Return the motion by the method that was asked for; see `Model.transient`."""
    if not run.is_linear:
        _refuse_last_blow(run)
    history = _followed(run)
    refuse_infinite(history.value, history.time)
    return history


def _followed(run: Run) -> History:
    if run.method == EVENTS:
        return solve_events(run)
    if run.is_linear and not resists_beside_ratios(run):
        return solve_linear(run)
    if not why_not_events(run):
        return _by_events(run)
    return collocate(run) if takes(run) else integrate(run)
