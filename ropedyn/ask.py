"""Questions: what can be asked of any model, kept apart from the model.

Examples
--------
>>> import ropedyn as rd
>>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
>>> question = rd.ask.modes(2)
>>> for model in (scene.compile(), scene.compile(elements=8)):
...     print(question.of(model).frequency.round(2))
[15.81 31.62]
[15.71 30.82]
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .base import check
from .base.answer import Frozen
from .base.array import Complex, Real
from .base.errors import SceneError
from .base.unit import MOTIONS, QUANTITIES, place
from .chain.port import Point
from .eigen.modes import Modes
from .eigen.spectrum import SOLVERS as MODES_SOLVERS
from .experiment.compare.difference import (
    OF_FRF,
    OF_MODES,
    OF_MOTION,
    AnswerChange,
    change_of_frf,
    change_of_modes,
    change_of_motion,
    of_largest,
    relative,
)
from .model import Model
from .motion.history import History
from .motion.request import METHODS, checked_times
from .response.deflection import Deflection
from .response.frf import FRF
from .response.solvers import SOLVERS as FRF_SOLVERS
from .scene.force import KINDS as FORCES
from .scene.force import forces


@dataclass(frozen=True)
class ModesQuestion:
    """Which natural frequencies; made by `modes`.

    Attributes
    ----------
    number : int or None
        So many of the lowest.
    below : float or None
        All below this frequency [Hz].

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0)
    >>> question = rd.ask.modes(below=60.0)
    >>> answer = question.of(scene.compile(elements=64))
    >>> question.values(answer).round(3), question.mesh(answer).round(6)
    (array([24.997, 49.98 ]), array([0.0001  , 0.000402]))
    >>> question.like(answer), bool(question.rounding(answer).max() < 1e-9)
    (ModesQuestion(number=2, below=None), True)
    >>> heavier = scene.replace(rope=rd.Rope(2.0, 0.1001)).compile(elements=64)
    >>> change = question.like(answer).change(answer, heavier)
    >>> question.measures[0], round(change.size["largest [Hz]"], 3)
    ('largest [Hz]', 0.025)
    >>> question.solvers, question.work(heavier, "lapack") < 1e-3
    (('sweep', 'lapack'), True)
    >>> print(question.apart(question.values(answer), 1.0001 * answer.frequency).round(6))
    [0.0001 0.0001]
    >>> question.unseen(answer)
    array([0., 0.])
    """

    number: int | None = None
    below: float | None = None
    measures: ClassVar[tuple[str, ...]] = OF_MODES  # what is measured of a change of the answer
    solvers: ClassVar[tuple[str, ...]] = tuple(MODES_SOLVERS)  # what can answer it
    usual: ClassVar[tuple[str, ...]] = ("sweep", "lapack")  # of these, what is tried
    of_spans: ClassVar[tuple[str, ...]] = ("sweep",)  # of these, what takes continuous spans

    def __post_init__(self) -> None:
        if (self.number is None) == (self.below is None):
            raise SceneError(
                f"give either number or below, got number={self.number!r} and below={self.below!r}"
            )
        if self.number is not None:
            check.count(self.number, "number", most=np.iinfo(np.int32).max)
        below = check.optional(self.below, "below", "Hz", sign="positive")
        object.__setattr__(self, "below", below)

    def __str__(self) -> str:
        return f"{self.number} modes" if self.below is None else f"modes below {self.below:g} Hz"

    def of(self, model: Model, *, solver: str = "sweep", threads: int | None = None) -> Modes:
        """Ask a model; see `Model.modes`. Modes are found by one thread whatever `threads`."""
        return model.modes(self.number, below=self.below, solver=solver)

    def like(self, answer: Modes) -> ModesQuestion:
        """Return the question for as many modes as an answer has."""
        return self if self.below is None else ModesQuestion(number=len(answer.frequency))

    def values(self, answer: Modes) -> Real:
        """Return frequencies [Hz], where motion grows minus its growth rate over 2 pi."""
        return np.where(answer.growth > 0, -answer.growth / (2 * math.pi), answer.frequency)

    def mesh(self, answer: Modes) -> Real:
        """Return the estimated relative error that the mesh causes; 0 for rigid-body motion."""
        return self._relative(answer, answer.mesh_error)

    def rounding(self, answer: Modes) -> Real:
        """Return the estimated relative error that rounding causes; 0 for rigid-body motion."""
        return self._relative(answer, answer.rounding_error)

    def _relative(self, answer: Modes, error: Real) -> Real:
        size = np.abs(self.values(answer))
        return np.divide(error, size, out=np.zeros_like(size), where=size > 0)

    def change(self, answer: Modes, model: Model, *, solver: str = "sweep") -> AnswerChange:
        """Compare an answer with that of a model from which something was left out."""
        return change_of_modes(answer, model, solver)

    def apart(self, found: NDArray[Any], right: NDArray[Any]) -> Real:
        """Return how far values are from right ones, relative to these."""
        return relative(found, right)

    def unseen(self, answer: Modes) -> Real:
        """Return the relative error that the same spans in other cuts do not show: none."""
        return np.zeros(self.values(answer).shape)

    def work(self, model: Model, solver: str) -> float:
        """Return the seconds, by their order, that an assembled solver takes: dense, n^3."""
        return 7e-11 * sum(float(n) ** 3 for n in model.unknowns) * (solver == "lapack")


@dataclass(frozen=True, eq=False)
class FRFQuestion(Frozen):
    """Which frequency response; made by `frf`.

    Attributes
    ----------
    frequency : ndarray, shape (f,)
        [Hz].
    drive, response, quantity
        As in `Model.frf`.

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0)
    >>> question = rd.ask.frf([10.0, 20.0], drive=("z", 0.5))
    >>> answer = question.of(scene.compile(elements=64))
    >>> question.values(answer).real.round(6), question.mesh(answer).round(4)
    (array([[0.000418, 0.000757]]), array([[0.0001, 0.0004]]))
    >>> question.like(answer) is question, bool(question.rounding(answer).max() < 1e-9)
    (True, True)
    >>> heavier = scene.replace(rope=rd.Rope(2.0, 0.1001)).compile(elements=64)
    >>> change = question.change(answer, heavier)
    >>> question.measures[0], round(change.size["largest [dB]"], 3)
    ('largest [dB]', 0.012)
    >>> question.solvers, question.work(heavier, "lapack") < 1e-3
    (('sweep', 'band', 'lapack'), True)
    >>> print(question.apart(answer.value, 1.01 * answer.value).round(6))
    [[0.009901 0.009901]]
    >>> question.unseen(answer)
    array([[0., 0.]])
    """

    frequency: Real
    drive: Any
    response: Any = None
    quantity: str = "receptance"
    measures: ClassVar[tuple[str, ...]] = OF_FRF  # what is measured of a change of the answer
    solvers: ClassVar[tuple[str, ...]] = tuple(FRF_SOLVERS)  # what can answer it
    usual: ClassVar[tuple[str, ...]] = ("sweep", "lapack")  # of these, what is tried
    of_spans: ClassVar[tuple[str, ...]] = ("sweep",)  # of these, what takes continuous spans

    def __post_init__(self) -> None:
        object.__setattr__(self, "frequency", check.frequencies(self.frequency))
        super().__post_init__()
        object.__setattr__(self, "drive", check.points(self.drive, "drive", forces=False))
        if self.response is not None:
            response = check.points(self.response, "response", forces=True)
            object.__setattr__(self, "response", response)
        check.one_of(self.quantity, "quantity", QUANTITIES)

    def __str__(self) -> str:
        f = self.frequency
        lines = f"{f[0]:g} Hz" if len(f) == 1 else f"{len(f)} lines, {f.min():g} to {f.max():g} Hz"
        drives = (self.drive,) if isinstance(self.drive[0], str) else self.drive
        driven = " and ".join(map(place, drives))
        return f"{self.quantity} of {lines}, driven in {driven}"

    def of(self, model: Model, *, solver: str = "sweep", threads: int | None = None) -> FRF:
        """Ask a model; see `Model.frf`."""
        return model.frf(
            self.frequency,
            drive=self.drive,
            response=self.response,
            quantity=self.quantity,
            solver=solver,
            threads=threads,
        )

    def like(self, answer: FRF) -> FRFQuestion:
        """Return the question itself: every answer has as many lines."""
        return self

    def values(self, answer: FRF) -> Complex:
        """Return the response."""
        return answer.value

    def mesh(self, answer: FRF) -> Real:
        """Return the estimated relative error that the mesh causes."""
        return answer.mesh_error

    def rounding(self, answer: FRF) -> Real:
        """Return the estimated relative error that rounding causes."""
        return answer.rounding_error

    def change(self, answer: FRF, model: Model, *, solver: str = "sweep") -> AnswerChange:
        """Compare an answer with that of a model from which something was left out."""
        return change_of_frf(answer, self.of(model, solver=solver, threads=1))

    def apart(self, found: NDArray[Any], right: NDArray[Any]) -> Real:
        """Return how far values are from right ones, relative to these."""
        return relative(found, right)

    def unseen(self, answer: FRF) -> Real:
        """Return the relative error that the same spans in other cuts do not show: none."""
        return np.zeros(self.values(answer).shape)

    def work(self, model: Model, solver: str) -> float:
        """Return the seconds, by their order, that an assembled solver takes: n a line."""
        return 4e-7 * model.size * len(self.frequency) * (solver == "lapack")


@dataclass(frozen=True, eq=False)
class MotionQuestion(Frozen):
    """Which motion over time; made by `motion`.

    Attributes
    ----------
    time : ndarray, shape (t,)
        [s].
    drive, force, response, start, quantity, tolerance
        As in `Model.transient`.

    Examples
    --------
    >>> import numpy as np
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0, damping=rd.ViscousDamping(0.5))
    >>> time = np.linspace(0.0, 0.1, 101)
    >>> question = rd.ask.motion(time, drive=("z", 0.5), force=rd.Sine(1.0, 20.0))
    >>> answer = question.of(scene.compile(elements=64))
    >>> question.values(answer).shape, bool(question.mesh(answer).max() < 3e-3)
    ((1, 101), True)
    >>> question.like(answer) is question, bool(question.rounding(answer).max() < 1e-3)
    (True, True)
    >>> heavier = scene.replace(rope=rd.Rope(2.0, 0.101)).compile(elements=64)
    >>> change = question.change(answer, heavier)
    >>> question.measures[0], 0.1 < change.size["largest [%]"] < 10.0
    ('largest [%]', True)
    >>> question.solvers[0], question.work(heavier, "auto") < 0.1
    ('auto', True)
    >>> print(question.apart(answer.value, 1.01 * answer.value).max().round(6))
    0.009901
    >>> bool((question.unseen(answer) == question.rounding(answer)).all())
    True
    """

    time: Real
    drive: Any = None
    force: Any = None
    response: Any = None
    start: Any = None
    quantity: str = "displacement"
    tolerance: float = 1e-3
    measures: ClassVar[tuple[str, ...]] = OF_MOTION  # what is measured of a change of the answer
    solvers: ClassVar[tuple[str, ...]] = METHODS  # what can answer it
    usual: ClassVar[tuple[str, ...]] = METHODS[:1]  # of these, what is tried
    of_spans: ClassVar[tuple[str, ...]] = METHODS  # of these, what takes continuous spans

    def __post_init__(self) -> None:
        time = checked_times(self.time)
        kept: dict[str, Any] = {"time": time}
        if (self.drive is None) != (self.force is None):
            raise SceneError("give both drive and force, or neither")
        if self.drive is not None:
            kept["drive"] = check.points(self.drive, "drive", forces=False)
            drives = kept["drive"]
            count = None if isinstance(drives[0], str) else len(drives)
            kept["force"] = _forces(self.force, count, time)
        if self.response is not None:
            kept["response"] = check.points(self.response, "response", forces=True)
        if self.start is not None and not isinstance(self.start, Deflection):
            check.instance(self.start, "start", Mapping, "a mapping from points to loads")
            kept["start"] = dict(self.start)
        check.one_of(self.quantity, "quantity", MOTIONS)
        kept["tolerance"] = check.number(self.tolerance, "tolerance", sign="positive")
        for name, value in kept.items():
            object.__setattr__(self, name, value)
        super().__post_init__()

    def __str__(self) -> str:
        t = self.time
        times = f"motion at {len(t)} times, {t[0]:g} to {t[-1]:g} s"
        if self.drive is None:
            return f"free {times}"
        drives = (self.drive,) if isinstance(self.drive[0], str) else self.drive
        return f"{times}, driven in {' and '.join(map(place, drives))}"

    def of(self, model: Model, *, solver: str = "auto", threads: int | None = None) -> History:
        """Ask a model; see `Model.transient`. One thread finds it whatever `threads`."""
        return model.transient(
            self.time,
            drive=self.drive,
            force=self.force,
            response=self.response,
            start=self.start,
            quantity=self.quantity,
            tolerance=self.tolerance,
            method=solver,
        )

    def like(self, answer: History) -> MotionQuestion:
        """Return the question itself: every answer has as many times."""
        return self

    def values(self, answer: History) -> Real:
        """Return the motion."""
        return answer.value

    def mesh(self, answer: History) -> Real:
        """Return the error that the mesh causes, over the largest value of each response."""
        return of_largest(answer.mesh_error, answer.value)

    def rounding(self, answer: History) -> Real:
        """Return the estimated error of the method, over the largest value of each response."""
        return of_largest(answer.error, answer.value)

    def change(self, answer: History, model: Model, *, solver: str = "auto") -> AnswerChange:
        """Compare an answer with that of a model from which something was left out."""
        return change_of_motion(answer, self.of(model, solver=solver))

    def apart(self, found: NDArray[Any], right: NDArray[Any]) -> Real:
        """Return how far values are from right ones, over the largest of each response."""
        return of_largest(found - right, right)

    def unseen(self, answer: History) -> Real:
        """Return the relative error that the same spans in other cuts do not show: the method's."""
        return self.rounding(answer)

    def work(self, model: Model, solver: str) -> float:
        """Return the seconds, by their order, that the slowest way takes: n a time."""
        return 4e-7 * model.size * len(self.time)


