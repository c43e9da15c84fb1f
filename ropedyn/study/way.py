"""A question put to several ways of solving: what each answers, and how long it takes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..ask import AnyQuestion
from ..base import check
from ..base.array import Real
from ..base.errors import RopedynError, SceneError
from ..base.stopwatch import Times, timed
from ..model import Model
from ..scene.scene import Scene


@dataclass(frozen=True, eq=False)
class Way:
    """One way of answering a question."""

    question: AnyQuestion
    scene: Scene
    how: Mapping[str, Any]  # arguments of `Scene.compile`
    solver: str
    model: Model
    answer: Any

    @classmethod
    def of(
        cls, question: AnyQuestion, scene: Scene, how: Mapping[str, Any], solver: str | None = None
    ) -> Way:
        """Compile and ask."""
        model, solver = scene.compile(**how), solver or question.solvers[0]
        return cls(question, scene, how, solver, model, ask_once(question, model, solver))

    @property
    def calls(self) -> tuple[Callable[[], Any], ...]:
        """What compiles and what asks, to be timed."""
        asked = partial(ask_once, self.question, self.model, self.solver)
        return partial(self.scene.compile, **self.how), asked

    @property
    def unknowns(self) -> int:
        """Of what was solved; a count, which is a number, does not say it."""
        cost = getattr(self.answer, "cost", None)
        return self.model.size if cost is None else int(cost.unknowns)

    def bound(self) -> Real:
        """Ask, and read the error bar: relative errors of the mesh and of rounding."""
        answer = ask_once(self.question, self.model, self.solver)
        rounding = self.question.rounding(answer)
        spans = self.model.element == "continuous"
        return rounding if spans else rounding + self.question.mesh(answer)

    def __str__(self) -> str:
        return words(self.model.element, len(self.model.x) - 1, self.solver)


def ask_once(question: AnyQuestion, model: Model, solver: str | None = None) -> Any:
    """Ask a model as it is timed: in one thread, where no solver is given the first one."""
    return question.of(model, solver=solver or question.solvers[0], threads=1)


def answered(
    question: AnyQuestion, scene: Scene, how: Mapping[str, Any], solver: str | None = None
) -> Way:
    """Ask a scene, and refuse a question whose answer is empty."""
    way = Way.of(question, scene, how, solver)
    if question.values(way.answer).size == 0:
        raise SceneError(f"question must have an answer, got {question}: there are none")
    return way


def words(element: str, elements: int, solver: str) -> str:
    """Say a way in words; the usual solver of continuous spans is not named."""
    if element != "continuous":
        return f"{element}, {elements}, {solver}"
    return element if solver in ("sweep", "auto") else f"{element}, {solver}"


# Tries a way, and returns it with the numbers of its row.
Attempt = Callable[[], tuple[Way, Mapping[str, Any]]]


def check_question(scene: Scene, question: AnyQuestion) -> None:
    """Refuse what is no scene, and what is no question."""
    check.instance(scene, "scene", Scene, "a Scene")
    check.instance(question, "question", AnyQuestion, "made by ropedyn.ask")


def priced(
    attempts: Sequence[Attempt],
    nothing: Mapping[str, Any],
    repeat: int,
    report: Callable[[float], Any],
    *first: Way,
    bounds: bool = False,
) -> tuple[dict[str, NDArray[Any]], Times]:
    """Try ways, with rows of nothing for refusals, and time them after those that come first.

    With `bounds` also with the error bar.
    """
    rows: list[Mapping[str, Any]] = []
    calls: list[tuple[Callable[[], Any], ...]] = [way.calls for way in first]
    for attempt in attempts:
        try:
            way, numbers = attempt()
        except RopedynError as refusal:
            rows.append({**nothing, "refusal": str(refusal)})
            calls.append(())
        else:
            rows.append({**numbers, "refusal": ""})
            calls.append((*way.calls, way.bound) if bounds and way.question.bounded else way.calls)
        report(len(rows) / len(attempts) / 2)
    columns = {name: np.array([row[name] for row in rows]) for name in (*nothing, "refusal")}
    return columns, timed(calls, repeat, lambda fraction: report((1 + fraction) / 2))
