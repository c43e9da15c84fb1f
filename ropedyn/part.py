"""Parts that stand on the rope: what each adds to the node it stands at."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass
from types import MappingProxyType
from typing import ClassVar, NamedTuple, Protocol

import numpy as np

from . import check
from . import stretch as _stretch
from .errors import SceneError
from .stretch import Stretch

FIRST_ROOT = 1.8751040687119611
"""Of 1 + cos x cosh x."""


class Attached(NamedTuple):
    """A structure condensed to its foot at a node; see csrc/attached.h."""

    kind: str
    """In `chain.ATTACHED`."""
    displacement: Mapping[str, float]
    """Of the foot per motion of the node."""
    rotation: Mapping[str, float]
    value: tuple[float, float, float, float]
    """Its numbers."""


class Law(NamedTuple):
    """A force on one coordinate that is not in proportion to its motion."""

    coordinate: str
    kind: str
    """"power": value[0] |v|^value[1] sign(v); "stop": value[0] times how far u is beyond value[1]
    in the direction value[2], +1 or -1; "call": what `call` returns."""
    value: tuple[float, ...] = ()
    call: Callable[[float, float, float], float] | None = None
    """Of time, displacement and velocity, the force on the rope."""


class NodeTerm(NamedTuple):
    """What stands at one node, per coordinate."""

    mass: Mapping[str, float] = MappingProxyType({})
    """[kg, kg m^2]; inertia on an absent coordinate is ignored."""
    stiffness: Mapping[str, float] = MappingProxyType({})
    """To the ground [N/m, N m]."""
    held: Sequence[str] = ()
    """Coordinates that cannot move."""
    hinge: Mapping[str, float] = MappingProxyType({})
    """Compliance between the node and the rope on its right [rad/(N m)], infinite where free."""
    damping: Mapping[str, float] = MappingProxyType({})
    """To the ground, in proportion to velocity [N s/m, N m s]."""
    nonlinear: str = ""
    """What must be otherwise where time is not integrated, empty where nothing must."""
    attached: Sequence[Attached] = ()
    """Structures that it carries."""
    laws: Sequence[Law] = ()
    """Forces that only integration over time takes."""


class AttachedRate(NamedTuple):
    """How fast a structure changes with one number of it."""

    size: float = 0.0
    """Relative, of mass and stiffness together."""
    mass: float = 0.0
    """Relative, at the same stiffness."""
    stiffness: float = 0.0
    """Relative, at the same mass."""
    damping: float = 0.0
    """Of its damping ratio."""
    displacement: Mapping[str, float] = MappingProxyType({})
    """Of the foot per motion of the node."""
    rotation: Mapping[str, float] = MappingProxyType({})
    """Times the length of the structure, over that length: it feels no other rotation."""


class NodeRate(NamedTuple):
    """How fast what stands at a node changes with one number of it, per coordinate."""

    mass: Mapping[str, float] = MappingProxyType({})
    stiffness: Mapping[str, float] = MappingProxyType({})
    hinge: Mapping[str, float] = MappingProxyType({})
    """Of the stiffness across a hinge."""
    damping: Mapping[str, float] = MappingProxyType({})
    attached: AttachedRate | None = None
    """Of the structure that it carries."""

    def acts(self, coordinates: Collection[str]) -> bool:
        """Whether it changes anything where there are only some coordinates."""
        moved = [self.mass, self.stiffness, self.hinge, self.damping]
        if self.attached is not None:
            if self.attached._replace(displacement={}, rotation={}) != AttachedRate():
                return True
            moved += [self.attached.displacement, self.attached.rotation]
        return any(c in coordinates for values in moved for c in values)


class Part(Protocol):
    """What the compiler asks of a part that stands at one place."""

    kind: ClassVar[str]
    """Name of the effect."""

    @property
    def x(self) -> float:
        """Where it stands [m]."""

    @property
    def stands_on(self) -> tuple[str, ...]:
        """Coordinates without which it has no meaning."""

    def term(self) -> NodeTerm:
        """Return what it adds to its node."""

    def rates(self) -> Mapping[str, NodeRate]:
        """Return how fast that changes with each number of it, positions apart."""


@dataclass(frozen=True)
class PointMass:
    """A rigid body clamped to the rope at one point.

    Parameters
    ----------
    x : float
        Where it stands [m].
    mass : float
        [kg]; 0 is allowed, for a disc that only turns.
    rotary_inertia, polar_inertia : float
        About the transverse axis and about the rope's own [kg m^2].

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

    x: float
    mass: float
    _: KW_ONLY
    rotary_inertia: float = 0.0
    polar_inertia: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "x", check.number(self.x, "x", "m"))
        for name, unit in (
            ("mass", "kg"),
            ("rotary_inertia", "kg m^2"),
            ("polar_inertia", "kg m^2"),
        ):
            value = check.number(getattr(self, name), name, unit, sign="nonnegative")
            object.__setattr__(self, name, value)

    @property
    def stands_on(self) -> tuple[str, ...]:
        """Nothing: inertia on an absent coordinate is ignored."""
        return ()

    def term(self) -> NodeTerm:
        """Inertia on the diagonal."""
        mass = {
            "x": self.mass,
            "z": self.mass,
            "alpha": self.polar_inertia,
            "beta": self.rotary_inertia,
        }
        return NodeTerm(mass=mass)

    def rates(self) -> dict[str, NodeRate]:
        """Each of its numbers is an inertia."""
        return {
            "mass": NodeRate(mass={"x": 1.0, "z": 1.0}),
            "rotary_inertia": NodeRate(mass={"beta": 1.0}),
            "polar_inertia": NodeRate(mass={"alpha": 1.0}),
        }


