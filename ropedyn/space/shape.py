"""Where a mode takes the points of an axis in space."""

from __future__ import annotations

from typing import NamedTuple

from ..base import check
from ..base.array import Real
from ..base.errors import SceneError
from ..eigen.animation import in_space, scale_of
from ..eigen.modes import Modes
from ..scene.scene import Scene
from .compile import axis_of


class ShapeInSpace(NamedTuple):
    """A mode of a rope on an axis."""

    title: str
    scale: float
    rest: Real  # (nodes, 3) [m]
    moved: Real

    @classmethod
    def of(cls, scene: Scene, modes: Modes, k: int, scale: float | None) -> ShapeInSpace:
        """Return mode k, its displacement multiplied by a scale."""
        axis = axis_of(scene)
        if abs(modes.x[-1] - scene.rope.length) > check.NEAR * scene.rope.length:
            raise SceneError("modes must be of this model, got those of a rope of another length")
        rest, moved = in_space(axis, modes.coordinates, modes.x, modes.shape[k])
        by = scale_of(rest, moved, scale)
        title = f"{k + 1}: {modes.frequency[k]:.4g} Hz, {modes.family[k]}, {by:.3g} times"
        return cls(title, by, rest, rest + by * moved)
