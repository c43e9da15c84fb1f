"""Scenes as TOML files."""

from __future__ import annotations

import dataclasses
import os
import tomllib
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, TypeVar

from ..axis.axis import Axis
from ..base import check
from ..base.array import Real
from ..base.atomic import write_bytes
from ..base.errors import SceneError, at_once
from ..base.parameter import Description, required
from ..base.reading import reading
from . import damping
from .end import End
from .force import KINDS as FORCES
from .force import Force, Samples, Sum
from .gravity import Gravity
from .parts import part
from .parts.law import NodeForce
from .rope import Rope
from .tension import Tension

_Scene = TypeVar("_Scene", bound=Description)


def load(scene: type[_Scene], path: str | os.PathLike[str]) -> _Scene:
    """Read a scene; see `Scene.load`."""
    file = check.path(path)
    content = file.read_bytes()
    with reading(file, "a TOML file"):
        document = tomllib.loads(content.decode("utf-8-sig"))
    with reading(file, "a TOML file of a scene"):
        try:
            return built(scene, document)
        except TypeError as error:  # of a number that is text
            raise SceneError(str(error)) from error


def save(scene: Any, path: str | os.PathLike[str]) -> None:
    """Write a scene; see `Scene.save`."""
    import tomli_w

    check.path(path)
    write_bytes(path, tomli_w.dumps(document(scene)).encode())


def built(scene: type[_Scene], document: Mapping[str, Any]) -> _Scene:
    """Build a scene from its keys in a file."""
    return scene(**_arguments(document, {field.name for field in dataclasses.fields(scene)}))


def document(scene: Any) -> dict[str, Any]:
    """Return the keys of a scene in a file."""
    for i, one in enumerate(scene.parts):
        if isinstance(one, NodeForce):
            raise SceneError(f"parts[{i}].law cannot be written to a file, got {one.law!r}")
    rope = _plain(scene.rope)
    if scene.rope.axis is None:
        rope.pop("natural", None)
    else:
        del rope["length"]
        rope["axis"] = dict(scene.rope.axis.words)
    found: dict[str, Any] = {
        "tension": scene.tension if isinstance(scene.tension, float) else _plain(scene.tension),
        "ends": [end if isinstance(end, str) else _plain(end) for end in scene.ends],
        "rope": rope,
    }
    if scene.planes != "z":
        found["planes"] = scene.planes
    for name in ("torque", "axial_force"):
        if getattr(scene, name):
            found[name] = getattr(scene, name)
    if scene.gravity is not None:
        found["gravity"] = _plain(scene.gravity)
    if scene.dampings:
        found["damping"] = [_named(one) for one in scene.dampings]
    if scene.parts:
        found["parts"] = [_named(one) for one in scene.parts]
    return found


def force_words(force: Force) -> Any:
    """Return a force as JSON knows it, without its samples; a sum has those of its parts."""
    if isinstance(force, Sum):
        each = map(force_words, force.forces)
        return [one for said in each for one in (said if isinstance(said, list) else [said])]
    return None if isinstance(force, Samples) else _named(force)


def force_from(said: Any, time: Real, sample: Real) -> Force:
    """Return the force of its words and of what it is at times: what others leave is sampled."""
    kinds = {kind.__name__: kind for kind in FORCES}
    whole = said if isinstance(said, list) else [said]
    known: list[Force] = [_one(one, "law", kinds) for one in whole if one is not None]
    if None in whole:
        known.append(Samples(time, sample - Sum(tuple(known)).value(time)))
    return Sum(tuple(known)) if isinstance(said, list) else known[0]


def _plain(thing: Any) -> dict[str, Any]:
    """Return the arguments of a description that are not their defaults."""
    values = {}
    for field in dataclasses.fields(thing):
        value = getattr(thing, field.name)
        if isinstance(value, Mapping):
            value = dict(value)
        if value is not None and value != {}:
            values[field.name] = value
    return values


