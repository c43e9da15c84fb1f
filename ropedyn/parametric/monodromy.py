"""How motion in modes is carried on over one period of the tension.

Over a period p the motion is an entire function of p: polynomials between a few dozen periods give
it at all others.

With W = diag(w) and the state (W q, q') the modes by themselves move exactly, by the exponential of
their rates; the pulsation kicks them, q' -= h a cos(2 pi f t) Gamma q. Kicks between half steps of
motion are of second order and symmetric in time; a symmetric composition of 35 of them, some of
which go backwards, is of order 10. Whatever the step, the determinant of motion over a period is
exp(-trace(C)/f), and without damping it is symplectic: no numerical damping, no numerical growth.

M. Sofroniou, G. Spaletta, Derivation of symmetric composition constants for symmetric integrators,
Optimization Methods and Software 20 (2005) 597-613; the constants as in E. Hairer, C. Lubich, G.
Wanner, Geometric Numerical Integration (2006), section V.3.2.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..base.array import Index, Real
from ..base.errors import SolveError
from ..motion.modal_system import ModalSystem

HALF = (
      0.07879572252168641926390768,   0.31309610341510852776481247,   0.02791838323507806610952027,
     -0.22959284159390709415121340,   0.13096206107716486317465686,  -0.26973340565451071434460973,
      0.07497334315589143566613711,   0.11199342399981020488957508,   0.36613344954622675119314812,
     -0.39910563013603589787862981,   0.10308739852747107731580277,   0.41143087395589023782070412,
     -0.00486636058313526176219566,  -0.39203335370863990644808194,   0.05194250296244964703718290,
      0.05066509075992449633587434,   0.04967437063972987905456880,   0.04931773575959453791768001,
)  # fmt: skip
"""Each kick of the composition stands for such a part of a step, up to the one in the middle."""
SHARE = np.array(HALF + HALF[-2::-1])
AT = np.cumsum(SHARE) - SHARE / 2  # Each kick comes at this part of the step.
DRIFT = (np.append(SHARE, 0.0) + np.append(0.0, SHARE)) / 2  # So long are motions between kicks.
TERMS = 15  # After so many terms of the series of a matrix of norm 1/2 the next is 1e-18.
TOGETHER = 1 << 16  # So many numbers of states are carried on together: they stay in the cache.
MOST_STEPS = 200_000  # A period takes so many steps at most.
ANGLE = 1.0
"""The highest mode turns so far in a step [rad]: the error of ln|multiplier| is 1e-10 where the
tension pulsates by half of it."""
SMALL_ANGLE = 0.4  # The same where motion is to be right to rounding.
NODES = 40  # A polynomial goes through the motion over so many periods,
TURN = 6.0  # between which the highest mode turns by twice this [rad].


def steps_for(system: ModalSystem, frequency: float, amplitude: float, angle: float) -> int:
    """Return how many steps a period takes."""
    stiffest = np.abs(system.eigenvalue) + amplitude * np.abs(np.diag(system.geometric))
    rate = max(math.sqrt(stiffest.max()), float(np.abs(np.diag(system.damping)).max()))
    count = rate / (frequency * angle)
    if not count <= MOST_STEPS:
        raise SolveError(
            f"frequency {frequency!r} Hz is too low: a period would take {count:.3g} steps of the "
            f"highest mode, at most {MOST_STEPS} are made"
        )
    return max(math.ceil(count), 6)


def scales(system: ModalSystem) -> Real:
    """Return w of the states [rad/s]: the mode's own, or the least that moves where it has none."""
    size = np.sqrt(np.abs(system.eigenvalue))
    least = size[size > 0].min(initial=np.inf)
    return np.where(size > 0, size, least if np.isfinite(least) else 1.0)


def rates(system: ModalSystem) -> Real:
    """Return the matrix A of x' = A x without pulsation, x = (W q, q'), shape (2k, 2k) [1/s]."""
    w, k = scales(system), len(system.eigenvalue)
    matrix = np.zeros((2 * k, 2 * k))
    matrix[:k, k:] = np.diag(w)
    matrix[k:, :k] = -np.diag(system.eigenvalue / w)
    matrix[k:, k:] = -system.damping
    return matrix


def exponential(matrix: Real) -> Real:
    """Return exp(A) of many small matrices, (..., n, n): Taylor's series of A/2^s, squared."""
    # of one alone `scipy.linalg.expm` is as good; of thousands its threads take longer
    norm = float(np.abs(matrix).sum(axis=-1).max(initial=0.0))
    squarings = max(math.ceil(math.log2(norm)) + 1, 0) if norm > 0 else 0
    scaled = matrix / 2.0**squarings
    total = term = np.broadcast_to(np.eye(matrix.shape[-1]), matrix.shape)
    for n in range(1, TERMS + 1):
        term = term @ scaled / n
        total = total + term
    for _ in range(squarings):
        total = total @ total
    return total


