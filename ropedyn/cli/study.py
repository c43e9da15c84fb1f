"""The command of the 2015 study."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from .. import study2015

FOLDER = Path("ropedyn-study")


def study_command(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser("study", help="the 2015 study: table, verdict, figures")
    parser.add_argument("--folder", type=Path, default=FOLDER, help="of the figures (%(default)s)")
    parser.set_defaults(run=run_study)


def run_study(options: argparse.Namespace) -> None:
    """Print the study and draw its figures."""
    from ..plot import study2015 as study_figures

    print(study2015.report())
    print()
    for path in study_figures.draw(options.folder):
        print(f"figure: {path}")
