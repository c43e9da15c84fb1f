"""Ways to the answer of a question: what compiles, what asks, and how wrong the answer is."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..ask import Question
from ..base.array import Flags, Real
from ..base.errors import RopedynError, SceneError, SolveError
from ..model import Model
from ..scene.scene import Scene
from .difference import relative

CUTS = (3, 5, 7)
"""Parts that spans are cut into for other arithmetic; powers of two would join to the same bits."""

FEWEST, MOST = 3, 12
"""Powers of two between which chains are tried."""

LONGEST = 1.0
"""Of assembled solvers that nobody asked for by number of elements [s]."""

EPSILON = float(np.finfo(float).eps)


@dataclass(frozen=True, eq=False)
class Truth:
    """What answers are measured against: continuous spans."""

    scene: Scene  # what is asked about
    question: Question  # what is asked, and timed
    same: Question  # the same for exactly as many values as the true answer has
    values: NDArray[Any]  # true ones
    # which of them have a correct digit: what is 0 by symmetry is nothing but rounding
    known: Flags
    error: float  # their own largest relative error, seen in other cuts of the same spans
    spans: int  # how many

    @staticmethod
    def of(scene: Scene, question: Question) -> Truth:
        """Ask continuous spans, whole and cut."""
        model = scene.compile()
        answer = answered(question, model)
        values = question.values(answer)
        known = question.rounding(answer) < 1
        if not known.any():
            raise SolveError(f"continuous spans have no correct digit of the {question}")
        same, spans = question.like(answer), len(model.x) - 1
        error = 0.0
        for parts in CUTS:
            cut = ask_once(same, scene.compile(elements=parts * spans, element="continuous"))
            error = max(error, largest(relative(same.values(cut), values), known))
        return Truth(scene, question, same, values, known, error, spans)


@dataclass(frozen=True, eq=False)
class Trial:
    """One way to the answer."""

    element: str  # as in `AccuracyCost`
    elements: int  # as in `AccuracyCost`
    solver: str  # as in `AccuracyCost`
    error: float = np.nan  # largest of all values, NaN where there is no answer
    estimated_error: float = np.nan  # largest of all values, NaN where there is no answer
    digits_lost: float = np.nan  # largest of all values, NaN where there is no answer
    refusal: str = ""  # why there is none
    # what compiles and what asks, nothing where there is no answer
    calls: tuple[Callable[[], Any], ...] = ()


def largest(errors: Real, known: Flags) -> float:
    """Return the largest error of values that are known."""
    return float(errors[known].max())


Way = tuple[str, int, str]
"""Element, how many, solver."""


def words(element: str, elements: int, solver: str) -> str:
    """Say a way in words; continuous spans are only swept."""
    return element if element == "continuous" else f"{element}, {elements}, {solver}"


def ways(
    truth: Truth, kinds: Sequence[str], counts: Sequence[int] | None, solvers: Sequence[str]
) -> list[Way]:
    """Return every way to the answer."""
    found: list[Way] = []
    for kind in kinds:
        if kind != "continuous":
            found += [(kind, n, s) for s in solvers for n in counts or _sensible(truth, kind, s)]
        elif "sweep" in solvers:
            found.append((kind, truth.spans, "sweep"))
    return found


def trial(truth: Truth, way: Way) -> Trial:
    """Try one way."""
    return continuous(truth) if way[0] == "continuous" else chain(truth, *way)


def continuous(truth: Truth) -> Trial:
    """Try the continuous spans themselves."""
    model = truth.scene.compile()
    rounding = largest(truth.same.rounding(ask_once(truth.same, model)), truth.known)
    return Trial(
        "continuous",
        truth.spans,
        "sweep",
        error=max(truth.error, EPSILON / 2),
        estimated_error=rounding,
        digits_lost=_digits(rounding),
        calls=(truth.scene.compile, partial(ask_once, truth.question, model)),
    )


def chain(truth: Truth, kind: str, n: int, solver: str) -> Trial:
    """Try a chain of so many elements."""
    compiled = partial(truth.scene.compile, elements=n, element=kind)
    try:
        model = compiled()
        answer = ask_once(truth.same, model, solver)
        asked = partial(ask_once, truth.question, model, solver)
        if truth.same is not truth.question:
            asked()
    except RopedynError as refusal:
        return Trial(kind, n, solver, refusal=str(refusal))
    values, bound = truth.same.values(answer), truth.same.rounding(answer)
    rounding = bound if solver == "sweep" else _rounding(truth, model, values, bound)
    return Trial(
        kind,
        n,
        solver,
        error=max(largest(relative(values, truth.values), truth.known), EPSILON / 2),
        estimated_error=largest(truth.same.mesh(answer) + bound, truth.known),
        digits_lost=_digits(largest(rounding, truth.known)),
        calls=(compiled, asked),
    )


def _sensible(truth: Truth, kind: str, solver: str) -> Iterator[int]:
    """Return powers of two from 8, or from the number of spans, as far as they are not too slow."""
    first = max(FEWEST, (truth.spans - 1).bit_length())
    for power in range(first, max(MOST, first + 3) + 1):
        model = truth.scene.compile(elements=2**power, element=kind)
        if solver == "lapack" and truth.question.work(model) > LONGEST:
            return
        yield 2**power


def ask_once(question: Question, model: Model, solver: str = "sweep") -> Any:
    """Ask a model as it is timed: in one thread."""
    return question.of(model, solver=solver, threads=1)


def _rounding(truth: Truth, model: Model, values: NDArray[Any], bound: Real) -> Real:
    """Return how far values are from those of the sweep along the same chain, if it has any."""
    try:
        return relative(values, truth.same.values(ask_once(truth.same, model)))
    except SolveError:
        return bound


def answered(question: Question, model: Model, solver: str = "sweep") -> Any:
    """Ask a model, and refuse a question whose answer is empty."""
    answer = ask_once(question, model, solver)
    if question.values(answer).size == 0:
        raise SceneError(f"question must have an answer, got {question}: there are none")
    return answer


def _digits(rounding: float) -> float:
    """Return how many of the decimal digits there are a relative error by rounding takes."""
    return float(np.log10(min(max(rounding / EPSILON, 1.0), 1 / EPSILON)))
