"""Where users push and look, checked against a model."""

from __future__ import annotations

from typing import Any

from ..base import check
from ..base.errors import SceneError
from ..scene.end import end_of
from ..scene.parts.broken_wire import BrokenWire
from ..scene.scene import Scene
from .compiled import Compiled
from .port import Point


def points(
    model: Compiled, given: Any, name: str, *, forces: bool = True, ends: bool = False
) -> tuple[tuple[Point, ...], bool]:
    """Return one or several points, and whether a list of them was given."""
    several = isinstance(given, (list, tuple)) and len(given) > 0 and not isinstance(given[0], str)
    length = model.scene.rope.length
    wires = sum(isinstance(part, BrokenWire) for part in model.scene.parts)
    found = []
    for k, one in enumerate(given if several else (given,)):
        called = f"{name}[{k}]" if several else name
        if ends and check.is_end(one):
            found.append(moved_end(model.scene, one, called))
            continue
        found.append(
            check.point(
                one,
                called,
                model.coordinates,
                length,
                forces=forces,
                wires=wires if forces else None,
            )
        )
    if not forces:
        for point in found:
            refuse_slack(model, point, name)
    return tuple(found), several


def refuse_slack(model: Compiled, point: Point, name: str) -> None:
    """Refuse a force where a string has no tension: it would have no bounds to move within."""
    along, coordinates = model.scene.grade, model.coordinates
    if point[0] != "z" or "beta" in coordinates or model.chain.rise is None:
        return
    for at, tension in ((0.0, along.left[0]), (model.scene.rope.length, along.right[-1])):
        if tension == 0 and abs(point[1] - at) <= check.NEAR * model.scene.rope.length:
            raise SceneError(
                f"{name} must not be where a rope without bending_stiffness has no tension, got "
                f"{point}"
            )


def moved_end(scene: Scene, given: Any, name: str) -> Any:
    """Return an end that is moved: it must hold the coordinate."""
    _, number, coordinate = found = check.end(given, name, scene.coordinates)
    if coordinate not in end_of(scene.ends[number]).term().held:
        raise SceneError(
            f"{name} must be a coordinate that the end holds, got {coordinate!r} of "
            f"{check.shown(scene.ends[number])}"
        )
    return found


def observed(model: Compiled, given: Any, drives: tuple[Point, ...]) -> tuple[Point, ...]:
    """Return what is watched: the drives where nothing else is said."""
    if given is not None:
        return points(model, given, "response")[0]
    if not drives or any(map(check.is_end, drives)):
        what = "an end is moved" if drives else "nothing drives"
        raise SceneError(f"response must be given where {what}, got None")
    return drives
