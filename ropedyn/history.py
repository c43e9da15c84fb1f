"""Motion over time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .answer import Answer, Cost, Frozen, axes, nested
from .port import Point
from .table import Table
from .unit import label

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Real = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Balance(Frozen):
    """Where the energy is; see `History`."""

    energy: dict[str, Real] = field(metadata=axes("time", unit="J", keyed=True))


@dataclass(frozen=True, eq=False)
class Deviation(Frozen):
    """How far the values are from those without steps and without elements; see `History`."""

    step_error: Real = field(metadata=axes("response", "time"))
    mesh_error: Real = field(metadata=axes("response", "time"))


@dataclass(frozen=True, eq=False)
class History(Answer):
    """Motion over time.

    What it would take other runs to know (`step_error`, `mesh_error`, of the modal method also
    `energy`) is computed when it is first asked for.

    Attributes
    ----------
    drive : tuple of points
        What the forces act on, or whose motion is given.
    response : tuple of points
        What is watched.
    quantity : {"displacement", "velocity", "acceleration"}
        Of the responses.
    time : ndarray, shape (t,)
        [s].
    value : ndarray, shape (responses, t)
        [m, rad, and these per s or s^2; N, N m].
    force : ndarray, shape (drives, t)
        What drives, at these times [N, N m; m, rad]; of a blow at an instant nothing.
    truncation_error : ndarray, shape (responses,)
        Bound of the absolute error of every value that the modes cause which were left out. 0 of
        the direct method, infinite where there is no bound.
    step_error : ndarray, shape (responses, t)
        Estimated absolute error that the steps of the direct method cause: by Richardson's
        extrapolation from a run with half the steps' length, within a tolerance from the last two
        runs. 0 of the modal method, which is exact.
    mesh_error : ndarray, shape (responses, t)
        Absolute error that the elements cause: the distance to the motion of the continuous spans
        of the same scene and the error of that. 0 for continuous spans, infinite where they have no
        answer, as where something is not linear.
    energy : dict of ndarray, shape (t,)
        "kinetic" and "strain", what the forces put in since t = 0 ("input") and what dampers took
        ("dissipated") [J]: kinetic + strain - input + dissipated stays what it was at the first
        time, but for what numerical damping takes. Work of a tension that pulsates is input; of an
        end that jumps, what stays of it. Where stops or a `NodeForce` act, what they took since
        then is "laws" and belongs to the sum.
    snapshot_time : ndarray, shape (s,)
        When the whole rope was looked at [s].
    x : ndarray, shape (nodes,)
        Where [m].
    coordinates : tuple of str
        Of every node.
    snapshot : ndarray, shape (s, nodes, coordinates)
        Displacement of the whole rope [m, rad].
    stopped : str
        Why it ends before the last time that was asked for; empty where it does not.
    cost : Cost
        What it cost.
    """

    drive: tuple[Point, ...]
    response: tuple[Point, ...]
    quantity: str
    coordinates: tuple[str, ...]
    time: Real = field(metadata=axes("time", unit="s"))
    value: Real = field(metadata=axes("response", "time"))
    force: Real = field(metadata=axes("drive", "time"))
    truncation_error: Real = field(metadata=axes("response"))
    snapshot_time: Real = field(metadata=axes("snapshot", unit="s"))
    x: Real = field(metadata=axes("node", unit="m"))
    snapshot: Real = field(metadata=axes("snapshot", "node", "coordinate", unit="m or rad"))
    cost: Cost
    balance_source: Balance | Callable[[], Balance] = field(
        repr=False, metadata=nested(Balance, "balance")
    )
    deviation_source: Deviation | Callable[[], Deviation] = field(
        repr=False, metadata=nested(Deviation, "deviation")
    )
    stopped: str = ""

    @cached_property
    def balance(self) -> Balance:
        """Where the energy is."""
        source = self.balance_source
        return source if isinstance(source, Balance) else source()

    @cached_property
    def deviation(self) -> Deviation:
        """What other runs say."""
        source = self.deviation_source
        return source if isinstance(source, Deviation) else source()

    @property
    def energy(self) -> dict[str, Real]:
        """Energies over time [J], each shape (t,)."""
        return self.balance.energy

    @property
    def step_error(self) -> Real:
        """Error that steps cause, as value."""
        return self.deviation.step_error

    @property
    def mesh_error(self) -> Real:
        """Error that elements cause, as value."""
        return self.deviation.mesh_error

    @property
    def labels(self) -> tuple[str, ...]:
        """What each response is, with its unit."""
        return tuple(label(r, quantity=self.quantity) for r in self.response)

    def table(self) -> Table:
        """Return every response over time."""
        columns: dict[str, Any] = {"time [s]": self.time}
        columns |= dict(zip(self.labels, self.value))
        return Table.of(f"{self.quantity} over time", columns)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the responses over time."""
        from .plotting import plot_history

        return plot_history(self, ax)
