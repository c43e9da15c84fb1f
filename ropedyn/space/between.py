"""Parts at many lines, by polynomials of the frequency between a few of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..base.array import Index, Real
from ..base.chebyshev import fitted
from ..response.bands import between
from .assembly import Parts, parts_at
from .rope import Factors, SpaceRope

NODES = 32
"""Lines between which others are interpolated.

Parts end below 0.69 of their resonances (`GENTLE`), so that from 0 on the error of as many falls by
3.5 with each: 4e-18."""
MISSED = 1e-14
"""The last two coefficients, of the largest entry of a matrix, beyond which a band is halved."""


class Between(NamedTuple):
    """Parts of a component at the lines of a band."""

    weight: Real  # (lines, NODES)
    values: Real  # (NODES, ..) real and imaginary parts beside each other, not scaled
    shape: tuple[int, ...]  # of the matrices of a line
    node: Index
    missed: Real  # (3, parts) shares of the largest entries

    @classmethod
    def of(
        cls, rope: SpaceRope, which: Index, frequency: Real, factors_at: Callable[[Real], Factors]
    ) -> Between:
        """Solve the nodes of increasing frequencies."""
        nodes, weight = between(frequency, NODES)
        factors = factors_at(nodes)
        z = rope.scale(which, np.abs(factors.inertia))
        parts = parts_at(rope, which, factors, z)
        last = np.tensordot(fitted(NODES)[-2:], parts.matrices, axes=(1, 1))
        size = np.abs(parts.matrices).max(axis=(1, 3, 4))
        missed = np.abs(last).max(axis=(0, 3, 4)) / np.where(size > 0, size, 1.0)
        values = np.moveaxis(parts.matrices / _scales(z), 1, 0)
        flat = np.ascontiguousarray(values).reshape(NODES, -1).view(np.float64)
        return cls(weight, flat, values.shape[1:], parts.node, missed)

    def at(self, lines: slice, z: Real) -> Parts:
        """Return the parts at some lines."""
        weight = self.weight[lines]
        values = (weight @ self.values).view(np.complex128)
        matrices = np.moveaxis(values.reshape(len(weight), *self.shape), 0, 1) * _scales(z)
        return Parts(matrices, self.node, self.missed)


def _scales(z: Real) -> Real:
    """Return what scaled D, G and Q are of those in metres and newtons, (3, n, 1, width, width)."""
    one, other = z[:, None, :, None], z[:, None, None, :]
    return np.stack([other / one, 1 / (one * other), one * other])
