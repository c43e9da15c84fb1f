"""The lowest modes of a rope in space: bracketed by counts, then refined."""

from __future__ import annotations

import math
from bisect import bisect_left, bisect_right
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..base.array import Real
from ..base.errors import SolveError
from .assembly import ROUNDINGS, Assembly, assemble, foot_of
from .rope import SPRINGS, SpaceRope, unforced

STEP = 2.0**-200  # Of derivatives by a complex step.
TOGETHER = 1e-8  # Modes that are closer, relative, are found together.
ALONE = 0.2  # So narrow, relative, is the bracket of a single mode that is sought.
ROUNDS = 200  # Of counts.
ITERATIONS = 12
RIGID = 1e-14  # Less, in units of bending over the whole length, is none.
NARROW = 1e-13  # Brackets that nothing is found in are an answer themselves.
BESIDE = 3e-8  # Iteration is at so much from a mode, where solving still tells others from it.
SETTLED = 4.0  # Shifts of so many times that are the last.
AT_ONCE = 32  # Groups that are sought together.
MORE = 3  # Vectors beside those of the modes that are sought.


class Lowest(NamedTuple):
    """Eigenvalues [rad^2/s^2], estimates of what rounding does, and how many counts they took."""

    eigenvalue: Real
    error: Real
    counts: int


class Bracket(NamedTuple):
    """Values of which counts are known, and the modes between them."""

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
    """Counts that are known, by increasing eigenvalue."""

    def __init__(self, rope: SpaceRope) -> None:
        self.rope = rope
        self.values: list[float] = []
        self.counts: list[int] = []
        self.asked = 0

    def ask(self, values: Any) -> list[int]:
        """Count at several."""
        new = np.array(sorted({float(v) for v in values} - set(self.values)))
        for nudge in range(8):
            if not len(new):
                return [self.counts[bisect_left(self.values, float(v))] for v in values]
            # joints at a resonance of a part are none a little aside
            counts = counts_at(self.rope, new * (1 + nudge * 2.0**-48))
            self.asked += len(new)
            there = ~np.isnan(counts)
            for value, count in zip(new[there].tolist(), counts[there].tolist()):
                at = bisect_left(self.values, value)
                self.values.insert(at, value)
                self.counts.insert(at, int(count))
            new = new[~there]
        raise SolveError("parts of the rope resonate too close to each other to be counted")

    def bracket(self, i: int) -> Bracket:
        """Return the closest values with count <= i and > i, and the counts."""
        at = bisect_right(self.counts, i)
        if any(a > b for a, b in pairwise(self.counts[max(at - 2, 0) : at + 2])):
            raise SolveError("counts contradict each other: rounding decides where modes are")
        low, high = self.values[at - 1 : at + 1]
        return Bracket(low, high, *self.counts[at - 1 : at + 1])


def counts_at(rope: SpaceRope, values: Real) -> Real:
    """Count the eigenvalues below several, NaN where a part resonates there.

    Those of wires held at their feet, and those of a rope whose nodes have the stiffness of feet.
    """
    arrays, z = rope.core(values)
    if not rope.carried:
        return np.asarray(_core.space_count(arrays, values, z))
    springs, found = np.tile(rope.springs, (len(values), 1, 1, 1)), np.zeros(len(values))
    for one in rope.carried:
        springs[:, one.node] += foot_of(one, unforced(values)).stiffness.real
        found += counts_at(one.rope, values)
    for k, value in enumerate(values):
        own = (*arrays[:SPRINGS], springs[k], *arrays[SPRINGS + 1 :])
        found[k] += _core.space_count(own, np.array([value]), z[k : k + 1])[0]
    return found


def count_below(rope: SpaceRope, eigenvalue: float) -> int:
    """Return how many eigenvalues lie below one."""
    return Counter(rope).ask([eigenvalue])[0]


def lowest(rope: SpaceRope, wanted: int | None, below: float) -> Lowest:
    """Return the lowest eigenvalues, so many or all below one."""
    counter, unit = Counter(rope), rope.unit
    wanted = _surround(counter, unit, wanted, below)
    value, error = np.full(wanted, math.nan), np.zeros(wanted)
    _isolate(counter, range(wanted), unit)
    while len(left := np.flatnonzero(np.isnan(value))):
        groups = sorted({counter.bracket(int(i)) for i in left})
        wide: list[int] = []
        for group, found in zip(groups, refined(rope, groups, unit)):
            if found is None and not group.is_narrow(unit):
                wide += range(group.first, min(group.last, wanted))
                continue
            size = min(group.last, wanted) - group.first
            whole = found or (np.full(size, group.middle), np.full(size, group.high - group.low))
            value[group.first :][:size], error[group.first :][:size] = (one[:size] for one in whole)
        _divide(counter, wide, unit)
        if rope.carried:
            _narrow(counter, wide, unit)
    return Lowest(value, error, counter.asked)


