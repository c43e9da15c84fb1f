"""What a motion over time tells of the responses per force, and what it cannot know of them."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any

import numpy as np

from ..base import check
from ..base.array import Complex, Real
from ..base.errors import SceneError
from ..scene.force import Force, Samples
from ..signal.estimate import Estimate, estimate, estimate_known
from ..signal.spectrum import time_step
from .force_spectrum import transform

TAIL = 20  # The last of so many parts of a record says whether the motion has decayed.
WITHIN = (0.1, 0.3, 0.5, 0.7, 0.9)  # So far between two breaks a force is looked at.
SEEN = 2  # Samples show a blow that lasts for so many steps, and how they fold it.
LEFT = 1e-6  # Less of the largest value counts as nothing.

EXACT = "force: its exact transform, of what it does between the times too"
STRAIGHT = "force: straight lines between its samples, up to the width of the window"
WEIGHTED = (
    "force: its samples, which the window weights; what it does between them is not known: one "
    'segment with window="boxcar" takes its exact transform'
)
UNKNOWN = "force: its samples; what it does between them is not known"


def estimated(
    time: Real,
    value: Real,
    force: Real,
    law: Sequence[Force],
    *,
    drive: int,
    segments: int,
    window: str | None,
    band: Any,
    order: int,
    error: Real,
) -> tuple[Estimate, tuple[str, ...]]:
    """Return responses per force, as `History.frf` asks for them, and notes on them."""
    at_rest = order == 0
    sampled = partial(estimate, time, value, force, drive=drive, segments=segments)
    sampled = partial(sampled, window=window, band=band, at_rest=at_rest)
    held = order > 0 and bool(law) and _is_held(time, force)
    ends = _at_the_end(time, value, force, held)
    if not law:
        return sampled(), (UNKNOWN, *ends)
    own = _alone(law, drive, time)
    if check.count(segments, "segments", most=len(time)) == 1 and window in (None, "boxcar"):
        push = partial(_transformed, own, begin=float(time[0]), end=float(time[-1]), held=held)
        how = {"error": error, "falls": 1 - order, "band": band, "at_rest": at_rest}
        found, folded, missed = estimate_known(time, value, push, **how)
        return found, (EXACT, *_folds(time, folded), *_misses(missed), *ends)
    found = sampled()
    if not isinstance(own, Samples):
        return found, (WEIGHTED, *ends)
    hat = np.sinc(found.frequency * time_step(time)) ** 2
    return found._replace(value=found.value / hat), (STRAIGHT, *ends)


def _is_held(time: Real, force: Real) -> bool:
    """Whether some force is there at the end, and all are the same in the last part of a record."""
    last = force[:, -max(1, len(time) // TAIL) :]
    changes, largest = np.ptp(last, axis=1), np.abs(force).max(axis=1)
    return bool((changes <= LEFT * largest).all() and (np.abs(last[:, -1]) > LEFT * largest).any())


def _transformed(force: Force, omega: Real, begin: float, end: float, held: bool) -> Complex:
    """Transform a force from begin on; what is held at the end is so for ever, but at 0 Hz."""
    total = transform(force, omega, begin, end)
    if held:
        last = force.value(np.array([end])) * np.exp(-1j * omega * end)
        total += np.divide(last, 1j * omega, out=np.zeros_like(total), where=omega != 0)
    return total


def _alone(law: Sequence[Force], drive: int, time: Real) -> Force:
    """Return the force that alone drives within the times, between them too."""
    check.count(drive, "drive", least=0, most=len(law) - 1)
    omega = np.asarray(2 * np.pi * np.fft.rfftfreq(len(time), time_step(time)), dtype=np.float64)
    for k, other in enumerate(law):
        if k != drive and transform(other, omega, float(time[0]), float(time[-1])).any():
            raise SceneError(f"force must be 0 at other drives than {drive}, got some at {k}")
    return law[drive]


def _folds(time: Real, folded: float) -> tuple[str, ...]:
    """Say how much motion above half the rate of the times may be in the lines."""
    if folded < LEFT:
        return ()
    half = (len(time) - 1) / (2 * float(time[-1] - time[0]))
    return (
        f"motion: faster than half the rate of the times, {half:g} Hz, it folds into the lines: by "
        f"up to about {folded:.2g} of the largest",
    )


def _misses(missed: float) -> tuple[str, ...]:
    """Say how much the error of the motion may make of a line."""
    if missed < LEFT:
        return ()
    return (f"motion: known to its error, up to {missed:.2g} of the largest in a line",)


def is_struck_between(force: Force, time: Real) -> bool:
    """Whether a blow lasts for less than `SEEN` steps, within the times."""
    if any(time[0] <= at <= time[-1] for at, _ in force.blows):
        return True
    first, last = float(time[0]), float(time[-1])
    at = np.unique([first, *(one for one in force.breaks if first <= one <= last), last])
    short = np.diff(at) < SEEN * time_step(time)
    begin, end = at[:-1][short], at[1:][short]
    beside = np.searchsorted(time, begin, side="right") - 1, np.searchsorted(time, end)
    ends = np.stack([force.value(time[one]) for one in beside])
    inside = force.value(begin + np.multiply.outer(WITHIN, end - begin))
    over = np.maximum(inside - ends.max(axis=0), ends.min(axis=0) - inside)
    return bool((over > LEFT * np.abs(inside)).any())


def _at_the_end(time: Real, value: Real, force: Real, held: bool) -> tuple[str, ...]:
    """Say what of motion and force is cut off at the end of the record, or held from there on."""
    notes = []
    tail = slice(-max(1, len(time) // TAIL), None)
    for name, each in ("motion", value), ("force", force):
        if each.size == 0 or not each.any():
            continue
        largest = np.abs(each).max(axis=1)
        left = np.abs(each[:, tail]).max(axis=1) / np.where(largest > 0, largest, 1.0)
        if left.max() > LEFT:
            how = "held after the end" if held and each is force else "cut off at the end"
            notes.append(f"{name}: {how}, with {left.max():.2g} of its largest value")
    return tuple(notes)
