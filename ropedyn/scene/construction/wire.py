"""Wires and fibre: what a construction is made of."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import KW_ONLY

from ...base.errors import SceneError
from ...base.parameter import Description, number
from .strand import Bar

LARGEST_RATIO = 0.5  # Of Poisson: no volume is lost.


class Wire(Description):
    """A wire of one material: round by its diameter, or shaped by area and stiffnesses.

    Parameters
    ----------
    diameter : float, optional
        Of a round wire, or how much of the radius a shaped one takes, twice from its centre
        outwards [m]; of a shaped wire, where left out, that of the circle of its area.
    youngs_modulus : float, optional
        E [N/m^2].
    poissons_ratio : float, optional
        Between -1 and 0.5.
    density : float, optional
        [kg/m^3].
    area, bending_stiffness, torsional_stiffness : float, optional
        Of a shaped wire, as those of locked coils, all three: A [m^2], E I about any diameter and
        G J [N m^2].

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite or not positive, if the ratio is not one of a solid, or if
        neither a diameter nor all numbers of a shape are given.

    Examples
    --------
    >>> import ropedyn as rd
    >>> wire = rd.Wire(2e-3)
    >>> section = rd.Construction(core=wire).section()
    >>> round(section.axial_stiffness), round(section.bending_slip, 6)
    (628319, 0.15708)
    """

    diameter: float | None = number("m", sign="positive", default=None)
    _: KW_ONLY
    youngs_modulus: float = number("N/m^2", sign="positive", default=200e9)
    poissons_ratio: float = number(default=0.3)
    density: float = number("kg/m^3", sign="positive", default=7850.0)
    area: float | None = number("m^2", sign="positive", default=None)
    bending_stiffness: float | None = number("N m^2", sign="positive", default=None)
    torsional_stiffness: float | None = number("N m^2", sign="positive", default=None)

    def _agree(self) -> None:
        if not -1 < self.poissons_ratio <= LARGEST_RATIO:
            raise SceneError(
                f"poissons_ratio must be above -1 and at most {LARGEST_RATIO}, "
                f"got {self.poissons_ratio!r}"
            )
        shape = self._shape
        missing = [name for name, value in shape.items() if value is None]
        if len(missing) == len(shape) and self.diameter is None:
            raise SceneError("diameter of a round wire must be a finite number > 0 [m], got None")
        if missing and len(missing) < len(shape):
            raise SceneError(f"a shaped wire needs {' and '.join(missing)}, got None")
        if not _are_numbers(self.bar):
            raise SceneError(
                f"diameter must leave mass and stiffnesses numbers > 0, got {self.diameter!r} m: "
                "check the units"
            )

    @property
    def _shape(self) -> dict[str, float | None]:
        names = ("area", "bending_stiffness", "torsional_stiffness")
        return {name: getattr(self, name) for name in names}

    @property
    def bar(self) -> Bar:
        """The wire as plain numbers.

        Examples
        --------
        >>> import ropedyn as rd
        >>> round(rd.Wire(2e-3).bar.mass, 6)
        0.024662
        """
        E, rho, d = self.youngs_modulus, self.density, self.diameter
        A, B, C = self._shape.values()
        if A is None or B is None or C is None:
            assert d is not None
            A, B = math.pi * d * d / 4, E * math.pi * d * d * d * d / 64
            C = B / (1 + self.poissons_ratio)
        d = math.sqrt(4 * A / math.pi) if d is None else d
        return Bar(E * A, C, B, rho * A, rho * 2 * B / E, A, d)


class Fibre(Description):
    """A core of fibre: it has mass and keeps the radii of strands, but no stiffness of its own.

    Parameters
    ----------
    diameter : float
        [m].
    density : float, optional
        [kg/m^3].

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite or not positive.

    Examples
    --------
    >>> import ropedyn as rd
    >>> strand = rd.Construction.standard("1x7", diameter=5e-3, lay="S")
    >>> rope = rd.Construction(core=rd.Fibre(6e-3), layers=[rd.Layer(6, strand, lay=0.1)])
    >>> round(1e3 * rope.diameter, 6)
    16.0
    """

    diameter: float = number("m", sign="positive")
    _: KW_ONLY
    density: float = number("kg/m^3", sign="positive", default=900.0)

    def _agree(self) -> None:
        if not _are_numbers((self.bar.mass, self.bar.polar)):
            raise SceneError(
                f"diameter must leave its mass a number > 0, got {self.diameter!r} m: check the "
                "units"
            )

    @property
    def bar(self) -> Bar:
        """The core as plain numbers.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Fibre(6e-3).bar.EA
        0.0
        """
        mass = self.density * math.pi * self.diameter * self.diameter / 4
        return mere_mass(mass, self.diameter)


def _are_numbers(found: Sequence[float]) -> bool:
    return all(0 < number < math.inf for number in found)


def mere_mass(mass: float, diameter: float) -> Bar:
    """Return a round bar that has mass alone."""
    return Bar(0.0, 0.0, 0.0, mass, mass * diameter * diameter / 8, 0.0, diameter)
