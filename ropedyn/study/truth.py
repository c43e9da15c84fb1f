"""What answers are measured against, and which ways to the answer are worth a trial."""

from __future__ import annotations

import tracemalloc
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..ask import AnyQuestion
from ..base.array import Flags, Real
from ..base.errors import SceneError, SolveError
from ..scene.scene import Scene
from .way import Way, answered, ask_once

# Spans are cut into so many parts for other arithmetic; powers of two would join to the same bits.
CUTS = (3, 5, 7)
FEWEST, MOST = 3, 12  # Chains are tried between these powers of two.
LONGEST = 0.03  # Chains that nobody asked for by number of elements may take so long each [s].
ALWAYS = 2  # So many numbers of elements are tried however slow the question is.
EPSILON = float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class Truth:
    """What answers are measured against: continuous spans."""

    scene: Scene  # what is asked about
    question: AnyQuestion  # what is asked, and timed
    same: AnyQuestion  # the same for exactly as many values as the true answer has
    values: NDArray[Any]  # true ones
    # which of them have a correct digit: what is 0 by symmetry is nothing but rounding
    known: Flags
    error: float  # their own largest relative error, seen in other cuts of the same spans
    floor: float  # that of the method, which cuts do not show: below it no error is seen
    spans: int  # how many

    @staticmethod
    def of(scene: Scene, question: AnyQuestion) -> Truth:
        """Ask continuous spans, whole and cut."""
        scene = question.placed(scene)
        whole = answered(question, scene, {})
        values = question.values(whole.answer)
        known = np.isfinite(values)
        if question.bounded:
            known &= question.rounding(whole.answer) < 1
        if not known.any():
            raise SolveError(f"continuous spans have no correct digit of the {question}")
        same, spans = question.like(whole.answer), len(whole.model.x) - 1
        floor = _largest(question.unseen(whole.answer), known)
        error = floor
        for parts in CUTS:
            cut = Way.of(same, scene, {"elements": parts * spans, "element": "continuous"}).answer
            error = max(error, _largest(same.apart(same.values(cut), values), known))
        return Truth(scene, question, same, values, known, error, floor, spans)

    def ways(
        self, kinds: Sequence[str], counts: Sequence[int] | None, solvers: Sequence[str]
    ) -> list[tuple[str, int, str]]:
        """Return element, number of elements and solver of every way to the answer."""
        found: list[tuple[str, int, str]] = []
        for kind in kinds:
            if kind != "continuous":
                found += [(kind, n, s) for s in solvers for n in counts or self._sensible(kind, s)]
            else:
                able = [s for s in solvers if s in self.question.of_spans]
                found += [(kind, self.spans, s) for s in able]
        return found

    def _sensible(self, kind: str, solver: str) -> Iterator[int]:
        """Return powers of two from 8, or from the number of spans, that are not too slow.

        Of chains that there are none of the first alone, whose row says why.
        """
        first = max(FEWEST, (self.spans - 1).bit_length())
        for power in range(first, max(MOST, first + 3) + 1):
            try:
                model = self.scene.compile(elements=2**power, element=kind)
            except SceneError:
                yield 2**power
                return
            if power >= first + ALWAYS and self.question.work(model, solver) > LONGEST:
                return
            yield 2**power

    def tried(self, kind: str, elements: int, solver: str) -> tuple[Way, dict[str, float]]:
        """Try a way, and return it with its errors and the digits that it loses."""
        continuous = kind == "continuous"
        how = {} if continuous else {"elements": elements, "element": kind}
        with peak_memory() as memory:
            way = same = Way.of(self.question, self.scene, how, solver)
        if self.same is not self.question:
            same = Way.of(self.same, self.scene, how, solver)
        values, bound = self.same.values(same.answer), self.same.rounding(same.answer)
        error, estimated = self.error, bound
        if not continuous:
            if not np.isfinite(values[self.known]).all():
                raise SolveError(f"the {self.question} has no numbers to compare")
            error = max(_largest(self.same.apart(values, self.values), self.known), self.floor)
            estimated = self.same.mesh(same.answer) + bound
        lost = bound if solver == self.question.solvers[0] else self._rounding(way, values, bound)
        rounding = _largest(lost, self.known)
        return way, {
            "error": max(error, EPSILON / 2),
            "estimated_error": _largest(estimated, self.known),
            "digits_lost": _digits(rounding) if np.isfinite(rounding) else np.nan,
            "memory": float(memory[0]),
        }

    def _rounding(self, way: Way, values: NDArray[Any], bound: Real) -> Real:
        """Return how far values are from those of the first solver of the same chain, if any."""
        try:
            return self.same.apart(values, self.same.values(ask_once(self.same, way.model)))
        except SolveError:
            return bound


def _largest(errors: Real, known: Flags) -> float:
    return float(errors[known].max())


def _digits(rounding: float) -> float:
    """Return how many of the 15.7 digits an error takes."""
    return float(np.log10(np.clip(rounding / EPSILON, 1.0, 1 / EPSILON)))


@contextmanager
def peak_memory() -> Iterator[list[int]]:
    """Measure the most memory that is taken meanwhile, of arrays and of the core [B]."""
    peak, before = [0], tracemalloc.is_tracing()
    tracemalloc.start()
    tracemalloc.reset_peak()
    base = tracemalloc.get_traced_memory()[0]
    try:
        yield peak
    finally:
        peak[0] = tracemalloc.get_traced_memory()[1] - base
        if not before:
            tracemalloc.stop()
