"""Frequency response."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from .answer import Cost, Frozen, axes, nested
from .curves import Curves
from .port import Point


@dataclass(frozen=True, eq=False)
class Mesh(Frozen):
    """What continuous spans say about the response of a chain; see `FRF`."""

    mesh_error: NDArray[np.float64] = field(metadata=axes("drive", "response", "frequency"))


@dataclass(frozen=True, eq=False)
class FRF(Curves):
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
