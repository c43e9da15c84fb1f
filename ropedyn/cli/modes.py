"""The command that finds modes."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from ..base import check
from ..base.errors import SceneError
from ..eigen.damped.damped_modes import DampedModes
from ..eigen.modes import Modes
from .options import compiled, scene_command, show


def modes_command(commands: Any) -> None:
    """Add the command."""
    scene_command(commands, "modes", _modes, _options, text="natural frequencies and shapes")


def _options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--modes", type=int, default=10, help="how many (%(default)s)")
    parser.add_argument("--damped", action="store_true", help="complex modes")
    parser.add_argument(
        "--animate", type=Path, metavar="FILE", help="write a mode in motion: .gif, .html, .mp4"
    )
    parser.add_argument("--mode", type=int, help="which of them --animate shows (1)")


def _modes(options: argparse.Namespace) -> None:
    if options.mode is not None and options.animate is None:
        raise SceneError("--animate must be given with --mode, got none")
    model = compiled(options)
    modes: Modes | DampedModes
    modes = (
        model.modes(options.modes, damped=True) if options.damped else model.modes(options.modes)
    )
    if options.animate is not None:
        number = 1 if options.mode is None else options.mode
        check.count(number, "--mode", most=len(modes.frequency))
        modes.animate(number - 1, path=options.animate)
    show(options, modes)
