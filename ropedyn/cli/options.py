"""What several commands share: options, and how texts become numbers and points."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ..base.answer import Answer
from ..base.array import Real
from ..base.atomic import replacing
from ..base.check import shown
from ..base.errors import SceneError
from ..base.unit import END, WIRE
from ..chain.chain import KINDS
from ..chain.port import Point
from ..model import Model
from ..scene.scene import Scene


def compile_options(parser: argparse.ArgumentParser) -> None:
    """Add what chooses elements."""
    parser.add_argument(
        "--elements", type=int, help="over the rope; without it spans are continuous"
    )
    parser.add_argument("--element", choices=KINDS, help="kind (tensed where --elements is given)")


def output_options(parser: argparse.ArgumentParser) -> None:
    """Add what chooses the form of an answer."""
    parser.add_argument("--plot", type=Path, metavar="FILE", help="write a figure")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--json", action="store_true", help="print the table as JSON")
    form.add_argument("--csv", action="store_true", help="print the table as CSV")


def scene_command(
    commands: Any,
    name: str,
    run: Callable[[argparse.Namespace], None],
    options: Callable[[argparse.ArgumentParser], object],
    *,
    text: str,
    description: str | None = None,
    elements: Callable[[argparse.ArgumentParser], object] = compile_options,
) -> None:
    """Add a command about a scene: beside its own options elements and the form of its answer.

    The description is the text as a sentence where left out, the elements are those of a model.
    """
    if description is None:
        description = f"{text[0].upper()}{text[1:]}."
    parser = commands.add_parser(name, help=text, description=description)
    parser.add_argument("scene", metavar="SCENE.toml", help="the scene")
    elements(parser)
    options(parser)
    output_options(parser)
    parser.set_defaults(run=run)


def modes_option(parser: argparse.ArgumentParser) -> None:
    """Add how many modes carry the motion."""
    parser.add_argument(
        "--modes", type=int, default=4, help="with transverse motion, the lowest (%(default)s)"
    )


def progress_option(parser: argparse.ArgumentParser) -> None:
    """Add the wish to see progress."""
    parser.add_argument("--progress", action="store_true", help="say on stderr how far it is")


def compiled(options: argparse.Namespace) -> Model:
    """Return the model of the scene."""
    return Scene.load(options.scene).compile(elements=options.elements, element=options.element)


def show(options: argparse.Namespace, answer: Answer, text: str | None = None) -> None:
    """Print an answer, as text that or its table, and draw it where that is asked."""
    table = answer.table()
    if options.json:
        print(json.dumps({"title": table.title, "rows": table.to_records()}, indent=1))
    elif options.csv:
        print(table.to_csv(), end="")
    else:
        print(table if text is None else text)
    if options.plot is not None:
        figure = answer.plot().get_figure(root=True)
        assert figure is not None
        with replacing(options.plot) as draft:
            figure.savefig(draft, dpi=120)


def numbers(text: str, option: str) -> list[float]:
    """Return the numbers of a comma list."""
    try:
        return [float(part) for part in text.split(",")]
    except ValueError:
        raise SceneError(f"{option} must be a comma list of numbers, got {shown(text)}") from None


def whole_numbers(text: str, option: str) -> list[int]:
    """Return the whole numbers of a comma list."""
    try:
        return [int(part) for part in text.split(",")]
    except ValueError:
        raise SceneError(
            f"{option} must be a comma list of whole numbers, got {shown(text)}"
        ) from None


def spaced(text: str, option: str, unit: str) -> Real | list[float]:
    """Return equally spaced numbers from ``start:stop:count``, or those of a comma list."""
    if ":" not in text:
        return numbers(text, option)
    parts = text.split(":")
    try:
        start, stop, count = float(parts[0]), float(parts[1]), int(parts[2])
        if len(parts) == 3 and 1 <= count <= 10_000_000 and np.isfinite([start, stop]).all():
            return np.linspace(start, stop, count)
    except (ValueError, IndexError):
        pass
    raise SceneError(f"{option} must be start:stop:count [{unit}], got {shown(text)}")


def point(text: str, option: str) -> Point:
    """Return a point from ``coordinate@position``."""
    coordinate, at, position = text.partition("@")
    try:
        if at:
            return coordinate, int(position) if coordinate == WIRE else float(position)
    except ValueError:
        pass
    raise SceneError(f"{option} must be coordinate@position [m] such as z@0.5, got {shown(text)}")


def drive(text: str, option: str) -> Any:
    """Return what is driven: a point, or from ``end:number:coordinate`` an end that is moved."""
    kind, *rest = text.split(":")
    if kind != END:
        return point(text, option)
    try:
        number, coordinate = rest
        return END, int(number), coordinate
    except ValueError:
        raise SceneError(
            f"{option} must be {END}:number:coordinate such as {END}:0:z, got {shown(text)}"
        ) from None
