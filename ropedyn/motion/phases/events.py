"""Motion over time of scenes whose laws are linear between events."""

from __future__ import annotations

import time as clock
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...base.answer import Cost
from ...base.array import Index, Real
from ...base.errors import SceneError
from ...chain.port import Point, moving
from ...response.moved_end import is_end
from ..history import Balance, Deviation, History
from ..request import Run
from ..states import states
from .laws import PhaseLaws, phase_laws
from .phase import PhaseSystem, extras
from .pieces import pieces
from .walk import Instant, Walk

MODES = 64  # Of continuous spans and long chains.


@dataclass(frozen=True, eq=False)
class Moving:
    """One component that moves in a run."""

    system: PhaseSystem
    drives: list[int]  # Which of the run's drives
    loads: list[float]  # that are let go
    responses: list[int]  # Which of the run's responses


def moving_components(run: Run, modes: int) -> list[Moving]:
    """Return the components that are pushed."""
    model, found = run.model, []
    for component in model.components:
        drives = [k for k, d in enumerate(run.drives) if moving(d) in component]
        loads = {p: load for p, load in run.loads.items() if p[0] in component}
        watched = [k for k, r in enumerate(run.responses) if moving(r) in component]
        if not drives and not loads:
            continue
        laws = phase_laws(model, component)
        inputs: list[Any] = [*(run.drives[k] for k in drives), *loads, *laws.points]
        outputs: list[Point] = [*(run.responses[k] for k in watched), *laws.points]
        st = states(model, component, inputs, outputs, modes=modes)
        if st.late.any() and any(map(is_end, inputs)):
            raise SceneError("drive must not be the motion of an end where stiffness is damped")
        span = float(run.time[-1] - run.time[0])
        system = PhaseSystem(st, laws, len(drives), len(loads), len(watched), span)
        found.append(Moving(system, drives, list(loads.values()), watched))
    return found


def _start(one: Moving) -> Instant:
    """Return the rest under loads that are let go."""
    st, system = one.system.states, one.system
    load = np.zeros(st.push.shape[1])
    load[system.drives : system.first] = one.loads
    if load.any() and not (st.square > 0).all():
        raise SceneError("start must be None where the rope has no rest under a load")
    q = (st.push @ load) / np.where(st.square == 0, 1.0, st.square)
    u = st.seen[system.responses :] @ q + (st.now + st.late)[system.responses :] @ load
    own = extras(system)
    e = load[own] if system.late else u[[i - system.first for i in own]]
    contacts = len(system.laws.contacts)
    hold = u[contacts : contacts + len(system.laws.frictions)]
    return Instant(q, np.zeros_like(q), e, hold)


def follow(run: Run, modes: int) -> tuple[Real, list[Walk]]:
    """Return the responses, (responses, t), and what happened."""
    value = np.zeros((len(run.responses), len(run.time)))
    walks = []
    for one in moving_components(run, modes):
        walk = Walk(one.system)
        walks.append(walk)
        forces = [run.forces[k] for k in one.drives]
        rows = slice(0, one.system.responses)
        for visit in walk.visits(_start(one), pieces(forces, run.time)):
            last = visit.stop >= run.time[-1]
            i = int(np.searchsorted(run.time, visit.start))
            j = int(np.searchsorted(run.time, visit.stop, side="right" if last else "left"))
            if i == j:
                continue
            course = visit.outputs.some(rows)
            for _ in range(run.order):
                course = course.derivative()
            value[one.responses, i:j] = course.at(run.time[i:j] - visit.start)
    return value, walks
