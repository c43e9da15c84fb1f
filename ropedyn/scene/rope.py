"""The rope: length, density and the stiffnesses of its section."""

from __future__ import annotations

import dataclasses
from dataclasses import KW_ONLY
from typing import Any, ClassVar

import numpy as np

from ..axis.axis import Axis
from ..axis.piece import CatenaryPiece
from ..base import check
from ..base.errors import SceneError
from ..base.parameter import Description, Pair, given, instance, number, pair
from .bench.bending_test import BendingTest
from .bench.given import given_tests
from .bench.torsion_test import TorsionTest
from .construction.construction import Construction
from .construction.section import Section

ACROSS = {name: f"{name}[1]" for name in ("bending_stiffness", "rotary_inertia")}
"""Properties that the plane of y has of its own, and what they are called there."""

_ACROSS_OF = {across: name for name, across in ACROSS.items()}


def in_plane(value: Any, plane: int) -> Any:
    """Return what a number, or the one of a pair, is in the plane of z (0) or of y (1)."""
    return value[plane] if isinstance(value, tuple) else value


def own_number(rope: Rope, name: str) -> float | None:
    """Return a property of the plane of z, or of that of y by its name in `ACROSS`."""
    found: float | None = in_plane(getattr(rope, _ACROSS_OF.get(name, name)), name in _ACROSS_OF)
    return found


Angle = float | tuple[tuple[float, ...], tuple[float, ...]]  # A number, or places and angles there.


def _checked_angle(value: Any) -> Angle | None:
    """Return an angle, or places and angles there; None where it is 0 everywhere."""
    if value is None or isinstance(value, (int, float)):
        angle = check.optional(value, "principal_angle", "rad")
        return angle or None
    expected = "principal_angle must be a number, or places (s) [m] and angles there [rad]"
    try:
        places, angles = (check.numbers(one, "principal_angle", "m, rad") for one in value)
    except (TypeError, ValueError) as error:
        raise type(error)(f"{expected}, got {check.shown(value)}") from error
    if len(places) != len(angles) or len(places) < 2 or (np.diff(places) <= 0).any():
        raise SceneError(f"{expected}, two or more that increase, got {check.shown(value)}")
    return tuple(map(float, places)), tuple(map(float, angles))


def _checked_natural(value: Any) -> str | None:
    return None if value is None else check.one_of(value, "natural", ("axis", "straight"))


