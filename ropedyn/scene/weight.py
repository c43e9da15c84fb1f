"""The tension along a rope: what its own weight, sheaves and a load on a spring make of it."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..axis.axis import Axis
from ..axis.piece import CatenaryPiece
from ..base.array import Real
from ..base.errors import SceneError
from .gravity import Gravity
from .parts.node import Part
from .parts.part import places, standing, stretches
from .parts.stretch import Stretch, ropes
from .rope import Rope
from .stations import nearest, stations_at
from .tension import Tension

if TYPE_CHECKING:
    from .described import Described

WEIGHING = ("linear_density", "density", "mass", "g", "inclination")
"""Numbers that the tension changes with by weight."""

LEAST = 1e-6
"""Of the largest tension: a string with less of it is not told from a slack one to 1e-11."""

ROUNDING = 16 * np.finfo(float).eps  # Of the largest tension: less is none.


def pulls(gravity: Gravity | None) -> float:
    """Return what the weight pulls by along the rope, per mass, from its end at L [m/s^2]."""
    if gravity is None or not gravity.own_weight:
        return 0.0
    return gravity.g * math.sin(gravity.inclination)


def hanging(rope: Rope, gravity: Gravity | None) -> Axis | None:
    """Return the catenary that a rope with weight hangs in."""
    if rope.axis is None or gravity is None or not gravity.own_weight:
        return None
    return rope.axis if rope.axis.hangs else None


def pull(axis: Axis, s: Any) -> Real:
    """Return the tension over weight per length of what hangs [m]: its curvature is c/pull^2."""
    return np.asarray(np.sqrt(_hung(axis)[0].parameter / axis.rates(s)[..., 1]))


def mean_pull(axis: Axis) -> float:
    """Return its mean along the axis [m]."""
    return math.fsum(piece.mean_pull * piece.length for piece in _hung(axis)) / axis.length


def _hung(axis: Axis) -> list[CatenaryPiece]:
    return [piece for piece in axis.pieces if isinstance(piece, CatenaryPiece)]


def rubbing(rope: Rope, tension: float | Tension) -> Tension | None:
    """Return the tension of a rope that rubs against what curves it."""
    there = rope.axis is not None and isinstance(tension, Tension) and tension.friction != 0
    return tension if there and isinstance(tension, Tension) else None


def angle_of(rope: Rope, tension: Tension) -> float:
    """Return the angle that the axis turns by up to where a tension is its mean [rad]."""
    assert rope.axis is not None
    return float(rope.axis.turned(place_of(tension, rope.length)))


def mean_around(rope: Rope, tension: Tension) -> float:
    """Return the mean along a rope that rubs, T (e^x - 1)/x of each piece, T at its left end."""
    assert rope.axis is not None
    joints, pieces = rope.axis.joints, rope.axis.pieces
    left = tension.around(rope.axis.turned(joints)[:-1] - angle_of(rope, tension))
    x = tension.friction * np.array([piece.turned(piece.length) for piece in pieces])
    mean = np.divide(np.expm1(x), x, where=x != 0, out=np.ones_like(x))
    return float(left * mean @ np.diff(joints) / rope.length)


def climb(rope: Rope) -> float:
    """Return the sine of the pitch angle of a helix."""
    assert rope.axis is not None
    tau, kz, _ = rope.axis.rates(0.0)
    return float(abs(tau) / math.hypot(tau, kz))


def curves(gravity: Gravity | None, rope: Rope) -> bool:
    """Say whether the weight curves a rope, if it can stretch and does not stand upright."""
    if gravity is None or not gravity.sag or rope.axial_stiffness is None or rope.axis is not None:
        return False
    return abs(gravity.inclination) != math.pi / 2


def place_of(tension: Tension, length: float) -> float:
    """Return where along a rope a tension is its mean [m]."""
    of = {"start": 0.0, "middle": 0.5 * length, "end": length}
    return of[tension.at] if isinstance(tension.at, str) else tension.at


class Grade(NamedTuple):
    """Tension between stations, linear in each span; it is larger above a mass than below."""

    station: Real  # (spans + 1,) [m]
    left: Real  # (spans,) at the left end of each [N]
    right: Real  # (spans,)

    @property
    def mean(self) -> float:
        """Along the rope [N]."""
        whole = np.diff(self.station) @ (self.left + self.right) / 2
        return float(whole / self.station[-1])

    def less(self, other: Grade, times: float) -> Grade:
        """Return so many times the difference from another."""
        return Grade(
            self.station, times * (self.left - other.left), times * (self.right - other.right)
        )

    def at(self, x: Any) -> Real:
        """Return the tension at places, of a mass right of it [N]."""
        span = np.searchsorted(self.station, x, side="right") - 1
        span = np.clip(span, 0, len(self.left) - 1)
        share = (x - self.station[span]) / np.diff(self.station)[span]
        return np.asarray(self.left[span] * (1 - share) + self.right[span] * share)

    def parted(self, x: Real) -> tuple[Real, Real]:
        """Return the tension at both ends of what lies between places, stations among them."""
        span = np.searchsorted(self.station, (x[1:] + x[:-1]) / 2, side="right") - 1
        length = np.diff(self.station)[span]
        from_left = (x[:-1] - self.station[span]) / length
        from_right = (self.station[span + 1] - x[1:]) / length
        rise = self.right[span] - self.left[span]
        return self.left[span] + from_left * rise, self.right[span] - from_right * rise


def grade(
    rope: Rope, tension: Tension, gravity: Gravity | None, parts: Sequence[Part | Stretch]
) -> Grade:
    """Return the tension along a rope, see `Gravity`."""
    station = stations_at(rope.length, places(parts))
    spans = len(station) - 1
    along = pulls(gravity)
    if along == 0.0:
        return Grade(station, *np.full((2, spans), tension.mean))
    local, which = ropes(rope, stretches(parts), station)
    density = np.array([one.linear_density for one in local])[which]
    return graded(station, density, along, tension=tension, parts=parts)


def graded(
    station: Any, density: Any, along: Any, *, tension: Tension, parts: Sequence[Part | Stretch]
) -> Grade:
    """Return the tension between stations, of any kind of number, by the pull per mass."""
    stands, mass = standing(parts), np.zeros_like(station)
    np.add.at(mass, nearest(station, places(stands)), [getattr(p, "mass", 0.0) for p in stands])
    rise = along * density * np.diff(station)
    left = np.cumsum(along * mass[:-1] + np.append(0.0, rise[:-1]))
    own = Grade(station, left, left + rise)
    missing = tension.mean - own.at(place_of(tension, station[-1]))
    ends = np.stack([left, left + rise]) + missing
    return Grade(station, *np.where(np.abs(ends) <= ROUNDING * np.abs(ends).max(), 0.0, ends))


def grade_rate(scene: Described, path: str) -> Grade | None:
    """Return the derivative of the tension by a number that it is linear in, None if it is not."""
    rope, gravity, parts = scene.rope, scene.gravity, list(scene.parts)
    tension = scene.tension if isinstance(scene.tension, Tension) else Tension(scene.tension)
    of, _, name = path.rpartition(".")
    owner: Any = parts[int(of[6:-1])] if of.startswith("parts") else gravity if of else rope
    if path == "tension":
        return Grade(scene.grade.station, *np.ones((2, len(scene.grade.left))))
    if of.startswith("ends") or name not in WEIGHING:
        return None
    assert gravity is not None
    if name == "inclination":
        level = np.full((2, len(scene.grade.left)), tension.mean)
        turned = 1 / math.tan(gravity.inclination)
        return scene.grade.less(Grade(scene.grade.station, *level), turned)
    value = getattr(owner, name)
    step = value or 1.0
    more = dataclasses.replace(owner, **{name: value + step})
    if owner is rope:
        rope = more
    elif owner is gravity:
        gravity = more
    else:
        parts[int(of[6:-1])] = more
    return grade(rope, tension, gravity, parts).less(scene.grade, 1 / step)


def refuse_slack(along: Grade, pulsating: float, free: tuple[bool, bool]) -> None:
    """Refuse a slack string, and one without tension but at a free end with nothing on it."""
    least = np.minimum(along.left, along.right) - pulsating
    worst = int(least.argmin())
    place = along.station[worst + int(along.right[worst] < along.left[worst])]
    if least[worst] < 0:
        raise SceneError(
            "tension must be >= 0 all along a rope without bending_stiffness [N], got "
            f"{least[worst]:g} at {place:g} m: it is slack there"
        )
    loose = (along.left[0] == 0 and free[0], along.right[-1] == 0 and free[1])
    slack = np.minimum(along.left, along.right) == 0
    slack[0] &= not loose[0]
    slack[-1] &= not loose[1]
    if slack.any():
        raise SceneError(
            "tension must be > 0 along a rope without bending_stiffness but at a free end with "
            f"nothing on it [N], got 0 at {place:g} m"
        )
    ends = np.concatenate([along.left, along.right])
    if ends[ends > 0].min() < LEAST * ends.max():
        raise SceneError(
            f"tension must be 0 at a free end or at least {LEAST:g} of its largest all along a "
            f"rope without bending_stiffness [N], got {ends[ends > 0].min():g} and {ends.max():g}"
        )
