"""Which method follows a motion."""

from __future__ import annotations

from .direct.direct import march
from .history import History
from .linear import solve_linear
from .phases.components import why_not_events
from .phases.events import solve_events
from .request import EVENTS, Run
from .smooth.smooth import collocate, takes


def follow_motion(run: Run) -> History:
    """Return the motion by the method that was asked for; see `Model.transient`."""
    # steps where they are asked for, and where phases do not take the scene
    if run.method == EVENTS or (run.method == "auto" and run.direct and not why_not_events(run)):
        return solve_events(run)
    if run.direct and takes(run):
        return collocate(run)
    return march(run) if run.direct else solve_linear(run)
