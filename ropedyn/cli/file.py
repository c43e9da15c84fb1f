"""Commands about files: of scenes, of measurements, and the schemas of what is printed."""

from __future__ import annotations

import argparse
from importlib import resources
from pathlib import Path

from ..base.errors import SceneError
from ..curves.files.contents import contents
from ..scene.scene import Scene
from .options import FORM, Command, OptionGroup, option, show_table, switch

SCHEMAS = ("table", "tension")


def _inspect(options: argparse.Namespace) -> None:
    layout = {name: getattr(options, name) for name in ("delimiter", "decimal", "comments", "skip")}
    show_table(options, contents(options.file, **layout))


def _scene(options: argparse.Namespace) -> None:
    if (options.scene is None) == (not options.example):
        raise SceneError("either SCENE.toml or --example must be given, got both or none")
    if options.example:
        example = resources.files("ropedyn") / "scene" / "example.toml"
        print(example.read_text(encoding="utf-8"), end="")
    else:
        print(Scene.load(options.scene))


def _schema(options: argparse.Namespace) -> None:
    file = resources.files("ropedyn") / f"{options.name}-1.schema.json"
    print(file.read_text(encoding="utf-8"), end="")


SCENE_FILE = Command(
    "scene",
    _scene,
    "what a scene file says: length, mass, waves, effects; or an example of one",
    (switch("--example", "print a file with comments, to begin with"),),
    elements=(),
    subject=(option("scene", "the scene", nargs="?", metavar="SCENE.toml"),),
    form=(),
)
INSPECT = Command(
    "inspect",
    _inspect,
    "what a measured file holds: functions of a universal file, columns of text",
    (
        option("--delimiter", "between columns of text (found from the first line)"),
        option("--decimal", "of text (%(default)s)", choices=(".", ","), default="."),
        option("--comments", "how comments begin in text (%(default)s)", default="#"),
        option("--skip", "lines of text before the table", type=int, default=0),
    ),
    elements=(),
    subject=(option("file", "measured", type=Path, metavar="FILE"),),
    form=(OptionGroup(FORM),),
)
SCHEMA = Command(
    "schema",
    _schema,
    "the JSON schema of what --json prints",
    (),
    "The JSON schema of what --json prints: of tables, or of what `tension` finds, which is among "
    "the details of the table of `identify`.",
    elements=(),
    subject=(
        option("name", "of the schema (%(default)s)", nargs="?", choices=SCHEMAS, default="table"),
    ),
    form=(),
)
