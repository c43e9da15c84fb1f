"""Outputs as functions of the time since a phase began: exponentials, t times some, a polynomial.

y(t) = Re sum_j (c_j + d_j t) e^(rate_j t) + sum_m a_m t^m
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.array import Complex, Index, Real


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
        return self.on(self.powers(time), time)

    def powers(self, time: Real) -> Complex:
        """Return e^(rate t), shape (j, t)."""
        with np.errstate(under="ignore"):
            return np.exp(np.multiply.outer(self.rate, time))

    def on(self, power: Complex, time: Real) -> Real:
        """Return the outputs where e^(rate t) is known."""
        value = self.c.real @ power.real - self.c.imag @ power.imag
        n = self.d.shape[1]
        if n:
            value += time * (self.d.real @ power[:n].real - self.d.imag @ power[:n].imag)
        for m in range(self.a.shape[1] - 1, -1, -1):
            if self.a[:, m].any():
                value += np.multiply.outer(self.a[:, m], time**m)
        return np.asarray(value)

    def size(self, first: float, last: float) -> Real:
        """Bound the outputs between two times, shape (outputs,)."""
        growth = np.exp(np.maximum(self.rate.real * first, self.rate.real * last))
        bound = np.abs(self.c) @ growth
        n = self.d.shape[1]
        if n:
            bound += last * (np.abs(self.d) @ growth[:n])
        return np.asarray(bound + np.abs(self.a) @ last ** np.arange(self.a.shape[1]))
