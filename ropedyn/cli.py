"""The command line."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from . import ask, check, study2015
from .accuracy import accuracy_cost
from .cli_compare import compare_command
from .cli_identify import identify_command
from .cli_options import (
    compile_options,
    compiled,
    drive,
    output_options,
    point,
    show,
    spaced,
    whole_numbers,
)
from .cli_time import time_commands
from .damped_modes import DampedModes
from .effect import effect_cost
from .errors import RopedynError, SceneError, SolveError
from .modes import Modes
from .scene import Scene

STUDY_FOLDER = Path("ropedyn-study")

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
    parser.set_defaults(run=_study, folder=STUDY_FOLDER)
    commands = parser.add_subparsers(title="commands", metavar="COMMAND")
    study = commands.add_parser("study", help="the 2015 study: table, verdict, figures")
    study.add_argument(
        "--folder", type=Path, default=STUDY_FOLDER, help="of the figures (%(default)s)"
    )
    study.set_defaults(run=_study)
    _scene_command(commands, "modes", _modes, "natural frequencies and shapes")
    _scene_command(commands, "frf", _frf, "frequency response")
    compare_command(commands)
    _accuracy_command(commands)
    _effects_command(commands)
    identify_command(commands)
    time_commands(commands)
    return parser


def _scene_command(
    commands: Any, name: str, run: Callable[[argparse.Namespace], None], text: str
) -> None:
    parser = commands.add_parser(name, help=text)
    parser.add_argument("scene", metavar="SCENE.toml", help="the scene")
    compile_options(parser)
    if name == "modes":
        parser.add_argument("--modes", type=int, default=10, help="how many (%(default)s)")
        parser.add_argument("--damped", action="store_true", help="complex modes")
        parser.add_argument(
            "--animate", type=Path, metavar="FILE", help="write a mode in motion: .gif, .html, .mp4"
        )
        parser.add_argument("--mode", type=int, help="which of them --animate shows (1)")
    if name == "frf":
        _frf_options(parser, required=True)
    output_options(parser)
    parser.set_defaults(run=run)


def _accuracy_command(commands: Any) -> None:
    parser = commands.add_parser(
        "accuracy",
        help="time and error of every element and solver",
        description="Time and error of every element and solver, for modes (10 of them unless "
        "--modes or --below is given) or, with --frequency and --drive, a frequency response.",
    )
    parser.add_argument("scene", metavar="SCENE.toml", help="the scene")
    parser.add_argument("--elements", help="of chains, comma list (powers of two from 8 to 4096)")
    parser.add_argument("--element", default="rigid,tensed,continuous", help="kinds (%(default)s)")
    parser.add_argument("--solver", default="sweep,lapack", help="comma list (%(default)s)")
    _question_options(parser)
    output_options(parser)
    parser.set_defaults(run=_accuracy)


def _effects_command(commands: Any) -> None:
    parser = commands.add_parser(
        "effects",
        help="what each effect of the scene changes and costs",
        description="What each effect of the scene changes and costs, for modes (10 of them unless "
        "--modes or --below is given) or, with --frequency and --drive, a frequency response.",
    )
    parser.add_argument("scene", metavar="SCENE.toml", help="the scene")
    compile_options(parser)
    _question_options(parser)
    output_options(parser)
    parser.set_defaults(run=_effects)


def _question_options(parser: argparse.ArgumentParser) -> None:
    asked = parser.add_mutually_exclusive_group()
    asked.add_argument("--modes", type=int, help="how many")
    asked.add_argument("--below", type=float, help="instead: modes below this [Hz]")
    _frf_options(asked, required=False, beside=parser)


def _frf_options(parser: Any, *, required: bool, beside: Any = None) -> None:
    parser.add_argument(
        "--frequency", required=required, help="start:stop:lines or a comma list [Hz]"
    )
    beside = beside or parser
    beside.add_argument(
        "--drive", required=required, help="coordinate@position [m], such as z@0.5, or end:0:z"
    )
    beside.add_argument("--response", action="append", help="as --drive; may be repeated")


def _study(options: argparse.Namespace) -> None:
    from . import study_figures

    print(study2015.report())
    print()
    for path in study_figures.draw(options.folder):
        print(f"figure: {path}")


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


def _frf(options: argparse.Namespace) -> None:
    show(options, _asked_frf(options).of(compiled(options)))


def _accuracy(options: argparse.Namespace) -> None:
    scene = Scene.load(options.scene)
    elements = options.elements and whole_numbers(options.elements, "--elements")
    element, solver = options.element.split(","), options.solver.split(",")
    cost = accuracy_cost(scene, _asked(options), elements=elements, element=element, solver=solver)
    show(options, cost)


def _effects(options: argparse.Namespace) -> None:
    scene = Scene.load(options.scene)
    how = {"elements": options.elements, "element": options.element}
    show(options, effect_cost(scene, _asked(options), **how))


def _asked(options: argparse.Namespace) -> ask.Question:
    if options.frequency is not None:
        if options.drive is None:
            raise SceneError("--drive must be given with --frequency, got none")
        return _asked_frf(options)
    for option in ("drive", "response"):
        if getattr(options, option) is not None:
            raise SceneError(f"--frequency must be given with --{option}, got none")
    if options.below is not None:
        return ask.modes(below=options.below)
    return ask.modes(10 if options.modes is None else options.modes)


def _asked_frf(options: argparse.Namespace) -> ask.FRFQuestion:
    return ask.frf(
        spaced(options.frequency, "--frequency", "Hz"),
        drive=drive(options.drive, "--drive"),
        response=options.response and [point(text, "--response") for text in options.response],
    )