def monodromy(system: ModalSystem, frequency: Real, amplitude: Real, steps: int) -> Real:
    """Return how states are carried on over one period."""
    count, several = amplitude.shape
    k = len(system.eigenvalue)
    step = 1 / (frequency * steps)
    drift = exponential(rates(system) * step[:, None, None] * DRIFT[: len(HALF), None, None, None])
    between = [drift[min(j, len(SHARE) - j)] for j in range(1, len(SHARE))]
    between.append(drift[0] @ drift[0])
    kick = -(system.geometric / scales(system))
    push = np.repeat(step[:, None] * amplitude, 2 * k, axis=1)[:, None, :]
    state = drift[0] @ np.tile(np.eye(2 * k), several)
    other = np.empty_like(state)
    for n in range(steps):
        if n == steps - 1:
            between[-1] = drift[0]
        for share, at, motion in zip(SHARE.tolist(), AT.tolist(), between):
            force = share * math.cos(2 * math.pi * (n + at) / steps)
            state[:, k:] += (kick @ state[:, :k]) * (force * push)
            state, other = np.matmul(motion, state, out=other), state
    return state.reshape(count, 2 * k, several, 2 * k).swapaxes(1, 2)


def exponent(
    system: ModalSystem,
    frequency: Real,
    amplitude: Real,
    *,
    angle: float = ANGLE,
    report: Callable[[float], Any] = lambda fraction: None,
) -> Real:
    """Return ln|multiplier| of the motion that grows most over one period."""
    largest = np.full(amplitude.shape, -np.inf)
    for number, modes in enumerate(system.blocks):
        done = 0
        for these, matrix in periods(system.only(modes), frequency, amplitude, angle):
            size = np.abs(np.linalg.eigvals(matrix)).max(axis=-1)
            with np.errstate(divide="ignore"):
                largest[these] = np.maximum(largest[these], np.log(size))
            done += len(these)
            report((number + done / len(frequency)) / len(system.blocks))
    return largest


def periods(
    system: ModalSystem, frequency: Real, amplitude: Real, angle: float
) -> Iterator[tuple[Index, Real]]:
    """Yield some of the frequencies, lowest first, and the motion over their periods."""
    # as `exponent` takes them; the motion has the shape (some, a, 2k, 2k)
    order = np.argsort(frequency, kind="stable")
    highest = float(amplitude.max(initial=0.0))
    each = max(TOGETHER // ((2 * len(system.eigenvalue)) ** 2 * amplitude.shape[1]), 1)
    for first in range(0, len(order), each):
        these = order[first : first + each]
        steps = steps_for(system, float(frequency[these[0]]), highest, angle)
        with np.errstate(over="ignore", invalid="ignore"):
            matrix = monodromy(system, frequency[these], amplitude[these], steps)
        yield these, finite(matrix)


def finite(matrix: Real) -> Real:
    """Return the same."""
    if not np.isfinite(matrix).all():
        raise SolveError("motion grows out of all numbers within one period of the tension")
    return matrix


@dataclass(frozen=True, eq=False)
class Propagator:
    """Motion over a period as polynomials in the period."""

    edge: Real  # (p + 1,) where polynomials meet [s]
    coefficient: Real  # (p, NODES, 2k, 2k) of Chebyshev's

    @classmethod
    def of(cls, system: ModalSystem, low: float, high: float, amplitude: float) -> Propagator:
        """Return that between two periods."""
        stiffest = np.abs(system.eigenvalue).max() + amplitude * np.abs(system.geometric).max()
        rate = math.sqrt(stiffest) + float(np.abs(system.damping).max())
        pieces = max(math.ceil(rate * (high - low) / (2 * TURN)), 1)
        edge = np.linspace(low, high, pieces + 1)
        angle = np.pi * (np.arange(NODES) + 0.5) / NODES
        middle, half = (edge[1:] + edge[:-1])[:, None] / 2, np.diff(edge)[:, None] / 2
        frequency = 1 / (middle + half * np.cos(angle)).ravel()
        size = 2 * len(system.eigenvalue)
        motion = np.empty((len(frequency), size, size))
        given = np.full((len(frequency), 1), amplitude)
        for these, matrix in periods(system, frequency, given, SMALL_ANGLE):
            motion[these] = matrix[:, 0]
        series = np.cos(np.arange(NODES)[:, None] * angle) * 2 / NODES
        series[0] /= 2
        coefficient = np.einsum("mj,pjab->pmab", series, motion.reshape(pieces, NODES, size, size))
        return cls(edge, coefficient)

    @property
    def tail(self) -> float:
        """The last terms of the polynomials beside the largest: what is left out is smaller."""
        size = np.abs(self.coefficient).max(axis=(2, 3))
        return float((size[:, -2:].max(axis=1) / size.max(axis=1)).max())

    def __call__(self, period: Real) -> Real:
        """Return the motion over periods, shape (m, 2k, 2k)."""
        at = np.clip(np.searchsorted(self.edge, period) - 1, 0, len(self.edge) - 2)
        size = self.coefficient.shape[-1]
        motion = np.empty((len(period), size, size))
        for piece in np.unique(at):
            these = at == piece
            low, high = self.edge[piece : piece + 2]
            x = (2 * period[these] - low - high) / (high - low)
            series = np.polynomial.chebyshev.chebvander(x, NODES - 1)
            motion[these] = np.tensordot(series, self.coefficient[piece], 1)
        return motion