@dataclass(frozen=True)
class Spring:
    """A spring from the rope to the ground.

    Parameters
    ----------
    x : float
        Where it stands [m].
    stiffness : float
        [N/m for x and z, N m for alpha and beta]; may be negative.
    coordinate : {"z", "x", "alpha", "beta"}
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

    x: float
    stiffness: float
    _: KW_ONLY
    coordinate: str = "z"

    def __post_init__(self) -> None:
        object.__setattr__(self, "x", check.number(self.x, "x", "m"))
        check.one_of(self.coordinate, "coordinate", check.COORDINATES)
        unit = "N/m" if self.coordinate in ("x", "z") else "N m"
        stiffness = check.number(self.stiffness, "stiffness", unit, sign="nonzero")
        object.__setattr__(self, "stiffness", stiffness)

    @property
    def stands_on(self) -> tuple[str, ...]:
        """Its coordinate."""
        return (self.coordinate,)

    def term(self) -> NodeTerm:
        """Stiffness on the diagonal."""
        return NodeTerm(stiffness={self.coordinate: self.stiffness})

    def rates(self) -> dict[str, NodeRate]:
        """Return that of its stiffness."""
        return {"stiffness": NodeRate(stiffness={self.coordinate: 1.0})}


@dataclass(frozen=True)
class Dashpot:
    """A dashpot from the rope to the ground, of force c |v|^exponent sign(v).

    Parameters
    ----------
    x : float
        Where it stands [m].
    damping : float
        c [N s/m for x and z, N m s for alpha and beta, of exponent 1].
    coordinate : {"z", "x", "alpha", "beta"}
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

    x: float
    damping: float
    _: KW_ONLY
    coordinate: str = "z"
    exponent: float = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "x", check.number(self.x, "x", "m"))
        check.one_of(self.coordinate, "coordinate", check.COORDINATES)
        unit = "N s/m" if self.coordinate in ("x", "z") else "N m s"
        damping = check.number(self.damping, "damping", unit, sign="positive")
        object.__setattr__(self, "damping", damping)
        exponent = check.number(self.exponent, "exponent", sign="nonnegative")
        object.__setattr__(self, "exponent", exponent)

    @property
    def stands_on(self) -> tuple[str, ...]:
        """Its coordinate."""
        return (self.coordinate,)

    def term(self) -> NodeTerm:
        """Damping on the diagonal, if it is linear."""
        if self.exponent != 1.0:
            law = Law(self.coordinate, "power", (self.damping, self.exponent))
            return NodeTerm(nonlinear=f"exponent must be 1, got {self.exponent!r}", laws=(law,))
        return NodeTerm(damping={self.coordinate: self.damping})

    def rates(self) -> dict[str, NodeRate]:
        """Return that of its damping, which undamped modes do not feel."""
        return {"damping": NodeRate(damping={self.coordinate: 1.0})}


