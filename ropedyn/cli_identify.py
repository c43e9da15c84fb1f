"""Command that identifies numbers of a scene from peaks."""

from __future__ import annotations

import argparse
import sys
import warnings
from typing import Any

from .cli_options import compile_options, numbers, output_options, show, whole_numbers
from .errors import IdentifyWarning, SceneError
from .fit import Fit
from .identify import identify
from .peaks import Peaks
from .scene import Scene

WORDS = {"auto": "auto", "search": None}
"""Orders that are no numbers."""


def identify_command(commands: Any) -> None:
    """Add the command."""
    parser = commands.add_parser(
        "identify",
        help="tension, stiffness and other numbers from measured peaks",
        description="Tension, stiffness and other numbers of the scene from measured peaks; what "
        "the scene says of them is a guess.",
    )
    parser.add_argument("scene", metavar="SCENE.toml", help="the scene")
    parser.add_argument("--peaks", required=True, help="measured peaks, comma list [Hz]")
    parser.add_argument(
        "--std", help="of the peaks, one number or a comma list [Hz]; estimated without it"
    )
    parser.add_argument(
        "--orders",
        default="auto",
        help='which mode each peak is, comma list, 0 for none, "auto" or "search" (%(default)s)',
    )
    parser.add_argument(
        "--unknown",
        required=True,
        help="comma list, such as tension,bending_stiffness,ends[0].spring.beta",
    )
    parser.add_argument(
        "--prior",
        action="append",
        default=[],
        metavar="PATH=VALUE:STD",
        help="what is known of an unknown beforehand; may be repeated",
    )
    compile_options(parser)
    output_options(parser)
    parser.set_defaults(run=_identify)


def _identify(options: argparse.Namespace) -> None:
    std = None if options.std is None else numbers(options.std, "--std")
    peaks = Peaks(numbers(options.peaks, "--peaks"), std=std)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", IdentifyWarning)
        fit = identify(
            Scene.load(options.scene),
            peaks,
            options.unknown.split(","),
            orders=_orders(options.orders),
            prior=dict(_known(text) for text in options.prior) or None,
            elements=options.elements,
            element=options.element,
        )
    _tell(options, fit)


def _tell(options: argparse.Namespace, fit: Fit) -> None:
    """Print the report, or the table alone with what limits it beside it."""
    if options.json or options.csv:
        for note in fit.notes:
            print(f"ropedyn: {note}", file=sys.stderr)
        show(options, fit)
    else:
        show(options, fit, text=fit.report())


def _orders(text: str) -> Any:
    return WORDS[text] if text in WORDS else whole_numbers(text, "--orders")


def _known(text: str) -> tuple[str, tuple[float, float]]:
    """Return a path with its value and standard deviation from ``path=value:std``."""
    path, _, pair = text.partition("=")
    value, _, std = pair.partition(":")
    try:
        return path, (float(value), float(std))
    except ValueError:
        raise SceneError(
            f"--prior must be path=value:std such as tension=300:15, got {text!r}"
        ) from None
