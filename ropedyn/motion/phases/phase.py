"""A scene between two events: linear, with poles of its own, in closed form.

With the states q, law forces f_A (stops in contact, friction that holds, dashpots) and those that
are known (drives f_d, friction that slips) a phase is

    x' = A x + B_d f_d + B_s s,    y = Y x + D_d f_d + D_s s,    s = (1, u_0 of each friction).

x is (r, r', e): q = E r + b u_0, where friction holds points whose motion is all in the modes, so
that nothing but a constraint can hold them, and E = 1 elsewhere. e are the left-out modes' relaxing
flexibilities l, or where those are stiff and dashpots stand there, their displacements u_d. f_A are
told by one line each,

    stop        f + k u = k side gap
    friction    u = u_0, or of relaxing flexibility u' = 0, or of none B^T q'' = 0
    dashpot     f + c u' = 0, or on stiff flexibility u = u_d, c u_d' + f = 0.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...base.array import Flags, Real
from ...chain.compiled import Compiled
from ...chain.port import Point
from ..acting import acting_laws
from ..states import Resistance, States, without_dashpots

STIFF = 1e-6  # Of left-out flexibility below this part of the own of its point forces are noise.


class Contact(NamedTuple):
    """A stop."""

    point: Point
    stiffness: float  # [N/m, N m]
    gap: float  # [m, rad]
    side: float  # 1 or -1


class Friction(NamedTuple):
    """Coulomb's friction."""

    point: Point
    force: float  # [N, N m]


class PhaseLaws(NamedTuple):
    """All laws of a component at points that can move."""

    contacts: tuple[Contact, ...]
    frictions: tuple[Friction, ...]  # one for each point
    dashpots: tuple[Resistance, ...]

    @property
    def points(self) -> tuple[Point, ...]:
        """Where they act, in this order."""
        return tuple(one.point for some in self for one in some)


def phase_laws(model: Compiled, component: tuple[str, ...]) -> PhaseLaws:
    """Return the laws of a component."""
    contacts: list[Contact] = []
    friction: dict[Point, float] = {}
    for _, point, law in acting_laws(model, component):
        if law.kind == "stop":
            contacts.append(Contact(point, *law.value))
        else:
            friction[point] = friction.get(point, 0.0) + law.value[0]
    _, dashpots = without_dashpots(model, component)
    frictions = tuple(Friction(point, force) for point, force in friction.items())
    return PhaseLaws(tuple(contacts), frictions, dashpots)


@dataclass(frozen=True, eq=False)
class PhaseSystem:
    """States and laws of one component; see `phase_of`."""

    states: States
    laws: PhaseLaws
    drives: int  # inputs of the states: these first,
    loads: int  # then loads that were let go, then laws
    responses: int  # outputs of the states: these first, then the laws' points
    begin: float  # The first time that the motion is asked for [s]
    span: float  # and how long from then on

    @property
    def first(self) -> int:
        """The first input that is a law."""
        return self.drives + self.loads

    @property
    def late(self) -> bool:
        """Whether left-out flexibility relaxes."""
        return bool(self.states.late.any())

    @property
    def soft(self) -> Flags:
        """Which laws stand on flexibility of left-out modes, shape (laws,)."""
        s = self.states
        at = np.arange(len(self.laws.points))
        rest = (s.now + s.late)[self.responses + at, self.first + at]
        own = (s.push[:, self.first :] ** 2 / np.maximum(np.abs(s.square), 1e-300)[:, None]).sum(0)
        return np.asarray(np.abs(rest) > STIFF * own)

    @property
    def damped(self) -> range:
        """Laws that are dashpots."""
        first = len(self.laws.contacts) + len(self.laws.frictions)
        return range(first, first + len(self.laws.dashpots))