def _forces(given: Any, drives: int | None, time: Real) -> Any:
    """Return what is given, checked, its samples as arrays: a force, or one for each drive."""
    if drives is None:
        return _force(given, "force", time)
    if not isinstance(given, (tuple, list, np.ndarray)) or len(given) != drives:
        raise SceneError(
            f"force must be one for each of the {drives} drives, got {check.shown(given)}"
        )
    return tuple(_force(one, f"force[{k}]", time) for k, one in enumerate(given))


def _force(given: Any, name: str, time: Real) -> Any:
    """Return a force as it is given, its samples as an array."""
    forces(given, name, time)
    if isinstance(given, FORCES):
        return given
    if isinstance(given, (tuple, list)) and any(isinstance(one, FORCES) for one in given):
        return tuple(_force(one, f"{name}[{k}]", time) for k, one in enumerate(given))
    return np.array(given, dtype=np.float64)


Question = ModesQuestion | FRFQuestion | MotionQuestion
QUESTIONS = (ModesQuestion, FRFQuestion, MotionQuestion)


def modes(number: int | None = None, *, below: float | None = None) -> ModesQuestion:
    """Ask for natural frequencies.

    Parameters
    ----------
    number : int, optional
        How many of the lowest.
    below : float, optional
        All below this frequency [Hz]; instead of `number`.

    Returns
    -------
    ModesQuestion
        ``question.of(model)`` is what ``model.modes(...)`` is.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    SceneError
        If not exactly one of the two is given, or a value has no meaning.

    Examples
    --------
    >>> import ropedyn as rd
    >>> print(rd.ask.modes(below=400.0))
    modes below 400 Hz
    """
    return ModesQuestion(number, below)


