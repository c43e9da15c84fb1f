"""The undamped modes of a model, and how far they are from those of continuous spans."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial

import numpy as np
from numpy.typing import NDArray

from ..axis.axis import Axis
from ..base import check
from ..base.answer import Cost, Work
from ..base.array import Index, Real
from ..base.errors import SceneError, SolveError
from ..chain.chain import plane_of
from ..chain.compile import check_points, compile_scene
from ..chain.compiled import Compiled
from ..scene.scene import Scene
from .catenary import on_catenary
from .fewest import solve_components
from .measured import rounding_of
from .modes import Modes, UndampedMesh, UndampedVectors
from .spectrum import (
    SOLVERS,
    ComponentModes,
    distance,
    eigenvalue_of,
    error_in_hertz,
    in_hertz,
    merged,
    refuse_short_waves,
    spectrum,
)
from .vectors import later_vectors, later_within, places_within, solve_shapes, vectors_of

MOST_MODES = 2**31 - 1  # So many can be asked for.


def solve_modes(
    model: Compiled,
    number: int | None,
    *,
    below: float | None,
    solver: str,
    points: int | None = None,
    strict: bool = True,
) -> Modes:
    """Find natural frequencies and shapes; see `Model.modes`."""
    # without `strict` fewer modes than asked for are no error
    check.one_of(solver, "solver", SOLVERS)
    check_points(model, points)
    if model.element == "continuous" and solver != "sweep":
        raise SceneError(f'solver must be "sweep" for continuous spans, got {solver!r}')
    limit = check_asked(number, below)
    if below is not None:
        refuse_short_waves(model, limit)
    found = solve_components(model, solver, number, limit, shaped=False)
    existing = sum(len(part.eigenvalue) for part in found)
    if strict and number is not None and number > existing:
        raise SolveError(
            f"number must be at most {existing}, the modes this model has, got {number}"
        )
    eigenvalue, error, order = merged(found, number)
    which = _which(found, order)
    later: Callable[[], UndampedVectors] = partial(later_vectors, model, solver, which, limit)
    frequency = np.sqrt(np.maximum(eigenvalue, 0.0)) / (2 * math.pi)
    mesh: Callable[[], UndampedMesh]
    x: Real | Callable[[], Real] = model.x
    if model.element == "continuous":
        mesh = partial(no_mesh, frequency)
        x = partial(places_within, model, eigenvalue, points)
        later = partial(later_within, model, which, limit, eigenvalue, points)
    else:
        mesh = partial(mesh_of_modes, model.scene, model.components, which, eigenvalue)
    return Modes(
        coordinates=model.coordinates,
        certified=all(part.certified for part in found),
        x=x,
        frequency=frequency,
        eigenvalue=eigenvalue,
        growth=np.sqrt(np.maximum(-eigenvalue, 0.0)),
        rounding_error=partial(rounding_of, model, which, eigenvalue, error),
        rounding_bound=error_in_hertz(eigenvalue, error),
        plane=partial(_planes, model, which),
        cost=_cost(model, solver, found),
        vectors=later if solver == "sweep" else vectors_of(model, found, eigenvalue, order),
        mesh=mesh,
        hanging=partial(on_catenary, model, which, frequency),
        solve_shapes=partial(solve_shapes, model, solver, eigenvalue, which),
        line=partial(Axis.line, model.scene.rope.length),
    )


def _which(found: Sequence[ComponentModes], order: Index) -> Index:
    """Return the component of each mode."""
    if len(found) == 1:
        return np.zeros(len(order), dtype=np.intp)
    return np.repeat(np.arange(len(found)), [len(part.eigenvalue) for part in found])[order]


def _planes(model: Compiled, which: Index) -> NDArray[np.str_]:
    """Return the plane of each mode: that of the coordinates that move with it."""
    return np.array([plane_of(component) for component in model.components])[which]


def check_asked(number: int | None, below: float | None) -> float:
    """Check that one of both is given; return the limit of eigenvalues [rad^2/s^2]."""
    if (number is None) == (below is None):
        raise SceneError(f"give either number or below, got number={number!r} and below={below!r}")
    if number is not None:
        check.count(number, "number", most=MOST_MODES)
    return math.inf if below is None else eigenvalue_of(below)


def _cost(model: Compiled, solver: str, found: Sequence[ComponentModes]) -> Cost:
    work = Work.of(part.work for part in found)
    share = work.redone / max(sum(len(part.eigenvalue) for part in found), 1)
    return Cost(solver, len(model.x) - 1, model.size, work.sweeps, work.factorisations, share)


def no_mesh(frequency: Real) -> UndampedMesh:
    """Return what continuous spans say about themselves."""
    return UndampedMesh(mesh_error=np.zeros_like(frequency), limit=frequency)


def mesh_of_modes(
    scene: Scene, components: tuple[tuple[str, ...], ...], which: Index, eigenvalue: Real
) -> UndampedMesh:
    """Compare the modes of a chain with those of continuous spans."""
    error, limit = np.full(len(eigenvalue), np.inf), np.full(len(eigenvalue), np.nan)
    try:
        continuous = compile_scene(scene)
    except SceneError:
        return UndampedMesh(mesh_error=error, limit=limit)
    for k, component in enumerate(components):
        mine = np.flatnonzero(which == k)
        true, uncertain = _lowest(continuous, component, len(mine))
        mine = mine[: len(true)]
        error[mine] = distance(eigenvalue[mine], true, uncertain)
        limit[mine] = np.maximum(in_hertz(true), 0.0)
    return UndampedMesh(mesh_error=error, limit=limit)


def _lowest(model: Compiled, component: tuple[str, ...], number: int) -> tuple[Real, Real]:
    """Return the lowest eigenvalues and their errors [rad^2/s^2]."""
    # None where they are refused or too much for the memory: the chain's own answer stands
    if number > 0:
        with suppress(SolveError, MemoryError):
            return spectrum(model, component, number)
    return np.zeros(0), np.zeros(0)
