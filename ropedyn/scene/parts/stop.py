"""A stop that the rope meets after a gap."""

from __future__ import annotations

from dataclasses import KW_ONLY, dataclass
from typing import ClassVar

from ...base import check
from ...base.errors import SceneError
from ...base.unit import UNIT
from .node import Law, NodeRate, NodeTerm


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
        gap = check.number(self.gap, "gap", UNIT[self.coordinate], sign="nonnegative")
        object.__setattr__(self, "gap", gap)
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
