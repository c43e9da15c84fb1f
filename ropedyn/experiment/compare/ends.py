"""Whether the give of the ends explains the differences of frequencies."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...base.array import Real
from ...scene.end import end_of
from ...scene.rope import own_number
from ...scene.scene import Scene
from .tracked import Tracked

LIMITS = (1e-3, 1e4)
"""Springs, in sqrt(T B), that are free and clamped to what peaks can tell."""
TRIED = (0.03, 0.3, 3.0, 30.0, 300.0)  # Springs where the search begins.


class Give(NamedTuple):
    """Rotational springs at both ends that make calculated frequencies the measured ones."""

    spring: tuple[float, float]  # [N m]
    scale: float  # sqrt(T B) [N m]
    chi2: float  # what is left, in squares of standard uncertainties
    unknowns: int = 2

    def __str__(self) -> str:
        first, last = (self._said(one) for one in self.spring)
        return f"rotational springs at the ends ({first} and {last})"

    def _said(self, spring: float) -> str:
        least, most = (limit * self.scale for limit in LIMITS)
        if spring < 2 * least:
            return "none"
        return "clamped" if spring > most / 2 else f"{spring:.2g} N m"


def fitted_ends(tracked: Tracked, wanted: Real, weight: Real) -> Give | None:
    """Fit both springs by least squares, None where no end can turn or peaks are too few."""
    from scipy.optimize import least_squares

    scene = tracked.model.scene
    if not _may_turn(tracked) or len(wanted) <= len(scene.ends):
        return None
    scale = _scale(scene)
    root = np.sqrt(weight)

    def left(log: Real) -> Real:
        moved = tracked.moved(_turning(scene, scale * np.exp(log)))
        return np.full(len(wanted), np.inf) if moved is None else root * (wanted - moved)

    starts = [np.log([a, b]) for a in TRIED for b in TRIED]
    start = min(starts, key=lambda log: float(np.sum(left(log) ** 2)))
    if not np.isfinite(left(start)).all():
        return None
    found = least_squares(left, start, bounds=tuple(map(math.log, LIMITS)))
    first, last = (scale * np.exp(found.x)).tolist()
    return Give((first, last), scale, 2 * float(found.cost))


def _may_turn(tracked: Tracked) -> bool:
    """Whether the tracked modes bend, and both ends hold the rope."""
    bend = {"z", "beta"} <= {c for component, _, _ in tracked.parts for c in component}
    return bend and all(end_of(end).holds("z") for end in tracked.model.scene.ends)


def _scale(scene: Scene) -> float:
    """Return a stiffness against turning that is neither free nor clamped [N m]."""
    bending = own_number(scene.rope, "bending_stiffness") or 0.0
    tension = max(scene.mean_tension, 0.0)
    return math.sqrt(tension * bending + (bending / scene.rope.length) ** 2)


def _turning(scene: Scene, spring: Real) -> Scene:
    """Return the scene with these rotational springs at its ends [N m]."""
    ends = (end_of(end) for end in scene.ends)
    turned = (
        replace(end, beta="free", spring={**end.spring, "beta": one})
        for end, one in zip(ends, spring.tolist())
    )
    return scene.replace(ends=tuple(turned))
