"""Bending test: deflection under a force across a piece of rope."""

from __future__ import annotations

from dataclasses import KW_ONLY
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...base import check
from ...base.answer import axes
from ...base.errors import SceneError, UnitWarning, warn
from ...base.parameter import Description, depending, number, numbers, one_of
from .static_test import StaticTest

LARGE = 0.5  # A part of the span that no bending test of a rope moves.


def _cantilever(L: float, s: float, t: float) -> float:
    return s * s * (3 * t - s) / 6


def _simply_supported(L: float, s: float, t: float) -> float:
    b = L - t
    return s * b * ((L - s) * (L + s) - b * b) / (6 * L)


def _clamped(L: float, s: float, t: float) -> float:
    b = L - t
    return b * b * s * s * (3 * t * L - s * (3 * t + b)) / (6 * L**3)


DEFLECTION = {
    "cantilever": _cantilever,
    "simply-supported": _simply_supported,
    "clamped": _clamped,
}
"""B times the deflection at t per force at s <= t, or the reverse, for each kind of ends."""


def _load_place(x: Any, name: str, test: BendingTest) -> float:
    return _place(x, name, test, test.span if test.ends == "cantilever" else test.span / 2)


def _reading_place(x: Any, name: str, test: BendingTest) -> float:
    assert test.x is not None
    return _place(x, name, test, test.x)


def _place(value: Any, name: str, test: BendingTest, default: float) -> float:
    if value is None:
        return default
    x = check.position(value, name, test.span)
    if x == 0 or (x == test.span and test.ends != "cantilever"):
        raise SceneError(f"{name} must not lie at a support, got {check.shown(value)}")
    return x


class BendingTest(Description, StaticTest, eq=False):
    """Deflections of a piece of rope by a force across it, and the bending stiffness they imply.

    Slender, without tension, small deflections w = F g/B, linear in the force. With the force at
    one and the reading at the other of s <= t from the left support, b = L - t:

    ================  =====================================  ============================
    ends              g                                      at the default place
    ================  =====================================  ============================
    cantilever        s^2 (3 t - s)/6                        L^3/3, at the tip
    simply-supported  s b (L^2 - s^2 - b^2)/(6 L)            L^3/48, at mid-span
    clamped           s^2 b^2 (3 t L - s (3 t + b))/(6 L^3)  L^3/192, at mid-span
    ================  =====================================  ============================

    Roark's Formulas for Stress and Strain, 7th ed., table 8.1, cases 1a, 1e and 1d.

    Parameters
    ----------
    span : float
        L [m]: from the clamp to the tip of a cantilever, otherwise between the supports.
    force : array_like, shape (k,)
        Across the rope [N], zero and negative ones too.
    deflection : array_like, shape (k,)
        Reading at each force, in its direction [m].
    ends : {"cantilever", "simply-supported", "clamped"}
        How the piece is held.
    x : float, optional
        Where the force acts [m], from the left support, the clamp of a cantilever; the tip or
        mid-span where left out.
    read_at : float, optional
        Where the deflection is read [m]; where the force acts if left out.
    zero : float, optional
        Reading without force [m]. Left out it is not known and fitted as well: the slope alone
        tells the stiffness, so that a gauge that was not set to zero, the weight of a pan and the
        sag of the piece under its own weight do no harm.
    reading_std : float, optional
        Standard uncertainty of each reading [m]; the scatter about the line tells it where left
        out, and nothing does where there are no more readings than numbers fitted.

    Attributes
    ----------
    stiffness, std : float
        B and its standard error [N m^2]. That of force, span and places is not in it: B goes with
        the third power of the span.
    offset : float
        Reading without force [m].
    residual : ndarray, shape (k,)
        Reading less the straight line [m]: where it is curved the stiffness depends on the force,
        as when wires slip on each other.

    Raises
    ------
    TypeError
        If something is of the wrong type.
    SceneError
        If something is not finite, a place is off the piece or does not move, the lengths differ,
        the forces are all equal, or the deflection does not grow with them.

    Warns
    -----
    UnitWarning
        If the deflection is more than half of the span.

    Examples
    --------
    >>> import ropedyn as rd
    >>> test = rd.BendingTest(0.5, [0.0, 2.0, 4.0], [1.0e-3, 2.5e-3, 4.1e-3])
    >>> round(test.stiffness, 1), round(test.std, 1), round(test.offset, 6)
    (53.8, 1.0, 0.000983)
    """

    span: float = number("m", sign="positive")
    force: ArrayLike = numbers(axes("reading", unit="N"))
    deflection: ArrayLike = numbers(axes("reading", unit="m"))
    _: KW_ONLY
    ends: str = one_of(DEFLECTION, default="cantilever")
    x: float | None = depending(_load_place, "m", default=None)
    read_at: float | None = depending(_reading_place, "m", default=None)
    zero: float | None = number("m", default=None)
    reading_std: float | None = number("m", sign="positive", default=None)

    stiffness_name = "bending_stiffness"
    symbol = "B"
    names = ("force", "deflection")

    def _agree(self) -> None:
        self._check_readings()
        moved = float(np.ptp(np.asarray(self.deflection)))
        if moved > LARGE * self.span:
            warn(
                f"deflection is up to {moved:.3g} m on a span of {self.span:g} m: is it in m?",
                UnitWarning,
            )

    @property
    def factor(self) -> float:
        """B times the deflection per force, g [m^3]."""
        assert self.x is not None and self.read_at is not None
        s, t = sorted((self.x, self.read_at))
        return DEFLECTION[self.ends](self.span, s, t)
