"""Static deflection."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..base import check
from ..base.answer import Answer, Cost, Work, axes
from ..base.array import Index, Real
from ..base.computed import Late, Lazy, lazy
from ..base.errors import SceneError, SolveError, UnitWarning
from ..base.table import Table
from ..base.unit import FORCE, FORCE_UNIT, UNIT
from ..chain.chain import Chain
from ..chain.compile import check_points, finer
from ..chain.compiled import EXACT, Compiled
from ..chain.place import refuse_slack
from ..chain.port import Point, Ports, cut, ports, stops
from ..chain.reaction import left_ends
from .critical import critical_loads, exceeds, refuse_critical
from .rounding import bound_of


@dataclass(frozen=True, eq=False)
class Deflection(Answer):
    """Static deflection of a model.

    Attributes
    ----------
    coordinates : tuple of str
        Of every node.
    x : ndarray, shape (nodes,)
        [m].
    displacement : ndarray, shape (nodes, coordinates)
        [m, rad]. Of more than a tenth of the rope's length `Model.static` warns, `UnitWarning`.
    force : ndarray, shape (nodes, coordinates)
        What the surroundings put on each node: loads, and reactions where a coordinate is held or
        a spring stands [N, N m].
    rounding_error : ndarray, shape (nodes, coordinates)
        Bound of what rounding does to the displacement, to first order, computed when it is read
        [m, rad]. The closer a load is to a critical one the larger it is.
    load : tuple of (point, float)
        That was asked for [N, N m].
    critical_loads : int
        How many critical loads the compression exceeds, those within rounding of it included; of
        springs that push too. The rope does not stay in this state unless it is 0.
    cost : Cost
        What it cost.

    Examples
    --------
    >>> import ropedyn as rd
    >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=2)
    >>> static = model.static({("z", 0.5): 10.0})
    >>> static.displacement[:, 0].round(6), static.force[:, 0].round(6)
    (array([0.   , 0.025, 0.   ]), array([-5., 10., -5.]))
    """

    coordinates: tuple[str, ...]
    x: Real = field(metadata=axes("node", unit="m"))
    displacement: Real = field(metadata=axes("node", "coordinate", unit="m or rad"))
    force: Real = field(metadata=axes("node", "coordinate", unit="N or N m"))
    load: tuple[tuple[Point, float], ...]
    critical_loads: int
    cost: Cost
    rounding_error: Lazy[Real] = lazy(np.ndarray, axes=axes("node", "coordinate", unit="m or rad"))

    def table(self) -> Table:
        """Return displacement and force at every node."""
        columns: dict[str, Any] = {"x [m]": self.x}
        for k, c in enumerate(self.coordinates):
            columns[f"{c} [{UNIT[c]}]"] = self.displacement[:, k]
        for k, c in enumerate(self.coordinates):
            columns[f"{FORCE[c]} [{FORCE_UNIT[c]}]"] = self.force[:, k]
        critical = self.critical_loads
        unstable = f", unstable: {exceeds(critical)}" if critical else ""
        return Table.of(f"static deflection{unstable}", columns)


def solve_static(
    model: Compiled,
    load: Mapping[Point, float],
    *,
    solver: str,
    points: int | None = None,
    unstable: bool = False,
) -> Deflection:
    """Find the static deflection; see `Model.static`."""
    solver_of = SOLVERS[check.one_of(solver, "solver", SOLVERS)]
    loads = checked_loads(model, load)
    check_points(model, points)
    check.instance(unstable, "unstable", bool, "True or False")
    start = time.perf_counter()
    if not unstable:
        refuse_critical(model, loads, "unstable=True answers all the same")
    if model.element == "continuous":
        model = finer(model, points or POINTS)
        x = cut(model.chain, model.x, [at for _, at in loads])[1]
    else:
        x = model.x
    width = len(model.coordinates)
    displacement, force = np.zeros((len(x), width)), np.zeros((len(x), width))
    unknowns, works = 0, []
    for component, free in zip(model.components, model.unknowns):
        here = {point: value for point, value in loads.items() if point[0] in component}
        if not here:
            continue
        at = [model.coordinates.index(c) for c in component]
        try:
            displacement[:, at], force[:, at], work = solver_of.solve(model, component, here, x)
        except SolveError as error:
            raise SolveError(
                f"({', '.join(component)}): the stiffness is singular to working precision: a "
                "rigid motion is free, the compression is critical, or there are too many "
                "elements for the assembled stiffness"
            ) from error
        unknowns += free
        works.append(work)
    seconds = time.perf_counter() - start
    if not np.isfinite(displacement).all() or not np.isfinite(force).all():
        raise SolveError("the numbers of the static deflection overflow: check the units")
    _warn_of_large(model, displacement)
    return Deflection(
        coordinates=model.coordinates,
        x=x,
        displacement=displacement,
        force=force,
        load=tuple(loads.items()),
        critical_loads=critical_loads(model, loads) if unstable else 0,
        rounding_error=Late(partial(_rounding, model, loads, x, solver_of.bound)),
        cost=Cost(seconds, solver, len(model.x) - 1, unknowns, *Work.of(works)),
    )


def _warn_of_large(model: Compiled, displacement: Real) -> None:
    """Warn of what is no small deflection, at the line that asked the model."""
    length = model.scene.rope.length
    for k, coordinate in enumerate(model.coordinates):
        largest = float(np.abs(displacement[:, k]).max(initial=0.0))
        if UNIT[coordinate] == "m" and largest > LARGE * length:
            warnings.warn(
                f"{coordinate} moves by up to {largest:.3g} m on a rope of {length:g} m, and the "
                "theory is of small deflections: is the load in N, the tension too?",
                UnitWarning,
                stacklevel=4,
            )


LARGE = 0.1  # A part of the length that is no small deflection.
POINTS = 64  # A deflection is given at so many parts of each continuous span.
BLOCK = 4096  # One sweep reports the motion of so many nodes.


def _sweep(
    model: Compiled, component: tuple[str, ...], loads: dict[Point, float], nodes: Real
) -> tuple[Real, Real, Work]:
    """Return motion of the nodes, what the surroundings put on them, and what it took."""
    longer, finer, kept = _cut(model, component, loads, nodes)
    pushed = ports(longer, finer, component, loads)
    amount = np.array(list(loads.values()))
    asked = 0

    def ask(node: Index, forces: bool) -> Real:
        """Return motion of nodes, or force on the right end of the elements left of them."""
        w = len(component)
        watched = _watching(longer, node)
        if forces:
            unit = np.tile(np.eye(w), (len(node), 1))
            watched = Ports(np.repeat(node - 1, w).astype(np.int32), 0 * watched.row, unit)
        nonlocal asked
        asked += 1
        value, _, solved = _core.sweep(longer, STILL, pushed, watched)
        if solved == 0:
            raise SolveError("singular")
        answer = np.einsum("d,dr->r", amount, value[:, :, 0].real)
        return answer.reshape(len(node), w)

    def ask_all(node: Index, forces: bool) -> Real:
        blocks = [node[k : k + BLOCK] for k in range(0, len(node), BLOCK)]
        return np.concatenate([ask(block, forces) for block in blocks])

    u = ask_all(kept, False)
    right = ask_all(kept[1:], True)
    begins = ask_all(kept[:-1] + 1, True) if len(kept) < longer.nodes else right
    return u, _on_nodes(longer, kept, u, right, begins), Work(2 * asked)


def _band(
    model: Compiled, component: tuple[str, ...], loads: dict[Point, float], nodes: Real
) -> tuple[Real, Real, Work]:
    chain, x, kept = _cut(model, component, loads, nodes)
    u, force = _core.mixed_deflection(chain, nodal(chain, x, component, loads))
    on_nodes = _on_nodes(chain, kept, u[kept], force[kept[1:] - 1], force[kept[:-1]])
    return u[kept], on_nodes, Work(factorisations=1)


STILL = np.array([[1.0], [1.0], [1.0], [0.0], [0.0]], dtype=np.complex128)
"""At 0 Hz the factors on sections, tension, springs, inertia and dashpots."""
AT_ONCE = 32  # The rounding of so many nodes is bounded together.
Bound = Callable[[Chain, Ports, Ports], Real]


def _rounding(model: Compiled, loads: dict[Point, float], nodes: Real, bound: Bound) -> Real:
    """Bound what rounding does to the displacement of the nodes, linear in the loads [m, rad]."""
    error = np.zeros((len(nodes), len(model.coordinates)))
    for component in model.components:
        here = {point: value for point, value in loads.items() if point[0] in component}
        if not here:
            continue
        chain, x, kept = _cut(model, component, here, nodes)
        pushed, amount = ports(chain, x, component, here), np.abs(list(here.values()))
        parts = [
            amount @ bound(chain, pushed, _watching(chain, kept[k : k + AT_ONCE]))
            for k in range(0, len(kept), AT_ONCE)
        ]
        moves = chain.held[chain.term_of[kept]] == 0
        at = [model.coordinates.index(c) for c in component]
        error[:, at] = np.concatenate(parts).reshape(moves.shape) * moves
    error.setflags(write=False)
    return error


def _watching(chain: Chain, node: Index) -> Ports:
    """Return the ports of all coordinates of nodes."""
    width = chain.held.shape[1]
    left = np.minimum(node, chain.nodes - 2)
    row = np.zeros((len(node) * width, 2, width))
    row[np.arange(len(row)), np.repeat(node - left, width)] = np.tile(np.eye(width), (len(node), 1))
    return Ports(np.repeat(left, width).astype(np.int32), row, None)


def _sweep_bound(chain: Chain, pushed: Ports, watched: Ports) -> Real:
    return bound_of(chain, STILL, pushed, watched)[:, :, 0]


def _band_bound(chain: Chain, pushed: Ports, watched: Ports) -> Real:
    return _core.mixed(chain, STILL, pushed, watched)[1][:, :, 0]


def _lapack_bound(chain: Chain, pushed: Ports, watched: Ports) -> Real:
    return _core.frf(chain, np.ascontiguousarray(STILL.T), pushed, watched)[1][0]


def _on_nodes(
    chain: Chain,
    kept: Index,
    u: Real,
    right: Real,
    begins: Real,
) -> Real:
    """Return f_b of the element on the left less f_a = E f_b - Q u_a + P u_b of the right one."""
    of = left_ends(chain)
    first = chain.element_of[kept[:-1]]
    left_end = np.einsum("nij,nj->ni", of.E[first], begins)
    left_end -= np.einsum("nij,nj->ni", of.Q[first], u[:-1])
    # struts are never cut: their right end is the next node that is kept
    left_end += np.einsum("nij,nj->ni", of.P[first], u[1:])
    if chain.hinge is not None:
        left_end *= _kept(chain.hinge[chain.term_of[kept[:-1]]], of.Q[first])
    force = np.zeros_like(u)
    force[1:] += right
    force[:-1] -= left_end
    return force


def _kept(compliance: Real, Q: Real) -> Real:
    """Return the share 1/(1 + Q C) that a hinge leaves of f_a without it, none where it is free."""
    # f_a = E f_b - Q (u_a + C f_a) + P u_b, and a hinge stands on the one coordinate that Q has
    free = np.isinf(compliance)
    finite = np.where(free, 0.0, compliance)
    return np.where(free, 0.0, 1 / (1 + np.einsum("nii->ni", Q) * finite))


def _lapack(
    model: Compiled, component: tuple[str, ...], loads: dict[Point, float], nodes: Real
) -> tuple[Real, Real, Work]:
    chain, x, kept = _cut(model, component, loads, nodes)
    u, _ = _core.deflection(chain, nodal(chain, x, component, loads))
    return u[kept], _held_up(chain, u)[kept], Work(factorisations=1)


def _cut(
    model: Compiled, component: tuple[str, ...], loads: dict[Point, float], nodes: Real
) -> tuple[Chain, Real, Index]:
    """Return the chain with nodes under the loads, where they stand, and those of the answer."""
    chain, x = model.chain.only(component).at_rest, model.x
    if model.element in EXACT:
        chain, x = cut(chain, x, [*nodes, *(point[1] for point in loads), *stops(chain, x)])
    return chain, x, np.flatnonzero(np.isin(x, nodes))


class Static(NamedTuple):
    """A solver: what finds motion of and forces on the nodes of one component, and its rounding."""

    solve: Callable[[Compiled, tuple[str, ...], dict[Point, float], Real], tuple[Real, Real, Work]]
    bound: Bound  # of each motion watched under unit loads, (loads, watched)


SOLVERS = {
    "sweep": Static(_sweep, _sweep_bound),
    "band": Static(_band, _band_bound),
    "lapack": Static(_lapack, _lapack_bound),
}


def checked_loads(model: Compiled, load: Any, name: str = "load") -> dict[Point, float]:
    """Return forces at points, those given twice as their sum."""
    what = 'a mapping such as {("z", 0.5): 10.0}'
    check.instance(load, name, Mapping, what)
    if not load:
        raise SceneError(f"{name} must be {what} with at least one entry, got {{}}")
    loads: dict[Point, float] = {}
    for key, value in load.items():
        point = check.point(key, f"{name} point", model.coordinates, model.scene.rope.length)
        refuse_slack(model, point, name)
        unit = FORCE_UNIT[point[0]]
        loads[point] = loads.get(point, 0.0) + check.number(value, f"{name}[{key}]", unit)
    return loads


def nodal(
    chain: Chain,
    x: Real,
    component: tuple[str, ...],
    loads: dict[Point, float],
) -> Real:
    """Return the forces on the nodes that the loads amount to."""
    node, row, _ = ports(chain, x, component, loads)
    force = np.zeros((len(x), len(component)))
    for left, shape, value in zip(node, row, loads.values()):
        force[left : left + 2] += shape * value
    return force


def _held_up(chain: Chain, u: Real) -> Real:
    """Return what the elements need from outside at every node: K_elements u."""
    elastic, elastic_beside, string, string_beside, _, _, _ = _core.assemble(chain)
    force = np.einsum("nij,nj->ni", elastic + string, u)
    beside = elastic_beside + string_beside
    force[:-1] += np.einsum("nij,nj->ni", beside, u[1:])
    force[1:] += np.einsum("nji,nj->ni", beside, u[:-1])
    return force
