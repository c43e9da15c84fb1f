"""The command line."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from .cli_accuracy import accuracy_command
from .cli_compare import compare_command
from .cli_effects import effects_command
from .cli_floquet import floquet_command
from .cli_frf import frf_command
from .cli_identify import identify_command
from .cli_modes import modes_command
from .cli_stability import stability_command
from .cli_study import FOLDER, run_study, study_command
from .cli_transient import transient_command
from .errors import RopedynError, SolveError

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
    """Run the command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        Those of the process where left out.

    Returns
    -------
    int
        Exit status: 0, 1 where the numbers refused, 2 where the input was bad.
    """
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
