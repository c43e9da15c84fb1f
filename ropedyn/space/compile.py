"""A scene with a rope on an axis as pieces with what stands at their ends."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np

from ..axis.axis import Axis
from ..base import check
from ..base.errors import SceneError
from ..scene import damping
from ..scene.end import end_of
from ..scene.parts import part as _part
from ..scene.parts.broken_wire import BrokenWire
from ..scene.rope import in_plane
from ..scene.scene import Scene
from ..scene.weight import angle_of, hanging, rubbing
from .pieces import FINER, FOLLOWED, Rest, SpaceSection, cross, kink_of, rope_of
from .rope import SIGN, SIX, Carried, SpaceRope
from .wire import wound_wire


def resting(scene: Scene) -> Scene:
    """Return the scene about whose axis it moves: of a rope that its weight curves a catenary."""
    return scene.on_catenary() if scene.sags else scene


def axis_of(scene: Scene) -> Axis:
    """Return the axis of a scene, a line where it has none."""
    return resting(scene).rope.axis or Axis.line(scene.rope.length)


def method_of(scene: Scene) -> str:
    """Return how answers are found, and on what where it is not what the scene says."""
    return "sweep on the catenary" if scene.sags else "sweep"


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
    rubs = rubbing(scene.rope, scene.tension)
    return Rest(
        tension=rubs.mean if rubs else scene.mean_tension,
        friction=rubs.friction if rubs else 0.0,
        ahead=angle_of(scene.rope, rubs) if rubs else 0.0,
        axial=scene.axial_force,
        weight=weight * scene.rope.linear_density,
        torque=scene.torque,
        bent=scene.rope.natural == "straight",
    )


def rope_of_scene(scene: Scene, *, followed: float = FOLLOWED) -> SpaceRope:
    """Return the pieces, with ends and drag."""
    chord, scene = scene.rope.length, resting(scene)
    axis = axis_of(scene)
    absent = tuple(c for c in SIX if c not in scene.coordinates)
    rope = rope_of(axis, section_of(scene), rest_of(scene), absent, followed=followed)
    drag = damping.drag(scene.dampings)
    rope.drag[:] = np.diag([drag] * 3 + [0.0] * 3)
    rope = replace(rope, closed=axis.closed)
    for node, end in zip((0, -1), () if axis.closed else scene.ends):
        stand = end_of(end)
        rope.held[node] |= [stand.holds(c) for c in SIX]
        given = stand.spring, stand.mass, stand.dashpot
        for array, what in zip((rope.springs, rope.masses, rope.dashpots), given):
            array[node] = np.diag([what.get(c, 0.0) for c in SIX])
    return _with_parts(replace(rope, longer=scene.rope.length / chord), scene)


def _with_parts(rope: SpaceRope, scene: Scene) -> SpaceRope:
    """Return it with nodes at its parts, and these on them."""
    parts = _part.standing(scene.parts)
    if not parts:
        return rope
    places = np.array([part.x for part in parts])
    rope, node = rope.cut(places, check.NEAR * scene.rope.length)
    carried = []
    for part, at in zip(parts, node):
        if isinstance(part, BrokenWire):
            if rope.held[at].all():
                raise SceneError(f"the root of a broken wire must be able to move at {part.x!r} m")
            carried.append(carried_wire(part, int(at)))
            continue
        term = part.term()
        rope.held[at] |= [c in term.held for c in SIX]
        for array, what in (
            (rope.springs, term.stiffness),
            (rope.masses, term.mass),
            (rope.dashpots, term.damping),
        ):
            array[at] += np.diag([what.get(c, 0.0) for c in SIX])
    return replace(rope, carried=tuple(carried))


def carried_wire(wire: BrokenWire, node: int) -> Carried:
    """Return a wound wire on its node: its root's frame is that of its helix there."""
    alone = wound_wire(wire)
    rope, axis = rope_of_scene(alone), axis_of(alone)
    angle = wire.angle + (math.pi if wire.radius < 0 else 0.0)
    radius, sign = abs(wire.radius), 1.0 if wire.sense == "Z" else -1.0
    outward = np.array([0.0, math.cos(angle), math.sin(angle)])
    around = np.array([0.0, -math.sin(angle), math.cos(angle)])
    tau, kz, _ = axis.rates(0.0)
    # kz = cos^2 p/R and tau = +-sin p cos p/R of the pitch angle p
    along = np.array([abs(tau), 0.0, 0.0]) + sign * kz * around
    along /= np.linalg.norm(along)
    frame = np.stack([along, np.cross(-outward, along), -outward], axis=1)
    lever = np.eye(6)
    lever[:3, 3:] = -cross(radius * outward)
    arm = kink_of(frame.T) @ SIGN @ lever @ SIGN
    aim = np.zeros(6)
    aim[:3] = (frame @ axis.frame(axis.length))[2]
    return Carried(node, arm, aim, rope, 2 * wire.damping_ratio)


def finer_rope(scene: Scene, rope: SpaceRope) -> SpaceRope | None:
    """Return one of shorter pieces, None where the pieces are exact."""
    return rope_of_scene(scene, followed=FINER) if rope.changes else None
