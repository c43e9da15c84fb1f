"""What is asked of one component of a model that is driven harmonically."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from .. import _core
from ..base import check
from ..base.array import Complex, Flags, Index, Real
from ..base.computed import computed
from ..base.errors import SceneError, SolveError
from ..chain.chain import PLANE, Chain
from ..chain.compiled import EXACT, Compiled
from ..chain.lean import lean
from ..chain.port import Point, cut, is_force, locate, stops
from ..chain.reaction import at_start
from ..scene import damping


@dataclass(frozen=True, eq=False)
class Question:
    """What is asked of one component."""

    model: Compiled  # whose component it is
    component: tuple[str, ...]  # coordinates
    frequency: Real  # (f,) [Hz]
    factor: Complex  # (5, f) on sections, tension, springs, inertia and dashpots
    drives: list[Point]  # on these coordinates
    responses: list[Point]  # on these coordinates
    workers: int  # threads
    decay: float = 0.0  # the response is that at i omega + decay [1/s]

    @property
    def omega(self) -> Real | Complex:
        """-i s, shape (f,): real where nothing decays [rad/s]."""
        return angular(self.frequency, self.decay)

    @property
    def is_damped(self) -> Flags:
        """Whether a factor of something that this component has is complex, shape (f,)."""
        return damped_lines(self.walked[0], self.factor)

    def at(self, lines: Index) -> Question:
        """Return the same at some of its frequencies."""
        factor = np.ascontiguousarray(self.factor[:, lines])
        return replace(self, frequency=self.frequency[lines], factor=factor)

    @computed
    def cut(self) -> tuple[Chain, Real]:
        """The component's chain with nodes where points need them, and where they stand."""
        return self._cut(self.model.chain.only(self.component), self.model.x)

    @computed
    def walked(self) -> tuple[Chain, Real]:
        """The same without the nodes at which nothing stands and nobody asks."""
        return self.cut if len(self.lean[1]) == len(self.model.x) else self._cut(*self.lean)

    @computed
    def lean(self) -> tuple[Chain, Real]:
        """The component's chain without the nodes at which nothing stands, and where they are."""
        chain, kept = lean(self.model.chain.only(self.component))
        return chain, self.model.x[kept]

    def _cut(self, chain: Chain, x: Real) -> tuple[Chain, Real]:
        model, points = self.model, [*self.drives, *self.responses]
        between = [p for p in dict.fromkeys(points) if locate(x, p[1])[1] is not None]
        if model.element not in EXACT:
            for point in filter(is_force, between):
                raise SceneError(
                    "response of an internal force must stand at a node unless elements are "
                    f'"tensed", got {point} between nodes of {model.element!r} elements'
                )
            between = []
        positions = [p[1] for p in between]
        if model.element == "tensed":
            positions += stops(chain, x)
        if model.element == "continuous" and any(at_start(x, p) for p in self.responses):
            positions += self._short(chain, x)
        return cut(chain, x, positions)

    def _short(self, chain: Chain, x: Real) -> list[float]:
        """Return where the first element is cut so that its left end is far from resonances."""
        first = chain.between(0, 1)
        pieces = _core.steps(first, self.fastest)
        return [float(x[1]) / pieces]

    @property
    def fastest(self) -> Complex:
        """The factors of the highest frequency, shape (5, 1), or none where there is none."""
        factor = self.factor
        highest = [int(np.abs(factor[damping.INERTIA]).argmax())] if factor.size else []
        return factor.take(highest, axis=1)

    def resonance(self, k: int, more: str = "") -> OnResonance:
        """Return what says that frequency k has no answer."""
        return OnResonance(float(self.frequency[k]), self.component, more)


class OnResonance(SolveError):
    """A line [Hz] that a solver has no answer for."""

    def __init__(self, frequency: float, component: Sequence[str], more: str = "") -> None:
        super().__init__(
            f"frequency {frequency!r} Hz has no correct digit in ({', '.join(component)}): it lies "
            f"on an undamped resonance{more}"
        )
        self.frequency = frequency


Bound = Callable[[], Real]
"""What computes, when it is asked, how far rounding may have moved a response."""

Solver = Callable[[Question], tuple[Complex, Bound]]
"""What answers it: motion per force, (drives, responses, f), and what bounds its rounding."""


def angular(frequency: Real, decay: float) -> Real | Complex:
    """Return omega = -i s of s = i 2 pi frequency + decay, real where nothing decays [rad/s]."""
    omega = 2 * np.pi * frequency
    return np.asarray(omega - 1j * decay, dtype=np.complex128) if decay else omega


def damped_lines(chain: Chain, factor: Complex) -> Flags:
    """Return at which lines a factor of something that a component has is complex, shape (f,)."""
    names = {PLANE[k] for k in chain.coordinate}
    has = {
        damping.SECTION: names != {"z"},
        damping.TENSION: "z" in names and bool(chain.tension.any()),
        damping.SPRING: bool(chain.stiffness.any()),
        damping.INERTIA: True,
        damping.DASHPOT: chain.damping is not None
        or chain.drag is not None
        or (chain.attached_value is not None and bool(chain.attached_value[:, -1].any())),
    }
    found: Flags = np.zeros(factor.shape[1], dtype=np.bool_)
    for part, is_there in has.items():
        if is_there and not found.all():
            found |= factor[part].imag != 0
    return found


def workers_of(threads: int | None) -> int:
    """Return how many threads share the work: as given, as the environment says, or all cores."""
    if threads is not None:
        return check.count(threads, "threads", most=1024)
    text = os.environ.get("ROPEDYN_THREADS", "")
    if not text:
        return os.cpu_count() or 1
    if not text.isdecimal():
        raise SceneError(f"ROPEDYN_THREADS must be a whole number from 1 to 1024, got {text!r}")
    return check.count(int(text), "ROPEDYN_THREADS", most=1024)
