"""How probable orders are before frequencies are looked at: what is seen, and what is no mode.

- Modes 1 .. N are excited, P(N) = (1 - g) g^(N - 1); an excited mode n is seen with the chance
  d v_n, d ~ Beta(4, 1), v_n by its shape at the sensors; all odd, or all even, modes may be hidden.
  The lowest modes may lie below the band.
- Peaks that are no mode: their number is Poisson's with a rate r ~ Exp(1), so that m of them have
  the density m!/2^(m + 1)/Lambda^m over a range Lambda of ln f: there is no cap.
- A peak that a record calls a line or weak is rarely a mode.
- The shape of a peak lies within an angle of that of its mode, or anywhere on the sphere.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Flags, Integer, Real

EXCITED = 0.85  # g
SEEN = 4.0  # d ~ Beta(4, 1)
HIDDEN = 0.07  # All odd modes are hidden with this probability, and so are all even ones.
LOW, CUT = 0.02, 0.9  # The band begins above mode c with this probability, c geometric too.
NODES = 16  # Of Gauss's rule over d: exact for up to 28 modes.
NARROWEST = float(np.log(2.0))  # Of the range in which strays fall.
AS_MODE = {"mode": 1.0, "double": 1.0, "weak": 0.1, "line": 0.02}
"""How much more rarely a mode looks like this than a peak that is none."""


@dataclass(frozen=True, eq=False)
class Chances:
    """What is known of modes 1 .. N and k peaks."""

    visible: Real  # (N,) v_n
    span: float  # Lambda
    of_mode: Real  # (k, N) ln of how much likelier kind and shape are of a mode than of none

    @classmethod
    def of(cls, visible: Real, frequency: Real, of_mode: Real) -> Chances:
        """Take the range of frequencies from peaks in increasing order."""
        span = max(float(np.log(frequency[-1] / frequency[0])), NARROWEST)
        return cls(visible, span, of_mode)

    def __call__(self, orders: Integer) -> Real:
        """Return ln of the probability of orders, (n, k), with the density of strays."""
        from scipy.special import gammaln

        used = orders > 0
        strays = (~used).sum(axis=1)
        chance = gammaln(strays + 1) - (strays + 1) * np.log(2.0) - strays * np.log(self.span)
        each = np.take_along_axis(self.of_mode[None], np.maximum(orders - 1, 0)[:, :, None], 2)
        return chance + np.where(used, each[:, :, 0], 0.0).sum(axis=1) + self.detection(orders)

    def detection(self, orders: Integer) -> Real:
        """Return ln of the probability that these modes, and no others, are seen."""
        seen = np.zeros((len(orders), len(self.visible) + 1), dtype=bool)
        np.put_along_axis(seen, orders, True, axis=1)
        seen = seen[:, 1:]
        odd = np.arange(1, len(self.visible) + 1) % 2 == 1
        chance = (1 - 2 * HIDDEN - LOW) * _seen(seen, self.visible)
        for shown in odd, ~odd:
            # of modes that are hidden none is seen, and the others are excited as if all were there
            there = ~(seen & ~shown).any(axis=1)
            chance += HIDDEN * there * _seen(seen[:, shown], self.visible[shown])
        return np.log(chance + LOW * self._above(seen))

    def _above(self, seen: Flags) -> Real:
        """Return the same where all modes below the lowest that is seen are beyond the band."""
        modes = seen.shape[1]
        cut = seen.argmax(axis=1)
        at = cut[:, None] + np.arange(modes)
        shifted = np.take_along_axis(seen, np.minimum(at, modes - 1), axis=1) & (at < modes)
        return (1 - CUT) * CUT ** (cut - 1.0) * (cut > 0) * _seen(shifted, self.visible)


def _seen(seen: Flags, visible: Real) -> Real:
    """Return the probability of what is seen, (n, modes), over d and the highest excited mode."""
    node, weight = np.polynomial.legendre.leggauss(NODES)
    d, modes = (1 + node) / 2, np.arange(1, len(visible) + 1)
    weight = weight / 2 * SEEN * d ** (SEEN - 1)
    each = d[:, None] * visible
    chance = np.where(seen[:, None, :], each, 1 - each).cumprod(axis=2)
    highest = np.where(seen, modes, 0).max(axis=1, initial=0)
    excited = (1 - EXCITED) * EXCITED ** (modes - 1) * (modes >= highest[:, None])
    return np.einsum("q,nqm,nm->n", weight, chance, excited)
