"""Which periods of the tension let motion without damping grow: none can be missed.

Multipliers on the unit circle are of two kinds, by the sign of i q* q'. Those of the first turn
forward only while the period becomes longer, as Hill's bands in Omega^2 fall, and those of the
second backward, their mirror images. Only two of different kinds can leave the circle, where
phi_i + phi_j = 2 pi n: between two periods where no such sum passes a whole turn nothing grows
(M. G. Krein, American Mathematical Society Translations 120 (1983) 1-70). How often multipliers
have come through 1 altogether is the number of bands of Hill's matrix: it proves that none went
round unseen.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ..base.array import Flags, Index, Real
from ..motion.modal_system import ModalSystem
from .hill import flat_band, flat_pair, turns
from .monodromy import Propagator, scales

NEUTRAL = 1e-6
"""Growth ln|multiplier| over a period is seen above this where undamped motion keeps its size: two
multipliers that meet on the unit circle are the root of 1e-16 off it by rounding."""
STEP = 1.0  # All phases together turn so far between the first periods that are looked at [rad].
SECTIONS = 4  # Between two periods where something may happen, so many parts are looked at.
CLOSE = 1e-9  # Hill's matrix goes on from intervals of this part of the period.
NARROW = 1e-13  # A tongue narrower than this part of its period has no width.
NEAR = 1e-5  # Tongues that no period falls into lie in this part of theirs.
TAIL = 1e-10  # Polynomials leave out less than this part of the motion.
LOST = 14.0
"""Where motion grows by the exponential of this over a period it is taken to grow up to the next
one looked at: of what keeps its size beside it rounding leaves too little to prove that."""
LEVEL = 1e-7  # Sums of phases are whole turns if they are by this part of one.


class Unstable(NamedTuple):
    """Periods [s] between which motion grows, and the orders of the tongues on both sides."""

    begin: float
    end: float
    begin_order: int
    end_order: int


@dataclass
class Regions:
    """Where motion of some modes grows."""

    unstable: list[Unstable] = field(default_factory=list)
    passed: int = 0  # resonances n f = f_i + f_j, tongues without width too
    proved: bool = True


class _Phases(NamedTuple):
    """Of multipliers of the first kind, and of those outside the circle in place of lost ones."""

    phase: Real  # (m, k) [rad], from 0 to 2 pi, increasing
    off: Flags  # (m, k) whether it has left the circle
    lost: Flags  # (m,) whether the others are lost beside one far outside

    def some(self, which: list[int]) -> _Phases:
        return _Phases(self.phase[which], self.off[which], self.lost[which])


class _Steps(NamedTuple):
    """From each of some periods to the next."""

    closed: Flags  # (m,) nothing begins or ends between
    wraps: Index  # (m,) so many multipliers of the first kind come through 1
    passed: Index  # (m, k, k) how often the sums of two phases pass a whole turn


def undamped(system: ModalSystem, low: float, high: float, amplitude: float) -> Regions:
    """Find where motion of coupled modes without damping grows between two periods."""
    motion = Propagator.of(system, low, high, amplitude)
    period, state = _looked(system, motion, low, high)
    found = Regions(proved=motion.tail < TAIL and not state.lost.any())
    step = _steps(state)
    through = [_through(system, amplitude, period[at], state.some([at])) for at in (0, -1)]
    found.proved &= bool(through[1] - through[0] == step.wraps.sum())
    at = np.flatnonzero(~step.closed)
    grows, begin, order = bool(state.off[0].any()), low, 0
    pairs = list[tuple[float, float]]()
    # neighbours that stay open are one place
    for run in np.split(at, np.flatnonzero(np.diff(at) > 1) + 1) if len(at) else []:
        ends = state.some([int(run[0]), int(run[-1]) + 1])
        where = float(period[run[0]] + period[run[-1] + 1]) / 2
        passed, after = np.triu(_steps(ends).passed[0]), bool(ends.off[1].any())
        found.passed += int(passed.sum())
        if grows != after:
            phase = float(ends.phase[int(after)][ends.off[int(after)]][0])
            edge = flat_band(system, amplitude, where, phase)
            if grows:
                found.unstable.append(Unstable(begin, float(edge.period[0]), order, edge.order))
            grows, begin, order = after, float(edge.period[0]), edge.order
        elif not grows:
            pairs += [(where, phase) for phase in ends.phase[0][np.nonzero(passed)[0]].tolist()]
    if grows:
        found.unstable.append(Unstable(begin, high, order, 0))
    narrow = [_narrow(system, amplitude, *pair, found.unstable) for pair in pairs]
    found.proved &= None not in narrow
    found.unstable += [tongue for tongue in narrow if tongue and tongue.begin < tongue.end]
    return found


def _looked(
    system: ModalSystem, motion: Propagator, low: float, high: float
) -> tuple[Real, _Phases]:
    """Return periods between which nothing begins or ends, but where they are close."""
    count = math.ceil(float(system.omega.sum()) * (high - low) / STEP) + 2
    period = np.linspace(low, high, count)
    state = _phases(system, motion(period))
    while True:
        wide = np.diff(period) > CLOSE * period[1:]
        at = np.flatnonzero(wide & ~_steps(state).closed)
        if len(at) == 0:
            return period, state
        more = np.linspace(period[at], period[at + 1], SECTIONS + 1, axis=1)[:, 1:-1].ravel()
        new = _phases(system, motion(more))
        order = np.argsort(np.concatenate([period, more]), kind="stable")
        period = np.concatenate([period, more])[order]
        state = _Phases(*(np.concatenate(both)[order] for both in zip(state, new)))


def _phases(system: ModalSystem, motion: Real) -> _Phases:
    """Return the multipliers of the first kind of motions over periods."""
    k = len(system.eigenvalue)
    value, vector = np.linalg.eig(motion)
    q, v = vector[:, :k], vector[:, k:]
    kind = (q.conj() * v / scales(system)[:, None]).imag.sum(axis=1)
    with np.errstate(divide="ignore"):
        growth = np.log(np.abs(value))
    off = np.abs(growth) > NEUTRAL
    first = np.argsort(-np.where(off, np.copysign(np.inf, growth), kind), axis=1)[:, :k]
    phase = np.mod(np.angle(np.take_along_axis(value, first, 1)), 2 * np.pi)
    order = np.argsort(phase, axis=1)
    outside = np.take_along_axis(np.take_along_axis(off, first, 1), order, 1)
    return _Phases(np.take_along_axis(phase, order, 1), outside, growth.max(axis=1) > LOST)


def _steps(state: _Phases) -> _Steps:
    """Compare neighbours."""
    k, turn = state.phase.shape[1], 2 * np.pi
    total = np.diff(state.phase, axis=0).sum(axis=1) / turn
    wraps = np.ceil(-total - LEVEL).astype(np.intp)
    # the same multipliers in order, after some came through 1
    number = np.arange(k) + wraps[:, None]
    after = np.take_along_axis(state.phase[1:], number % k, 1) + turn * (number // k)
    off = np.take_along_axis(state.off[1:], number % k, 1)
    sums = [
        np.floor((one[:, :, None] + one[:, None, :]) / turn + LEVEL).astype(np.intp)
        for one in (state.phase[:-1], after)
    ]
    moved = after - state.phase[:-1]
    passed = sums[1] - sums[0]
    closed = (passed == 0).all(axis=(1, 2)) & (off == state.off[:-1]).all(axis=1)
    closed &= (np.abs(moved) < np.pi).all(axis=1)
    return _Steps(closed | (state.lost[1:] & state.lost[:-1]), wraps, passed)


def _through(system: ModalSystem, amplitude: float, period: float, state: _Phases) -> float:
    """Return how many multipliers have come through 1, by Hill's matrix; nan if it cannot tell."""
    apart = np.abs(np.remainder(state.phase + np.pi, 2 * np.pi) - np.pi)
    at_one = int((state.off & (apart < LEVEL)).sum())
    twice = turns(system, amplitude, period) + at_one - len(system.eigenvalue)
    return math.nan if twice % 2 else twice / 2


def _narrow(
    system: ModalSystem, amplitude: float, period: float, phase: float, wide: list[Unstable]
) -> Unstable | None:
    """Find the tongue of two multipliers that pass each other at a period and a phase.

    One without width begins where it ends; there is none where it is not found.
    """
    flat = flat_pair(system, amplitude, period, phase)
    if flat is None:
        return None
    begin, end = flat.period.tolist()
    closed = Unstable(period, period, flat.order, flat.order)
    if any(one.begin <= (begin + end) / 2 <= one.end for one in wide):
        return closed  # they leave a wide one, and pass each other beside its edge
    if max(abs(begin - period), abs(end - period)) > NEAR * period:
        return None
    return Unstable(begin, end, flat.order, flat.order) if end - begin > NARROW * period else closed
