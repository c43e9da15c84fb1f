"""The lowest modes of all components: those that have none among them are counted, not solved."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..base.answer import Work
from ..base.errors import SolveError
from ..chain.compiled import Compiled
from .spectrum import SOLVERS, ComponentModes, count_component, merged

APART = 1e-9
"""Eigenvalues that are relatively nearer than this to the last one wanted are solved as well."""


def solve_components(
    model: Compiled, solver: str, number: int | None, limit: float, *, shaped: bool
) -> list[ComponentModes]:
    """Return what each component has of the lowest modes, or all its modes below a limit."""
    found: dict[tuple[str, ...], ComponentModes] = {}
    for component in sorted(model.components, key=lambda names: "z" not in names):
        # the assembled solver stays one that no count of the sweep has a say in
        wanted = number
        if number is not None and solver == "sweep":
            wanted = _wanted(model, component, list(found.values()), number)
        found[component] = (
            _none_of(model, component)
            if wanted == 0
            else SOLVERS[solver](model, component, wanted, limit, shaped=shaped)
        )
    return [found[component] for component in model.components]


def _wanted(
    model: Compiled, component: tuple[str, ...], found: Sequence[ComponentModes], number: int
) -> int:
    """Count the modes of a component below the last one that is wanted, as far as it is known."""
    if sum(len(part.eigenvalue) for part in found) < number:
        return number
    eigenvalue, error, _ = merged(found, number)
    last, uncertain = float(eigenvalue[-1]), float(error[-1])
    if not last > 0:
        return number
    try:
        return min(count_component(model, component, last * (1 + APART) + 4 * uncertain), number)
    except SolveError:
        return number  # what cannot be counted is solved


def _none_of(model: Compiled, component: tuple[str, ...]) -> ComponentModes:
    """Return what a component is that has no mode among those wanted."""
    none, shape = np.zeros(0), np.zeros((0, len(model.x), len(component)))
    return ComponentModes(none, none, shape, True, Work())
