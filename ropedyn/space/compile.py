"""A scene with a rope on an axis as pieces with what stands at their ends."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..axis.axis import Axis
from ..scene import damping
from ..scene.end import End, end_of
from ..scene.rope import in_plane
from ..scene.scene import Scene
from ..scene.weight import hanging
from .pieces import FINER, FOLLOWED, Rest, SpaceSection, rope_of
from .rope import SIX, SpaceRope


def section_of(scene: Scene) -> SpaceSection:
    """Return what the rope is made of."""
    rope = scene.rope

    def both(value: Any) -> tuple[float, float]:
        return in_plane(value, 0), in_plane(value, 1)

    turned = rope.principal_angle or 0.0
    return SpaceSection(
        bending=None if rope.bending_stiffness is None else both(rope.bending_stiffness),
        torsion=rope.torsional_stiffness,
        density=rope.linear_density,
        axial=rope.axial_stiffness,
        shear=rope.shear_stiffness,
        coupling=rope.lay_coupling or 0.0,
        slope=rope.lay_slope or 0.0,
        rotary=both(rope.rotary_inertia or 0.0),
        polar=rope.polar_inertia or 0.0,
        angle=turned if isinstance(turned, tuple) else ((0.0,), (turned,)),
    )


def rest_of(scene: Scene) -> Rest:
    """Return the state about which the rope moves."""
    hangs = hanging(scene.rope, scene.gravity)
    weight = 0.0 if hangs is None or scene.gravity is None else scene.gravity.g
    return Rest(
        tension=scene.mean_tension,
        weight=weight * scene.rope.linear_density,
        torque=scene.torque,
        bent=scene.rope.natural == "straight",
    )


def rope_of_scene(scene: Scene, *, followed: float = FOLLOWED) -> SpaceRope:
    """Return the pieces, with ends and drag."""
    axis = scene.rope.axis or Axis.line(scene.rope.length)
    absent = tuple(c for c in SIX if c not in scene.coordinates)
    rope = rope_of(axis, section_of(scene), rest_of(scene), absent, followed=followed)
    drag = damping.drag(scene.dampings)
    rope.drag[:] = np.diag([drag] * 3 + [0.0] * 3)
    for node, end in zip((0, -1), scene.ends):
        stand = end_of(end)
        rope.held[node] |= [stand.holds(c) for c in SIX]
        for array, what in zip((rope.springs, rope.masses, rope.dashpots), _standing(stand)):
            array[node] = np.diag(what)
    return rope


def finer_rope(scene: Scene, rope: SpaceRope) -> SpaceRope | None:
    """Return one of shorter pieces, None where the pieces are exact."""
    return rope_of_scene(scene, followed=FINER) if rope.changes else None


def _standing(end: End) -> list[list[float]]:
    return [[what.get(c, 0.0) for c in SIX] for what in (end.spring, end.mass, end.dashpot)]
