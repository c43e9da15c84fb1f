"""Questions about motion under given forces: at given frequencies, and at rest."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass, field
from typing import Any, ClassVar

import numpy as np

from ..base import check
from ..base.array import Complex, Real
from ..base.errors import SceneError
from ..base.unit import QUANTITIES, place
from ..chain.port import Point
from ..experiment.compare.difference import OF_FRF, AnswerChange, change_of_frf
from ..model import Model
from ..response.deflection import Deflection, check_some
from ..response.frf import FRF
from ..response.solvers import SOLVERS
from ..scene.parts.part import PointMass
from ..scene.scene import Scene
from .question import AnyQuestion, relative_to

ON_A_NODE = 1e-9  # Of the length: a load that is not farther from a node stands on it.


@dataclass(frozen=True, eq=False)
class FRFQuestion(AnyQuestion):
    """Ask for a frequency response, ``question.of(model)`` is what ``model.frf(...)`` is.

    Whether a rope has such points is checked when it is asked.

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

    Raises
    ------
    TypeError, SceneError
        If an argument is of the wrong type, or has no meaning.

    Examples
    --------
    >>> import ropedyn as rd
    >>> print(rd.ask.frf([10.0, 20.0], drive=("z", 0.5)))
    receptance of 2 lines, 10 to 20 Hz, driven in z at 0.500 m
    """

    frequency: Any
    _: KW_ONLY
    drive: Any
    response: Any = None
    quantity: str = "receptance"
    measures: ClassVar[tuple[str, ...]] = OF_FRF
    solvers: ClassVar[tuple[str, ...]] = tuple(SOLVERS)
    usual: ClassVar[tuple[str, ...]] = ("sweep", "lapack")
    of_spans: ClassVar[tuple[str, ...]] = ("sweep",)

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

    def values(self, answer: FRF) -> Complex:
        """Return the response."""
        return answer.value

    def mesh(self, answer: FRF) -> Real:
        """Return the estimated relative error that the mesh causes."""
        return answer.mesh_error

    def rounding(self, answer: FRF) -> Real:
        """Return the estimated relative error that rounding causes."""
        return answer.rounding_bound

    def change(self, answer: FRF, model: Model, *, solver: str | None = None) -> AnswerChange:
        """Compare an answer with that of a model from which something was left out."""
        left = self.of(model, solver=solver or self.solvers[0], threads=1)
        return change_of_frf(answer, left)

    def work(self, model: Model, solver: str) -> float:
        """Return the seconds, by their order, that an assembled solver takes: n a line."""
        return 4e-7 * model.size * len(self.frequency) * (solver == "lapack")


@dataclass(frozen=True, eq=False)
class SteppedSineQuestion(FRFQuestion):
    """Ask for steady motion under a sine, as ``model.stepped_sine(...)`` does.

    Parameters
    ----------
    frequency, drive, response, quantity
        As in `FRFQuestion`: frequencies > 0, one drive.
    amplitude : float
        Of the sine [N, N m; m, rad of an end].

    Raises
    ------
    TypeError, SceneError
        If an argument is of the wrong type, or has no meaning.

    Examples
    --------
    >>> import ropedyn as rd
    >>> print(rd.ask.stepped_sine([12.0, 15.0], drive=("z", 0.5), amplitude=2.0))
    steady receptance of 2 lines, 12 to 15 Hz, driven in z at 0.500 m with 2
    """

    amplitude: float = field(kw_only=True)
    solvers: ClassVar[tuple[str, ...]] = AnyQuestion.solvers
    usual: ClassVar[tuple[str, ...]] = AnyQuestion.usual
    of_spans: ClassVar[tuple[str, ...]] = AnyQuestion.of_spans

    def __post_init__(self) -> None:
        super().__post_init__()
        amplitude = check.number(self.amplitude, "amplitude", sign="positive")
        object.__setattr__(self, "amplitude", amplitude)

    def __str__(self) -> str:
        return f"steady {super().__str__()} with {self.amplitude:g}"

    def of(self, model: Model, *, solver: str = "auto", threads: int | None = None) -> FRF:
        """Ask a model; see `Model.stepped_sine`. One thread finds it whatever `threads`."""
        how = {"drive": self.drive, "response": self.response, "quantity": self.quantity}
        return model.stepped_sine(self.frequency, amplitude=self.amplitude, **how)

    def work(self, model: Model, solver: str) -> float:
        """Return the seconds, by their order, that harmonic balance takes: n a line."""
        return 6e-3 * model.size * len(self.frequency)


@dataclass(frozen=True, eq=False)
class StaticQuestion(AnyQuestion):
    """Ask for static deflection, as ``model.static(...)`` does; that in the loads is compared.

    Parameters
    ----------
    load : mapping from points to float
        Such as ``{("z", 0.5): 10.0}`` [N, N m].

    Raises
    ------
    TypeError, SceneError
        If an argument is of the wrong type, or has no meaning.

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
    >>> question = rd.ask.static({("z", 0.3): 10.0})
    >>> print(question, question.values(question.of(scene.compile())).round(9))
    deflection under loads in z at 0.300 m [0.021]
    >>> chain = question.placed(scene).compile(elements=8)
    >>> print(chain.x[3].round(9), question.values(question.of(chain)).round(9))
    0.3 [0.021]
    """

    load: Mapping[Point, float]
    solvers: ClassVar[tuple[str, ...]] = ("sweep", "band", "lapack")
    usual: ClassVar[tuple[str, ...]] = ("sweep", "lapack")
    of_spans: ClassVar[tuple[str, ...]] = ("sweep",)
    each: ClassVar[float] = 1e-5

    def __post_init__(self) -> None:
        check_some(self.load)
        given = {
            check.points(point, "load", forces=False): check.number(value, f"load[{point!r}]")
            for point, value in self.load.items()
        }
        object.__setattr__(self, "load", given)

    def __str__(self) -> str:
        return f"deflection under loads in {' and '.join(map(place, self.load))}"

    def of(self, model: Model, *, solver: str = "sweep", threads: int | None = None) -> Deflection:
        """Ask a model; see `Model.static`."""
        return model.static(self.load, solver=solver)

    def values(self, answer: Deflection) -> Real:
        """Return the deflection in each load."""
        return self._in_loads(answer, answer.displacement)

    def rounding(self, answer: Deflection) -> Real:
        """Return the relative error that rounding causes."""
        return relative_to(self.values(answer), self._in_loads(answer, answer.rounding_bound))

    def mesh(self, answer: Deflection) -> Real:
        """Return the relative error that the mesh causes."""
        return relative_to(self.values(answer), self._in_loads(answer, answer.mesh_error))

    def _in_loads(self, answer: Deflection, each: Real) -> Real:
        """Return what there is of each node and coordinate in each load."""
        found = np.zeros(len(self.load))
        for k, (coordinate, x) in enumerate(self.load):
            node = np.abs(answer.x - x).argmin()
            if abs(answer.x[node] - x) > ON_A_NODE * answer.x[-1]:
                raise SceneError(
                    f"load must stand on a node, such as one under a part, to be compared, got x = "
                    f"{x:g} m beside a node at {answer.x[node]:g} m"
                )
            found[k] = each[node, answer.coordinates.index(coordinate)]
        return found

    def placed(self, scene: Scene) -> Scene:
        """Return the scene with nodes under the loads: masses of 0 kg."""
        inside = sorted({x for _, x in self.load if 0 < x < scene.rope.length})
        return scene.replace(parts=(*scene.parts, *(PointMass(x, 0.0) for x in inside)))
