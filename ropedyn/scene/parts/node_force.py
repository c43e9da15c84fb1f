"""A force on a node by a law of the user."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import KW_ONLY
from typing import Any, ClassVar

from ...base import check
from ...base.parameter import given, one_of
from .node import Law, NodeTerm, Part


def _checked_law(law: Any) -> Any:
    if not callable(law):
        raise TypeError(f"law must be callable as law(t, u, v), got {check.shown(law)}")
    return law


class NodeForce(Part):
    """A force that depends on time and on the motion of the place it acts at.

    Only `Model.transient` and `Model.stepped_sine` take it, by the direct method, and call the law
    about four times for each of the two stages of a step: some 100 microseconds of Python a step.
    The tension must neither pulsate nor be stretching.

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

    law: Callable[[float, float, float], float] = given(_checked_law)
    _: KW_ONLY
    coordinate: str = one_of(check.COORDINATES, default="z")

    def term(self) -> NodeTerm:
        """Return the law."""
        law = Law(self.coordinate, "call", call=self.law)
        return NodeTerm(nonlinear="law must be absent", laws=(law,))
