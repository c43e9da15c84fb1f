"""The lowest modes of a rope in space: bracketed by counts, then refined."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from collections.abc import Iterable
from functools import lru_cache
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..base.array import Index, Real
from ..base.errors import SolveError
from .assembly import ROUNDINGS, SAFE, Assembly, assemble, foot_of
from .rope import SPRINGS, SpaceRope, unforced

STEP = 2.0**-200  # Of derivatives by a complex step.
TOGETHER = 1e-8  # Modes that are closer, relative, are found together.
ALONE = 0.2  # So narrow, relative, is the bracket of a single mode that is sought.
ROUNDS = 200  # Of counts.
ITERATIONS = 12
RIGID = 1e-14  # Less, in units of bending over the whole length, is none.
NARROW = 1e-13  # Brackets that nothing is found in are an answer themselves.
BESIDE = 3e-8  # Iteration is at so much from a mode, where solving still tells others from it.
SETTLED = 2.0  # Shifts of so many times that are the last.
LADDER = 8.0  # Between the first values that are counted at.
BOTTOM = 1e16  # What grows this much faster than others move leaves them no digit.
AT_ONCE = 32  # Groups that are sought together.
MORE = 3  # Vectors beside those of the modes that are sought.


class Lowest(NamedTuple):
    """Eigenvalues [rad^2/s^2], bounds of what rounding does, whose they are, and counts taken."""

    eigenvalue: Real
    error: Real
    component: Index
    counts: int


class Bracket(NamedTuple):
    """Values of which counts of a component are known, and the modes between them."""

    component: int
    low: float
    high: float
    first: int
    last: int

    @property
    def size(self) -> int:
        """How many there are."""
        return self.last - self.first

    @property
    def middle(self) -> float:
        """Of the bracket."""
        return (self.low + self.high) / 2

    def is_narrow(self, unit: float) -> bool:
        """Whether the bracket is an answer itself."""
        return self.high - self.low <= NARROW * max(abs(self.low), abs(self.high), unit)

    def has(self, value: Real, error: Real) -> bool:
        """Whether values lie in it."""
        inside = (value >= self.low - 4 * error) & (value <= self.high + 4 * error)
        return bool(inside.all() and np.isfinite(value).all())


class Counter:
    """Counts of each component that are known, by increasing eigenvalue."""

    def __init__(self, rope: SpaceRope) -> None:
        self.rope = rope
        self.components = range(len(rope.own))
        self.values: list[list[float]] = [[] for _ in self.components]
        self.counts: list[list[int]] = [[] for _ in self.components]
        self.asked = 0

    def ask(self, asked: set[tuple[int, float]]) -> None:
        """Count components below values, all at once."""
        new = sorted((k, v) for k, v in asked if v not in self.values[k])
        for nudge in range(8):
            if not new:
                return
            which = np.array([k for k, _ in new])
            value = np.array([v for _, v in new])
            # joints at a resonance of a part are none a little aside
            counts = counts_at(self.rope, which, value * (1 + nudge * 2.0**-48))
            self.asked += len(new)
            for (k, v), count in zip(new, counts.tolist()):
                if not math.isnan(count):
                    at = bisect_left(self.values[k], v)
                    self.values[k].insert(at, v)
                    self.counts[k].insert(at, int(count))
            new = [one for one, count in zip(new, counts) if math.isnan(count)]
        raise SolveError("parts of the rope resonate too close to each other to be counted")

    def each(self, values: list[float]) -> list[list[int]]:
        """Count every component below each of several values."""
        self.ask({(k, v) for k in self.components for v in values})
        return [
            [self.counts[k][bisect_left(self.values[k], v)] for k in self.components]
            for v in values
        ]

    def total(self, values: list[float]) -> list[int]:
        """Count all below each of several values."""
        return [sum(counts) for counts in self.each(values)]

    def bracket(self, component: int, i: int) -> Bracket:
        """Return the closest values with count <= i and > i, and the counts."""
        values, counts = self.values[component], self.counts[component]
        at = bisect_right(counts, i)
        if any(a > b for a, b in pairwise(counts[max(at - 2, 0) : at + 2])):
            raise SolveError("counts contradict each other: rounding decides where modes are")
        return Bracket(component, values[at - 1], values[at], counts[at - 1], counts[at])


def counts_at(rope: SpaceRope, which: Index, values: Real) -> Real:
    """Count the eigenvalues of components below values, NaN where a part resonates there.

    Those of wires held at their feet, and those of a rope whose nodes have the stiffness of feet.
    """
    arrays, z = rope.core(which, values)
    own = which.astype(np.int32)
    if not rope.carried:
        return np.asarray(_core.space_count(arrays, own, values, z))
    springs, found = np.tile(rope.springs, (len(values), 1, 1, 1)), np.zeros(len(values))
    for one in rope.carried:
        springs[:, one.node] += foot_of(one, unforced(values)).stiffness.real
        found += counts_at(one.rope, which, values)
    for k in range(len(values)):
        line = slice(k, k + 1)
        stiff = (*arrays[:SPRINGS], springs[line], *arrays[SPRINGS + 1 :])
        found[k] += _core.space_count(stiff, own[line], values[line], z[line])[0]
    return found


def count_below(rope: SpaceRope, eigenvalue: float) -> int:
    """Return how many eigenvalues lie below one."""
    return Counter(rope).total([eigenvalue])[0]


def growing(rope: SpaceRope) -> Real:
    """Return the eigenvalues that are negative beyond what rounding does: as many critical loads.

    Of a free rope counts below 0 have rigid motions too, in which nothing is strained.
    """
    count = count_below(rope, 0.0)
    if not count:
        return np.zeros(0)
    found = lowest(rope, count, math.inf)
    return found.eigenvalue[found.eigenvalue < -found.error]


def lowest(rope: SpaceRope, wanted: int | None, below: float) -> Lowest:
    """Return the lowest eigenvalues, so many or all below one: of each component its own share."""
    counter, unit = Counter(rope), rope.unit
    wanted = _surround(counter, unit, wanted, below)
    modes = _isolate(counter, wanted, unit)
    found: dict[tuple[int, int], tuple[float, float]] = {}
    while left := [one for one in modes if one not in found]:
        groups = sorted({counter.bracket(*one) for one in left})
        wide = []
        for group, settled in zip(groups, refined(rope, groups, unit)):
            if settled is None and not group.is_narrow(unit):
                wide.append(group)
                continue
            whole = settled or [
                np.full(group.size, one) for one in (group.middle, group.high - group.low)
            ]
            for i, (value, error) in enumerate(zip(*whole)):
                found[group.component, group.first + i] = value, error
        _divide(counter, wide, unit)
        if rope.carried:
            _narrow(counter, [(one.component, one.first) for one in wide], unit)
    ordered = sorted(modes, key=found.__getitem__)[:wanted]
    value, error = np.array([found[one] for one in ordered]).reshape(-1, 2).T
    which = np.array([k for k, _ in ordered], dtype=np.intp)
    return Lowest(value, error, which, counter.asked)


def _narrow(counter: Counter, modes: list[tuple[int, int]], unit: float) -> None:
    """Divide brackets until each is an answer: beside a pole of a foot no iteration is one."""
    while wide := {
        one for one in (counter.bracket(*mode) for mode in modes) if not one.is_narrow(unit)
    }:
        _divide(counter, wide, unit)


def _surround(counter: Counter, unit: float, wanted: int | None, below: float) -> int:
    """Count below all and above those that are wanted; return how many these are."""
    low, ladder = -unit * 1e-3, [below]
    if not math.isfinite(below):
        assert wanted is not None
        # about where a straight rope has so many in two planes
        rope = counter.rope
        guess = rope.at_wave(math.pi * (wanted + 1) / (2 * rope.length.sum()))
        ladder = [guess * LADDER**k for k in range(-3, 3)]
    counter.total([low, *ladder])
    while counter.total([low])[0] > 0:
        low *= 64
        if low < -BOTTOM * unit:
            raise SolveError("the stiffness has no lower bound: what is loaded has no mass")
    high = ladder[-1]
    if wanted is None or math.isfinite(below):
        there = counter.total([high])[0]
        return there if wanted is None else min(wanted, there)
    while counter.total([high])[0] < wanted:
        high *= LADDER**2
        counter.total([high / LADDER, high])
        if high > 1e150 * unit:
            raise SolveError(f"fewer than {wanted} modes are finite")
    return wanted


def _edge(counter: Counter, wanted: int) -> tuple[float, float]:
    """Return the closest values at which all are counted, fewer and not fewer than are wanted."""
    known = sorted(set(counter.values[0]).intersection(*counter.values[1:]))
    totals = counter.total(known)
    above = next(i for i, total in enumerate(totals) if total >= wanted)
    return known[max(above - 1, 0)], known[above]


def _isolate(counter: Counter, wanted: int, unit: float) -> list[tuple[int, int]]:
    """Divide brackets until each has a single mode or modes that are found together; return these.

    They are those that are wanted, and more where some are nearly equal.
    """
    for _ in range(ROUNDS):
        low, high = _edge(counter, wanted)
        (share,) = counter.each([high])
        modes = [(k, i) for k in counter.components for i in range(share[k])]
        brackets = {counter.bracket(*one) for one in modes}
        near = {one: ALONE if one.size == 1 else TOGETHER for one in brackets}
        wide = {one for one in brackets if not _are_close(one.low, one.high, near[one], unit)}
        more = len(modes) > wanted and not _are_close(low, high, TOGETHER, unit)
        if not wide and not more:
            return modes
        _divide(counter, wide, unit, _between(low, high, unit) if more else [])
    raise SolveError("modes lie closer together than counts tell apart")


def _are_close(low: float, high: float, near: float, unit: float) -> bool:
    return high - low <= max(near * max(abs(low), abs(high)), 1e-6 * unit)


def _divide(
    counter: Counter, brackets: Iterable[Bracket], unit: float, more: Iterable[float] = ()
) -> None:
    """Count at three places in the bracket of each, which costs as much as at one; all at more."""
    asked = {(k, value) for k in counter.components for value in more}
    for component, low, high, _, _ in brackets:
        asked |= {(component, value) for value in _between(low, high, unit)}
    counter.ask(asked)


def _between(low: float, high: float, unit: float) -> list[float]:
    """Return three places that divide a bracket, or those that rounding leaves."""
    middle = _middle(low, high, unit)
    places = {_middle(low, middle, unit), middle, _middle(middle, high, unit)}
    return sorted(places - {low, high})


def _middle(low: float, high: float, unit: float) -> float:
    """Return the middle by what counts far from 0, by a geometric mean."""
    small = 1e-4 * unit
    if low >= small and high > 4 * low:
        return math.sqrt(low * high)
    if low < small < high / 4:
        return math.sqrt(small * high)
    return (low + high) / 2


class Pursuit:
    """Inverse iteration for the modes of a bracket, in the space of a few vectors."""

    def __init__(self, bracket: Bracket, bends: bool = False) -> None:
        self.bracket, self.at = bracket, bracket.middle
        self.value = [math.inf] * bracket.size
        self.shift = math.inf
        self.settled = False
        self.bends = bends  # whether poles of feet bend what is linear about a shift elsewhere
        self.vectors: Any = None
        self.error: Any = None

    def take(self, nearby: Nearby, unit: float) -> bool:
        """Go on from what was found at `at`; True where nothing is to come."""
        shifts = nearby.shift.tolist()
        value, shift = [self.at + one for one in shifts], max(map(abs, shifts))
        change = max(abs(now - before) for now, before in zip(value, self.value))
        # the last value was off by the square of its shift, so this one is by that of its own
        off = change * min(shift / self.shift, 1.0) ** 2 if math.isfinite(self.shift) else math.inf
        self.value, self.shift, self.vectors = value, shift, nearby.around
        mean, error = sum(value) / len(value), float(nearby.error.min())
        near = max(8 * (value[-1] - value[0]), BESIDE * max(abs(mean), unit))
        self.settled = min(change, off) <= error / 4 or (
            math.isfinite(off) and shift <= SETTLED * near
        )
        self.error = nearby.error + SAFE * off
        if self.bends:
            # the error of the second order is a third of what another shift changes
            self.settled = change <= 2 * error
            self.error = nearby.error + change
            near *= 2 if abs(self.at - mean) < 1.5 * near else 1
        self.at = mean + near
        return self.settled

    @property
    def found(self) -> tuple[Real, Real] | None:
        """Eigenvalues and rounding errors, None where they did not settle in the bracket."""
        value = np.array(self.value)
        if self.settled and self.bracket.has(value, self.error):
            return value, self.error
        return None


def refined(rope: SpaceRope, groups: list[Bracket], unit: float) -> list[tuple[Real, Real] | None]:
    """Return eigenvalues and rounding errors of each, or None where they leave the bracket."""
    pursuits = [Pursuit(group, bool(rope.carried)) for group in groups]
    for first in range(0, len(pursuits), AT_ONCE):
        left = pursuits[first : first + AT_ONCE]
        for _ in range(ITERATIONS):
            if not left:
                break
            at = np.array([one.at for one in left])
            which = np.array([one.bracket.component for one in left])
            system = assemble(rope, which, unforced(at, STEP), rope.scale(which, at))
            x = start(system, max(one.bracket.size for one in left) + MORE, left)
            times = 3 if any(one.vectors is None for one in left) else 1
            found = ritz(system, x, [one.bracket.size for one in left], times)
            left = [one for one, near in zip(left, found) if not one.take(near, unit)]
    # rigid motion strains nothing, and has a stiffness of rounding alone
    found_ones = (one.found for one in pursuits)
    return [(f[0], np.maximum(f[1], RIGID * unit)) if f else None for f in found_ones]


def start(system: Assembly, columns: int, known: Any = ()) -> Real:
    """Return vectors (n, rows, columns): those found before, or some that no mode is free of."""
    rows = system.size
    x = np.tile(_fresh(rows, columns), (len(system.D), 1, 1))
    for k, one in enumerate(known):
        if one.vectors is not None and len(one.vectors) == rows:
            x[k, :, : one.vectors.shape[1]] = one.vectors[:, :columns]
    return x


@lru_cache(16)
def _fresh(rows: int, columns: int) -> Real:
    return np.random.default_rng(0).standard_normal((rows, columns))


class Nearby(NamedTuple):
    """Vectors of the eigenvalues closest to an assembly's, and those around them."""

    shift: Real  # of the eigenvalues from the assembly's
    error: Real  # what rounding does to them, at most
    own: Real  # (unknowns, size), of unit mass
    around: Real


