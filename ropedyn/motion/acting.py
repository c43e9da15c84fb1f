"""Laws of points: those of a scene, and those among them that act on what moves."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..base.array import Flags, Real
from ..chain.compiled import Compiled
from ..chain.port import Point, is_held
from ..scene.parts.node import Law
from ..scene.parts.part import standing
from ..scene.scene import Scene

KINDS = ("power", "stop", "call")  # in the order of csrc/law/law.h
SLIPS = 1e-3  # Friction may slip where a force is less by this part of it.
NUMBERS = 4  # of a law at most, RD_LAW_VALUES there


class ActingLaw(NamedTuple):
    """A law, and where it acts."""

    part: int  # number among the parts of the scene; -1: what dashpots resist there
    point: Point
    law: Law

    @property
    def name(self) -> str:
        """As messages name it."""
        return "a dashpot" if self.part < 0 else f"parts[{self.part}]"

    @property
    def is_friction(self) -> bool:
        """Whether it jumps or bends without limit where the velocity changes its sign."""
        return self.law.kind == "power" and self.law.value[1] < 1

    @property
    def is_sharp(self) -> bool:
        """Whether it bends or jumps where contact begins or velocities turn."""
        return self.law.kind == "stop" or self.is_friction


def scene_laws(scene: Scene) -> list[ActingLaw]:
    """Return the laws of all parts."""
    return [
        ActingLaw(i, (law.coordinate, one.x), law)
        for i, part in enumerate(scene.parts)
        for one in standing([part])
        for law in one.term().laws
    ]


def acting_laws(model: Compiled, coordinates: Collection[str] | None = None) -> list[ActingLaw]:
    """Return the laws on some coordinates, or on all, where something moves."""
    place, on = (model.x, model.coordinates), coordinates or model.coordinates
    some = [one for one in scene_laws(model.scene) if one.point[0] in on]
    return [one for one in some if not is_held(model.chain, *place, one.point)]


def held_of(points: Sequence[Point], laws: Sequence[ActingLaw], force: Real) -> Flags:
    """Say which points friction holds that never slips: forces of laws were so large at most."""
    both = [(one, *one.law.value, most) for one, most in zip(laws, force) if one.is_friction]
    held = {one.point for one, size, p, most in both if p == 0 and most < (1 - SLIPS) * size}
    return np.array([point in held for point in points], dtype=np.bool_)


def core_laws(
    acting: Sequence[ActingLaw],
) -> tuple[NDArray[np.int32], Real, tuple[Callable[..., Any] | None, ...]]:
    """Return the kinds and the numbers of laws, and what is called, as the core takes them."""
    laws, value = [one.law for one in acting], np.zeros((len(acting), NUMBERS))
    for row, law in zip(value, laws):
        row[: len(law.value)] = law.value
    kind = np.array([KINDS.index(law.kind) for law in laws], dtype=np.int32)
    return kind, value, tuple(law.call for law in laws)
