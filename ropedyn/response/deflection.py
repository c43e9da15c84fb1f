"""Static deflection."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..base import check
from ..base.answer import Answer, Cost, Work, axes
from ..base.array import Flags, Index, Real
from ..base.computed import Late, Lazy, lazy
from ..base.errors import SceneError, SolveError
from ..base.table import Table
from ..base.unit import FORCE, FORCE_UNIT, UNIT
from ..chain.chain import Chain
from ..chain.compile import check_points, compile_scene, finer, remeshed
from ..chain.compiled import EXACT, Compiled
from ..chain.place import refuse_slack
from ..chain.port import Point, Ports, cut, ports, stops
from ..chain.reaction import left_ends
from ..chain.wide import of_steep
from ..scene.end import end_of
from .critical import critical_loads, exceeds, refuse_critical
from .measured import measured_at_rest, off_by, surely
from .rounding import bound_of

LOAD = 'a mapping such as {("z", 0.5): 10.0}'
"""What loads are, as messages name it."""


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
        [m, rad].
    force : ndarray, shape (nodes, coordinates)
        What the surroundings put on each node: loads, and reactions where a coordinate is held or
        a spring stands [N, N m].
    rounding_error : ndarray, shape (nodes, coordinates)
        What rounding did to the displacement, measured when it is read as the distance to the same
        deflection in wider numbers with their own error [m, rad]; where these do not tell, as
        where a string has no tension at an end, `rounding_bound`. On an axis both are told by 16
        deflections for numbers that are a little off, infinite where one of them is singular.
    force_rounding_error : ndarray, shape (nodes, coordinates)
        The same of the forces, which are what the rope beside a node leaves of its forces [N, N m].
    rounding_bound : ndarray, shape (nodes, coordinates)
        A bound of what rounding does to the displacement, to first order, some hundred times as
        large [m, rad]. The closer a load is to a critical one the larger it is.
    mesh_error : ndarray, shape (nodes, coordinates)
        How far a chain is from its continuous spans, solved when it is read, with what rounding
        does to these [m, rad]; 0 of these, infinite where they have no answer.
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
    >>> bool((static.mesh_error < 1e-15).all())
    True
    """

    coordinates: tuple[str, ...]
    x: Real = field(metadata=axes("node", unit="m"))
    displacement: Real = field(metadata=axes("node", "coordinate", unit="m or rad"))
    force: Real = field(metadata=axes("node", "coordinate", unit="N or N m"))
    load: tuple[tuple[Point, float], ...]
    critical_loads: int
    cost: Cost
    rounding_error: Lazy[Real] = lazy(np.ndarray, axes=axes("node", "coordinate", unit="m or rad"))
    rounding_bound: Lazy[Real] = lazy(np.ndarray, axes=axes("node", "coordinate", unit="m or rad"))
    force_rounding_error: Lazy[Real] = lazy(
        np.ndarray, axes=axes("node", "coordinate", unit="N or N m")
    )

    mesh_error: Lazy[Real] = lazy(np.ndarray, axes=axes("node", "coordinate", unit="m or rad"))

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
    check.instance(load, "load", Mapping, LOAD)
    if not load:
        model, load = _pulled(model)
    solver_of = SOLVERS[check.one_of(solver, "solver", SOLVERS)]
    loads = checked_loads(model, load)
    check_points(model, points)
    check.instance(unstable, "unstable", bool, "True or False")
    if not unstable:
        refuse_critical(model, loads, "unstable=True answers all the same")
    if model.element == "continuous":
        model = finer(model, points or POINTS)
        x = cut(model.chain, model.x, [at for _, at in loads])[1]
    else:
        x = model.x
    displacement, force, unknowns, work = _deflected(model, loads, x, solver_of)
    bounds = [
        cache(partial(_rounding, model, loads, x, partial(of, solver_of.bound)))
        for of in (_motion_error, solver_of.force_error)
    ]
    measured = cache(partial(_measured, model, loads, x, (displacement, force)))

    @cache
    def lost() -> Real:
        answer = np.stack((displacement, force))
        return of_steep(
            model, answer, lambda one: np.stack(_deflected(one, loads, x, solver_of)[:2])
        )

    return Deflection(
        coordinates=model.coordinates,
        x=x,
        displacement=displacement,
        force=force,
        load=tuple(loads.items()),
        critical_loads=critical_loads(model, loads) if unstable else 0,
        rounding_error=Late(lambda: measured()[0].over(bounds[0]() + lost()[0], solver)),
        force_rounding_error=Late(lambda: measured()[1].over(bounds[1]() + lost()[1], solver)),
        rounding_bound=Late(bounds[0]),
        mesh_error=Late(partial(_mesh, model, loads, displacement)),
        cost=Cost(solver, len(model.x) - 1, unknowns, *work),
    )


