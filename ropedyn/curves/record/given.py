"""Checks of what a record is made of."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...base import check
from ...base.array import Real
from ...base.errors import SceneError
from ...base.unit import FORCE_UNIT, curve_unit, is_quantity, magnitude
from ...chain.port import Point

LEAST = 16  # Samples of a record at least.
MOST_ABSENT = 0.5  # A channel has at most this share of its samples missing.


def points_of(given: Any) -> tuple[Point, ...]:
    """Return the points of response."""
    what = 'a point such as ("z", 3.5) for each channel, or a list of them'
    check.instance(given, "response", (list, tuple), what)
    if not given:
        raise SceneError(f"response must be {what}, got {given!r}")
    each = [given] if isinstance(given[0], str) else given
    return tuple(_place(one, f"response[{k}]") for k, one in enumerate(each))


def drive_of(given: Any, force: Any) -> Point | None:
    """Return the point that the force acts on, None where there is no force."""
    if (given is None) != (force is None):
        alone = "force" if given is None else "drive"
        raise SceneError(f"force and drive must be given together, got {alone} alone")
    return None if given is None else _place(given, "drive")


def _place(given: Any, name: str) -> Point:
    """Return a point of a rope whose length is not known."""
    coordinate, x = check.point(given, name, check.COORDINATES, None)
    return coordinate, check.number(x, f"{name}[1]", "m", sign="nonnegative")


def times_given(given: Any, rate: float | None, count: int) -> Real:
    """Return the times of so many samples."""
    if given is None:
        if rate is None:
            raise SceneError("time must be given, or rate [Hz] in its place, got None")
        return np.arange(count) / rate
    time = check.numbers(given, "time", "s")
    if len(time) != count:
        raise SceneError(f"time must be as long as each row of value, {count}, got {len(time)}")
    return time


def channels_given(given: Any, points: Sequence[Point], quantity: str, missing: str) -> Real:
    """Return values (channels, t), NaN where they may be missing."""
    units = {curve_unit(point, None, quantity) for point in points}
    if len(units) > 1 and is_quantity(given):
        raise SceneError(
            "value must be plain numbers where channels have different units "
            f"({', '.join(sorted(units))}), got {check.shown(given)}"
        )
    unit = units.pop()
    value = np.atleast_2d(_numbers(given, "value", unit))
    if value.ndim != 2 or len(value) != len(points):
        turned = value.ndim == 2 and value.shape[1] == len(points)
        raise SceneError(
            f"value must have a row for each of {len(points)} points of response, got shape "
            f"{value.shape}{': transpose it' if turned else ''}"
        )
    if value.shape[1] < LEAST:
        raise SceneError(f"value must have at least {LEAST} samples, got {value.shape[1]}")
    for k, row in enumerate(value):
        _finite(row, f"value[{k}]", missing)
    return value


def force_given(given: Any, drive: Point | None, count: int, missing: str) -> Real | None:
    """Return a force (t,), NaN where it may be missing."""
    if drive is None:
        return None
    force = _numbers(given, "force", FORCE_UNIT[drive[0]])
    if force.ndim == 2 and len(force) == 1:
        force = force[0]
    if force.shape != (count,):
        raise SceneError(
            f"force must be one row as long as each of value, {count}, got shape {force.shape}"
        )
    _finite(force, "force", missing)
    return force


def _numbers(given: Any, name: str, unit: str) -> Real:
    """Return a new array of numbers."""
    what = f"{name} must be an array of numbers [{unit}]"
    if is_quantity(given):
        try:
            given = magnitude(given, unit)
        except ValueError as error:
            raise SceneError(f"{what}, got {check.shown(given)}") from error
    try:
        array = np.array(given)
    except ValueError as error:
        raise SceneError(f"{what} with rows of equal length, got {check.shown(given)}") from error
    if array.size == 0:
        raise SceneError(f"{what}, got none")
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{what}, got {check.shown(given)}")
    return array.astype(np.float64)


def _finite(row: Real, name: str, missing: str) -> None:
    """Refuse what is infinite, and what is missing unless that was said."""
    good = np.isfinite(row)
    if missing == "gap":
        absent = np.isnan(row)
        good |= absent
        if absent.mean() > MOST_ABSENT:
            raise SceneError(
                f"{name} must be there at least half of the time, got {int(absent.sum())} of "
                f"{len(row)} samples missing: leave the channel out"
            )
    if not good.all():
        k = int(good.argmin())
        hint = ': missing="gap" makes it a gap' if np.isnan(row[k]) else ""
        raise SceneError(f"{name}[{k}] must be a finite number, got {float(row[k])}{hint}")
