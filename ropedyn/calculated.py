"""Natural frequencies as functions of what is sought, with their exact derivatives."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .eigen import solve_modes
from .errors import SceneError
from .modes import Modes
from .unknown import Unknowns

Real = NDArray[np.float64]

REMEMBERED = 8
"""Answers."""


@dataclass(frozen=True, eq=False)
class Calculated:
    """Natural frequencies of a scene with unknown numbers.

    Attributes
    ----------
    unknowns : Unknowns
        What is sought.
    elements, element
        As `Scene.compile` takes them.
    """

    unknowns: Unknowns
    elements: int | None = None
    element: str | None = None
    asked: OrderedDict[tuple[bytes, int], tuple[Real, Real]] = field(
        default_factory=OrderedDict, init=False, repr=False
    )

    def __call__(self, u: Real, count: int) -> tuple[Real, Real]:
        """Find the lowest frequencies, rigid motion and growth left out, or all there are.

        Parameters
        ----------
        u : ndarray, shape (p,)
            The variables.
        count : int
            How many.

        Returns
        -------
        frequency : ndarray, shape (count,)
            [Hz].
        slope : ndarray, shape (count, p)
            df/du [Hz].
        """
        key = u.tobytes(), count
        if key not in self.asked:
            if len(self.asked) == REMEMBERED:
                self.asked.popitem(last=False)
            self.asked[key] = self._solve(u, count)
        return self.asked[key]

    def _solve(self, u: Real, count: int) -> tuple[Real, Real]:
        modes, kept = self._modes(u, count)
        slope = [self._derivative(modes, i)[kept] for i in range(len(u))]
        return modes.frequency[kept], np.column_stack(slope) * self.unknowns.slope(u)

    def _derivative(self, modes: Modes, i: int) -> Real:
        try:
            return modes.derivative(self.unknowns.paths[i])
        except SceneError as error:
            raise SceneError(f"unknown[{i}] must change natural frequencies: {error}") from error

    def _modes(self, u: Real, count: int) -> tuple[Modes, NDArray[np.intp]]:
        """Return modes among which so many vibrate, or all there are, and which they are."""
        model = self.unknowns.at(u).compile(elements=self.elements, element=self.element)
        still = 0
        while True:
            asked = count + still
            modes = solve_modes(model, asked, below=None, solver="sweep", strict=False)
            kept = np.flatnonzero(modes.frequency > 0)[:count]
            if len(kept) == count or len(modes.frequency) < asked:
                return modes, kept
            still = asked - len(kept)
