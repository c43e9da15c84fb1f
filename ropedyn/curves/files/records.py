"""Files of recorded motion over time: text in columns, and universal files."""

from __future__ import annotations

import csv
import io
import json
import re
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...base import check
from ...base.array import Real
from ...base.atomic import write_bytes
from ...base.errors import SceneError, at_once
from ...base.reading import reading
from ...base.unit import FORCE_UNIT, MOTIONS, UNIT, label, place
from ..motion_unit import RATES, side
from . import uff
from .columns import Layout, Sheet, sheet_of, text_of
from .formats import is_universal

OWN = "# ropedyn record "
"""How text begins that `write` has written: JSON of what is in it follows."""
OWN_POINT = re.compile(r"ropedyn (?P<what>motion|force) (?P<name>[a-z]+) (?P<x>\S+)$")
OWN_TIME = re.compile(r"ropedyn start (?P<start>\S+) rate (?P<rate>\S+)$")
"""The second and third line of a function that was written here."""
HISTORY, OVER_TIME = 1, 17
"""Types of a function over time, and of its abscissa."""


class RecordContent(NamedTuple):
    """What a `Record` is made of, and written from."""

    time: Real | None  # (t,) [s]
    value: Real  # (channels, t)
    rate: float | None
    response: Sequence[Any]
    quantity: str
    force: Real | None = None
    drive: Any = None
    missing: str = "refuse"
    notes: Sequence[str] = ()


class Said(NamedTuple):
    """What the user says of a file; see `Record.read`."""

    time: Any
    rate: Any
    response: Any
    quantity: Any
    force: Any
    unit: Any
    missing: str


class Row(NamedTuple):
    """One channel of a file."""

    value: Real
    unit: str | None  # as the file says it
    order: int | None  # how often the displacement is differentiated, as the file says it


# --- which channels, in which unit ----------------------------------------------------------------


def read(file: Path, said: Said, layout: dict[str, Any]) -> RecordContent:
    """Read what a `Record` is made of."""
    universal = is_universal(file)
    if not file.is_file():
        raise FileNotFoundError(f"path must be a file, got {str(file)!r}")
    return _universal(file, said, layout) if universal else _text(file, said, layout)


def _in_order(file: Path, said: Said, channels: Sequence[Any], there: str) -> Said:
    """Return the same with a list of points as those of all channels that are nothing else."""
    if not isinstance(said.response, (list, tuple)):
        return said
    if len(said.response) != len(channels):
        raise SceneError(
            f"response must have a point for each of {len(channels)} channels of {str(file)!r} "
            f"that are neither time nor force ({there}), got {len(said.response)}"
        )
    return said._replace(response=dict(zip(channels, said.response)))


def _points(file: Path, said: Said, there: str) -> None:
    """Refuse a file of which nobody says where its channels are."""
    such = '{"a1": ("z", 3.5)}'
    what = f"which channels of {str(file)!r} are at which points, such as {such} ({there})"
    if not said.response:
        raise SceneError(f"response must say {what}, got {said.response!r}")
    check.instance(said.response, "response", (Mapping, list, tuple), what)


def _chosen(file: Path, said: Said, taken: Any) -> dict[str, Any]:
    """Return the motions and the force that the user names, in SI."""
    quantity, rows, points = said.quantity, [], []
    for key, point in said.response.items():
        row, name = taken(key, "response"), f"response[{key!r}]"
        at = check.point(point, name, check.COORDINATES, None)
        value, order = _scaled(
            row, _unit(said, key), UNIT[at[0]], f"unit of {key!r} in {str(file)!r}"
        )
        of_unit = next((word for word, k in MOTIONS.items() if k == order), None)
        if None not in (quantity, of_unit) and quantity != of_unit:
            raise SceneError(f"quantity must be that of channel {key!r}, {of_unit}, got {quantity}")
        quantity = quantity or of_unit
        rows.append(value)
        points.append(at)
    found = {"response": points, "quantity": quantity or "acceleration", "value": np.array(rows)}
    return found | _force(file, said, taken)