class Rope(Description):
    """A rope of uniform section. A property left out is an effect that does not exist.

    Parameters
    ----------
    length : float or Axis
        Between the two ends [m], or the line that the rope follows in space; a scene of such a rope
        has all six coordinates, and needs ``planes="both"``, bending and torsional stiffness, or
        under tension neither: a string, of x, y and z. On a straight axis it is a straight rope.
    linear_density : float
        Mass per length [kg/m].
    bending_stiffness : float or pair of float, optional
        B [N m^2]: gives bending and with it the coordinates z and beta. A pair is of the planes of
        z and of y, where the scene has both.
    torsional_stiffness : float, optional
        C [N m^2]: gives twist, the coordinate alpha.
    axial_stiffness : float, optional
        EA [N]: gives stretch, the coordinate x.
    lay_coupling : float, optional
        D [N m]: (axial force, torque) = [[EA, D], [D, C]] (axial strain, twist rate), the linear
        coupling of an axisymmetric laid rope. Needs axial and torsional stiffness. An end that is
        free to turn twists by -D F/(EA C - D^2) per length under an axial force F; one that is
        held takes the torque D F/EA.
    lay_slope : float, optional
        H [1]: the section axes of bending and twist are tilted by the slope H, which couples
        bending and twist as in the 2015 study. Needs bending and torsional stiffness. A force F
        across the tip of a cantilever of length l twists it by
        H/(1 + H^2) (1/C - 1/B) F l^2/2.
    rotary_inertia : float or pair of float, optional
        Inertia of bending rotation per length [kg m], a pair as above; 0 is none.
    polar_inertia : float, optional
        Inertia of twist per length [kg m]; 0 is none.
    shear_stiffness : float, optional
        k G A [N], of a rope on an axis.
    natural : {"axis", "straight"}, optional
        What a rope on an axis is when nothing loads it: as its axis, like a spring, or straight, so
        that it is bent by the moment B times the curvature, which counts across its plane. Left
        out: straight on a catenary without loads and of one bending stiffness, else as its axis.
        None of a straight rope.
    principal_angle : float or pair of sequences, optional
        By which the principal axes of a pair of `bending_stiffness` are turned about x from z
        towards -y [rad], everywhere, or at places s [m], linear between them: a twisted strip.
    axis : Axis, optional
        That was given as `length`.

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite, not positive where it must be, or if the section is not
        positive definite.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rope = rd.Rope(1.35, 0.1017, bending_stiffness=1.54)
    >>> rope.replace(length=2.0).length
    2.0

    What a force of 1 kN does to a laid rope of 10 m, whose end turns or is kept from it: stretch
    [m] and turn [rad].

    >>> laid = rd.Rope(
    ...     10.0, 0.5, axial_stiffness=1e6, torsional_stiffness=20.0, lay_coupling=2000.0
    ... )
    >>> for end in rd.End(x="free", alpha="free"), rd.End(x="free"):
    ...     static = rd.Scene(laid, ends=("clamped", end)).compile().static({("x", 10.0): 1000.0})
    ...     print(static.displacement[-1].round(6), static.force[-1].round(6))
    [ 0.0125 -1.25  ] [1000.    0.]
    [0.01 0.  ] [1000.    2.]
    """

    section: ClassVar[Section | None] = None
    """What a rope from a construction was taken from; one with changed properties has none."""

    length: float = number("m", sign="positive")
    linear_density: float = number("kg/m", sign="positive")
    _: KW_ONLY
    bending_stiffness: Pair | None = pair("N m^2", sign="positive", default=None)
    torsional_stiffness: float | None = number("N m^2", sign="positive", default=None)
    axial_stiffness: float | None = number("N", sign="positive", default=None)
    lay_coupling: float | None = number("N m", default=None)
    lay_slope: float | None = number(default=None)
    rotary_inertia: Pair | None = pair("kg m", sign="nonnegative", default=None)
    polar_inertia: float | None = number("kg m", sign="nonnegative", default=None)
    shear_stiffness: float | None = number("N", sign="positive", default=None)
    natural: str | None = given(_checked_natural, default=None)
    principal_angle: Angle | None = given(_checked_angle, default=None)
    axis: Axis | None = instance(Axis, "an Axis", default=None)

    def __post_init__(self) -> None:
        own = vars(self)
        if isinstance(self.length, Axis):
            own["axis"], own["length"] = self.length, self.length.length
        if isinstance(self.axis, Axis) and self.axis.is_straight:
            own["axis"] = None
        super().__post_init__()
        own["natural"] = None if self.axis is None else self.natural or _natural(self, self.axis)

    @property
    def is_turned(self) -> bool:
        """Whether the principal axes of its section are turned.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Rope(1.0, 0.4, bending_stiffness=(2.0, 1.0), principal_angle=0.3).is_turned
        True
        """
        return self.principal_angle is not None

    def _agree(self) -> None:
        if self.axis is not None:
            _agree_on(self, self.axis)
        elif self.shear_stiffness is not None:
            got = check.shown(self.shear_stiffness)
            raise SceneError(f"shear_stiffness must be None of a straight rope, got {got}")
        if self.is_turned and not isinstance(self.bending_stiffness, tuple):
            got = check.shown(self.bending_stiffness)
            raise SceneError(f"bending_stiffness must be a pair with a principal_angle, got {got}")
        if isinstance(self.principal_angle, tuple):
            for place in self.principal_angle[0]:
                check.position(place, "principal_angle", self.length)
        needs = {
            "lay_coupling": ("axial_stiffness", "torsional_stiffness"),
            "lay_slope": ("bending_stiffness", "torsional_stiffness"),
        }
        for name, others in needs.items():
            missing = [other for other in others if getattr(self, other) is None]
            if getattr(self, name) is not None and missing:
                raise SceneError(f"{name} needs {' and '.join(missing)}, got None")
        EA, C, D = self.axial_stiffness, self.torsional_stiffness, self.lay_coupling
        if D is None or EA is None or C is None or EA * C > D * D:
            return
        lowest = np.linalg.eigvalsh([[EA, D], [D, C]])[0]
        raise SceneError(
            "the section stiffness [[axial_stiffness, lay_coupling], [lay_coupling, "
            f"torsional_stiffness]] must be positive definite, got {[[EA, D], [D, C]]} with the "
            f"eigenvalue {lowest:.6g}"
        )

    @staticmethod
    def from_tests(
        length: float,
        linear_density: float,
        *,
        bending: BendingTest | None = None,
        torsion: TorsionTest | None = None,
        **others: Any,
    ) -> Rope:
        """Return a rope with the stiffnesses that static tests of pieces of it imply.

        A rope keeps no errors: ``Prior.of(bending=..., torsion=...)`` does.

        Parameters
        ----------
        length, linear_density : float
            Of the rope [m, kg/m].
        bending : BendingTest, optional
            Of `bending_stiffness`.
        torsion : TorsionTest, optional
            Of `torsional_stiffness`.
        **others
            Any further argument of `Rope`.

        Returns
        -------
        Rope

        Raises
        ------
        TypeError
            If something is of the wrong type, or there is no such argument.
        SceneError
            If there is no test, a stiffness is given that a test tells, or as `Rope` does.

        Examples
        --------
        >>> import ropedyn as rd
        >>> bent = rd.BendingTest(0.5, [0.0, 2.0, 4.0], [1.0e-3, 2.5e-3, 4.1e-3])
        >>> twisted = rd.TorsionTest(0.5, [0.0, 0.05, 0.1], [0.0, 0.17, 0.336])
        >>> rope = rd.Rope.from_tests(1.35, 0.1017, bending=bent, torsion=twisted)
        >>> round(rope.bending_stiffness, 2), round(rope.torsional_stiffness, 4)
        (53.76, 0.1488)
        """
        for test in given_tests(bending, torsion):
            name = test.stiffness_name
            if name in others:
                raise SceneError(
                    f"{name} must not be given where a {type(test).__name__} tells it, "
                    f"got {check.shown(others[name])}"
                )
            others[name] = test.stiffness
        return Rope(length, linear_density, **others)

    @staticmethod
    def from_construction(
        length: float,
        construction: Construction | Section,
        *,
        bending: str = "stick",
        torsion: str | None = None,
        **others: Any,
    ) -> Rope:
        """Return a rope with the properties that its construction implies.

        Its `section` is kept for reading; a rope that is changed has none.

        Parameters
        ----------
        length : float
            Of the rope [m].
        construction : Construction or Section
            Whose stiffnesses, mass and inertias it has.
        bending : {"stick", "slip"}, optional
            Whether wires stick when it bends, as they do where motion is small, or slide freely.
        torsion : {"slip", "stick", "straight"}, optional
            Of a construction, as `Construction.section` takes it; "slip" where left out.
        **others
            Any further argument of `Rope`, in the place of what the construction implies; None
            drops an effect.

        Returns
        -------
        Rope

        Raises
        ------
        TypeError
            If something is of the wrong type, or there is no such argument.
        SceneError
            If there is no such state, or as `Rope` does.

        Examples
        --------
        >>> import ropedyn as rd
        >>> strand = rd.Construction.standard("1x19", diameter=4e-3, lay="Z")
        >>> rope = rd.Rope.from_construction(1.35, strand)
        >>> round(rope.bending_stiffness, 4), round(rope.section.bending_slip, 4)
        (1.6313, 0.0733)
        """
        what = "a Construction or a Section"
        check.instance(construction, "construction", (Construction, Section), what)
        check.one_of(bending, "bending", ("stick", "slip"))
        if isinstance(construction, Construction):
            section = construction.section("slip" if torsion is None else torsion)
        elif torsion is None:
            section = construction
        else:
            raise SceneError(f"torsion must not be given of a Section, got {check.shown(torsion)}")
        rope = Rope(length, **{**section.properties(bending), **others})
        vars(rope)["section"] = section
        return rope

    def replace(self, **changes: Any) -> Rope:
        """Return a rope with these properties changed.

        Parameters
        ----------
        **changes
            Any argument of `Rope`.

        Raises
        ------
        TypeError
            If there is no such property.
        SceneError
            As `Rope` does.
        """
        return dataclasses.replace(self, **changes)


