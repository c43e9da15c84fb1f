"""Outputs as functions of the time since a phase began: exponentials, t times some, a polynomial.

y(t) = Re sum_j (c_j + d_j t) e^(rate_j t) + sum_m a_m t^m
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ... import _core
from ...base.array import Complex, Index, Real


class Crossing(NamedTuple):
    """Where an output falls below zero."""

    time: float
    which: int


class Course(NamedTuple):
    """Outputs over time in closed form, with every derivative."""

    rate: Complex  # (j,) [1/s]
    c: Complex  # (outputs, j)
    d: Complex  # (outputs, j') of the first j' rates
    a: Real  # (outputs, powers)

    def some(self, which: Index | slice) -> Course:
        """Return some of the outputs."""
        return Course(self.rate, self.c[which], self.d[which], self.a[which])

    def beside(self, other: Course) -> Course:
        """Return the outputs of both, of one phase."""
        return Course(
            self.rate,
            np.concatenate([self.c, other.c]),
            np.concatenate([self.d, other.d]),
            np.concatenate([self.a, other.a]),
        )

    def derivative(self) -> Course:
        """Return the rate of change."""
        c, n = self.c * self.rate, self.d.shape[1]
        if n:
            c[:, :n] += self.d
        a = np.zeros_like(self.a)
        a[:, :-1] = self.a[:, 1:] * np.arange(1, self.a.shape[1])
        return Course(self.rate, c, self.d * self.rate[:n], a)

    def at(self, time: Real) -> Real:
        """Return the outputs at times [s], shape (outputs, t)."""
        with np.errstate(under="ignore", over="ignore", invalid="ignore"):
            power = np.exp(np.multiply.outer(self.rate, time))
            value = self.c.real @ power.real - self.c.imag @ power.imag
            n = self.d.shape[1]
            if n:
                value += time * (self.d.real @ power[:n].real - self.d.imag @ power[:n].imag)
        value += self.a @ np.vander(time, self.a.shape[1], increasing=True).T
        return np.asarray(value)

    def first_crossing(self, scale: Real, end: float) -> Crossing | None:
        """Return the first time before the end at which one falls below zero, from 0 on.

        `scale` is the size of the numbers that they are differences of.
        """
        found = _core.first_crossing(self.rate, self.c, self.d, self.a, scale, end)
        return None if found is None else Crossing(*found)
