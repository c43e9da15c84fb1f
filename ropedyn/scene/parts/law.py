"""Forces by a law that only integration over time takes: a user's, or a stop after a gap."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY
from typing import Any, ClassVar

from ...base import check
from ...base.errors import SceneError
from ...base.parameter import given, number, one_of
from .node import Law, NodeTerm, Part


def _checked_law(law: Any) -> Any:
    if not callable(law):
        raise TypeError(f"law must be callable as law(t, u, v), got {check.shown(law)}")
    return law


class NodeForce(Part):
    """A force that depends on time and on the motion of the place it acts at.

    Only `Model.transient` and `Model.stepped_sine` take it. With ``method="auto"`` motion under a
    smooth law is found by collocation, some 20 calls a step; a law that takes arrays of t, u and v,
    as ``-1e9 * u**3`` does, is given all stages of a step in one call. What jumps, such as
    friction, does not converge and is refused. Harmonic balance gives it the times and motions of a
    whole period where it takes arrays, else one after another.

    Parameters
    ----------
    x : float
        Where it acts [m].
    law : callable
        ``law(t, u, v)`` returns the force on the rope [N, or N m on a rotation] at the time t [s]
        from the displacement u [m, rad] and the velocity v [m/s, rad/s].
    coordinate : {"z", "x", "y", "alpha", "beta", "gamma"}
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

    law: Callable[[float, float, float], float] = given(_checked_law)
    _: KW_ONLY
    coordinate: str = one_of(check.COORDINATES, default="z")

    def term(self) -> NodeTerm:
        """Return the law."""
        law = Law(self.coordinate, "call", call=self.law)
        return NodeTerm(nonlinear="law must be absent", laws=(law,))


def _checked_side(side: Any) -> int:
    number = int(check.number(side, "side", sign="nonzero"))
    if number not in (1, -1) or number != side:
        raise SceneError(f"side must be 1 or -1, got {side!r}")
    return number


class Stop(Part):
    """A spring that the rope meets after a gap, on one side.

    Only `Model.transient` and `Model.stepped_sine` take it, on continuous spans too.

    Parameters
    ----------
    x : float
        Where it stands [m].
    stiffness : float
        While in contact [N/m for x, y and z, N m for alpha, beta and gamma].
    gap : float
        From rest to contact [m, rad].
    side : {1, -1}
        Whether it stops motion in the positive or in the negative direction.
    coordinate : {"z", "x", "y", "alpha", "beta", "gamma"}
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

    stiffness: float = number("N/m", turning="N m", sign="positive")
    _: KW_ONLY
    gap: float = number("m", turning="rad", sign="nonnegative", default=0.0)
    side: int = given(_checked_side, default=1)
    coordinate: str = one_of(check.COORDINATES, default="z")

    def term(self) -> NodeTerm:
        """Return the law."""
        law = Law(self.coordinate, "stop", (self.stiffness, self.gap, float(self.side)))
        return NodeTerm(nonlinear="stiffness must be that of a Spring, got a Stop", laws=(law,))
