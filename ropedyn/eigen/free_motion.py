"""What modes are, undamped or damped: motion that nothing drives."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from ..axis.axis import Axis
from ..base import check
from ..base.answer import Answer, Frozen, axes
from ..base.array import Real
from ..base.computed import Lazy, Read
from ..base.errors import SceneError
from ..base.unit import own_coordinate
from ..chain.chain import CARRIED
from .animation import VIEWS, Animation, animated, flying, in_space

Number = TypeVar("Number", np.float64, np.complex128)


@dataclass(frozen=True, eq=False)
class Vectors(Frozen, Generic[Number]):
    """What follows from the shapes of modes; see `Modes` and `DampedModes`."""

    family: NDArray[np.str_] = field(metadata=axes("mode"))
    modal_mass: NDArray[Number] = field(metadata=axes("mode", unit="kg or kg m^2"))
    shape: NDArray[Number] = field(metadata=axes("mode", "node", "coordinate", unit="m or rad"))
    energy: dict[str, Real] = field(metadata=axes("mode", keyed=True))


@dataclass(frozen=True, eq=False)
class MeshOfModes(Frozen):
    """What continuous spans say about the modes of a chain; see `Modes` and `DampedModes`."""

    mesh_error: Real = field(metadata=axes("mode", unit="Hz"))


OfShapes = TypeVar("OfShapes", bound=Vectors[Any])
OfMesh = TypeVar("OfMesh", bound=MeshOfModes)


class FreeMotion(Answer, Generic[Number, OfShapes, OfMesh]):
    """Base of modes: what follows from shapes and from continuous spans is found when asked for."""

    coordinates: tuple[str, ...]
    x: Lazy[Real]
    plane: Lazy[NDArray[np.str_]]
    line: Callable[[], Axis] | None
    vectors: Lazy[OfShapes]
    mesh: Lazy[OfMesh]

    mesh_error = Read[Real]("mesh", "Error that the elements cause [Hz], shape (k,).")
    family = Read[NDArray[np.str_]]("vectors", "Family of each mode, shape (k,).")
    modal_mass = Read[NDArray[Number]]("vectors", "Modal mass, shape (k,).")
    shape = Read[NDArray[Number]]("vectors", "Shapes, shape (k, nodes, coordinates).")
    energy = Read[dict[str, Real]]("vectors", "Fractions of strain and kinetic energy, (k,) each.")

    def animate(
        self,
        k: int = 0,
        *,
        path: str | os.PathLike[str] | None = None,
        frames: int = 30,
        seconds: float = 2.0,
        view: str | None = None,
    ) -> Animation:
        """Show one period of a mode in motion.

        Complex shapes travel as they do, Re(shape e^(i omega t)); decay is left out. A mode of a
        rope on an axis moves in space, one of a straight rope coordinate by coordinate, or in space
        too if a view is given.

        Parameters
        ----------
        k : int
            Which mode, from 0 as in ``modes.frequency[k]``.
        path : path, optional
            Of a file to write: ``.gif``, ``.html`` or, where ffmpeg is installed, ``.mp4``.
        frames : int
            How many there are in the period, from 2 to 1000.
        seconds : float
            What the period takes on the screen [s].
        view : {"isometric", "front", "top", "side"}, optional
            In space, as of `SpaceModel.plot`, magnified to a tenth of the axis' extent.

        Returns
        -------
        Animation
            A notebook shows it.

        Raises
        ------
        TypeError
            If an argument is of the wrong type.
        SceneError
            If a number is out of range, the mode does not oscillate or the file is of another kind;
            for a view, if the modes were read from a file, which has no axis.
        OSError
            If the file cannot be written.

        Examples
        --------
        >>> import ropedyn as rd
        >>> modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile().modes(2)
        >>> animation = modes.animate(1, frames=4)
        >>> animation
        <Animation of mode 2: 50 Hz, transverse, 4 frames>
        >>> animation.motion.shape == (4, len(modes.x), 1)
        True
        """
        frequency = cast("Any", self).frequency
        check.count(k, "k", least=0, most=len(frequency) - 1)
        count = check.count(frames, "frames", least=2, most=1000)
        duration = check.number(seconds, "seconds", "s", sign="positive")
        if not frequency[k] > 0:
            raise SceneError(
                f"k must be that of a mode that oscillates, got {k}, whose frequency is 0"
            )
        if view is not None:
            check.one_of(view, "view", VIEWS)
        title = f"mode {k + 1}: {frequency[k]:.4g} Hz, {self.family[k]}"
        axis = None if self.line is None else self.line()
        if axis is not None and (view is not None or not axis.is_straight):
            moved = in_space(axis, self.coordinates, self.x, self.shape[k])
            how: Any = {"view": view or VIEWS[0], "frames": count, "seconds": duration}
            animation = flying(title, *moved, **how)
        elif view is not None:
            raise SceneError(
                f"view must be left out for modes from a file, which has no axis, got {view!r}"
            )
        else:
            animation = self._beside(k, title, count, duration)
        if path is not None:
            animation.write(path)
        return animation

    def _beside(self, k: int, title: str, count: int, duration: float) -> Animation:
        return animated(
            title,
            self.coordinates,
            self.x,
            self.shape[k],
            own=own_coordinate(self.family[k], self.plane[k]),
            frames=count,
            seconds=duration,
        )

    @property
    def _shares(self) -> dict[str, Real]:
        """Columns of the energies, kinetic ones first [%]."""
        moving = (*self.coordinates, *CARRIED.values())
        kinetic = [name for name in moving if name in self.energy]
        strain = [name for name in self.energy if name not in moving]
        columns = {f"kinetic {name} [%]": 100 * self.energy[name] for name in kinetic}
        return columns | {f"strain {name} [%]": 100 * self.energy[name] for name in strain}
