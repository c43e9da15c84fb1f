"""What stands at single points and is linear but for events: stops, friction, dashpots."""

from __future__ import annotations

from typing import NamedTuple

from ...chain.compiled import Compiled
from ...chain.port import Point
from ..acting import acting_laws
from ..states import Resistance, without_dashpots


class Contact(NamedTuple):
    """A stop."""

    point: Point
    stiffness: float  # [N/m, N m]
    gap: float  # [m, rad]
    side: float  # 1 or -1


class Friction(NamedTuple):
    """Coulomb's friction."""

    point: Point
    force: float  # [N, N m]


class PhaseLaws(NamedTuple):
    """All laws of a component at points that can move."""

    contacts: tuple[Contact, ...]
    frictions: tuple[Friction, ...]  # one for each point
    dashpots: tuple[Resistance, ...]

    @property
    def points(self) -> tuple[Point, ...]:
        """Where they act, in this order."""
        return tuple(one.point for some in self for one in some)


def phase_laws(model: Compiled, component: tuple[str, ...]) -> PhaseLaws:
    """Return the laws of a component."""
    contacts: list[Contact] = []
    friction: dict[Point, float] = {}
    for _, point, law in acting_laws(model, component):
        if law.kind == "stop":
            contacts.append(Contact(point, *law.value))
        else:
            friction[point] = friction.get(point, 0.0) + law.value[0]
    _, dashpots = without_dashpots(model, component)
    frictions = tuple(Friction(point, force) for point, force in friction.items())
    return PhaseLaws(tuple(contacts), frictions, dashpots)
