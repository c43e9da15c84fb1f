"""Gravity: the tension of a rope grows uphill, and one that hangs is curved."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY
from typing import ClassVar

from ..base.errors import SceneError
from ..base.parameter import Description, flag, number
from .rope import Rope


class Gravity(Description):
    """Weight of the rope in the plane of z: its tension grows uphill, and between its ends it sags.

    The end at x = L is the higher one where the inclination is positive. With the weight along the
    rope w = linear_density g sin(inclination) the tension is ("own weight")

        T(s) = T_ref + integral of w from s_ref to s, + m g sin(inclination) above each mass m

    with T_ref and s_ref of the scene's `Tension`, the middle where that is a number. Of a mass that
    stands there T_ref is on the side of larger x: above it where the inclination is positive, below
    where it is negative. Continuous spans are exact for it, elements of chains each have the
    tension at their middle. Without bending stiffness it must not be negative anywhere; at a free
    end it may vanish, as of a hanging chain. What does not go with it is refused.

    A rope with axial stiffness is curved as well ("sag"), unless it stands upright. With the
    chordwise tension H (the scene's), w = linear_density g cos(inclination) and the chord L, it
    hangs in a parabola of the curvature w/H. A small motion, x along it and z towards
    the centre of the curve (up, against the weight), strains the rope by

        x' - (w/H) z = h/EA_e,  EA_e = EA L/L_e,  L_e = L (1 + (w L/H)^2/8)

    and the tension h that this adds pulls z back by (w/H) h:

        B z'''' - H z'' + mu z_tt = (w/H) h

    The stretch follows at once: the rope has no inertia along x where gravity acts, so that h is
    the same wherever nothing holds x, and there are no axial modes. With both ends held, h =
    -(EA/L_e) (w/H) integral z dx. For a string (B = 0) symmetric modes depend on

        lambda^2 = (w L/H)^2 L EA/(H L_e)

    alone and antisymmetric ones not at all. With x free at an end h is 0 and sag stiffens nothing.

    The parabola is the whole rope's whatever supports it between; the weight of what stands on it
    does not curve it, as it does on the catenary; a `PointMass` keeps its inertia along x.
    `Modes.model_error` says what that leaves out, and `Modes.catenary` what is true. Where it may
    be more than a thousandth of a frequency, above frequencies along the rope, and where both
    effects act, modes, counts, responses and statics of continuous spans are those of
    `Scene.on_catenary`; what is not carried there stays the parabola's with a `ModelWarning`, and
    is refused where both act.

    Parameters
    ----------
    g : float
        Acceleration [m/s^2]; negative: the rope hangs towards positive z.
    inclination : float
        Of the chord to the horizontal [rad], from -pi/2 to pi/2.
    sag, own_weight : bool
        Whether the weight curves the rope, and whether it changes the tension along it.

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite or the inclination is beyond a right angle.

    References
    ----------
    H. M. Irvine, T. K. Caughey, The linear theory of free vibrations of a suspended cable,
    Proceedings of the Royal Society A 341 (1974); H. M. Irvine, Cable Structures (1981), with the
    inclined cable.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rope = rd.Rope(100.0, 2.0, axial_stiffness=2e7)
    >>> scene = rd.Scene(rope, tension=10e3, gravity=rd.Gravity())
    >>> round(scene.gravity.sag_parameter(rope, 10e3), 2)
    76.62
    >>> scene.compile().modes(2).frequency.round(4)
    array([0.7049, 0.8676])
    >>> scene.without("sag").compile().modes(2).frequency.round(4)
    array([0.3536, 0.7071])
    """

    kind: ClassVar[str] = "sag"  # name of the effect
    grading: ClassVar[str] = "own weight"  # name of the effect

    g: float = number("m/s^2", default=9.81)
    _: KW_ONLY
    inclination: float = number("rad", default=0.0)
    sag: bool = flag(default=True)
    own_weight: bool = flag(default=True)

    def _agree(self) -> None:
        if not abs(self.inclination) <= math.pi / 2:
            raise SceneError(
                f"inclination must lie between -pi/2 and pi/2 [rad], got {self.inclination!r}"
            )

    def curvature(self, rope: Rope, tension: float) -> float:
        """Return w/H [1/m] of a rope under a chordwise tension [N].

        Examples
        --------
        >>> import ropedyn as rd
        >>> round(rd.Gravity().curvature(rd.Rope(100.0, 2.0), 10e3), 6)
        0.001962
        """
        return rope.linear_density * self.g * math.cos(self.inclination) / tension

    def lengthening(self, rope: Rope, tension: float) -> float:
        """Return L_e/L = 1 + (w L/H)^2/8 of a rope under a chordwise tension [N].

        Examples
        --------
        >>> import ropedyn as rd
        >>> round(rd.Gravity().lengthening(rd.Rope(100.0, 2.0), 10e3), 6)
        1.004812
        """
        slope = self.curvature(rope, tension) * rope.length
        return 1 + slope * slope / 8

    def sag_parameter(self, rope: Rope, tension: float) -> float:
        """Return Irvine's lambda^2 = (w L/H)^2 EA/(H L_e/L) of a rope under a tension [N].

        Raises
        ------
        SceneError
            If the rope has no axial stiffness.
        """
        if rope.axial_stiffness is None:
            raise SceneError("axial_stiffness must be given for a sag parameter [N], got None")
        slope = self.curvature(rope, tension) * rope.length
        return slope**2 * rope.axial_stiffness / (tension * self.lengthening(rope, tension))
