"""The command that draws where a pulsating tension lets motion grow."""

from __future__ import annotations

import argparse
from typing import Any

from .options import compiled, modes_option, progress_option, scene_command, show, spaced


def stability_command(commands: Any) -> None:
    """Add the command."""
    scene_command(
        commands,
        "stability",
        _stability,
        _options,
        text="frequencies and amplitudes of the tension at which motion grows",
    )


def _options(parser: argparse.ArgumentParser) -> None:
    what = "of the tension, start:stop:count or a comma list"
    parser.add_argument("--frequency", required=True, help=f"{what} [Hz]")
    parser.add_argument("--amplitude", required=True, help=f"{what} [N]")
    modes_option(parser)
    progress_option(parser)


def _stability(options: argparse.Namespace) -> None:
    chart = compiled(options).stability_map(
        spaced(options.frequency, "--frequency", "Hz"),
        spaced(options.amplitude, "--amplitude", "N"),
        modes=options.modes,
        progress=options.progress,
    )
    show(options, chart)
