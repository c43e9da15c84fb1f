"""Ends of the rope: what is held, what is free, and the springs there."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import KW_ONLY, dataclass, field
from typing import Any

from . import check
from .errors import SceneError


class PerCoordinate(Mapping[str, float]):
    """Values per coordinate, such as spring stiffnesses; a mapping that cannot change."""

    def __init__(self, values: Mapping[str, Any], name: str, unit: str, sign: str) -> None:
        check.instance(values, name, Mapping, "a mapping from coordinates to numbers")
        for key in values:
            check.one_of(key, f"key of {name}", check.COORDINATES)
        self._values = {
            c: check.number(values[c], f"{name}[{c!r}]", unit, sign=sign)
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

    Raises
    ------
    TypeError
        If a word is not a string or a stiffness not a number.
    SceneError
        If a word or coordinate is unknown, a stiffness not finite or 0, or a spring stands at a
        held coordinate.

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

    def __post_init__(self) -> None:
        for coordinate in check.COORDINATES:
            check.one_of(getattr(self, coordinate), coordinate, ("held", "free"))
        spring = PerCoordinate(self.spring, "spring", "N/m or N m", "nonzero")
        for coordinate in spring:
            if getattr(self, coordinate) == "held":
                raise SceneError(
                    f"spring must stand at free coordinates, got one at {coordinate!r}, "
                    "which is held"
                )
        object.__setattr__(self, "spring", spring)

    def holds(self, coordinate: str) -> bool:
        """Whether the coordinate cannot move."""
        return bool(getattr(self, coordinate) == "held")


NAMED = {
    "clamped": End(),
    "pinned": End(beta="free"),
    "free": End(x="free", z="free", alpha="free", beta="free"),
}
"""The words that are ends."""


def end_of(value: str | End) -> End:
    """Return the end a word stands for, or the end itself."""
    return NAMED[value] if isinstance(value, str) else value
