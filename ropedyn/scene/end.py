"""Ends of the rope: what is held, what is free, and what stands there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import KW_ONLY, dataclass, field
from typing import Any

from ..base import check
from ..base.errors import SceneError
from ..base.unit import UNIT
from .parts.node import NodeTerm
from .parts.part import Dashpot, PointMass, Spring

STANDING = {"spring": Spring.kind, "dashpot": Dashpot.kind, "mass": PointMass.kind}
"""What can stand at an end, and the effect it is."""

_NUMBER = {
    "spring": ("N/m", "N m", "nonzero"),
    "dashpot": ("N s/m", "N m s", "positive"),
    "mass": ("kg", "kg m^2", "nonnegative"),
}


class PerCoordinate(Mapping[str, float]):
    """Values per coordinate, such as spring stiffnesses; a mapping that cannot change."""

    def __init__(
        self, values: Mapping[str, Any], name: str, units: tuple[str, str], sign: str
    ) -> None:
        check.instance(values, name, Mapping, "a mapping from coordinates to numbers")
        for key in values:
            check.one_of(key, f"key of {name}", check.COORDINATES)
        self._values = {
            c: check.number(values[c], f"{name}[{c!r}]", units[UNIT[c] == "rad"], sign=sign)
            for c in check.COORDINATES
            if c in values
        }

    def __getitem__(self, coordinate: str) -> float:
        return self._values[coordinate]

    def __iter__(self) -> Iterator[str]:
        return iter(self._values)

    def __len__(self) -> int:
        return len(self._values)

    def __hash__(self) -> int:
        return hash(tuple(self._values.items()))

    def __repr__(self) -> str:
        return repr(self._values)


@dataclass(frozen=True)
class End:
    """What holds an end of the rope. Coordinates the scene does not have are ignored.

    Parameters
    ----------
    x, z, alpha, beta : {"held", "free"}
        The coordinate cannot move, or nothing holds it.
    spring : mapping, optional
        Stiffness from the end to the ground at free coordinates, such as ``{"beta": 12.0}``
        [N/m for x and z, N m for alpha and beta].
    dashpot : mapping, optional
        Damping from the end to the ground at free coordinates [N s/m, N m s].
    mass : mapping, optional
        Inertia at free coordinates, of one the other has no part of [kg, kg m^2].

    Raises
    ------
    TypeError
        If a word is not a string or a value not a number.
    SceneError
        If a word or coordinate is unknown, a value not finite, a stiffness 0, a damping not
        positive, a mass negative, or something stands at a held coordinate.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.End(beta="free", spring={"beta": 12.0}).spring["beta"]
    12.0
    """

    x: str = "held"
    z: str = "held"
    alpha: str = "held"
    beta: str = "held"
    _: KW_ONLY
    spring: Mapping[str, float] = field(default_factory=dict)
    dashpot: Mapping[str, float] = field(default_factory=dict)
    mass: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for coordinate in check.COORDINATES:
            check.one_of(getattr(self, coordinate), coordinate, ("held", "free"))
        for name, (along, turning, sign) in _NUMBER.items():
            values = PerCoordinate(getattr(self, name), name, (along, turning), sign)
            for coordinate in values:
                if self.holds(coordinate):
                    raise SceneError(
                        f"{name} must stand at free coordinates, got one at {coordinate!r}, "
                        "which is held"
                    )
            object.__setattr__(self, name, values)

    def holds(self, coordinate: str) -> bool:
        """Whether the coordinate cannot move.

        Examples
        --------
        >>> import ropedyn as rd
        >>> pinned = rd.End(beta="free")
        >>> pinned.holds("z"), pinned.holds("beta")
        (True, False)
        """
        return bool(getattr(self, coordinate) == "held")

    @property
    def standing(self) -> dict[str, Mapping[str, float]]:
        """What stands there, by the name of the argument; nothing where nothing does.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.End(beta="free", spring={"beta": 12.0}).standing
        {'spring': {'beta': 12.0}}
        """
        values = {name: getattr(self, name) for name in STANDING}
        return {name: value for name, value in values.items() if value}

    def term(self) -> NodeTerm:
        """Return what it adds to its node.

        Examples
        --------
        >>> import ropedyn as rd
        >>> term = rd.End(beta="free", spring={"beta": 12.0}).term()
        >>> term.held, term.stiffness
        (['x', 'z', 'alpha'], {'beta': 12.0})
        """
        held = [c for c in check.COORDINATES if self.holds(c)]
        return NodeTerm(self.mass, self.spring, held, damping=self.dashpot)


NAMED = {
    "clamped": End(),
    "pinned": End(beta="free"),
    "free": End(x="free", z="free", alpha="free", beta="free"),
}
"""The words that are ends."""


def end_of(value: str | End) -> End:
    """Return the end a word stands for, or the end itself."""
    return NAMED[value] if isinstance(value, str) else value
