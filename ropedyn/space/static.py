"""The static deflection of a rope on an axis."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from ..base import check
from ..base.answer import Cost
from ..base.array import Real
from ..base.computed import Late
from ..base.errors import SolveError
from ..chain.port import Point
from ..eigen.vectors import within
from ..response.critical import exceeds
from ..response.deflection import POINTS, Deflection, summed_loads
from ..scene.scene import Scene
from .assembly import Assembly, assemble, bound
from .compile import finer_rope
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
    x = np.concatenate([within(rope.x, points or POINTS), [at for _, at in loads]])
    cut, _ = rope.cut(x, near)
    x = cut.x
    system, u, f = _under(cut, loads)
    z = system.z[0]
    shown = u[0, system.node, :, 0][:, own]

    def mesh() -> Real:
        finer = finer_rope(scene, rope)
        if finer is None:
            return _same(shown.shape, 0.0)
        other, node = finer.cut(x, near)
        whole, v, _ = _under(other, loads)
        return np.abs(shown * z[own] - v[0, whole.node[node], :, 0][:, own] * whole.z[0][own])

    return Deflection(
        coordinates=rope.coordinates,
        x=x,
        displacement=shown * z[own],
        force=(_force(system, u[0], f[0]) / z)[:, own],
        load=tuple(loads.items()),
        critical_loads=critical,
        cost=Cost("sweep", len(rope.length), rope.unknowns, sweeps=1, factorisations=1),
        rounding_error=Late(partial(_rounding, system, (u, f))),
        force_rounding_error=_same(shown.shape, np.inf),
        mesh_error=Late(mesh),
    )


def _under(rope: SpaceRope, loads: dict[Point, float]) -> tuple[Assembly, Real, Real]:
    """Return the parts, their motion and force under loads at nodes."""
    system = assemble(rope, unforced([0.0]), rope.scale([0.0]))
    right = np.zeros((system.parts + 1, 6, 1))
    for (coordinate, at), amount in loads.items():
        k = SIX.index(coordinate)
        right[system.node[int(np.abs(rope.x - at).argmin())], k] += amount * system.z[0, k]
    return system, *_solved(system, right)


def _same(shape: tuple[int, ...], value: float) -> Real:
    error = np.full(shape, value)
    error.setflags(write=False)
    return error


def _solved(system: Assembly, right: Real) -> tuple[Real, Real]:
    """Return motion and force of columns of loads (parts + 1, 6, columns)."""
    right = np.where(system.held[:, :, None], 0.0, right)[None]
    none = np.zeros((1, system.parts, 6, right.shape[3]))
    try:
        x = system.factored(real=True).solve(system.together(right, none))
    except SolveError:
        x = np.full((1, 1, 1), np.nan)
    if not np.isfinite(x).all() or np.abs(x).max() > 1e14 * np.abs(right).max():
        raise SolveError(
            "the stiffness is singular to working precision: a rigid motion is free, or the "
            "compression is critical"
        )
    return system.apart(x)


def _force(system: Assembly, u: Real, f: Real) -> Real:
    """Return what the surroundings put on the nodes: f_b on the left less f_a on the right."""
    D, Q = system.D[0].real, system.Q[0].real
    force = np.zeros(u.shape)
    force[1:] += f
    force[:-1] += Q @ u[:-1] - f - D.swapaxes(1, 2) @ f
    return force[system.node, :, 0]


def _rounding(system: Assembly, found: tuple[Real, Real]) -> Real:
    """Bound what rounding does to the displacement, shape (nodes, 6)."""
    nodes = len(system.node)
    unit = np.zeros((system.parts + 1, 6, 6 * nodes))
    unit[np.repeat(system.node, 6), np.tile(np.arange(6), nodes), np.arange(6 * nodes)] = 1.0
    limit = bound(system, found, _solved(system, unit))[0, 0].reshape(nodes, 6) * system.z[0]
    limit[system.held[system.node]] = 0.0
    limit = limit[:, ~system.absent]
    limit.setflags(write=False)
    return limit
