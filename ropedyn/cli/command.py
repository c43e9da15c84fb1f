"""The command line: its commands and what they leave with. Alone it is the 2015 study."""

from __future__ import annotations

import argparse
import os
import sys
import warnings
from collections.abc import Sequence
from importlib import metadata
from pathlib import Path
from typing import Any

from .. import study2015
from ..base.errors import RopedynError, SolveError
from .experiment import COMPARE, IDENTIFY
from .file import INSPECT, SCENE_FILE, SCHEMA
from .hard import HARD
from .options import BAD_INPUT, REFUSED, SOLVED, STATUS
from .scene import ACCURACY, EFFECTS, FLOQUET, FRF, MODES, STABILITY, TRANSIENT
from .section import SECTION
from .tension import TENSION
from .text import in_options

COMMANDS = (
    MODES,
    FRF,
    COMPARE,
    ACCURACY,
    EFFECTS,
    HARD,
    IDENTIFY,
    TENSION,
    TRANSIENT,
    FLOQUET,
    STABILITY,
    SECTION,
    SCENE_FILE,
    INSPECT,
    SCHEMA,
)
NAME = "ropedyn"
FOLDER = Path("ropedyn-study")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line."""
    options = argparse.Namespace()
    try:
        options = parser().parse_args(arguments)
        with warnings.catch_warnings():
            warnings.showwarning = _warn
            status = options.run(options) or SOLVED
        sys.stdout.flush()
        return status
    except BrokenPipeError:
        # who reads has seen enough, and what is left would complain at the end
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return SOLVED
    except SolveError as error:
        return _complain(in_options(str(error), vars(options)), REFUSED)
    except OSError as error:
        said = f"{error.filename}: {error.strerror}" if error.filename else str(error)
        return _complain(said, BAD_INPUT)
    except (RopedynError, TypeError, ImportError) as error:
        return _complain(in_options(str(error), vars(options)), BAD_INPUT)


def _warn(message: Warning | str, *_: Any, **__: Any) -> None:
    print(f"{NAME}: warning: {message}", file=sys.stderr)


def _complain(said: str, status: int) -> int:
    print(*(f"{NAME}: {line}" for line in said.split("\n")), sep="\n", file=sys.stderr)
    return status


def parser() -> argparse.ArgumentParser:
    """Return what reads the arguments."""
    parser = argparse.ArgumentParser(
        prog=NAME,
        description="Vibration of axially tensed steel ropes. Alone: the 2015 study.",
        epilog=f"Exit status: {SOLVED}, {REFUSED} where the numbers refused or a hard case failed, "
        f"{BAD_INPUT} where the input was bad, {STATUS['ambiguous']} where what was measured "
        "leaves several answers.",
    )
    parser.add_argument("--version", action="version", version=f"%(prog)s {metadata.version(NAME)}")
    parser.set_defaults(run=_study, folder=FOLDER)
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    study = commands.add_parser("study", help="the 2015 study: table, verdict, figures")
    study.add_argument("--folder", type=Path, default=FOLDER, help="of the figures (%(default)s)")
    study.set_defaults(run=_study)
    for command in COMMANDS:
        command.add(commands)
    return parser


def _study(options: argparse.Namespace) -> None:
    """Print the study and draw its figures."""
    from ..plot import study2015 as study_figures

    print(study2015.report())
    print()
    for path in study_figures.draw(options.folder):
        print(f"figure: {path}")
