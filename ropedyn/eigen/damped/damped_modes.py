"""Complex modes: rates of damped motion and shapes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...axis.axis import Axis
from ...base.answer import TRANSIENT, Cost, axes
from ...base.array import Complex, Real
from ...base.computed import Lazy, lazy
from ...base.drawing import draw
from ...base.table import Table
from ..free_motion import FreeMotion, MeshOfModes, Vectors

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False, kw_only=True)
class DampedModes(FreeMotion[np.complex128, Vectors[np.complex128], MeshOfModes]):
    """Rates s of free motion Re(shape e^(s t)) of a damped model, those of the least |s| first.

    Of each conjugate pair the one with Im s > 0 is given (with a loss factor, whose stiffness is
    another below the real axis, it has no partner); overdamped motion, with real s, has two
    rates, which are modes each. Rigid-body motion, s = 0, is one mode even where it drifts on
    undamped. A complex modulus, of a loss factor or of a broken wire with damping, is one of
    oscillation: there only rates with Im s > 0 and rigid-body motion are modes.

    What follows from the shapes (`shape`, `energy`, `family`, `modal_mass`) is computed when it is
    first asked for, and so is `mesh_error`.

    Attributes
    ----------
    coordinates : tuple of str
        Of every node.
    x : ndarray, shape (nodes,)
        Where shapes are given [m], as in `Modes`.
    eigenvalue : ndarray of complex, shape (k,)
        s [rad/s].
    frequency : ndarray, shape (k,)
        Of the damped oscillation, Im s/2 pi [Hz]; 0 of overdamped motion.
    natural_frequency : ndarray, shape (k,)
        |s|/2 pi [Hz], that of the undamped mode where damping is proportional.
    damping_ratio : ndarray, shape (k,)
        -Re s/|s|; 1 of overdamped motion, 0 where s is 0, negative where motion grows.
    decay_rate : ndarray, shape (k,)
        -Re s [1/s].
    rounding_error : ndarray, shape (k,)
        Absolute error of s/2 pi that rounding causes [Hz], measured when it is read; see `Modes`.
    rounding_bound : ndarray, shape (k,)
        A bound of that, known at once [Hz].
    mesh_error : ndarray, shape (k,)
        Absolute error of s/2 pi that the elements cause [Hz]: the distance to the damped mode of
        the continuous spans it is matched with, and the rounding error of that. 0 for continuous
        spans, infinite where they have no answer.
    searched : float
        No mode with |s|/2 pi below this is missing [Hz].
    certified : bool
        Whether none is missing between them: circles around the modes surround as many roots of the
        characteristic function as the circle around all of them does, by the argument principle;
        where damping is proportional, the undamped modes are certified by count. False where that
        circle meets motion that decays within so small a part of a period that rounding of the
        scene's numbers alone decides about it, as of a dashpot of twice the rope's impedance. Then
        a wider circle that stays away from there is searched: beyond `searched` only modes are
        given that decay slower than `searched` times 2 pi, and those are all there.
    family : ndarray of str, shape (k,)
        "transverse", "bending rotation", "torsional" or "axial": the coordinate with the most
        kinetic energy.
    plane : ndarray of str, shape (k,)
        As in `Modes`.
    modal_mass : ndarray of complex, shape (k,)
        shape^T D'(s) shape/2 s with the dynamic stiffness D [kg, kg m^2], no part conjugate: the
        response has the poles shape shape^T/(2 s modal_mass)/(i omega - s). shape^T M shape where
        s is 0.
    shape : ndarray of complex, shape (k, nodes, coordinates)
        The largest component of the family's own coordinate at `x` is 1 [m, rad].
    energy : dict of ndarray, shape (k,)
        Fractions, as in `Modes`, averaged over a period.
    cost : Cost
        What the rates cost, and what of the rest has been read.

    Examples
    --------
    A string in a viscous medium loses c/2 mu per second, whatever the mode:

    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0, damping=rd.ViscousDamping(2.0))
    >>> modes = scene.compile().modes(2, damped=True)
    >>> modes.decay_rate.round(9), modes.natural_frequency.round(9)
    (array([10., 10.]), array([25., 50.]))
    >>> modes.frequency.round(3), modes.damping_ratio.round(4)
    (array([24.949, 49.975]), array([0.0637, 0.0318]))
    """

    coordinates: tuple[str, ...]
    certified: bool
    searched: float
    x: Lazy[Real] = lazy(np.ndarray, axes("node", unit="m"))
    eigenvalue: Complex = field(metadata=axes("mode", unit="rad/s"))
    rounding_error: Lazy[Real] = lazy(np.ndarray, axes("mode", unit="Hz"))
    rounding_bound: Real = field(metadata=axes("mode", unit="Hz"))
    plane: Lazy[NDArray[np.str_]] = lazy(np.ndarray, axes("mode"))
    cost: Cost
    vectors: Lazy[Vectors[np.complex128]] = lazy(Vectors)
    mesh: Lazy[MeshOfModes] = lazy(MeshOfModes)
    line: Callable[[], Axis] | None = field(default=None, repr=False, metadata=TRANSIENT)

    @property
    def frequency(self) -> Real:
        """Frequency of the damped oscillation [Hz], shape (k,)."""
        return self.eigenvalue.imag / (2 * np.pi)

    @property
    def natural_frequency(self) -> Real:
        """Modulus of s/2 pi [Hz], shape (k,)."""
        return np.abs(self.eigenvalue) / (2 * np.pi)

    @property
    def damping_ratio(self) -> Real:
        """Damping ratio of each mode, shape (k,)."""
        size = np.abs(self.eigenvalue)
        return np.divide(self.decay_rate, size, out=np.zeros_like(size), where=size > 0)

    @property
    def decay_rate(self) -> Real:
        """Decay rate of each mode [1/s], shape (k,)."""
        return 0.0 - self.eigenvalue.real

    def table(self) -> Table:
        """Return one row for each mode."""
        columns: dict[str, Any] = {
            "mode": np.arange(1, len(self.eigenvalue) + 1),
            "frequency [Hz]": self.frequency,
            "natural frequency [Hz]": self.natural_frequency,
            "damping ratio": self.damping_ratio,
            "decay rate [1/s]": self.decay_rate,
            "mesh error [Hz]": self.mesh_error,
            "rounding error [Hz]": self.rounding_error,
            "family": self.family,
        }
        if (self.plane == "y").any():
            columns["plane"] = self.plane
        title = "damped modes"
        if not self.certified:
            title += f"; beyond {self.searched:.6g} Hz such as decay within a period may be missing"
        return Table.of(title, columns | self._shares)

    def plot(self, ax: Axes | None = None, *, coordinate: str | None = None) -> Axes:
        """Plot the real parts of the shapes of one coordinate, the first one by default."""
        return draw(self, "plot", ax, coordinate=coordinate)
