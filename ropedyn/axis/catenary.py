"""A catenary between two points, with weights on it: pieces that meet at kinks."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.errors import SceneError
from .piece import CatenaryPiece

LEFT = 1e-13  # Of the chord: what is left of it where the pieces are found.

Loads = tuple[tuple[float, float], ...]


def checked_loads(loads: Any) -> Loads:
    """Return (share of the arc length, weight over weight per length) in order, one a place."""
    if not isinstance(loads, Iterable):
        raise TypeError(f"loads must be pairs of a place and a length, got {check.shown(loads)}")
    found: dict[float, float] = {}
    for k, pair in enumerate(loads):
        numbers = check.numbers(pair, f"loads[{k}]")
        if len(numbers) != 2 or not (0 < numbers[0] < 1 and numbers[1] >= 0):
            raise SceneError(
                f"loads[{k}] must be a place between 0 and 1 and a length >= 0 [m], got "
                f"{check.shown(pair)}"
            )
        place, load = map(float, numbers)
        found[place] = found.get(place, 0.0) + load
    return tuple(sorted((place, load) for place, load in found.items() if load > 0))


def catenaries(span: float, rise: float, c: float, loads: Loads) -> list[CatenaryPiece]:
    """Return the pieces between weights of what has the parameter c.

    Each is a catenary of that parameter; behind a weight of so many metres of the rope the next
    one begins so much further behind its lowest point.
    """
    # cosh(a + b) - cosh(a - b) = 2 sinh a sinh b
    middle = c * math.asinh(rise / c / (2 * math.sinh(span / (2 * c))))
    first, last = (c * math.sinh((middle + side * span / 2) / c) for side in (-1, 1))
    if not loads:
        return [CatenaryPiece(last - first, c, first)]
    from scipy.optimize import root

    place, load = np.array(loads).T
    cut = np.array([0.0, *place, 1.0])
    below = np.array([0.0, *np.cumsum(load)])
    chord = math.hypot(span, rise)

    def ends(unknown: Real) -> tuple[Real, Real]:
        length, begin = unknown
        return begin + below + length * cut[:-1], begin + below + length * cut[1:]

    def missed(unknown: Real) -> tuple[Real, Real]:
        begin, end = ends(unknown)
        far, near = np.hypot(c, end), np.hypot(c, begin)
        level = c * (np.arcsinh(end / c) - np.arcsinh(begin / c))
        slope = np.stack([c * cut[1:] / far - c * cut[:-1] / near, c / far - c / near])
        climb = np.stack([end * cut[1:] / far - begin * cut[:-1] / near, end / far - begin / near])
        left = np.array([level.sum() - span, (far - near).sum() - rise])
        return left / chord, np.stack([slope.sum(axis=1), climb.sum(axis=1)]) / chord

    guess = np.array([last - first, first - load @ (1 - place)])
    found = root(missed, guess, jac=True, tol=1e-15)
    if not np.abs(found.fun).max() <= LEFT:
        raise SceneError(
            f"loads must let a rope of the parameter {c:g} m hang between its ends, whose pieces "
            f"were not found, got {check.shown(loads)}"
        )
    begin, end = ends(found.x)
    return [CatenaryPiece(float(b - a), c, float(a)) for a, b in zip(begin, end)]


def placed(
    pieces: list[CatenaryPiece],
) -> list[tuple[CatenaryPiece, Real, Real]]:
    """Return them with the position and the frame where each begins."""
    c, found, position = pieces[0].parameter, [], np.zeros(3)
    for piece in pieces:
        u = piece.begin
        frame = np.array([[c, 0, -u], [0, math.hypot(c, u), 0], [u, 0, c]])
        turned = frame * math.cos(math.atan2(u, c)) / c
        found.append((piece, position, turned))
        place, _ = piece.travel(np.array([piece.length]))
        position = position + turned @ place[0]
    return found


def upward(pieces: list[CatenaryPiece], share: float) -> float:
    """Return the upward part of the tension over weight per length at a share of the arc [m]."""
    left = share * math.fsum(piece.length for piece in pieces)
    for piece in pieces[:-1]:
        if left < piece.length:
            return piece.begin + left
        left -= piece.length
    return pieces[-1].begin + left


def jumps(pieces: Iterable[Any]) -> list[float]:
    """Return the weights over weight per length that balance the kinks between pieces [m]."""
    return [float(b.begin - a.end) for a, b in itertools.pairwise(pieces)]
