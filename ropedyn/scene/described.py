"""What a scene is made of, and what follows from it."""

from __future__ import annotations

from dataclasses import KW_ONLY
from typing import Any

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.computed import computed
from ..base.parameter import Description, given, instance, number, one_of
from . import damping as _damping
from . import end as _end
from . import left
from .checked import checked_damping, checked_ends, checked_parts, checked_tension
from .damping import Damping
from .end import End
from .gravity import Gravity
from .left import SECOND_PLANE
from .parts import part as _part
from .parts.broken_wire import BrokenWire
from .parts.node import Part
from .parts.stretch import Stretch
from .rope import Rope
from .tension import Tension
from .weight import (
    Grade,
    angle_of,
    climb,
    curves,
    grade,
    hanging,
    mean_around,
    mean_pull,
    pull,
    pulls,
    rubbing,
)

EFFECTS = (
    "tension",
    Tension.pulsating,
    Tension.growing,
    "bending",
    "twist",
    "stretch",
    "lay",
    "rotary inertia",
    "polar inertia",
    *(kind.kind for kind in _part.KINDS),
    *(kind.kind for kind in _damping.KINDS),
    Gravity.kind,
    Gravity.grading,
    SECOND_PLANE,
    "axis",
    "initial moment",
    "turned section",
    "shear",
)
"""The effects that a scene can have, in their fixed order."""


