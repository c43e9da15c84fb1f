"""The command that finds motion over time."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import Any

import numpy as np

from ..base.array import Real
from ..base.check import shown
from ..base.errors import SceneError
from ..base.unit import MOTIONS
from ..motion.request import METHODS
from ..scene.force import Chirp, Impulse, Sine, Step
from .options import compiled, drive, point, progress_option, scene_command, show, spaced

FORCES: dict[str, tuple[str, int, Callable[..., Any]]] = {
    "sine": ("AMPLITUDE:FREQUENCY[:PHASE]", 2, lambda a, f, p=0.0: Sine(a, f, phase=p)),
    "step": ("AMPLITUDE[:TIME]", 1, lambda a, t=0.0: Step(a, time=t)),
    "impulse": (
        "IMPULSE[:DURATION[:TIME]]",
        1,
        lambda i, d=0.0, t=0.0: Impulse(i, duration=d, time=t),
    ),
    "chirp": ("AMPLITUDE:START:STOP:DURATION", 4, Chirp),
}
"""Of each kind what follows it, how much of that must be there, and what it makes."""

FORCE_HELP = (
    " or ".join(f"{kind}:{what}" for kind, (what, *_) in FORCES.items())
    + " [N, N s, Hz, rad, s], or a CSV file whose last column is the force, a line for each of the "
    "times; one for each --drive"
)


def transient_command(commands: Any) -> None:
    """Add the command."""
    scene_command(
        commands,
        "transient",
        _transient,
        _options,
        text="motion over time",
        description="Motion over time, driven by forces or moved ends, or let go from a load.",
    )


def _options(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--time", required=True, help="start:stop:count or a comma list [s]")
    parser.add_argument(
        "--drive",
        action="append",
        default=[],
        help="coordinate@position [m], such as z@0.5, or an end that is moved, such as end:0:z; "
        "may be repeated",
    )
    parser.add_argument("--force", action="append", default=[], help=FORCE_HELP)
    parser.add_argument(
        "--response", action="append", help="coordinate@position [m]; may be repeated"
    )
    parser.add_argument(
        "--quantity", choices=MOTIONS, default="displacement", help="of responses (%(default)s)"
    )
    parser.add_argument(
        "--start",
        action="append",
        default=[],
        metavar="POINT=LOAD",
        help="load that is let go [N, N m], such as z@0.5=10; may be repeated",
    )
    parser.add_argument("--method", choices=METHODS, default="auto", help="(%(default)s)")
    parser.add_argument("--step", type=float, help="of the direct method, at most [s]")
    parser.add_argument("--tolerance", type=float, help="instead: of the error that steps cause")
    progress_option(parser)


def _transient(options: argparse.Namespace) -> None:
    time = np.asarray(spaced(options.time, "--time", "s"), dtype=np.float64)
    if len(options.drive) != len(options.force):
        raise SceneError(
            f"--force must be given once for each of {len(options.drive)} --drive, got "
            f"{len(options.force)}"
        )
    history = compiled(options).transient(
        time,
        drive=[drive(text, "--drive") for text in options.drive] or None,
        force=[_force(text, time) for text in options.force] or None,
        response=options.response and [point(text, "--response") for text in options.response],
        quantity=options.quantity,
        start=dict(_load(text) for text in options.start) or None,
        method=options.method,
        step=options.step,
        tolerance=options.tolerance,
        progress=options.progress,
    )
    show(options, history)


def _force(text: str, time: Real) -> Any:
    """Return a force from its kind and numbers, or its samples from a file."""
    kind, *rest = text.split(":")
    if kind not in FORCES:
        return _samples(text, time)
    what, least, make = FORCES[kind]
    most = what.count(":") + 1
    try:
        values = [float(part) for part in rest]
    except ValueError:
        values = []
    if not least <= len(values) <= most:
        raise SceneError(f"--force must be {kind}:{what}, got {shown(text)}")
    return make(*values)


def _samples(path: str, time: Real) -> Real:
    """Return the last column of a file: a line for each time, and maybe one that names columns."""
    try:
        with open(path, encoding="utf-8") as file:
            lines = [line.split(",")[-1].strip() for line in file if line.strip()]
    except FileNotFoundError:
        kinds = ", ".join(FORCES)
        raise SceneError(
            f"--force must be one of {kinds} with its numbers, or a file, got {shown(path)}"
        ) from None
    named = len(lines) == len(time) + 1
    try:
        values = np.array([float(line) for line in lines[named:]])
    except ValueError as error:
        raise SceneError(f"--force must be a file of numbers, got {shown(path)}: {error}") from None
    if len(values) != len(time):
        raise SceneError(
            f"--force must be a file with a line for each of {len(time)} times, got "
            f"{len(values)} in {shown(path)}"
        )
    return values


def _load(text: str) -> tuple[Any, float]:
    """Return a point and its load from ``coordinate@position=load``."""
    where, _, load = text.partition("=")
    try:
        value = float(load)
    except ValueError:
        raise SceneError(
            f"--start must be point=load [N, N m] such as z@0.5=10, got {shown(text)}"
        ) from None
    return point(where, "--start"), value
