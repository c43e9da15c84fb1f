"""Questions about motion over time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ..base import check
from ..base.array import Real
from ..base.errors import SceneError
from ..base.unit import MOTIONS, place
from ..experiment.compare.difference import OF_MOTION, AnswerChange, change_of_motion, of_largest
from ..model import Model
from ..motion.history import History
from ..motion.request import METHODS, checked_times
from ..response.deflection import Deflection
from ..scene.force import KINDS as FORCES
from ..scene.force import forces
from .question import AnyQuestion


@dataclass(frozen=True, eq=False)
class MotionQuestion(AnyQuestion):
    """Ask for motion over time, ``question.of(model)`` is what ``model.transient(...)`` is.

    Whether a rope has such points is checked when it is asked.

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

    Raises
    ------
    TypeError, SceneError
        If an argument is of the wrong type, or has no meaning.

    Examples
    --------
    >>> import ropedyn as rd
    >>> print(rd.ask.motion([0.0, 0.1, 0.2], drive=("z", 0.5), force=rd.Step(1.0)))
    motion at 3 times, 0 to 0.2 s, driven in z at 0.500 m
    """

    time: Any
    _: KW_ONLY
    drive: Any = None
    force: Any = None
    response: Any = None
    start: Any = None
    quantity: str = "displacement"
    tolerance: float = 1e-3
    measures: ClassVar[tuple[str, ...]] = OF_MOTION
    solvers: ClassVar[tuple[str, ...]] = METHODS
    of_spans: ClassVar[tuple[str, ...]] = METHODS

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

    def values(self, answer: History) -> Real:
        """Return the motion."""
        return answer.value

    def mesh(self, answer: History) -> Real:
        """Return the error that the mesh causes, over the largest value of each response."""
        return of_largest(answer.mesh_error, answer.value)

    def rounding(self, answer: History) -> Real:
        """Return the estimated error of the method, over the largest value of each response."""
        return of_largest(answer.error, answer.value)

    def change(self, answer: History, model: Model, *, solver: str | None = None) -> AnswerChange:
        """Compare an answer with that of a model from which something was left out."""
        return change_of_motion(answer, self.of(model, solver=solver or self.solvers[0]))

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
