"""What the peaks say where both ends are pinned, or both clamped."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.array import Real
from .ridge import Cloud, Ridge
from .space import Fixed, space_of
from .task import PosteriorTask

DRAWN, STARTS = 64, 12  # Points that are drawn, and those of them that steps begin from.
STEPS = 12


class Limit(NamedTuple):
    """The likeliest rope with given ends."""

    ridge: Ridge
    cloud: Cloud  # one point


def best_with(task: PosteriorTask, ends: Fixed, rng: np.random.Generator) -> Limit | None:
    """Return the likeliest point with both loose ends pinned or clamped, None without a rope."""
    ridge = Ridge.of(task, space_of(task, ends))
    space = ridge.space
    u, tied = space.draw(rng, DRAWN if space.size else 1, ridge.freedom)
    cloud = ridge.cloud(u, tied, np.full(len(u), np.log(space.tension)))
    order = np.argsort(-_height(cloud), kind="stable")[:STARTS]
    cloud = cloud.take(order)
    cloud = cloud.take(np.isfinite(_height(cloud)))
    if not len(cloud):
        return None
    damping = np.ones(len(cloud))
    for _ in range(STEPS if space.size else 0):
        there = ridge.cloud(cloud.u + _step(ridge, cloud, damping), cloud.tied, cloud.log_tension)
        better = _height(there) > _height(cloud)
        cloud.put(better, there.take(better))
        damping = np.where(better, damping / 10, damping * 10)
    return Limit(ridge, cloud.take(np.array([int(np.argmax(_height(cloud)))])))


def _height(cloud: Cloud) -> Real:
    return cloud.base + cloud.likelihood


def _step(ridge: Ridge, cloud: Cloud, damping: Real) -> Real:
    """Return Levenberg's steps, shape (n, d)."""
    space = ridge.space
    at, known = space.believed, np.zeros((space.size, space.size))
    known[at, at] = space.belief.precision
    downhill = -np.einsum("nmd,nm->nd", cloud.slope, cloud.residual)
    downhill[:, at] -= (cloud.u[:, at] - space.belief.mean) @ space.belief.precision
    square = cloud.slope.swapaxes(1, 2) @ cloud.slope + known
    square += damping[:, None, None] * (np.eye(space.size) + square * np.eye(space.size))
    step = np.linalg.solve(square, downhill[:, :, None])[:, :, 0]
    low, high = np.maximum(space.low, -1e300), np.minimum(space.high, 1e300)
    return np.clip(cloud.u + np.clip(step, -5, 5), low, high) - cloud.u
