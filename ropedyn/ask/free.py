"""Questions about free motion: which modes, how many, and whether it grows."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..base import check
from ..base.array import Complex, Real
from ..base.errors import SceneError
from ..eigen.damped.damped_modes import DampedModes
from ..eigen.modes import Modes
from ..eigen.spectrum import SOLVERS
from ..experiment.compare.difference import (
    OF_MODES,
    AnswerChange,
    change_of_modes,
    partners,
    relative,
)
from ..model import Model
from ..parametric.floquet import MOST_MODES, Floquet
from .question import AnyQuestion, change_of_pairs


@dataclass(frozen=True)
class ModesQuestion(AnyQuestion):
    """Ask for natural frequencies, ``question.of(model)`` is what ``model.modes(...)`` is.

    Parameters
    ----------
    number : int, optional
        How many of the lowest.
    below : float, optional
        All below this frequency [Hz]; instead of `number`.
    damped : bool
        Rates of damped motion, paired so that all together are as near as can be; where another
        pairing would be less than twice as far, error bars have both.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    SceneError
        If not exactly one of `number` and `below` is given, or a value has no meaning.

    Examples
    --------
    >>> import ropedyn as rd
    >>> print(rd.ask.modes(below=400.0))
    modes below 400 Hz
    """

    number: int | None = None
    below: float | None = field(default=None, kw_only=True)
    damped: bool = field(default=False, kw_only=True)
    solvers: ClassVar[tuple[str, ...]] = tuple(SOLVERS)
    of_spans: ClassVar[tuple[str, ...]] = ("sweep",)

    def __post_init__(self) -> None:
        if (self.number is None) == (self.below is None):
            raise SceneError(
                f"give either number or below, got number={self.number!r} and below={self.below!r}"
            )
        if self.number is not None:
            check.count(self.number, "number", most=np.iinfo(np.int32).max)
        below = check.optional(self.below, "below", "Hz", sign="positive")
        object.__setattr__(self, "below", below)
        check.instance(self.damped, "damped", bool, "True or False")

    def __str__(self) -> str:
        modes = "damped modes" if self.damped else "modes"
        return (
            f"{self.number} {modes}" if self.below is None else f"{modes} below {self.below:g} Hz"
        )

    @property
    def usual(self) -> tuple[str, ...]:  # type: ignore[override]
        """Solvers that are tried: of damped modes there is one."""
        return ("sweep",) if self.damped else ("sweep", "lapack")

    @property
    def measures(self) -> tuple[str, ...]:  # type: ignore[override]
        """What is measured of a change."""
        return AnyQuestion.measures if self.damped else OF_MODES

    def of(
        self, model: Model, *, solver: str = "sweep", threads: int | None = None
    ) -> Modes | DampedModes:
        """Ask a model; see `Model.modes`. Modes are found by one thread whatever `threads`."""
        ask: Any = model.modes
        return ask(self.number, below=self.below, solver=solver, damped=self.damped)

    def like(self, answer: Modes | DampedModes) -> ModesQuestion:
        """Return the question for as many modes as an answer has."""
        if self.below is None:
            return self
        return replace(self, number=len(answer.frequency), below=None)

    def values(self, answer: Modes | DampedModes) -> NDArray[Any]:
        """Return frequencies [Hz], where motion grows minus its rate over 2 pi; or s/2 pi."""
        if isinstance(answer, DampedModes):
            return answer.eigenvalue / (2 * math.pi)
        return np.where(answer.growth > 0, -answer.growth / (2 * math.pi), answer.frequency)

    def apart(self, found: NDArray[Any], right: NDArray[Any]) -> Real:
        """Return how far values are from right ones, relative to these."""
        return relative(found[partners(found, right)[0]] if self.damped else found, right)

    def change(
        self, answer: Modes | DampedModes, model: Model, *, solver: str | None = None
    ) -> AnswerChange:
        """Compare modes with those of the same motion of a model that has less."""
        solver = solver or self.solvers[0]
        if isinstance(answer, DampedModes):
            left = self.of(model, solver=solver)
            return change_of_pairs(self, answer, left, model.element == "continuous")
        return change_of_modes(answer, model, solver)

    def work(self, model: Model, solver: str) -> float:
        """Return the seconds, by their order: n^3 of the assembled solver, n of damped modes."""
        if self.damped:
            return 1e-4 * model.size
        return 3e-10 * sum(float(n) ** 3 for n in model.unknowns) * (solver == "lapack")


@dataclass(frozen=True)
class CountQuestion(AnyQuestion):
    """Ask how many natural frequencies there are, as ``model.count(...)`` does.

    Parameters
    ----------
    below : float
        This frequency [Hz].

    Raises
    ------
    TypeError, SceneError
        If it is not a number, or not positive.

    Examples
    --------
    >>> import ropedyn as rd
    >>> question = rd.ask.count(below=110.0)
    >>> print(question)
    count of modes below 110 Hz
    >>> question.of(rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile())
    4
    """

    below: float
    measures: ClassVar[tuple[str, ...]] = ("count [%]",)
    solvers: ClassVar[tuple[str, ...]] = ("sweep",)
    usual: ClassVar[tuple[str, ...]] = ("sweep",)
    of_spans: ClassVar[tuple[str, ...]] = ("sweep",)

    def __post_init__(self) -> None:
        below = check.number(self.below, "below", "Hz", sign="positive")
        object.__setattr__(self, "below", below)

    def __str__(self) -> str:
        return f"count of modes below {self.below:g} Hz"

    def of(self, model: Model, *, solver: str = "sweep", threads: int | None = None) -> int:
        """Ask a model; see `Model.count`."""
        return model.count(below=self.below)

    def values(self, answer: int) -> NDArray[Any]:
        """Return the count."""
        return np.array([answer])

    def rounding(self, answer: int) -> Real:
        """Return 0: a count is right for the model that is counted."""
        return np.zeros(1)


@dataclass(frozen=True)
class FloquetQuestion(AnyQuestion):
    """Ask how free motion grows under a tension that pulsates, as ``model.floquet(...)`` does.

    Multipliers are compared with the nearest ones.

    Parameters
    ----------
    modes : int
        With transverse motion, the lowest ones.

    Raises
    ------
    TypeError, SceneError
        If it is not a whole number, or has no meaning.

    Examples
    --------
    >>> import ropedyn as rd
    >>> print(rd.ask.floquet(3))
    multipliers of 3 modes
    """

    modes: int = 4
    each: ClassVar[float] = 1e-4

    def __post_init__(self) -> None:
        check.count(self.modes, "modes", most=MOST_MODES)

    def __str__(self) -> str:
        return f"multipliers of {self.modes} mode{'s' * (self.modes > 1)}"

    def of(self, model: Model, *, solver: str = "auto", threads: int | None = None) -> Floquet:
        """Ask a model; see `Model.floquet`."""
        return model.floquet(self.modes)

    def values(self, answer: Floquet) -> Complex:
        """Return the multipliers."""
        return answer.multiplier

    def apart(self, found: NDArray[Any], right: NDArray[Any]) -> Real:
        """Return how far the nearest multipliers are from right ones, relative to these."""
        return relative(found[partners(found, right)[0]], right)

    def change(self, answer: Floquet, model: Model, *, solver: str | None = None) -> AnswerChange:
        """Compare multipliers with those that they are next to of a model that has less."""
        left = self.of(model, solver=solver or self.solvers[0])
        return change_of_pairs(self, answer, left, model.element == "continuous")
