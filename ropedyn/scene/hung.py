"""A rope that hangs between its ends: on the catenary of its weight, and how far a parabola is."""

from __future__ import annotations

import dataclasses
import math
from typing import TYPE_CHECKING, Any

import numpy as np

from ..axis.axis import Axis
from ..axis.catenary import catenaries, checked_loads, upward
from ..base.check import shown
from ..base.errors import SceneError
from .end import end_of
from .gravity import Gravity
from .parts.part import places, standing, stretches
from .parts.stretch import ropes
from .rope import Rope, own_number
from .stations import stations_at
from .tension import Tension
from .weight import place_of

if TYPE_CHECKING:
    from .described import Described
    from .scene import Scene

PARABOLA = 1e-3
"""Of a frequency: where a parabola may be further off, a rope is solved on its catenary."""
SHALLOW = 5.6
"""Times the square of sag over chord: by so much of a frequency a parabola is off at most."""
LOADED = 3.5
"""Times the share that other weights have of the rope's, where the rope hardly stretches."""
STIFFENED = 12.0  # A sag parameter that doubles the square of the first frequency.
ALONG = 0.8
"""Of the first frequency along the rope, of which a parabola knows nothing."""
DEEPEST = 3.0
"""Half the span over the parameter, H/w: a level rope hangs 1.5 times its span low then."""


def parabola_error(scene: Described) -> float:
    """Bound what a parabola changes of any frequency below those along the rope, relative."""
    # what own_weight=False leaves out by name is not in it. High modes are those of the arc and of
    # its tension, 4/3 of the square of the sag over the chord; the first symmetric one, where the
    # rope hardly stretches, is 5.2 of it off. Weights beside the rope's own bend it elsewhere
    gravity, rope, tension = scene.gravity, scene.rope, scene.mean_tension
    assert gravity is not None
    sag = gravity.curvature(rope, tension) * rope.length / 8
    error = SHALLOW * sag * sag
    if scene.parts:
        parameter = gravity.sag_parameter(rope, tension)
        error += LOADED * _other_weight(scene) * parameter / (STIFFENED + parameter)
    return error


def _other_weight(scene: Described) -> float:
    """Return what stands on a rope and what it weighs more or less, as a share of its weight."""
    rope, parts = scene.rope, scene.parts
    station = stations_at(rope.length, places(parts))
    local, which = ropes(rope, stretches(parts), station)
    density = np.array([one.linear_density for one in local])[which]
    other = np.abs(density - rope.linear_density) @ np.diff(station)
    inside = (part for part in standing(parts) if 0 < part.x < rope.length)
    other += sum(getattr(part, "mass", 0.0) for part in inside)
    return float(other / (rope.linear_density * rope.length))


def highest(scene: Described) -> float:
    """Return the frequency up to which a rope moves along itself without inertia [Hz]."""
    rope = scene.rope
    assert rope.axial_stiffness is not None
    held = sum("x" in end_of(end).term().held for end in scene.ends)
    waves = math.sqrt(rope.axial_stiffness / rope.linear_density) / rope.length
    return ALONG * waves * (0.5 if held == 2 else 0.25)


def catenary_scene(scene: Scene) -> Scene:
    """Return the same rope on the catenary of its weight; see `Scene.on_catenary`."""
    gravity, rope = scene.gravity, scene.rope
    if gravity is None or not scene.sags:
        raise SceneError(f"gravity must curve the rope for a catenary, got {shown(gravity)}")
    if gravity.inclination != 0 and not gravity.own_weight:
        raise SceneError(
            "own_weight must be True of an inclined rope on its catenary, along which the tension "
            "grows, got False"
        )
    if not gravity.g > 0:
        raise SceneError(f"g must be > 0 of a rope on its catenary, got {gravity.g!r} m/s^2")
    _refuse_beside(scene)
    loads = _loads_of(scene)
    axis = _axis_of(scene, gravity, loads)
    longer = axis.length / rope.length
    stands: list[Any] = standing(scene.parts)
    parts = [dataclasses.replace(part, x=longer * part.x) for part in stands]
    return scene.replace(
        rope=_rope_on(rope, axis, bool(loads)), tension=0.0, gravity=Gravity(gravity.g), parts=parts
    )


