"""The lowest modes of a rope in space: bracketed by counts, then refined."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..base.array import Real
from ..base.errors import SolveError
from .assembly import Assembly, assemble
from .rope import SpaceRope, unforced

STEP = 2.0**-200  # Of derivatives by a complex step.
TOGETHER = 1e-8  # Modes that are closer, relative, are found together.
ROUNDS = 200  # Of counts.
ITERATIONS = 12
RIGID = 1e-14  # Less, in units of bending over the whole length, is none.
NARROW = 1e-13  # Brackets that nothing is found in are an answer themselves.
BESIDE = 3e-8  # Iteration is at so much from a mode, where solving still tells others from it.
MORE = 3  # Vectors beside those of the modes that are sought.


class Lowest(NamedTuple):
    """Eigenvalues [rad^2/s^2] with bounds of what rounding does, and how many counts they took."""

    eigenvalue: Real
    error: Real
    counts: int


class Counter:
    """Counts that are known, by increasing eigenvalue."""

    def __init__(self, rope: SpaceRope) -> None:
        self.rope = rope
        self.known: dict[float, int] = {}
        self.asked = 0

    def ask(self, values: Any) -> None:
        """Count at several."""
        for value in {float(v) for v in values} - self.known.keys():
            self.known[value] = self._one(value)

    def _one(self, value: float) -> int:
        for nudge in range(8):
            # joints at a resonance of a part are none a little aside
            beside = value * (1 + nudge * 2.0**-48)
            (count,) = _core.space_count(self.rope.core(value), np.array([beside]))
            self.asked += 1
            if not math.isnan(count):
                return int(count)
        raise SolveError("parts of the rope resonate too close to each other to be counted")

    def bracket(self, i: int) -> tuple[float, float, int, int]:
        """Return the closest values with count <= i and > i, and the counts."""
        low = max(v for v, n in self.known.items() if n <= i)
        high = min(v for v, n in self.known.items() if n > i)
        if not low < high:
            raise SolveError("counts contradict each other: rounding decides where modes are")
        return low, high, self.known[low], self.known[high]


def unit_of(rope: SpaceRope) -> float:
    """Return the eigenvalue that bending gives a length like the rope's [rad^2/s^2]."""
    length = rope.length.sum()
    soft = np.diagonal(rope.soft, axis1=1, axis2=2)[:, 4:].max()
    return float(1 / (soft * rope.inertia[:, 1, 1].max() * length**4))


def count_below(rope: SpaceRope, eigenvalue: float) -> int:
    """Return how many eigenvalues lie below one."""
    counter = Counter(rope)
    counter.ask([eigenvalue])
    return counter.known[eigenvalue]


def lowest(rope: SpaceRope, wanted: int | None, below: float) -> Lowest:
    """Return the lowest eigenvalues, so many or all below one."""
    counter, unit = Counter(rope), unit_of(rope)
    wanted = _surround(counter, unit, wanted, below)
    value, error = np.zeros(wanted), np.zeros(wanted)
    _isolate(counter, range(wanted), unit)
    done = 0
    while done < wanted:
        low, high, first, last = counter.bracket(done)
        group = Group(rope, low, high, last - first, unit)
        found = group.refined()
        if found is None and high - low > NARROW * max(abs(low), abs(high), unit):
            _halve(counter, [done], unit)
            continue
        if found is None:
            found = np.full(last - first, (low + high) / 2), np.full(last - first, high - low)
        members = slice(done - first, wanted - first)
        size = min(last, wanted) - done
        value[done : done + size], error[done : done + size] = (one[members] for one in found)
        done += size
    return Lowest(value, error, counter.asked)


def _surround(counter: Counter, unit: float, wanted: int | None, below: float) -> int:
    """Count below all and above those that are wanted; return how many there are."""
    low = -unit * 1e-3
    counter.ask([low])
    while counter.known[low] > 0:
        low *= 64
        counter.ask([low])
        if not math.isfinite(low):
            raise SolveError("the stiffness has no lower bound: what is loaded has no mass")
    if math.isfinite(below):
        counter.ask([below])
        there = counter.known[below]
        return there if wanted is None else min(wanted, there)
    assert wanted is not None
    high = unit
    counter.ask([high])
    while counter.known[high] < wanted:
        high *= 4
        if high > 1e150 * unit:
            raise SolveError(f"fewer than {wanted} modes are finite")
        counter.ask([high])
    return wanted


def _isolate(counter: Counter, modes: range, unit: float) -> None:
    """Halve brackets until each has a single mode or modes that are found together."""
    for _ in range(ROUNDS):
        wide = [i for i in modes if not _is_done(counter.bracket(i), unit)]
        if not wide:
            return
        _halve(counter, wide, unit)
    raise SolveError("modes lie closer together than counts tell apart")


def _is_done(bracket: tuple[float, float, int, int], unit: float) -> bool:
    low, high, first, last = bracket
    near = 0.1 if last - first == 1 else TOGETHER
    return high - low <= near * max(abs(low), abs(high)) or high - low <= 1e-6 * unit


