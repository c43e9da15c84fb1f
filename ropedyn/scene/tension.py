"""Tension: where it is known, how it pulsates in time or grows with the amplitude."""

from __future__ import annotations

from dataclasses import KW_ONLY
from typing import Any, ClassVar

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.errors import SceneError
from ..base.parameter import Description, flag, given, number
from .force import rotation

AT = ("middle", "start", "end")
"""Words for the places where the mean is known."""


def _checked_at(at: Any) -> str | float:
    if isinstance(at, str):
        return check.one_of(at, "at", AT)
    return check.number(at, "at", "m", sign="nonnegative")


class Tension(Description):
    """A tension that is more than a number.

        T(t) = mean + amplitude cos(2 pi frequency t + phase) + stretching,

    where the stretching, if it is asked for, is EA/2L times the integral of (dz/dx)^2 along the
    rope, in both planes of (dz/dx)^2 + (dy/dx)^2: transverse motion lengthens a rope whose ends
    hold it along x, and the tension this adds is the same everywhere where waves along x are much
    faster than transverse ones (Kirchhoff's string). Frequencies, responses and deflections are
    those of the mean tension; what pulsates and stretches acts in `Model.transient`,
    `Model.stepped_sine`, `Model.floquet` and `Model.stability_map`. A laid rope is turned by what
    pulsates, at ends that are free to turn.

    Parameters
    ----------
    mean : float
        [N]; negative is compression.
    at : {"middle", "start", "end"} or float
        Where along the rope it is the mean [m]; elsewhere the rope's weight has changed it: see
        `Gravity`. Without that it says nothing. Of a rope that is curved too it is the component
        along the chord, and the place a share of the arc: see `Scene.on_catenary`.
    amplitude : float
        Of the pulsation [N].
    frequency : float
        Of the pulsation [Hz], positive where there is one.
    phase : float
        Of the pulsation [rad].
    stretching : bool
        Whether the tension grows with the amplitude of transverse motion; needs axial_stiffness.
    friction : float
        Of a rope on an axis against the sheaves that curve it, at the limit of sliding: the tension
        grows by exp(friction angle) with the angle that the axis turns by, falls where it is
        negative (Euler and Eytelwein). What holds the rope so is a dead load.

    Raises
    ------
    TypeError
        If something is of the wrong type.
    SceneError
        If something is not finite, the amplitude is negative, or it pulsates without a frequency.

    References
    ----------
    G. Kirchhoff, Vorlesungen ueber mathematische Physik: Mechanik (1876), lecture 29; A. H. Nayfeh,
    D. T. Mook, Nonlinear Oscillations (1979), sections 5.2 and 7.5.

    Examples
    --------
    >>> import ropedyn as rd
    >>> tension = rd.Tension(1000.0, amplitude=100.0, frequency=50.0)
    >>> rd.Scene(rd.Rope(1.0, 0.1), tension=tension).effects
    ('tension', 'pulsating tension')
    """

    pulsating: ClassVar[str] = "pulsating tension"  # name of the effect
    growing: ClassVar[str] = "mean stretching"  # name of the effect

    mean: float = number("N")
    _: KW_ONLY
    at: str | float = given(_checked_at, default="middle")
    amplitude: float = number("N", sign="nonnegative", default=0.0)
    frequency: float = number("Hz", sign="nonnegative", default=0.0)
    phase: float = number("rad", default=0.0)
    stretching: bool = flag(default=False)
    friction: float = number(default=0.0)

    def _agree(self) -> None:
        if self.amplitude > 0 and self.frequency == 0:
            raise SceneError("frequency must be > 0 where the tension pulsates [Hz], got 0")

    @property
    def pulsates(self) -> bool:
        """Whether it varies in time."""
        return self.amplitude > 0

    @property
    def is_constant(self) -> bool:
        """Whether it varies neither in time nor with the motion."""
        return not self.pulsates and not self.stretching

    def around(self, angle: Any) -> Any:
        """Return it where the axis has turned by an angle from where the mean is known [N].

        Examples
        --------
        >>> import math
        >>> import ropedyn as rd
        >>> print(round(rd.Tension(100.0, friction=0.1).around(math.pi), 3))
        136.911
        """
        return self.mean * np.exp(self.friction * angle)

    def pulsation(self, time: Real) -> Real:
        """Return what pulsation adds to the mean [N], as `time` [s].

        Examples
        --------
        >>> import numpy as np
        >>> import ropedyn as rd
        >>> tension = rd.Tension(1000.0, amplitude=100.0, frequency=50.0)
        >>> tension.pulsates, tension.is_constant
        (True, False)
        >>> tension.pulsation(np.array([0.0, 0.01, 0.02]))
        array([ 100., -100.,  100.])
        """
        angle = rotation(self.frequency, time, self.phase)
        return np.asarray(self.amplitude * np.cos(angle))
