"""Where users push and look, checked against a model."""

from __future__ import annotations

from typing import Any

from . import check
from .errors import SceneError
from .model import Model
from .part import BrokenWire
from .port import Point
from .unit import END


def points(
    model: Model, given: Any, name: str, *, forces: bool = True, ends: bool = False
) -> tuple[tuple[Point, ...], bool]:
    """Return one or several points, and whether a list of them was given.

    Parameters
    ----------
    model : Model
        That is asked.
    given : object
        What the user gave.
    name : str
        For messages.
    forces : bool
        Whether internal forces and tips of wires are allowed.
    ends : bool
        Whether the motion of an end is, such as ("end", 0, "z").
    """
    several = isinstance(given, (list, tuple)) and len(given) > 0 and not isinstance(given[0], str)
    length = model.scene.rope.length
    wires = sum(isinstance(part, BrokenWire) for part in model.scene.parts)
    found = []
    for k, one in enumerate(given if several else (given,)):
        called = f"{name}[{k}]" if several else name
        if ends and isinstance(one, (tuple, list)) and len(one) > 0 and one[0] == END:
            found.append(_end(model, one, called))
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
    return tuple(found), several


def _end(model: Model, given: Any, name: str) -> Any:
    """Return an end that is moved: it must hold the coordinate."""
    from .end import end_of

    what = 'an end and a coordinate such as ("end", 0, "z")'
    if len(given) != 3:
        raise SceneError(f"{name} must be {what}, got {check.shown(given)}")
    number = check.count(given[1], f"{name}[1]", least=0, most=1)
    coordinate = check.one_of(given[2], f"{name}[2]", model.coordinates)
    if coordinate not in end_of(model.scene.ends[number]).term().held:
        raise SceneError(
            f"{name} must be a coordinate that the end holds, got {coordinate!r} of "
            f"{check.shown(model.scene.ends[number])}"
        )
    return (END, number, coordinate)
