"""The scene that never had some of its effects."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

from . import end as _end
from .end import End
from .gravity import Gravity
from .parts.node import Part
from .parts.stretch import Stretch, changeable
from .tension import Tension

if TYPE_CHECKING:
    from .scene import Scene

_PROPERTIES = {
    "bending": ("bending_stiffness", "lay_slope", "rotary_inertia"),
    "twist": ("torsional_stiffness", "lay_coupling", "lay_slope", "polar_inertia"),
    "stretch": ("axial_stiffness", "lay_coupling"),
    "lay": ("lay_coupling", "lay_slope"),
    "rotary inertia": ("rotary_inertia",),
    "polar inertia": ("polar_inertia",),
}
"""What a rope never had that never had one of these effects."""

_WEIGHTLESS = {"tension", "stretch", Gravity.kind}  # Without one of these effects there is no sag.


def without(scene: Scene, effects: tuple[str, ...]) -> Scene:
    """Return a scene without effects, and without what stood on coordinates that go with them."""
    gone = {name for effect in effects for name in _PROPERTIES.get(effect, ())}
    rope = scene.rope.replace(**dict.fromkeys(gone))
    tension = _left_of_tension(scene.tension, effects)
    mean = tension.mean if isinstance(tension, Tension) else tension
    bare = type(scene)(rope, tension=mean)
    kept = tuple(d for d in scene.dampings if d.kind not in effects)
    return bare.replace(
        tension=tension,
        ends=tuple(_thinned(end, bare.coordinates, effects) for end in scene.ends),
        damping=kept,
        gravity=None if _WEIGHTLESS & set(effects) else scene.gravity,
        parts=tuple(
            left
            for part in scene.parts
            if part.kind not in effects and (left := _left_of(part, bare)) is not None
        ),
    )


def _left_of_tension(tension: float | Tension, effects: tuple[str, ...]) -> float | Tension:
    """Return the tension of a scene that never had these effects."""
    if "tension" in effects:
        return 0.0
    if not isinstance(tension, Tension):
        return tension
    if Tension.pulsating in effects:
        tension = dataclasses.replace(tension, amplitude=0.0, frequency=0.0, phase=0.0)
    if {Tension.growing, "stretch"} & set(effects):
        tension = dataclasses.replace(tension, stretching=False)
    return tension.mean if tension.is_constant else tension


def _left_of(part: Part | Stretch, bare: Scene) -> Part | Stretch | None:
    """Return what is left of a part in a scene with less, None where nothing is."""
    if isinstance(part, Stretch):
        return part.on(changeable(bare.rope, bare.coordinates))
    return part if set(part.stands_on) <= set(bare.coordinates) else None


def _thinned(end: str | End, present: tuple[str, ...], effects: tuple[str, ...]) -> str | End:
    """Return an end without what goes with coordinates or with the effect itself."""
    if isinstance(end, str):
        return end
    kept: dict[str, Any] = {}
    for name, values in end.standing.items():
        gone = _end.STANDING[name] in effects
        kept[name] = {c: v for c, v in values.items() if c in present and not gone}
    return dataclasses.replace(end, **kept)