@dataclass(frozen=True)
class Support:
    """A rigid support of one coordinate.

    Parameters
    ----------
    x : float
        Where it stands [m].
    coordinate : {"z", "x", "alpha", "beta"}
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

    x: float
    _: KW_ONLY
    coordinate: str = "z"

    def __post_init__(self) -> None:
        object.__setattr__(self, "x", check.number(self.x, "x", "m"))
        check.one_of(self.coordinate, "coordinate", check.COORDINATES)

    @property
    def stands_on(self) -> tuple[str, ...]:
        """Its coordinate."""
        return (self.coordinate,)

    def term(self) -> NodeTerm:
        """Return the held coordinate."""
        return NodeTerm(held=(self.coordinate,))

    def rates(self) -> dict[str, NodeRate]:
        """Nothing: it has no number but its place."""
        return {}


@dataclass(frozen=True)
class Hinge:
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

    x: float
    _: KW_ONLY
    stiffness: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "x", check.number(self.x, "x", "m"))
        stiffness = check.number(self.stiffness, "stiffness", "N m", sign="nonnegative")
        object.__setattr__(self, "stiffness", stiffness)

    @property
    def stands_on(self) -> tuple[str, ...]:
        """Bending rotation."""
        return ("beta",)

    def term(self) -> NodeTerm:
        """Return the compliance of its spring."""
        compliance = 1.0 / self.stiffness if self.stiffness > 0.0 else math.inf
        return NodeTerm(hinge={"beta": compliance})

    def rates(self) -> dict[str, NodeRate]:
        """Return that of its stiffness."""
        return {"stiffness": NodeRate(hinge={"beta": 1.0})}


@dataclass(frozen=True)
class Resonator:
    """A mass on a spring: a tuned absorber, an attached instrument.

    It moves transversely, with the rope's z as the motion of its foot. In undamped modes it is free
    of damping, as the rope is. Rayleigh damping of the rope acts on its mass, other dampings of the
    rope do not act on it.

    Parameters
    ----------
    x : float
        Where it stands [m].
    mass : float
        [kg].
    frequency : float
        Its own, with its foot held [Hz]: the spring has mass (2 pi frequency)^2.
    damping_ratio : float, optional
        Of the critical damping at that frequency: a dashpot 2 damping_ratio mass (2 pi frequency)
        beside the spring.

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite, the mass or the frequency is not positive or the damping is
        negative; in a model, if z cannot move where it stands.

    Examples
    --------
    An absorber tuned to the drive keeps its foot still:

    >>> import ropedyn as rd
    >>> absorber = rd.Resonator(0.5, 0.01, 16.0)
    >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, parts=[absorber]).compile()
    >>> bool(abs(model.frf([16.0], drive=("z", 0.5)).value[0, 0]) < 1e-15)
    True
    """

    kind: ClassVar[str] = "resonator"

    x: float
    mass: float
    frequency: float
    _: KW_ONLY
    damping_ratio: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "x", check.number(self.x, "x", "m"))
        for name, unit in (("mass", "kg"), ("frequency", "Hz")):
            value = check.number(getattr(self, name), name, unit, sign="positive")
            object.__setattr__(self, name, value)
        ratio = check.number(self.damping_ratio, "damping_ratio", sign="nonnegative")
        object.__setattr__(self, "damping_ratio", ratio)
        numbers = [*self._values, self._values[1] / self._values[0]]
        if not np.isfinite(numbers).all() or 0.0 in (self._values[1], numbers[-1]):
            raise SceneError(
                "frequency must leave the stiffness mass (2 pi frequency)^2 a number [N/m], got "
                f"{self.mass!r} kg and {self.frequency!r} Hz"
            )

    @property
    def _values(self) -> tuple[float, float, float, float]:
        """Mass, stiffness and damping as the core takes them."""
        omega = np.float64(2 * math.pi * self.frequency)
        with np.errstate(over="ignore", under="ignore", invalid="ignore"):
            stiffness = self.mass * omega * omega
            damping = 2 * self.damping_ratio * self.mass * omega
        return self.mass, float(stiffness), 0.0, float(damping)

    @property
    def stands_on(self) -> tuple[str, ...]:
        """The displacement of its foot."""
        return ("z",)

    def term(self) -> NodeTerm:
        """Return the structure, which moves with z."""
        return NodeTerm(attached=[Attached(self.kind, {"z": 1.0}, {}, self._values)])

    def rates(self) -> dict[str, NodeRate]:
        """Return those of a spring mass (2 pi frequency)^2; undamped modes feel no dashpot."""
        attached = {
            "mass": AttachedRate(size=1 / self.mass),
            "frequency": AttachedRate(stiffness=2 / self.frequency),
            "damping_ratio": AttachedRate(damping=1.0),
        }
        return {name: NodeRate(attached=rate) for name, rate in attached.items()}


@dataclass(frozen=True)
class BrokenWire:
    """The free end of a broken wire: a small cantilever that the rope carries.

    A solid round Euler-Bernoulli beam parallel to the axis, towards larger x. Its root moves
    transversely by z + radius alpha and turns by beta, where the scene has these. In undamped modes
    it is free of damping, as the rope is; dampings of the rope do not act on it, but Rayleigh
    damping on its mass. The motion of its tip is the response ("wire", 0) of `Model.frf` for the
    first one among the parts, and so on.

    Parameters
    ----------
    x : float
        Where its root is [m].
    length, diameter : float
        Of the wire [m].
    radius : float
        Of its root from the axis, sideways [m]: how far it moves with twist; may be negative.
    youngs_modulus : float, optional
        [N/m^2].
    density : float, optional
        [kg/m^3].
    damping_ratio : float, optional
        The modulus is E (1 + 2 i damping_ratio) in the frequency response and in damped modes:
        every mode of the wire has this damping ratio at its resonance.

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite, a size is not positive or the damping is negative; in a model,
        if its root cannot move where it stands.

    Examples
    --------
    >>> import ropedyn as rd
    >>> wire = rd.BrokenWire(0.5, 0.05, 3e-4, radius=2e-3)
    >>> print(round(wire.frequency, 2))
    86.0
    """

    kind: ClassVar[str] = "broken wire"

    x: float
    length: float
    diameter: float
    _: KW_ONLY
    radius: float
    youngs_modulus: float = 2.06e11
    density: float = 7850.0
    damping_ratio: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "x", check.number(self.x, "x", "m"))
        object.__setattr__(self, "radius", check.number(self.radius, "radius", "m"))
        for name, unit in (
            ("length", "m"),
            ("diameter", "m"),
            ("youngs_modulus", "N/m^2"),
            ("density", "kg/m^3"),
        ):
            value = check.number(getattr(self, name), name, unit, sign="positive")
            object.__setattr__(self, name, value)
        ratio = check.number(self.damping_ratio, "damping_ratio", sign="nonnegative")
        object.__setattr__(self, "damping_ratio", ratio)
        with np.errstate(all="ignore"):
            numbers = np.array([*self._values[:3], self.frequency])
        if not np.isfinite(numbers).all() or (numbers == 0.0).any():
            raise SceneError(
                "length and diameter must leave mass and stiffness of the wire numbers, got "
                f"{self.length!r} m and {self.diameter!r} m"
            )

    @property
    def _values(self) -> tuple[float, float, float, float]:
        """Mass, E I/length^3, length and damping as the core takes them."""
        length, d = np.float64(self.length), np.float64(self.diameter)
        mass = self.density * (math.pi * d * d / 4) * length
        stiffness = self.youngs_modulus * (math.pi * d**4 / 64) / length**3
        return float(mass), float(stiffness), self.length, self.damping_ratio

    @property
    def frequency(self) -> float:
        """The first natural frequency with the root held [Hz]."""
        mass, stiffness = (np.float64(v) for v in self._values[:2])
        return float(FIRST_ROOT**2 * np.sqrt(stiffness / mass) / (2 * math.pi))

    @property
    def stands_on(self) -> tuple[str, ...]:
        """The displacement of its root; twist and bending where the scene has them."""
        return ("z",)

    def term(self) -> NodeTerm:
        """Return the structure, which moves with z and alpha and turns with beta."""
        moves = {"z": 1.0, "alpha": self.radius}
        return NodeTerm(attached=[Attached(self.kind, moves, {"beta": 1.0}, self._values)])

    def rates(self) -> dict[str, NodeRate]:
        """Return those of a mass as density d^2 l and a stiffness as E d^4/l^3."""
        length, d = self.length, self.diameter
        attached = {
            "length": AttachedRate(
                size=1 / length, stiffness=-4 / length, rotation={"beta": 1 / length}
            ),
            "diameter": AttachedRate(size=2 / d, stiffness=2 / d),
            "radius": AttachedRate(displacement={"alpha": 1.0}),
            "youngs_modulus": AttachedRate(stiffness=1 / self.youngs_modulus),
            "density": AttachedRate(mass=1 / self.density),
            "damping_ratio": AttachedRate(damping=1.0),
        }
        return {name: NodeRate(attached=rate) for name, rate in attached.items()}


@dataclass(frozen=True)
class NodeForce:
    """A force that depends on time and on the motion of the place it acts at.

    Only `Model.transient` and `Model.stepped_sine` take it, by the direct method, and call the law
    about four times for each stage of each step: some 10 microseconds of Python each.

    Parameters
    ----------
    x : float
        Where it acts [m].
    law : callable
        ``law(t, u, v)`` returns the force on the rope [N, or N m on a rotation] at the time t [s]
        from the displacement u [m, rad] and the velocity v [m/s, rad/s].
    coordinate : {"z", "x", "alpha", "beta"}
        What it acts on.

    Raises
    ------
    TypeError
        If the position is not a number, the law not callable or the coordinate not a string.
    SceneError
        If the position is not finite or the coordinate is unknown.

    Examples
    --------
    A spring that hardens:

    >>> import ropedyn as rd
    >>> rd.NodeForce(0.5, lambda t, u, v: -1e3 * u - 1e9 * u**3).coordinate
    'z'
    """

    kind: ClassVar[str] = "node force"

    x: float
    law: Callable[[float, float, float], float]
    _: KW_ONLY
    coordinate: str = "z"

    def __post_init__(self) -> None:
        object.__setattr__(self, "x", check.number(self.x, "x", "m"))
        if not callable(self.law):
            raise TypeError(f"law must be callable as law(t, u, v), got {check.shown(self.law)}")
        check.one_of(self.coordinate, "coordinate", check.COORDINATES)

    @property
    def stands_on(self) -> tuple[str, ...]:
        """Its coordinate."""
        return (self.coordinate,)

    def term(self) -> NodeTerm:
        """Return the law."""
        law = Law(self.coordinate, "call", call=self.law)
        return NodeTerm(nonlinear="law must be absent", laws=(law,))

    def rates(self) -> dict[str, NodeRate]:
        """Nothing: it has no number but its place."""
        return {}


@dataclass(frozen=True)
class Stop:
    """A spring that the rope meets after a gap, on one side.

    Only `Model.transient` and `Model.stepped_sine` take it, by the direct method.

    Parameters
    ----------
    x : float
        Where it stands [m].
    stiffness : float
        While in contact [N/m for x and z, N m for alpha and beta].
    gap : float
        From rest to contact [m, rad].
    side : {1, -1}
        Whether it stops motion in the positive or in the negative direction.
    coordinate : {"z", "x", "alpha", "beta"}
        What it acts on.

    Raises
    ------
    TypeError
        If something is not a number or the coordinate not a string.
    SceneError
        If something is not finite, the stiffness is not positive, the gap is negative, the side is
        neither 1 nor -1 or the coordinate is unknown.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.Stop(0.5, 1e6, gap=1e-3).side
    1
    """

    kind: ClassVar[str] = "stop"

    x: float
    stiffness: float
    _: KW_ONLY
    gap: float = 0.0
    side: int = 1
    coordinate: str = "z"

    def __post_init__(self) -> None:
        object.__setattr__(self, "x", check.number(self.x, "x", "m"))
        check.one_of(self.coordinate, "coordinate", check.COORDINATES)
        unit = "N/m" if self.coordinate in ("x", "z") else "N m"
        stiffness = check.number(self.stiffness, "stiffness", unit, sign="positive")
        object.__setattr__(self, "stiffness", stiffness)
        unit = "m" if self.coordinate in ("x", "z") else "rad"
        object.__setattr__(self, "gap", check.number(self.gap, "gap", unit, sign="nonnegative"))
        side = int(check.number(self.side, "side", sign="nonzero"))
        if side not in (1, -1) or side != self.side:
            raise SceneError(f"side must be 1 or -1, got {self.side!r}")
        object.__setattr__(self, "side", side)

    @property
    def stands_on(self) -> tuple[str, ...]:
        """Its coordinate."""
        return (self.coordinate,)

    def term(self) -> NodeTerm:
        """Return the law."""
        law = Law(self.coordinate, "stop", (self.stiffness, self.gap, float(self.side)))
        return NodeTerm(nonlinear="stiffness must be that of a Spring, got a Stop", laws=(law,))

    def rates(self) -> dict[str, NodeRate]:
        """Nothing: undamped modes do not know it."""
        return {}


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
    return [part for part in parts if not isinstance(part, _stretch.KINDS)]


def stretches(parts: Iterable[Part | Stretch]) -> list[Stretch]:
    """Return the parts that change the rope over a stretch."""
    return [part for part in parts if isinstance(part, _stretch.KINDS)]


def places(parts: Iterable[Part | Stretch]) -> list[float]:
    """Return where parts stand, begin and end [m]."""
    at = ((p.start, p.stop) if isinstance(p, _stretch.KINDS) else (p.x,) for p in parts)
    return list(itertools.chain.from_iterable(at))
