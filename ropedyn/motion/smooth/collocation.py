"""Radau collocation of the forces of laws; between its stages linear motion is exact.

Over a step h the force of each law is the polynomial through its values at the nodes of Radau,
the last of which is the end of the step. A mode q'' + 2 sigma q' + square q = f then moves by

    q(t) = free motion + sum over stages j of f_j integral from 0 to t of g(t - s) l_j(s/h) ds

with its motion g after a blow of 1 and Lagrange's polynomials l_j, and only the forces at the
stages are unknown: those that the laws say where they move their points (csrc/collocation).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...base.array import Complex, Real
from ...base.computed import computed
from ..modal.exponentials import rates

STAGES = 5  # Errors fall with the ninth power of a step that resolves the motion.
PANEL = 18  # Gauss's nodes of a panel of an integral,
PER_RADIAN = 0.6  # and so many more for each radian that modes turn in it,
TURNS = 16.0  # up to so many: those that turn or decay further are integrated by parts.
FADED = 45.0  # A mode has decayed to nothing after so many time constants.
APART = 0.1  # Rates that differ by less of themselves are integrated together.


@lru_cache(maxsize=8)
def nodes(stages: int) -> Real:
    """Return Radau's nodes on (0, 1], the last of which is 1."""
    legendre = np.polynomial.legendre
    difference = np.zeros(stages + 1)
    difference[stages - 1 :] = 1.0, -1.0
    node = np.sort((legendre.legroots(difference) + 1) / 2)
    node[-1] = 1.0
    return np.asarray(node)


# Of forces at the stages, what Legendre's polynomial of the highest degree has in them.
HIGHEST = np.linalg.inv(np.polynomial.legendre.legvander(2 * nodes(STAGES) - 1, STAGES - 1))[-1]


@lru_cache(maxsize=64)
def gauss(count: int) -> tuple[Real, Real]:
    """Return Gauss's nodes on (0, 1) and their weights."""
    node, weight = np.polynomial.legendre.leggauss(count)
    return (node + 1) / 2, weight / 2


