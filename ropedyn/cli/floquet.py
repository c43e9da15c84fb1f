"""The command that finds how free motion grows under a pulsating tension."""

from __future__ import annotations

import argparse
from typing import Any

from .options import compiled, modes_option, scene_command, show


def floquet_command(commands: Any) -> None:
    """Add the command."""
    scene_command(
        commands,
        "floquet",
        _floquet,
        modes_option,
        text="growth of free motion under the pulsating tension of the scene",
    )


def _floquet(options: argparse.Namespace) -> None:
    show(options, compiled(options).floquet(modes=options.modes))