class FromWide(NamedTuple):
    """How far an answer is from wider numbers, and how little these know, (nodes, coordinates)."""

    error: Real  # infinite where there are none
    noise: Real

    def over(self, bound: Real, solver: str) -> Real:
        """Return that, or a bound where it says less."""
        return surely(self.error, self.noise, bound, solver=solver)[0]


def _measured(
    model: Compiled, loads: dict[Point, float], x: Real, answer: tuple[Real, Real]
) -> tuple[FromWide, FromWide]:
    """Measure what rounding did to displacement and force."""
    found = [FromWide(*np.zeros((2, *one.shape))) for one in answer]
    for component in model.components:
        here = {point: value for point, value in loads.items() if point[0] in component}
        if not here:
            continue
        at = [model.coordinates.index(c) for c in component]
        wide = measured_at_rest(model, component, here, x)
        for one, value, k in zip(found, answer, range(2)):
            if wide is None:
                one.error[:, at] = one.noise[:, at] = np.inf
                continue
            one.error[:, at] = off_by(value[:, at], wide[k], wide[2 + k])
            one.noise[:, at] = wide[2 + k]
    return found[0], found[1]


def _pulled(model: Compiled) -> tuple[Compiled, dict[Point, float]]:
    """Return the rope with an end let go along x, and the mean tension that pulls there."""
    scene, length = model.scene, model.scene.rope.length
    if scene.rope.axial_stiffness is None or scene.gravity is not None:
        raise SceneError(
            f"load must be {LOAD}: without one the mean tension pulls, along a rope with "
            f"axial_stiffness and without gravity, got {{}} and {scene.gravity or 'no stiffness'}"
        )
    ends = [end_of(end) for end in scene.ends]
    side = 1 if ends[0].holds("x") else 0
    ends[side] = replace(ends[side], x="free")
    tension = scene.mean_tension if side else -scene.mean_tension
    return remeshed(model, scene.replace(ends=tuple(ends))), {("x", side * length): tension}


def _deflected(
    model: Compiled, loads: dict[Point, float], x: Real, solver_of: Static
) -> tuple[Real, Real, int, Work]:
    """Return displacement and force at places, how many unknowns there were, and the work."""
    width = len(model.coordinates)
    displacement, force = np.zeros((len(x), width)), np.zeros((len(x), width))
    unknowns, works = 0, []
    for component, free in zip(model.components, model.unknowns):
        if not any(point[0] in component for point in loads):
            continue
        at = [model.coordinates.index(c) for c in component]
        try:
            push = _push(model, component, loads, x)
            displacement[:, at], force[:, at], work = solver_of.solve(push)
        except SolveError as error:
            raise SolveError(
                f"({', '.join(component)}): the stiffness is singular to working precision: a "
                "rigid motion is free, the compression is critical, or there are too many "
                "elements for the assembled stiffness"
            ) from error
        unknowns += free
        works.append(work)
    if not np.isfinite(displacement).all() or not np.isfinite(force).all():
        raise SolveError("the numbers of the static deflection overflow: check the units")
    return displacement, force, unknowns, Work.of(works)


