"""Cells along the rope, in each of which the amplitude of the curvature is one number.

They are small where bending is: before ends, parts and the drive, where it decays over
sqrt(B/T), and grow away from them until they are a part of the bending wave length.
"""

from __future__ import annotations

import numpy as np

from ...base.array import Real
from ...base.errors import SceneError

FIRST = 1 / 3  # Of sqrt(B/T): the cells at a station, before they are halved.
GROWTH = 0.4  # By which part of the distance to the station they are larger.
WAVE = 1.0  # They turn a wave by at most so much [rad].
FEWEST = 8  # Over the rope.
MOST = 600
LOOKS = 20_000  # At their size, along the rope.


def edges(stations: Real, bending: float, tension: float, wave: float) -> Real:
    """Return where cells end, (2 n + 1,); every second one is that of n cells alone."""
    length = float(stations[-1])
    decay = min(np.sqrt(bending / tension), length) if tension > 0 else length
    widest = min(length / FEWEST, WAVE / wave if wave > 0 else np.inf)
    x = np.linspace(0.0, length, LOOKS + 1)
    away = np.abs(x[:, None] - stations).min(axis=1)
    size = np.minimum(widest, FIRST * decay + GROWTH * away)
    passed = np.append(0.0, np.cumsum((1 / size[1:] + 1 / size[:-1]) * np.diff(x) / 2))
    found = [stations[:1]]
    at = np.interp(stations, x, passed)
    for begin, end, low, high in zip(stations, stations[1:], at, at[1:]):
        n = 2 * max(int(np.ceil(high - low)), 1)
        inside = np.interp(np.linspace(low, high, n + 1)[1:-1], passed, x)
        found += [np.clip(inside, begin, end), np.array([end])]
    cells = np.concatenate(found)
    if len(cells) > MOST + 1:
        raise SceneError(
            f"frequency must be so low, and the rope so short, that {MOST} cells tell where wires "
            f"slip, got {len(cells) - 1} of them"
        )
    return cells


def wave_number(bending: float, tension: float, density: float, omega: float) -> float:
    """Return k of B k^4 + T k^2 = mu omega^2, without rotary inertia [1/m]."""
    load, pull = density * omega**2, max(tension, 0.0)
    return float(np.sqrt(2 * load / (pull + np.sqrt(pull**2 + 4 * bending * load))))
