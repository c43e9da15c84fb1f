"""The static deflection of a rope on an axis."""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.answer import Cost
from ..base.array import Index, Real
from ..base.computed import Late
from ..base.errors import SolveError
from ..chain.port import Point
from ..chain.wide import LINEAR, RUNS, apart
from ..eigen.vectors import within
from ..response.critical import exceeds
from ..response.deflection import POINTS, Deflection, summed_loads
from ..scene.scene import Scene
from .assembly import Assembly, LoadedFields, assemble
from .compile import finer_rope, method_of
from .modes import check_points
from .rope import SIX, SpaceRope, unforced
from .spectrum import growing, start

NOTHING = 2.0**-80  # Of the largest of an answer: what rounding makes of a rounding.


def refuse_growing(rope: SpaceRope, instead: str) -> None:
    """Refuse a rope that rests where it does not stay."""
    critical = len(growing(rope))
    if critical:
        raise SolveError(f"the rope does not stay at rest: {exceeds(critical)}; {instead}")


def solve_static(
    scene: Scene, rope: SpaceRope, load: Any, *, points: int | None, unstable: bool
) -> Deflection:
    """Find the static deflection; see `SpaceModel.static`."""
    loads = summed_loads(load, scene.coordinates, scene.rope.length)
    check_points(rope, points)
    if not unstable:
        refuse_growing(rope, "unstable=True answers all the same")
    own, near = ~rope.absent, check.NEAR * scene.rope.length
    along = {(coordinate, at * rope.longer): load for (coordinate, at), load in loads.items()}
    x = np.concatenate([within(rope.x, points or POINTS), [at for _, at in along]])
    cut, _ = rope.cut(x, near)
    x, solved = cut.x, _under(cut, along)
    answer = _at_nodes(solved, np.arange(len(x)))

    def mesh() -> Real:
        finer = finer_rope(scene, rope)
        if finer is None:
            return np.zeros((len(x), int(own.sum())))
        other, node = finer.cut(x, near)
        return np.abs(answer - _at_nodes(_under(other, along), node))[0][:, own]

    rounding = cache(lambda: _rounding(cut, along, answer)[..., own])
    return Deflection(
        coordinates=rope.coordinates,
        x=x / rope.longer,
        displacement=answer[0][:, own],
        force=answer[1][:, own],
        load=tuple(loads.items()),
        critical_loads=len(growing(rope)) if unstable else 0,
        cost=Cost(
            method_of(scene), len(rope.length), rope.unknowns, sweeps=1, factorisations=len(solved)
        ),
        rounding_error=Late(lambda: rounding()[0]),
        rounding_bound=Late(lambda: rounding()[0]),
        force_rounding_error=Late(lambda: rounding()[1]),
        mesh_error=Late(mesh),
    )


class LoadedPart(NamedTuple):
    """A component that is loaded: what motion and force it has."""

    own: Index  # its coordinates
    system: Assembly
    field: LoadedFields

    @property
    def displacement(self) -> Real:
        """Of the nodes, shape (nodes, width)."""
        return np.asarray(self.field.u[0, self.system.node, :, 0] * self.system.z[0])

    @property
    def force(self) -> Real:
        """What the surroundings put on the nodes: p - N u, or where they are held what is left."""
        system, field = self.system, self.field
        matrices = (system.D, system.Q, system.N, field.u, field.f, field.load)
        D, Q, N, u, f, p = (one[0].real for one in matrices)
        held = np.zeros(u.shape)
        held[1:] += f
        held[:-1] += Q @ u[:-1] - f - D.swapaxes(1, 2) @ f
        if self.system.closed:
            held[0] += held[-1]
        force = np.where(self.system.held[0, :, :, None], held, p - N @ u)
        return np.asarray(force[self.system.node, :, 0] / self.system.z[0])


def _under(rope: SpaceRope, loads: dict[Point, float]) -> list[LoadedPart]:
    """Return the components that loads at nodes move."""
    found = []
    for k, own in enumerate(rope.own):
        which = np.array([k])
        system = assemble(rope, which, unforced([0.0]), rope.scale(which, [0.0]))
        right = np.zeros((system.parts + 1, system.width, 1))
        for (coordinate, at), amount in loads.items():
            along = np.flatnonzero(own == SIX.index(coordinate))
            node = system.node[int(rope.node_at(at))]
            right[node, along] += amount * system.z[0, along, None]
        if right.any():
            found.append(LoadedPart(own, system, _solved(system, right)))
    return found


def _at_nodes(parts: list[LoadedPart], node: Index) -> Real:
    """Return displacement and force at nodes, (2, nodes, 6)."""
    found = np.zeros((2, len(node), 6))
    for one in parts:
        found[0][:, one.own], found[1][:, one.own] = one.displacement[node], one.force[node]
    return found


def _rounding(rope: SpaceRope, loads: dict[Point, float], answer: Real) -> Real:
    """Bound what rounding did to displacement and force by those of numbers a little off."""
    every = []
    for seed in range(RUNS):
        moved, node = rope.nudged(np.random.default_rng(seed))
        try:
            every.append(_at_nodes(_under(moved, loads), node))
        except SolveError:  # as close to a critical load as numbers are known
            return np.full(answer.shape, np.inf)
    error, size = apart(answer, np.stack(every)), np.abs(answer).max(axis=(1, 2))
    if error[0].max() > LINEAR * size[0]:
        return np.full(answer.shape, np.inf)
    return error + NOTHING * size[:, None, None]


def _solved(system: Assembly, right: Real) -> LoadedFields:
    """Return motion and force of columns of loads (parts + 1, 6, columns)."""
    right = np.where(system.held[0, :, :, None], 0.0, right)[None]
    # loads in balance do not say that a motion is free, any others do
    any_other = system.apart(start(system, 1))[0]
    any_other[system.held] = 0.0
    right = np.concatenate([right, any_other], axis=3)
    rows = system.together(right, np.zeros((1, system.parts, *right.shape[2:])))
    try:
        u, f = system.apart(system.factored().solve(rows))
    except SolveError:
        u = f = None
    if u is None or LoadedFields(u, f, right).lost(system, rows).any():
        raise SolveError(
            "the stiffness is singular to working precision: a rigid motion is free, or the "
            "compression is critical"
        )
    return LoadedFields(u[..., :-1], f[..., :-1], right[..., :-1])
