"""The command that identifies numbers of a scene."""

from __future__ import annotations

import argparse
import sys
import warnings
from typing import Any

from ..base.errors import IdentifyWarning, SceneError
from ..curves.measured import Measured
from ..curves.peaks import Peaks
from ..experiment.identify.fit import Fit
from ..experiment.identify.identify import identify
from ..experiment.identify.response_fit import ResponseFit
from ..scene.scene import Scene
from .measured import OF_FILES, file_options, measured_of, measured_options, refuse
from .options import numbers, scene_command, show, whole_numbers

WORDS = {"auto": "auto", "search": None}
"""Orders that are no numbers."""


def identify_command(commands: Any) -> None:
    """Add the command."""
    scene_command(
        commands,
        "identify",
        _identify,
        _options,
        text="tension, stiffness and other numbers from measured peaks or responses",
        description="Tension, stiffness and other numbers of the scene from measured peaks, or a "
        "measured frequency response; what the scene says of them is a guess.",
    )


def _options(parser: argparse.ArgumentParser) -> None:
    measured_options(parser)
    parser.add_argument(
        "--only-peaks",
        action="store_true",
        default=None,
        help="of the FILE, not all of it",
    )
    parser.add_argument(
        "--scale", action="store_true", default=None, help="seek the calibration of the FILE too"
    )
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
        default="tension",
        help="comma list, such as tension,bending_stiffness,ends[0].spring.beta (%(default)s)",
    )
    parser.add_argument(
        "--prior",
        action="append",
        default=[],
        metavar="PATH=VALUE:STD",
        help="what is known of an unknown beforehand; may be repeated",
    )
    file_options(parser)


def _identify(options: argparse.Namespace) -> None:
    measured: Any = _peaks(options) if options.peaks is not None else _measured(options)
    given: dict[str, Any] = {}
    if options.scale is not None:
        given["scale"] = True
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", IdentifyWarning)
        found: Fit | ResponseFit = identify(
            Scene.load(options.scene),
            measured,
            options.unknown.split(","),
            orders=_orders(options.orders),
            prior=dict(_known(text) for text in options.prior) or None,
            elements=options.elements,
            element=options.element,
            **given,
        )
    _tell(options, found)


def _peaks(options: argparse.Namespace) -> Peaks:
    refuse(options, (*OF_FILES, "only_peaks", "scale"), "--measured")
    std = None if options.std is None else numbers(options.std, "--std")
    return Peaks(numbers(options.peaks, "--peaks"), std=std)


def _measured(options: argparse.Namespace) -> Peaks | Measured:
    refuse(options, ("std",), "--peaks")
    measured = measured_of(options)
    return measured if options.only_peaks is None else Peaks.of(measured)


def _tell(options: argparse.Namespace, found: Fit | ResponseFit) -> None:
    """Print the report, or the table alone with what limits it beside it."""
    if options.json or options.csv:
        for note in found.notes:
            print(f"ropedyn: {note}", file=sys.stderr)
    show(options, found, found.report())


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
