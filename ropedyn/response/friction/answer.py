"""The response to a force of one amplitude, with what wires do at it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...base.answer import axes
from ...base.array import Complex, Flags, Real
from ...base.errors import SceneError
from ..frf import FRF


@dataclass(frozen=True, eq=False)
class FrictionResponse(FRF):
    """Frequency response with friction between wires, under a force of one amplitude.

    In each cell along the rope B and loss factor are those of the amplitude of its curvature.

    Attributes
    ----------
    value : ndarray of complex, shape (responses, f)
        Motion at the frequency of the drive per amplitude of it, else as `FRF`.
    rounding_error : ndarray, as value
        Estimated relative error: the difference that cells twice as long make, and
        `third_harmonic`.
    drive_amplitude : float
        Of the drive [N, N m; m, rad of an end].
    x : ndarray, shape (cells + 1,)
        Where cells begin and end [m].
    curvature : ndarray, shape (cells, f)
        Its amplitude, the mean in each cell [1/m].
    bending_stiffness : ndarray, shape (cells, f)
        Equivalent B at that amplitude: in-phase part of the moment per curvature [N m^2].
    loss_factor : ndarray, shape (cells, f)
        Equivalent eta: B eta is the part a quarter of a period ahead, pi B eta a^2 the work that a
        cycle loses per length.
    third_harmonic : ndarray, shape (f,)
        Largest curvature at three times the frequency that the moment left out would cause, per
        largest curvature; infinite on an undamped resonance there.
    several : ndarray of bool, shape (f,)
        Where other steady motion was found too: the value is what is reached from rest as the
        drive is raised. Found from three starts, so False is no proof.

    Examples
    --------
    >>> import ropedyn as rd
    >>> made = rd.Construction.standard("1x19", diameter=20e-3)
    >>> damping = made.section().wire_friction(0.3)
    >>> scene = rd.Scene(rd.Rope.from_construction(10.0, made), tension=30e3, damping=damping)
    >>> model = scene.compile()
    >>> for force in 1.0, 300.0:
    ...     found = model.frf([6.0], drive=("z", 3.0), amplitude=force)
    ...     print(found.mean_bending_stiffness.round(), found.mean_loss_factor.round(2))
    [1020.] [0.]
    [62.] [0.37]
    """

    drive_amplitude: float = field(kw_only=True)
    x: Real = field(kw_only=True, metadata=axes("edge", unit="m"))
    curvature: Real = field(kw_only=True, metadata=axes("cell", "frequency", unit="1/m"))
    bending_stiffness: Real = field(kw_only=True, metadata=axes("cell", "frequency", unit="N m^2"))
    loss_factor: Real = field(kw_only=True, metadata=axes("cell", "frequency"))
    third_harmonic: Real = field(kw_only=True, metadata=axes("frequency"))
    several: Flags = field(kw_only=True, metadata=axes("frequency"))

    @property
    def mean_bending_stiffness(self) -> Real:
        """B of all cells by the energy of the bent rope, shape (f,) [N m^2]."""
        return np.asarray((self.bending_stiffness * self._weight).sum(axis=0))

    @property
    def mean_loss_factor(self) -> Real:
        """Loss factor of all cells by that energy, shape (f,)."""
        lost = self.loss_factor * self.bending_stiffness * self._weight
        return np.asarray(lost.sum(axis=0) / self.mean_bending_stiffness)

    @property
    def _weight(self) -> Real:
        """Share of each cell in the bending of the rope, of all alike where it is not bent."""
        square = np.diff(self.x)[:, None] * self.curvature**2
        whole, alike = square.sum(axis=0), np.full(square.shape, 1 / len(square))
        return np.divide(square, whole, out=alike, where=whole > 0)

    def derivative(self, path: str) -> Complex:
        """Refuse it: stiffness and loss would change with the motion.

        Raises
        ------
        SceneError
            Always.
        """
        raise SceneError(f"derivative must be of a linear scene, got friction and path {path!r}")

    def _columns(self) -> dict[str, Any]:
        return super()._columns() | {
            "largest curvature [1/m]": self.curvature.max(axis=0),
            "mean B [N m^2]": self.mean_bending_stiffness,
            "mean loss factor": self.mean_loss_factor,
            "third harmonic": self.third_harmonic,
            "several": self.several,
        }
