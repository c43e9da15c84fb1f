"""Every key and table of a scene file, from the declarations: writes docs/scene_file.md.

python docs/scene_file.py
"""

import dataclasses
import inspect
import re
from importlib import resources
from pathlib import Path

import ropedyn as rd
from ropedyn.base.check import SIGNS
from ropedyn.base.parameter import parameters, required
from ropedyn.scene import damping
from ropedyn.scene.parts import part

PAGE = Path(__file__).with_suffix(".md")
ROOT = PAGE.parent.parent
TABLES = (
    (rd.Scene, "The file", "Keys before the first table, and the tables themselves."),
    (rd.Rope, "`[rope]`", ""),
    (
        rd.End,
        "Ends",
        "Each of the two `ends` is a word or a table, as "
        '`ends = ["clamped", { beta = "free", spring = { beta = 5e6 } }]`.',
    ),
    (rd.Tension, "`[tension]`", "A table in place of the number."),
    (rd.Gravity, "`[gravity]`", ""),
)
KINDS = (
    ("damping", damping.KINDS, "Their sum acts."),
    ("parts", part.KINDS, "What stands on the rope, or changes it over a stretch."),
)
OPENING = """# Scene files

A scene file is [TOML](https://toml.io) in SI units, frequencies in Hz. Keys are the names of the
arguments in Python; {py:meth}`Scene.save <ropedyn.Scene.save>` writes such a file and
{py:meth}`Scene.load <ropedyn.Scene.load>` reads it. An unknown key is an error that names those
there are. `ropedyn scene rope.toml` says what a file describes, so that a slip of units is seen.
`python docs/scene_file.py` writes this page from the declarations that check the files.

`ropedyn scene --example` prints one to begin with:
"""


def documented(kind):
    """Return what the documentation of a class says of each of its parameters: type, meaning."""
    listed = re.search(r"\nParameters\n-+\n(.*?)\n\n", inspect.getdoc(kind) + "\n\n", re.S)
    text = re.sub(r"\\\n *", "", listed[1])
    found = {}
    for names, of_type, words in re.findall(r"^(\w.*?) : (.*)\n((?: .*\n?)+)", text, re.M):
        said = of_type.removesuffix(", optional"), " ".join(words.split())
        found |= dict.fromkeys(names.split(", "), said)
    return found


def value_of(kind, field, of_type):
    """Return what a key must be: unit and sign of a number, else what the documentation says."""
    one = parameters(kind)[field.name]
    words = {"bool": "true or false"}.get(of_type, of_type)
    if one.unit or (of_type == "float" and one.sign != "any"):
        words = f"number{SIGNS[one.sign][0]}"
        words += " or a pair of them" if "pair" in of_type else ""
    unit = " or ".join(one.units())
    return f"{words} [{unit}]" if unit else words.replace("float", "number")


def default_of(kind, field):
    """Return what holds where a key is left out."""
    if field.name in required(kind):
        return "must be given"
    value = field.default
    if value is dataclasses.MISSING or value is None or value == ():
        return "none"  # a mapping without keys is made by a factory
    if isinstance(value, bool):
        return f"`{str(value).lower()}`"
    shown = list(value) if isinstance(value, tuple) else value
    return f"`{shown!r}`".replace("'", '"')


def table(kind):
    """Return the lines of the table of a description."""
    said = documented(kind)
    lines = ["| key | value | left out | meaning |", "|---|---|---|---|"]
    for field in dataclasses.fields(kind):
        of_type, meaning = said[field.name]
        value = value_of(kind, field, of_type)
        cells = (f"`{field.name}`", value, default_of(kind, field), marked(meaning))
        lines.append(f"| {' | '.join(one.replace('|', chr(92) + '|') for one in cells)} |")
    return lines


def marked(text):
    """Return a text of a docstring in Markdown."""
    return re.sub(r"``?(.+?)``?", r"`\1`", text)


def first_line(kind):
    """Return what a class is, in its own words."""
    return marked(inspect.getdoc(kind).partition("\n\n")[0])


def page():
    """Return the page."""
    example = resources.files("ropedyn") / "scene" / "example.toml"
    lines = [OPENING, "```toml", example.read_text(encoding="utf-8").rstrip(), "```"]
    for kind, heading, said in TABLES:
        lines += ["", f"## {heading}", "", " ".join(f"{said} {first_line(kind)}".split()), ""]
        lines += table(kind)
    for name, kinds, said in KINDS:
        lines += ["", f"## `[[{name}]]`", "", f"Any number of tables, each with its `kind`. {said}"]
        for kind in kinds:
            if kind is rd.NodeForce:  # whose law is Python
                continue
            lines += ["", f'### `kind = "{kind.__name__}"`', "", first_line(kind), "", *table(kind)]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
