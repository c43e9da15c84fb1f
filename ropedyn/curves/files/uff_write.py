"""Frequency responses into universal files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...base.array import Complex, Real
from ...base.errors import SceneError
from ...base.unit import QUANTITIES, label
from ...chain.port import Point
from ..motion_unit import dimensions
from . import uff
from .uff import COHERENCE, FORCE, FREQUENCY, FRF, MOTION, UNSAID, Fields

if TYPE_CHECKING:
    from ..curves import Curves

EVEN = 1e-13
"""A relative distance of frequencies: rounding of start + k step."""

CODE = {"x": 1, "z": 3, "alpha": 4, "beta": -5}
"""Directions: x along the rope and z of a right-handed system, where dz/dx turns against +Y."""


def write(curves: Curves, path: Path, binary: bool) -> None:
    """Write responses, and their coherences, as datasets 58 in SI; see `Curves.write`."""
    _refuse(curves)
    points = [*curves.drive, *curves.response]
    nodes = {x: k for k, x in enumerate(sorted({x for _, x in points}), start=1)}
    datasets: list[Fields] = [_units()]
    coherence = getattr(curves, "coherence", None)
    for d, drive in enumerate(curves.drive):
        for r, response in enumerate(curves.response):
            common = _common(curves, nodes, drive, response, binary)
            datasets.append(common | _ordinate(curves, drive, response, curves.curve(r, d)))
            if coherence is not None:
                datasets.append(common | _share(coherence[r]))
    uff.write(path, datasets)


def _refuse(curves: Curves) -> None:
    """Refuse what a dataset 58 has no words for."""
    for name, points in ("drive", curves.drive), ("response", curves.response):
        for k, point in enumerate(points):
            if point[0] not in CODE:
                raise SceneError(
                    f"{name}[{k}] must be a coordinate at a position to be written as a universal "
                    f"file, got {point!r}: write a .csv"
                )
    if len(curves.frequency) < 2:
        raise SceneError("frequency must have at least two lines for a universal file, got 1")


def _units() -> Fields:
    return {
        "type": uff.UNITS,
        "units_code": 1,
        "units_description": "SI",
        "temp_mode": 1,
        "length": 1.0,
        "force": 1.0,
        "temp": 1.0,
        "temp_offset": 273.15,
    }


def _common(
    curves: Curves, nodes: Mapping[float, int], drive: Point, response: Point, binary: bool
) -> Fields:
    """Return the fields of a function and of its coherence."""
    (r, rx), (d, dx) = response, drive
    averages = getattr(curves, "averages", None)
    return {
        "type": uff.FUNCTION,
        "binary": int(binary),
        "id1": label(response, drive, curves.quantity),
        "id2": f"ropedyn {r} {float(rx)!r} per {d} {float(dx)!r}",
        "id5": "NONE" if averages is None else f"ropedyn averages {averages!r}",
        "rsp_node": nodes[rx],
        "rsp_dir": CODE[r],
        "ref_node": nodes[dx],
        "ref_dir": CODE[d],
        "x": curves.frequency,
        "abscissa_spacing": int(_is_even(curves.frequency, binary)),
        "abscissa_spec_data_type": FREQUENCY,
        "abscissa_axis_lab": "Frequency",
        "abscissa_axis_units_lab": "Hz",
        "orddenom_spec_data_type": UNSAID[0],
    }


def _is_even(frequency: Real, binary: bool) -> bool:
    """Whether the start and the step, with the 6 digits a header has, are the frequencies.

    Else each is written: with 6 digits too, or in full where the file is binary.
    """
    start, step = (float(f"{x:.5e}") for x in (frequency[0], frequency[1] - frequency[0]))
    written = start + np.arange(len(frequency)) * step
    if binary:
        return bool((written == frequency).all())
    if np.allclose(written, frequency, rtol=EVEN, atol=0.0):
        return True
    if (np.diff([float(f"{x:.5e}") for x in frequency]) <= 0).any():
        raise SceneError(
            "frequency must increase in the 6 digits of an ASCII universal file, got a step of "
            f"{np.diff(frequency).min():g} Hz: write a binary one"
        )
    return False


def _ordinate(curves: Curves, drive: Point, response: Point, curve: Complex) -> Fields:
    order = QUANTITIES[curves.quantity]
    above, below = dimensions(response, drive)
    kind = next(code for code, times in MOTION.items() if times == order)
    return {
        "func_type": FRF,
        "data": curve,
        "ordinate_spec_data_type": kind,
        "ordinate_axis_lab": ("Displacement", "Velocity", "Acceleration")[order],
        "ordinate_axis_units_lab": above + ("", "/s", "/s2")[order],
        "orddenom_spec_data_type": FORCE[0],
        "orddenom_axis_lab": "Force",
        "orddenom_axis_units_lab": below,
    }


def _share(coherence: Real) -> Fields:
    return {"func_type": COHERENCE, "data": coherence, "ordinate_axis_lab": "Coherence"}
