"""Torsion test: turn of one end of a piece of rope under a torque."""

from __future__ import annotations

from dataclasses import KW_ONLY

from numpy.typing import ArrayLike

from ...base.answer import axes
from ...base.parameter import Description, number, numbers
from .static_test import StaticTest


class TorsionTest(Description, StaticTest, eq=False):
    """Angles that a torque turns a piece of rope by, and the torsional stiffness they imply.

    Of uniform twist: angle = torque length/C. In a laid rope that is C where the ends cannot come
    nearer to each other, and C - D^2/EA where they are free to.

    Parameters
    ----------
    length : float
        Of the piece that twists [m]: between the two places whose difference the angle is.
    torque : array_like, shape (k,)
        [N m].
    angle : array_like, shape (k,)
        Reading at each torque, in its direction [rad].
    zero : float, optional
        Reading without torque [rad]. Left out it is not known and fitted as well: the slope alone
        tells the stiffness.
    reading_std : float, optional
        Standard uncertainty of each reading [rad]; the scatter about the line tells it where left
        out, and nothing does where there are no more readings than numbers fitted.

    Attributes
    ----------
    stiffness, std : float
        C and its standard error [N m^2]; that of torque and length is not in it.
    offset : float
        Reading without torque [rad].
    residual : ndarray, shape (k,)
        Reading less the straight line [rad].

    Raises
    ------
    TypeError
        If something is of the wrong type.
    SceneError
        If something is not finite, the lengths differ, the torques are all equal, or the angle does
        not grow with them.

    Examples
    --------
    >>> import ropedyn as rd
    >>> test = rd.TorsionTest(0.5, [0.0, 0.05, 0.1], [0.0, 0.17, 0.336])
    >>> round(test.stiffness, 4), round(test.std, 4)
    (0.1488, 0.001)
    """

    length: float = number("m", sign="positive")
    torque: ArrayLike = numbers(axes("reading", unit="N m"))
    angle: ArrayLike = numbers(axes("reading", unit="rad"))
    _: KW_ONLY
    zero: float | None = number("rad", default=None)
    reading_std: float | None = number("rad", sign="positive", default=None)

    stiffness_name = "torsional_stiffness"
    symbol = "C"
    names = ("torque", "angle")

    def _agree(self) -> None:
        self._check_readings()

    @property
    def factor(self) -> float:
        """C times the angle per torque: the length [m]."""
        return self.length
