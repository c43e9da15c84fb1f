"""Which calculated frequencies and responses the measured ones are."""

from __future__ import annotations

import math

import numpy as np

from ...base.array import Complex, Index, Integer, Real
from ...base.errors import SceneError
from ...base.unit import QUANTITIES, place
from ...curves.measured import Measured
from ...model import Model
from ...response.frf import FRF
from ...space.model import SpaceModel
from .calculated import index

CLOSE = 0.1  # Frequencies nearer than this part of their mean distance are close to each other.
ALONE = math.log(2.0)  # A frequency without neighbour is spaced like the first two of a string.
SPREAD = 3.0  # A measured frequency may be off by so many standard uncertainties.
SAME = 1e-9  # Lines that differ by less than this share are one.


def reach(calculated: Real) -> Real:
    """Return half the distance to the farther neighbour, in logarithms: partners are no farther."""
    log = np.log(calculated)
    mean = (log[-1] - log[0] + ALONE) / len(log)
    group = np.append(0, np.cumsum(np.diff(log) > CLOSE * mean))
    gap = np.diff(np.bincount(group, log) / np.bincount(group))
    if len(gap) == 0:
        return np.full(len(log), ALONE / 2)
    wider = np.maximum(np.append(gap[0], gap), np.append(gap, gap[-1]))
    return np.asarray(wider[group] / 2)


def paired(
    measured: Real, calculated: Real, *, std: Real | None = None, within: float | None = None
) -> Integer:
    """Pair frequencies: squares of distances, and of the reach of what is left out, are least."""
    from scipy.optimize import linear_sum_assignment

    order = np.zeros(len(measured), dtype=np.int64)
    if len(measured) == 0 or len(calculated) == 0:
        return order
    distance = np.abs(np.log(np.divide.outer(measured, calculated)))
    price = reach(calculated) ** 2 + np.zeros_like(distance)
    if within is not None:
        spread = np.zeros(len(measured)) if std is None else SPREAD * np.nan_to_num(std) / measured
        price = np.minimum(price, (math.log1p(within) + spread[:, None]) ** 2)
    saved = np.maximum(price - distance**2, 0.0)
    row, column = linear_sum_assignment(saved, maximize=True)
    close = saved[row, column] > 0
    order[row[close]] = column[close] + 1
    return order


def drive_of(calculated: FRF, measured: Measured) -> int:
    """Return which drive of a calculated response is that of a measured one."""
    at = index(calculated.drive, measured.drive[0])
    if at is None:
        raise SceneError(
            f"calculated must be driven in {place(measured.drive[0])}, as measured, got "
            + ", ".join(map(place, calculated.drive))
        )
    return at


def calculated_at(calculated: Model | SpaceModel | FRF, measured: Measured) -> Complex:
    """Return the calculated responses as measured: points, lines and quantity."""
    if isinstance(calculated, (Model, SpaceModel)):
        return calculated.frf(
            measured.frequency,
            drive=measured.drive[0],
            response=list(measured.response),
            quantity=measured.quantity,
            decay=measured.decay,
        ).value
    drive = drive_of(calculated, measured)
    lines = _lines(calculated, measured)
    rows = []
    for k, point in enumerate(measured.response):
        at = index(calculated.response, point)
        if at is None:
            raise SceneError(
                f"calculated must have measured.response[{k}], {place(point)}, got "
                + ", ".join(map(place, calculated.response))
            )
        rows.append(calculated.curve(at, drive)[lines])
    if calculated.decay != measured.decay:
        raise SceneError(
            f"calculated must be a Model or have the decay of measured, {measured.decay:g} 1/s, "
            f"got {calculated.decay:g} 1/s"
        )
    # at lines above 0 Hz motion can be integrated
    times = QUANTITIES[measured.quantity] - QUANTITIES[calculated.quantity]
    return np.asarray(np.stack(rows) * measured.s**times)


def _lines(calculated: FRF, measured: Measured) -> Index:
    """Return which lines are those of the measurement."""
    line, first = np.unique(calculated.frequency, return_index=True)
    above = line > 0
    line, first = line[above], first[above]
    f = measured.frequency
    if len(line) != len(f) or not np.allclose(line, f, rtol=SAME, atol=0.0):
        raise SceneError(
            "calculated must be a Model or a response at the measured lines, "
            f"{_range(f)}, got one at {_range(line)}"
        )
    return first


def _range(lines: Real) -> str:
    if len(lines) == 0:
        return "none"
    return f"{len(lines)} from {lines[0]:g} to {lines[-1]:g} Hz"
