"""What is wrong with a record, named; and what of it is put right."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ...base.array import Flags, Index, Real
from ...base.errors import SceneError
from ...base.unit import place

SAME_RATE = 1e-3  # A rate within this relative distance is that of the times.
GAP = 1.5  # Steps between two times from which samples are missing.
EVEN, JITTER = 0.01, 0.25
"""Times off equal steps, in steps: up to the first they are equal, up to the second resampled."""
BRIDGED = 0.05  # Gaps up to so long are bridged [s].
MOST_MISSING = 10  # Gaps are at most so many times as long as what was recorded.
CLIPPED, CLIPPED_SHARE = 4, 0.01
"""So many samples on the exact extreme are clipped; above this share the channel is not used."""
DEAD = 1e-3  # Motion of a dead channel over that of the others of its kind.
SHORT = 0.1  # Pieces shorter than this part of the longest are not used.
DRIFTS = 1.0  # A drift is named from so many times the rest of the motion.
DRIFT_PARTS = 10  # Drift is what the means of so many parts of a record do.


class EqualSteps(NamedTuple):
    """Samples at equal steps."""

    start: float  # [s]
    rate: float  # [Hz]
    at: Index  # (samples,) which of the equal steps each is
    moved: Real | None  # (samples,) how far each is from there, in steps; None where that is little


def grid_of(time: Real, rate: float | None) -> EqualSteps:
    """Return the equal steps that times are at."""
    steps = np.diff(time)
    if (steps <= 0).any():
        k = int(np.argmax(steps <= 0))
        raise SceneError(
            f"time must increase, got time[{k + 1}] = {time[k + 1]:.9g} s after {time[k]:.9g} s"
        )
    usual = float(np.median(steps))
    whole = steps < GAP * usual
    ahead = np.where(whole, 1, np.maximum(np.round(steps / usual), 2)).astype(int)
    at = np.concatenate([[0], np.cumsum(ahead)])
    if at[-1] + 1 > (MOST_MISSING + 1) * len(time):
        k = int(ahead.argmax())
        raise SceneError(
            f"time must be of one record, got {steps[k]:.6g} s between time[{k}] and "
            f"time[{k + 1}]: make a Record of each part"
        )
    step, off = _steps(time, at, whole)
    if rate is not None and abs(step * rate - 1) > SAME_RATE:
        raise SceneError(
            f"rate must be that of time, {1 / step:.6g} Hz, or time left out, got {rate!r}"
        )
    if np.abs(off).max() > JITTER:
        k = int(np.abs(off).argmax())
        raise SceneError(
            f"time must have equal steps, of {step:.6g} s here, to a quarter of a step, got "
            f"time[{k}] = {time[k]:.9g} s, {abs(off[k]):.2g} steps off: resample the values first"
        )
    exact = float(f"{1 / step:.12g}") if rate is None else rate
    return EqualSteps(float(time[0]), exact, at, off if np.abs(off).max() > EVEN else None)


def _steps(time: Real, at: Index, whole: Flags) -> tuple[float, Real]:
    """Return the step that fits all parts best, and how far times are from theirs, in steps."""
    part = np.concatenate([[0], np.cumsum(~whole)])
    samples = np.bincount(part)
    t, k = (x - (np.bincount(part, x) / samples)[part] for x in (time - time[0], at))
    step = float(k @ t / (k @ k))
    return step, t / step - k


def on_grid(grid: EqualSteps, rows: Real) -> tuple[Real, list[str]]:
    """Return rows (rows, t) at equal steps, NaN in gaps that are not bridged, and what was done."""
    from scipy.interpolate import CubicSpline

    total = int(grid.at[-1]) + 1
    value = np.full((len(rows), total), np.nan)
    there = ~np.isnan(rows).any(axis=0)
    at, moved = grid.at[there], None if grid.moved is None else grid.moved[there]
    value[:, at] = rows[:, there]
    notes = []
    spline = CubicSpline(at if moved is None else at + moved, rows[:, there], axis=1)
    if moved is not None:
        value[:, at] = spline(at)
        most = float(np.abs(moved).max())
        notes.append(f"time is up to {most:.2g} steps off equal ones: resampled by cubic splines")
    bridged = [
        (a, b) for a, b in gaps(value) if a > 0 and b < total and (b - a + 1) <= BRIDGED * grid.rate
    ]
    for a, b in bridged:
        value[:, a:b] = spline(np.arange(a, b))
    if bridged:
        samples = sum(b - a for a, b in bridged)
        notes.append(f"{_many(len(bridged), 'gap')} of {_many(samples, 'sample')} bridged")
    return value, notes


def gaps(value: Real) -> list[tuple[int, int]]:
    """Return where values (rows, t) are missing, as starts and stops."""
    return runs(np.isnan(value).any(axis=0))


def runs(flags: Any) -> list[tuple[int, int]]:
    """Return where flags are set, as starts and stops."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist()))


