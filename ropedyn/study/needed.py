"""Which effects an answer needs: found by leaving them out."""

from __future__ import annotations

import math
from collections.abc import Iterable
from itertools import combinations

from ..ask.question import AnyQuestion
from ..base import check
from ..base.errors import RopedynError
from ..scene.scene import Scene
from .way import Way, answered, check_question

MOST = 8  # Of so many effects all sets are tried, of more one after the other is left out.


def needed(scene: Scene, question: AnyQuestion, tolerance: float) -> tuple[str, ...]:
    """Name the effects that an answer needs; see `Scene.needed`."""
    check_question(scene, question)
    tolerance = check.number(tolerance, "tolerance", sign="positive")
    whole = answered(question, question.placed(scene), {})
    alone = {effect: _apart(whole, scene, [effect]) for effect in scene.effects}
    idle = [effect for effect in alone if alone[effect] <= tolerance]
    idle.sort(key=lambda effect: alone[effect])
    out = _left_out(whole, scene, idle, tolerance)
    return scene.without(*out).effects


def _left_out(whole: Way, scene: Scene, idle: list[str], tolerance: float) -> tuple[str, ...]:
    """Return what leaves the fewest effects, of as many those that change least."""
    for count in range(len(idle) if len(idle) <= MOST else 0, 0, -1):
        found = {some: _apart(whole, scene, some) for some in combinations(idle, count)}
        within = [some for some in found if found[some] <= tolerance]
        if within:
            return min(within, key=lambda some: (len(scene.without(*some).effects), found[some]))
    out: tuple[str, ...] = ()
    for effect in idle:
        if _apart(whole, scene, (*out, effect)) <= tolerance:
            out = (*out, effect)
    return out


def _apart(whole: Way, scene: Scene, effects: Iterable[str]) -> float:
    """Return how far an answer is off without effects, relative, with its error bars."""
    question = whole.question
    try:
        model = question.placed(scene.without(*effects)).compile(**whole.how)
        change = question.change(whole.answer, model)
    except RopedynError:
        return math.inf
    return change.relative