def _mesh(model: Compiled, loads: dict[Point, float], displacement: Real) -> Real:
    """Return how far a chain is from its continuous spans; infinite where these have no answer."""
    error = np.zeros(displacement.shape)
    if model.element != "continuous":
        solver_of, x = SOLVERS["sweep"], model.x
        try:
            spans = compile_scene(model.scene, elements=len(x) - 1, element="continuous")
            error = _rounding(spans, loads, x, partial(_motion_error, solver_of.bound))
            error = error + np.abs(displacement - _deflected(spans, loads, x, solver_of)[0])
        except (SceneError, SolveError):
            error = np.full(displacement.shape, np.inf)
    return error


POINTS = 64  # A deflection is given at so many parts of each continuous span.
BLOCK = 4096  # One sweep reports the motion of so many nodes.


class Loaded(NamedTuple):
    """Loads of a component on a chain that is cut under them and at the nodes of the answer."""

    chain: Chain
    kept: Index  # nodes of the answer
    ports: Ports
    amount: Real  # (loads,) [N, N m]
    nodal: Real  # (nodes, width) what they amount to

    @property
    def moves(self) -> Flags:
        """Which coordinates of the nodes of the answer can move, (kept, width)."""
        return np.asarray(self.chain.held[self.chain.term_of[self.kept]] == 0)


def _push(
    model: Compiled, component: tuple[str, ...], loads: dict[Point, float], nodes: Real
) -> Loaded:
    """Cut the chain of a component under its loads and at nodes."""
    here = {point: value for point, value in loads.items() if point[0] in component}
    chain, x = model.chain.only(component).at_rest, model.x
    if model.element in EXACT:
        chain, x = cut(chain, x, [*nodes, *(point[1] for point in here), *stops(chain, x)])
    kept, pushed = np.flatnonzero(np.isin(x, nodes)), ports(chain, x, component, here)
    amount = np.array(list(here.values()))
    return Loaded(chain, kept, pushed, amount, nodal(chain, x, component, here))


class Ends(NamedTuple):
    """Motion of the nodes of an answer, and forces on right ends of elements beside them."""

    u: Real  # (kept, width)
    right: Real  # (kept - 1, width) of those that end there
    begins: Real  # (kept - 1, width) of those that begin there
    work: Work


def _sweep(push: Loaded) -> Ends:
    chain, kept, asked = push.chain, push.kept, 0

    def ask(node: Index, forces: bool) -> Real:
        """Return motion of nodes, or force on the right end of the elements left of them."""
        watched = _right_ends(chain, node) if forces else _watching(chain, node)
        nonlocal asked
        asked += 1
        value, _, solved = _core.sweep(chain, STILL, push.ports, watched)
        if solved == 0:
            raise SolveError("singular")
        answer = np.einsum("d,dr->r", push.amount, value[:, :, 0].real)
        return answer.reshape(len(node), -1)

    def ask_all(node: Index, forces: bool) -> Real:
        blocks = [node[k : k + BLOCK] for k in range(0, len(node), BLOCK)]
        return np.concatenate([ask(block, forces) for block in blocks])

    # what is held is still, to the last digit
    u = ask_all(kept, False) * push.moves
    right = ask_all(kept[1:], True)
    begins = ask_all(kept[:-1] + 1, True) if len(kept) < chain.nodes else right
    return Ends(u, right, begins, Work(2 * asked))


def _band(push: Loaded) -> Ends:
    u, force = _core.mixed_deflection(push.chain, push.nodal)
    kept = push.kept
    return Ends(u[kept] * push.moves, force[kept[1:] - 1], force[kept[:-1]], Work(factorisations=1))


def _by_ends(ends_of: Callable[[Loaded], Ends], push: Loaded) -> tuple[Real, Real, Work]:
    """Return motion of the nodes, what the surroundings put on them, and what it took."""
    ends = ends_of(push)
    force = np.zeros_like(ends.u)
    force[1:] += ends.right
    force[:-1] -= _left_forces(push, ends)
    return ends.u, force, ends.work


