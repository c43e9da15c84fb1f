"""The first time at which one of several functions falls below zero, and none before it.

Between two looks at h and h' a distance w apart, with |h''| <= M,

    h >= min(h_a, h_a + h_a' w/2 - M w^2/8, h_b, h_b - h_b' w/2 - M w^2/8).

Where that is not above zero Taylor's polynomials may tell: what no wave has reached moves as a high
power of time, below rounding. Else the interval is divided, so that nothing is overlooked however
short it is, but for what rounding hides.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...base.array import Real
from ...base.errors import SolveError
from .course import Course

LOOKS, PARTS = 64, 8  # So many intervals are looked at together, and one is divided into so many.
ROUNDING = 64 * np.finfo(float).eps  # Of the sum of the terms' magnitudes.
BEGUN = 1e-10  # Of the same: an event is rounded to so much, at most.
DEEPEST = 24  # Divisions after which only rounding is left.
ORDER = 10  # Of Taylor's polynomials.
STEPS = 60  # Of a root, at most.


class Crossing(NamedTuple):
    """Where a function falls below zero."""

    time: float
    which: int


class _Guards(NamedTuple):
    value: Course
    slope: Course
    bend: Course
    floor: Real  # (guards,) what rounding cannot tell from 0


@np.errstate(over="ignore", invalid="ignore")
def first_crossing(guards: Course, scale: Real, end: float) -> Crossing | None:
    """Return the first time before the end at which a guard falls below zero, from 0 on.

    `scale` is the size of the numbers that the guards are differences of.
    """
    if not len(guards.c):
        return None
    slope, start = guards.derivative(), guards.at(np.zeros(1))[:, 0]
    bend = slope.derivative()
    scale = np.maximum(scale, guards.size(0.0, 0.0))
    if not np.isfinite([start, scale, bend.size(0.0, 0.0)]).all():
        raise SolveError("the numbers overflow: check the units and the times")
    # what begins a little below zero was zero before rounding, and its slope may have been too
    begun = (start < 0) & (-start < BEGUN * scale)
    floor = np.maximum(ROUNDING * scale, np.where(begun, -2 * start, 0.0))
    g = _Guards(guards, slope, bend, floor)
    if (start < -floor).any():
        return Crossing(0.0, int(np.argmin(start + floor)))
    first = 0.0
    while first < end:
        last, looks = _reach(g, first, end)
        found = _within(g, first, last, looks, 0)
        if found is not None:
            return found
        first = last
    return None


def _reach(g: _Guards, first: float, end: float) -> tuple[float, int]:
    """Return up to where looks tell the most, and how many it takes."""
    size, bend = g.value.size(first, first), g.bend.size(first, first)
    share = np.divide(size, bend, out=np.full(len(size), np.inf), where=bend > 0)
    width = float(np.sqrt(0.2 * share.min(initial=np.inf)))
    if not first + width > first:
        width = (end - first) / LOOKS
    if first + LOOKS * width < end:
        return first + LOOKS * width, LOOKS
    return end, max(1, math.ceil((end - first) / width)) if width < math.inf else 1


def _within(g: _Guards, first: float, last: float, parts: int, depth: int) -> Crossing | None:
    """Look at parts of an interval, in order."""
    time = np.linspace(first, last, parts + 1)
    power = g.value.powers(time)
    h, v = g.value.on(power, time), g.slope.on(power, time)
    width = (last - first) / parts
    bend = g.bend.size(first, last)
    safe = (_above(h, v, width, bend[:, None]) >= -g.floor[:, None]).all(axis=0)
    for k in np.flatnonzero(~safe):
        lo, hi = float(time[k]), float(time[k + 1])
        falls = v[:, k : k + 2].max(axis=1) < -bend * width / 2  # throughout
        below = h[:, k + 1] < -g.floor
        if depth >= DEEPEST or not lo < (lo + hi) / 2 < hi:
            if below.any():
                return Crossing(hi, int(np.argmin(h[:, k + 1] + g.floor)))
            continue
        if not below.any() and _stays(g, lo, width):
            continue
        certain = _above(h[:, k : k + 2], v[:, k : k + 2], width, bend[:, None])[:, 0] >= -g.floor
        unclear = ~falls & ~certain
        if not unclear.any() and below.any():
            roots = [Crossing(_root(g, int(i), lo, hi), int(i)) for i in np.flatnonzero(below)]
            return min(roots)
        found = _within(g, lo, hi, PARTS, depth + 1)
        if found is not None:
            return found
    return None


def _stays(g: _Guards, first: float, width: float) -> bool:
    """Say whether Taylor's polynomials and what they leave out are above zero in an interval."""
    course, when = g.value, np.array([first])
    power, least, share = course.powers(when), np.zeros(len(g.floor)), 1.0
    for order in range(ORDER):
        value = course.on(power, when)[:, 0]
        least = least + share * (np.minimum(value, 0.0) if order else value)
        course, share = course.derivative(), share * width / (order + 1)
    return bool((least - share * course.size(first, first + width) >= -g.floor).all())


def _above(h: Real, v: Real, width: float, bend: Real) -> Real:
    """Return what guards are at least between looks, shape (guards, looks - 1)."""
    sag = bend * width**2 / 8
    left = np.minimum(h, h + v * width / 2 - sag)[:, :-1]
    return np.minimum(left, np.minimum(h, h - v * width / 2 - sag)[:, 1:])


def _root(g: _Guards, which: int, lo: float, hi: float) -> float:
    """Return where a guard that falls throughout is zero, by Newton's method between bounds."""
    h, v = (one.some(slice(which, which + 1)) for one in (g.value, g.slope))
    at = (lo + hi) / 2
    for _ in range(STEPS):
        when = np.array([at])
        power = h.powers(when)
        value = float(h.on(power, when)[0, 0])
        if value > 0:
            lo = at
        else:
            hi = at
        step = value / float(v.on(power, when)[0, 0])
        new = at - step if lo < at - step < hi else (lo + hi) / 2
        if abs(new - at) <= 2 * np.spacing(max(abs(at), hi - lo)) or new in (lo, hi):
            return new
        at = new
    return at
