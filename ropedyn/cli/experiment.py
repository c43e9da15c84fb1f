"""Commands that take a measurement: compare a scene with it, identify numbers of the scene."""

from __future__ import annotations

import argparse
import json
import sys
import warnings
from functools import partial
from typing import Any

from ..base.errors import IdentifyWarning, at_once
from ..base.unit import QUANTITIES
from ..curves.measured import Measured
from ..curves.peaks import Peaks
from ..experiment.compare.compare import compare
from ..experiment.identify.fit import Fit
from ..experiment.identify.identify import ENDS, identify
from ..scene.scene import Scene
from . import text
from .options import (
    DRIVE,
    RESPONSE,
    STATUS,
    Command,
    OptionGroup,
    compiled,
    draw,
    option,
    refuse,
    repeated,
    show,
    switch,
)

PEAKS_ARE = "comma list [Hz], or a file or - with one a line, and their std"
MEASURED = OptionGroup(
    (
        option("--peaks", f"measured peaks, {PEAKS_ARE}", text.peaks, metavar="PEAKS|FILE|-"),
        option("--measured", "measured response, universal file or CSV", metavar="FILE"),
    ),
    required=True,
)
OF_FILE = (
    option(*DRIVE),
    RESPONSE,
    option("--quantity", "of the values", choices=QUANTITIES),
    option("--unit", 'of the values, such as "m/s^2/N" or "g/N"'),
    repeated(
        "--position",
        "where a node of a universal file is [m], such as 1=0.5",
        text.node,
        metavar="NODE=X",
    ),
    repeated(
        "--coordinate",
        "what a direction of a universal file is, such as Z=z or RY=-beta",
        text.pair,
        metavar="DIRECTION=COORDINATE",
    ),
    repeated(
        "--column",
        "column of a CSV file: frequency, real, imag, amplitude, phase or coherence",
        text.column,
        metavar="KIND=NAME",
    ),
    switch(
        "--reciprocal",
        "exchange what was driven and what was watched, for a hammer that roves",
        default=None,
    ),
)
"""What only a file takes."""

FILE_TITLE = "of a FILE, where it does not say so itself"
STD = "of the peaks, one number or a comma list [Hz]"

ONLY_PEAKS = switch("--only-peaks", "of the FILE, not all of it", default=None)
STD_OF_COMPARED = option("--std", STD, text.numbers)
STD_OF_FITTED = option("--std", f"{STD}; estimated without it", text.numbers)
ORDERS = option(
    "--orders",
    'which mode each peak is, comma list, 0 for none, "auto" or "search" (%(default)s)',
    text.orders,
    default="auto",
)
HELD = option("--ends", "whether they are known (unknown if the rope bends)", choices=ENDS)
PRIOR_OF = repeated(
    "--prior",
    "what is known of a number beforehand",
    text.known,
    default=[],
    metavar="PATH=VALUE:STD",
)
ORDER = option(
    "--order", "which mode each peak is, comma list of whole numbers", text.whole_numbers
)
BAND = option("--band", "that FRAC is taken over at each line [Hz]", type=float)


def peaks_of(options: argparse.Namespace, **also: Any) -> Peaks:
    """Return the peaks that are given; what options say beside a file replaces what it says."""
    also = {"std": options.std, **also}
    return Peaks(**options.peaks | {name: one for name, one in also.items() if one is not None})


def _read(options: argparse.Namespace) -> Measured:
    """Read the file."""
    given = {
        "quantity": options.quantity,
        "unit": options.unit,
        "reciprocal": options.reciprocal,
        "drive": options.drive,
        "response": options.response,
        "positions": options.position and dict(options.position),
        "coordinate": options.coordinate and dict(options.coordinate),
        "columns": options.column and _columns(options.column),
    }
    return Measured.read(options.measured, **{k: v for k, v in given.items() if v is not None})


def _columns(pairs: list[tuple[str, str | int]]) -> dict[str, Any]:
    """Return columns by their kind, a list where there are several."""
    found: dict[str, Any] = {}
    for kind, name in pairs:
        found.setdefault(kind, []).append(name)
    return {kind: many[0] if len(many) == 1 else many for kind, many in found.items()}


def _compare(options: argparse.Namespace) -> None:
    if options.peaks is not None:
        refuse(options, (*OF_FILE, BAND), "--measured")
        read: Any = partial(peaks_of, options, order=options.order)
    else:
        refuse(options, (STD_OF_COMPARED, ORDER), "--peaks")
        read = partial(_read, options)
    model, measured = at_once(partial(compiled, options), read)
    calculated = model if options.modes is None else model.modes(options.modes)
    comparison = compare(calculated, measured, within=options.within, band=options.band)
    show(options, comparison, comparison.report())


COMPARE = Command(
    "compare",
    _compare,
    "calculated against measured peaks or responses",
    (
        option("--modes", "compare with so many (as many as are needed)", type=int),
        MEASURED,
        STD_OF_COMPARED,
        ORDER,
        option("--within", "largest relative error of calculated peaks, such as 0.05", type=float),
        OptionGroup((*OF_FILE, BAND), FILE_TITLE),
    ),
    "Calculated against measured peaks, or a measured frequency response: pairs of peaks, likeness "
    "of responses (FRAC), and what their differences prove of their cause.",
)


def _identify(options: argparse.Namespace) -> int:
    whole = options.peaks is None and options.only_peaks is None
    if options.peaks is not None:
        refuse(options, (*OF_FILE, ONLY_PEAKS), "--measured")
        read: Any = peaks_of
    else:
        refuse(options, (STD_OF_FITTED,), "--peaks")
        read = _read
    scene, measured = at_once(partial(Scene.load, options.scene), partial(read, options))
    measured = measured if options.only_peaks is None else Peaks.of(measured)
    given = {"ends": options.ends, "orders": options.orders}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", IdentifyWarning)
        found: Any = identify(
            scene,
            measured,
            options.unknown,
            prior=dict(options.prior) or None,
            elements=options.elements,
            element=options.element,
            **given,
        )
    # what limits the report stands in it, and in JSON; beside a table alone
    if options.csv:
        for note in found.notes:
            print(f"ropedyn: {note}", file=sys.stderr)
    if options.json and isinstance(found, Fit):
        # the table, and beside it all that `tension` prints
        print(found.table().to_json(json.loads(found.to_json())))
        draw(options, found)
    else:
        show(options, found, found.report())
    return 0 if whole else STATUS[found.status]


IDENTIFY = Command(
    "identify",
    _identify,
    "tension, stiffness and other numbers from measured peaks or responses",
    (
        MEASURED,
        ONLY_PEAKS,
        STD_OF_FITTED,
        ORDERS,
        HELD,
        option(
            "--unknown",
            "comma list, such as tension,bending_stiffness,ends[0].spring.beta (%(default)s)",
            text.words,
            default="tension",
        ),
        PRIOR_OF,
        OptionGroup(OF_FILE, FILE_TITLE),
    ),
    "Tension, stiffness and other numbers of the scene from measured peaks, or a measured "
    "frequency response; what the scene says of them is a guess.",
)