def ritz(system: Assembly, x: Real, sizes: list[int], times: int = 3) -> list[Nearby]:
    """Iterate vectors (n, rows, columns), and combine those that an eigenvalue belongs to.

    Of A(lambda) x = 0 about lambda: A x = shift M x with M = -dA/dlambda, which is what moves, so
    that the shifts of vectors between which nothing else lies are right to second order.
    """
    factored, most = system.factored(), max(sizes)
    x, A, M = factored.iterated(x, times)
    shift, mix = _small(A, M / -STEP)
    # the nearest first: the next iteration may start with fewer
    around = x @ np.take_along_axis(mix, np.abs(shift).argsort(1)[:, None], 2)
    # those that are sought alone: the others' shifts are so much larger that they round theirs
    own, A, M = factored.iterated(around[:, :, :most], 1)
    of = np.array(sizes)
    shift, mix = np.full((len(x), most), math.inf), np.zeros(A.shape)
    for size in set(sizes):
        these = of == size
        few = these, slice(size), slice(size)
        shift[these, :size], mix[few] = _small(A[few], M[few] / -STEP)
    own = own @ mix
    error = _rounding(system, own)
    return [
        Nearby(shift[k, :size], error[k, :size], own[k, :, :size], around[k])
        for k, size in enumerate(sizes)
    ]