def _narrow(counter: Counter, modes: list[int], unit: float) -> None:
    """Divide brackets until each is an answer: beside a pole of a foot no iteration is one."""
    while wide := [i for i in modes if not counter.bracket(i).is_narrow(unit)]:
        _divide(counter, wide, unit)


def _surround(counter: Counter, unit: float, wanted: int | None, below: float) -> int:
    """Count below all and above those that are wanted; return how many there are."""
    low = -unit * 1e-3
    while counter.ask([low])[0] > 0:
        low *= 64
        if not math.isfinite(low):
            raise SolveError("the stiffness has no lower bound: what is loaded has no mass")
    if math.isfinite(below):
        there = counter.ask([below])[0]
        return there if wanted is None else min(wanted, there)
    assert wanted is not None
    high = unit * max(1.0, (wanted / 4) ** 2)
    while counter.ask([high, 4 * high])[1] < wanted:
        high *= 16
        if high > 1e150 * unit:
            raise SolveError(f"fewer than {wanted} modes are finite")
    return wanted


def _isolate(counter: Counter, modes: range, unit: float) -> None:
    """Divide brackets until each has a single mode or modes that are found together."""
    for _ in range(ROUNDS):
        wide = [i for i in modes if not _is_done(counter.bracket(i), unit)]
        if not wide:
            return
        _divide(counter, wide, unit)
    raise SolveError("modes lie closer together than counts tell apart")


def _is_done(bracket: Bracket, unit: float) -> bool:
    near = ALONE if bracket.size == 1 else TOGETHER
    width = bracket.high - bracket.low
    return width <= near * max(abs(bracket.low), abs(bracket.high)) or width <= 1e-6 * unit


def _divide(counter: Counter, modes: list[int], unit: float) -> None:
    """Count at three places in the bracket of each, which costs as much as at one."""
    asked = set()
    for low, high, _, _ in {counter.bracket(i) for i in modes}:
        middle = _middle(low, high, unit)
        asked |= {_middle(low, middle, unit), middle, _middle(middle, high, unit)} - {low, high}
    counter.ask(asked)


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
        self.value = np.full(bracket.size, math.inf)
        self.settled = False
        self.bends = bends  # whether poles of feet bend what is linear about a shift elsewhere
        self.vectors: Any = None
        self.error: Any = None

    def take(self, nearby: Nearby, unit: float) -> bool:
        """Go on from what was found at `at`; True where nothing is to come."""
        value = self.at + nearby.shift
        change = float(np.abs(value - self.value).max())
        self.value, self.error, self.vectors = value, nearby.error, nearby.around
        mean = float(value.mean())
        near = max(8 * float(np.ptp(value)), BESIDE * max(abs(mean), unit))
        # at a shift like the least one the error of the second order is that of rounding
        self.settled = bool(
            change <= self.error.min() / 4 or np.abs(nearby.shift).max() <= SETTLED * near
        )
        if self.bends:
            # the error of the second order is a third of what another shift changes
            self.settled = change <= 2 * float(self.error.min())
            near *= 2 if abs(self.at - mean) < 1.5 * near else 1
        self.at = mean + near
        return self.settled

    @property
    def found(self) -> tuple[Real, Real] | None:
        """Eigenvalues and rounding errors, None where they did not settle in the bracket."""
        if self.settled and self.bracket.has(self.value, self.error):
            return self.value, self.error
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
            system = assemble(rope, unforced(at, STEP), rope.scale(at))
            x = start(system, max(one.bracket.size for one in left) + MORE, left)
            times = 3 if any(one.vectors is None for one in left) else 1
            found = ritz(system, x, [one.bracket.size for one in left], times)
            left = [one for one, near in zip(left, found) if not one.take(near, unit)]
    # rigid motion strains nothing, and has a stiffness of rounding alone
    found_ones = (one.found for one in pursuits)
    return [(f[0], np.maximum(f[1], RIGID * unit)) if f else None for f in found_ones]


