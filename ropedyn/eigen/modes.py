"""Natural frequencies and shapes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..axis.axis import Axis
from ..base import check
from ..base.answer import TRANSIENT, Cost, Frozen, axes
from ..base.array import Real
from ..base.computed import Lazy, Read, computed, lazy
from ..base.drawing import draw
from ..base.errors import SceneError
from ..base.table import Table
from .damage import Damage, damage_of
from .free_motion import FreeMotion, MeshOfModes, Vectors
from .sensitivity import Shapes

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False)
class UndampedVectors(Vectors[np.float64]):
    """What follows from the shapes of undamped modes; see `Modes`."""

    damping_ratio: Real = field(metadata=axes("mode"))


@dataclass(frozen=True, eq=False)
class UndampedMesh(MeshOfModes):
    """What continuous spans say about the undamped modes of a chain; see `Modes`."""

    limit: Real = field(metadata=axes("mode", unit="Hz"))


@dataclass(frozen=True, eq=False)
class OnCatenary(Frozen):
    """What the true curve of a hanging rope says about its modes; see `Modes`."""

    model_error: Real = field(metadata=axes("mode", unit="Hz"))
    catenary: Real = field(metadata=axes("mode", unit="Hz"))


@dataclass(frozen=True, eq=False, kw_only=True)
class Modes(FreeMotion[np.float64, UndampedVectors, UndampedMesh]):
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
        Absolute error of the frequency that rounding causes [Hz]; of growth/2 pi where motion
        grows. Measured when it is read, as the distance to the same mode in wider numbers with
        their own error, which takes some milliseconds a mode; where these do not tell, as of
        rigid-body motion or where a string has no tension at an end, `rounding_bound`. On an axis
        told by 16 answers for numbers that are a little off.
    rounding_bound : ndarray, shape (k,)
        A bound of that to first order, known at once and some 80 times as large [Hz].
    mesh_error : ndarray, shape (k,)
        Absolute error of the frequency that the elements cause [Hz]; of growth/2 pi where motion
        grows. Not an estimate: the distance to the mode of the same number, among those of the
        same component, of the continuous spans, and the rounding error of that. 0 for continuous
        spans, because they have none; infinite where they have no answer.
    limit : ndarray, shape (k,)
        The frequency without mesh error [Hz]: that of the continuous spans, which the frequencies
        of ever finer chains of tensed or rigid elements approach. Exact, where extrapolation from
        two chains would be an estimate. 0 where motion grows, NaN where there is no answer.
    model_error : ndarray, shape (k,)
        Absolute error of the frequency that the parabola of a rope that sags causes [Hz]: the
        distance to the mode of the same number on the curve that the rope, and the masses on it,
        really rest on, by Ritz's method with the shapes of the straight rope; of twist the square
        of the largest slope. 0 without sag and of modes that are of that curve themselves, as
        `cost.method` says ("sweep on the catenary"), infinite where it is not known: in the plane
        of a laid rope, and where ends do not hold x or something between them does.
    catenary : ndarray, shape (k,)
        The frequency on that curve [Hz]; NaN where it is not known.
    certified : bool
        True: no mode is missed below the last, shown by count. The assembled solver does not count.
    damping_ratio : ndarray, shape (k,)
        Of each mode by its share of every damped part; exact where damping is proportional, the
        first-order value otherwise, 0 where the frequency is 0.
    family : ndarray of str, shape (k,)
        "transverse", "bending rotation", "torsional" or "axial": the coordinate with the most
        kinetic energy.
    plane : ndarray of str, shape (k,)
        In which it moves across, with what its coordinates are tied to: "z", "y", "space" for both
        at once, "" where in none.
    modal_mass : ndarray, shape (k,)
        shape^T M shape, of continuous spans its integral [kg, kg m^2]: of the shape as it is given,
        so that shape^2/modal_mass at a place does not depend on the other points.
    shape : ndarray, shape (k, nodes, coordinates)
        The largest component of the family's own coordinate at `x` is 1 [m, rad]; where a mode has
        its nodes at all of them, that elsewhere.
    energy : dict of ndarray, shape (k,)
        Fractions: strain "bending", "twist", "stretch", "lay", "tension", "spring" as far as the
        scene has them, sum 1 (all 0 for rigid-body motion); kinetic "x", "y", "z", "alpha", "beta",
        "gamma" of the coordinates there are, sum 1. What the rope carries is, where the scene has
        any, "resonator" and "broken wire" in the first, "resonator mass" and "broken wire mass" in
        the second.
    cost : Cost
        What the frequencies cost, and what of the rest has been read.

    Examples
    --------
    A string of 64 elements, and what it would be without them:

    >>> import ropedyn as rd
    >>> modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile(elements=64).modes(2)
    >>> modes.frequency.round(3), modes.limit.round(3), modes.mesh_error.round(3)
    (array([24.997, 49.98 ]), array([25., 50.]), array([0.003, 0.02 ]))
    >>> modes.family.tolist(), modes.certified, modes.energy["tension"].round(9)
    (['transverse', 'transverse'], True, array([1., 1.]))
    >>> modes.shape.shape, modes.modal_mass.round(3)
    ((2, 65, 1), array([0.1, 0.1]))
    """

    coordinates: tuple[str, ...]
    certified: bool
    x: Lazy[Real] = lazy(np.ndarray, axes("node", unit="m"))
    frequency: Real = field(metadata=axes("mode", unit="Hz"))
    eigenvalue: Real = field(metadata=axes("mode", unit="rad^2/s^2"))
    growth: Real = field(metadata=axes("mode", unit="1/s"))
    rounding_error: Lazy[Real] = lazy(np.ndarray, axes("mode", unit="Hz"))
    rounding_bound: Real = field(metadata=axes("mode", unit="Hz"))
    plane: Lazy[NDArray[np.str_]] = lazy(np.ndarray, axes("mode"))
    cost: Cost
    vectors: Lazy[UndampedVectors] = lazy(UndampedVectors)
    mesh: Lazy[UndampedMesh] = lazy(UndampedMesh)
    hanging: Lazy[OnCatenary] = lazy(OnCatenary)
    solve_shapes: Callable[..., Shapes] | None = field(default=None, repr=False, metadata=TRANSIENT)
    line: Callable[[], Axis] | None = field(default=None, repr=False, metadata=TRANSIENT)

    limit = Read[Real]("mesh", "Frequencies without mesh error [Hz], shape (k,).")
    model_error = Read[Real]("hanging", "Error that the parabola of sag causes [Hz], shape (k,).")
    catenary = Read[Real]("hanging", "Frequencies on the true curve [Hz], shape (k,).")
    damping_ratio = Read[Real]("vectors", "Damping ratio of each mode, shape (k,).")

    @computed
    def sensitivity(self) -> Any:
        """What derivatives are computed from.

        Examples
        --------
        >>> import ropedyn as rd
        >>> modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile().modes(1)
        >>> modes.sensitivity.frequency("tension")[:1].round(6)
        array([0.0125])
        """
        return self._solved_again().sensitivity

    def _solved_again(self, points: int | None = None) -> Shapes:
        if self.solve_shapes is None:
            raise SceneError(
                "modes from a file have no model to ask for derivatives: compile the scene again"
            )
        return self.solve_shapes(points)

    def derivative(self, path: str, *, of: str = "frequency") -> Real:
        """Find the exact derivative of each mode with respect to a number of the scene.

        By first-order perturbation theory, from the shapes: no difference of two frequencies. It is
        the derivative of the model that was asked, with the number of elements of each span fixed.

        Parameters
        ----------
        path : str
            ``"tension"``, a property of the rope as ``"bending_stiffness"`` or ``"length"``, of a
            part as ``"parts[0].mass"``, ``"parts[0].x"``, ``"parts[1].bending"``,
            ``"parts[1].start"`` or ``"parts[2].frequency"`` of a resonator, of an end as
            ``"ends[0].spring.beta"``, or ``"gravity.g"`` and ``"gravity.inclination"``. Under
            gravity tension, linear density and length change the sag too. When the length grows
            parts keep their places, except those at the right end, which stay there. Dashpots
            and damping ratios have derivatives of 0: frequencies are undamped ones.
        of : {"frequency", "eigenvalue", "growth"}
            `frequency` [Hz] has the derivative 0 where motion grows, `growth` [1/s] where it does
            not; `eigenvalue` [rad^2/s^2] has one everywhere.

        Returns
        -------
        ndarray, shape (k,)
            In units of the quantity per unit of the number. Modes whose eigenvalues rounding cannot
            tell apart have no shapes of their own: theirs are the derivatives, in increasing order,
            of the eigenvalues that part when the number grows. `derivative_error` says how many
            digits rounding leaves: fewer where modes are close to each other, and of lengths and
            places in chains of many elements, whose forces are differences of neighbours.

        Raises
        ------
        TypeError
            If an argument is not a string.
        SceneError
            If the path is not that of a number that acts in the scene, or that of a part which does
            not stand alone, or if the modes were read from a file.
        SolveError
            If an eigenvalue is 0 and the number changes it: its root has no derivative there.

        Examples
        --------
        A string has f = sqrt(T/mu)/2 L, so that df/dT = f/2 T:

        >>> import ropedyn as rd
        >>> modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile().modes(1)
        >>> modes.frequency, modes.derivative("tension")
        (array([25.]), array([0.0125]))
        >>> modes.derivative("length")
        array([-12.5])
        """
        check.one_of(of, "of", ("frequency", "eigenvalue", "growth"))
        return getattr(self.sensitivity, of)(path)[: len(self.frequency)]

    def derivative_error(self, path: str, *, of: str = "frequency") -> Real:
        """Bound the rounding error of a derivative.

        Parameters
        ----------
        path, of
            As in `derivative`.

        Returns
        -------
        ndarray, shape (k,)
            Absolute, in units of the derivative.

        Raises
        ------
        TypeError
            If an argument is not a string.
        SceneError
            As in `derivative`.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0, parts=[rd.PointMass(0.5, 1e-9)])
        >>> modes = scene.compile().modes(1)
        >>> error = modes.derivative_error("parts[0].x")
        >>> bool((error < 1e-10 * abs(modes.derivative("parts[0].x"))).all())
        True
        """
        check.one_of(of, "of", ("frequency", "eigenvalue", "growth"))
        return self.sensitivity.error(path, of)[: len(self.frequency)]

    def damage(self, *, points: int | None = None) -> Damage:
        """Find which mode feels a loss of stiffness or mass where.

        Parameters
        ----------
        points : int, optional
            Of continuous spans: equal parts of each span or element that the rope is looked at in,
            some for each half wave where left out. Of a chain the parts are its elements.

        Returns
        -------
        Damage

        Raises
        ------
        TypeError
            If the number is not a whole one.
        SceneError
            If it is given for a chain or out of range, or if the modes were read from a file.
        SolveError
            If modes that rounding cannot tell apart are coupled by damage: which of them feels it
            depends on the damage itself.

        Examples
        --------
        A pinned beam's curvature is largest where its deflection is, and zero at nodes:

        >>> import ropedyn as rd
        >>> rope = rd.Rope(1.0, 0.1, bending_stiffness=2.0)
        >>> modes = rd.Scene(rope, ends=("pinned", "pinned")).compile().modes(2)
        >>> damage = modes.damage(points=100)
        >>> damage.change["bending_stiffness"][:, 49].round(3)
        array([-1.   , -0.001])
        >>> damage.frequency_change(0.2, 0.3, bending_stiffness=0.1).round(4)
        array([-0.005 , -0.0097])
        """
        return damage_of(self.frequency, self._solved_again(points))

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
        if (self.model_error > 0).any():
            columns["model error [Hz]"] = self.model_error
            columns["on the catenary [Hz]"] = self.catenary
        if (self.plane == "y").any():
            columns["plane"] = self.plane
        if (self.growth > 0).any():
            columns["growth [1/s]"] = self.growth
        where = " on the catenary" if self.cost.method.endswith("catenary") else ""
        return Table.of(f"natural frequencies{where}", columns | self._shares)

    def plot(self, ax: Axes | None = None, *, coordinate: str | None = None) -> Axes:
        """Plot the shapes of one coordinate along the rope, the first one by default."""
        return draw(self, "plot", ax, coordinate=coordinate)
