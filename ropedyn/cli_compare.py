"""The command that compares a scene with a measurement."""

from __future__ import annotations

import argparse
from typing import Any

from .check import shown
from .cli_options import (
    compile_options,
    compiled,
    numbers,
    output_options,
    point,
    show,
    whole_numbers,
)
from .cli_options import drive as drive_of
from .compare import compare
from .errors import SceneError
from .measured import Measured
from .peaks import Peaks
from .unit import QUANTITIES

OF_PEAKS = ("std", "order")
OF_FILES = (
    "drive",
    "response",
    "quantity",
    "unit",
    "position",
    "coordinate",
    "column",
    "reciprocal",
    "band",
)
"""Options that only one of both takes."""


def compare_command(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "compare",
        help="calculated against measured peaks or responses",
        description="Calculated against measured peaks, or a measured frequency response: pairs of "
        "peaks, likeness of responses (FRAC), and what their differences prove of their cause.",
    )
    parser.add_argument("scene", metavar="SCENE.toml", help="the scene")
    compile_options(parser)
    parser.add_argument("--modes", type=int, help="compare with so many (as many as are needed)")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--peaks", help="measured peaks, comma list [Hz]")
    what.add_argument("--measured", metavar="FILE", help="measured response, universal file or CSV")
    parser.add_argument("--std", help="of the peaks, one number or a comma list [Hz]")
    parser.add_argument("--order", help="which mode each peak is, comma list of whole numbers")
    parser.add_argument(
        "--within", type=float, help="largest relative error of calculated peaks, such as 0.05"
    )
    _file_options(parser.add_argument_group("of a FILE, where it does not say so itself"))
    output_options(parser)
    parser.set_defaults(run=_compare)


def _file_options(group: Any) -> None:
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
    group.add_argument("--band", type=float, help="that FRAC is taken over at each line [Hz]")


def _compare(options: argparse.Namespace) -> None:
    measured = _peaks(options) if options.peaks is not None else _measured(options)
    model = compiled(options)
    calculated = model if options.modes is None else model.modes(options.modes)
    comparison = compare(calculated, measured, within=options.within, band=options.band)
    show(options, comparison, comparison.report())


def _peaks(options: argparse.Namespace) -> Peaks:
    _refuse(options, OF_FILES, "--measured")
    std = None if options.std is None else numbers(options.std, "--std")
    order = None if options.order is None else whole_numbers(options.order, "--order")
    return Peaks(numbers(options.peaks, "--peaks"), std=std, order=order)


def _measured(options: argparse.Namespace) -> Measured:
    _refuse(options, OF_PEAKS, "--peaks")
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


def _refuse(options: argparse.Namespace, names: tuple[str, ...], instead: str) -> None:
    for name in names:
        if getattr(options, name) is not None:
            raise SceneError(f"{instead} must be given with --{name}, got none")


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
