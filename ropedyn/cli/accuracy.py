"""The command that times elements and solvers and finds their errors."""

from __future__ import annotations

import argparse
from typing import Any

from ..scene.scene import Scene
from ..study.accuracy import accuracy_cost
from .options import scene_command, show, whole_numbers
from .question import EITHER, question, question_options


def accuracy_command(commands: Any) -> None:
    """Add the command."""
    scene_command(
        commands,
        "accuracy",
        _accuracy,
        question_options,
        text="time and error of every element and solver",
        description=f"Time and error of every element and solver, {EITHER}",
        elements=_methods,
    )


def _methods(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--elements", help="of chains, comma list (powers of two from 8 to 4096)")
    parser.add_argument("--element", default="rigid,tensed,continuous", help="kinds (%(default)s)")
    parser.add_argument("--solver", default="sweep,lapack", help="comma list (%(default)s)")


def _accuracy(options: argparse.Namespace) -> None:
    scene = Scene.load(options.scene)
    elements = options.elements and whole_numbers(options.elements, "--elements")
    element, solver = options.element.split(","), options.solver.split(",")
    cost = accuracy_cost(
        scene, question(options), elements=elements, element=element, solver=solver
    )
    show(options, cost)
