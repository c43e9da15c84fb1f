"""Universal files: their datasets, read and written by pyuff, and responses as such datasets."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...base.array import Complex, Real
from ...base.atomic import replacing
from ...base.errors import SceneError
from ...base.extra import pyuff
from ...base.reading import reading
from ...base.unit import QUANTITIES, label
from ...chain.port import Point
from ..motion_unit import dimensions
from . import Content

FUNCTION = 58
NODES = (15, 2411)
UNITS = 164
FRF, COHERENCE, GENERAL = 4, 6, 0
"""Types of functions."""
FREQUENCY = 18  # The type of an abscissa over frequency.
MOTION = {8: 0, 11: 1, 12: 2}
"""How often the displacement is differentiated in each type of ordinate."""
FORCE = (13, 9)  # Types of what a motion is divided by: excitation and reaction force.
UNSAID = (0, 1)  # Types of anything: unknown and general.
DIRECTIONS = ("scalar", "X", "Y", "Z", "RX", "RY", "RZ")
"""Directions by their codes without sign; R is rotation."""
OWN = re.compile(r"ropedyn (?P<r>[a-z]+) (?P<rx>\S+) per (?P<d>[a-z]+) (?P<dx>\S+)$")
"""The second line of a function that was written here: its points."""
DECAY = re.compile(r"ropedyn decay (\S+)$")
"""The fourth line of a function that was written here."""
SPREAD = "Standard deviation"
"""The ordinate of a general function that was written here."""
AVERAGES = re.compile(r"ropedyn averages (\S+)$")
"""The fifth line of a function that was written here."""
MARK = re.compile(rb"(?=    -1(?:[\r\n]|\Z| {74}.))", re.DOTALL)
"""A line that opens or closes a dataset; the one pyuff looks for."""
IEEE = 2  # Floating point format of a binary dataset 58.
LONGEST_LINE = 6  # The last line of a dataset may be filled up with so many numbers.
Fields = dict[str, Any]


class FileFunction(NamedTuple):
    """One function of a file."""

    number: int  # among the datasets, from 0
    fields: Fields  # as pyuff names them; "x" and "data" are the numbers
    # how many of its units of length and of force are 1 m and 1 N, by dataset 164; or None
    units: tuple[float, float] | None


def read(file: Path, wanted: Callable[[Fields], bool]) -> list[FileFunction]:
    """Read the functions of a file."""
    content = file.read_bytes()
    if not content.strip():
        raise SceneError(f"path must be a universal file, got {str(file)!r}, which is empty")
    marks = len(MARK.findall(content))
    if marks == 0:
        raise SceneError(
            f"path must be a universal file, got {str(file)!r}, which has no line of -1 that opens "
            "a dataset"
        )
    if marks % 2:
        raise SceneError(
            f"path must be a whole universal file, got {str(file)!r}, whose dataset "
            f"{marks // 2} (from 0) has no end"
        )
    opened = _opened(file)
    kinds = [int(kind) for kind in opened.get_set_types()]
    if 0 in kinds:
        raise SceneError(
            f"path must be a universal file without damage, got {str(file)!r}, whose dataset "
            f"{kinds.index(0)} (from 0) has no number that says what it is"
        )
    if FUNCTION not in kinds:
        raise SceneError(
            f"path must be a universal file with a dataset 58 (function), got {str(file)!r} with "
            f"{sorted(set(kinds))}"
        )
    return _functions(file, opened, kinds, wanted)


def _functions(
    file: Path, opened: Any, kinds: Sequence[int], wanted: Callable[[Fields], bool]
) -> list[FileFunction]:
    found: list[FileFunction] = []
    units = None
    for number, kind in enumerate(kinds):
        if kind == UNITS:
            units = _units(file, number, _dataset(file, opened, number))
        if kind == FUNCTION and wanted(_dataset(file, opened, number, header_only=True)):
            fields = _dataset(file, opened, number)
            with reading(file, f"a universal file whose dataset {number} (from 0) is whole"):
                _check(file, number, fields)
            found.append(FileFunction(number, fields, units))
    return found


def nodes(file: Path, axis: str) -> dict[int, float]:
    """Read where the nodes of a file are along one of its axes [m]."""
    opened = _opened(file)
    found: dict[int, float] = {}
    units = None
    for number, kind in enumerate(opened.get_set_types().tolist()):
        if kind == UNITS:
            units = _units(file, number, _dataset(file, opened, number))
        if kind in NODES:
            if units is None:
                raise SceneError(
                    f"positions must be stated in m: no dataset 164 before dataset {number} of "
                    f"{str(file)!r} says the unit of its nodes"
                )
            fields = _dataset(file, opened, number)
            names, where = (np.asarray(fields[key]) for key in ("node_nums", axis.lower()))
            if len(names) != len(where) or not np.isfinite([*names, *where]).all():
                raise SceneError(
                    f"path must be a universal file without damage, got {str(file)!r}: dataset "
                    f"{number} (from 0) must hold finite numbers, seven for each node"
                )
            found |= {int(n): float(x) for n, x in zip(names, where / units[0])}
    return found


def _opened(file: Path) -> Any:
    with reading(file, "a universal file without damage"):
        return pyuff().UFF(str(file))


def _dataset(file: Path, opened: Any, number: int, **options: bool) -> Fields:
    with reading(file, f"a universal file whose dataset {number} (from 0) can be read"):
        return opened.read_sets(number, **options)


def _units(file: Path, number: int, fields: Fields) -> tuple[float, float]:
    length, force = float(fields["length"]), float(fields["force"])
    if not (0 < length < np.inf and 0 < force < np.inf):
        raise SceneError(
            f"path must be a universal file with units > 0, got {str(file)!r}, whose dataset "
            f"{number} (164, from 0) says {length:g} of length and {force:g} of force"
        )
    return length, force


def _check(file: Path, number: int, fields: Fields) -> None:
    """Make sure that a function has the numbers its header says; cut those that fill a line."""
    where = f"path must be a universal file without damage, got {str(file)!r}: dataset {number} "
    if fields["binary"] and (fields["fp_format"] != IEEE or fields["byte_ordering"] not in (1, 2)):
        raise SceneError(
            f"{where}(from 0) must hold IEEE 754 numbers (byte order 1 or 2, format 2), got byte "
            f"order {fields['byte_ordering']} and format {fields['fp_format']}"
        )
    count, data = fields["num_pts"], fields["data"]
    if not 0 < count <= len(data) < count + LONGEST_LINE or len(fields["x"]) != len(data):
        raise SceneError(f"{where}(from 0) must hold {count} values, as it says, got {len(data)}")
    fields["x"], fields["data"] = fields["x"][:count], data[:count]
    if not (np.isfinite(fields["x"]).all() and np.isfinite(fields["data"]).all()):
        raise SceneError(f"{where}(from 0) must hold finite numbers")


def label_of(text: str) -> str:
    """Return what a label says, nothing where it says NONE."""
    return "" if text.strip().upper() == "NONE" else text.strip()


def _bytes(dataset: Fields) -> int:
    """Return how many bytes the numbers of a binary function take."""
    each = (2 if np.iscomplexobj(dataset["data"]) else 1) + (not dataset["abscissa_spacing"])
    return 8 * each * len(dataset["data"])


def _state_bytes(file: Path, sizes: Sequence[int]) -> None:
    """Correct the number of bytes that the header of each binary function says."""
    # pyuff, up to 2.5.8, counts 8 for each value, complex or with its abscissa too; readers that go
    # by the header would stop there
    content = bytearray(file.read_bytes())
    at = 0
    for size in sizes:
        at = content.index(b"    58b", at)
        content[at + 31 : at + 43] = b"%12d" % size
        for _ in range(12):
            at = content.index(b"\n", at) + 1
        at += size
    file.write_bytes(content)


# --- responses as datasets ----------------------------------------------------------------------


EVEN = 1e-13  # Frequencies nearer than this relative distance differ by rounding of start + k step.
CODE = {"x": 1, "y": 2, "z": 3, "alpha": 4, "beta": -5, "gamma": 6}
"""Directions of a right-handed system, x along the rope: dz/dx turns against +Y, dy/dx as +Z."""


def write(content: Content, path: Path, binary: bool) -> None:
    """Write responses, and what is known of them, as datasets 58 in SI; see `Curves.write`."""
    _refuse(content)
    points = [*content.drive, *content.response]
    nodes = {x: k for k, x in enumerate(sorted({x for _, x in points}), start=1)}
    datasets: list[Fields] = [si_units()]
    for d, drive in enumerate(content.drive):
        for r, response in enumerate(content.response):
            common = _common(content, nodes, drive, response, binary)
            datasets.append(common | _ordinate(content, drive, response, content.value[d, r]))
            if content.coherence is not None:
                datasets.append(common | _share(content.coherence[r]))
            if content.std is not None:
                datasets.append(common | _spread(content.std[r]))
    write_all(path, datasets)


def _refuse(content: Content) -> None:
    """Refuse what a dataset 58 has no words for."""
    for name, points in ("drive", content.drive), ("response", content.response):
        for k, point in enumerate(points):
            if point[0] not in CODE:
                raise SceneError(
                    f"{name}[{k}] must be a coordinate at a position to be written as a universal "
                    f"file, got {point!r}: write a .csv"
                )
    if len(content.frequency) < 2:
        raise SceneError("frequency must have at least two lines for a universal file, got 1")


def si_units() -> Fields:
    """Return the dataset that says that what follows is in SI."""
    return {
        "type": UNITS,
        "units_code": 1,
        "units_description": "SI",
        "temp_mode": 1,
        "length": 1.0,
        "force": 1.0,
        "temp": 1.0,
        "temp_offset": 273.15,
    }


def _common(
    content: Content, nodes: Mapping[float, int], drive: Point, response: Point, binary: bool
) -> Fields:
    """Return the fields of a function and of its coherence."""
    (r, rx), (d, dx) = response, drive
    averages = getattr(content, "averages", None)
    return {
        "type": FUNCTION,
        "binary": int(binary),
        "id1": label(response, drive, content.quantity),
        "id2": f"ropedyn {r} {float(rx)!r} per {d} {float(dx)!r}",
        "id4": f"ropedyn decay {content.decay!r}" if content.decay else "NONE",
        "id5": "NONE" if averages is None else f"ropedyn averages {averages!r}",
        "rsp_node": nodes[rx],
        "rsp_dir": CODE[r],
        "ref_node": nodes[dx],
        "ref_dir": CODE[d],
        "x": content.frequency,
        "abscissa_spacing": int(_is_even(content.frequency, binary)),
        "abscissa_spec_data_type": FREQUENCY,
        "abscissa_axis_lab": "Frequency",
        "abscissa_axis_units_lab": "Hz",
        "orddenom_spec_data_type": UNSAID[0],
    }


def _is_even(frequency: Real, binary: bool) -> bool:
    """Whether the start and the step, with the 6 digits a header has, are the frequencies."""
    # else each is written: with 6 digits too, or in full where the file is binary
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


def _ordinate(content: Content, drive: Point, response: Point, curve: Complex) -> Fields:
    order = QUANTITIES[content.quantity]
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


def _spread(std: Real) -> Fields:
    return {"func_type": GENERAL, "data": std, "ordinate_axis_lab": SPREAD}


def write_all(path: Path, datasets: Sequence[Fields]) -> None:
    """Write datasets to a file, whole or not at all."""
    library = pyuff()
    with replacing(path) as draft:
        with warnings.catch_warnings():
            # pyuff leaves it to the collector to close what it opened again after binary numbers
            warnings.simplefilter("ignore", ResourceWarning)
            library.UFF(str(draft)).write_sets([dict(one) for one in datasets], mode="overwrite")
        if any(one.get("binary") for one in datasets):
            _state_bytes(draft, [_bytes(one) for one in datasets if one["type"] == FUNCTION])
