"""What is left of the things of a scene that never had some effects."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

from .end import STANDING, End
from .parts.node import Part
from .parts.stretch import Stretch, changeable
from .rope import ACROSS, Rope, own_number
from .tension import Tension

if TYPE_CHECKING:
    from .scene import Scene

PROPERTIES = {
    "bending": ("bending_stiffness", "lay_slope", "rotary_inertia"),
    "twist": ("torsional_stiffness", "lay_coupling", "lay_slope", "polar_inertia"),
    "stretch": ("axial_stiffness", "lay_coupling"),
    "lay": ("lay_coupling", "lay_slope"),
    "rotary inertia": ("rotary_inertia",),
    "polar inertia": ("polar_inertia",),
}
"""What a rope never had that never had one of these effects."""

SECOND_PLANE = "second plane"  # The effect that a scene moves in the plane of y too.


def of_rope(rope: Rope, effects: tuple[str, ...]) -> Rope:
    """Return the rope without properties that go with these effects."""
    pairs = [name for name in ACROSS if isinstance(getattr(rope, name), tuple)]
    kept = {name: own_number(rope, name) for name in pairs if SECOND_PLANE in effects}
    gone = {name for effect in effects for name in PROPERTIES.get(effect, ())}
    return rope.replace(**(kept | dict.fromkeys(gone)))


def of_tension(tension: float | Tension, effects: tuple[str, ...]) -> float | Tension:
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


def of_part(part: Part | Stretch, bare: Scene) -> Part | Stretch | None:
    """Return what is left of a part in a scene with less, None where nothing is."""
    if isinstance(part, Stretch):
        return part.on(changeable(bare.rope, bare.coordinates))
    return part if set(part.stands_on) <= set(bare.coordinates) else None


def of_end(end: str | End, present: tuple[str, ...], effects: tuple[str, ...]) -> str | End:
    """Return an end without what goes with coordinates or with the effect itself."""
    if isinstance(end, str):
        return end
    kept: dict[str, Any] = {}
    for name, values in end.standing.items():
        gone = STANDING[name] in effects
        kept[name] = {c: v for c, v in values.items() if c in present and not gone}
    return dataclasses.replace(end, **kept)
