"""A scene with a rope on an axis as pieces with what stands at their ends."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..scene import damping
from ..scene.end import End, end_of
from ..scene.rope import in_plane
from ..scene.scene import Scene
from .pieces import SpaceSection, rope_of
from .rope import SIX, SpaceRope


def section_of(scene: Scene) -> SpaceSection:
    """Return what the rope is made of."""
    rope = scene.rope
    assert rope.torsional_stiffness is not None

    def both(value: Any) -> tuple[float, float]:
        return in_plane(value, 0), in_plane(value, 1)

    return SpaceSection(
        bending=both(rope.bending_stiffness),
        torsion=rope.torsional_stiffness,
        density=rope.linear_density,
        axial=rope.axial_stiffness,
        shear=rope.shear_stiffness,
        coupling=rope.lay_coupling or 0.0,
        slope=rope.lay_slope or 0.0,
        rotary=both(rope.rotary_inertia or 0.0),
        polar=rope.polar_inertia or 0.0,
    )


def rope_of_scene(scene: Scene) -> SpaceRope:
    """Return the pieces, with ends and drag."""
    axis = scene.rope.axis
    assert axis is not None
    bent = scene.rope.natural == "straight"
    rope = rope_of(axis, section_of(scene), scene.mean_tension, bent=bent)
    drag = damping.drag(scene.dampings)
    rope.drag[:] = np.diag([drag] * 3 + [0.0] * 3)
    for node, end in zip((0, -1), scene.ends):
        stand = end_of(end)
        rope.held[node] = [stand.holds(c) for c in SIX]
        for array, what in zip((rope.springs, rope.masses, rope.dashpots), _standing(stand)):
            array[node] = np.diag(what)
    return rope


def _standing(end: End) -> list[list[float]]:
    return [[what.get(c, 0.0) for c in SIX] for what in (end.spring, end.mass, end.dashpot)]
