"""Natural frequencies and shapes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .answer import Answer, Cost, axes, freeze, nested
from .table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False)
class Vectors:
    """What follows from the shapes of modes; see `Modes`."""

    damping_ratio: NDArray[np.float64] = field(metadata=axes("mode"))
    family: NDArray[np.str_] = field(metadata=axes("mode"))
    modal_mass: NDArray[np.float64] = field(metadata=axes("mode", unit="kg or kg m^2"))
    shape: NDArray[np.float64] = field(metadata=axes("mode", "node", "coordinate", unit="m or rad"))
    energy: dict[str, NDArray[np.float64]] = field(metadata=axes("mode", keyed=True))

    def __post_init__(self) -> None:
        freeze(self)

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        freeze(self)


@dataclass(frozen=True, eq=False)
class Mesh:
    """What continuous spans say about the modes of a chain; see `Modes`."""

    mesh_error: NDArray[np.float64] = field(metadata=axes("mode", unit="Hz"))
    limit: NDArray[np.float64] = field(metadata=axes("mode", unit="Hz"))

    def __post_init__(self) -> None:
        freeze(self)

    def __setstate__(self, state: dict[str, Any]) -> None:
        vars(self).update(state)
        freeze(self)


@dataclass(frozen=True, eq=False)
class Modes(Answer):
    """Natural frequencies and shapes of an undamped model, lowest first.

    What follows from the shapes (`shape`, `energy`, `family`, `modal_mass`, `damping_ratio`) is
    computed when it is first asked for, and so is what follows from the continuous spans of the
    same scene (`mesh_error`, `limit`).

    Attributes
    ----------
    coordinates : tuple of str
        Of every node.
    x : ndarray, shape (nodes,)
        Where shapes are given [m]: at the nodes, of continuous spans also at points within.
    frequency : ndarray, shape (k,)
        [Hz]; 0 for rigid-body motion and where motion grows.
    eigenvalue : ndarray, shape (k,)
        omega^2 [rad^2/s^2]; negative beyond the critical compression.
    growth : ndarray, shape (k,)
        Growth rate sqrt(-omega^2) where that is negative [1/s], else 0.
    rounding_error : ndarray, shape (k,)
        Estimated absolute error of the frequency that rounding causes [Hz]; of growth/2 pi where
        motion grows.
    mesh_error : ndarray, shape (k,)
        Absolute error of the frequency that the elements cause [Hz]; of growth/2 pi where motion
        grows. Not an estimate: the distance to the mode of the same number, among those of the
        same component, of the continuous spans, and the rounding error of that. 0 for continuous
        spans, because they have none; infinite where they have no answer.
    limit : ndarray, shape (k,)
        The frequency without mesh error [Hz]: that of the continuous spans, which the frequencies
        of ever finer chains of tensed or rigid elements approach. Exact, where extrapolation from
        two chains would be an estimate. 0 where motion grows, NaN where there is no answer.
    certified : bool
        True: no mode is missed below the last, shown by count. The assembled solver does not count.
    damping_ratio : ndarray, shape (k,)
        Of each mode by its share of every damped part; exact where damping is proportional, the
        first-order value otherwise, 0 where the frequency is 0.
    family : ndarray of str, shape (k,)
        "transverse", "bending rotation", "torsional" or "axial": the coordinate with the most
        kinetic energy.
    modal_mass : ndarray, shape (k,)
        shape^T M shape, of continuous spans its integral [kg, kg m^2]: of the shape as it is given,
        so that shape^2/modal_mass at a place does not depend on the other points.
    shape : ndarray, shape (k, nodes, coordinates)
        The largest component of the family's own coordinate at `x` is 1 [m, rad]; where a mode has
        its nodes at all of them, that elsewhere.
    energy : dict of ndarray, shape (k,)
        Fractions: strain "bending", "twist", "stretch", "lay", "tension", "spring" as far as the
        scene has them, sum 1 (all 0 for rigid-body motion); kinetic "x", "z", "alpha", "beta" of
        the coordinates there are, sum 1. The springs and the motion of resonators and broken wires
        are "attached" and "attached mass", where the scene has any.
    cost : Cost
        What the frequencies cost.
    """

    coordinates: tuple[str, ...]
    certified: bool
    x: NDArray[np.float64] = field(metadata=axes("node", unit="m"))
    frequency: NDArray[np.float64] = field(metadata=axes("mode", unit="Hz"))
    eigenvalue: NDArray[np.float64] = field(metadata=axes("mode", unit="rad^2/s^2"))
    growth: NDArray[np.float64] = field(metadata=axes("mode", unit="1/s"))
    rounding_error: NDArray[np.float64] = field(metadata=axes("mode", unit="Hz"))
    cost: Cost
    source: Vectors | Callable[[], Vectors] = field(repr=False, metadata=nested(Vectors, "vectors"))
    mesh_source: Mesh | Callable[[], Mesh] = field(repr=False, metadata=nested(Mesh, "mesh"))

    @cached_property
    def vectors(self) -> Vectors:
        """What follows from the shapes."""
        return self.source if isinstance(self.source, Vectors) else self.source()

    @cached_property
    def mesh(self) -> Mesh:
        """What the continuous spans of the same scene say."""
        return self.mesh_source if isinstance(self.mesh_source, Mesh) else self.mesh_source()

    @property
    def mesh_error(self) -> NDArray[np.float64]:
        """Error of each frequency that the elements cause [Hz], shape (k,)."""
        return self.mesh.mesh_error

    @property
    def limit(self) -> NDArray[np.float64]:
        """Frequencies without mesh error [Hz], shape (k,)."""
        return self.mesh.limit

    @property
    def damping_ratio(self) -> NDArray[np.float64]:
        """Damping ratio of each mode, shape (k,)."""
        return self.vectors.damping_ratio

    @property
    def family(self) -> NDArray[np.str_]:
        """Family of each mode, shape (k,)."""
        return self.vectors.family

    @property
    def modal_mass(self) -> NDArray[np.float64]:
        """Modal mass, shape (k,)."""
        return self.vectors.modal_mass

    @property
    def shape(self) -> NDArray[np.float64]:
        """Shapes, shape (k, nodes, coordinates)."""
        return self.vectors.shape

    @property
    def energy(self) -> dict[str, NDArray[np.float64]]:
        """Fractions of strain and of kinetic energy, each shape (k,)."""
        return self.vectors.energy

    def table(self) -> Table:
        """Return one row for each mode."""
        columns: dict[str, Any] = {
            "mode": np.arange(1, len(self.frequency) + 1),
            "frequency [Hz]": self.frequency,
            "mesh error [Hz]": self.mesh_error,
            "rounding error [Hz]": self.rounding_error,
            "damping ratio": self.damping_ratio,
            "family": self.family,
        }
        if (self.growth > 0).any():
            columns["growth [1/s]"] = self.growth
        moving = (*self.coordinates, "attached mass")
        kinds = {"kinetic": tuple(k for k in moving if k in self.energy)}
        kinds["strain"] = tuple(k for k in self.energy if k not in moving)
        for kind, names in kinds.items():
            columns |= {f"{kind} {name} [%]": 100 * self.energy[name] for name in names}
        return Table.of("natural frequencies", columns)

    def plot(self, ax: Axes | None = None, *, coordinate: str | None = None) -> Axes:
        """Plot the shapes of one coordinate along the rope, the first one by default."""
        from .plotting import plot_modes

        return plot_modes(self, ax, coordinate)
