"""Files of frequency responses, by their suffix."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from ...base import check
from ...base.errors import SceneError
from . import Content, columns, uff, uff_read

UNIVERSAL = (".uff", ".unv", ".uf")
TEXT = (".csv", ".txt", ".dat", ".tsv")
DEFAULTS = {"reciprocal": False, "decimal": ".", "comments": "#", "skip": 0}
"""Values of the options that are not None where left out."""


def read(
    path: str | os.PathLike[str],
    *,
    anything: dict[str, Any],
    universal: dict[str, Any],
    text: dict[str, Any],
) -> Content:
    """Read what a `Measured` is made of; options by the kind of file they are for."""
    file = check.path(path)
    universal_file = is_universal(file)
    if not file.is_file():
        raise FileNotFoundError(f"path must be a file, got {str(file)!r}")
    for name, value in (text if universal_file else universal).items():
        if value != DEFAULTS.get(name):
            kind = "text in columns" if universal_file else "a universal file"
            raise SceneError(f"{name} is for {kind}, got {check.shown(value)} for {str(file)!r}")
    if universal_file:
        return uff_read.read(file, **anything, **universal)
    return columns.read(file, **anything, **text)


def write(content: Content, path: str | os.PathLike[str], binary: bool) -> None:
    """Write responses; see `Curves.write`."""
    file = check.path(path)
    check.instance(binary, "binary", bool, "True or False")
    universal_file = is_universal(file)
    if not np.isfinite(content.value).all():
        raise SceneError("value must be finite to be written")
    if (np.diff(content.frequency) <= 0).any():
        raise SceneError("frequency must increase to be written")
    if universal_file:
        uff.write(content, file, binary)
    elif binary:
        raise SceneError(f"binary is for a universal file, got {binary!r} for {str(file)!r}")
    else:
        columns.write(content, file)


def is_universal(file: Path) -> bool:
    """Whether a file is universal, by its suffix; else it is text."""
    suffix = file.suffix.lower()
    if suffix not in (*UNIVERSAL, *TEXT):
        raise SceneError(
            f"path must end with {', '.join(UNIVERSAL)} (universal file) or {', '.join(TEXT)} "
            f"(text in columns), got {str(file)!r}"
        )
    return suffix in UNIVERSAL
