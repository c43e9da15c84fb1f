"""What a measured file holds, as a table, before anybody says what it means."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np

from ...base import check
from ...base.table import Table
from . import columns, uff
from .formats import is_universal

TYPES = {
    0: "general",
    1: "time response",
    2: "auto spectrum",
    3: "cross spectrum",
    uff.FRF: "frequency response",
    5: "transmissibility",
    uff.COHERENCE: "coherence",
    7: "auto correlation",
    8: "cross correlation",
    9: "power spectral density",
    10: "energy spectral density",
    12: "spectrum",
}
"""Types of functions of dataset 58."""


def contents(path: str | os.PathLike[str], **layout: Any) -> Table:
    """Return the functions of a universal file, or the columns of a text file."""
    file = check.path(path)
    if not file.is_file():
        raise FileNotFoundError(f"path must be a file, got {str(file)!r}")
    return _functions(file) if is_universal(file) else _columns(file, layout)


def _functions(file: Path) -> Table:
    found = uff.read(file, lambda fields: True)
    ends = [(one.fields["x"][0], one.fields["x"][-1]) for one in found]
    return Table.of(
        f"functions of {file.name}",
        {
            "dataset": [one.number for one in found],
            "function": tuple(_type(one.fields) for one in found),
            "response": tuple(_place(one.fields, "rsp") for one in found),
            "reference": tuple(_place(one.fields, "ref") for one in found),
            "values": [len(one.fields["data"]) for one in found],
            "over": tuple(_unit(one.fields, "abscissa") for one in found),
            "first": [float(first) for first, _ in ends],
            "last": [float(last) for _, last in ends],
            "unit": tuple(_unit(one.fields, "ordinate") for one in found),
            "name": tuple(str(one.fields["id1"]).strip() for one in found),
        },
    )


def _type(fields: uff.Fields) -> str:
    number = int(fields["func_type"])
    return TYPES.get(number, f"type {number}")


def _place(fields: uff.Fields, end: str) -> str:
    """Return a node and a direction such as "3 -Z"."""
    code = int(fields[f"{end}_dir"])
    turns = abs(code) < len(uff.DIRECTIONS)
    direction = uff.DIRECTIONS[abs(code)] if turns else f"direction {abs(code)}"
    return f"{int(fields[f'{end}_node'])} {'-' if code < 0 else ''}{direction}"


def _unit(fields: uff.Fields, axis: str) -> str | None:
    return uff.label_of(fields[f"{axis}_axis_units_lab"]) or None


def _columns(file: Path, layout: dict[str, Any]) -> Table:
    sheet = columns.sheet_of(file, columns.text_of(file), **layout)
    numbers, count = sheet.numbers, sheet.numbers.shape[1]
    steps = [np.diff(column) for column in numbers.T]
    rises = [len(step) > 0 and bool((step > 0).all()) for step in steps]
    return Table.of(
        f"columns of {file.name}",
        {
            "column": range(count),
            "name": sheet.names or (None,) * count,
            "values": [len(numbers)] * count,
            "first": numbers[0],
            "last": numbers[-1],
            "least": numbers.min(axis=0),
            "largest": numbers.max(axis=0),
            "increases": tuple("yes" if one else "no" for one in rises),
            "mean step": tuple(
                float(step.mean()) if one else None for one, step in zip(rises, steps)
            ),
        },
    )