class Matrices(NamedTuple):
    """A phase as in the head of the file."""

    E: Real  # (k, r)
    b: Real  # (k, frictions)
    A: Real  # (n, n)
    Bd: Real  # (n, drives)
    Bs: Real  # (n, 1 + frictions)
    Y: Real  # (outputs, n): responses, displacement u and force f of each law
    Dd: Real  # (outputs, drives)
    Ds: Real  # (outputs, 1 + frictions)


def extras(system: PhaseSystem) -> list[int]:
    """Return which inputs have a state of their own beside the modes."""
    if system.late:
        return list(range(system.states.late.shape[1]))
    soft = system.soft
    return [system.first + k for k in system.damped if soft[k]]


class _Rows:
    """Linear functions of (q, q', e, f_A, f_d, s), as rows over them, one after another."""

    def __init__(self, system: PhaseSystem, active: list[int]) -> None:
        k, own = system.states.modes, extras(system)
        sizes = [k, k, len(own), len(active), system.drives, 1 + len(system.laws.frictions)]
        at = np.cumsum([0, *sizes])
        self.q, self.v, self.e, self.f, self.d, self.s = (
            slice(i, j) for i, j in pairwise(at.tolist())
        )
        self.width = int(at[-1])

    def none(self, count: int) -> Real:
        """Return rows of zeros."""
        return np.zeros((count, self.width))


def matrices(system: PhaseSystem, mode: tuple[int, ...]) -> Matrices:
    """Assemble a phase; `mode` is 1 for stops in contact, 0 for holding, +-1 for slipping."""
    st, laws = system.states, system.laws
    contacts, frictions = len(laws.contacts), len(laws.frictions)
    active = [k for k in range(contacts) if mode[k]]
    sticking = [contacts + k for k in range(frictions) if not mode[contacts + k]]
    active += sticking + list(system.damped)
    rows, soft, own = _Rows(system, active), system.soft, extras(system)
    force = _forces(system, mode, active, rows)
    u = _outputs(system, rows, force, slice(system.responses, None))
    y = _outputs(system, rows, force, slice(0, system.responses))
    acceleration = rows.none(st.modes)
    acceleration[:, rows.q] = -np.diag(st.square)
    acceleration[:, rows.v] = -np.diag(2 * st.sigma)
    acceleration += st.push @ force
    extra = rows.none(len(own))
    for n, i in enumerate(own):
        if system.late:
            extra[n] = force[i] / st.gamma
            extra[n, rows.e.start + n] -= 1 / st.gamma
        else:
            c = laws.dashpots[i - system.first - system.damped.start].damping
            extra[n] = -force[i] / c
    lines = _lines(system, mode, active, rows, u=u, acceleration=acceleration, extra=extra)
    fixed = [k for k in sticking if not soft[k]]
    E, b = _constrained(system, fixed, contacts)
    solved = _solved(lines, rows)
    whole = np.concatenate([E.T @ acceleration, extra, y, u, force[system.first :]])
    known = np.concatenate([whole[:, : rows.f.start], whole[:, rows.f.stop :]], axis=1)
    known += whole[:, rows.f] @ solved
    return _reduced(system, rows, known, E, b)


def _forces(system: PhaseSystem, mode: tuple[int, ...], active: list[int], rows: _Rows) -> Real:
    """Return every input of the states as a row."""
    force = rows.none(system.states.push.shape[1])
    force[: system.drives, rows.d] = np.eye(system.drives)
    for n, k in enumerate(active):
        force[system.first + k, rows.f.start + n] = 1.0
    contacts = len(system.laws.contacts)
    for k, friction in enumerate(system.laws.frictions):
        if mode[contacts + k]:
            force[system.first + contacts + k, rows.s.start] = -mode[contacts + k] * friction.force
    return force


def _outputs(system: PhaseSystem, rows: _Rows, force: Real, which: slice) -> Real:
    st = system.states
    y = st.now[which] @ force
    y[:, rows.q] += st.seen[which]
    y[:, rows.v] += st.swept[which]
    if system.late:
        y[:, rows.e] += st.late[which]
    return np.asarray(y)


