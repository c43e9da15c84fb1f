"""How texts of the command line become numbers, points and forces.

Each takes the text and the name of its option, which its error says.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from ..base.array import Real
from ..base.check import shown
from ..base.errors import SceneError
from ..base.parameter import Description, required
from ..base.unit import END, WIRE
from ..chain.port import Point
from ..scene.force import Chirp, Force, Impulse, Sine, Step

_Number = TypeVar("_Number", int, float)

FORCES: dict[str, tuple[type[Description], tuple[str, ...]]] = {
    "sine": (Sine, ("amplitude", "frequency", "phase")),
    "step": (Step, ("amplitude", "time")),
    "impulse": (Impulse, ("impulse", "duration", "time")),
    "chirp": (Chirp, ("amplitude", "start", "stop", "duration")),
}
"""Each kind of force, and its numbers in the order in which they follow the word."""

NO_OPTIONS = {"scene", "run", "json", "csv", "file", "record", "name"}
RENAMED = {
    "number": ("modes",),
    "frequencies": ("frequency",),
    "positions": ("position",),
    "columns": ("column",),
    "response": ("channel", "sensors"),
}
"""Arguments that are options of another name, or of one of several."""
ORDERS = {"auto": "auto", "search": None}  # Orders that are words.


def figure_file(text: str, option: str) -> Path:
    """Return the file of a figure, whose ending says its format."""
    from matplotlib.backend_bases import FigureCanvasBase

    known = sorted(FigureCanvasBase.get_supported_filetypes())
    path = Path(text)
    if path.suffix[1:].lower() not in known:
        ends = ", ".join(f".{one}" for one in known)
        raise SceneError(f"{option} must be a file that ends in one of {ends}, got {shown(text)}")
    return path


def in_options(message: str, options: Mapping[str, Any]) -> str:
    """Return what is said of arguments of Python as said of the options of these names."""
    known = {name: f"--{name.replace('_', '-')}" for name in options if name not in NO_OPTIONS}
    known |= {
        name: " or ".join(known[one] for one in names)
        for name, names in RENAMED.items()
        if known.keys() >= set(names)
    }
    if options.get("peaks") is not None:
        known["measured"] = known["peaks"]

    def option(found: re.Match[str]) -> str:
        return known.get(found["name"], found[0])

    def value(found: re.Match[str]) -> str:
        name = found["name"]
        return f"{known[name]} {found['value']}" if name in known else found[0]

    message = re.sub(r"Tension\(([^,()]+), ([^()]*)\)", _table, message)
    message = re.sub(r"\b(?P<name>\w+)=\"?(?P<value>[\w./^]+)\"?", value, message)
    message = re.sub(r"(?<=\bleave )(?P<name>\w+)(?= out\b)", option, message)
    message = re.sub(r"(?<=\bor )(?P<name>\w+)(?= stated\b)", option, message)
    message = re.sub(r"\(['\"](\w+)['\"], ([\w.+-]+)\)", r"\1@\2", message)
    message = re.sub(r"\{(?:[^{}:,]+: [^{}:,]+(?:, )?)+\}", _pairs, message)
    message = message.replace(', or "X", "Y" or "Z"', "").replace("got None", "got none")
    return re.sub(
        r"(?:^|(?<=; ))(?:measured\.)?(?P<name>\w+)(?:\[[^]]*\])*(?=:? )",
        option,
        message,
        flags=re.MULTILINE,
    )


def _pairs(found: re.Match[str]) -> str:
    """Return a dictionary as options have it: 1=0.5."""
    each = found[0].strip("{}").split(", ")
    return ", ".join("=".join(side.strip("\"'") for side in one.split(": ")) for one in each)


def _table(found: re.Match[str]) -> str:
    """Return a pulsating tension as scene files have it."""
    return f"tension = {{ mean = {found[1]}, {found[2].replace('=', ' = ')} }}"


def words(text: str, option: str) -> list[str]:
    """Return the words of a comma list."""
    return text.split(",")


def numbers(text: str, option: str) -> list[float]:
    """Return the numbers of a comma list."""
    return _listed(text, float, f"{option} must be a comma list of numbers")


def peaks(text: str, option: str) -> dict[str, list[Any]]:
    """Return what is said of peaks: a comma list, a file of them, or ``-`` for standard input.

    A file has a comma list, or a line for each peak: its frequency and maybe its standard deviation
    [Hz], or what the first line names, as ``--csv`` of other commands prints it.
    """
    if text != "-" and not Path(text).is_file():
        kinds = f"{option} must be a comma list of numbers, a file or - for the standard input"
        return {"frequency": _listed(text, float, kinds)}
    lines = sys.stdin.read() if text == "-" else Path(text).read_text(encoding="utf-8-sig")
    rows = [re.split(r"[\s,;]+", line.strip()) for line in lines.splitlines()]
    rows = [row for row in rows if row[0] and not row[0].startswith("#")]
    if len(rows) == 1 and len(rows[0]) > 2:
        rows = [[one] for one in rows[0]]
    named = bool(rows) and rows[0][0][0].isalpha()
    names = rows.pop(0) if named else ["frequency", "std"][: len(rows[0]) if rows else 0]
    if "frequency" not in names or {len(row) for row in rows} != {len(names)}:
        raise SceneError(
            f"{option} must be a file with the frequency and maybe the std of a peak [Hz] in each "
            f"line, or columns of these names, got {shown(text)}"
        )
    known = {"frequency": float, "std": float, "order": int}
    columns = {name: column for name, column in zip(names, zip(*rows)) if name in known}
    expected = f"{option} must be a file of numbers"
    return {name: _listed(",".join(one), known[name], expected) for name, one in columns.items()}


def whole_numbers(text: str, option: str) -> list[int]:
    """Return the whole numbers of a comma list."""
    return _listed(text, int, f"{option} must be a comma list of whole numbers")


def _listed(text: str, kind: Callable[[str], _Number], expected: str) -> list[_Number]:
    try:
        return [kind(part) for part in text.split(",")]
    except ValueError:
        raise SceneError(f"{expected}, got {shown(text)}") from None


def orders(text: str, option: str) -> Any:
    """Return which mode each peak is, or the word that says how that is found."""
    return ORDERS[text] if text in ORDERS else whole_numbers(text, option)


def spaced(unit: str) -> Callable[[str, str], Real | list[float]]:
    """Return what takes ``start:stop:count``, equally spaced numbers, or a comma list."""

    def parse(text: str, option: str) -> Real | list[float]:
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

    return parse


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


def load_at(text: str, option: str) -> tuple[Point, float]:
    """Return a point and its load from ``coordinate@position=load``."""
    where, _, load = text.partition("=")
    try:
        value = float(load)
    except ValueError:
        raise SceneError(
            f"{option} must be point=load [N, N m] such as z@0.5=10, got {shown(text)}"
        ) from None
    return point(where, option), value


def known(text: str, option: str) -> tuple[str, tuple[float, float]]:
    """Return a path with its value and standard deviation from ``path=value:std``."""
    path, _, pair = text.partition("=")
    value, _, std = pair.partition(":")
    try:
        return path, (float(value), float(std))
    except ValueError:
        raise SceneError(
            f"{option} must be path=value:std such as tension=300:15, got {text!r}"
        ) from None


def pair(text: str, option: str) -> tuple[str, str]:
    """Return what stands on both sides of an equals sign."""
    name, between, value = text.partition("=")
    if not (name and between and value):
        raise SceneError(f"{option} must be two words with = between, got {shown(text)}")
    return name, value


def node(text: str, option: str) -> tuple[int, float]:
    """Return the number of a node and its position from ``NODE=X``."""
    number, x = pair(text, option)
    return _of_node(number, int, option), _of_node(x, float, option)


def _of_node(text: str, kind: Callable[[str], _Number], option: str) -> _Number:
    try:
        return kind(text)
    except ValueError:
        raise SceneError(f"{option} must be NODE=X, such as 1=0.5, got {shown(text)}") from None


def name_or_number(text: str, option: str) -> str | int:
    """Return the name of a column, whole numbers as such."""
    return int(text) if text.isdecimal() else text


def channel(text: str, option: str) -> tuple[str | int, Point]:
    """Return which channel it is and where, from ``name=coordinate@position``."""
    name, where = pair(text, option)
    return name_or_number(name, option), point(where, option)


def column(text: str, option: str) -> tuple[str, str | int]:
    """Return a kind of column and which one it is: whole numbers are numbers."""
    kind, name = pair(text, option)
    return kind, name_or_number(name, option)


def force_words(kind: str) -> str:
    """Say what follows the word of a force, such as ``AMPLITUDE[:TIME]``."""
    made, names = FORCES[kind]
    least, upper = len(required(made)), ":".join(names).upper().split(":")
    left = [f"[:{name}" for name in upper[least:]]
    return ":".join(upper[:least]) + "".join(left) + "]" * len(left)


def force(text: str, time: Real) -> Force | Real:
    """Return a force from its kind and numbers, or its samples from a file."""
    kind, *rest = text.split(":")
    if kind not in FORCES:
        return _samples(text, time)
    made, names = FORCES[kind]
    try:
        values = [float(part) for part in rest]
    except ValueError:
        values = []
    if not len(required(made)) <= len(values) <= len(names):
        raise SceneError(f"--force must be {kind}:{force_words(kind)}, got {shown(text)}")
    return made(**dict(zip(names, values)))  # type: ignore[return-value]


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