def _force(file: Path, said: Said, taken: Any) -> dict[str, Any]:
    if said.force is None:
        return {}
    what = 'one channel and what it acts on, such as {"hammer": ("z", 9.0)}'
    check.instance(said.force, "force", Mapping, what)
    if len(said.force) != 1:
        raise SceneError(f"force must be {what}, got {check.shown(said.force)}")
    ((key, point),) = said.force.items()
    at = check.point(point, f"force[{key!r}]", check.COORDINATES, None)
    unit = said.unit.get(key) if isinstance(said.unit, Mapping) else None
    value, _ = _scaled(
        taken(key, "force"), unit, FORCE_UNIT[at[0]], f"unit of {key!r} in {str(file)!r}"
    )
    return {"force": value, "drive": at}


def _unit(said: Said, key: Any) -> str | None:
    if said.unit is None or isinstance(said.unit, str):
        return said.unit
    what = 'a unit such as "g", or one for each channel'
    return check.instance(said.unit, "unit", Mapping, what).get(key)


def _scaled(row: Row, unit: Any, expected: str, name: str) -> tuple[Real, int | None]:
    """Return a channel in SI, and how often it differentiates a displacement if that is known."""
    text = row.unit if unit is None else unit
    if text is None:
        return row.value, row.order
    found = side(text) if isinstance(text, str) else None
    if found is None or found.dimension != expected:
        such = " or ".join(repr(expected + rate) for rate in RATES)
        raise SceneError(f"{name} must be one of {such} or of their kind, got {text!r}")
    return row.value * found.size, found.order


# --- text -----------------------------------------------------------------------------------------


def _text(file: Path, said: Said, layout: dict[str, Any]) -> RecordContent:
    text = text_of(file)
    if text.startswith(OWN):
        _refuse_said(file, said)
        return _own_text(file, text)
    if text.startswith("# ropedyn {"):
        raise SceneError(
            f"path must be a record, got {str(file)!r}, which is a frequency response: "
            "Measured.read reads it"
        )
    sheet = sheet_of(file, text, **layout)
    at_once(partial(_clock, file, said, sheet), partial(_points, file, said, sheet.there))

    def taken(key: Any, argument: str) -> Row:
        return Row(sheet.numbers[:, _column(file, sheet, key, argument)], None, None)

    time = None if said.time is None else taken(said.time, "time").value
    keys = [*([] if said.time is None else [said.time]), *(said.force or ())]
    others = {_column(file, sheet, key, "time or force") for key in keys}
    width = sheet.numbers.shape[1]
    said = _in_order(file, said, [i for i in range(width) if i not in others], sheet.there)
    found = _chosen(file, said, taken)
    return RecordContent(time=time, rate=said.rate, missing=said.missing, **found)


def _clock(file: Path, said: Said, sheet: Sheet) -> None:
    """Refuse a file of which nobody says when its samples are."""
    if said.time is None and said.rate is None:
        raise SceneError(
            f"time must be the column of the times in {str(file)!r} ({sheet.there}), or rate "
            "stated in Hz, got None"
        )


def _column(file: Path, sheet: Sheet, key: Any, argument: str) -> int:
    """Return the number of a column."""
    if isinstance(key, str):
        if key not in (sheet.names or ()):
            raise SceneError(
                f"{argument} must be names out of {sheet.names or 'none'}, the head of "
                f"{str(file)!r}, got {key!r}"
            )
        return (sheet.names or ()).index(key)
    name = f"{argument} of {str(file)!r}"
    return check.count(key, name, least=0, most=sheet.numbers.shape[1] - 1)


def _refuse_said(file: Path, said: Said) -> None:
    """Refuse what a file says that was written here."""
    for name in ("time", "rate", "response", "quantity", "force", "unit"):
        value = getattr(said, name)
        if value is not None:
            raise SceneError(
                f"{name} must be left out for {str(file)!r}, which says it, got "
                f"{check.shown(value)}"
            )


