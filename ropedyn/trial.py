"""Ways to the answer of a question: what compiles, what asks, and how wrong the answer is."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .ask import Question
from .errors import RopedynError, SceneError, SolveError
from .model import Model
from .scene import Scene

CUTS = (3, 5, 7)
"""Parts that spans are cut into for other arithmetic; powers of two would join to the same bits."""

FEWEST, MOST = 3, 12
"""Powers of two between which chains are tried."""

LONGEST = 1.0
"""Of assembled solvers that nobody asked for by number of elements [s]."""

EPSILON = float(np.finfo(float).eps)

Real = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Truth:
    """What answers are measured against: continuous spans.

    Attributes
    ----------
    scene : Scene
        What is asked about.
    question : Question
        What is asked, and timed.
    same : Question
        The same for exactly as many values as the true answer has.
    values : ndarray
        True ones.
    error : float
        Their own largest relative error, seen in other cuts of the same spans.
    spans : int
        How many.
    """

    scene: Scene
    question: Question
    same: Question
    values: NDArray[Any]
    error: float
    spans: int

    @staticmethod
    def of(scene: Scene, question: Question) -> Truth:
        """Ask continuous spans, whole and cut."""
        model = scene.compile()
        answer: Any = question.of(model, threads=1)
        values = question.values(answer)
        if values.size == 0:
            raise SceneError(f"question must have an answer, got {question}: there are none")
        same, spans = question.like(answer), len(model.x) - 1
        error = 0.0
        for parts in CUTS:
            cut = scene.compile(elements=parts * spans, element="continuous")
            error = max(error, largest(relative(_values(same, cut, "sweep"), values)))
        return Truth(scene, question, same, values, error, spans)


@dataclass(frozen=True, eq=False)
class Trial:
    """One way to the answer.

    Attributes
    ----------
    element, elements, solver
        As in `AccuracyCost`.
    error, estimated_error, digits_lost : float
        Largest of all values, NaN where there is no answer.
    refusal : str
        Why there is none.
    calls : tuple of callables
        What compiles and what asks, nothing where there is no answer.
    """

    element: str
    elements: int
    solver: str
    error: float = np.nan
    estimated_error: float = np.nan
    digits_lost: float = np.nan
    refusal: str = ""
    calls: tuple[Callable[[], Any], ...] = ()


def relative(found: NDArray[Any], right: NDArray[Any]) -> Real:
    """Return relative errors: 0 where both are 0, 1 where only the right value is."""
    size = np.where(right == 0, np.abs(found), np.abs(right))
    return np.divide(np.abs(found - right), size, out=np.zeros(size.shape), where=size > 0)


def largest(errors: Real) -> float:
    """Return the largest error as a number."""
    return float(errors.max())


def trials(
    truth: Truth, kinds: Sequence[str], counts: Sequence[int] | None, solvers: Sequence[str]
) -> Iterator[Trial]:
    """Try every way there is.

    Parameters
    ----------
    truth : Truth
        What is asked, and the answer.
    kinds, solvers : sequence of str
        Of elements, and for each.
    counts : sequence of int or None
        Of elements; those that make sense where left out.
    """
    for kind in kinds:
        if kind == "continuous":
            if "sweep" in solvers:
                yield continuous(truth)
            continue
        for solver in solvers:
            for n in counts or _sensible(truth, kind, solver):
                yield chain(truth, kind, n, solver)


def continuous(truth: Truth) -> Trial:
    """Try the continuous spans themselves."""
    model = truth.scene.compile()
    answer: Any = truth.question.of(model, threads=1)
    rounding = truth.question.rounding(answer)
    return Trial(
        "continuous",
        truth.spans,
        "sweep",
        error=max(truth.error, EPSILON / 2),
        estimated_error=largest(rounding),
        digits_lost=_digits(rounding),
        calls=(truth.scene.compile, partial(truth.question.of, model, threads=1)),
    )


def chain(truth: Truth, kind: str, n: int, solver: str) -> Trial:
    """Try a chain of so many elements."""
    compiled = partial(truth.scene.compile, elements=n, element=kind)
    try:
        model = compiled()
        answer: Any = truth.same.of(model, solver=solver, threads=1)
        asked = partial(truth.question.of, model, solver=solver, threads=1)
        if truth.same is not truth.question:
            asked()
    except RopedynError as refusal:
        return Trial(kind, n, solver, refusal=str(refusal))
    values, bound = truth.same.values(answer), truth.same.rounding(answer)
    return Trial(
        kind,
        n,
        solver,
        error=max(largest(relative(values, truth.values)), EPSILON / 2),
        estimated_error=largest(_mesh_error(truth, values) + bound),
        digits_lost=_digits(bound if solver == "sweep" else _rounding(truth, model, values, bound)),
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


def _values(question: Question, model: Model, solver: str) -> NDArray[Any]:
    answer: Any = question.of(model, solver=solver, threads=1)
    return question.values(answer)


def _mesh_error(truth: Truth, values: NDArray[Any]) -> Real:
    """Return the relative error that the mesh causes, by the difference to continuous spans."""
    return relative(values, truth.values)


def _rounding(truth: Truth, model: Model, values: NDArray[Any], bound: Real) -> Real:
    """Return how far values are from those of the sweep along the same chain, if it has any."""
    try:
        return relative(values, _values(truth.same, model, "sweep"))
    except SolveError:
        return bound


def _digits(rounding: Real) -> float:
    """Return how many decimal digits a relative error by rounding takes."""
    return float(np.log10(max(largest(rounding) / EPSILON, 1.0)))
