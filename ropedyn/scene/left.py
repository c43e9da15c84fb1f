"""What is left of a scene that never had some of its effects."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

from ..base.check import COORDINATES
from ..base.unit import ROLE
from .checked import checked_tension
from .damping import WireFriction
from .end import STANDING, End
from .gravity import Gravity
from .parts.broken_wire import BrokenWire
from .parts.node import Part
from .parts.stretch import Stretch, changeable
from .rope import ACROSS, Rope, own_number
from .tension import Tension
from .weight import curves, hanging, pulls

if TYPE_CHECKING:
    from .described import Described

PROPERTIES = {
    "bending": ("bending_stiffness", "lay_slope", "rotary_inertia"),
    "twist": ("torsional_stiffness", "lay_coupling", "lay_slope", "polar_inertia"),
    "stretch": ("axial_stiffness", "lay_coupling"),
    "lay": ("lay_coupling", "lay_slope"),
    "rotary inertia": ("rotary_inertia",),
    "polar inertia": ("polar_inertia",),
    "shear": ("shear_stiffness",),
    "axis": ("axis", "shear_stiffness"),
    "turned section": ("principal_angle",),
}
"""What a rope never had that never had one of these effects."""

SECOND_PLANE = "second plane"  # The effect that a scene moves in the plane of y too.


IN_PLANE = ("x", "z", "beta")
"""Coordinates of a plane curve in its plane."""


def coordinates_of(rope: Rope, mean_tension: float, planes: str) -> tuple[str, ...]:
    """Return the coordinates that a rope under a tension has."""
    bends = rope.bending_stiffness is not None
    if rope.axis is not None:
        own = COORDINATES if bends else COORDINATES[:3]
        # a catenary alone has a plane to move in
        return own if planes == "both" else tuple([c for c in own if c in IN_PLANE])
    present = {
        "x": rope.axial_stiffness is not None,
        "z": bends or mean_tension != 0,
        "alpha": rope.torsional_stiffness is not None,
        "beta": bends,
    }
    if planes == "both":
        present |= {c: present[role] for c, role in ROLE.items()}
    return tuple([c for c in COORDINATES if present.get(c, False)])


def left_of(scene: Described, effects: tuple[str, ...]) -> dict[str, Any]:
    """Return the arguments of a scene that never had these effects."""
    rope, tension = _rope(scene.rope, effects), _tension(scene.tension, effects)
    gravity = _gravity(scene.gravity, rope, effects)
    planes = "z" if SECOND_PLANE in effects else scene.planes
    mean = tension.mean if isinstance(tension, Tension) else tension
    if pulls(gravity):
        mean = scene.mean_tension
    present = coordinates_of(rope, mean, planes)
    unbent = set() if "beta" in present else {WireFriction.kind}
    left = (_part(part, rope, present) for part in scene.parts if part.kind not in effects)
    return {
        "rope": rope,
        "tension": tension,
        "ends": tuple(_end(end, present, effects) for end in scene.ends),
        "damping": tuple(d for d in scene.dampings if d.kind not in {*effects, *unbent}),
        "gravity": gravity,
        "parts": tuple(part for part in left if part is not None),
        "planes": planes,
        "torque": 0.0 if "initial moment" in effects else scene.torque,
        "axial_force": 0.0 if {"tension", "initial moment"} & {*effects} else scene.axial_force,
    }


def _rope(rope: Rope, effects: tuple[str, ...]) -> Rope:
    """Return the rope without properties that go with these effects."""
    pairs = [name for name in ACROSS if isinstance(getattr(rope, name), tuple)]
    alike = pairs if SECOND_PLANE in effects else []
    kept: dict[str, Any] = {name: own_number(rope, name) for name in alike}
    gone = {name for effect in effects for name in PROPERTIES.get(effect, ())}
    if {"axis", "initial moment"} & {*effects}:
        kept["natural"] = "axis"
    return rope.replace(**(kept | dict.fromkeys(gone)))


def _gravity(gravity: Gravity | None, rope: Rope, effects: tuple[str, ...]) -> Gravity | None:
    """Return the gravity of a scene that never had these effects."""
    if gravity is None or "tension" in effects:
        return None
    if Gravity.kind in effects:
        gravity = dataclasses.replace(gravity, sag=False)
    if Gravity.grading in effects:
        gravity = dataclasses.replace(gravity, own_weight=False)
    return gravity if curves(gravity, rope) or pulls(gravity) or hanging(rope, gravity) else None


def _tension(tension: float | Tension, effects: tuple[str, ...]) -> float | Tension:
    """Return the tension of a scene that never had these effects."""
    if "tension" in effects:
        return 0.0
    if not isinstance(tension, Tension):
        return tension
    if "axis" in effects:
        tension = dataclasses.replace(tension, friction=0.0)
    if Tension.pulsating in effects:
        tension = dataclasses.replace(tension, amplitude=0.0, frequency=0.0, phase=0.0)
    if {Tension.growing, "stretch"} & set(effects):
        tension = dataclasses.replace(tension, stretching=False)
    return checked_tension(tension)


def _part(part: Part | Stretch, rope: Rope, present: tuple[str, ...]) -> Part | Stretch | None:
    """Return what is left of a part in a scene with less, None where nothing is."""
    if isinstance(part, Stretch):
        return part.on(changeable(rope, present))
    if isinstance(part, BrokenWire) and part.is_wound and "y" not in present:
        # in one plane a wire is a straight cantilever
        part = dataclasses.replace(part, lay_length=None)
    return part if set(part.stands_on) <= set(present) else None


def _end(end: str | End, present: tuple[str, ...], effects: tuple[str, ...]) -> str | End:
    """Return an end without what goes with coordinates or with the effect itself."""
    if isinstance(end, str):
        return end
    kept: dict[str, Any] = {}
    for name, values in end.standing.items():
        gone = STANDING[name] in effects
        kept[name] = {c: v for c, v in values.items() if c in present and not gone}
    return dataclasses.replace(end, **kept)
