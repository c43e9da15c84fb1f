"""Modes as pairs of rates."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.array import Real
from .expansion import Expansion


class Pairs(NamedTuple):
    """Modes q'' + 2 sigma q' + square q = f that move responses by a q + b q'."""

    sigma: Real  # (k,) [1/s]
    square: Real  # (k,) [rad^2/s^2]
    a: Real  # (responses, k)
    b: Real  # (responses, k)

    def derivative(self) -> tuple[Pairs, Real]:
        """Return the pairs of the responses' derivative, and what f itself adds, (responses,)."""
        a, b = -self.b * self.square, self.a - 2 * self.sigma * self.b
        return self._replace(a=a, b=b), self.b.sum(axis=1)


def pairs(expansion: Expansion, drive: int) -> Pairs:
    """Return the modes that a drive moves; r/(s - p) is r (s - p)/(s - p)^2."""
    a, b, p, r = expansion.a[drive], expansion.b[drive], expansion.p, expansion.r[drive]
    return Pairs(
        np.concatenate([expansion.sigma, -p]),
        np.concatenate([expansion.square, p * p]),
        np.concatenate([a, -r * p], axis=1),
        np.concatenate([b, r], axis=1),
    )
