"""Measured responses in files, by options that several commands share."""

from __future__ import annotations

import argparse
from typing import Any

from ..base.check import shown
from ..base.errors import SceneError
from ..base.unit import QUANTITIES
from ..curves.measured import Measured
from .options import drive as drive_of
from .options import point

OF_FILES = (
    "drive",
    "response",
    "quantity",
    "unit",
    "position",
    "coordinate",
    "column",
    "reciprocal",
)
"""Options that only files take."""


def measured_options(parser: argparse.ArgumentParser) -> None:
    """Add what was measured: peaks, or a file."""
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--peaks", help="measured peaks, comma list [Hz]")
    what.add_argument("--measured", metavar="FILE", help="measured response, universal file or CSV")


def file_options(parser: argparse.ArgumentParser) -> Any:
    """Add what a file may not say itself, and return the group of it."""
    group = parser.add_argument_group("of a FILE, where it does not say so itself")
    group.add_argument("--drive", help="coordinate@position [m], such as z@0.5, or end:0:z")
    group.add_argument("--response", action="append", help="as --drive; may be repeated")
    group.add_argument("--quantity", choices=QUANTITIES, help="of the values")
    group.add_argument("--unit", help='of the values, such as "m/s^2/N" or "g/N"')
    group.add_argument(
        "--position",
        action="append",
        metavar="NODE=X",
        help="where a node of a universal file is [m], such as 1=0.5; may be repeated",
    )
    group.add_argument(
        "--coordinate",
        action="append",
        metavar="DIRECTION=COORDINATE",
        help="what a direction of a universal file is, such as Z=z or RY=-beta; may be repeated",
    )
    group.add_argument(
        "--column",
        action="append",
        metavar="KIND=NAME",
        help="column of a CSV file: frequency, real, imag, amplitude, phase or coherence; "
        "may be repeated",
    )
    group.add_argument(
        "--reciprocal",
        action="store_true",
        default=None,
        help="exchange what was driven and what was watched, for a hammer that roves",
    )
    return group


def measured_of(options: argparse.Namespace) -> Measured:
    """Read the file."""
    given: dict[str, Any] = {
        name: getattr(options, name) for name in ("quantity", "unit", "reciprocal")
    }
    if options.drive is not None:
        given["drive"] = drive_of(options.drive, "--drive")
    if options.response is not None:
        given["response"] = [point(text, "--response") for text in options.response]
    if options.position is not None:
        given["positions"] = {
            _number(node, int, "--position"): _number(x, float, "--position")
            for node, x in _pairs(options.position, "--position")
        }
    if options.coordinate is not None:
        given["coordinate"] = dict(_pairs(options.coordinate, "--coordinate"))
    if options.column is not None:
        given["columns"] = _columns(_pairs(options.column, "--column"))
    return Measured.read(options.measured, **{k: v for k, v in given.items() if v is not None})


def refuse(options: argparse.Namespace, names: tuple[str, ...], instead: str) -> None:
    """Refuse options that only another one takes."""
    for name in names:
        if getattr(options, name) is not None:
            option = name.replace("_", "-")
            raise SceneError(f"{instead} must be given with --{option}, got none")


def _pairs(texts: list[str], option: str) -> list[tuple[str, str]]:
    """Return what stands on both sides of the equals sign of each text."""
    found = [text.partition("=") for text in texts]
    for text, (name, between, value) in zip(texts, found):
        if not (name and between and value):
            raise SceneError(f"{option} must be two words with = between, got {shown(text)}")
    return [(name, value) for name, _, value in found]


def _number(text: str, kind: Any, option: str) -> Any:
    try:
        return kind(text)
    except ValueError:
        raise SceneError(f"{option} must be NODE=X, such as 1=0.5, got {shown(text)}") from None


def _columns(pairs: list[tuple[str, str]]) -> dict[str, Any]:
    """Return columns by their kind, a list where there are several; whole numbers are numbers."""
    found: dict[str, Any] = {}
    for kind, text in pairs:
        column: Any = int(text) if text.isdecimal() else text
        found.setdefault(kind, []).append(column)
    return {kind: many[0] if len(many) == 1 else many for kind, many in found.items()}