STILL = np.array([[1.0], [1.0], [1.0], [0.0], [0.0]], dtype=np.complex128)
"""At 0 Hz the factors on sections, tension, springs, inertia and dashpots."""
SUMMED = 8 * np.finfo(float).eps  # So far are elements off, and sums over their coordinates.
AT_ONCE = 32  # The rounding of so many nodes is bounded together.
Bound = Callable[[Chain, Ports, Ports], Real]


def _rounding(
    model: Compiled, loads: dict[Point, float], nodes: Real, bounded: Callable[[Loaded], Real]
) -> Real:
    """Bound what rounding does to motion of the nodes or forces on them, linear in the loads."""
    error = np.zeros((len(nodes), len(model.coordinates)))
    for component in model.components:
        if any(point[0] in component for point in loads):
            at = [model.coordinates.index(c) for c in component]
            error[:, at] = bounded(_push(model, component, loads, nodes))
    return error


def _bounds(bound: Bound, push: Loaded, watched: Ports) -> Real:
    """Bound what is watched, all coordinates of one place after another, (places, width)."""
    width = push.chain.held.shape[1]
    step = AT_ONCE * width
    parts = [
        np.abs(push.amount) @ bound(push.chain, push.ports, watched.part(slice(k, k + step)))
        for k in range(0, len(watched.node), step)
    ]
    return np.concatenate(parts).reshape(-1, width)


def _motion_error(bound: Bound, push: Loaded) -> Real:
    return _bounds(bound, push, _watching(push.chain, push.kept)) * push.moves


def _force_error(ends_of: Callable[[Loaded], Ends], bound: Bound, push: Loaded) -> Real:
    """Bound f_b of the element on the left less f_a of the one on the right, and their difference.

    What rounding did to f_a = E f_b - Q u_a + P u_b is that of the response of this sum.
    """
    chain, before, ends = push.chain, push.kept[:-1], ends_of(push)
    of, first, width = left_ends(chain), chain.element_of[before], push.moves.shape[1]
    row = np.stack([-of.Q[first], of.P[first]], axis=2).reshape(-1, 2, width)
    begins = Ports(before.repeat(width).astype(np.int32), row, of.E[first].reshape(-1, width))
    error = np.zeros_like(ends.u)
    error[1:] += _bounds(bound, push, _right_ends(chain, push.kept[1:]))
    error[1:] += SUMMED * np.abs(ends.right)
    error[:-1] += _bounds(bound, push, begins) * np.abs(_hinged(push, of.Q[first]))
    error[:-1] += SUMMED * chain.section_loss * _left_sizes(push, ends)
    return error


def _assembled_force_error(bound: Bound, push: Loaded) -> Real:
    """Bound K u by the errors of u and of the entries of K."""
    everywhere = push._replace(kept=np.arange(push.chain.nodes))
    size = np.abs(_core.deflection(push.chain, push.nodal)[0])
    wrong = _motion_error(bound, everywhere) + SUMMED * size
    return _held_up(push.chain, wrong, np.abs)[push.kept]


def _right_ends(chain: Chain, node: Index) -> Ports:
    """Return the ports of the forces on the right ends of the elements left of nodes."""
    watched = _watching(chain, node)
    force = np.tile(np.eye(chain.held.shape[1]), (len(node), 1))
    return Ports((node - 1).repeat(chain.held.shape[1]).astype(np.int32), 0 * watched.row, force)


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


def _left_forces(push: Loaded, ends: Ends) -> Real:
    """Return f_a = E f_b - Q u_a + P u_b of the elements right of nodes."""
    E, Q, P = (one[push.chain.element_of[push.kept[:-1]]] for one in left_ends(push.chain))
    left = np.einsum("nij,nj->ni", E, ends.begins)
    left -= np.einsum("nij,nj->ni", Q, ends.u[:-1])
    # struts are never cut: their right end is the next node that is kept
    left += np.einsum("nij,nj->ni", P, ends.u[1:])
    return left * _hinged(push, Q)


