"""The lowest modes of all components: those that have none among them are counted, not solved."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

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
    names = model.components

    def solve(k: int, wanted: int | None) -> ComponentModes:
        return SOLVERS[solver](model, names[k], wanted, limit, shaped=shaped)

    if number is None or len(names) == 1 or solver != "sweep":
        # the assembled solver stays one that no count of the sweep has a say in
        return [solve(k, number) for k in range(len(names))]
    empty = [_none_of(model, component) for component in names]
    order = sorted(range(len(names)), key=lambda k: "z" not in names[k])
    return fewest(number, order, solve, lambda k, top: count_component(model, names[k], top), empty)


def fewest(
    number: int,
    order: Sequence[int],
    solve: Callable[[int, int], ComponentModes],
    count: Callable[[int, float], int],
    empty: Sequence[ComponentModes],
) -> list[ComponentModes]:
    """Solve parts in some order, of each as many modes as it has below the last one wanted."""
    found: dict[int, ComponentModes] = {}
    for k in order:
        top, wanted = _last(list(found.values()), number), number
        if top < math.inf:
            try:
                wanted = min(count(k, top), number)
            except SolveError:
                wanted = number  # what cannot be counted is solved
        found[k] = solve(k, wanted) if wanted else empty[k]
    return [found[k] for k in range(len(order))]


def _last(found: Sequence[ComponentModes], number: int) -> float:
    """Return what the last mode wanted is below, infinite where it is not known or not above 0."""
    if sum(len(part.eigenvalue) for part in found) < number:
        return math.inf
    eigenvalue, error, _ = merged(found, number)
    last = float(eigenvalue[-1])
    return last * (1 + APART) + 4 * float(error[-1]) if last > 0 else math.inf


def _none_of(model: Compiled, component: tuple[str, ...]) -> ComponentModes:
    """Return what a component is that has no mode among those wanted."""
    none = np.zeros(0)
    shape = np.zeros((0, len(model.x), len(component)))
    return ComponentModes(none, none, shape, True, Work())
