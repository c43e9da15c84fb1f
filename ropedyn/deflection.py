"""Static deflection."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _core, check
from .answer import Answer, Cost, axes
from .errors import SceneError, SolveError
from .model import Model, Point, ports
from .table import Table
from .unit import FORCE, FORCE_UNIT, UNIT

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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
    condition : ndarray, shape (components,)
        Reciprocal condition number of the stiffness, scaled to a unit diagonal.
    cost : Cost
        What it cost.
    """

    coordinates: tuple[str, ...]
    x: NDArray[np.float64] = field(metadata=axes("node", unit="m"))
    displacement: NDArray[np.float64] = field(metadata=axes("node", "coordinate", unit="m or rad"))
    force: NDArray[np.float64] = field(metadata=axes("node", "coordinate", unit="N or N m"))
    condition: NDArray[np.float64] = field(metadata=axes("component"))
    cost: Cost

    def table(self) -> Table:
        """Return displacement and force at every node."""
        columns: dict[str, Any] = {"x [m]": self.x}
        for k, c in enumerate(self.coordinates):
            columns[f"{c} [{UNIT[c]}]"] = self.displacement[:, k]
        for k, c in enumerate(self.coordinates):
            columns[f"{FORCE[c]} [{FORCE_UNIT[c]}]"] = self.force[:, k]
        return Table.of("static deflection", columns)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the deflection along the rope, each coordinate to its largest."""
        from .plotting import plot_deflection

        return plot_deflection(self, ax)


def solve_static(model: Model, load: Mapping[Point, float], *, solver: str) -> Deflection:
    """Find the static deflection; see `Model.static`."""
    check.one_of(solver, "solver", ("lapack",))
    loads = _checked(model, load)
    width = len(model.coordinates)
    displacement = np.zeros((len(model.x), width))
    force = np.zeros((len(model.x), width))
    condition, unknowns = [], 0
    start = time.perf_counter()
    for component in model.components:
        here = {point: value for point, value in loads.items() if point[0] in component}
        if not here:
            continue
        chain = model.chain.only(component)
        at = [model.coordinates.index(c) for c in component]
        try:
            displacement[:, at], reciprocal = _core.deflection(
                chain, _nodal(model, component, here)
            )
        except SolveError as error:
            raise SolveError(
                f"{', '.join(component)}: {error}: a rigid motion is free, the compression is "
                "critical, or there are too many elements for the assembled stiffness"
            ) from error
        force[:, at] = _held_up(model, component, displacement[:, at])
        condition.append(reciprocal)
        unknowns += chain.free
    seconds = time.perf_counter() - start
    cost = Cost(seconds, "lapack", len(model.x) - 1, unknowns, len(condition))
    return Deflection(
        coordinates=model.coordinates,
        x=model.x,
        displacement=displacement,
        force=force,
        condition=np.array(condition),
        cost=cost,
    )


def _checked(model: Model, load: Any) -> dict[Point, float]:
    what = 'a mapping such as {("z", 0.5): 10.0}'
    check.instance(load, "load", Mapping, what)
    if not load:
        raise SceneError(f"load must be {what} with at least one entry, got {{}}")
    loads: dict[Point, float] = {}
    for key, value in load.items():
        point = check.point(key, "load point", model.coordinates, model.scene.rope.length)
        unit = FORCE_UNIT[point[0]]
        loads[point] = loads.get(point, 0.0) + check.number(value, f"load[{key}]", unit)
    return loads


def _nodal(
    model: Model, component: tuple[str, ...], loads: dict[Point, float]
) -> NDArray[np.float64]:
    """Return the forces on the nodes that the loads amount to."""
    chain = model.chain.only(component)
    node, row = ports(model, chain, component, loads)
    force = np.zeros((len(model.x), len(component)))
    for left, shape, value in zip(node, row, loads.values()):
        force[left : left + 2] += shape * value
    return force


def _held_up(
    model: Model, component: tuple[str, ...], u: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return what the elements need from outside at every node: K_elements u."""
    elastic, elastic_beside, string, string_beside, _, _ = _core.assemble(
        model.chain.only(component)
    )
    force = np.einsum("nij,nj->ni", elastic + string, u)
    beside = elastic_beside + string_beside
    force[:-1] += np.einsum("nij,nj->ni", beside, u[1:])
    force[1:] += np.einsum("nji,nj->ni", beside, u[:-1])
    return force
