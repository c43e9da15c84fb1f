"""Measured and calculated responses at the same lines, between the same points."""

from __future__ import annotations

import numpy as np

from ...base.array import Complex, Index, Real
from ...base.errors import SceneError
from ...base.unit import QUANTITIES, place
from ...curves.measured import Measured
from ...model import Model
from ...response.frf import FRF
from .calculated import index

SAME = 1e-9  # Lines that differ by less than this share are one.


def drive_of(calculated: FRF, measured: Measured) -> int:
    """Return which drive of a calculated response is that of a measured one."""
    at = index(calculated.drive, measured.drive[0])
    if at is None:
        raise SceneError(
            f"calculated must be driven in {place(measured.drive[0])}, as measured, got "
            + ", ".join(map(place, calculated.drive))
        )
    return at


def calculated_at(calculated: Model | FRF, measured: Measured) -> Complex:
    """Return the calculated responses as measured: points, lines and quantity."""
    if isinstance(calculated, Model):
        return calculated.frf(
            measured.frequency,
            drive=measured.drive[0],
            response=list(measured.response),
            quantity=measured.quantity,
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
    # at lines above 0 Hz motion can be integrated
    times = QUANTITIES[measured.quantity] - QUANTITIES[calculated.quantity]
    return np.asarray(np.stack(rows) * (2j * np.pi * measured.frequency) ** times)


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
