"""Frequency response."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core, check, damping
from .answer import Answer, Cost, axes
from .errors import SceneError, SolveError
from .model import Model, Point, locate, ports
from .resonance import Resonances, resonances
from .table import Table
from .unit import QUANTITIES, label

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False)
class FRF(Answer):
    """Frequency response: motion is Re(value exp(+i omega t)) per unit force.

    Attributes
    ----------
    drive : tuple of points
        Where and on what the forces act; one, unless a list was asked for.
    response : tuple of points
        What is watched.
    quantity : {"receptance", "mobility", "accelerance"}
        Displacement, velocity or acceleration per force.
    frequency : ndarray, shape (f,)
        [Hz].
    value : ndarray of complex, shape (responses, f) or (drives, responses, f)
        [m/N, rad/N, m/(N m), rad/(N m), and these per s or s^2].
    rounding_error : ndarray, as value
        Estimated relative error that rounding in the assembled matrices causes.
    cost : Cost
        What it cost.
    """

    drive: tuple[Point, ...]
    response: tuple[Point, ...]
    quantity: str
    frequency: NDArray[np.float64] = field(metadata=axes("frequency", unit="Hz"))
    value: NDArray[np.complex128] = field(metadata=axes("drive", "response", "frequency"))
    rounding_error: NDArray[np.float64] = field(metadata=axes("drive", "response", "frequency"))
    cost: Cost

    @property
    def labels(self) -> tuple[str, ...]:
        """What each response is, with its unit, for the first drive."""
        return tuple(label(r, self.drive[0][0], self.quantity) for r in self.response)

    def curve(self, response: int = 0, drive: int = 0) -> NDArray[np.complex128]:
        """Return one response to one drive, shape (f,).

        Raises
        ------
        TypeError, SceneError
            If a number is none of those there are.
        """
        check.count(response, "response", least=0, most=len(self.response) - 1)
        check.count(drive, "drive", least=0, most=len(self.drive) - 1)
        return self.value[response] if self.value.ndim == 2 else self.value[drive, response]

    def to(self, quantity: str) -> FRF:
        """Return the same response as another quantity.

        Parameters
        ----------
        quantity : {"receptance", "mobility", "accelerance"}
            Displacement, velocity or acceleration per force.

        Raises
        ------
        SceneError
            If the quantity is unknown, or a motion at 0 Hz would have to be integrated.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=8)
        >>> frf = model.frf([1.0], drive=("z", 0.5)).to("mobility")
        >>> frf.labels
        ('z at 0.500 m [m/s/N]',)
        """
        check.one_of(quantity, "quantity", QUANTITIES)
        times = QUANTITIES[quantity] - QUANTITIES[self.quantity]
        if times < 0 and (self.frequency == 0).any():
            raise SceneError(
                f"quantity must be {self.quantity!r} where a frequency is 0, got {quantity!r}"
            )
        value = self.value * (2j * np.pi * self.frequency) ** times
        return FRF(
            drive=self.drive,
            response=self.response,
            quantity=quantity,
            frequency=self.frequency,
            value=value,
            rounding_error=self.rounding_error,
            cost=self.cost,
        )

    def peaks(self, drive: int = 0) -> tuple[Resonances, ...]:
        """Find the resonances that show as peaks, for each response.

        Parameters
        ----------
        drive : int, optional
            Which drive.

        Returns
        -------
        tuple of Resonances
            Frequency [Hz], amplitude and damping ratio of each peak.

        Raises
        ------
        TypeError, SceneError
            If the drive is none of those there are.
        """
        check.count(drive, "drive", least=0, most=len(self.drive) - 1)
        return tuple(
            resonances(self.frequency, self.curve(r, drive), self.quantity, self.labels[r])
            for r in range(len(self.response))
        )

    def table(self) -> Table:
        """Return amplitude and phase of every response over frequency."""
        columns: dict[str, Any] = {"frequency [Hz]": self.frequency}
        for d, (coordinate, x) in enumerate(self.drive):
            for r, point in enumerate(self.response):
                name = label(point, coordinate, self.quantity)
                if len(self.drive) > 1:
                    name += f" driven in {coordinate} at {x:.3f} m"
                curve = self.curve(r, d)
                columns[f"|{name}|" if name not in columns else name] = np.abs(curve)
                columns[f"phase of {name} [deg]"] = np.degrees(np.angle(curve))
        return Table.of(f"{self.quantity} over frequency", columns)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the amplitudes over frequency."""
        from .plotting import plot_frf

        return plot_frf(self, ax)


