"""Polylines in space: straight arms between corners that are sharp or rounded."""

from __future__ import annotations

import itertools
from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.errors import SceneError
from .piece import UniformPiece

STRAIGHT = 1e-12  # [rad] Corners of a smaller angle are none.
BACK = np.pi - 1e-6  # [rad] Beyond it an axis runs back along itself.


class Corner(NamedTuple):
    """Where two arms meet."""

    angle: float  # between them [rad]
    inward: Real  # unit vector across the first one, towards the second
    cut: float  # length of each that a fillet takes [m]


def checked_points(xyz: Any) -> Real:
    """Return at least two points in space, shape (n, 3) [m], each apart from the one before."""
    try:
        points = np.array(xyz, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise TypeError(_expected(check.shown(xyz))) from error
    if points.ndim != 2 or points.shape[1] != 3 or len(points) < 2:
        raise SceneError(_expected(f"an array of shape {points.shape}"))
    if not np.isfinite(points).all():
        raise SceneError(_expected(check.shown(xyz)))
    steps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    if steps.min() <= check.NEAR * steps.sum():
        k = int(steps.argmin())
        raise SceneError(f"xyz[{k + 1}] must lie apart from xyz[{k}], got the same point twice")
    return points


def _expected(got: str) -> str:
    return f"xyz must be two or more points of three finite numbers [m], got {got}"


def polyline(points: Real, fillet: float | None) -> list[tuple[UniformPiece, Real, Real]]:
    """Return the pieces with the position and the frame where each begins."""
    steps = np.diff(points, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    along = steps / lengths[:, None]
    corners = [
        _corner(k, one, other, fillet) for k, (one, other) in enumerate(itertools.pairwise(along))
    ]
    cuts = [0.0, *(corner.cut for corner in corners), 0.0]
    pieces, frame = [], _first_frame(along[0], corners)
    for k, direction in enumerate(along):
        frame = _onto(frame, direction)
        rest = lengths[k] - cuts[k] - cuts[k + 1]
        if rest < -check.NEAR * lengths[k]:
            raise SceneError(
                f"fillet must fit between xyz[{k}] and xyz[{k + 1}], which are {lengths[k]:g} m "
                f"apart, got {fillet!r} with rounded corners that take {cuts[k] + cuts[k + 1]:g} m"
            )
        if rest > check.NEAR * lengths[k]:
            begin = points[k] + cuts[k] * direction
            pieces.append((UniformPiece(float(rest)), begin, frame))
        if k < len(corners) and corners[k].angle > 0:
            corner = corners[k]
            frame = _frame(direction, corner.inward)
            if fillet is not None:
                arc = UniformPiece(fillet * corner.angle, 0.0, 1 / fillet)
                pieces.append((arc, points[k + 1] - corner.cut * direction, frame))
    return pieces


def _corner(k: int, one: Real, other: Real, fillet: float | None) -> Corner:
    across = other - (other @ one) * one
    size = float(np.linalg.norm(across))
    angle = float(np.arctan2(size, other @ one))
    if angle > BACK:
        raise SceneError(f"xyz[{k + 1}] must not turn the axis back along itself, got a full turn")
    if angle < STRAIGHT:
        return Corner(0.0, across, 0.0)
    cut = 0.0 if fillet is None else fillet * float(np.tan(angle / 2))
    return Corner(angle, across / size, cut)


def _first_frame(direction: Real, corners: list[Corner]) -> Real:
    """Return the frame of the first arm: z towards the first corner's inside, else up."""
    for corner in corners:
        if corner.angle > 0:
            return _frame(direction, corner.inward)
    up = np.array([0.0, 0.0, 1.0]) if abs(direction[2]) < 0.9 else np.array([1.0, 0.0, 0.0])
    across = up - (up @ direction) * direction
    return _frame(direction, across / np.linalg.norm(across))


def _frame(along: Real, inward: Real) -> Real:
    """Return the frame (3, 3) whose columns are x, y = z cross x and z."""
    return np.stack([along, np.cross(inward, along), inward], axis=1)


def _onto(frame: Real, direction: Real) -> Real:
    """Return the frame turned by the least angle so that x is the direction."""
    axis = np.cross(frame[:, 0], direction)
    cosine = frame[:, 0] @ direction
    W = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    turned: Real = (np.eye(3) + W + W @ W / (1 + cosine)) @ frame
    return turned