CARRIED = ("point mass", "spring", "dashpot", "support")
"""Kinds of parts that leave a catenary what it is, but for kinks where they weigh."""


def _refuse_beside(scene: Described) -> None:
    """Refuse what makes another curve of it, or what is not carried along one."""
    rope, where = scene.rope, "of a rope on its catenary"
    for i, part in enumerate(scene.parts):
        if part.kind not in CARRIED and getattr(part, "mass", None) != 0:
            raise SceneError(
                f"parts[{i}] must be one of {', '.join(CARRIED)} {where}, got {part.kind}"
            )
    if rope.lay_coupling or rope.lay_slope:
        raise SceneError(f"lay_coupling and lay_slope must be left out {where}, which it twists")
    bends = rope.bending_stiffness is not None
    if rope.torsional_stiffness is not None and not (bends and scene.planes == "both"):
        raise SceneError(
            f'torsional_stiffness needs bending_stiffness and planes="both" {where}, whose twist '
            f"goes with the plane of y, got {rope.torsional_stiffness!r}"
        )
    tension = scene.tension
    if isinstance(tension, Tension) and not tension.is_constant:
        raise SceneError(f"tension must be constant {where}, got {shown(tension)}")


def _loads_of(scene: Described) -> list[tuple[float, float]]:
    """Return where a rope carries weights, as shares of its length, and their lengths of it [m]."""
    rope = scene.rope
    stands: list[Any] = standing(scene.parts)
    return [
        (part.x / rope.length, part.mass / rope.linear_density)
        for part in stands
        if getattr(part, "mass", 0.0) > 0 and 0 < part.x < rope.length
    ]


def _rope_on(rope: Rope, axis: Axis, kinks: bool) -> Rope:
    """Return a rope on an axis: one that says nothing of twist has that of a wire that is bent."""
    bending = own_number(rope, "bending_stiffness")
    own: dict[str, Any] = {"length": axis.length, "axis": axis}
    if bending is not None and rope.torsional_stiffness is None:
        own["torsional_stiffness"] = bending
    if isinstance(rope.bending_stiffness, tuple) or (kinks and bending is not None):
        own["natural"] = "axis"
    return dataclasses.replace(rope, **own)


def _axis_of(scene: Described, gravity: Gravity, loads: list[tuple[float, float]]) -> Axis:
    """Find the catenary whose tension along the chord is the scene's where that is known."""
    # of the parameter c = span/2d; its tension is w (c, u) in the level and upwards
    from scipy.optimize import brentq

    length = scene.rope.length
    tension = scene.tension if isinstance(scene.tension, Tension) else Tension(scene.tension)
    share = place_of(tension, length) / length
    height = tension.mean / (scene.rope.linear_density * gravity.g)
    cos, sin = math.cos(gravity.inclination), math.sin(gravity.inclination)
    span, rise, carried = length * cos, length * sin, checked_loads(loads)

    def missed(d: float) -> float:
        c = span / (2 * d)
        return cos * c + sin * upward(catenaries(span, rise, c, carried), share) - height

    low = length / (4 * (abs(height) + length + sum(load for _, load in loads)))
    high = 1.25 * low
    while high < DEEPEST and missed(high) > 0:
        low, high = high, 1.25 * high
    if not high < DEEPEST:
        raise SceneError(
            f"tension must be more for a rope to hang between its ends [N], got {tension.mean!r} "
            f"N of one that weighs {scene.rope.linear_density * gravity.g * length:g} N"
        )
    d = float(brentq(missed, low, high, xtol=1e-300, rtol=4 * np.finfo(float).eps))
    return Axis.catenary(span, rise, parameter=span / (2 * d), loads=loads)
