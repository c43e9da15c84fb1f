"""The file of a sweep: a zip of a sheet and, beside it, the answers and arrays that it names."""

from __future__ import annotations

import builtins
import io
import json
import zipfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ..base import check, errors
from ..base.answer import Answer, Cost, sealed, unsealed
from ..base.errors import RopedynError, SceneError
from ..base.reading import reading
from ..scene.scene import Scene
from ..scene.toml import built, document

SCHEMA = "ropedyn.sweep/1"
SHEET = "sweep.json"
PLAIN = (bool, int, float, str, type(None))
WHAT = "answers, scenes, numbers, texts, arrays, lists, tuples, dictionaries"


class ArchiveWriter:
    """A file in memory."""

    def __init__(self) -> None:
        self.content = io.BytesIO()
        self.file = zipfile.ZipFile(self.content, "w", zipfile.ZIP_DEFLATED)
        self.count = 0

    def kept(self, value: Any, where: str) -> Any:
        """Return what the sheet says of a value: plain as it is, else its kind and content."""
        if type(value) in PLAIN:
            return value
        if type(value) is complex:
            return {"complex": [value.real, value.imag]}
        if isinstance(value, (list, tuple)):
            each = [self.kept(one, f"{where}[{k}]") for k, one in enumerate(value)]
            return {"list" if isinstance(value, list) else "tuple": each}
        if isinstance(value, Mapping):
            pairs = [(key, f"{where}[{key!r}]") for key in value]
            return {"dict": [[self.kept(k, at), self.kept(value[k], at)] for k, at in pairs]}
        return self._whole(value, where)

    def _whole(self, value: Any, where: str) -> dict[str, Any]:
        """Return the same of what is kept as a scene file, or stands beside the sheet."""
        if isinstance(value, Scene):
            return {"scene": document(value)}
        if isinstance(value, Answer):
            return {"answer": self._beside(sealed(value), "nc")}
        if isinstance(value, (np.ndarray, np.generic)) and value.dtype.kind in "biufcU":
            content = io.BytesIO()
            np.save(content, value, allow_pickle=False)
            kind = "array" if isinstance(value, np.ndarray) else "scalar"
            return {kind: self._beside(content.getvalue(), "npy")}
        raise SceneError(f"{where} must be of {WHAT} to be saved, got {check.shown(value)}")

    def _beside(self, content: bytes, ending: str) -> str:
        name, self.count = f"{self.count}.{ending}", self.count + 1
        self.file.writestr(name, content)
        return name


def packed(sweep: Mapping[str, Any]) -> bytes:
    """Return the content of the file of a sweep, of its fields."""
    writer = ArchiveWriter()
    sheet = {
        "schema": SCHEMA,
        "results": writer.kept(sweep["results"], "results"),
        "seconds": writer.kept(sweep["seconds"], "seconds"),
        "failed": [[k, *_told(error)] for k, error in sweep["failed"].items()],
        "cost": vars(sweep["cost"]),
    }
    writer.file.writestr(SHEET, json.dumps(sheet))
    writer.file.close()
    return writer.content.getvalue()


def _told(error: BaseException) -> tuple[str, list[Any], list[str]]:
    plain = all(type(one) in PLAIN for one in error.args)
    given = list(error.args) if plain else [str(error)]
    return type(error).__name__, given, getattr(error, "__notes__", [])


def unpacked(path: Path) -> dict[str, Any]:
    """Return the fields of the sweep in a file."""
    with reading(path, "a file that Sweep.save wrote"), zipfile.ZipFile(path) as file:
        kinds: dict[str, Callable[[Any], Any]] = {
            "complex": lambda parts: complex(*parts),
            "list": lambda each: [value(one) for one in each],
            "tuple": lambda each: tuple(value(one) for one in each),
            "dict": lambda pairs: {value(k): value(v) for k, v in pairs},
            "scene": partial(built, Scene),
            "answer": lambda name: unsealed(file.read(name), path),
            "array": lambda name: np.load(io.BytesIO(file.read(name)), allow_pickle=False),
            "scalar": lambda name: kinds["array"](name)[()],
        }

        def value(said: Any) -> Any:
            if not isinstance(said, dict):
                return said
            [(kind, content)] = said.items()
            return kinds[kind](content)

        sheet = json.loads(file.read(SHEET))
        failed = {k: _error(*told) for k, *told in sheet["failed"]}
        found = {name: value(sheet[name]) for name in ("results", "seconds")}
        return {**found, "failed": failed, "cost": Cost(**sheet["cost"])}


def _error(kind: str, given: list[Any], notes: list[str]) -> BaseException:
    """Return an exception of the kind that is named, if it can be made again."""
    known = getattr(errors, kind, None) or getattr(builtins, kind, None)
    error: BaseException = RopedynError(": ".join([kind, *map(str, given)]))
    if isinstance(known, type) and issubclass(known, Exception):
        with suppress(TypeError):  # such as UnicodeDecodeError, which takes bytes
            error = known(*given)
    for note in notes:
        error.add_note(note)
    return error
