"""How the arrays of a rope on an axis change with a number of its scene."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.errors import SceneError
from ..scene.path import value_at, with_values
from ..scene.scene import Scene
from .compile import rope_of_scene
from .rope import MATRICES, PLANES, SpaceRope

NODES = 11  # Chebyshev's, between which an array is a polynomial in the number.
RADIUS = 0.05  # Of the number, or of 1 in its unit where it is 0: 1/p is one to 40^-11.
BESIDE = 0.4  # Of the way to the next node, at most, where a place is the number.
STRETCHED = ("bend", "soft", "string", "stress", "inertia")
"""What is per length, so that a longer piece is one of the same length with more of it."""


def slope_of(scene: Scene, rope: SpaceRope, path: str) -> SpaceRope:
    """Return a rope whose arrays are the derivatives of those of another by a number.

    Each entry is a closed form of the number, so that a polynomial through its values at nodes
    about it has its slope to 1e-13. Lengths of pieces are 1, what their change does is in the rest.
    """
    value, ropes = value_at(scene, path), []
    centre, radius = _about(scene, rope, path, value)
    turn = np.cos((2 * np.arange(NODES) + 1) * np.pi / (2 * NODES))
    ropes = [rope_of_scene(with_values(scene, {path: centre + radius * t})) for t in turn]
    if any(one.bend.shape != rope.bend.shape for one in ropes):
        raise SceneError(
            f"path must not change how an axis is divided for polynomials, got {path!r}"
        )
    fitted = np.linalg.inv(np.polynomial.chebyshev.chebvander(turn, NODES - 1))
    slopes = np.polynomial.chebyshev.chebder(np.eye(NODES))
    at = np.polynomial.chebyshev.chebvander((value - centre) / radius, NODES - 2)
    return _mixed(ropes, (at @ slopes @ fitted).ravel() / radius, rope)


def _about(scene: Scene, rope: SpaceRope, path: str, value: float) -> tuple[float, float]:
    """Return the middle of the nodes and how far they reach: all have a meaning."""
    radius = RADIUS * (abs(value) or 1.0)
    if path.endswith(".x"):
        apart, same = np.abs(rope.x - value), check.NEAR * scene.rope.length
        radius = min(radius, BESIDE * float(apart[apart > same].min()))
    for centre in (value, value + radius, value - radius):
        try:
            for sign in (-1, 1):
                with_values(scene, {path: centre + sign * radius})
        except SceneError as error:
            refused = error
            continue
        return centre, radius
    raise refused


def _mixed(ropes: list[SpaceRope], weight: Real, rope: SpaceRope) -> SpaceRope:
    """Return the weighted sum of ropes, lengths as what is per length."""

    def mix(name: str) -> Any:
        # the weights add up to 0
        own = getattr(rope, name)
        return np.tensordot(weight, np.array([getattr(one, name) - own for one in ropes]), 1)

    arrays = {name: mix(name) for name in MATRICES}
    longer = mix("length") / rope.length
    for name in STRETCHED:
        own = getattr(rope, name)
        arrays[name] += longer.reshape(-1, *[1] * (own.ndim - 1)) * own
    carried = tuple(
        own._replace(
            arm=np.tensordot(weight, np.array([each[k].arm for each in _wires(ropes)]), 1),
            rope=_mixed([each[k].rope for each in _wires(ropes)], weight, own.rope),
        )
        for k, own in enumerate(rope.carried)
    )
    return replace(rope, **arrays, carried=carried)


def _wires(ropes: list[SpaceRope]) -> list[Any]:
    return [one.carried for one in ropes]


def stepped(rope: SpaceRope, slope: SpaceRope, step: complex) -> SpaceRope:
    """Return a rope that goes a step along a slope."""
    arrays = {name: getattr(rope, name) + step * getattr(slope, name) for name in MATRICES}
    carried = tuple(
        own._replace(arm=own.arm + step * one.arm, rope=stepped(own.rope, one.rope, step))
        for own, one in zip(rope.carried, slope.carried)
    )
    return replace(rope, **arrays, carried=carried)


def apart(slope: SpaceRope) -> tuple[SpaceRope, bool]:
    """Return a slope without what ties the planes, and whether something does."""
    inside, across = PLANES
    arrays, tied = {name: getattr(slope, name).copy() for name in MATRICES}, False
    for array in arrays.values():
        for tie in (np.ix_(inside, across), np.ix_(across, inside)):
            tied = tied or bool(array[(..., *tie)].any())
            array[(..., *tie)] = 0.0
    return replace(slope, **arrays), tied
