"""Natural frequencies as functions of what is sought, with their exact derivatives."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, field

import numpy as np

from ...base.array import Index, Real
from ...base.errors import SceneError
from ...eigen.eigen import solve_modes
from ...eigen.sensitivity import Sensitivity, Shapes
from ...eigen.vectors import solve_shapes
from ...model import Model
from .unknown import Unknowns

REMEMBERED = 8  # So many answers are kept.
MARGIN = 1.5  # The highest eigenvalue is thought to be at most so many times the last one.


@dataclass(frozen=True, eq=False)
class NaturalFrequencies:
    """Natural frequencies of a scene with unknown numbers."""

    unknowns: Unknowns  # what is sought
    elements: int | None = None  # as `Scene.compile` takes them
    element: str | None = None  # as `Scene.compile` takes them
    asked: OrderedDict[tuple[bytes, int], tuple[Real, Real]] = field(
        default_factory=OrderedDict, init=False, repr=False
    )
    highest: dict[int, float] = field(default_factory=dict, init=False, repr=False)

    def __call__(self, u: Real, count: int) -> tuple[Real, Real]:
        """Find the lowest frequencies, rigid motion and growth left out, or all there are."""
        key = u.tobytes(), count
        if key not in self.asked:
            if len(self.asked) == REMEMBERED:
                self.asked.popitem(last=False)
            self.asked[key] = self._solve(u, count)
        return self.asked[key]

    def _solve(self, u: Real, count: int) -> tuple[Real, Real]:
        shapes, kept = self._shapes(u, count)
        found = Sensitivity(shapes)
        slope = [self._derivative(found, i)[kept] for i in range(len(u))]
        frequency = np.sqrt(shapes.eigenvalue[kept]) / (2 * np.pi)
        return frequency, np.column_stack(slope) * self.unknowns.slope(u)

    def _derivative(self, found: Sensitivity, i: int) -> Real:
        try:
            return found.frequency(self.unknowns.paths[i])
        except SceneError as error:
            raise SceneError(
                f"unknown[{i}] must change natural frequencies, as damping does not, which a whole "
                f"response tells: {error}"
            ) from error

    def _shapes(self, u: Real, count: int) -> tuple[Shapes, Index]:
        """Return modes among which so many vibrate, or all there are, and which they are."""
        model = self.unknowns.at(u).compile(elements=self.elements, element=self.element)
        asked = count
        while True:
            shapes = self._lowest(model, asked)
            kept = np.flatnonzero(shapes.eigenvalue[:asked] > 0)[:count]
            if len(kept) == count or len(shapes.eigenvalue) < asked:
                return shapes, kept
            asked += count - len(kept)

    def _lowest(self, model: Model, number: int) -> Shapes:
        """Return the lowest modes, by one solution where the highest is where it is thought."""
        thought = self.highest.get(number)
        if thought is not None:
            shapes = solve_shapes(model, "sweep", np.full(number, thought))
            highest = float(shapes.eigenvalue.max(initial=0.0))
            self.highest[number] = MARGIN * highest
            if highest <= thought:
                return shapes
        found = solve_modes(model, number, below=None, solver="sweep", strict=False).eigenvalue
        self.highest[number] = MARGIN * float(found.max(initial=0.0))
        return solve_shapes(model, "sweep", found)
