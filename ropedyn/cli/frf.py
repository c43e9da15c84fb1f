"""The command that finds a frequency response."""

from __future__ import annotations

import argparse
from typing import Any

from .options import compiled, scene_command, show
from .question import frf_options, frf_question


def frf_command(commands: Any) -> None:
    """Add the command."""
    scene_command(commands, "frf", _frf, _options, text="frequency response")


def _options(parser: argparse.ArgumentParser) -> None:
    frf_options(parser, parser, required=True)


def _frf(options: argparse.Namespace) -> None:
    show(options, frf_question(options).of(compiled(options)))
