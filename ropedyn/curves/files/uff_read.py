"""Responses out of universal files: which, where on the rope, in which unit."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...base import check
from ...base.array import Real
from ...base.errors import SceneError, at_once
from ...base.reading import reading
from ...base.unit import QUANTITIES
from ...chain.port import Point
from ..motion_unit import Unit, dimensions, ratio, side, stated
from ..motion_unit import scale as scaled
from . import Content, uff
from .uff import (
    AVERAGES,
    COHERENCE,
    DECAY,
    DIRECTIONS,
    FORCE,
    FREQUENCY,
    FRF,
    GENERAL,
    MOTION,
    OWN,
    SPREAD,
    UNSAID,
    FileFunction,
    label_of,
)

SAME = 1e-6
"""Frequencies nearer than this relative distance are the same: they may have six digits."""
HERTZ = {
    "Hz": 1.0,
    "HZ": 1.0,
    "hz": 1.0,
    "kHz": 1e3,
    "rad/s": 0.5 / np.pi,
    "rpm": 1 / 60,
    "RPM": 1 / 60,
}
"""Units of frequency; where the label says none, it is Hz."""


def read(
    file: Path,
    *,
    drive: Any,
    response: Any,
    unit: Any,
    quantity: str | None,
    positions: Any,
    coordinate: Any,
    reciprocal: bool,
    records: Any,
) -> Content:
    """Read what a `Measured` is made of; see `Measured.read`."""
    found = uff.read(
        file, lambda fields: _is_spread(fields) or fields["func_type"] in (FRF, COHERENCE)
    )
    found = _numbered(found, records, file)
    functions = [r for r in found if r.fields["func_type"] == FRF]
    _ask_at_once(functions, file, positions, coordinate, unit)
    lines = located(functions, file, positions, coordinate)
    if reciprocal:
        lines = [line._replace(response=line.drive, drive=line.response) for line in lines]
    lines = chosen(lines, file, drive, response)
    frequency = _frequency(lines[0].record, file)
    for line in lines[1:]:
        if not _alike(frequency, _frequency(line.record, file)):
            raise SceneError(
                f"path must hold the same frequencies for each response, got {str(file)!r} with "
                f"others in dataset {line.record.number} than in {lines[0].record.number}"
            )
    units = _listed(unit, len(lines))
    scales = [scale(line, file, one, quantity, reciprocal) for line, one in zip(lines, units)]
    names = {word for word, _ in scales}
    if len(names) > 1:
        raise SceneError(
            f"quantity must be one for all responses, got {sorted(names)} in {str(file)!r}: choose "
            "some by response="
        )
    factor = [line.sign * size for line, (_, size) in zip(lines, scales)]
    value = np.array([line.record.fields["data"] for line in lines])
    return Content(
        frequency=frequency,
        value=value * np.reshape(factor, (-1, 1)),
        drive=lines[0].drive,
        response=[line.response for line in lines],
        quantity=names.pop(),
        coherence=_beside(lines, [r for r in found if r.fields["func_type"] == COHERENCE], file),
        averages=_noted(lines, "id5", AVERAGES),
        std=_spread(lines, [r for r in found if _is_spread(r.fields)], factor, file),
        decay=_noted(lines, "id4", DECAY) or 0.0,
    )


def _ask_at_once(
    records: Sequence[FileFunction], file: Path, positions: Any, coordinate: Any, unit: Any
) -> None:
    """Refuse in one error all that a file does not say and nobody has said."""
    if all(OWN.match(record.fields["id2"]) for record in records):
        return
    code = min(r.fields[side] for r in records for side in ("rsp_dir", "ref_dir"))
    of_points = (
        partial(_positions, positions, records, file),
        partial(_turned, code, coordinate, records, file),
    )
    with suppress(SceneError):
        at_once(*of_points)
        return  # those that are left out need no unit
    at_once(*of_points, partial(_refuse_without_unit, records, file, unit))


def _refuse_without_unit(records: Sequence[FileFunction], file: Path, unit: Any) -> None:
    labels = ("ordinate_axis_units_lab", "orddenom_axis_units_lab")
    for record in records if unit is None else ():
        if record.units is None and not any(label_of(record.fields[one]) for one in labels):
            raise SceneError(
                f'unit must be stated, such as "m/s^2/N" or "g/N": dataset {record.number} of '
                f"{str(file)!r} says none"
            )


def _numbered(found: Sequence[FileFunction], records: Any, file: Path) -> list[FileFunction]:
    """Return the records of these numbers, or all."""
    if records is None:
        chosen = list(found)
    else:
        numbers = [records] if isinstance(records, int) else records
        check.instance(numbers, "records", (list, tuple, range), "numbers of datasets, from 0")
        missing = [n for n in numbers if n not in {record.number for record in found}]
        if missing:
            raise SceneError(
                f"records must be numbers out of {[r.number for r in found]}, the frequency "
                f"responses and coherences of {str(file)!r}, got {check.shown(missing[0])}"
            )
        chosen = [record for record in found if record.number in numbers]
    if all(record.fields["func_type"] != FRF for record in chosen):
        raise SceneError(
            f"path must be a universal file with a frequency response (dataset 58, function type "
            f"4), got {str(file)!r} with none"
        )
    return chosen


def _listed(unit: Any, lines: int) -> list[str | None]:
    """Return a stated unit for each line."""
    if unit is None or isinstance(unit, str):
        return [unit] * lines
    check.instance(unit, "unit", (list, tuple), "a unit, or one for each response")
    if len(unit) != lines:
        raise SceneError(f"unit must be one, or {lines} as there are responses, got {len(unit)}")
    return list(unit)


def _frequency(record: FileFunction, file: Path) -> Real:
    """Return the frequencies of a record [Hz]."""
    kind, text = record.fields["abscissa_spec_data_type"], record.fields["abscissa_axis_units_lab"]
    said = label_of(text)
    if kind not in (FREQUENCY, *UNSAID) or (said or "Hz") not in HERTZ:
        raise SceneError(
            f"path must be a universal file over frequency, got {str(file)!r}: the abscissa of "
            f"dataset {record.number} is of type {kind} [{text}]"
        )
    return np.asarray(record.fields["x"] * HERTZ[said or "Hz"], dtype=np.float64)


def _alike(a: Real, b: Real) -> bool:
    return len(a) == len(b) and np.allclose(a, b, rtol=SAME, atol=0.0)


def _is_spread(fields: uff.Fields) -> bool:
    """Whether a function is the standard deviation that `write` has written."""
    return bool(fields["func_type"] == GENERAL and fields["ordinate_axis_lab"].strip() == SPREAD)


def _spread(
    lines: Sequence[Located], found: Sequence[FileFunction], factor: Sequence[float], file: Path
) -> Real | None:
    """Return the standard deviation of each response in SI; None without any."""
    std = _beside(lines, found, file)
    return None if std is None else std * np.abs(np.reshape(factor, (-1, 1)))


def _beside(lines: Sequence[Located], found: Sequence[FileFunction], file: Path) -> Real | None:
    """Return what else is known of each response, by nodes and directions; None without any."""
    frequency = _frequency(lines[0].record, file)
    rows = []
    for line in lines:
        key = _key(line.record)
        same = [r for r in found if _key(r) == key]
        if len(same) > 1:
            raise SceneError(
                f"records must leave one of datasets {[r.number for r in same]} of {str(file)!r}: "
                f"all are the {_kind(same[0])} of dataset {line.record.number}"
            )
        rows += same
    if not rows:
        return None
    if len(rows) < len(lines):
        raise SceneError(
            f"path must hold a {_kind(rows[0])} for each response or for none, got {str(file)!r} "
            f"with {len(rows)} for {len(lines)}: choose by response= or records="
        )
    for row in rows:
        if np.iscomplexobj(row.fields["data"]) or not _alike(frequency, _frequency(row, file)):
            raise SceneError(
                f"path must hold real {_kind(row)}s at the frequencies of the response, got "
                f"{str(file)!r} with others in dataset {row.number}"
            )
    return np.array([row.fields["data"] for row in rows])


def _kind(record: FileFunction) -> str:
    return SPREAD.lower() if _is_spread(record.fields) else "coherence"


def _key(record: FileFunction) -> tuple[int, ...]:
    fields = record.fields
    nodes = (fields["rsp_node"], fields["ref_node"])
    return (*nodes, abs(fields["rsp_dir"]), abs(fields["ref_dir"]))


def _noted(lines: Sequence[Located], field: str, words: re.Pattern[str]) -> float | None:
    """Return a number that `write` has written down for all of them."""
    said = {match[1] for line in lines if (match := words.match(line.record.fields[field]))}
    try:
        return float(said.pop()) if len(said) == 1 else None
    except ValueError:
        return None


# --- nodes and directions as points of a rope ---------------------------------------------------


AXES = ("X", "Y", "Z")  # Axes along which the nodes of a file may be.


class Located(NamedTuple):
    """One response to one drive."""

    record: FileFunction
    response: Point
    drive: Point
    sign: int


def located(
    records: Sequence[FileFunction], file: Path, positions: Any, coordinate: Any
) -> list[Located]:
    """Say where on the rope each record is and which way it counts."""
    own = [(record, m) for record in records if (m := OWN.match(record.fields["id2"]))]
    if positions is None and coordinate is None and len(own) == len(records):
        with reading(file, "a file that nobody changed"):
            return [_own(record, match) for record, match in own]
    where = _positions(positions, records, file)
    lines = []
    for record in records:
        rx, dx = (where[record.fields[side]] for side in ("rsp_node", "ref_node"))
        if rx is None or dx is None:
            continue
        codes = [record.fields[side] for side in ("rsp_dir", "ref_dir")]
        (r, plus), (d, minus) = (_turned(code, coordinate, records, file) for code in codes)
        lines.append(Located(record, (r, rx), (d, dx), plus * minus))
    if not lines:
        raise SceneError(f"positions must leave a response of {str(file)!r}, got {positions!r}")
    return lines


def _own(record: FileFunction, match: re.Match[str]) -> Located:
    """Return the points that `write` has written down."""
    points = []
    for name, x in (match["r"], match["rx"]), (match["d"], match["dx"]):
        try:
            at = float(x)
        except ValueError:
            at = np.nan
        points.append(
            check.point((name, at), "the second line of a record", check.COORDINATES, None)
        )
    return Located(record, points[0], points[1], 1)


def _positions(given: Any, records: Sequence[FileFunction], file: Path) -> dict[int, float | None]:
    """Return where each node is, None for one that is left out."""
    nodes = sorted({record.fields[side] for record in records for side in ("rsp_node", "ref_node")})
    what = f"a position [m] for each node of {str(file)!r} ({', '.join(map(str, nodes))})"
    if given is None:
        raise SceneError(
            f'positions must be {what}, such as {{{nodes[0]}: 0.5}}, or "X", "Y" or "Z", got None'
        )
    if isinstance(given, str):
        axis = check.one_of(given, "positions", AXES)
        given = uff.nodes(file, axis)
    check.instance(given, "positions", Mapping, what)
    for node in nodes:
        if node not in given:
            raise SceneError(
                f"positions must be {what}, got {check.shown(dict(given))} without node {node}; "
                "None leaves a node out"
            )
    return {node: check.optional(given[node], f"positions[{node}]", "m") for node in nodes}


def _turned(
    code: int, coordinate: Any, records: Sequence[FileFunction], file: Path
) -> tuple[str, int]:
    """Return which coordinate of the rope a direction is and with which sign."""
    axis = DIRECTIONS[abs(code)] if abs(code) < len(DIRECTIONS) else str(code)
    codes = {abs(r.fields[side]) for r in records for side in ("rsp_dir", "ref_dir")}
    axes = [DIRECTIONS[k] if k < len(DIRECTIONS) else str(k) for k in sorted(codes)]
    what = f"which coordinate of the rope each direction in {str(file)!r} is ({', '.join(axes)})"
    such = f'such as {{"{axes[0]}": "z"}}'
    if isinstance(coordinate, str) and len(axes) == 1:
        coordinate = {axes[0]: coordinate}
    if not isinstance(coordinate, (str, Mapping, type(None))):
        raise TypeError(f"coordinate must say {what}, {such}, got {check.shown(coordinate)}")
    if not isinstance(coordinate, Mapping) or axis not in coordinate:
        raise SceneError(f"coordinate must say {what}, {such}, got {check.shown(coordinate)}")
    name = coordinate[axis]
    signed = [sign + word for word in check.COORDINATES for sign in ("", "-")]
    check.one_of(name, f"coordinate[{axis!r}]", signed)
    sign = -1 if name.startswith("-") != (code < 0) else 1
    return name.removeprefix("-"), sign


def chosen(lines: Sequence[Located], file: Path, drive: Any, response: Any) -> list[Located]:
    """Return the responses to one drive, one for each point."""
    drives = list(dict.fromkeys(line.drive for line in lines))
    if drive is None and len(drives) > 1:
        one = len({line.response for line in lines}) == 1
        raise SceneError(
            f"drive must be one of those of {str(file)!r}, {_list(drives)}, got None"
            + one * "; with reciprocal=True these are watched and what was watched is driven"
        )
    cause = drives[0] if drive is None else _one(drive, "drive", drives, file)
    to_it = [line for line in lines if line.drive == cause]
    if response is not None:
        points = check.points(response, "response", forces=True)
        points = (points,) if isinstance(points[0], str) else points
        there = list(dict.fromkeys(line.response for line in to_it))
        wanted = [_one(point, "response", there, file) for point in points]
        to_it = [line for point in wanted for line in to_it if line.response == point]
    for k, line in enumerate(to_it):
        for other in to_it[:k]:
            if other.response == line.response:
                both = f"{other.record.number} and {line.record.number} of {str(file)!r}"
                raise SceneError(
                    f"records must leave one of datasets {both}: both are {line.response!r} to "
                    f"{cause!r}"
                )
    return to_it


def _one(given: Any, name: str, there: Sequence[Point], file: Path) -> Point:
    point = check.points(given, name, forces=name == "response")
    for one in there:
        if point[0] == one[0] and abs(point[1] - one[1]) <= check.NEAR * abs(one[1]):
            return one
    raise SceneError(f"{name} must be one of those of {str(file)!r}, {_list(there)}, got {given!r}")


def _list(points: Sequence[Point]) -> str:
    return ", ".join(map(repr, points))


# --- units --------------------------------------------------------------------------------------


def scale(
    line: Located, file: Path, unit: str | None, quantity: str | None, reciprocal: bool
) -> tuple[str, float]:
    """Return the quantity of a record and what makes it SI."""
    fields = line.record.fields
    where = f"dataset {line.record.number} of {str(file)!r}"
    if not np.iscomplexobj(fields["data"]):
        raise SceneError(f"path must hold complex responses, got real numbers in {where}")
    kind, over = fields["ordinate_spec_data_type"], fields["orddenom_spec_data_type"]
    if kind not in (*MOTION, *UNSAID) or over not in (*FORCE, *UNSAID):
        raise SceneError(
            f"path must hold motion per force, got {where}: ordinate type {kind} over {over}"
        )
    ends = (line.drive, line.response) if reciprocal else (line.response, line.drive)
    sides = _said(line.record, where, ends) if unit is None else stated(unit)
    name, size = scaled(sides, *ends, f"unit of {where}" if unit is None else "unit")
    expected = quantity
    if expected is None and kind in MOTION:
        expected = next(word for word, order in QUANTITIES.items() if order == MOTION[kind])
    elif expected is not None:
        check.one_of(expected, "quantity", QUANTITIES)
    if expected not in (None, name):
        raise SceneError(
            f"unit and quantity must agree, got {name} by unit and {expected} by "
            f"{'quantity' if quantity else 'the type of the ordinate'} for {where}"
        )
    return name, size


def _said(record: FileFunction, where: str, ends: tuple[Point, Point]) -> tuple[Unit, Unit]:
    """Return the unit that a record says itself, by its labels or by dataset 164."""
    fields = record.fields
    above = label_of(fields["ordinate_axis_units_lab"])
    below = label_of(fields["orddenom_axis_units_lab"])
    whole = ratio(above)
    by_label = whole if whole is not None and not below else (side(above), side(below))
    by_units = _by_dataset(record, ends)
    found = []
    for text, labelled, general in zip((above, below), by_label, by_units):
        if text and labelled is None:
            raise SceneError(f"unit must be stated: {where} says {text!r}, which is not known")
        if labelled and general and not np.isclose(labelled.size, general.size, rtol=1e-6):
            raise SceneError(
                f"unit must be stated: {where} says {text!r} but dataset 164 a unit of "
                f"{general.size:g} in SI"
            )
        one = labelled or general
        if one is None:
            raise SceneError(
                f'unit must be stated, such as "m/s^2/N" or "g/N": {where} says {above or None!r} '
                f"per {below or None!r} and no dataset 164 stands before it"
            )
        found.append(one)
    return found[0], found[1]


def _by_dataset(record: FileFunction, ends: tuple[Point, Point]) -> tuple[Unit | None, Unit | None]:
    """Return what dataset 164 and the types of the ordinate make of motion and force."""
    kind, over = (record.fields[f"{side}_spec_data_type"] for side in ("ordinate", "orddenom"))
    if record.units is None:
        return None, None
    length, force = record.units
    above, below = dimensions(*ends)
    size = {"m": 1 / length, "rad": 1.0, "N": 1 / force, "N m": 1 / (length * force)}
    motion = Unit(above, MOTION[kind], size[above]) if kind in MOTION else None
    return motion, Unit(below, 0, size[below]) if over in FORCE else None