def _named(thing: Any) -> dict[str, Any]:
    return {"kind": type(thing).__name__, **_plain(thing)}


def _arguments(document: Mapping[str, Any], known: set[str]) -> dict[str, Any]:
    tables: dict[str, Callable[[], Any]] = {"rope": partial(_rope, document)}
    if isinstance(document.get("tension"), dict):
        tables["tension"] = partial(_built, Tension, document["tension"], "tension")
    if "gravity" in document:
        tables["gravity"] = partial(_built, Gravity, document["gravity"], "gravity")
    if isinstance(document.get("ends"), list):
        tables["ends"] = partial(_ends, document["ends"])
    if "damping" in document:
        given = document["damping"]
        many = given if isinstance(given, list) else [given]
        tables["damping"] = partial(_each, many, "damping", damping.KINDS)
    if "parts" in document:
        tables["parts"] = partial(_each, document["parts"], "parts", part.KINDS)
    _, *built = at_once(partial(_known_keys, document, known, "the file"), *tables.values())
    return {**document, **dict(zip(tables, built))}


def _rope(document: Mapping[str, Any]) -> Any:
    if "rope" not in document:
        raise SceneError("key rope is missing: a scene needs a table [rope]")
    return _built(Rope, _with_axis(document["rope"]), "rope")


def _ends(given: Sequence[Any]) -> tuple[Any, ...]:
    tables = {i: end for i, end in enumerate(given) if isinstance(end, dict)}
    built = at_once(*(partial(_built, End, end, f"ends[{i}]") for i, end in tables.items()))
    return tuple((dict(enumerate(given)) | dict(zip(tables, built))).values())


def _with_axis(rope: Any) -> Any:
    """Return the keys of a rope, its length the axis that its table says."""
    if not isinstance(rope, dict) or "axis" not in rope:
        return rope
    if "length" in rope:
        raise SceneError(f"rope.length must be left out beside rope.axis, got {rope['length']!r}")
    others = {key: value for key, value in rope.items() if key != "axis"}
    try:
        return others | {"length": Axis.from_words(rope["axis"])}
    except (SceneError, TypeError) as error:
        raise type(error)(f"rope.axis: {error}") from error


def _each(given: Any, name: str, kinds: Sequence[Any]) -> tuple[Any, ...]:
    check.instance(given, name, list, f"an array of tables [[{name}]]")
    by_name = {kind.__name__: kind for kind in kinds}
    tables = (partial(_one, table, f"{name}[{i}]", by_name) for i, table in enumerate(given))
    return tuple(at_once(*tables))


def _one(table: Any, where: str, by_name: Mapping[str, type[Description]]) -> Any:
    check.instance(table, where, dict, "a table")
    if "kind" not in table:
        raise SceneError(f"key {where}.kind is missing: one of {', '.join(by_name)}")
    kind = by_name[check.one_of(table["kind"], f"{where}.kind", by_name)]
    return _built(kind, {key: value for key, value in table.items() if key != "kind"}, where)


def _built(kind: type[Description], table: Any, where: str) -> Any:
    """Call a description with the keys of a table, and say where an error comes from."""
    check.instance(table, where, dict, "a table")
    at_once(
        partial(_known_keys, table, {field.name for field in dataclasses.fields(kind)}, where),
        *(partial(_has_key, table, key, where) for key in required(kind)),
    )
    try:
        return kind(**table)
    except (SceneError, TypeError) as error:
        raise type(error)(f"{where}.{error}") from error


def _has_key(table: Mapping[str, Any], key: str, where: str) -> None:
    if key not in table:
        raise SceneError(f"key {where}.{key} is missing")


def _known_keys(table: Mapping[str, Any], known: set[str], where: str) -> None:
    unknown = [repr(key) for key in table if key not in known]
    if unknown:
        raise SceneError(
            f"unknown key {', '.join(unknown)} in {where}: expected one of "
            f"{', '.join(sorted(known))}"
        )
