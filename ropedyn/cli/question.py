"""Questions to a scene, modes or a frequency response, by options that several commands share."""

from __future__ import annotations

import argparse
from typing import Any

from .. import ask
from ..base.errors import SceneError
from .options import drive, point, spaced

EITHER = (
    "for modes (10 of them unless --modes or --below is given) or, with --frequency and --drive, "
    "a frequency response."
)
"""What a command says that takes both."""


def question_options(parser: argparse.ArgumentParser) -> None:
    """Add what chooses modes or a frequency response."""
    asked = parser.add_mutually_exclusive_group()
    asked.add_argument("--modes", type=int, help="how many")
    asked.add_argument("--below", type=float, help="instead: modes below this [Hz]")
    frf_options(parser, asked, required=False)


def frf_options(parser: argparse.ArgumentParser, asked: Any, *, required: bool) -> None:
    """Add what chooses a frequency response, its frequencies among what else may be asked."""
    asked.add_argument(
        "--frequency", required=required, help="start:stop:lines or a comma list [Hz]"
    )
    parser.add_argument(
        "--drive", required=required, help="coordinate@position [m], such as z@0.5, or end:0:z"
    )
    parser.add_argument("--response", action="append", help="as --drive; may be repeated")


def question(options: argparse.Namespace) -> ask.Question:
    """Return what is asked."""
    if options.frequency is not None:
        if options.drive is None:
            raise SceneError("--drive must be given with --frequency, got none")
        return frf_question(options)
    for option in ("drive", "response"):
        if getattr(options, option) is not None:
            raise SceneError(f"--frequency must be given with --{option}, got none")
    if options.below is not None:
        return ask.modes(below=options.below)
    return ask.modes(10 if options.modes is None else options.modes)


def frf_question(options: argparse.Namespace) -> ask.FRFQuestion:
    """Return the question of a frequency response."""
    return ask.frf(
        spaced(options.frequency, "--frequency", "Hz"),
        drive=drive(options.drive, "--drive"),
        response=options.response and [point(text, "--response") for text in options.response],
    )