def _own_text(file: Path, text: str) -> RecordContent:
    first, _, rest = text.partition("\n")
    changed = f"path must be a file that nobody changed, got {str(file)!r}"
    with reading(file, "a file that nobody changed"):
        head = json.loads(first.removeprefix(OWN))
        points = [tuple(point) for point in head["response"]]
        drive = head["drive"] and tuple(head["drive"])
        said = (points, head["quantity"], head["rate"], tuple(head["notes"]))
    sheet = sheet_of(file, rest, delimiter=",", decimal=".", comments="", skip=0)
    if sheet.numbers.shape[1] != 1 + len(points) + (drive is not None):
        raise SceneError(f"{changed} with {sheet.numbers.shape[1]} columns")
    rows = sheet.numbers.T
    return RecordContent(
        time=rows[0],
        value=rows[1 : 1 + len(points)],
        rate=said[2],
        response=points,
        quantity=said[1],
        force=rows[-1] if drive else None,
        drive=drive,
        missing="gap",
        notes=said[3],
    )


def write(motion: RecordContent, file: Path, binary: bool) -> None:
    """Write a record with every digit; see `Record.write`."""
    check.instance(binary, "binary", bool, "True or False")
    if is_universal(file):
        _write_universal(motion, file, binary)
        return
    if binary:
        raise SceneError(f"binary is for a universal file, got {binary!r} for {str(file)!r}")
    head = {
        "response": motion.response,
        "quantity": motion.quantity,
        "rate": motion.rate,
        "drive": motion.drive,
        "notes": list(motion.notes),
    }
    names = ["time [s]", *(label(point, quantity=motion.quantity) for point in motion.response)]
    rows = [motion.time, *motion.value]
    if motion.force is not None:
        names.append(f"force in {place(motion.drive)} [{FORCE_UNIT[motion.drive[0]]}]")
        rows.append(motion.force)
    text = io.StringIO()
    text.write(f"{OWN}{json.dumps(head)}\n")
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    writer.writerows(np.stack(rows, axis=1).tolist())
    write_bytes(file, text.getvalue().encode())


# --- universal files ------------------------------------------------------------------------------


def _universal(file: Path, said: Said, layout: dict[str, Any]) -> RecordContent:
    for name, usual in LAYOUT.items():
        if layout[name] != usual:
            raise SceneError(f"{name} is for text in columns, got {layout[name]!r}")
    found = uff.read(file, lambda fields: fields["func_type"] == HISTORY)
    if not found:
        raise SceneError(
            "path must be a universal file with a time response (dataset 58, function type 1), "
            f"got {str(file)!r} with none"
        )
    own = [OWN_POINT.match(record.fields["id2"]) for record in found]
    if said.response is None and all(own):
        _refuse_said(file, said)
        return _own_universal(file, found, own)
    return _foreign(file, found, said)


def _foreign(file: Path, found: Sequence[uff.FileFunction], said: Said) -> RecordContent:
    """Return the datasets that the user names, by number or by first line."""
    names = {record.number: record.fields["id1"].strip() for record in found}
    there = ", ".join(f"{number}: {name!r}" for number, name in names.items())
    used: list[uff.FileFunction] = []

    def taken(key: Any, argument: str) -> Row:
        matching = [r for r in found if key in (r.number, names[r.number])]
        if len(matching) != 1:
            raise SceneError(
                f"{argument} must be numbers or first lines of datasets of {str(file)!r} "
                f"({there}), each of one, got {key!r}"
            )
        used.append(matching[0])
        return _row(matching[0])

    if said.time is not None:
        raise SceneError(f"time is for text in columns, got {said.time!r} for {str(file)!r}")
    _points(file, said, there)
    motions = [k for k, name in names.items() if not {k, name} & set(said.force or ())]
    said = _in_order(file, said, motions, there)
    chosen = _chosen(file, said, taken)
    time = _times(file, used)
    return RecordContent(time=time, rate=said.rate, missing=said.missing, **chosen)


def _row(record: uff.FileFunction) -> Row:
    """Return a dataset as a channel; one in the direction -Z counts the other way."""
    fields = record.fields
    sign = -1.0 if fields["rsp_dir"] < 0 else 1.0
    unit = uff.label_of(fields["ordinate_axis_units_lab"]) or None
    order = uff.MOTION.get(fields["ordinate_spec_data_type"])
    return Row(sign * np.real(fields["data"]).astype(np.float64), unit, order)


