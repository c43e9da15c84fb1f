"""What every question can do: ask a model, and compare its answer with another one."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..base.answer import Frozen
from ..base.array import Real
from ..experiment.compare.difference import (
    OF_VALUES,
    AnswerChange,
    change_of_values,
    partners,
    relative,
)
from ..model import Model
from ..scene.scene import Scene


class AnyQuestion(Frozen):
    """Base of what can be asked of any model: answers to a question know how to be compared.

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0)
    >>> question = rd.ask.modes(below=60.0)
    >>> answer = question.of(scene.compile(elements=64))
    >>> question.values(answer).round(3), question.mesh(answer).round(6)
    (array([24.997, 49.98 ]), array([0.0001  , 0.000402]))
    >>> print(question.like(answer))
    2 modes
    >>> bool(question.rounding(answer).max() < 1e-9), question.unseen(answer)
    (True, array([0., 0.]))
    >>> heavier = scene.replace(rope=rd.Rope(2.0, 0.1001)).compile(elements=64)
    >>> change = question.like(answer).change(answer, heavier)
    >>> question.measures[0], round(change.size["largest [Hz]"], 3)
    ('largest [Hz]', 0.025)
    >>> question.solvers == question.usual, question.work(heavier, "lapack") < 1e-3
    (True, True)
    >>> print(question.apart(question.values(answer), 1.0001 * answer.frequency).round(6))
    [0.0001 0.0001]
    >>> question.placed(scene) is scene, question.parts
    (True, (1, ''))
    """

    measures: ClassVar[tuple[str, ...]] = OF_VALUES  # what is measured of a change of the answer
    solvers: ClassVar[tuple[str, ...]] = ("auto",)  # what can answer it, the first where none is
    usual: ClassVar[tuple[str, ...]] = ("auto",)  # named; of these, what is tried
    of_spans: ClassVar[tuple[str, ...]] = ("auto",)  # of these, what takes continuous spans
    bounded: ClassVar[bool] = True  # whether answers have a bound of their rounding errors
    each: ClassVar[float] = 0.0  # what the slowest way takes for each unknown, by its order [s]

    def of(self, model: Model, *, solver: str = "auto", threads: int | None = None) -> Any:
        """Ask a model."""
        raise NotImplementedError

    def values(self, answer: Any) -> NDArray[Any]:
        """Return the numbers of an answer that are compared."""
        raise NotImplementedError

    def rounding(self, answer: Any) -> Real:
        """Return the relative error that rounding causes, infinite where no bound is known."""
        if not self.bounded:
            return relative_to(self.values(answer), np.inf)
        # what is measured in wider numbers takes longer than most answers
        quick = getattr(answer, "rounding_bound", None)
        return relative_to(self.values(answer), answer.rounding_error if quick is None else quick)

    def mesh(self, answer: Any) -> Real:
        """Return the relative error that the mesh causes, infinite where no bound is known."""
        return relative_to(self.values(answer), getattr(answer, "mesh_error", np.inf))

    def unseen(self, answer: Any) -> Real:
        """Return the relative error that the same spans in other cuts do not show: none."""
        return np.zeros(self.values(answer).shape)

    def apart(self, found: NDArray[Any], right: NDArray[Any]) -> Real:
        """Return how far values are from right ones, relative to these."""
        return relative(found, right)

    def change(self, answer: Any, model: Model, *, solver: str | None = None) -> AnswerChange:
        """Compare an answer with that of a model from which something was left out."""
        left = self.of(model, solver=solver or self.solvers[0], threads=1)
        before, after = self.values(answer), self.values(left)
        if before.shape != after.shape:
            return AnswerChange.lost_some(self.measures, before.size - after.size)
        error = self.rounding(answer) + self.rounding(left)
        if model.element != "continuous":
            error = error + self.mesh(answer) + self.mesh(left)
        return change_of_values(self.apart(after, before), error, self.measures)

    def like(self, answer: Any) -> AnyQuestion:
        """Return the question for exactly as many values as an answer has: usually itself."""
        return self

    def placed(self, scene: Scene) -> Scene:
        """Return the scene with a node wherever values are read: usually itself."""
        return scene

    @property
    def parts(self) -> tuple[int, str]:
        """Into how many parts of which name what an answer costs is shared, such as ropes."""
        return 1, ""

    def work(self, model: Model, solver: str) -> float:
        """Return the seconds, by their order, that the slowest way takes."""
        return self.each * model.size


def relative_to(values: NDArray[Any], error: Real | float) -> Real:
    """Return errors relative to values; of a value that is 0, as of rigid motion, 0 if finite."""
    size = np.abs(values)
    at_zero = np.where(np.isinf(error), np.inf, np.zeros(size.shape))
    return np.divide(error, size, out=at_zero, where=size > 0)


def change_of_pairs(question: AnyQuestion, answer: Any, left: Any, spans: bool) -> AnswerChange:
    """Compare values that have no order with those of another answer that they are next to."""
    before, after = question.values(answer), question.values(left)
    if len(after) < len(before):
        return AnswerChange.lost_some(question.measures, len(before) - len(after))
    which, open_ = partners(after, before)
    error = question.rounding(answer) + question.rounding(left)[which]
    if not spans:
        error = error + question.mesh(answer) + question.mesh(left)[which]
    apart = relative(after[which], before)
    change = change_of_values(apart, error + relative_to(before, open_), question.measures)
    return replace(change, unsure=int(np.count_nonzero(open_)))
