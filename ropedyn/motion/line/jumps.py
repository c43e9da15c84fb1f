"""Where forces jump and bend, and how far that moves modes beyond the rates."""

from __future__ import annotations

import numpy as np

from ...base.array import Real
from ...scene.force import Force, is_sampled

TIMES = 2.0  # Corners ring a mode at most so many times as they do at random.


def jumps(force: Force, time: Real) -> Real:
    """Return when a force jumps, by how much its rate, itself and its impulse, (n, 4)."""
    begin, end = float(time[0]), float(time[-1])
    at = np.array([begin, *(when for when in force.breaks if begin < when <= end)])
    before = np.nextafter(at, -np.inf)
    found = [at, *(one(at) - one(before) * (at > begin) for one in (force.rate, force.value))]
    blows = [(when, 0.0, 0.0, size) for when, size in force.blows if begin <= when <= end]
    return np.concatenate([np.stack([*found, 0 * at], axis=1), np.reshape(blows, (-1, 4))])


def largest(force: Force, time: Real) -> tuple[float, float]:
    """Return the largest jump of a force within times, and its largest blow at an instant."""
    *_, jump, blow = np.abs(jumps(force, time)).max(axis=0)
    return float(jump), float(blow)


def excited(force: Force, time: Real, omega: Real) -> Real:
    """Bound how far a force moves modes of rates (n,) over r/omega^2, and derivatives, (3, n)."""
    _, corners, steps, blows = np.abs(jumps(force, time)).T
    if is_sampled(force):
        corners = np.append(corners, np.diff(force.rate(time)))
    bends = TIMES * np.sqrt((corners**2).sum())
    most = steps.max() + omega * blows.max() + bends / omega
    return np.stack([most, most * omega, most * omega**2])