def _small(A: Real, M: Real) -> tuple[Real, Real]:
    """Return shifts (n, c) and vectors in columns of A x = shift M x.

    What moves next to nothing is no motion: its shift is infinite, its vector 0.
    """
    if A.shape[1:] == (1, 1):
        return (A / M)[:, 0], 1 / np.sqrt(M)
    weight, own = np.linalg.eigh(M)
    moving = weight > 1e-8 * weight[:, -1:]
    if moving.all():
        own = own / np.sqrt(weight)[:, None]
        shift, mix = np.linalg.eigh(own.swapaxes(1, 2) @ A @ own)
        return shift, own @ mix
    shift, vectors = np.full(weight.shape, math.inf), np.zeros(A.shape)
    for k, there in enumerate(moving):
        some, count = own[k][:, there] / np.sqrt(weight[k][there]), there.sum()
        shift[k, :count], mix = np.linalg.eigh(some.T @ A[k] @ some)
        vectors[k, :, :count] = some @ mix
    return shift, vectors


def _rounding(system: Assembly, x: Real) -> Real:
    """Bound what rounding of the parts does to the eigenvalues of vectors of unit mass."""
    u, f = (np.linalg.norm(one, axis=2) for one in system.apart(x))
    D, G, Q, N = (one[:, :, None] for one in system.largest)
    left = u[:, :-1]
    size = (N * u**2).sum(1) + (Q * left**2 + 2 * (1 + D) * left * f + G * f**2).sum(1)
    # those of the parts, and as many of their sums
    bound: Real = SAFE * ROUNDINGS * np.finfo(float).eps * size
    return bound
