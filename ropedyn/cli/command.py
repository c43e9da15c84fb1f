"""The command line."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from ..base.errors import RopedynError, SolveError
from .accuracy import accuracy_command
from .compare import compare_command
from .effects import effects_command
from .floquet import floquet_command
from .frf import frf_command
from .identify import identify_command
from .modes import modes_command
from .stability import stability_command
from .study import FOLDER, run_study, study_command
from .transient import transient_command

COMMANDS = (
    study_command,
    modes_command,
    frf_command,
    compare_command,
    accuracy_command,
    effects_command,
    identify_command,
    transient_command,
    floquet_command,
    stability_command,
)

SOLVED, REFUSED, BAD_INPUT = 0, 1, 2


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line."""
    options = _parser().parse_args(arguments)
    try:
        options.run(options)
    except SolveError as error:
        return _complain(error, REFUSED)
    except (RopedynError, TypeError, OSError, ImportError) as error:
        return _complain(error, BAD_INPUT)
    return SOLVED


def _complain(error: Exception, status: int) -> int:
    print(f"ropedyn: {error}", file=sys.stderr)
    return status


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="ropedyn",
        description="Vibration of axially tensed steel ropes. Alone: the 2015 study.",
        epilog="Exit status: 0, 1 where the numbers refused, 2 where the input was bad.",
    )
    parser.set_defaults(run=run_study, folder=FOLDER)
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    for command in COMMANDS:
        command(commands)
    return parser
