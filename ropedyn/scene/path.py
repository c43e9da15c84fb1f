"""Numbers of a scene by their paths, such as "tension" or "parts[0].mass"."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping
from numbers import Real
from typing import Any, NamedTuple

from ..base import check
from ..base.errors import SceneError
from ..base.parameter import Parameter, parameters
from . import damping
from .end import STANDING, End, end_of
from .gravity import Gravity
from .parts import part
from .rope import Rope
from .scene import Scene
from .tension import Tension

_PATH = re.compile(
    r"(?:(?P<one>tension|gravity|damping)|(?P<many>parts|damping)\[(?P<at>\d+)\]"
    rf"|ends\[(?P<end>[01])\]\.(?P<kind>{'|'.join(STANDING)}))\.(?P<name>[^.]+)"
)

_ENTRY = re.compile(r"(.*?)(?:\[([01])\])?")  # a number, or one of a pair for the planes of z and y


class _Place(NamedTuple):
    """Where a number is: in what of a scene, in which one of several, and its name there."""

    of: str
    name: str
    at: int | None = None
    kind: str = ""  # of what stands at an end; then the name is a coordinate
    entry: int | None = None  # which number of a pair


def _place(path: str) -> _Place:
    """Take a path apart; what leads nowhere else leads to the rope."""
    check.instance(path, "path", str, 'a string such as "tension"')
    if path == "tension":
        return _Place("tension", "mean")
    found = _PATH.fullmatch(path)
    own = _ENTRY.fullmatch(path.rsplit(".", 1)[-1] if found is None else found["name"])
    assert own is not None
    name, entry = own[1], None if own[2] is None else int(own[2])
    if found is None:
        return _Place("rope", name, entry=entry)
    if found["end"]:
        return _Place("ends", name, int(found["end"]), found["kind"], entry)
    at = int(found["at"]) if found["many"] else None
    return _Place(found["one"] or found["many"], name, at, entry=entry)


def value_at(scene: Scene, path: str) -> float:
    """Return a number of a scene: of the rope without a prefix, such as "bending_stiffness"."""
    place = _place(path)
    owner = _owner(scene, place, path)
    if place.kind:
        value = getattr(owner, place.kind).get(place.name)
    else:
        value = getattr(owner, place.name, None)
    if value is None:
        raise _absent(path, "the scene has none")
    if place.entry is not None:
        if not isinstance(value, tuple):
            raise _absent(path, f"there is one number, {check.shown(value)}")
        value = value[place.entry]
    if isinstance(value, bool) or not isinstance(value, Real):
        raise _absent(path, f"there is {check.shown(value)}")
    return float(value)


def with_values(scene: Scene, values: Mapping[str, float]) -> Scene:
    """Return a scene with other numbers, by their paths."""
    changes: dict[tuple[str, int], dict[str, Any]] = {}
    for path, value in values.items():
        value_at(scene, path)
        place = _place(path)
        change = changes.setdefault((place.of, place.at or 0), {})
        if place.kind:
            beside = change.get(place.kind, getattr(_owner(scene, place, path), place.kind))
            change[place.kind] = {**beside, place.name: value}
        elif place.entry is not None:
            pair = list(change.get(place.name, getattr(_owner(scene, place, path), place.name)))
            pair[place.entry] = value
            change[place.name] = tuple(pair)
        else:
            change[place.name] = value
    kept: dict[str, list[Any]] = {}
    for (of, at), change in changes.items():
        many = kept.setdefault(of, list(scene.ends if of == "ends" else _all(scene, of)))
        many[at] = dataclasses.replace(_all(scene, of)[at], **change)
    alone = ("rope", "tension", "gravity")
    whole = {of: many[0] if of in alone else tuple(many) for of, many in kept.items()}
    return scene.replace(**whole) if whole else scene


def unit_of(path: str) -> str:
    """Return the unit of the number at a path, all that it can have where the path does not tell.

    >>> unit_of("bending_stiffness"), unit_of("ends[0].spring.beta"), unit_of("damping.eta")
    ('N m^2', 'N m', '')
    """
    place = _place(path)
    if place.kind:
        return parameters(End)[place.kind].unit_on(place.name)
    units = dict.fromkeys(unit for one in _declared(place) for unit in one.units())
    return " or ".join(unit or "1" for unit in units) if len(units) > 1 else "".join(units)


def signs_of(path: str) -> set[str]:
    """Return the signs that are asked of the number at a path, one for each thing that has it.

    >>> signs_of("bending_stiffness"), signs_of("ends[0].spring.beta"), signs_of("tension")
    ({'positive'}, {'nonzero'}, {'any'})
    """
    place = _place(path)
    declared = [parameters(End)[place.kind]] if place.kind else _declared(place)
    return {one.sign for one in declared}


def _declared(place: _Place) -> list[Parameter]:
    """Return what is declared of a number of this name, one for each kind of thing that has it."""
    kinds = {"damping": damping.KINDS, "parts": part.KINDS}
    alone = {"tension": Tension, "gravity": Gravity, "rope": Rope}
    among = (parameters(kind) for kind in kinds.get(place.of) or (alone[place.of],))
    return [declared[place.name] for declared in among if place.name in declared]


def _owner(scene: Scene, place: _Place, path: str) -> Any:
    """Return what has the number, None where there is no such thing."""
    many = _all(scene, place.of)
    if place.at is None:
        return many[0] if len(many) == 1 else None
    if place.at >= len(many):
        raise _absent(path, f"there are {len(many)} {place.of}")
    return many[place.at]


def _all(scene: Scene, of: str) -> tuple[Any, ...]:
    if of == "tension":
        tension = scene.tension
        return (tension if isinstance(tension, Tension) else Tension(tension),)
    if of == "ends":
        return tuple(map(end_of, scene.ends))
    return (
        scene.dampings
        if of == "damping"
        else scene.parts
        if of == "parts"
        else (getattr(scene, of),)
    )


def _absent(path: str, why: str) -> SceneError:
    return SceneError(
        'path must be that of a number of the scene, such as "tension", "bending_stiffness", '
        f'"parts[0].mass", "ends[0].spring.beta" or "damping.gamma", got {path!r}: {why}'
    )
