"""What stands at a node, and how fast it changes with its numbers."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from types import MappingProxyType
from typing import ClassVar, NamedTuple

from ...base.parameter import Description, position


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


class Part(Description):
    """Base of what stands at one place of the rope: what the compiler asks of it.

    >>> import ropedyn as rd
    >>> spring = rd.Spring(0.5, 1e4)
    >>> spring.stands_on, spring.term().stiffness, spring.rates()["stiffness"].stiffness
    (('z',), {'z': 10000.0}, {'z': 1.0})
    """

    kind: ClassVar[str]
    """Name of the effect."""

    x: float = position()

    @property
    def stands_on(self) -> tuple[str, ...]:
        """Coordinates without which it has no meaning: the one it acts on, if it has one."""
        return (self.coordinate,) if hasattr(self, "coordinate") else ()

    def term(self) -> NodeTerm:
        """Return what it adds to its node."""
        raise NotImplementedError

    def rates(self) -> Mapping[str, NodeRate]:
        """Return how fast that changes with each number of it, positions apart."""
        return {}
