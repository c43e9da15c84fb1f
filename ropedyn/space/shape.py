"""Where a mode takes the points of an axis in space."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.errors import SceneError
from ..eigen.modes import Modes
from ..scene.scene import Scene
from .compile import axis_of

VIEWS = ("isometric", "front", "top", "side")
PART = 0.1  # Of the axis' extent, by which the farthest point moves.
LEFT = 1e-12  # Of the length: frames of joints are those of the piece on their left.


def extent(points: Real) -> float:
    """Return the diagonal of the box around points (n, 3) [m]."""
    return float(np.linalg.norm(np.ptp(points, axis=0)))


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
        if abs(modes.x[-1] - axis.length) > check.NEAR * axis.length:
            raise SceneError("modes must be of this model, got those of a rope of another length")
        frames = axis.frame(modes.x * (1 - LEFT))
        own = np.zeros((len(modes.x), 3))
        for i, coordinate in enumerate(("x", "y", "z")):
            if coordinate in modes.coordinates:
                own[:, i] = modes.shape[k, :, modes.coordinates.index(coordinate)]
        rest = axis.position(modes.x)
        far = float(np.linalg.norm(own, axis=1).max())
        if scale is None:
            scale = PART * extent(rest) / far if far > 0 else 1.0
        by = check.number(scale, "scale")
        title = f"{k + 1}: {modes.frequency[k]:.4g} Hz, {modes.family[k]}, {by:.3g} times"
        return cls(title, by, rest, rest + by * np.einsum("nij,nj->ni", frames, own))
