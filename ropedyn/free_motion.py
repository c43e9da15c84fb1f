"""What modes are, undamped or damped: motion that nothing drives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from .answer import Answer, Frozen, axes
from .chain import CARRIED

Number = TypeVar("Number", np.float64, np.complex128)


@dataclass(frozen=True, eq=False)
class Vectors(Frozen, Generic[Number]):
    """What follows from the shapes of modes; see `Modes` and `DampedModes`."""

    family: NDArray[np.str_] = field(metadata=axes("mode"))
    modal_mass: NDArray[Number] = field(metadata=axes("mode", unit="kg or kg m^2"))
    shape: NDArray[Number] = field(metadata=axes("mode", "node", "coordinate", unit="m or rad"))
    energy: dict[str, NDArray[np.float64]] = field(metadata=axes("mode", keyed=True))


@dataclass(frozen=True, eq=False)
class Mesh(Frozen):
    """What continuous spans say about the modes of a chain; see `Modes` and `DampedModes`."""

    mesh_error: NDArray[np.float64] = field(metadata=axes("mode", unit="Hz"))


OfShapes = TypeVar("OfShapes", bound=Vectors[Any])
OfMesh = TypeVar("OfMesh", bound=Mesh)


class FreeMotion(Answer, Generic[Number, OfShapes, OfMesh]):
    """Base of modes: what follows from shapes and from continuous spans is found when asked for."""

    coordinates: tuple[str, ...]
    source: OfShapes | Callable[[], OfShapes]
    mesh_source: OfMesh | Callable[[], OfMesh]

    @cached_property
    def vectors(self) -> OfShapes:
        """What follows from the shapes."""
        return self.source if isinstance(self.source, Vectors) else self.source()

    @cached_property
    def mesh(self) -> OfMesh:
        """What the continuous spans of the same scene say."""
        return self.mesh_source if isinstance(self.mesh_source, Mesh) else self.mesh_source()

    @property
    def mesh_error(self) -> NDArray[np.float64]:
        """Error that the elements cause [Hz], shape (k,)."""
        return self.mesh.mesh_error

    @property
    def family(self) -> NDArray[np.str_]:
        """Family of each mode, shape (k,)."""
        return self.vectors.family

    @property
    def modal_mass(self) -> NDArray[Number]:
        """Modal mass, shape (k,)."""
        return self.vectors.modal_mass

    @property
    def shape(self) -> NDArray[Number]:
        """Shapes, shape (k, nodes, coordinates)."""
        return self.vectors.shape

    @property
    def energy(self) -> dict[str, NDArray[np.float64]]:
        """Fractions of strain and of kinetic energy, each shape (k,)."""
        return self.vectors.energy

    @property
    def _shares(self) -> dict[str, NDArray[np.float64]]:
        """Columns of the energies, kinetic ones first [%]."""
        moving = (*self.coordinates, *CARRIED.values())
        kinetic = [name for name in moving if name in self.energy]
        strain = [name for name in self.energy if name not in moving]
        columns = {f"kinetic {name} [%]": 100 * self.energy[name] for name in kinetic}
        return columns | {f"strain {name} [%]": 100 * self.energy[name] for name in strain}
