"""Frequency responses as text in columns."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Mapping
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...base import check
from ...base.array import Complex, Real
from ...base.atomic import write_bytes
from ...base.errors import SceneError, at_once
from ...base.reading import reading
from ...base.unit import QUANTITIES, named
from ..motion_unit import EXAMPLES, scale, stated
from . import Content

OWN = "# ropedyn "
"""How a file begins that `write` has written: JSON of what is in it follows."""
PAIRS = (("real", "imag"), ("amplitude", "phase"))
KEYS = ("frequency", "real", "imag", "amplitude", "phase", "coherence")
"""What columns may be; phases in degrees."""
COMMA = re.compile(r"[+-]?\d*,\d+([eE][+-]?\d+)?")
TWO = re.compile(r"\d+([eE][+-]?\d+)?\s+[+-]?\d+")
"""A number with a decimal comma, and what lies between the commas of two."""
COMMAS = ': its numbers have decimal commas; say decimal="," and, if it is a comma, the delimiter'
SUCH = '{"frequency": 0, "real": 1, "imag": 2}'


class Layout(NamedTuple):
    """How text is split; see `Measured.read`."""

    delimiter: str | None
    decimal: str
    comments: str
    skip: int


class Head(NamedTuple):
    """What the first line of a file says that `write` has written."""

    drives: list[Any]
    responses: list[Any]
    quantity: str
    has_coherence: bool
    averages: float | None
    has_std: bool
    decay: float
    notes: tuple[str, ...]


class Sheet(NamedTuple):
    """Text in columns."""

    names: tuple[str, ...] | None  # of the columns; None where the first line has numbers already
    numbers: Real  # (rows, columns)

    @property
    def there(self) -> str:
        """The columns in words."""
        named = ", ".join(map(repr, self.names or ()))
        return named or f"{self.numbers.shape[1]} columns without names"


def read(
    file: Path,
    *,
    drive: Any,
    response: Any,
    unit: Any,
    quantity: str | None,
    columns: Any,
    **layout: Any,
) -> Content:
    """Read what a `Measured` is made of; see `Measured.read`."""
    text = text_of(file)
    if columns is None and text.startswith(OWN):
        for name, value in (("unit", unit), ("quantity", quantity), ("response", response)):
            if value is not None:
                raise SceneError(
                    f"{name} must be left out for {str(file)!r}, which says it, got {value!r}"
                )
        return _own(file, text, drive)
    sheet = sheet_of(file, text, **layout)
    found, *_ = at_once(
        partial(_columns, file, sheet, columns),
        partial(_state, file, "drive", drive, 'what the force acts on, such as ("z", 0.5)'),
        partial(_state, file, "response", response, 'what is watched, such as ("z", 0.5)'),
        partial(_state, file, "unit", unit, f"the unit of the numbers, such as {EXAMPLES}"),
    )
    meaning, factor = _meaning(drive, response, unit, quantity)
    with np.errstate(all="ignore"):  # what is not finite is refused by name
        found["value"] = found["value"] * np.reshape(factor, (-1, 1))
    return Content(**found, **meaning)


def text_of(file: Path) -> str:
    """Return the text of a file."""
    content = file.read_bytes()
    with reading(file, "a text file"):
        text = content.decode("utf-8-sig")
    if "\0" in text:
        raise SceneError(f"path must be a text file, got {str(file)!r} with bytes 0")
    return text


def sheet_of(file: Path, text: str, **layout: Any) -> Sheet:
    """Return text as columns of numbers, split as the user says."""
    return _sheet(file, text, _layout(**layout))


def _layout(delimiter: Any, decimal: Any, comments: Any, skip: Any) -> Layout:
    """Check what the user says of the text."""
    if delimiter is not None:
        check.instance(delimiter, "delimiter", str, "a character")
        if len(delimiter) != 1 or delimiter in '\r\n"':
            raise SceneError(f"delimiter must be a character, got {delimiter!r}")
    check.one_of(decimal, "decimal", (".", ","))
    check.instance(comments, "comments", str, "how a comment begins")
    check.count(skip, "skip", least=0, most=1 << 31)
    return Layout(delimiter, decimal, comments, skip)


def _sheet(file: Path, text: str, layout: Layout) -> Sheet:
    """Split text into numbers, with the number of the line for what is none."""
    what = f"path must be a file with numbers in columns, got {str(file)!r}"
    lines = [(k, line) for k, line in enumerate(text.splitlines(), start=1) if k > layout.skip]
    begins = layout.comments or ()
    lines = [
        (k, line) for k, line in lines if line.strip() and not line.lstrip().startswith(begins)
    ]
    if not lines:
        raise SceneError(f"{what} without a line")
    separator = _separator(layout, lines[0][1])
    rows = [(k, _cells(line, separator)) for k, line in lines]
    names = None
    if any(_number(cell, layout) is None for cell in rows[0][1]):
        if _has_commas(rows[0][1], layout, 0):
            raise SceneError(f"{what} with {check.shown(lines[0][1])} in line {rows[0][0]}{COMMAS}")
        names = tuple(rows.pop(0)[1])
    if not rows:
        raise SceneError(f"{what} with one line and no numbers: {check.shown(names)}")
    numbers = np.empty((len(rows), len(names or rows[0][1])))
    for at, (k, cells) in enumerate(rows):
        found = [_number(cell, layout) for cell in cells]
        hint = COMMAS if _has_commas(cells, layout, numbers.shape[1]) else ""
        if None in found:
            wrong = check.shown(cells[found.index(None)])
            raise SceneError(f"{what} with {wrong} in line {k}{hint}")
        if len(cells) != numbers.shape[1]:
            wrong = f"{len(cells)} of {numbers.shape[1]} columns"
            raise SceneError(f"{what} with {wrong} in line {k}{hint}")
        numbers[at] = found
    return Sheet(names, numbers)


def _separator(layout: Layout, line: str) -> str | None:
    """Return what stands between columns: white space if None."""
    if layout.delimiter is not None:
        return None if layout.delimiter == " " else layout.delimiter
    return next((c for c in (";", "\t", ",") if c in line and c != layout.decimal), None)


def _cells(line: str, separator: str | None) -> list[str]:
    if separator is None:
        return line.split()
    return [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]


def _number(cell: str, layout: Layout) -> float | None:
    try:
        return float(cell.replace(",", ".") if layout.decimal == "," else cell)
    except ValueError:
        return None


def _has_commas(cells: list[str], layout: Layout, columns: int) -> bool:
    """Whether numbers were written with decimal commas, that were not said."""
    # in cells of their own, or split at them: into cells of two numbers, or twice as many cells
    if layout.decimal == ",":
        return False
    split = len(cells) == 2 * columns and all(_number(cell, layout) is not None for cell in cells)
    return split or any(COMMA.fullmatch(cell) or TWO.fullmatch(cell) for cell in cells)


def _state(file: Path, name: str, value: Any, what: str) -> None:
    """Refuse a file of which nobody says what only the user knows."""
    if value is None:
        raise SceneError(f"{name} must be stated for {str(file)!r}: {what}; got None")


def _columns(file: Path, sheet: Sheet, columns: Any) -> dict[str, Any]:
    """Return frequency, values and coherence of the columns that the user names."""
    if columns is None:
        raise SceneError(
            f"columns must say what the columns of {str(file)!r} are ({sheet.there}), such as "
            f"{SUCH}, got None"
        )
    check.instance(columns, "columns", Mapping, f"names or numbers of columns such as {SUCH}")
    for key in columns:
        check.one_of(key, "each key of columns", KEYS)
    given = [pair for pair in PAIRS if pair[0] in columns or pair[1] in columns]
    if "frequency" not in columns or len(given) != 1 or not all(k in columns for k in given[0]):
        raise SceneError(
            'columns must have "frequency", and either "real" and "imag" or "amplitude" and '
            f'"phase", got {check.shown(dict(columns))}'
        )
    found = {key: _taken(file, sheet, key, columns[key]) for key in columns}
    if (
        len(found["frequency"]) != 1
        or len({len(v) for k, v in found.items() if k != "frequency"}) > 1
    ):
        raise SceneError(
            "columns must have one frequency and as many of each other kind, got "
            f"{check.shown(dict(columns))}"
        )
    first, second = (found[key] for key in given[0])
    turned = given[0] == PAIRS[1]
    return {
        "frequency": found["frequency"][0],
        "value": first * np.exp(1j * np.radians(second)) if turned else _complex(first, second),
        "coherence": found.get("coherence"),
    }


def _taken(file: Path, sheet: Sheet, key: str, chosen: Any) -> Real:
    """Return columns by name or number, shape (columns, rows)."""
    chosen = chosen if isinstance(chosen, (list, tuple)) else [chosen]
    width = sheet.numbers.shape[1]
    at = []
    for one in chosen:
        if isinstance(one, str):
            if one not in (sheet.names or ()):
                raise SceneError(
                    f"columns[{key!r}] must be names out of {sheet.names or 'none'}, the head of "
                    f"{str(file)!r}, got {one!r}"
                )
            at.append((sheet.names or ()).index(one))
        else:
            name = f"columns[{key!r}] of {str(file)!r}"
            at.append(check.count(one, name, least=0, most=width - 1))
    return sheet.numbers[:, at].T


def _complex(real: Real, imag: Real) -> Complex:
    """Return real and imaginary parts together, every bit as it is."""
    value = np.empty(real.shape, dtype=np.complex128)
    value.real, value.imag = real, imag
    return value


def _meaning(
    drive: Any, response: Any, unit: Any, quantity: str | None
) -> tuple[dict[str, Any], list[float]]:
    """Return what the user says that the numbers are, and the factors that make them SI."""
    cause = check.points(drive, "drive", forces=False)
    points = check.points(response, "response", forces=True)
    points = (points,) if isinstance(points[0], str) else points
    if not isinstance(cause[0], str):
        raise SceneError(f"drive must be one point, got {check.shown(drive)}")
    units = [unit] * len(points) if isinstance(unit, str) else unit
    check.instance(units, "unit", (list, tuple), "a unit, or one for each response")
    if len(units) != len(points):
        raise SceneError(f"unit must be one, or {len(points)} as response, got {len(units)}")
    scales = [scale(stated(u), r, cause, "unit") for u, r in zip(units, points)]
    names = {name for name, _ in scales}
    if quantity is not None:
        check.one_of(quantity, "quantity", QUANTITIES)
        names.add(quantity)
    if len(names) > 1:
        raise SceneError(f"unit and quantity must agree, got {unit!r} and {quantity!r}")
    meaning = {"drive": cause, "response": points, "quantity": names.pop()}
    return meaning, [size for _, size in scales]


def _own(file: Path, text: str, drive: Any) -> Content:
    """Read what `write` wrote."""
    first, _, rest = text.partition("\n")
    with reading(file, "a file whose first line nobody changed"):
        head = _head(first.removeprefix(OWN))
    there = f"one of those of {str(file)!r}, {', '.join(map(repr, head.drives))}"
    if drive is None and len(head.drives) > 1:
        raise SceneError(f"drive must be {there}, got None")
    wanted = head.drives[0] if drive is None else check.points(drive, "drive", forces=False)
    if wanted not in head.drives:
        raise SceneError(f"drive must be {there}, got {drive!r}")
    sheet = _sheet(file, rest, Layout(",", ".", "", 0))
    each = 2 + head.has_coherence + head.has_std
    if sheet.numbers.shape[1] != 1 + each * len(head.responses) * len(head.drives):
        raise SceneError(
            f"path must be a file that nobody changed, got {str(file)!r} with "
            f"{sheet.numbers.shape[1]} columns"
        )
    shape = (len(head.drives), len(head.responses), each, -1)
    block = sheet.numbers[:, 1:].T.reshape(shape)[head.drives.index(wanted)]
    return Content(
        frequency=sheet.numbers[:, 0],
        value=_complex(block[:, 0], block[:, 1]),
        drive=wanted,
        response=head.responses,
        quantity=head.quantity,
        coherence=block[:, 2] if head.has_coherence else None,
        averages=head.averages,
        std=block[:, -1] if head.has_std else None,
        decay=head.decay,
        notes=head.notes,
    )


def _head(text: str) -> Head:
    """Return what the first line says."""
    given = json.loads(text)
    if not given["drive"] or not given["response"]:
        raise ValueError("no point")
    return Head(
        [check.points(tuple(point), "drive", forces=False) for point in given["drive"]],
        [check.points(tuple(point), "response", forces=True) for point in given["response"]],
        check.one_of(given["quantity"], "quantity", QUANTITIES),
        check.instance(given["coherence"], "coherence", bool, "true or false"),
        check.optional(given["averages"], "averages", sign="positive"),
        check.instance(given["std"], "std", bool, "true or false"),
        check.number(given["decay"], "decay", "1/s", sign="nonnegative"),
        tuple(check.instance(note, "note", str, "text") for note in given["notes"]),
    )


def write(content: Content, path: Path) -> None:
    """Write responses, and what is known of them, with every digit; see `Curves.write`."""
    coherence, std = content.coherence, content.std
    head = {
        "drive": content.drive,
        "response": content.response,
        "quantity": content.quantity,
        "coherence": coherence is not None,
        "averages": content.averages,
        "std": std is not None,
        "decay": content.decay,
        "notes": list(content.notes),
    }
    names, columns = ["frequency [Hz]"], [content.frequency]
    for name, r, d in named(content.response, content.drive, content.quantity):
        names += [f"real {name}", f"imag {name}"]
        columns += [content.value[d, r].real, content.value[d, r].imag]
        if coherence is not None:
            names.append(f"coherence of {name}")
            columns.append(coherence[r])
        if std is not None:
            names.append(f"std of {name}")
            columns.append(std[r])
    text = io.StringIO()
    text.write(f"{OWN}{json.dumps(head)}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    writer.writerows(np.stack(columns, axis=1).tolist())
    write_bytes(path, text.getvalue().encode())