def _lines(
    system: PhaseSystem,
    mode: tuple[int, ...],
    active: list[int],
    rows: _Rows,
    *,
    u: Real,
    acceleration: Real,
    extra: Real,
) -> Real:
    """Return the lines that tell the forces, each a row that is zero."""
    st, laws, soft = system.states, system.laws, system.soft
    contacts, frictions = len(laws.contacts), len(laws.frictions)
    push = st.push[:, system.first :]
    gripped = {laws.points[k] for k in active if contacts <= k < contacts + frictions}
    line = rows.none(len(active))
    for n, k in enumerate(active):
        f = np.zeros(rows.width)
        f[rows.f.start + n] = 1.0
        speed = np.zeros(rows.width)
        speed[rows.v] = push[:, k]
        if system.late:
            speed += st.late[system.responses + k] @ extra
        if k < contacts:
            stop = laws.contacts[k]
            line[n] = f / stop.stiffness + u[k]
            line[n, rows.s.start] -= stop.side * stop.gap
        elif k < contacts + frictions:
            if not soft[k]:
                line[n] = push[:, k] @ acceleration
            elif system.late:
                line[n] = speed
            else:
                line[n] = u[k]
                line[n, rows.s.start + 1 + k - contacts] -= 1.0
        elif soft[k] and not system.late and laws.points[k] in gripped:
            line[n] = f  # friction holds the dashpot too
        elif soft[k] and not system.late:
            line[n] = u[k]
            line[n, rows.e.start + extras(system).index(system.first + k)] -= 1.0
        else:
            line[n] = f / laws.dashpots[k - contacts - frictions].damping + speed
    return line


def _solved(lines: Real, rows: _Rows) -> Real:
    """Return the forces as rows over everything else."""
    known = np.concatenate([lines[:, : rows.f.start], lines[:, rows.f.stop :]], axis=1)
    if not len(lines):
        return known
    # flexibilities and inverse masses: as large as the units make them
    size = np.abs(lines[:, rows.f]).max(axis=1, keepdims=True)
    return -np.linalg.solve(lines[:, rows.f] / size, known / size)


def _constrained(system: PhaseSystem, fixed: list[int], contacts: int) -> tuple[Real, Real]:
    """Return E and b of q = E r + b u_0, where points are held whose motion is all in the modes."""
    k = system.states.modes
    b = np.zeros((k, len(system.laws.frictions)))
    if not fixed:
        return np.eye(k), b
    B = system.states.push[:, [system.first + one for one in fixed]]
    Q, R = np.linalg.qr(B, mode="complete")
    b[:, [one - contacts for one in fixed]] = Q[:, : len(fixed)] @ np.linalg.inv(R[: len(fixed)]).T
    return Q[:, len(fixed) :], b


def _reduced(system: PhaseSystem, rows: _Rows, known: Real, E: Real, b: Real) -> Matrices:
    """Return the matrices over (r, r', e), from rows over (q, q', e, f_d, s)."""
    n = E.shape[1]
    own, drives = rows.e.stop - rows.e.start, system.drives
    q, v = known[:, rows.q], known[:, rows.v]
    e, d = known[:, rows.e], known[:, rows.e.stop : rows.e.stop + drives]
    s = known[:, rows.e.stop + drives :].copy()
    s[:, 1:] += q @ b
    x = np.concatenate([q @ E, v @ E, e], axis=1)
    size = 2 * n + own
    A, Bd, Bs = np.zeros((size, size)), np.zeros((size, drives)), np.zeros((size, s.shape[1]))
    A[:n, n : 2 * n] = np.eye(n)
    A[n:], Bd[n:], Bs[n:] = x[: n + own], d[: n + own], s[: n + own]
    return Matrices(E, b, A, Bd, Bs, x[n + own :], d[n + own :], s[n + own :])
