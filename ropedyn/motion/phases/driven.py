"""Motion of a phase under what drives it, in closed form.

    z' = p z + g(t):  z = (z_0 - sum_m Z_m - a_0) e^(p t) + sum_m Z_m e^(eta_m t) + a_0 + a_1 t

where nothing nearly cancels; forces near a pole make t e^(rate t), poles near 0 a polynomial.
"""

from __future__ import annotations

from math import factorial
from typing import NamedTuple

import numpy as np

from ...base.array import Complex, Index, Real
from .course import Course

SLOW, POWERS = 3e-3, 8
"""A pole this close to 0 over the time ahead is a polynomial of so many powers of t."""
CLOSE = 1e-5  # A force this close to a pole over the time ahead makes t e^(rate t).


class Forcing(NamedTuple):
    """Re(wave e^(rate t)) + level + slope t, of each drive."""

    rate: Complex  # (m,) [1/s]
    wave: Complex  # (drives, m)
    level: Real  # (drives,)
    slope: Real  # (drives,)

    def at(self, time: Real) -> Real:
        """Return the forces at times (t,), shape (drives, t)."""
        wave = (self.wave @ np.exp(np.multiply.outer(self.rate, time))).real
        return np.asarray(wave + self.level[:, None] + np.multiply.outer(self.slope, time))


class UnderDrives(NamedTuple):
    """z over time, as in the head of the file."""

    first: Real  # (j,) size of what z is the sum of at the beginning
    push: Forcing
    fixed: Real  # s
    rates: Complex  # all: between what is near, of the poles, of the drives
    own: Complex  # (j,) of e^(p t)
    forced: Complex  # (j, 2 m) of the drives' rates and their conjugates
    near: tuple[Index, Index]  # which poles and which of these rates
    grows: Complex  # (near,) of t e^(rate t)
    power: Complex  # (j, powers) of t

    def seen(self, rows: Complex, Dd: Real, Ds: Real) -> Course:
        """Return Re(rows z) + Dd f_d + Ds s."""
        push, j = self.push, self.near[0]
        eta = rows @ self.forced
        m = len(push.rate)
        eta[:, :m] += Dd @ push.wave
        c = np.concatenate([np.zeros((len(rows), len(j))), rows * self.own, eta], axis=1)
        a = (rows @ self.power).real
        a[:, 0] += Dd @ push.level + Ds @ self.fixed
        a[:, 1] += Dd @ push.slope
        return Course(self.rates, c, rows[:, j] * self.grows, a)

    def at(self, time: float) -> Complex:
        """Return z at a time."""
        n, j = len(self.near[0]), len(self.own)
        power = np.exp(self.rates * time)
        z = self.own * power[n : n + j] + self.forced @ power[n + j :]
        z += self.power @ time ** np.arange(POWERS)
        np.add.at(z, self.near[0], self.grows * time * power[:n])
        return np.asarray(z)


def drive(
    p: Complex,
    driven: Complex,
    z: Complex,
    push: Forcing,
    *,
    fixed: Real,
    held: Complex,
    ahead: float,
) -> UnderDrives:
    """Return the motion from z on while nothing happens, for a time.

    p (j,) the poles; driven (j, drives) and held (j,) how drives and what is fixed push them.
    """
    eta = np.concatenate([push.rate, push.rate.conj()])
    forced = driven @ np.concatenate([push.wave, push.wave.conj()], axis=1) / 2
    gap = eta - p[:, None]
    one, other = np.nonzero((np.abs(gap) * ahead < CLOSE) & (forced != 0))
    near = one, other
    grows = forced[near]
    forced = np.divide(forced, gap, out=np.zeros_like(forced), where=gap != 0)
    forced[near] = 0.0
    own = z - forced.sum(axis=1)
    level = driven @ push.level + held
    slope = driven @ push.slope
    power = np.zeros((len(p), POWERS), dtype=np.complex128)
    slow = np.abs(p) * ahead < SLOW
    fast = ~slow
    power[fast, 1] = -slope[fast] / p[fast]
    power[fast, 0] = (power[fast, 1] - level[fast]) / p[fast]
    own[fast] -= power[fast, 0]
    if slow.any():
        power[slow] = _expanded(p[slow], (own[slow], level[slow], slope[slow]))
        own[slow] = 0.0
    rates = np.concatenate([(p[one] + eta[other]) / 2, p, eta])
    return UnderDrives(np.abs(z), push, fixed, rates, own, forced, near, grows, power)


def _expanded(p: Complex, values: tuple[Complex, Complex, Complex]) -> Complex:
    """Return the powers of t of z_0, a level and a slope that poles near 0 integrate."""
    power = np.zeros((len(p), POWERS), dtype=np.complex128)
    for m in range(POWERS):
        for shift, value in enumerate(values[: m + 1]):
            power[:, m] += value * p ** (m - shift) / factorial(m)
    return power
