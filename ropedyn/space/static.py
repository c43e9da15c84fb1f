"""The static deflection of a rope on an axis."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.answer import Cost
from ..base.array import Index, Real
from ..base.computed import Late
from ..base.errors import SolveError
from ..chain.port import Point
from ..eigen.vectors import within
from ..response.critical import exceeds
from ..response.deflection import POINTS, Deflection, summed_loads
from ..scene.scene import Scene
from .assembly import Assembly, LoadedFields, assemble, bound
from .compile import finer_rope, method_of
from .modes import check_points
from .rope import SIX, SpaceRope, unforced
from .spectrum import count_below


def solve_static(
    scene: Scene, rope: SpaceRope, load: Any, *, points: int | None, unstable: bool
) -> Deflection:
    """Find the static deflection; see `SpaceModel.static`."""
    loads = summed_loads(load, scene.coordinates, scene.rope.length)
    check_points(rope, points)
    critical = count_below(rope, -1e-13 * rope.unit)
    if critical and not unstable:
        raise SolveError(
            f"the rope does not stay at rest: {exceeds(critical)}; "
            "unstable=True answers all the same"
        )
    own, near = ~rope.absent, check.NEAR * scene.rope.length
    along = {(coordinate, at * rope.longer): load for (coordinate, at), load in loads.items()}
    x = np.concatenate([within(rope.x, points or POINTS), [at for _, at in along]])
    cut, _ = rope.cut(x, near)
    x, shape = cut.x, (len(cut.x), int(own.sum()))
    solved = _under(cut, along)
    displacement, force = np.zeros((2, len(x), 6))
    for one in solved:
        displacement[:, one.own], force[:, one.own] = one.displacement, one.force

    def mesh() -> Real:
        finer = finer_rope(scene, rope)
        if finer is None:
            return _same(shape, 0.0)
        other, node = finer.cut(x, near)
        there = np.zeros_like(displacement)
        for one in _under(other, along):
            there[:, one.own] = one.displacement[node]
        return np.abs(displacement - there)[:, own]

    def rounding() -> Real:
        limit = np.zeros_like(displacement)
        for one in solved:
            limit[:, one.own] = one.rounding()
        limit = limit[:, own]
        limit.setflags(write=False)
        return limit

    return Deflection(
        coordinates=rope.coordinates,
        x=x / rope.longer,
        displacement=displacement[:, own],
        force=force[:, own],
        load=tuple(loads.items()),
        critical_loads=critical,
        cost=Cost(
            method_of(scene), len(rope.length), rope.unknowns, sweeps=1, factorisations=len(solved)
        ),
        rounding_error=Late(rounding),
        force_rounding_error=_same(shape, np.inf),
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
        """What the surroundings put on the nodes: f_b on the left less f_a on the right."""
        D, Q, u, f = (one[0].real for one in (self.system.D, self.system.Q, *self.field[:2]))
        force = np.zeros(u.shape)
        force[1:] += f
        force[:-1] += Q @ u[:-1] - f - D.swapaxes(1, 2) @ f
        return np.asarray(force[self.system.node, :, 0] / self.system.z[0])

    def rounding(self) -> Real:
        """Bound what rounding does to the displacement, shape (nodes, width)."""
        system, nodes, w = self.system, len(self.system.node), self.system.width
        unit = np.zeros((system.parts + 1, w, w * nodes))
        along = np.tile(np.arange(w), nodes)
        unit[np.repeat(system.node, w), along, np.arange(w * nodes)] = 1.0
        limit = bound(system, self.field, _solved(system, unit))[0, 0]
        limit = limit.reshape(nodes, w) * system.z[0]
        limit[system.held[0, system.node]] = 0.0
        return limit


def _under(rope: SpaceRope, loads: dict[Point, float]) -> list[LoadedPart]:
    """Return the components that loads at nodes move."""
    found = []
    for k, own in enumerate(rope.own):
        which = np.array([k])
        system = assemble(rope, which, unforced([0.0]), rope.scale(which, [0.0]))
        right = np.zeros((system.parts + 1, system.width, 1))
        for (coordinate, at), amount in loads.items():
            along = np.flatnonzero(own == SIX.index(coordinate))
            node = system.node[int(np.abs(rope.x - at).argmin())]
            right[node, along] += amount * system.z[0, along, None]
        if right.any():
            found.append(LoadedPart(own, system, _solved(system, right)))
    return found


def _same(shape: tuple[int, ...], value: float) -> Real:
    error = np.full(shape, value)
    error.setflags(write=False)
    return error


def _solved(system: Assembly, right: Real) -> LoadedFields:
    """Return motion and force of columns of loads (parts + 1, 6, columns)."""
    right = np.where(system.held[0, :, :, None], 0.0, right)[None]
    none = np.zeros((1, system.parts, system.width, right.shape[3]))
    try:
        x = system.factored().solve(system.together(right, none))
    except SolveError:
        x = np.full((1, 1, 1), np.nan)
    if not np.isfinite(x).all() or np.abs(x).max() > 1e14 * np.abs(right).max():
        raise SolveError(
            "the stiffness is singular to working precision: a rigid motion is free, or the "
            "compression is critical"
        )
    return LoadedFields(*system.apart(x), right)
