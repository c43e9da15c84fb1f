"""The smallest chain that meets a tolerance."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.errors import SceneError, SolveError
from ..chain.chain import KINDS
from ..chain.compile import MOST_ELEMENTS, compile_scene, stations_of
from ..chain.compiled import Compiled
from ..chain.mesh_choice import Choice
from ..scene.scene import Scene
from .spectrum import count_component, distance, eigenvalue_of, in_hertz, spectrum

NEAR = 0.05  # The chain that is chosen has so much more elements than one that fails, or one more.
FARTHEST = 16
"""The next chain has at most so many times the elements of one that failed."""
SECANTS = 4
"""Interpolations between a chain that fails and one that does not, before they are halved."""
Component = tuple[str, ...]


def compile_within(
    scene: Scene, *, tolerance: Any, below: Any, elements: Any, element: str | None
) -> Compiled:
    """Compile a scene, to the smallest chain within a tolerance if given; see `Scene.compile`."""
    if tolerance is None and below is None:
        return compile_scene(scene, elements=elements, element=element)
    if tolerance is None or below is None:
        raise SceneError(
            f"give both tolerance and below or none, got tolerance={check.shown(tolerance)} and "
            f"below={check.shown(below)}"
        )
    if elements is not None:
        raise SceneError(
            "elements must be left out where tolerance chooses them, got " + check.shown(elements)
        )
    element = check.one_of("tensed" if element is None else element, "element", KINDS)
    if element == "continuous":
        raise SceneError(
            'element must not be "continuous" where tolerance is given: continuous spans have no '
            "mesh error"
        )
    within = check.number(tolerance, "tolerance", sign="positive")
    if within >= 1:
        raise SceneError(f"tolerance must be below 1, the whole frequency, got {tolerance!r}")
    highest = check.number(below, "below", "Hz", sign="positive")
    least = len(stations_of(scene)) - 1
    coarsest = compile_scene(scene, elements=least, element=element)  # refuses what no chain can be
    chains = ChainErrors(scene, element, eigenvalue_of(highest))
    tried = Search(
        chains.error,
        start=chains.start(least),
        least=least,
        order=chains.order(coarsest),
        tolerance=within,
    ).run()
    chosen = min((n for n, error in tried.items() if error <= within), default=0)
    if chosen == 0:
        n = min(tried, key=tried.__getitem__)
        raise SolveError(
            f"tolerance must be one that {element} elements meet: their relative mesh error below "
            f"{highest:g} Hz is {tried[n]:.2g} with {n}, the best of {len(tried)} chains of up to "
            f"{max(tried)}, got {tolerance!r}"
        )
    choice = Choice(
        tolerance=within,
        below=highest,
        element=element,
        elements=chosen,
        mesh_error=tried[chosen],
        frequencies=chains.frequencies,
        tried=tuple(tried.items()),
    )
    return replace(compile_scene(scene, elements=chosen, element=element), choice=choice)


class ChainErrors:
    """How wrong chains of a scene are below a limit."""

    def __init__(self, scene: Scene, element: str, limit: float):
        self.scene, self.element, self.limit = scene, element, limit
        self.continuous = compile_scene(scene)
        # (eigenvalues, errors) of each component, more of them where a chain has more below
        self.true = {
            c: spectrum(self.continuous, c, None, limit) for c in self.continuous.components
        }
        self.existing = {c: len(eigenvalue) for c, (eigenvalue, _) in self.true.items()}
        self.frequencies = sum(int(np.count_nonzero(true)) for true, _ in self.true.values())

    def order(self, chain: Compiled) -> float:
        """Return the order of what there is below; what leads elsewhere is sought all the same."""
        moving = {c for part, number in self.existing.items() if number > 0 for c in part}
        return max(min((chain.mesh_order[c] for c in moving), default=2.0), 1.0)

    def start(self, least: int) -> int:
        """Return a small chain that has the frequencies: three elements to a half wave."""
        return min(max(least, 3 * max(self.existing.values())), MOST_ELEMENTS)

    def error(self, elements: int) -> float:
        """Return the largest relative mesh error below the limit, infinite where a mode lacks."""
        chain = compile_scene(self.scene, elements=elements, element=self.element)
        try:
            return max(self._error(chain, component) for component in self.true)
        except SolveError:
            return math.inf

    def _error(self, chain: Compiled, component: Component) -> float:
        """Return that of one component; what lies below the limit in the chain only counts too."""
        number = max(self.existing[component], count_component(chain, component, self.limit))
        if number == 0:
            return 0.0
        true, uncertain = self._first(component, number)
        found, _ = spectrum(chain, component, number)
        if len(found) < number:
            return math.inf
        relative = np.zeros(number)
        size = np.abs(in_hertz(true))
        np.divide(distance(found, true, uncertain), size, out=relative, where=size > 0)
        return float(relative.max())

    def _first(self, component: Component, number: int) -> tuple[Real, Real]:
        """Return so many of the true eigenvalues and their errors."""
        if number > len(self.true[component][0]):
            self.true[component] = spectrum(self.continuous, component, number)
        true, uncertain = self.true[component]
        return true[:number], uncertain[:number]


class Search:
    """The fewest elements whose error is within a tolerance, where it falls as C n^-p."""

    def __init__(
        self,
        error: Callable[[int], float],
        *,
        start: int,
        least: int,
        order: float,
        tolerance: float,
    ):
        self.error, self.start, self.order, self.tolerance = error, start, order, tolerance
        self.low, self.high = least - 1, MOST_ELEMENTS + 1
        """Too few, and enough or more than there can be."""
        self.tried: dict[int, float] = {}

    def run(self) -> dict[int, float]:
        """Return the error of each number of elements that was tried, in order."""
        n, between = self.start, 0
        while True:
            self.tried[n] = self.error(n)
            if self.tried[n] <= self.tolerance:
                self.high = n
            else:
                self.low = n
            near = NEAR * self.low if self.high in self.tried else 0.0
            if self.high - self.low <= max(1.0, near):
                return self.tried
            between += self.low in self.tried and self.high in self.tried
            n = self._next(halve=between > SECANTS)

    def _next(self, *, halve: bool) -> int:
        """Return the number that decides most: as predicted, but no nearer than need be."""
        low, high = self.low, self.high
        first, last = low + max(1, int(NEAR * low)), high - max(1, int(NEAR / (1 + NEAR) * high))
        predicted = self._predicted()
        if high not in self.tried:
            first, last = min(2 * low, MOST_ELEMENTS), min(FARTHEST * low, MOST_ELEMENTS)
            predicted *= 1 + NEAR
        if halve or first > last:
            return max(low + 1, math.isqrt(low * high))
        return min(max(math.ceil(predicted), first), last)

    def _predicted(self) -> float:
        """Return where C n^-p meets the tolerance; C and p of the two chains next to it."""
        errors = self.tried
        known = sorted(n for n in errors if 0 < errors[n] < math.inf)
        if not known:
            return 0.0 if self.high in errors else 2.0 * self.low
        a, *more = sorted(known, key=lambda n: abs(math.log(errors[n] / self.tolerance)))
        p = self.order
        if more:
            b = more[0]
            p = math.log(errors[a] / errors[b]) / math.log(b / a)
        p = min(max(p, 0.5), 2 * self.order)
        # C n^-p = e at a, so that n = a (e/tolerance)^(1/p)
        power = min(math.log(errors[a] / self.tolerance) / p, 40.0)
        return a * math.exp(power)
