"""Where the energy is while stops and friction act.

kinetic    sum of q'^2/2,       strain   sum of square q^2/2 and of what modes leave out, f R f/2
laws       k (u - gap)^2/2 of stops less what it was,   input   integral of f u' and jumps
dissipated integral of 2 sigma q'^2, of F |u'| where friction slips, of f^2/c of dashpots,
and of gamma l' R l' of what modes leave out
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...base.array import Real
from ...base.errors import SceneError
from ...scene.force import Force
from ..history import Balance
from ..modal.energy_balance import divided, refuse_moved_ends
from ..request import Run
from .components import Look, Moving, moving_components, rest
from .pieces import pieces
from .walk import PhaseWalk, Visit

NAMES = ("kinetic", "strain", "input", "dissipated", "laws")
NODES, WEIGHTS = np.polynomial.legendre.leggauss(8)
TURN = 2.0  # Between two times of a rule of Gauss the fastest motion turns by this angle.
RELAXED = 2.0 ** np.arange(-1, 6)  # What modes leave out follows a jump in so many of its times.
FAINT = 1e-14  # Motion with less than this part of the energy is not resolved.


class _Seen(NamedTuple):
    """A component at times since the start of a visit."""

    q: Real
    v: Real
    u: Real  # displacements of drives, loads and laws
    speed: Real
    force: Real  # of all inputs, of drives as the forces say
    relaxed: Real  # (extras, t)
    relaxing: Real  # (extras, t)


def balance(run: Run, modes: int) -> Balance:
    """Return the energies at the times of a run."""
    refuse_moved_ends(run)
    points = (*run.drives, *run.loads)
    asked = replace(run, responses=points, order=0)
    total = np.zeros((len(NAMES), len(run.time)))
    has_stops = False
    for one in moving_components(asked, [Look(points, run.time, 0)], modes):
        total += _component(asked, one)
        has_stops = has_stops or bool(one.system.laws.contacts)
    energy = dict(zip(NAMES, total))
    if not has_stops:
        del energy["laws"]
    return Balance(energy)


def _component(run: Run, one: Moving) -> Real:
    """Return the energies of one component, (names, t)."""
    result = np.zeros((len(NAMES), len(run.time)))
    done = np.zeros(2)  # input and dissipated
    before, pressed = None, 0.0
    forces = [run.forces[k] for k in one.drives]
    _refuse_infinite(one, forces, run.time)
    time = run.time - run.time[0]
    for visit in PhaseWalk(one.system).visits(rest(one, 0.0), pieces(forces, run.time)):
        edges = _edges(one, visit, time)
        stored = _stored(one, _look(one, visit, edges))
        if before is None:
            rested = _stored(one, _at_rest(one, visit))
            before, pressed = rested.sum(), float(rested[2, 0])
        done[0] += stored[:, 0].sum() - before
        before = stored[:, -1].sum()
        nodes = (edges[:-1, None] + np.multiply.outer(np.diff(edges), (NODES + 1) / 2)).ravel()
        power = _powers(one, visit, _look(one, visit, nodes))
        each = power.reshape(2, -1, len(NODES)) @ (WEIGHTS / 2) * np.diff(edges)
        gone = done[:, None] + np.concatenate([np.zeros((2, 1)), each.cumsum(axis=1)], axis=1)
        done = gone[:, -1]
        i, j = np.searchsorted(time, [visit.start, visit.stop])
        j += int(visit.stop >= time[-1])
        at = np.minimum(np.searchsorted(edges, time[i:j] - visit.start), len(edges) - 1)
        result[:2, i:j], result[4, i:j] = stored[:2, at], stored[2, at] - pressed
        result[2:4, i:j] = gone[:, at]
    return result


def _refuse_infinite(one: Moving, forces: list[Force], time: Real) -> None:
    """Refuse blows at an instant on flexibility that relaxes, which take an infinite energy."""
    system = one.system
    yields = np.diag(system.states.late[:, : system.drives])
    for force, give in zip(forces, yields):
        if give and any(time[0] <= at <= time[-1] for at, _ in force.blows):
            raise SceneError(
                "energy is not told where a blow at an instant hits between nodes and stiffness is "
                f"damped, which takes an infinite one, got {force}"
            )


def _edges(one: Moving, visit: Visit, time: Real) -> Real:
    """Return the times of a visit since its start, so many that its motion is resolved."""
    lasts = visit.stop - visit.start
    soon = one.system.states.gamma * RELAXED * one.system.late
    inside = np.concatenate([soon, time - visit.start])
    inside = inside[(inside > 0) & (inside < lasts)]
    edges = np.unique(np.concatenate([[0.0], inside, [lasts]]))
    rate, own = np.abs(visit.phase.poles.rate), visit.driven.own
    right = visit.phase.poles.right[: visit.phase.matrices.E.shape[1]]
    size = np.abs(right * own).max(axis=0, initial=0.0)
    share = (rate * size) ** 2
    fast = rate[share > FAINT * share.max(initial=0.0)].max(initial=0.0)
    fast = max(fast, np.abs(visit.driven.push.rate).max(initial=0.0))
    parts = np.maximum(1, np.ceil(np.diff(edges) * fast / TURN)).astype(np.intp)
    return np.append(divided(edges, parts)[0], edges[-1])


def _look(one: Moving, visit: Visit, since: Real) -> _Seen:
    system = one.system
    state, seen = visit.state(), visit.outputs
    k, laws = system.states.modes, len(system.laws.points)
    x, y = state.at(since), seen.at(since)
    speed = seen.derivative().some(slice(0, system.responses + laws)).at(since)
    given = np.zeros((system.first, len(since)))
    given[: system.drives] = visit.driven.push.at(since)  # at its end what acts until then
    force = np.concatenate([given, y[system.responses + laws :]])
    slow = state.derivative().some(slice(2 * k, None)).at(since)
    return _Seen(x[:k], x[k : 2 * k], y[: len(speed)], speed, force, x[2 * k :], slow)


def _at_rest(one: Moving, visit: Visit) -> _Seen:
    """Look at the start of the first visit before anything drives."""
    seen, system = _look(one, visit, np.zeros(1)), one.system
    push = visit.driven.push.at(np.zeros(1))
    y = visit.phase.matrices.Dd @ push
    force = np.concatenate([push, np.zeros((system.loads, 1)), y[len(seen.u) :]])
    return seen._replace(v=0 * seen.v, u=seen.u - y[: len(seen.u)], force=seen.force - force)


def _stored(one: Moving, seen: _Seen) -> Real:
    """Return kinetic energy, strain and that of stops, (3, t)."""
    st, laws = one.system.states, one.system.laws
    strain = (st.square[:, None] * seen.q**2).sum(axis=0) / 2
    if one.system.late:
        strain += np.einsum("it,ij,jt->t", seen.relaxed, st.late, seen.relaxed) / 2
    strain += np.einsum("it,ij,jt->t", seen.force, st.now, seen.force) / 2
    stops = np.zeros_like(strain)
    for k, stop in enumerate(laws.contacts):
        pressed = np.maximum(stop.side * seen.u[one.system.responses + k] - stop.gap, 0.0)
        stops += stop.stiffness / 2 * pressed**2
    return np.stack([(seen.v**2).sum(axis=0) / 2, strain, stops])


def _powers(one: Moving, visit: Visit, seen: _Seen) -> Real:
    """Return the powers of what drives and of what takes, (2, t)."""
    system = one.system
    st, laws = system.states, system.laws
    put = (seen.force[: system.drives] * seen.speed[: system.drives]).sum(axis=0)
    taken = (2 * st.sigma[:, None] * seen.v**2).sum(axis=0)
    if system.late:
        taken += st.gamma * np.einsum("it,ij,jt->t", seen.relaxing, st.late, seen.relaxing)
    first = system.responses + len(laws.contacts)
    for k, friction in enumerate(laws.frictions):
        if visit.phase.mode[len(laws.contacts) + k]:
            taken += friction.force * np.abs(seen.speed[first + k])
    for k, dashpot in enumerate(laws.dashpots):
        taken += seen.force[system.first + system.damped.start + k] ** 2 / dashpot.damping
    return np.stack([put, taken])