def start(system: Assembly, columns: int, known: Any = ()) -> Real:
    """Return vectors (n, rows, columns): those found before, or some that no mode is free of."""
    rows = (2 * system.parts + 1) * 6
    fresh = np.random.default_rng(0).standard_normal((rows, columns))
    x = np.tile(fresh, (len(system.D), 1, 1))
    for k, one in enumerate(known):
        if one.vectors is not None and len(one.vectors) == rows:
            x[k, :, : one.vectors.shape[1]] = one.vectors[:, :columns]
    return x


class Nearby(NamedTuple):
    """Vectors of the eigenvalues closest to an assembly's, and those around them."""

    shift: Real  # of the eigenvalues from the assembly's
    error: Real  # estimate of what rounding does to them
    own: Real  # (unknowns, size), of unit mass
    around: Real


def ritz(system: Assembly, x: Real, sizes: list[int], times: int = 3) -> list[Nearby]:
    """Iterate vectors (n, rows, columns), and combine those that an eigenvalue belongs to.

    Of A(lambda) x = 0 about lambda: A x = shift M x with M = -dA/dlambda, which is what moves, so
    that the shifts of vectors between which nothing else lies are right to second order.
    """
    factored, most = system.factored(real=True), max(sizes)
    for _ in range(times):
        x = factored.solve(mass(system, np.linalg.qr(x)[0]))
    x = np.linalg.qr(x)[0]
    own, around = np.zeros((*x.shape[:2], most)), []
    for k, (shift, mix) in enumerate(_small(*_forms(system, x))):
        around.append(x[k] @ mix)
        near = np.abs(shift).argsort()[:most]
        own[k, :, : len(near)] = around[k][:, near]
    # those that are sought alone: the others' shifts are so much larger that they round theirs
    own = np.linalg.qr(factored.solve(mass(system, np.linalg.qr(own)[0])))[0]
    found = []
    A, M = _forms(system, own)
    alike = _small(A, M) if min(sizes) == most else None
    for k, size in enumerate(sizes):
        few = slice(k, k + 1), slice(size), slice(size)
        shift, mix = alike[k] if alike else _small(A[few], M[few])[0]
        own[k, :, : mix.shape[1]] = own[k, :, :size] @ mix
        found.append((shift, mix.shape[1]))
    error = _rounding(system, own)
    return [
        Nearby(shift, error[k, :size], own[k, :, :size], around[k])
        for k, (shift, size) in enumerate(found)
    ]


def _forms(system: Assembly, x: Real) -> tuple[Real, Real]:
    back = x.swapaxes(1, 2)
    return back @ stiff(system, x), back @ mass(system, x)


def _small(A: Real, M: Real) -> list[tuple[Real, Real]]:
    """Return shifts and vectors of A x = shift M x; what moves next to nothing is no motion."""
    weight, own = np.linalg.eigh(M)
    moving = weight > 1e-8 * weight[:, -1:]
    if moving.all():
        own = own / np.sqrt(weight)[:, None]
        shift, mix = np.linalg.eigh(own.swapaxes(1, 2) @ A @ own)
        return list(zip(shift, own @ mix))
    found = []
    for k, there in enumerate(moving):
        some = own[k][:, there] / np.sqrt(weight[k][there])
        shift, mix = np.linalg.eigh(some.T @ A[k] @ some)
        found.append((shift, some @ mix))
    return found


def stiff(system: Assembly, x: Real) -> Real:
    """Return A x."""
    return system.together(*system.real.apply(*system.apart(x)))


def mass(system: Assembly, x: Real) -> Real:
    """Return -dA/dlambda x, by the imaginary parts."""
    return system.together(*system.imag.apply(*system.apart(x))) / -STEP


def _rounding(system: Assembly, x: Real) -> Real:
    """Estimate what rounding of the parts does to the eigenvalues of vectors of unit mass."""
    u, f = (np.linalg.norm(one, axis=2) for one in system.apart(x))
    D, G, Q, N = (one[:, :, None] for one in system.largest)
    left = u[:, :-1]
    size = (N * u**2).sum(1) + (Q * left**2 + 2 * (1 + D) * left * f + G * f**2).sum(1)
    bound: Real = ROUNDINGS * np.finfo(float).eps * size
    return bound
