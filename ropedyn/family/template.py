"""A scene some of whose numbers differ from row to row."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.errors import SceneError
from ..chain.compile import compile_scene
from ..chain.compiled import Compiled, refuse_nonlinear
from ..scene.agree import refuse_inclined
from ..scene.end import End, end_of
from ..scene.path import value_at, with_values
from ..scene.scene import Scene
from ..space.model import SpaceModel, compile_space

SPRING = re.compile(rf"ends\[([01])\]\.spring\.({'|'.join(check.COORDINATES)})")


class Template(NamedTuple):
    """A scene, and the paths of the numbers that differ."""

    scene: Scene
    paths: tuple[str, ...]
    elements: int | None = None
    element: str | None = None

    def spatial(self, row: Real) -> SpaceModel:
        """Compile the scene of a row on an axis."""
        return compile_space(self.at(row), elements=self.elements, element=self.element)

    def compiled(self, row: Real) -> Compiled:
        """Compile the scene of a row."""
        model = compile_scene(self.at(row), elements=self.elements, element=self.element)
        refuse_nonlinear(model)
        return model

    @property
    def row(self) -> Real:
        """The values of the scene, in the order of the paths."""
        return np.array([self._value(path) for path in self.paths])

    def _value(self, path: str) -> float:
        found = SPRING.fullmatch(path)
        if found is None:
            return value_at(self.scene, path)
        end = end_of(self.scene.ends[int(found[1])])
        return math.inf if end.holds(found[2]) else end.spring.get(found[2], 0.0)

    def at(self, row: Real) -> Scene:
        """Return the scene of a row."""
        plain = {p: float(x) for p, x in zip(self.paths, row) if not SPRING.fullmatch(p)}
        scene = with_values(self.scene, plain)
        for path, stiffness in zip(self.paths, row):
            if found := SPRING.fullmatch(path):
                ends = list(scene.ends)
                at = int(found[1])
                ends[at] = _sprung(end_of(ends[at]), found[2], float(stiffness), path)
                scene = scene.replace(ends=tuple(ends))
        return scene


def template(scene: Scene, paths: Iterable[str]) -> Template:
    """Check that paths lead to numbers of a scene, each once."""
    refuse_inclined(scene, "a family or a fit")
    if isinstance(paths, str):
        raise TypeError(f'paths must be a list such as ["tension"], got {paths!r}')
    named = tuple(_known(scene, path) for path in paths)
    if not named:
        raise SceneError("paths must name at least one number, got none")
    twice = [path for k, path in enumerate(named) if path in named[:k]]
    if twice:
        raise SceneError(f"paths must differ, got {twice[0]!r} twice")
    return Template(scene, named)


def _known(scene: Scene, path: str) -> str:
    """Check that a path leads to a number, and return it by its shortest name."""
    check.instance(path, "path", str, 'a string such as "tension"')
    if found := SPRING.fullmatch(path):
        if found[2] not in scene.coordinates:
            must = f"path {path!r} must be of a coordinate"
            raise check.absent(must, scene.coordinates, found[2])
        return path
    value_at(scene, path)
    return "tension" if path == "tension.mean" else path


def _sprung(end: End, coordinate: str, stiffness: float, path: str) -> End:
    """Return an end with a spring of 0 (free), infinite (held) or other stiffness."""
    if stiffness == -np.inf:
        raise SceneError(f"{path} must be a finite number or inf, got -inf")
    springs = {c: k for c, k in end.spring.items() if c != coordinate}
    if stiffness not in (0, np.inf):
        springs[coordinate] = stiffness
    change: dict[str, Any] = {coordinate: "held" if stiffness == np.inf else "free"}
    return replace(end, spring=springs, **change)
