"""Parts that stand on the rope: what each adds to the node it stands at."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import KW_ONLY
from typing import Any, ClassVar

from ...base import check
from ...base.parameter import depending, number, one_of, positions
from ...base.unit import UNIT
from . import stretch as _stretch
from .broken_wire import BrokenWire
from .law import NodeForce, Stop
from .node import PLANES, Law, NodeRate, NodeTerm, Part
from .resonator import Resonator
from .stretch import Stretch


class PointMass(Part):
    """A rigid body clamped to the rope at one point.

    Parameters
    ----------
    x : float
        Where it stands [m].
    mass : float
        [kg]; 0 is allowed, for a disc that only turns.
    rotary_inertia, polar_inertia : float
        About any transverse axis and about the rope's own [kg m^2].

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite or is negative.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.PointMass(0.5, 0.1, polar_inertia=1e-5).mass
    0.1
    """

    kind: ClassVar[str] = "point mass"

    mass: float = number("kg", sign="nonnegative")
    _: KW_ONLY
    rotary_inertia: float = number("kg m^2", sign="nonnegative", default=0.0)
    polar_inertia: float = number("kg m^2", sign="nonnegative", default=0.0)

    def term(self) -> NodeTerm:
        """Inertia on the diagonal."""
        mass, turning = self.mass, self.rotary_inertia
        along = {"x": mass, "y": mass, "z": mass}
        return NodeTerm(along | {"alpha": self.polar_inertia, "beta": turning, "gamma": turning})

    def rates(self) -> dict[str, NodeRate]:
        """Each of its numbers is an inertia."""
        return {
            "mass": NodeRate(mass={"x": 1.0, "y": 1.0, "z": 1.0}),
            "rotary_inertia": NodeRate(mass={"beta": 1.0, "gamma": 1.0}),
            "polar_inertia": NodeRate(mass={"alpha": 1.0}),
        }


class Spring(Part):
    """A spring from the rope to the ground.

    Parameters
    ----------
    x : float
        Where it stands [m].
    stiffness : float
        [N/m for x, y and z, N m for alpha, beta and gamma]; may be negative.
    coordinate : {"z", "x", "y", "alpha", "beta", "gamma"}
        What it acts on.

    Raises
    ------
    TypeError
        If something is not a number or the coordinate not a string.
    SceneError
        If something is not finite, the stiffness is 0 or the coordinate is unknown.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.Spring(0.5, 1e4).coordinate
    'z'
    """

    kind: ClassVar[str] = "spring"

    stiffness: float = number("N/m", turning="N m", sign="nonzero")
    _: KW_ONLY
    coordinate: str = one_of(check.COORDINATES, default="z")

    def term(self) -> NodeTerm:
        """Stiffness on the diagonal."""
        return NodeTerm(stiffness={self.coordinate: self.stiffness})

    def rates(self) -> dict[str, NodeRate]:
        """Return that of its stiffness."""
        return {"stiffness": NodeRate(stiffness={self.coordinate: 1.0})}


def _checked_damping(value: Any, name: str, dashpot: Dashpot) -> float:
    along, exponent = UNIT[dashpot.coordinate] == "m", dashpot.exponent
    unit = "N s/m" if along else "N m s"
    if exponent != 1:
        unit = f"{'N (s/m)^' if along else 'N m s^'}{exponent!r}"
    return check.number(value, name, unit, sign="positive")


class Dashpot(Part):
    """A dashpot from the rope to the ground, of force c |v|^exponent sign(v).

    Parameters
    ----------
    x : float
        Where it stands [m].
    damping : float
        c [N s/m for x, y and z, N m s for alpha, beta and gamma, of exponent 1].
    coordinate : {"z", "x", "y", "alpha", "beta", "gamma"}
        What it acts on.
    exponent : float
        1: in proportion to velocity; 2: a quadratic damper; 0: Coulomb friction, which holds the
        rope while less than `damping` is needed for that. Others than 1 have a meaning in the time
        domain alone: frequencies, frequency response, static deflection and matrices are refused.

    Raises
    ------
    TypeError
        If something is not a number or the coordinate not a string.
    SceneError
        If something is not finite, the damping is not positive, the exponent is negative or the
        coordinate is unknown.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.Dashpot(0.5, 3.0).coordinate
    'z'
    """

    kind: ClassVar[str] = "dashpot"

    damping: float = depending(_checked_damping, "N s/m", turning="N m s")
    _: KW_ONLY
    coordinate: str = one_of(check.COORDINATES, default="z")
    exponent: float = number(sign="nonnegative", default=1.0)

    def term(self) -> NodeTerm:
        """Damping on the diagonal, if it is linear."""
        if self.exponent != 1.0:
            law = Law(self.coordinate, "power", (self.damping, self.exponent))
            return NodeTerm(nonlinear=f"exponent must be 1, got {self.exponent!r}", laws=(law,))
        return NodeTerm(damping={self.coordinate: self.damping})

    def rates(self) -> dict[str, NodeRate]:
        """Return that of its damping, which undamped modes do not feel."""
        return {"damping": NodeRate(damping={self.coordinate: 1.0})}


class Support(Part):
    """A rigid support of one coordinate.

    Parameters
    ----------
    x : float
        Where it stands [m].
    coordinate : {"z", "x", "y", "alpha", "beta", "gamma"}
        What it holds.

    Raises
    ------
    TypeError
        If the position is not a number or the coordinate not a string.
    SceneError
        If the position is not finite or the coordinate is unknown.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.Support(0.5).coordinate
    'z'
    """

    kind: ClassVar[str] = "support"

    _: KW_ONLY
    coordinate: str = one_of(check.COORDINATES, default="z")

    def term(self) -> NodeTerm:
        """Return the held coordinate."""
        return NodeTerm(held=(self.coordinate,))


class Hinge(Part):
    """A place where the bending rotation may jump.

    The node and whatever else stands at the same place (inertia, springs and supports of the
    rotation) are on the left of the hinge; deflection and force pass through. Hinges at one place
    are springs in series. The rope's damping of springs damps this one too. Where a hinge moves,
    the inertia of tensed elements is lumped to second order, to first where the rope has rotary
    inertia; held by a `Support`, to fourth. Continuous spans lump nothing.

    Parameters
    ----------
    x : float
        Where it is [m], between the ends: at an end ``End(beta="free", spring={"beta": ...})`` is
        the same thing.
    stiffness : float
        Of the rotation spring across it [N m]; 0 is a free hinge, which carries no moment.
    plane : {"z", "y"}
        In which it turns; a hinge in both planes is two.

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite or the stiffness is negative; in a scene, if it stands at an end
        of the rope.

    Examples
    --------
    Two cantilevers that meet tip to tip:

    >>> import ropedyn as rd
    >>> rope = rd.Rope(2.0, 0.1, bending_stiffness=4.0)
    >>> model = rd.Scene(rope, parts=[rd.Hinge(1.0)]).compile(elements=2)
    >>> print(model.static({("z", 1.0): 24.0}).displacement[1, 0].round(12))
    1.0
    """

    kind: ClassVar[str] = "hinge"

    _: KW_ONLY
    stiffness: float = number("N m", sign="nonnegative", default=0.0)
    plane: str = one_of(PLANES, default="z")

    @property
    def stands_on(self) -> tuple[str, ...]:
        """Bending rotation."""
        return ("beta" if self.plane == "z" else "gamma",)

    def term(self) -> NodeTerm:
        """Return the compliance of its spring."""
        compliance = 1.0 / self.stiffness if self.stiffness > 0.0 else math.inf
        return NodeTerm(hinge=dict.fromkeys(self.stands_on, compliance))

    def rates(self) -> dict[str, NodeRate]:
        """Return that of its stiffness."""
        return {"stiffness": NodeRate(hinge=dict.fromkeys(self.stands_on, 1.0))}


KINDS = (
    PointMass,
    Spring,
    Dashpot,
    Support,
    Hinge,
    Resonator,
    BrokenWire,
    NodeForce,
    Stop,
    *_stretch.KINDS,
)
"""Every kind of part."""


def standing(parts: Iterable[Part | Stretch]) -> list[Part]:
    """Return the parts that stand at one place."""
    return [part for part in parts if not isinstance(part, Stretch)]


def stretches(parts: Iterable[Part | Stretch]) -> list[Stretch]:
    """Return the parts that change the rope over a stretch."""
    return [part for part in parts if isinstance(part, Stretch)]


def places(parts: Iterable[Part | Stretch]) -> list[float]:
    """Return where parts stand, begin and end [m]."""
    return [getattr(part, name) for part in parts for name in positions(part)]
