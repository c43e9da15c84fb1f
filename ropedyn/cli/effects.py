"""The command that finds what each effect of a scene changes and costs."""

from __future__ import annotations

import argparse
from typing import Any

from ..scene.scene import Scene
from ..study.effect import effect_cost
from .options import scene_command, show
from .question import EITHER, question, question_options


def effects_command(commands: Any) -> None:
    """Add the command."""
    scene_command(
        commands,
        "effects",
        _effects,
        question_options,
        text="what each effect of the scene changes and costs",
        description=f"What each effect of the scene changes and costs, {EITHER}",
    )


def _effects(options: argparse.Namespace) -> None:
    scene = Scene.load(options.scene)
    how = {"elements": options.elements, "element": options.element}
    show(options, effect_cost(scene, question(options), **how))
