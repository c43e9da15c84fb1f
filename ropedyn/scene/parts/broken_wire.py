"""A broken wire that stands off the rope."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY
from typing import ClassVar

import numpy as np

from ...base.errors import SceneError
from ...base.parameter import number, one_of
from .node import Attached, AttachedRate, NodeRate, NodeTerm, Part

FIRST_ROOT = 1.8751040687119611  # The first root of 1 + cos x cosh x = 0: of a cantilever.


class BrokenWire(Part):
    """The free end of a broken wire: a small cantilever that the rope carries.

    A solid round Euler-Bernoulli beam parallel to the axis, towards larger x. Its root stands at y
    = radius cos(angle), z = radius sin(angle) of the section, moves by z + radius cos(angle) alpha
    and turns by beta, where the scene has these; in both planes it moves by y - radius sin(angle)
    alpha and turns by gamma as well. In undamped modes it is free of damping, as the rope is;
    dampings of the rope do not act on it, but Rayleigh damping on its mass. The motion of its tip
    along z is the response ("wire", 0) of `Model.frf` for the first one among the parts, and so on.

    With `lay_length` it is still wound: a helix about the axis of the rope, on the cylinder of its
    radius, with bending, twist, stretch and rotary inertia of its own and its root clamped to the
    section. It moves with all coordinates of the rope at once, which a `SpaceModel` solves.

    Parameters
    ----------
    x : float
        Where its root is [m].
    length, diameter : float
        Of the wire [m].
    radius : float
        Of its root from the axis [m]: how far it moves with twist; may be negative.
    angle : float, optional
        Round the rope, from the direction of y to that of z [rad]. In both planes of a rope that
        twists it must be 0 if the wire is straight: elsewhere twist would tie the planes.
    youngs_modulus : float, optional
        [N/m^2].
    density : float, optional
        [kg/m^3].
    damping_ratio : float, optional
        The modulus is E (1 + 2 i damping_ratio) in the frequency response and in damped modes:
        every mode of the wire has this damping ratio at its resonance.
    lay_length : float, optional
        Along the rope in one turn of a wire that is still wound [m]; straight where left out.
    sense : {"Z", "S"}
        Of the lay: "Z" is a right-handed helix.
    poissons_ratio : float
        From -1 to 1/2, of the torsional stiffness E I/(1 + nu) of a wound one.

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite or out of range, or a wound wire has no radius; in a model, if
        its root cannot move where it stands.

    Examples
    --------
    >>> import ropedyn as rd
    >>> wire = rd.BrokenWire(0.5, 0.05, 3e-4, radius=2e-3)
    >>> print(round(wire.frequency, 2))
    86.0
    """

    kind: ClassVar[str] = "broken wire"

    length: float = number("m", sign="positive")
    diameter: float = number("m", sign="positive")
    _: KW_ONLY
    radius: float = number("m")
    angle: float = number("rad", default=0.0)
    youngs_modulus: float = number("N/m^2", sign="positive", default=2.06e11)
    density: float = number("kg/m^3", sign="positive", default=7850.0)
    damping_ratio: float = number(sign="nonnegative", default=0.0)
    lay_length: float | None = number("m", sign="positive", default=None)
    sense: str = one_of(("Z", "S"), default="Z")
    poissons_ratio: float = number(default=0.3)

    def _agree(self) -> None:
        with np.errstate(all="ignore"):
            numbers = np.array([*self._values[:3], self._straight])
        if not np.isfinite(numbers).all() or (numbers == 0.0).any():
            raise SceneError(
                "length and diameter must leave mass and stiffness of the wire numbers, got "
                f"{self.length!r} m and {self.diameter!r} m"
            )
        if not -1 < self.poissons_ratio <= 0.5:
            raise SceneError(f"poissons_ratio must be from -1 to 1/2, got {self.poissons_ratio!r}")
        if self.lay_length is not None and self.lay_length < self.diameter:
            raise SceneError(
                f"lay_length must be at least the diameter, {self.diameter!r} m, of a wire that "
                f"has room in a turn, got {self.lay_length!r}"
            )
        if self.is_wound and self.radius == 0:
            raise SceneError("radius must not be 0 [m] of a wire that is wound, got 0.0")

    @property
    def is_wound(self) -> bool:
        """Whether it is a helix.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.BrokenWire(0.5, 0.05, 3e-4, radius=2e-3, lay_length=0.03).is_wound
        True
        """
        return self.lay_length is not None

    @property
    def _values(self) -> tuple[float, float, float, float]:
        """Mass, E I/length^3, length and damping as the core takes them."""
        length, d = np.float64(self.length), np.float64(self.diameter)
        mass = self.density * (math.pi * d * d / 4) * length
        stiffness = self.youngs_modulus * (math.pi * d**4 / 64) / length**3
        return float(mass), float(stiffness), self.length, self.damping_ratio

    @property
    def frequency(self) -> float:
        """The first natural frequency of a straight one with the root held [Hz].

        That of a wound one is the first of `wound_wire`.
        """
        if self.is_wound:
            raise SceneError("frequency is that of a straight wire: see wound_wire")
        return self._straight

    @property
    def _straight(self) -> float:
        mass, stiffness = (np.float64(v) for v in self._values[:2])
        return float(FIRST_ROOT**2 * np.sqrt(stiffness / mass) / (2 * math.pi))

    @property
    def stands_on(self) -> tuple[str, ...]:
        """The displacement of its root; twist and bending where the scene has them."""
        return ("z",)

    def term(self) -> NodeTerm:
        """Return the structure in each plane, which moves with it and alpha and turns with it."""
        assert not self.is_wound, "a wound wire moves with all coordinates at once"
        along, across = self._lever
        up = Attached(self.kind, {"z": 1.0, "alpha": along}, {"beta": 1.0}, self._values)
        side = Attached(self.kind, {"y": 1.0, "alpha": across}, {"gamma": 1.0}, self._values)
        return NodeTerm(attached=[up, side])

    @property
    def _lever(self) -> tuple[float, float]:
        """How far twist moves the root along z and along y [m]."""
        return self.radius * math.cos(self.angle), -self.radius * math.sin(self.angle)

    def rates(self) -> dict[str, NodeRate]:
        """Return those of a mass as density d^2 l and a stiffness as E d^4/l^3."""
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        up = self._rates("beta", cos, -self.radius * sin)
        side = self._rates("gamma", -sin, -self.radius * cos)
        return {name: NodeRate(attached=[up[name], side[name]]) for name in up}

    def _rates(self, turns: str, lever: float, turned: float) -> dict[str, AttachedRate]:
        """Return those of one plane, with those of its lever by the radius and by the angle."""
        length, d = self.length, self.diameter
        longer = {turns: 1 / length}
        return {
            "length": AttachedRate(size=1 / length, stiffness=-4 / length, rotation=longer),
            "diameter": AttachedRate(size=2 / d, stiffness=2 / d),
            "radius": AttachedRate(displacement={"alpha": lever}),
            "angle": AttachedRate(displacement={"alpha": turned}),
            "youngs_modulus": AttachedRate(stiffness=1 / self.youngs_modulus),
            "density": AttachedRate(mass=1 / self.density),
            "damping_ratio": AttachedRate(damping=1.0),
        }
