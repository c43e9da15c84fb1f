"""Components that move in a run, each with its states and laws."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...base.array import Real
from ...base.errors import SceneError
from ...chain import tip
from ...chain.compiled import Compiled
from ...chain.port import Point, moving
from ...response.moved_end import is_end
from ...scene.tension import Tension
from ..acting import scene_laws
from ..request import Run
from ..states import softens, states, why_coupled, without_dashpots
from .phase import PhaseSystem, extras, phase_laws
from .pieces import is_chirp
from .walk import Instant


class Look(NamedTuple):
    """What is asked of a motion."""

    points: tuple[Point, ...]
    time: Real  # (t,) [s]
    order: int  # how often displacements are differentiated


@dataclass(frozen=True, eq=False)
class Moving:
    """One component that moves in a run."""

    system: PhaseSystem
    drives: list[int]  # Which of the run's drives
    loads: list[float]  # that are let go
    # of each look the outputs that are on it, and which of its points these are
    watched: list[tuple[slice, list[int]]]

    @property
    def is_whole(self) -> bool:
        """Whether no mode is left out."""
        return not np.isfinite(self.system.states.beyond)


def moving_components(
    run: Run, looks: Sequence[Look], modes: int, *, other: bool = False
) -> list[Moving]:
    """Return the components that are pushed; see `states`."""
    model, found = run.model, []
    for component in model.components:
        drives = [k for k, d in enumerate(run.drives) if moving(d) in component]
        loads = {p: load for p, load in run.loads.items() if p[0] in component}
        if not drives and not loads:
            continue
        watched, seen = _watched(model, component, looks)
        laws = phase_laws(model, component)
        inputs: list[Any] = [*(run.drives[k] for k in drives), *loads, *laws.points]
        outputs: list[Point] = [*seen, *laws.points]
        st = states(model, component, inputs, outputs, modes=modes, other=other)
        begin, span = float(run.time[0]), float(run.time[-1] - run.time[0])
        system = PhaseSystem(st, laws, len(drives), len(loads), len(seen), begin, span)
        found.append(Moving(system, drives, list(loads.values()), watched))
    return found


def _watched(
    model: Compiled, component: tuple[str, ...], looks: Sequence[Look]
) -> tuple[list[tuple[slice, list[int]]], list[Point]]:
    """Return what each look sees of a component, and all that is seen."""
    seen: list[Point] = []
    watched = []
    for look in looks:
        which = [k for k, p in enumerate(look.points) if tip.carrier(model, p) in component]
        watched.append((slice(len(seen), len(seen) + len(which)), which))
        seen += [look.points[k] for k in which]
    return watched, seen


def rest(one: Moving, nudge: float) -> Instant:
    """Return the rest under loads that are let go."""
    st, system = one.system.states, one.system
    load = np.zeros(st.push.shape[1])
    load[system.drives : system.first] = np.array(one.loads) * (1 + nudge)
    if load.any() and not (st.square > 0).all():
        raise SceneError("start must be None where the rope has no rest under a load")
    q = (st.push @ load) / np.where(st.square == 0, 1.0, st.square)
    u = st.seen[system.responses :] @ q + (st.now + st.late)[system.responses :] @ load
    own = extras(system)
    e = load[own] if system.late else u[[i - system.first for i in own]]
    contacts = len(system.laws.contacts)
    hold = u[contacts : contacts + len(system.laws.frictions)]
    return Instant(q, np.zeros_like(q), e, hold)


def why_not_events(run: Run) -> str:
    """Say what phases do not take, with nothing where they take all."""
    model = run.model
    if run.coarse is not None:
        return "start and velocity must not be functions of x on continuous spans"
    for one in scene_laws(model.scene):
        if not (one.law.kind == "stop" or (one.law.kind == "power" and one.law.value[1] == 0)):
            part = model.scene.parts[one.part]
            return f"{one.name} must be a stop, friction or linear, got {part}"
    tension = model.scene.tension
    if isinstance(tension, Tension) and (tension.pulsates or tension.stretching):
        return f"tension must not change, got {tension}"
    if any(map(is_chirp, run.forces)):
        return "force must not be a Chirp"
    return next(filter(None, (_why_damping(run, c) for c in model.components)), "")


def _why_damping(run: Run, component: tuple[str, ...]) -> str:
    """Say how a component must be damped, with nothing where it is."""
    damped = why_coupled(without_dashpots(run.model, component)[0], component)
    moved = [place for place in run.places if is_end(place) and moving(place) in component]
    if damped or not moved or not softens(run.model, component):
        return damped
    return f"drive must not be the motion of an end where stiffness is damped, got {moved}"
