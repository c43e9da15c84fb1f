"""What stands at a node, and how fast it changes with its numbers."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from types import MappingProxyType
from typing import ClassVar, NamedTuple

from ...base.parameter import Description, position

PLANES = ("z", "y")  # In one of which a part acts, by the displacement in it.

NOTHING: Mapping[str, float] = MappingProxyType({})


class Attached(NamedTuple):
    """A structure condensed to its foot at a node; see csrc/chain/attached.h.

    Its foot moves with a plane, which is named first: where that is absent, so is the structure.
    """

    kind: str  # in `chain.ATTACHED`
    displacement: Mapping[str, float]  # of the foot per motion of the node
    rotation: Mapping[str, float]
    value: tuple[float, float, float, float]  # its numbers


class Law(NamedTuple):
    """A force on one coordinate that is not in proportion to its motion."""

    coordinate: str
    # "power": value[0] |v|^value[1] sign(v); "stop": value[0] times how far u is beyond value[1]
    # in the direction value[2], +1 or -1; "call": what `call` returns
    kind: str
    value: tuple[float, ...] = ()
    # of time, displacement and velocity, the force on the rope
    call: Callable[[float, float, float], float] | None = None


class NodeTerm(NamedTuple):
    """What stands at one node, per coordinate."""

    mass: Mapping[str, float] = NOTHING  # [kg, kg m^2]; ignored on an absent coordinate
    stiffness: Mapping[str, float] = NOTHING  # to the ground [N/m, N m]
    held: Sequence[str] = ()  # coordinates that cannot move
    # compliance between the node and the rope on its right [rad/(N m)], infinite where free
    hinge: Mapping[str, float] = NOTHING
    damping: Mapping[str, float] = NOTHING  # to the ground, of velocity [N s/m, N m s]
    nonlinear: str = ""  # what must be otherwise where time is not integrated, empty if nothing
    attached: Sequence[Attached] = ()  # structures that it carries
    laws: Sequence[Law] = ()  # forces that only integration over time takes


class AttachedRate(NamedTuple):
    """How fast a structure changes with one number of it."""

    size: float = 0.0  # relative, of mass and stiffness together
    mass: float = 0.0  # relative, at the same stiffness
    stiffness: float = 0.0  # relative, at the same mass
    damping: float = 0.0  # of its damping ratio
    displacement: Mapping[str, float] = NOTHING  # of the foot per motion of the node
    # times the length of the structure, over that length: it feels no other rotation
    rotation: Mapping[str, float] = NOTHING


class NodeRate(NamedTuple):
    """How fast what stands at a node changes with one number of it, per coordinate."""

    mass: Mapping[str, float] = NOTHING
    stiffness: Mapping[str, float] = NOTHING
    hinge: Mapping[str, float] = NOTHING  # of the stiffness across a hinge
    damping: Mapping[str, float] = NOTHING
    attached: Sequence[AttachedRate] = ()  # of the structures that it carries, in their order

    def acts(self, coordinates: Collection[str]) -> bool:
        """Whether it changes anything where there are only some coordinates."""
        moved = [self.mass, self.stiffness, self.hinge, self.damping]
        for one in self.attached:
            if one._replace(displacement={}, rotation={}) != AttachedRate():
                return True
            moved += [one.displacement, one.rotation]
        return any(c in coordinates for values in moved for c in values)


class Part(Description):
    """Base of what stands at one place of the rope: what the compiler asks of it.

    >>> import ropedyn as rd
    >>> spring = rd.Spring(0.5, 1e4)
    >>> spring.stands_on, spring.term().stiffness, spring.rates()["stiffness"].stiffness
    (('z',), {'z': 10000.0}, {'z': 1.0})
    """

    kind: ClassVar[str]  # name of the effect

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
