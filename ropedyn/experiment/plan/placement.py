"""Places to drive and to listen, chosen so that the mode that is seen worst is seen best."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ...base.array import Real

TIE = 1e-6  # Weight of the mean over modes beside the least: of equals one that sees more is taken.
STARTS = 24  # The exchange of several sensors begins with so many places of the drive.


class CandidatePlaces(NamedTuple):
    """Places for a drive or for a sensor."""

    x: Real  # (p,) [m]
    share: Real  # (k, p) motion of each mode there over its largest


class Placement(NamedTuple):
    """What was chosen."""

    drive: int
    sensors: tuple[int, ...]
    score: float


def best_placement(
    drive: CandidatePlaces, sensors: Sequence[CandidatePlaces], apart: float
) -> Placement | None:
    """Maximise the least of a_n(x_d) max_s b_n(x_s) over modes n, more sensors one by one."""
    if len(sensors) == 1:
        return _pair(drive, sensors[0], apart)
    many = len(drive.x)
    starts = np.unique(np.linspace(0, many - 1, min(many, STARTS)).astype(int)).tolist()
    first = _pair(drive, sensors[0], apart)
    if first is not None:
        starts.append(first.drive)
    found = [_exchange(drive, sensors, apart, start) for start in starts]
    return max((one for one in found if one is not None), key=lambda one: one.score, default=None)


def _pair(drive: CandidatePlaces, sensor: CandidatePlaces, apart: float) -> Placement | None:
    least = np.full((len(drive.x), len(sensor.x)), np.inf)
    mean = np.zeros_like(least)
    for a, b in zip(drive.share, sensor.share):
        seen = np.multiply.outer(a, b)
        np.minimum(least, seen, out=least)
        mean += seen / len(drive.share)
    score = least + TIE * mean
    score[np.abs(drive.x[:, None] - sensor.x) < apart] = -np.inf
    best = int(score.argmax())
    d, s = divmod(best, len(sensor.x))
    return Placement(d, (s,), float(score[d, s])) if np.isfinite(score[d, s]) else None


def _exchange(
    drive: CandidatePlaces, sensors: Sequence[CandidatePlaces], apart: float, start: int
) -> Placement | None:
    """Add sensors one by one to a drive, then move each place until none gets better."""
    slots = [drive, *sensors]
    at: list[int] = [start]
    score = -np.inf
    for slot in range(1, len(slots)):
        moved = _best(slots, [*at, 0], slot, apart)
        if moved is None:
            return None
        at.append(moved[0])
        score = moved[1]
    moves = True
    while moves:
        moves = False
        for slot in range(len(slots)):
            moved = _best(slots, at, slot, apart)
            if moved is not None and moved[1] > score + 1e-3 * TIE:
                at[slot], score = moved
                moves = True
    return Placement(at[0], tuple(at[1:]), score)


def _best(
    slots: Sequence[CandidatePlaces], at: Sequence[int], slot: int, apart: float
) -> tuple[int, float] | None:
    """Return where one place is best, given the others, and how good that is."""
    others = [k for k in range(len(at)) if k != slot]
    heard = np.zeros(len(slots[0].share))
    for k in others:
        if k > 0:
            heard = np.maximum(heard, slots[k].share[:, at[k]])
    if slot == 0:
        seen = slots[0].share * heard[:, None]
    else:
        driven = slots[0].share[:, at[0]]
        seen = driven[:, None] * np.maximum(slots[slot].share, heard[:, None])
    score = seen.min(axis=0) + TIE * seen.mean(axis=0)
    for k in others:
        score[np.abs(slots[slot].x - slots[k].x[at[k]]) < apart] = -np.inf
    best = int(score.argmax())
    return (best, float(score[best])) if np.isfinite(score[best]) else None
