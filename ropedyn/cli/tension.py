"""The command that goes from a record, or peaks, to a tension."""

from __future__ import annotations

import argparse
import warnings
from functools import partial
from typing import Any

from ..base.computed import changed
from ..base.errors import IdentifyWarning, SceneError, at_once
from ..base.unit import MOTIONS
from ..curves.record.record import Record
from ..experiment.identify.identify import identify, peaks_of_record, said_of
from ..scene.scene import Scene
from . import text
from .experiment import HELD, ORDERS, PEAKS_ARE, PRIOR_OF, STD_OF_FITTED, peaks_of
from .options import (
    BAD_INPUT,
    STATUS,
    Command,
    Option,
    OptionGroup,
    option,
    refuse,
    repeated,
    shown_fit,
)

COORDINATE = "z"
"""What sensors measure where only their positions are said."""

OF_RECORD = (
    option("--sensors", "positions of all channels in their order, comma list [m]", text.numbers),
    repeated(
        "--channel",
        "which channel is where, in place of --sensors, such as a1=z@3.5",
        text.channel,
        metavar="NAME=COORDINATE@POSITION",
    ),
    option("--time", "column of the times of a CSV file, by name or number", text.name_or_number),
    option("--rate", "samples a second, in place of --time [Hz]", type=float),
    option("--quantity", "that was recorded (acceleration)", choices=tuple(MOTIONS)),
    option("--unit", 'of the record, such as "g" or "mm/s" (SI)'),
    option(
        "--force",
        "channel of the force and where it acts, such as hammer=z@9.0 or 0=z@9.0",
        text.channel,
        metavar="NAME=COORDINATE@POSITION",
    ),
    option("--below", "peaks below this frequency alone [Hz]", type=float),
    option("--decimal", "of a CSV file", choices=(".", ",")),
)
"""What only a record takes."""

RECORD = Option("record", {"help": "CSV or universal file", "nargs": "?", "metavar": "RECORD"})
PEAKS = option("--peaks", f"in place of a record, {PEAKS_ARE}", text.peaks, metavar="PEAKS|FILE|-")
WIDE = ("tension", "bending_stiffness")
"""What is sought of a rope that bends."""


def _tension(options: argparse.Namespace) -> int:
    scene, record = at_once(partial(Scene.load, options.scene), partial(_record, options))
    peaks = peaks_of(options) if record is None else peaks_of_record(record, options.below)
    bends = "beta" in scene.coordinates
    unknown = options.unknown or list(WIDE[: 1 + bends])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", IdentifyWarning)
        fit = identify(
            scene,
            peaks,
            unknown,
            orders=options.orders,
            ends=options.ends,
            prior=dict(options.prior) or None,
            model_std=options.model_std,
            seed=options.seed,
        )
    if options.save is not None and fit.status != "refused":
        fit.scene.save(options.save)
    if record is None:
        return shown_fit(options, fit)
    return shown_fit(options, changed(fit, record=said_of(record)), peaks)


def _record(options: argparse.Namespace) -> Record | None:
    """Return the record, None where peaks are given in its place."""
    if (options.record is None) == (options.peaks is None):
        raise SceneError("either RECORD or --peaks must be given, got both or none")
    if options.peaks is not None:
        refuse(options, OF_RECORD, "RECORD")
        return None
    refuse(options, (STD_OF_FITTED,), "--peaks")
    return _read(options)


def _read(options: argparse.Namespace) -> Record:
    """Read the record; a file that was written here says everything itself."""
    if options.sensors is not None and options.channel is not None:
        raise SceneError("--sensors must be left out with --channel, got both")
    response: Any = dict(options.channel) if options.channel is not None else None
    if options.sensors is not None:
        response = [(COORDINATE, x) for x in options.sensors]
    given = {
        "time": options.time,
        "rate": options.rate,
        "response": response,
        "quantity": options.quantity,
        "unit": options.unit,
        "force": None if options.force is None else dict([options.force]),
        "decimal": options.decimal,
    }
    return Record.read(options.record, **{k: v for k, v in given.items() if v is not None})


TENSION = Command(
    "tension",
    _tension,
    "the tension of a rope from a recorded time series or its peaks",
    (
        RECORD,
        PEAKS,
        STD_OF_FITTED,
        option("--unknown", "comma list (tension, and bending_stiffness if it bends)", text.words),
        ORDERS,
        HELD,
        PRIOR_OF,
        option("--model-std", "what the model is off, relative", type=float, default=0.0),
        option("--save", "write the scene with what was found; its ends stay", metavar="FILE.toml"),
        option("--seed", "of the random numbers (%(default)s)", type=int, default=0),
        OptionGroup(OF_RECORD, "of a RECORD that does not say so itself"),
    ),
    "The tension of a rope from a recorded time series, or from its peaks: which modes they are "
    f"and how the ends are held is found with it. Exit status {STATUS['trusted']} where the answer "
    f"can be trusted, {STATUS['ambiguous']} where the peaks leave several, {STATUS['refused']} "
    f"where there is none, {BAD_INPUT} where the input was bad.",
    elements=(),
)