def panel(turns: float) -> tuple[Real, Real]:
    """Return nodes and weights on (0, 1) for what turns so far in it [rad]."""
    count = PANEL + math.ceil(PER_RADIAN * turns)
    return gauss(8 * -(-count // 8))


def lagrange(theta: Real, order: int = 0) -> Real:
    """Return Lagrange's polynomials of the nodes at theta, differentiated, (theta, stages)."""
    node = nodes(STAGES)
    powers = np.polynomial.polynomial.polyvander(2 * node - 1, STAGES - 1)
    coefficient = np.linalg.inv(powers)
    if order:
        coefficient = np.polynomial.polynomial.polyder(coefficient, order, scl=2)
    return np.asarray(np.polynomial.polynomial.polyval(2 * theta - 1, coefficient).T)


@dataclass(frozen=True, eq=False)
class Oscillating:
    """Modes q'' + 2 sigma q' + square q = push f that move outputs by seen q + swept q'."""

    sigma: Real  # (k,) [1/s]
    square: Real  # (k,) [rad^2/s^2]
    push: Real  # (k, inputs)
    seen: Real  # (outputs, k)
    swept: Real  # (outputs, k) [s]

    @computed
    def rate(self) -> Complex:
        """The two rates of each mode, the slower first [rad/s], shape (k, 2)."""
        return rates(self.sigma, self.square)

    def some(self, inputs: slice, outputs: slice) -> Oscillating:
        """Return those of some inputs and outputs."""
        seen, swept = self.seen[outputs], self.swept[outputs]
        return replace(self, push=self.push[:, inputs], seen=seen, swept=swept)

    def reached(self, h: float, theta: float) -> Reached:
        """Return how modes move until theta h."""
        g, slope = _blow(self.rate, np.array(theta * h))
        change = np.array([[slope + 2 * self.sigma * g, g], [-self.square * g, slope]])
        return Reached(theta, change, self._pushed(h, theta))

    def _pushed(self, h: float, theta: float) -> Real:
        """Return (q, q') at theta h per force of 1 at each stage, (stages, 2, k)."""
        one, other = self.rate.T
        gap = np.abs(one - other)
        apart = (gap * theta * h > 1) & (gap > APART * np.abs(self.rate).max(axis=1))
        total = np.empty((STAGES, 2, len(apart)))
        total[..., ~apart] = _together(self.rate[~apart], h, theta)
        one, other = one[apart], other[apart]
        first, second = (_followed(p, h, theta) for p in (one, other))
        both = np.stack([first / one - second / other, first - second], axis=1)
        total[..., apart] = (both / (one - other)).real
        return total

    def rows(self, reached: Reached, order: int, h: float) -> tuple[Real, Real]:
        """Return outputs, differentiated, per (q, q') of each input and per force at the stages.

        Shapes (outputs, inputs, 2, k) and (outputs, stages, inputs).
        """
        own, forced = self.modal_rows(reached, order, h)
        return own[:, None] * self.push.T[:, None], forced @ self.push

    def modal_rows(self, reached: Reached, order: int, h: float) -> tuple[Real, Real]:
        """Return outputs, differentiated, per (q, q') and per forces on each mode at the stages.

        Shapes (outputs, 2, k) and (outputs, stages, k).
        """
        a, b = self.seen, self.swept
        at_once = np.zeros((len(a), STAGES, len(self.sigma)))
        for k in range(order):
            later = lagrange(np.array([reached.theta]), order - 1 - k)[0] / h ** (order - 1 - k)
            at_once += b[:, None] * later[:, None]
            a, b = -b * self.square, a - 2 * self.sigma * b
        change, pushed = reached.change, reached.pushed
        own = a[:, None] * change[0] + b[:, None] * change[1]
        return own, at_once + a[:, None] * pushed[:, 0] + b[:, None] * pushed[:, 1]


def _blow(rate: Complex, t: Real) -> tuple[Real, Real]:
    """Return q and q' of each mode a time t after a blow of 1, shape (.., k)."""
    slow, fast = rate.T
    time = np.asarray(t)[..., None]
    apart = (slow - fast) * time
    ratio = np.divide(-np.expm1(-apart), apart, out=np.ones_like(apart), where=apart != 0)
    q = np.exp(slow * time) * time * ratio
    return q.real, (slow * q + np.exp(fast * time)).real


def _together(rate: Complex, h: float, theta: float) -> Real:
    """Return how modes whose rates cancel are pushed, (stages, 2, k)."""
    slow, t = rate[:, 0], theta * h
    lasts = np.full(len(slow), np.inf)
    np.divide(-FADED, slow.real, out=lasts, where=slow.real < 0)
    # what decays fast is felt near the end alone: panels grow from there on
    panels = math.ceil(math.log2(max(np.abs(rate.real).max(initial=0.0) * t, 1.0))) + 1
    edge = t * np.concatenate([[0.0], 0.5 ** np.arange(panels)[::-1]])
    total = np.zeros((STAGES, 2, len(rate)))
    for begin, end in pairwise(edge.tolist()):
        turns = slow.imag * np.maximum(np.minimum(lasts, end) - begin, 0.0)
        node, weight = panel(turns.max(initial=0.0))
        since = begin + (end - begin) * node
        shape = lagrange((t - since) / h) * (weight * (end - begin))[:, None]
        for i, part in enumerate(_blow(rate, since)):
            total[:, i] += shape.T @ part
    return total


def _followed(p: Complex, h: float, theta: float) -> Complex:
    """Return p times the integrals of e^(p (theta h - s)) and each polynomial, (stages, k)."""
    t, total = theta * h, np.zeros((STAGES, len(p)), dtype=np.complex128)
    far = np.abs(p) * t > TURNS
    for order in range(STAGES):  # by parts: a polynomial has few derivatives
        begin, end = lagrange(np.array([0.0, theta]), order)
        change = np.multiply.outer(begin, np.exp(p[far] * t)) - end[:, None]
        total[:, far] += change / (p[far] * h) ** order
    node, weight = panel(TURNS)
    since = t * node
    shape = lagrange(theta - since / h) * (weight * t)[:, None]
    total[:, ~far] = shape.T @ np.exp(np.multiply.outer(since, p[~far])) * p[~far]
    return total


class Reached(NamedTuple):
    """How modes move until a time within a step."""

    theta: float  # of the step
    change: Real  # (2, 2, k) (q, q') there per (q, q') at the beginning
    pushed: Real  # (stages, 2, k) (q, q') there per force of 1 at each stage


class Tables(NamedTuple):
    """A step of one length, as `_core.collocate` takes it."""

    h: float
    node: Real
    change: Real
    push: Real
    seen: Real
    own: Real
    ahead: Real


def tables(modes: Oscillating, h: float, before: float) -> Tables:
    """Return the tables of a step after one of another length; outputs are the inputs' points."""
    node, n, k = nodes(STAGES), len(modes.seen), len(modes.sigma)
    seen = np.empty((n, 2, k, STAGES, 2, n))
    own = np.empty((STAGES, 2, n, STAGES, n))
    for i, theta in enumerate(node):
        reached = modes.reached(h, float(theta))
        for order in range(2):
            state, forced = modes.rows(reached, order, h)
            seen[:, :, :, i, order] = state.transpose(1, 2, 3, 0)
            own[i, order] = forced
    # forces of a step are no guess of what comes much later
    ahead = lagrange(1 + np.minimum(node * h / before, 1.0))
    return Tables(h, node, reached.change, reached.pushed, seen, own, ahead)