class Described(Description):
    """What a scene is made of, with what is read of it."""

    rope: Rope = instance(Rope, "a Rope")
    _: KW_ONLY
    tension: float | Tension = given(checked_tension, default=0.0)
    ends: tuple[str | End, str | End] = given(checked_ends, default=("clamped", "clamped"))
    damping: Damping | tuple[Damping, ...] | None = given(checked_damping, default=None)
    parts: tuple[Part | Stretch, ...] = given(checked_parts, default=())
    gravity: Gravity | None = instance(Gravity, "a Gravity or None", default=None)
    planes: str = one_of(("z", "both"), default="z")
    torque: float = number("N m", default=0.0)
    axial_force: float = number("N", default=0.0)

    @property
    def is_spatial(self) -> bool:
        """Whether its six coordinates are solved at once: a `SpaceModel`.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).is_spatial
        False
        """
        wound = any(isinstance(part, BrokenWire) and part.is_wound for part in self.parts)
        return self.rope.axis is not None or self.torque != 0 or self.rope.is_turned or wound

    @property
    def is_graded(self) -> bool:
        """Whether the tension grows along the rope by its own weight.

        Examples
        --------
        >>> import ropedyn as rd
        >>> hoist = rd.Scene(rd.Rope(10.0, 2.0), tension=500.0, gravity=rd.Gravity(inclination=0.5))
        >>> hoist.is_graded, hoist.sags
        (True, False)
        """
        return pulls(self.gravity) != 0

    @property
    def sags(self) -> bool:
        """Whether the weight curves the rope, which needs axial stiffness."""
        return curves(self.gravity, self.rope)

    @computed
    def grade(self) -> Grade:
        """The tension along the rope, as a function of the place.

        Examples
        --------
        >>> import ropedyn as rd
        >>> hoist = rd.Scene(rd.Rope(10.0, 2.0), tension=500.0, gravity=rd.Gravity(inclination=0.5))
        >>> round(hoist.grade.mean, 9)
        500.0
        """
        tension = self.tension if isinstance(self.tension, Tension) else Tension(self.tension)
        return grade(self.rope, tension, self.gravity, self.parts)

    def tension_at(self, x: Any) -> Real:
        """Return the tension at places along the rope [N], of a mass on its right.

        Parameters
        ----------
        x : float or array_like
            Places [m].

        Raises
        ------
        SceneError
            If one lies off the rope.

        Examples
        --------
        >>> import math
        >>> import ropedyn as rd
        >>> tension, up = rd.Tension(100.0, at="start"), rd.Gravity(10.0, inclination=math.pi / 2)
        >>> scene = rd.Scene(rd.Rope(30.0, 2.0), tension=tension, gravity=up)
        >>> scene.tension_at([0.0, 15.0, 30.0])
        array([100., 400., 700.])
        """
        places = check.numbers(np.atleast_1d(x), "x", "m")
        for place in places:
            check.position(float(place), "x", self.rope.length)
        if hangs := hanging(self.rope, self.gravity):
            return np.asarray(self._hung(pull(hangs, x)))
        if self.rope.axis is not None and (rubs := rubbing(self.rope, self.tension)):
            return np.asarray(rubs.around(self.rope.axis.turned(x) - angle_of(self.rope, rubs)))
        if self.axial_force:
            return np.full(np.shape(x), self.mean_tension)
        return self.grade.at(places).reshape(np.shape(x))

    @property
    def mean_tension(self) -> float:
        """The tension about which motion is small, its mean along the rope [N].

        Examples
        --------
        >>> import ropedyn as rd
        >>> tension = rd.Tension(1000.0, amplitude=100.0, frequency=50.0)
        >>> rd.Scene(rd.Rope(1.0, 0.1), tension=tension).mean_tension
        1000.0
        """
        if hangs := hanging(self.rope, self.gravity):
            return float(self._hung(mean_pull(hangs)))
        if self.is_graded:
            return self.grade.mean
        if self.axial_force:
            return self.axial_force * climb(self.rope)
        if rubs := rubbing(self.rope, self.tension):
            return mean_around(self.rope, rubs)
        return self.tension.mean if isinstance(self.tension, Tension) else self.tension

    def _hung(self, pull: Any) -> Any:
        assert self.gravity is not None
        return self.gravity.g * self.rope.linear_density * pull

    @computed
    def coordinates(self) -> tuple[str, ...]:
        """Coordinates of a node: z with bending or tension, beta with bending, and so on.

        In both planes y is where z is, gamma where beta is.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=1.0)).coordinates
        ('z', 'beta')
        """
        return left.coordinates_of(self.rope, self.mean_tension, self.planes)

    @property
    def dampings(self) -> tuple[Damping, ...]:
        """The dampings whose sum acts, none or one or more.

        Examples
        --------
        >>> import ropedyn as rd
        >>> damping = rd.ViscousDamping(2.0)
        >>> rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=damping).dampings
        (ViscousDamping(coefficient=2.0),)
        """
        if self.damping is None:
            return ()
        return self.damping if isinstance(self.damping, tuple) else (self.damping,)

    @property
    def effects(self) -> tuple[str, ...]:
        """What acts in this scene, in a fixed order."""
        rope = self.rope
        stands = {part.kind for part in self.parts} | {d.kind for d in self.dampings}
        for end in self.ends:
            stands |= {_end.STANDING[name] for name in _end.end_of(end).standing}
        acts = {
            "tension": self.mean_tension != 0,
            Tension.pulsating: isinstance(self.tension, Tension) and self.tension.pulsates,
            Tension.growing: isinstance(self.tension, Tension) and self.tension.stretching,
            "bending": rope.bending_stiffness is not None,
            "twist": rope.torsional_stiffness is not None,
            "stretch": rope.axial_stiffness is not None,
            "lay": bool(rope.lay_coupling or rope.lay_slope),
            "rotary inertia": bool(rope.bending_stiffness)
            and rope.rotary_inertia not in (None, 0.0, (0.0, 0.0)),
            "polar inertia": bool(rope.polar_inertia and rope.torsional_stiffness),
            Gravity.kind: self.sags,
            Gravity.grading: self.is_graded or hanging(rope, self.gravity) is not None,
            SECOND_PLANE: self.planes == "both",
            "axis": rope.axis is not None and not rope.axis.closed,
            "initial moment": rope.natural == "straight" or bool(self.torque or self.axial_force),
            "turned section": rope.is_turned,
            "shear": rope.shear_stiffness is not None,
        }
        return tuple(effect for effect in EFFECTS if acts.get(effect, effect in stands))
