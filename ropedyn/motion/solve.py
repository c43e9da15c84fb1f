"""Which method follows a motion."""

from __future__ import annotations

from .direct.direct import march
from .history import History
from .modal.superposition import superpose
from .phases.components import why_not_events
from .phases.events import solve_events
from .request import EVENTS, Run


def follow_motion(run: Run) -> History:
    """Return the motion by the method that was asked for; see `Model.transient`."""
    if run.method == EVENTS or (run.method == "auto" and run.direct and _has_phases(run)):
        return solve_events(run)
    return march(run) if run.direct else superpose(run)


def _has_phases(run: Run) -> bool:
    """Whether phases answer where nothing asks for steps."""
    return run.step is None and run.spectral_radius == 1 and not why_not_events(run)
