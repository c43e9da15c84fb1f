"""Commands that ask a scene: modes, responses, motion, growth, and what they cost."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from .. import ask
from ..base import check
from ..base.errors import SceneError
from ..base.unit import MOTIONS
from ..motion.request import METHODS
from ..scene.scene import Scene
from ..study.accuracy import accuracy_cost
from ..study.effect import effect_cost
from ..study.truth import FEWEST, MOST
from . import text
from .options import (
    DRIVE,
    RESPONSE,
    Command,
    OptionGroup,
    compiled,
    option,
    progress,
    refuse,
    repeated,
    show,
    switch,
)

LINES = ("--frequency", "start:stop:lines or a comma list [Hz]", text.spaced("Hz"))
CARRYING = option(
    "--modes", "with transverse motion, the lowest (%(default)s)", type=int, default=4
)
PROGRESS = switch("--progress", "say on stderr how far it is, where that is no terminal too")

QUESTION = (
    OptionGroup(
        (
            option("--modes", "how many", type=int),
            option("--below", "instead: modes below this [Hz]", type=float),
            option(*LINES),
        )
    ),
    switch("--damped", "complex modes"),
    option(*DRIVE),
    RESPONSE,
)
FIRST = 1  # Number of the lowest mode, as people count.
USUAL = 10  # Modes, where nobody says how many.
EITHER = (
    f"for modes ({USUAL} of them unless --modes or --below is given) or, with --frequency and "
    "--drive, a frequency response."
)
"""What a command says that takes a `QUESTION`."""


def _modes(options: argparse.Namespace) -> None:
    if options.mode is not None and options.animate is None:
        raise SceneError("--animate must be given with --mode, got none")
    modes: Any = compiled(options).modes(options.modes, damped=options.damped)
    if options.animate is not None:
        number = FIRST if options.mode is None else options.mode
        check.count(number, "--mode", most=len(modes.frequency))
        modes.animate(number - FIRST, path=options.animate)
    show(options, modes)


MODES = Command(
    "modes",
    _modes,
    "natural frequencies and shapes",
    (
        option("--modes", "how many (%(default)s)", type=int, default=USUAL),
        switch("--damped", "complex modes"),
        option("--animate", "write a mode in motion: .gif, .html, .mp4", type=Path, metavar="FILE"),
        option("--mode", f"which of them --animate shows ({FIRST})", type=int),
    ),
)


def _frf_question(options: argparse.Namespace) -> ask.AnyQuestion:
    return ask.frf(options.frequency, drive=options.drive, response=options.response)


FRF = Command(
    "frf",
    lambda options: show(options, _frf_question(options).of(compiled(options))),
    "frequency response",
    (option(*LINES, required=True), option(*DRIVE, required=True), RESPONSE),
)


def _question(options: argparse.Namespace) -> ask.AnyQuestion:
    if options.frequency is not None:
        if options.drive is None:
            raise SceneError("--drive must be given with --frequency, got none")
        if options.damped:
            raise SceneError("--damped must be given with modes, got --frequency")
        return _frf_question(options)
    refuse(options, (option(*DRIVE), RESPONSE), "--frequency")
    number = USUAL if options.modes is None and options.below is None else options.modes
    return ask.modes(number, below=options.below, damped=options.damped)


def _accuracy(options: argparse.Namespace) -> None:
    cost = accuracy_cost(
        Scene.load(options.scene),
        _question(options),
        elements=options.elements,
        element=options.element,
        solver=options.solver,
        progress=progress(options),
    )
    show(options, cost)


ACCURACY = Command(
    "accuracy",
    _accuracy,
    "time and error of every element and solver",
    QUESTION,
    f"Time and error of every element and solver, {EITHER}",
    (
        option(
            "--elements",
            f"of chains, comma list (powers of two from {2**FEWEST} to {2**MOST})",
            text.whole_numbers,
        ),
        option("--element", "kinds (%(default)s)", text.words, default="rigid,tensed,continuous"),
        option("--solver", "comma list (those usual for the question)", text.words),
    ),
)


def _effects(options: argparse.Namespace) -> None:
    scene = Scene.load(options.scene)
    how = {"elements": options.elements, "element": options.element}
    cost = effect_cost(scene, _question(options), progress=progress(options), **how)
    show(options, cost, cost.report())


EFFECTS = Command(
    "effects",
    _effects,
    "what each effect of the scene changes and costs",
    QUESTION,
    f"What each effect of the scene changes and costs, {EITHER}",
)


def _transient(options: argparse.Namespace) -> None:
    time = np.asarray(options.time, dtype=np.float64)
    if len(options.drive) != len(options.force):
        raise SceneError(
            f"--force must be given once for each of {len(options.drive)} --drive, got "
            f"{len(options.force)}"
        )
    history = compiled(options).transient(
        time,
        drive=[text.drive(one, "--drive") for one in options.drive] or None,
        force=[text.force(one, time) for one in options.force] or None,
        response=options.response,
        quantity=options.quantity,
        start=dict(options.start) or None,
        method=options.method,
        tolerance=options.tolerance,
        progress=progress(options),
    )
    show(options, history)


TRANSIENT = Command(
    "transient",
    _transient,
    "motion over time",
    (
        option("--time", "start:stop:count or a comma list [s]", text.spaced("s"), required=True),
        option(
            "--drive",
            "coordinate@position [m], such as z@0.5, or an end that is moved, such as end:0:z; "
            "may be repeated",
            action="append",
            default=[],
        ),
        option(
            "--force",
            " or ".join(f"{kind}:{text.force_words(kind)}" for kind in text.FORCES)
            + " [N, N s, Hz, rad, s], or a CSV file whose last column is the force, a line for "
            "each of the times; one for each --drive",
            action="append",
            default=[],
        ),
        repeated("--response", "coordinate@position [m]", text.point),
        option("--quantity", "of responses (%(default)s)", choices=MOTIONS, default="displacement"),
        repeated(
            "--start",
            "load that is let go [N, N m], such as z@0.5=10",
            text.load_at,
            default=[],
            metavar="POINT=LOAD",
        ),
        option("--method", "(%(default)s)", choices=METHODS, default="auto"),
        option("--tolerance", "part of the largest value that errors keep to", type=float),
        PROGRESS,
    ),
    "Motion over time, driven by forces or moved ends, or let go from a load.",
)

FLOQUET = Command(
    "floquet",
    lambda options: show(options, compiled(options).floquet(modes=options.modes)),
    "growth of free motion under the pulsating tension of the scene",
    (CARRYING,),
)


def _stability(options: argparse.Namespace) -> None:
    chart = compiled(options).stability_map(
        options.frequency, options.amplitude, modes=options.modes, progress=progress(options)
    )
    show(options, chart)


OF_TENSION = "of the tension, start:stop:count or a comma list"
STABILITY = Command(
    "stability",
    _stability,
    "frequencies and amplitudes of the tension at which motion grows",
    (
        option("--frequency", f"{OF_TENSION} [Hz]", text.spaced("Hz"), required=True),
        option("--amplitude", f"{OF_TENSION} [N]", text.spaced("N"), required=True),
        CARRYING,
        PROGRESS,
    ),
)
