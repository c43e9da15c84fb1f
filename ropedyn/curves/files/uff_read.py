"""Frequency responses out of universal files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ...base import check
from ...base.array import Real
from ...base.errors import SceneError
from . import uff
from .uff import AVERAGES, COHERENCE, FREQUENCY, FRF, UNSAID, Record, label_of
from .uff_points import Line, chosen, located
from .uff_units import scale

SAME = 1e-6
"""A relative distance of frequencies: they may have six digits."""

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
) -> dict[str, Any]:
    """Read what a `Measured` is made of; see `Measured.read`."""
    found = uff.read(file, lambda fields: fields["func_type"] in (FRF, COHERENCE))
    found = _numbered(found, records, file)
    functions = [r for r in found if r.fields["func_type"] == FRF]
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
    return {
        "frequency": frequency,
        "value": np.array([line.record.fields["data"] for line in lines]),
        "factor": [line.sign * size for line, (_, size) in zip(lines, scales)],
        "drive": lines[0].drive,
        "response": [line.response for line in lines],
        "quantity": names.pop(),
        "coherence": _coherence(lines, found, file),
        "averages": _averages(lines),
    }


def _numbered(found: Sequence[Record], records: Any, file: Path) -> list[Record]:
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


def _frequency(record: Record, file: Path) -> Real:
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


def _coherence(lines: Sequence[Line], found: Sequence[Record], file: Path) -> Real | None:
    """Return the coherence of each response, by its nodes and directions; None without any."""
    frequency = _frequency(lines[0].record, file)
    rows = []
    for line in lines:
        key = _key(line.record)
        same = [r for r in found if r.fields["func_type"] == COHERENCE and _key(r) == key]
        if len(same) > 1:
            raise SceneError(
                f"records must leave one of datasets {[r.number for r in same]} of {str(file)!r}: "
                f"all are the coherence of dataset {line.record.number}"
            )
        rows += same
    if not rows:
        return None
    if len(rows) < len(lines):
        raise SceneError(
            f"path must hold a coherence for each response or for none, got {str(file)!r} with "
            f"{len(rows)} for {len(lines)}: choose by response= or records="
        )
    for row in rows:
        if np.iscomplexobj(row.fields["data"]) or not _alike(frequency, _frequency(row, file)):
            raise SceneError(
                f"path must hold real coherences at the frequencies of the response, got "
                f"{str(file)!r} with others in dataset {row.number}"
            )
    return np.array([row.fields["data"] for row in rows])


def _key(record: Record) -> tuple[int, ...]:
    fields = record.fields
    nodes = (fields["rsp_node"], fields["ref_node"])
    return (*nodes, abs(fields["rsp_dir"]), abs(fields["ref_dir"]))


def _averages(lines: Sequence[Line]) -> float | None:
    """Return the number of averages that `write` has written down."""
    said = {match[1] for line in lines if (match := AVERAGES.match(line.record.fields["id5"]))}
    try:
        return float(said.pop()) if len(said) == 1 else None
    except ValueError:
        return None