def _halve(counter: Counter, modes: list[int], unit: float) -> None:
    brackets = {counter.bracket(i)[:2] for i in modes}
    counter.ask([_middle(low, high, unit) for low, high in brackets])


def _middle(low: float, high: float, unit: float) -> float:
    """Return the middle by what counts far from 0, by a geometric mean."""
    small = 1e-4 * unit
    if low >= small and high > 4 * low:
        return math.sqrt(low * high)
    if low < small < high / 4:
        return math.sqrt(small * high)
    return (low + high) / 2


@dataclass(frozen=True, eq=False)
class Group:
    """Modes of one bracket, sought by inverse iteration in the space of a few vectors."""

    rope: SpaceRope
    low: float
    high: float
    size: int
    unit: float

    def refined(self) -> tuple[Real, Real] | None:
        """Return eigenvalues and bounds of rounding, or None where they leave the bracket."""
        at, value, before = (self.low + self.high) / 2, np.full(self.size, math.inf), math.inf
        state = None
        for _ in range(ITERATIONS):
            system = assemble(self.rope, unforced([at], STEP), self.rope.scale(at))
            if state is None or len(state) != (2 * system.parts + 1) * 6:
                state = start(system, self.size + MORE)
            shift, error, _, state = ritz(system, state, self.size)
            change, value = float(np.abs(at + shift - value).max()), at + shift
            if change <= error.min() / 4 or change > before / 2:
                break
            before, mean = change, float(value.mean())
            at = mean + max(8 * float(np.ptp(value)), BESIDE * max(abs(mean), self.unit))
        inside = (value >= self.low - 4 * error) & (value <= self.high + 4 * error)
        # rigid motion strains nothing, and has a stiffness of rounding alone
        error = np.maximum(error, RIGID * self.unit)
        return (value, error) if inside.all() and np.isfinite(value).all() else None


def start(system: Assembly, columns: int) -> Real:
    """Return vectors that no mode is free of, the same for every run."""
    return np.random.default_rng(0).standard_normal(((2 * system.parts + 1) * 6, columns))


class Nearby(NamedTuple):
    """Vectors of the eigenvalues closest to an assembly's, and those around them."""

    shift: Real  # of the eigenvalues from the assembly's
    error: Real  # bound of what rounding does to them
    own: Real  # (unknowns, size), of unit mass
    around: Real


def ritz(system: Assembly, x: Real, size: int) -> Nearby:
    """Iterate vectors, and combine those that an eigenvalue belongs to.

    Of A(lambda) x = 0 about lambda: A x = shift M x with M = -dA/dlambda, which is what moves, so
    that the shifts of vectors between which nothing else lies are right to second order.
    """
    from scipy.linalg import eigh, qr

    factored = system.factored(0, real=True)
    for _ in range(3):
        x = factored.solve(mass(system, qr(x, mode="economic")[0]))
    x = qr(x, mode="economic")[0]
    A, M = x.T @ stiff(system, x), x.T @ mass(system, x)
    # vectors that move next to nothing are no motion
    weight, own = np.linalg.eigh(M)
    moving = weight > 1e-8 * weight[-1]
    own = own[:, moving] / np.sqrt(weight[moving])
    shift, mix = eigh(own.T @ A @ own)
    x = x @ (own @ mix)
    # those that are sought alone: the others' shifts are so much larger that they round theirs
    own = qr(x[:, np.abs(shift).argsort()[:size]], mode="economic")[0]
    own = qr(factored.solve(mass(system, own)), mode="economic")[0]
    shift, mix = eigh(own.T @ stiff(system, own), own.T @ mass(system, own))
    own = own @ mix
    return Nearby(shift, _rounding(system, own), own, x)


def stiff(system: Assembly, x: Real) -> Real:
    """Return A x."""
    u, f = system.apart(x)
    p, d = system.apply(u[None], f[None])
    return system.together(p[0].real, d[0].real)


def mass(system: Assembly, x: Real) -> Real:
    """Return -dA/dlambda x, by the imaginary parts."""
    u, f = system.apart(x)
    p, d = system.apply(u[None], f[None])
    return -system.together(p[0].imag, d[0].imag) / STEP


ROUNDINGS = 4.0  # Of entries of a part's matrices, in units of the largest one, scaled.


def _rounding(system: Assembly, x: Real) -> Real:
    """Bound what rounding of the parts does to the eigenvalues of vectors of unit mass."""
    u, f = (np.linalg.norm(one, axis=1) for one in system.apart(x))
    D, G, Q = (np.abs(one[0].real).max((1, 2))[:, None] for one in (system.D, system.G, system.Q))
    N = np.abs(system.N[0].real).max((1, 2))[:, None]
    moved, left = (N * u**2).sum(0), u[:-1]
    size = moved + (Q * left**2 + 2 * (1 + D) * left * f + G * f**2).sum(0)
    bound: Real = ROUNDINGS * np.finfo(float).eps * size
    return bound
