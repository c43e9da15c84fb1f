"""The transfer functions of a model at any complex rates, by the sweep along it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, Protocol

import numpy as np

from ...base.array import Complex, Real
from ...base.errors import SceneError
from ...chain import tip
from ...chain.compiled import Compiled
from ...chain.port import Point
from ...eigen.damped.rates import Rates
from ...eigen.spectrum import count_component, slowest_lump, spectrum
from ...response.harmonic import Receptance, by_components, line_by_line
from ...response.moved_end import moves_ends
from ...response.question import Question
from ...response.solvers import SOLVERS
from ...scene import damping

MOST = 1 << 19  # Rates, or
FURTHER = 4  # so many times as far as the times resolve.


class TransferFunctions(Protocol):
    """What responses are to drives, in the rate s of a motion e^(s t)."""

    @property
    def growth(self) -> float:
        """How fast motion grows at most [1/s]."""

    @property
    def ahead(self) -> float:
        """How fast motion fades before what causes it at least [1/s], infinite where none is."""

    def most(self, omega: float, resolved: int) -> int:
        """Return how many rates up to one [rad/s] are looked at, where times resolve so many."""

    def at(self, s: Complex) -> Complex:
        """Return it, shape (drives, responses, n)."""

    def rounding(self, s: Complex) -> Real:
        """Return what bounds its rounding, shape (drives, responses, n)."""


@dataclass(frozen=True, eq=False)
class Transfer:
    """What responses are to drives, in the rate s of a motion e^(s t)."""

    model: Compiled
    drives: tuple[Any, ...]  # forces, moments, motion of ends
    responses: tuple[Point, ...]  # motion, internal forces, tips of wires
    workers: int = 1  # threads

    @property
    def growth(self) -> float:
        """How fast motion grows at most [1/s]."""
        model, stiffness = self.model, self.model.chain.stiffness
        pushed = (c for c in model.components if count_component(model, c, 0.0))
        least = min((float(spectrum(model, c, 1)[0][0]) for c in pushed), default=0.0)
        pushes = bool((np.linalg.eigvalsh(stiffness) < 0).any())
        return growth_below(min(least, 0.0), model.scene.dampings, pushes=pushes)

    @property
    def ahead(self) -> float:
        """How fast motion fades before what causes it at least [1/s], infinite where none is.

        So a lump of negative inertia -m moves: -m s^2 + k = 0, and with drag a of the mass
        -m (s^2 + a s) + k = 0; what else resists makes it faster.
        """
        model = self.model
        slowest = min(slowest_lump(model, c) for c in model.components)
        drag = float(Rates.of(model.scene.dampings).linear[damping.INERTIA].real) / 2
        return math.hypot(slowest, drag) - drag

    def most(self, _omega: float, resolved: int) -> int:
        """Return how many rates are looked at."""
        return max(MOST, FURTHER * resolved)

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
        on_line = bool(len(s)) and bool((s.real == s.real[0]).all() and (s.imag >= 0).all())
        hertz, decay = (s.imag, float(s.real[0])) if on_line else (np.abs(s), 0.0)
        every, drives = self.model.coordinates, list(self.drives)
        whole = Question(
            self.model, every, hertz / (2 * np.pi), factor, drives, asked, self.workers, decay
        )
        solve = partial(line_by_line, solver=moves_ends(SOLVERS["sweep"]))
        return factor, by_components(whole, solve)


def growth_below(least: float, dampings: Sequence[damping.Damping], *, pushes: bool) -> float:
    """Return how fast motion grows at most where no eigenvalue is less [1/s].

    Refuse damping that drives, so that nothing bounds it.
    """
    section, tension, spring, *_ = Rates.of(dampings).linear.real
    if spring > 0 and pushes and not section == tension == spring:
        raise SceneError(
            "a spring's stiffness must be > 0 beside stiffness damping, which drives where it "
            "pushes away, got less"
        )
    half = tension * -least / 2
    return float(half + math.sqrt(half * half - least))
