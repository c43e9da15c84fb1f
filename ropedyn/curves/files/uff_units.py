"""Units of functions in universal files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...base import check
from ...base.errors import SceneError
from ...base.unit import QUANTITIES
from ...chain.port import Point
from ..motion_unit import Unit, dimensions, ratio, side, stated
from ..motion_unit import scale as scaled
from .uff import FORCE, MOTION, UNSAID, Record, label_of
from .uff_points import Line


def scale(
    line: Line, file: Path, unit: str | None, quantity: str | None, reciprocal: bool
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


def _said(record: Record, where: str, ends: tuple[Point, Point]) -> tuple[Unit, Unit]:
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


def _by_dataset(record: Record, ends: tuple[Point, Point]) -> tuple[Unit | None, Unit | None]:
    """Return what dataset 164 and the types of the ordinate make of motion and force."""
    kind, over = (record.fields[f"{side}_spec_data_type"] for side in ("ordinate", "orddenom"))
    if record.units is None:
        return None, None
    length, force = record.units
    above, below = dimensions(*ends)
    size = {"m": 1 / length, "rad": 1.0, "N": 1 / force, "N m": 1 / (length * force)}
    motion = Unit(above, MOTION[kind], size[above]) if kind in MOTION else None
    return motion, Unit(below, 0, size[below]) if over in FORCE else None
