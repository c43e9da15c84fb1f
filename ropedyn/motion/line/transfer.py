"""The transfer functions of a model at any complex rates, by the sweep along it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from ...base.array import Complex, Real
from ...chain import tip
from ...chain.compiled import Compiled
from ...chain.port import Point
from ...response.harmonic import Receptance, by_components, line_by_line
from ...response.moved_end import moves_ends
from ...response.question import Question
from ...response.solvers import SOLVERS
from ...scene import damping


@dataclass(frozen=True, eq=False)
class Transfer:
    """What responses are to drives, in the rate s of a motion e^(s t)."""

    model: Compiled
    drives: tuple[Any, ...]  # forces, moments, motion of ends
    responses: tuple[Point, ...]  # motion, internal forces, tips of wires
    workers: int = 1  # threads

    def at(self, s: Complex) -> Complex:
        """Return it, shape (drives, responses, n)."""
        factor, got = self._solved(s)
        return tip.gather(self.model, self.responses, factor, got.value)

    def rounding(self, s: Complex) -> Real:
        """Return what bounds its rounding, shape (drives, responses, n)."""
        factor, got = self._solved(s)
        return tip.gather_error(self.model, self.responses, factor, got.value, got.bound())

    def _solved(self, s: Complex) -> tuple[Complex, Receptance]:
        """Return the factors of the parts of a model, and what they make responses."""
        factor = np.ascontiguousarray(damping.factors(self.model.scene.dampings, -1j * s).T)
        asked = tip.spread(self.model, self.responses)
        hertz = np.abs(s) / (2 * np.pi)
        every = self.model.coordinates
        whole = Question(self.model, every, hertz, factor, list(self.drives), asked, self.workers)
        solve = partial(line_by_line, solver=moves_ends(SOLVERS["sweep"]))
        return factor, by_components(whole, solve)
