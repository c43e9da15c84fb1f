"""Frequency response."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import check
from .answer import Answer, Cost, axes, freeze, nested
from .errors import SceneError
from .port import Point
from .resonance import Resonances, resonances
from .table import Table
from .unit import QUANTITIES, label, place

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False)
class Mesh:
    """What continuous spans say about the response of a chain; see `FRF`."""

    mesh_error: NDArray[np.float64] = field(metadata=axes("drive", "response", "frequency"))

    def __post_init__(self) -> None:
        freeze(self)

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        freeze(self)


@dataclass(frozen=True, eq=False)
class FRF(Answer):
    """Frequency response: motion is Re(value exp(+i omega t)) per unit force.

    Attributes
    ----------
    drive : tuple of points
        Where and on what the forces act, or whose motion is given; one, unless a list was asked
        for.
    response : tuple of points
        What is watched.
    quantity : {"receptance", "mobility", "accelerance"}
        Displacement, velocity or acceleration per force, or per displacement of an end.
    frequency : ndarray, shape (f,)
        [Hz].
    value : ndarray of complex, shape (responses, f) or (drives, responses, f)
        [m/N, rad/N, m/(N m), rad/(N m), of internal forces N/N and so on, per motion of an end
        m/m, rad/m and so on; and these per s or s^2].
    rounding_error : ndarray, as value
        Estimated relative error that rounding causes.
    mesh_error : ndarray, as value
        Relative error that the elements cause, computed when it is first asked for. Not an
        estimate: the distance to the response of the continuous spans of the same scene, and the
        rounding error of that, over the value. 0 for continuous spans, because they have none;
        infinite where they have no answer, as on an undamped resonance of theirs, and where only
        the value is 0. Refined, chains of difference elements lead elsewhere; theirs is the
        distance to the same continuous spans. With `ModalDamping`, also the bound of what the modes
        give that were left out.
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
    mesh_source: Mesh | Callable[[], Mesh] = field(repr=False, metadata=nested(Mesh, "mesh"))

    @cached_property
    def mesh(self) -> Mesh:
        """What the continuous spans of the same scene say."""
        return self.mesh_source if isinstance(self.mesh_source, Mesh) else self.mesh_source()

    @property
    def mesh_error(self) -> NDArray[np.float64]:
        """Relative error that the elements cause, as value."""
        return self.mesh.mesh_error

    @property
    def labels(self) -> tuple[str, ...]:
        """What each response is, with its unit, for the first drive."""
        return tuple(label(r, self.drive[0], self.quantity) for r in self.response)

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
        return replace(self, quantity=quantity, value=value)

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
        for d, drive in enumerate(self.drive):
            for r, point in enumerate(self.response):
                name = label(point, drive, self.quantity)
                if len(self.drive) > 1:
                    name += f" driven in {place(drive)}"
                curve = self.curve(r, d)
                columns[f"|{name}|" if name not in columns else name] = np.abs(curve)
                columns[f"phase of {name} [deg]"] = np.degrees(np.angle(curve))
        return Table.of(f"{self.quantity} over frequency", columns)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the amplitudes over frequency."""
        from .plotting import plot_frf

        return plot_frf(self, ax)
