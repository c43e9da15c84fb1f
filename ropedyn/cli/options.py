"""Options of the command line, each declared once, and what commands about a scene share."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

from ..base.answer import Answer
from ..base.atomic import replacing
from ..base.errors import RopedynError, SceneError
from ..base.progress import Progress, on_terminal
from ..base.table import Table
from ..chain.chain import KINDS
from ..curves.peaks import Peaks
from ..experiment.identify.fit import Fit
from ..model import Model
from ..scene.scene import Scene
from .text import drive, figure_file, point


class Option(NamedTuple):
    """An option: its name, and what argparse takes beside that."""

    name: str
    how: dict[str, Any]

    def add(self, parser: Any) -> None:
        """Add it to a parser or a group of one."""
        parser.add_argument(self.name, **self.how)


class OptionGroup(NamedTuple):
    """Options of which one may be given or, under a title, all."""

    options: tuple[Option, ...]
    title: str = ""
    required: bool = False

    def add(self, parser: Any) -> None:
        """Add them to a parser."""
        if self.title:
            group = parser.add_argument_group(self.title)
        else:
            group = parser.add_mutually_exclusive_group(required=self.required)
        for one in self.options:
            one.add(group)


class Command(NamedTuple):
    """A command: beside its own options it takes what it is about and the form of an answer.

    It is about a scene, whose elements are options, unless another subject is said. Its description
    is its text as a sentence where left out.
    """

    name: str
    run: Callable[[argparse.Namespace], int | None]  # the exit status, None for 0
    text: str
    own: tuple[Option | OptionGroup, ...]
    description: str = ""
    elements: tuple[Option, ...] | None = None
    subject: tuple[Option, ...] | None = None
    form: tuple[Option | OptionGroup, ...] | None = None  # a table's and a figure's

    def add(self, commands: Any) -> None:
        """Add it to the commands of a parser."""
        about = self.description or f"{self.text[0].upper()}{self.text[1:]}."
        parser = commands.add_parser(self.name, help=self.text, description=about)
        elements = ELEMENTS if self.elements is None else self.elements
        subject = (SCENE,) if self.subject is None else self.subject
        form = OUTPUT if self.form is None else self.form
        for one in (*subject, *elements, *self.own, *form):
            one.add(parser)
        parser.set_defaults(run=self.run)


def option(
    name: str, help: str, parse: Callable[[str, str], Any] | None = None, **how: Any
) -> Option:
    """Return an option; of its text and its name `parse` makes what it means."""
    if parse is not None:
        how["type"] = partial(_meant, parse, name)
    return Option(name, {"help": help, **how})


def repeated(name: str, help: str, parse: Callable[[str, str], Any], **how: Any) -> Option:
    """Return an option that may be given several times."""
    return option(name, f"{help}; may be repeated", parse, action="append", **how)


def switch(name: str, help: str, **how: Any) -> Option:
    """Return an option without a value."""
    return option(name, help, action="store_true", **how)


def _meant(parse: Callable[[str, str], Any], name: str, text: str) -> Any:
    try:
        return parse(text, name)
    # of a ValueError argparse makes a message of its own
    except SceneError as error:
        raise RopedynError(str(error)) from None


SOLVED, REFUSED, BAD_INPUT = 0, 1, 2
STATUS = {"trusted": SOLVED, "refused": REFUSED, "ambiguous": 3}
"""Exit statuses of what was identified."""

SCENE = option("scene", "the scene", metavar="SCENE.toml")
ELEMENTS = (
    option("--elements", "over the rope; without it spans are continuous", type=int),
    option("--element", "kind (tensed where --elements is given)", choices=KINDS),
)
FORM = (switch("--json", "print the table as JSON"), switch("--csv", "print the table as CSV"))
DRIVE = ("--drive", "coordinate@position [m], such as z@0.5, or end:0:z", drive)
RESPONSE = repeated("--response", "as --drive", point)
OUTPUT = (option("--plot", "write a figure", figure_file, metavar="FILE"), OptionGroup(FORM))


def progress(options: argparse.Namespace) -> Progress:
    """Return what says how far long work is: where that is asked, and on a terminal."""
    return True if getattr(options, "progress", False) else on_terminal()


def refuse(options: argparse.Namespace, refused: tuple[Option, ...], instead: str) -> None:
    """Refuse options that only another one takes."""
    for one in refused:
        if getattr(options, one.name[2:].replace("-", "_")) is not None:
            raise SceneError(f"{instead} must be given with {one.name}, got none")


def compiled(options: argparse.Namespace) -> Model:
    """Return the model of the scene."""
    return Scene.load(options.scene).compile(elements=options.elements, element=options.element)


def shown_fit(options: argparse.Namespace, fit: Fit, peaks: Peaks | None = None) -> int:
    """Print what was identified, as the JSON of its schema where that is asked."""
    show(options, fit, fit.report() if peaks is None else f"{peaks.table()}\n\n{fit.report()}")
    return STATUS[fit.status]


def show(options: argparse.Namespace, answer: Answer, report: str | None = None) -> None:
    """Print an answer, as its report or its table, and draw it where that is asked."""
    if options.json:
        print(answer.to_json())
    else:
        show_table(options, answer.table(), report)
    draw(options, answer)


def show_table(options: argparse.Namespace, table: Table, report: str | None = None) -> None:
    """Print a table, or the report instead of its text."""
    if options.json:
        print(table.to_json())
    elif options.csv:
        print(table.to_csv(), end="")
    else:
        print(table.to_text() if report is None else report)


def draw(options: argparse.Namespace, answer: Answer) -> None:
    """Draw an answer where that is asked."""
    if options.plot is not None:
        figure = answer.plot().figure.figure  # the whole, of axes in a part of it too
        assert figure is not None
        with replacing(options.plot) as draft:
            figure.savefig(draft, dpi=120)