def _natural(rope: Rope, axis: Axis) -> str:
    """Return what a rope on an axis is if nothing is said."""
    alike = len({piece[1:] for piece in axis.pieces}) == 1
    hangs = alike and isinstance(axis.pieces[0], CatenaryPiece)
    return "straight" if hangs and isinstance(rope.bending_stiffness, float) else "axis"


def _agree_on(rope: Rope, axis: Axis) -> None:
    """Refuse what a rope on an axis cannot be."""
    if abs(rope.length - axis.length) > check.NEAR * axis.length:
        raise SceneError(f"length must be that of the axis, {axis.length!r} m, got {rope.length!r}")
    if rope.bending_stiffness is None:
        for name in ("torsional_stiffness", "shear_stiffness", "rotary_inertia", "polar_inertia"):
            if (value := getattr(rope, name)) is not None:
                raise SceneError(
                    f"bending_stiffness must be given of a rope on an axis with {name}, got None "
                    f"and {check.shown(value)}"
                )
    elif rope.torsional_stiffness is None:
        raise SceneError("torsional_stiffness must be given of a rope on an axis, got None")
    if rope.natural == "straight" and len({piece[1:] for piece in axis.pieces}) > 1:
        raise SceneError(
            'natural must be "axis" where curvature or torsion jump, at which a rope that is bent '
            'from a straight one would not rest without moments, got "straight"'
        )
    if rope.natural == "straight" and isinstance(rope.bending_stiffness, tuple):
        raise SceneError('natural must be "axis" where bending_stiffness is a pair, got "straight"')