def solve_frf(
    model: Model,
    frequency: ArrayLike,
    *,
    drive: Any,
    response: Any,
    quantity: str,
    solver: str,
) -> FRF:
    """Compute the frequency response; see `Model.frf`."""
    check.one_of(solver, "solver", ("lapack",))
    check.one_of(quantity, "quantity", QUANTITIES)
    f = check.frequencies(frequency)
    drives, several = _points(model, drive, "drive")
    responses = drives if response is None else _points(model, response, "response")[0]
    value = np.zeros((len(f), len(drives), len(responses)), dtype=np.complex128)
    rounding = np.zeros(value.shape)
    unknowns = 0
    start = time.perf_counter()
    for component in model.components:
        d = [k for k, point in enumerate(drives) if point[0] in component]
        r = [k for k, point in enumerate(responses) if point[0] in component]
        if not d or not r:
            continue
        block = np.ix_(range(len(f)), d, r)
        value[block], rounding[block] = _solve_component(
            model, component, f, [drives[k] for k in d], [responses[k] for k in r]
        )
        unknowns += model.chain.only(component).free
    seconds = time.perf_counter() - start
    value *= ((2j * np.pi * f) ** QUANTITIES[quantity])[:, None, None]
    value, rounding = value.transpose(1, 2, 0), rounding.transpose(1, 2, 0)
    return FRF(
        drive=drives,
        response=responses,
        quantity=quantity,
        frequency=f,
        value=np.ascontiguousarray(value if several else value[0]),
        rounding_error=np.ascontiguousarray(rounding if several else rounding[0]),
        cost=Cost(seconds, "lapack", len(model.x) - 1, unknowns, len(f) if unknowns else 0),
    )


def _points(model: Model, given: Any, name: str) -> tuple[tuple[Point, ...], bool]:
    """Return one or several points, and whether a list of them was given."""
    length = model.scene.rope.length
    several = isinstance(given, (list, tuple)) and len(given) > 0 and not isinstance(given[0], str)
    if not several:
        return (check.point(given, name, model.coordinates, length),), False
    points = (
        check.point(one, f"{name}[{k}]", model.coordinates, length) for k, one in enumerate(given)
    )
    return tuple(points), True


def _solve_component(
    model: Model,
    component: tuple[str, ...],
    frequency: NDArray[np.float64],
    drives: Sequence[Point],
    responses: Sequence[Point],
) -> tuple[NDArray[np.complex128], NDArray[np.float64]]:
    """Return value and relative rounding error, shape (f, drives, responses)."""
    chain = model.chain.only(component)
    factor = damping.factors(model.scene.dampings, 2 * np.pi * frequency)
    value, rounding, motion, solved = _core.frf(
        chain,
        factor,
        ports(model, chain, component, drives),
        ports(model, chain, component, responses),
    )
    lost = solved < len(frequency) or (motion >= 1).any()
    if lost:
        first = min([solved, *np.flatnonzero((motion[:solved] >= 1).any(axis=1))])
        raise SolveError(
            f"frequency {float(frequency[first])!r} Hz has no correct digit in "
            f"({', '.join(component)}): it lies on an undamped resonance, or "
            f"{len(model.x) - 1} elements are too many for the assembled stiffness"
        )
    for d, pushed in enumerate(drives):
        for r, watched in enumerate(responses):
            which, flexibility = _local(model, component, pushed, watched)
            value[:, d, r] += flexibility / factor[:, which]
    bad = ~np.isfinite(value).all(axis=(1, 2)) | np.isnan(rounding).any(axis=(1, 2))
    if bad.any():
        first = float(frequency[bad][0])
        raise SolveError(f"the numbers overflow at the frequency {first!r} Hz: check the units")
    return value, rounding


def _local(
    model: Model, component: tuple[str, ...], pushed: Point, watched: Point
) -> tuple[int, float]:
    """Return what the inside of an element adds: which factor divides it, and the flexibility.

    It is 0 unless both points lie inside the same element.
    """
    which = damping.SECTION if "beta" in component or pushed[0] != "z" else damping.TENSION
    left, p = locate(model, pushed[1])
    other, s = locate(model, watched[1])
    if p is None or s is None or left != other:
        return which, 0.0
    chain = model.chain.only(component)
    local = _core.local(chain, int(chain.element_of[left]), s, p)
    return which, float(local[component.index(watched[0]), component.index(pushed[0])])
