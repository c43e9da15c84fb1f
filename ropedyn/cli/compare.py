"""The command that compares a scene with a measurement."""

from __future__ import annotations

import argparse
from typing import Any

from ..curves.measured import Measured
from ..curves.peaks import Peaks
from ..experiment.compare.compare import compare
from .measured import OF_FILES, file_options, measured_of, measured_options, refuse
from .options import compiled, numbers, scene_command, show, whole_numbers

OF_PEAKS = ("std", "order")
"""Options that only one of both takes."""


def compare_command(commands: Any) -> None:
    """Add the command."""
    scene_command(
        commands,
        "compare",
        _compare,
        _options,
        text="calculated against measured peaks or responses",
        description="Calculated against measured peaks, or a measured frequency response: pairs of "
        "peaks, likeness of responses (FRAC), and what their differences prove of their cause.",
    )


def _options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--modes", type=int, help="compare with so many (as many as are needed)")
    measured_options(parser)
    parser.add_argument("--std", help="of the peaks, one number or a comma list [Hz]")
    parser.add_argument("--order", help="which mode each peak is, comma list of whole numbers")
    parser.add_argument(
        "--within", type=float, help="largest relative error of calculated peaks, such as 0.05"
    )
    group = file_options(parser)
    group.add_argument("--band", type=float, help="that FRAC is taken over at each line [Hz]")


def _compare(options: argparse.Namespace) -> None:
    measured = _peaks(options) if options.peaks is not None else _measured(options)
    model = compiled(options)
    calculated = model if options.modes is None else model.modes(options.modes)
    comparison = compare(calculated, measured, within=options.within, band=options.band)
    show(options, comparison, comparison.report())


def _peaks(options: argparse.Namespace) -> Peaks:
    refuse(options, (*OF_FILES, "band"), "--measured")
    std = None if options.std is None else numbers(options.std, "--std")
    order = None if options.order is None else whole_numbers(options.order, "--order")
    return Peaks(numbers(options.peaks, "--peaks"), std=std, order=order)


def _measured(options: argparse.Namespace) -> Measured:
    refuse(options, OF_PEAKS, "--peaks")
    return measured_of(options)
