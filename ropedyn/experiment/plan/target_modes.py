"""Modes that a measurement should show, and how they move along the rope."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...base import check
from ...base.array import Index, Integer, Real
from ...base.errors import SceneError, SolveError
from ...eigen.modes import Modes
from ...model import Model

GRID = 512  # At least so many places along the rope are looked at.
UNMOVED = 1e-9  # A mode that moves a coordinate by less, over its own, does not move it.
MOST_MODES = 4096  # At most so many modes are solved for, to find enough of them that move.


class TargetModes(NamedTuple):
    """Modes that a measurement should show."""

    mode: Integer  # (k,) their numbers, from 1
    rank: Index  # (k,) their numbers among those that can be seen, from 0
    frequency: Real  # (k,) as in `Plan`
    rounding: Real  # (k,) of the frequencies [Hz]
    damping_ratio: Real  # (k,) as in `Plan`
    separation: Real  # (k,) as in `Plan`
    highest_peak: Real  # (k,) the largest that |phi(x_d) phi(x_r)|/(2 zeta m omega^2) can be
    x: Real  # (places,) [m]
    driven: Real  # (k, places) as in `Plan`
    heard: Real  # (k, places) as in `Plan`


def target_modes(model: Model, asked: Any, coordinates: tuple[str, str]) -> TargetModes:
    """Find modes and the next ones, among those that move both coordinates."""
    numbers, count = _checked(asked)
    found, shapes, seen = _enough(model, numbers, count, coordinates)
    chosen = np.array(numbers) - 1 if numbers else seen[:count]
    if len(chosen) < count:
        raise SolveError(f"modes must be at most {len(seen)}, those that can be seen, got {count}")
    for number in chosen[~np.isin(chosen, seen)].tolist():
        raise SceneError(
            f"modes must be such that {' and '.join(dict.fromkeys(coordinates))} can move at a "
            f"frequency above 0, got mode {number + 1}: {found.family[number]}, "
            f"{found.frequency[number]:.6g} Hz"
        )
    rank = np.searchsorted(seen, chosen)
    f, ratio = found.frequency[chosen], found.damping_ratio[chosen]
    driven, heard = (shape[chosen] for shape in shapes)
    largest = np.array([np.abs(shape).max(axis=1) for shape in (driven, heard)])
    with np.errstate(divide="ignore"):
        peak = largest.prod(axis=0) / (2 * ratio * found.modal_mass[chosen])
    return TargetModes(
        mode=chosen + 1,
        rank=rank,
        frequency=f,
        rounding=found.rounding_bound[chosen],
        damping_ratio=ratio,
        separation=_separation(found.frequency[seen])[rank],
        highest_peak=peak / (2 * np.pi * f) ** 2,
        x=found.x,
        driven=driven / largest[0][:, None],
        heard=heard / largest[1][:, None],
    )


def _checked(asked: Any) -> tuple[list[int], int]:
    """Return numbers of modes, none where so many of the lowest are wanted; and how many."""
    most = MOST_MODES // 2
    if not isinstance(asked, (list, tuple, np.ndarray)):
        return [], check.count(asked, "modes", most=most)
    numbers = [check.count(k, f"modes[{i}]", most=most) for i, k in enumerate(asked)]
    if not numbers or len(set(numbers)) < len(numbers):
        raise SceneError(f"modes must be different whole numbers, got {check.shown(asked)}")
    return sorted(numbers), len(numbers)


def _enough(
    model: Model, numbers: list[int], count: int, coordinates: tuple[str, str]
) -> tuple[Modes, list[Real], Index]:
    """Return modes, how they move both coordinates, and which do: one more than is wanted."""
    size = max([count, *numbers]) + 2
    parts = -(-GRID // (len(model.x) - 1))
    while True:
        found = model.modes(size, points=parts)
        shapes = [found.shape[:, :, found.coordinates.index(c)] for c in coordinates]
        moving = [np.abs(shape).max(axis=1) > UNMOVED for shape in shapes]
        seen = np.flatnonzero(moving[0] & moving[1] & (found.frequency > 0))
        last = int(np.searchsorted(seen, max(numbers) - 1, side="right")) if numbers else count
        if len(seen) > last or size > MOST_MODES:
            return found, shapes, seen
        size *= 2


def _separation(frequency: Real) -> Real:
    """Return the distance of each frequency to its nearest neighbour."""
    gap = np.concatenate([[np.inf], np.diff(frequency), [np.inf]])
    return np.minimum(gap[:-1], gap[1:])
