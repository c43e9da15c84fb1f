"""Numbers of a scene by their paths, such as "tension" or "parts[0].mass"."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Mapping
from numbers import Real
from typing import Any

from ..base import check
from ..base.errors import SceneError
from ..base.parameter import Description, parameters
from . import damping
from .end import STANDING, End, end_of
from .gravity import Gravity
from .parts import part
from .rope import Rope
from .scene import Scene
from .tension import Tension

_TENSION = re.compile(r"tension(?:\.(?P<number>\w+))?")
_GRAVITY = re.compile(r"gravity\.(?P<number>\w+)")
_LISTED = re.compile(r"(?P<list>parts|damping)\[(?P<at>\d+)\]\.(?P<number>\w+)")
_DAMPING = re.compile(r"damping\.(?P<number>\w+)")
_END = re.compile(rf"ends\[(?P<at>[01])\]\.(?P<kind>{'|'.join(STANDING)})\.(?P<coordinate>\w+)")


def value_at(scene: Scene, path: str) -> float:
    """Return a number of a scene: of the rope without a prefix, such as "bending_stiffness"."""
    return _number(_owner(scene, path), path)


def with_values(scene: Scene, values: Mapping[str, float]) -> Scene:
    """Return a scene with other numbers, by their paths."""
    for path, value in values.items():
        scene = _put(scene, path, value)
    return scene


def unit_of(path: str) -> str:
    """Return the unit of the number at a path, all that it can have where the path does not tell.

    >>> unit_of("bending_stiffness"), unit_of("ends[0].spring.beta"), unit_of("damping.eta")
    ('N m^2', 'N m', '')
    """
    if found := _END.fullmatch(path):
        return parameters(End)[found["kind"]].unit_on(found["coordinate"])
    declared = [parameters(kind).get(_name(path)) for kind in _owners(path)]
    units = dict.fromkeys(unit for one in declared if one for unit in one.units())
    return " or ".join(unit or "1" for unit in units) if len(units) > 1 else "".join(units)


def _owners(path: str) -> tuple[type[Description], ...]:
    """Return the kinds of what can have the number at a path, ends apart."""
    if found := _LISTED.fullmatch(path):
        return damping.KINDS if found["list"] == "damping" else part.KINDS
    if _DAMPING.fullmatch(path):
        return damping.KINDS
    if _TENSION.fullmatch(path):
        return (Tension,)
    return (Gravity,) if _GRAVITY.fullmatch(path) else (Rope,)


def _owner(scene: Scene, path: str) -> Any:
    """Return what has a number at the path as an attribute, or a mapping that has it as a key."""
    check.instance(path, "path", str, 'a string such as "tension"')
    if _TENSION.fullmatch(path):
        return _tension(scene)
    if found := _END.fullmatch(path):
        return getattr(end_of(scene.ends[int(found["at"])]), found["kind"])
    if found := _LISTED.fullmatch(path):
        many = scene.dampings if found["list"] == "damping" else scene.parts
        if int(found["at"]) >= len(many):
            raise _absent(path, f"there are {len(many)} {found['list']}")
        return many[int(found["at"])]
    if _DAMPING.fullmatch(path) and len(scene.dampings) == 1:
        return scene.dampings[0]
    if _GRAVITY.fullmatch(path):
        return scene.gravity
    return scene.rope


def _number(owner: Any, path: str) -> float:
    name = _name(path)
    value = owner.get(name) if isinstance(owner, Mapping) else getattr(owner, name, None)
    if value is None:
        raise _absent(path, "the scene has none")
    if isinstance(value, bool) or not isinstance(value, Real):
        raise _absent(path, f"there is {check.shown(value)}")
    return float(value)


def _name(path: str) -> str:
    if path == "tension":
        return "mean"
    return path.rsplit(".", 1)[-1]


def _absent(path: str, why: str) -> SceneError:
    return SceneError(
        'path must be that of a number of the scene, such as "tension", "bending_stiffness", '
        f'"parts[0].mass", "ends[0].spring.beta" or "damping.gamma", got {path!r}: {why}'
    )


def _tension(scene: Scene) -> Tension:
    return scene.tension if isinstance(scene.tension, Tension) else Tension(scene.tension)


def _put(scene: Scene, path: str, value: float) -> Scene:
    owner = _owner(scene, path)
    _number(owner, path)
    change: dict[str, Any] = {_name(path): value}
    if isinstance(owner, Mapping):
        return _put_at_end(scene, path, {**owner, **change})
    changed = dataclasses.replace(owner, **change)
    if isinstance(owner, Tension):
        plain = not isinstance(scene.tension, Tension) and "mean" in change
        return scene.replace(tension=value if plain else changed)
    if owner is scene.rope:
        return scene.replace(rope=changed)
    if owner is scene.gravity:
        return scene.replace(gravity=changed)
    if path.startswith("parts"):
        return scene.replace(parts=_exchanged(scene.parts, path, changed))
    return scene.replace(damping=_exchanged(scene.dampings, path, changed))


def _put_at_end(scene: Scene, path: str, standing: dict[str, float]) -> Scene:
    found = _END.fullmatch(path)
    assert found is not None
    at, change = int(found["at"]), {found["kind"]: standing}
    ends = list(scene.ends)
    ends[at] = dataclasses.replace(end_of(ends[at]), **change)  # type: ignore[arg-type]
    return scene.replace(ends=tuple(ends))


def _exchanged(many: tuple[Any, ...], path: str, changed: Any) -> tuple[Any, ...]:
    found = _LISTED.fullmatch(path)
    at = int(found["at"]) if found else 0
    return (*many[:at], changed, *many[at + 1 :])