def _times(file: Path, records: Sequence[uff.FileFunction]) -> Real:
    """Return the times that all have."""
    first = records[0]
    for record in records:
        kind = record.fields["abscissa_spec_data_type"]
        if kind not in (OVER_TIME, *uff.UNSAID):
            raise SceneError(
                f"path must be a universal file over time, got {str(file)!r}: the abscissa of "
                f"dataset {record.number} is of type {kind}"
            )
        if len(record.fields["x"]) != len(first.fields["x"]):
            raise SceneError(
                f"response must be datasets of equal length, got {len(first.fields['x'])} samples "
                f"in {first.number} and {len(record.fields['x'])} in {record.number} of "
                f"{str(file)!r}"
            )
    return np.asarray(first.fields["x"], dtype=np.float64)


def _own_universal(
    file: Path, found: Sequence[uff.FileFunction], own: Sequence[re.Match[str] | None]
) -> RecordContent:
    changed = f"path must be a file that nobody changed, got {str(file)!r}"
    match = OWN_TIME.match(found[0].fields["id3"])
    with reading(file, "a file that nobody changed"):
        if match is None:
            raise ValueError(found[0].fields["id3"])
        start, rate = float(match["start"]), float(match["rate"])
        rows = np.array([record.fields["data"] for record in found], dtype=np.float64)
        with np.errstate(over="ignore"):
            time = start + np.arange(rows.shape[1]) / rate if rate > 0 else np.full(1, np.inf)
        if not np.isfinite(time).all():
            raise ValueError(match["rate"])
        points = [(m["name"], float(m["x"])) for m in own if m is not None]
    kinds = [m["what"] for m in own if m is not None]
    pushed = kinds[-1] == "force"
    order = uff.MOTION.get(found[0].fields["ordinate_spec_data_type"])
    quantity = next((word for word, k in MOTIONS.items() if k == order), None)
    if quantity is None or "force" in kinds[:-1] or (pushed and len(kinds) == 1):
        raise SceneError(changed)
    return RecordContent(
        time=time,
        value=rows[:-1] if pushed else rows,
        rate=rate,
        response=points[:-1] if pushed else points,
        quantity=quantity,
        force=rows[-1] if pushed else None,
        drive=points[-1] if pushed else None,
    )


def _write_universal(motion: RecordContent, file: Path, binary: bool) -> None:
    if np.isnan(motion.value).any():
        raise SceneError("value must be without gaps to be written as a universal file: write .csv")
    points = [*motion.response, *([motion.drive] if motion.drive else [])]
    rows = [*motion.value, *([motion.force] if motion.drive else [])]
    nodes = {x: k for k, x in enumerate(sorted({x for _, x in points}), start=1)}
    datasets = [uff.si_units()]
    for k, (point, row) in enumerate(zip(points, rows)):
        pushes = k == len(motion.response)
        common = _header(motion, point, pushes) | {"binary": int(binary)}
        datasets.append(common | {"data": row, "x": motion.time, "rsp_node": nodes[point[1]]})
    uff.write_all(file, datasets)


def _header(motion: RecordContent, point: Any, pushes: bool) -> dict[str, Any]:
    """Return the fields of one channel."""
    order = MOTIONS[motion.quantity]
    kind = next(code for code, times in uff.MOTION.items() if times == order)
    unit = FORCE_UNIT[point[0]] if pushes else UNIT[point[0]] + ("", "/s", "/s2")[order]
    assert motion.time is not None
    return {
        "type": uff.FUNCTION,
        "func_type": HISTORY,
        "id1": f"force in {place(point)}" if pushes else label(point, quantity=motion.quantity),
        "id2": f"ropedyn {'force' if pushes else 'motion'} {point[0]} {float(point[1])!r}",
        "id3": f"ropedyn start {float(motion.time[0])!r} rate {motion.rate!r}",
        "rsp_dir": uff.CODE[point[0]],
        "ref_node": 0,
        "ref_dir": 0,
        "abscissa_spacing": 1,
        "abscissa_spec_data_type": OVER_TIME,
        "abscissa_axis_lab": "Time",
        "abscissa_axis_units_lab": "s",
        "ordinate_spec_data_type": uff.FORCE[0] if pushes else kind,
        "ordinate_axis_lab": "Force" if pushes else motion.quantity.capitalize(),
        "ordinate_axis_units_lab": unit,
        "orddenom_spec_data_type": uff.UNSAID[0],
    }


LAYOUT = Layout(None, ".", "#", 0)._asdict()
"""How text is split where nothing is said."""
