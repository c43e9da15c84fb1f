"""The file of a sweep: a zip of a sheet and, beside it, the answers and arrays that it names."""

from __future__ import annotations

import builtins
import io
import json
import zipfile
from collections.abc import Mapping
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
WHAT = "answers, scenes, numbers, texts, arrays, or lists and dictionaries of these"


class Writer:
    """A file in memory."""

    def __init__(self) -> None:
        self.content = io.BytesIO()
        self.file = zipfile.ZipFile(self.content, "w", zipfile.ZIP_DEFLATED)
        self.count = 0

    def kept(self, value: Any, where: str) -> Any:
        """Return what the sheet says of a value: plain as it is, else its kind and content."""
        if type(value) in PLAIN:
            return value
        if isinstance(value, Answer):
            return {"answer": self._beside(sealed(value), "nc")}
        if isinstance(value, Scene):
            return {"scene": document(value)}
        if isinstance(value, (np.ndarray, np.generic)) and value.dtype.kind in "biufcU":
            content = io.BytesIO()
            np.save(content, value, allow_pickle=False)
            kind = "array" if isinstance(value, np.ndarray) else "scalar"
            return {kind: self._beside(content.getvalue(), "npy")}
        if type(value) is complex:
            return {"complex": [value.real, value.imag]}
        if isinstance(value, (list, tuple)):
            kind = "list" if isinstance(value, list) else "tuple"
            return {kind: [self.kept(one, f"{where}[{k}]") for k, one in enumerate(value)]}
        if isinstance(value, Mapping):
            pairs = [(key, f"{where}[{key!r}]") for key in value]
            return {"dict": [[self.kept(k, at), self.kept(value[k], at)] for k, at in pairs]}
        raise SceneError(f"{where} must be of {WHAT} to be saved, got {check.shown(value)}")

    def _beside(self, content: bytes, ending: str) -> str:
        name, self.count = f"{self.count}.{ending}", self.count + 1
        self.file.writestr(name, content)
        return name


def packed(sweep: Mapping[str, Any]) -> bytes:
    """Return the content of the file of a sweep, of its fields."""
    writer = Writer()
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


def _told(error: BaseException) -> tuple[str, str, list[str]]:
    return type(error).__name__, str(error), getattr(error, "__notes__", [])


def unpacked(path: Path) -> dict[str, Any]:
    """Return the fields of the sweep in a file."""
    with reading(path, "a file that Sweep.save wrote"), zipfile.ZipFile(path) as file:
        sheet = json.loads(file.read(SHEET))
        return {
            "results": _value(sheet["results"], file, path),
            "seconds": _value(sheet["seconds"], file, path),
            "failed": {k: _error(*told) for k, *told in sheet["failed"]},
            "cost": Cost(**sheet["cost"]),
        }


def _value(said: Any, file: zipfile.ZipFile, path: Path) -> Any:
    """Return the value that a sheet says."""
    if not isinstance(said, dict):
        return said
    [(kind, content)] = said.items()
    if kind == "answer":
        return unsealed(file.read(content), path)
    if kind == "scene":
        return built(Scene, content)
    if kind in ("array", "scalar"):
        array = np.load(io.BytesIO(file.read(content)), allow_pickle=False)
        return array if kind == "array" else array[()]
    if kind == "complex":
        return complex(*content)
    if kind == "dict":
        return {_value(k, file, path): _value(v, file, path) for k, v in content}
    each = [_value(one, file, path) for one in content]
    return each if kind == "list" else tuple(each)


def _error(kind: str, words: str, notes: list[str]) -> BaseException:
    """Return an exception of the kind that is named, if it can be made of its words."""
    known = getattr(errors, kind, None) or getattr(builtins, kind, None)
    error: BaseException = RopedynError(f"{kind}: {words}")
    if isinstance(known, type) and issubclass(known, Exception):
        try:
            error = known(words)
        except TypeError:  # such as UnicodeDecodeError, which takes five
            pass
    for note in notes:
        error.add_note(note)
    return error
