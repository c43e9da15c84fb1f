"""Universal files: their datasets, read and written by pyuff."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...base.atomic import replacing
from ...base.errors import SceneError
from ...base.extra import pyuff

FUNCTION = 58
NODES = (15, 2411)
UNITS = 164

FRF, COHERENCE = 4, 6
"""Function types."""
FREQUENCY = 18
"""A type of abscissa."""
MOTION = {8: 0, 11: 1, 12: 2}
"""How often the displacement is differentiated in each type of ordinate."""
FORCE = (13, 9)
"""Types of what a motion is divided by: excitation and reaction force."""
UNSAID = (0, 1)
"""Types of anything: unknown and general."""

DIRECTIONS = ("scalar", "X", "Y", "Z", "RX", "RY", "RZ")
"""By their codes without sign; R is rotation."""

OWN = re.compile(r"ropedyn (?P<r>[a-z]+) (?P<rx>\S+) per (?P<d>[a-z]+) (?P<dx>\S+)$")
"""What is written as second line of a function: its points."""
AVERAGES = re.compile(r"ropedyn averages (\S+)$")
"""And as fifth line."""

MARK = re.compile(rb"(?=    -1(?:[\r\n]|\Z| {74}.))", re.DOTALL)
"""A line that opens or closes a dataset; the one pyuff looks for."""

IEEE = 2
"""Floating point format of a binary dataset 58."""

LONGEST_LINE = 6
"""Numbers: the last line of a dataset may be filled up."""

Fields = dict[str, Any]


class Record(NamedTuple):
    """One function of a file."""

    number: int
    """Among the datasets, from 0."""
    fields: Fields
    """As pyuff names them; "x" and "data" are the numbers."""
    units: tuple[float, float] | None
    """How many of its units of length and of force are 1 m and 1 N, by dataset 164; or None."""


def read(file: Path, wanted: Callable[[Fields], bool]) -> list[Record]:
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
    opened = _tried(file, "its datasets", lambda: pyuff().UFF(str(file)))
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
) -> list[Record]:
    found: list[Record] = []
    units = None
    for number, kind in enumerate(kinds):
        if kind == UNITS:
            units = _units(file, number, _dataset(file, opened, number))
        if kind == FUNCTION and wanted(_dataset(file, opened, number, header_only=True)):
            fields = _dataset(file, opened, number)
            _check(file, number, fields)
            found.append(Record(number, fields, units))
    return found


def nodes(file: Path, axis: str) -> dict[int, float]:
    """Read where the nodes of a file are along one of its axes [m]."""
    opened = pyuff().UFF(str(file))
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


def _dataset(file: Path, opened: Any, number: int, **options: bool) -> Fields:
    what = f"dataset {number} (from 0)"
    # what overflows is infinite, and found by the check of the numbers
    with np.errstate(all="ignore"):
        return _tried(file, what, lambda: opened.read_sets(number, **options))


def _tried(file: Path, what: str, read: Callable[[], Any]) -> Any:
    """Read something; pyuff raises `Exception` itself for whatever it stumbles over."""
    try:
        return read()
    except ImportError:
        raise
    except Exception as error:
        raise SceneError(
            f"path must be a universal file without damage, got {str(file)!r}: {what} cannot be "
            f"read ({error})"
        ) from error


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


def write(path: Path, datasets: Sequence[Fields]) -> None:
    """Write datasets to a file, whole or not at all."""
    library = pyuff()
    with replacing(path) as draft:
        with warnings.catch_warnings():
            # pyuff leaves it to the collector to close what it opened again after binary numbers
            warnings.simplefilter("ignore", ResourceWarning)
            library.UFF(str(draft)).write_sets([dict(one) for one in datasets], mode="overwrite")
        if any(one.get("binary") for one in datasets):
            _state_bytes(draft, [_bytes(one) for one in datasets if one["type"] == FUNCTION])


def _bytes(dataset: Fields) -> int:
    """Return how many bytes the numbers of a binary function take."""
    each = (2 if np.iscomplexobj(dataset["data"]) else 1) + (not dataset["abscissa_spacing"])
    return 8 * each * len(dataset["data"])


def _state_bytes(file: Path, sizes: Sequence[int]) -> None:
    """Correct the number of bytes that the header of each binary function says.

    pyuff, up to 2.5.8, counts 8 for each value, complex or with its abscissa too; readers that go
    by the header would stop there.
    """
    content = bytearray(file.read_bytes())
    at = 0
    for size in sizes:
        at = content.index(b"    58b", at)
        content[at + 31 : at + 43] = b"%12d" % size
        for _ in range(12):
            at = content.index(b"\n", at) + 1
        at += size
    file.write_bytes(content)