def _left_sizes(push: Loaded, ends: Ends) -> Real:
    """Return the sizes of what that is the sum of; c = 1/(1 + Q C) rounds by 1 + 2 |c|."""
    of = left_ends(push.chain)
    E, Q, P = (np.abs(one[push.chain.element_of[push.kept[:-1]]]) for one in of)
    size = np.einsum("nij,nj->ni", E, np.abs(ends.begins))
    size += np.einsum("nij,nj->ni", Q, np.abs(ends.u[:-1]))
    size += np.einsum("nij,nj->ni", P, np.abs(ends.u[1:]))
    left = np.abs(_hinged(push, of.Q[push.chain.element_of[push.kept[:-1]]]))
    return 2 * size * left * (1 + left)


def _hinged(push: Loaded, Q: Real) -> Real:
    """Return what hinges leave of f_a, 1 where there is none."""
    if push.chain.hinge is None:
        return np.ones(Q.shape[:2])
    return _kept(push.chain.hinge[push.chain.term_of[push.kept[:-1]]], Q)


def _kept(compliance: Real, Q: Real) -> Real:
    """Return the share 1/(1 + Q C) that a hinge leaves of f_a without it, none where it is free."""
    # f_a = E f_b - Q (u_a + C f_a) + P u_b, and a hinge stands on the one coordinate that Q has
    free = np.isinf(compliance)
    finite = np.where(free, 0.0, compliance)
    return np.where(free, 0.0, 1 / (1 + np.einsum("nii->ni", Q) * finite))


def _lapack(push: Loaded) -> tuple[Real, Real, Work]:
    u, _ = _core.deflection(push.chain, push.nodal)
    return u[push.kept], _held_up(push.chain, u)[push.kept], Work(factorisations=1)


class Static(NamedTuple):
    """A solver: what finds motion of and forces on the nodes of one component, and its rounding."""

    solve: Callable[[Loaded], tuple[Real, Real, Work]]
    bound: Bound  # of each thing watched under unit loads, (loads, watched)
    force_error: Callable[[Bound, Loaded], Real]


SOLVERS = {
    "sweep": Static(partial(_by_ends, _sweep), _sweep_bound, partial(_force_error, _sweep)),
    "band": Static(partial(_by_ends, _band), _band_bound, partial(_force_error, _band)),
    "lapack": Static(_lapack, _lapack_bound, _assembled_force_error),
}


def checked_loads(
    model: Compiled, load: Any, name: str = "load", *, over: str = ""
) -> dict[Point, float]:
    """Return forces at points of a model, none of them where a rope hangs without bending."""
    loads = summed_loads(load, model.coordinates, model.scene.rope.length, name, over=over)
    for point in loads:
        refuse_slack(model, point, name)
    return loads


def check_some(load: Any, name: str = "load") -> None:
    """Refuse what is no mapping, and one without an entry."""
    check.instance(load, name, Mapping, LOAD)
    if not load:
        raise SceneError(f"{name} must be {LOAD} with at least one entry, got {{}}")


def summed_loads(
    load: Any, coordinates: tuple[str, ...], length: float, name: str = "load", *, over: str = ""
) -> dict[Point, float]:
    """Return forces at points of a rope, or these over a time [s], those given twice as a sum."""
    check_some(load, name)
    loads: dict[Point, float] = {}
    for key, value in load.items():
        point = check.point(key, f"{name} point", coordinates, length)
        unit = FORCE_UNIT[point[0]] + over
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


def _held_up(chain: Chain, u: Real, of: Callable[[Real], Real] = np.asarray) -> Real:
    """Return what the elements need from outside at every node: K_elements u, or |K_elements| u."""
    elastic, elastic_beside, string, string_beside, *_ = map(of, _core.assemble(chain))
    force = np.einsum("nij,nj->ni", elastic + string, u)
    beside = elastic_beside + string_beside
    force[:-1] += np.einsum("nij,nj->ni", beside, u[1:])
    force[1:] += np.einsum("nji,nj->ni", beside, u[:-1])
    return force