def frf(
    frequency: ArrayLike,
    *,
    drive: Point | list[Point],
    response: Point | list[Point] | None = None,
    quantity: str = "receptance",
) -> FRFQuestion:
    """Ask for a frequency response.

    Parameters
    ----------
    frequency : array_like, shape (f,)
        [Hz], each >= 0.
    drive : point or list of points
        Coordinate and position of a unit force or moment, such as ``("z", 0.5)``, or an end that
        is moved, such as ``("end", 0, "z")``.
    response : point or list of points, optional
        What is watched; the drive points where left out.
    quantity : {"receptance", "mobility", "accelerance"}
        Displacement, velocity or acceleration per force.

    Returns
    -------
    FRFQuestion
        ``question.of(model)`` is what ``model.frf(...)`` is. Whether a rope has such points is
        checked when it is asked.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    SceneError
        If a value has no meaning.

    Examples
    --------
    >>> import ropedyn as rd
    >>> print(rd.ask.frf([10.0, 20.0], drive=("z", 0.5)))
    receptance of 2 lines, 10 to 20 Hz, driven in z at 0.500 m
    """
    return FRFQuestion(frequency, drive, response, quantity)  # type: ignore[arg-type]


def motion(
    time: ArrayLike,
    *,
    drive: Any = None,
    force: Any = None,
    response: Point | list[Point] | None = None,
    start: Mapping[Point, float] | Deflection | None = None,
    quantity: str = "displacement",
    tolerance: float = 1e-3,
) -> MotionQuestion:
    """Ask for motion over time.

    Parameters
    ----------
    time : array_like, shape (t,)
        When the motion is asked for [s], increasing; it begins at the first.
    drive : point or list of points, optional
        What the force acts on, such as ``("z", 0.5)``, or an end that is moved, such as
        ``("end", 0, "z")``. None: free motion.
    force : array_like, shape (t,), Sine, Chirp, Step or Impulse, or a tuple of them (their sum)
        [N, N m; m, rad of an end]; one for each where a list of drives is given.
    response : point or list of points, optional
        What is watched; the drive points where left out.
    start : mapping from points to float, or Deflection, optional
        Static loads under which the rope rests before it is let go at the first time.
    quantity : {"displacement", "velocity", "acceleration"}
        Of the responses.
    tolerance : float
        Part of each response's largest value within which methods that can choose stay.

    Returns
    -------
    MotionQuestion
        ``question.of(model)`` is what ``model.transient(...)`` is. Whether a rope has such points
        is checked when it is asked.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    SceneError
        If a value has no meaning.

    Examples
    --------
    >>> import ropedyn as rd
    >>> print(rd.ask.motion([0.0, 0.1, 0.2], drive=("z", 0.5), force=rd.Step(1.0)))
    motion at 3 times, 0 to 0.2 s, driven in z at 0.500 m
    """
    return MotionQuestion(
        time,  # type: ignore[arg-type]
        drive,
        force,
        response,
        start,
        quantity,
        tolerance,
    )
