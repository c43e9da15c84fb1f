"""Ends of the rope: what is held, what is free, and what stands there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import KW_ONLY

from ..base import check
from ..base.errors import SceneError
from ..base.parameter import Description, one_of, per_coordinate
from .parts.node import NodeTerm
from .parts.part import Dashpot, PointMass, Spring

STANDING = {"spring": Spring.kind, "dashpot": Dashpot.kind, "mass": PointMass.kind}
"""What can stand at an end, and the effect it is."""

HELD_OR_FREE = ("held", "free")  # What an end can do to a coordinate.


class End(Description):
    """What holds an end of the rope. Coordinates the scene does not have are ignored.

    Parameters
    ----------
    x, y, z, alpha, beta, gamma : {"held", "free"}
        The coordinate cannot move, or nothing holds it. In a clevis ``End(beta="held",
        gamma="free")`` the rope is clamped in the plane of z and pinned in that of y.
    spring : mapping, optional
        Stiffness from the end to the ground at free coordinates, such as ``{"beta": 12.0}``
        [N/m for x, y and z, N m for alpha, beta and gamma].
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

    _: KW_ONLY
    x: str = one_of(HELD_OR_FREE, default="held")
    y: str = one_of(HELD_OR_FREE, default="held")
    z: str = one_of(HELD_OR_FREE, default="held")
    alpha: str = one_of(HELD_OR_FREE, default="held")
    beta: str = one_of(HELD_OR_FREE, default="held")
    gamma: str = one_of(HELD_OR_FREE, default="held")
    spring: Mapping[str, float] = per_coordinate("N/m", turning="N m", sign="nonzero", default={})
    dashpot: Mapping[str, float] = per_coordinate(
        "N s/m", turning="N m s", sign="positive", default={}
    )
    mass: Mapping[str, float] = per_coordinate(
        "kg", turning="kg m^2", sign="nonnegative", default={}
    )

    def _agree(self) -> None:
        for name in STANDING:
            for coordinate in getattr(self, name):
                if self.holds(coordinate):
                    raise SceneError(
                        f"{name} must stand at free coordinates, got one at {coordinate!r}, "
                        "which is held"
                    )

    def holds(self, coordinate: str) -> bool:
        """Whether the coordinate cannot move.

        Examples
        --------
        >>> import ropedyn as rd
        >>> pinned = rd.End(beta="free", gamma="free")
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
        (['x', 'y', 'z', 'alpha', 'gamma'], {'beta': 12.0})
        """
        held = [c for c in check.COORDINATES if getattr(self, c) == "held"]
        return NodeTerm(self.mass, self.spring, held, damping=self.dashpot)


NAMED = {
    "clamped": End(),
    "pinned": End(beta="free", gamma="free"),
    "free": End(x="free", y="free", z="free", alpha="free", beta="free", gamma="free"),
}
"""The words that are ends."""


def end_of(value: str | End) -> End:
    """Return the end a word stands for, or the end itself."""
    return NAMED[value] if isinstance(value, str) else value