class Channels(NamedTuple):
    """Which channels are good for something."""

    used: tuple[int, ...]
    notes: list[str]


def channels_of(value: Real, response: Sequence[tuple[str, float]]) -> Channels:
    """Return the channels (channels, t) whose motion can be believed, and why others cannot."""
    finite = value[:, ~np.isnan(value).any(axis=0)]
    motion = np.diff(finite, axis=1).std(axis=1)  # which no drift has
    notes, used = [], []
    clipped = [clipped_share(row) for row in finite]
    for k, (point, row) in enumerate(zip(response, finite)):
        name = f"channel {k} ({place(point)})"
        alike = [motion[j] for j, other in enumerate(response) if other[0] == point[0]]
        level = 1e-9 * float(np.abs(row).max())
        if motion[k] <= level or motion[k] < DEAD * max(alike):
            notes.append(f"{name} is dead: not used")
        elif clipped[k] > CLIPPED_SHARE and min(clipped) <= CLIPPED_SHARE:
            notes.append(f"{name} is clipped, {100 * clipped[k]:.2g} % of its samples: not used")
        else:
            used.append(k)
            if clipped[k] > 0:
                count = round(clipped[k] * len(row))
                notes.append(f"{name} is clipped, {_many(count, 'sample')}: used all the same")
            notes += _drifting(name, row)
    return Channels(tuple(used), notes)


def clipped_share(row: Real) -> float:
    """Return the share of samples on the exact extremes, 0 where these are less than four."""
    # a sinusoid may come back to its extreme, but does not stay there
    on = [row == extreme for extreme in (row.min(), row.max())]
    count = [int(flags.sum()) for flags in on if (flags[1:] & flags[:-1]).any()]
    return sum(n for n in count if n >= CLIPPED) / len(row)


def _drifting(name: str, row: Real) -> list[str]:
    if len(row) < 2 * DRIFT_PARTS:
        return []
    parts = row[: len(row) // DRIFT_PARTS * DRIFT_PARTS].reshape(DRIFT_PARTS, -1)
    drift, rest = float(np.ptp(parts.mean(axis=1))), float(parts.std(axis=1).mean())
    if drift <= DRIFTS * rest:
        return []
    return [f"{name} drifts by {drift:.2g}, {drift / rest:.2g} times its motion: taken away"]


def pieces_of(value: Real, rate: float) -> tuple[tuple[tuple[int, int], ...], list[str]]:
    """Return starts and stops of uninterrupted stretches, and what splits them."""
    whole = runs(~np.isnan(value).any(axis=0))
    notes = [
        f"{(start - stop) / rate:.3g} s are missing at {stop / rate:.6g} s after the start: split"
        for (_, stop), (start, _) in pairwise(whole)
    ]
    return tuple(whole), notes


def long_enough(pieces: Sequence[tuple[int, int]]) -> list[tuple[int, int]]:
    """Return the pieces that are no splinters."""
    longest = max(stop - start for start, stop in pieces)
    return [(start, stop) for start, stop in pieces if stop - start >= SHORT * longest]


def _many(count: int, noun: str) -> str:
    return f"{count} {noun}{'s' * (count != 1)}"
