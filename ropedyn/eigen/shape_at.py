"""Shapes of the modes of a model at points of the rope."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..base.array import Real
from ..chain.compile import divided
from ..chain.port import Point, locate, ports
from .eigen import shapes_of
from .modes import Modes


def shapes_at(modes: Modes, points: Sequence[Point]) -> Real:
    """Return the shapes of modes at points of the rope.

    Inside elements of a chain that of the element between its nodes; continuous spans are cut
    there, which changes nothing.
    """
    shapes, number = modes.sensitivity.shapes, len(modes.frequency)
    model = shapes.model
    inside = [at for _, at in points if locate(model.x, at)[1] is not None]
    if model.element == "continuous" and inside:
        x = np.unique(np.concatenate([model.x, inside]))
        model = divided(model.scene, "continuous", x, np.ones(len(x) - 1, dtype=np.intp))
        shapes = shapes_of(model, "sweep", number, np.arange(len(x)))
    shape = shapes.shape[:number]
    shape = shape / np.abs(shape).max(axis=(1, 2), keepdims=True)
    node, row, _ = ports(model.chain, model.x, model.coordinates, points)
    beside = np.stack([shape[:, node], shape[:, node + 1]], axis=2)
    return np.einsum("psc,kpsc->kp", row, beside)
