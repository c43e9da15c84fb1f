"""Parts at many lines, by polynomials of the frequency between a few of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..base.array import Index, Real
from ..base.chebyshev import fitted
from ..response.bands import between
from .assembly import ROUNDINGS, SpaceParts, parts_at
from .rope import Factors, SpaceRope

NODES = 40  # Of a band. Parts end below their resonances; of strings, the nearest, 32 left 1e-14.
MISSED = 1e-14
"""The last two coefficients, of the largest entry of a matrix, beyond which a band is halved."""

TOGETHER = 64  # Numbers of a line in a product: of more, threads of BLAS wait for each other.


class Between(NamedTuple):
    """Parts of a component at the lines of a band."""

    weight: Real  # (lines, NODES)
    values: Real  # (3, NODES, ..) real and imaginary parts beside each other, not scaled
    shape: tuple[int, ...]  # of each three of a line, (parts, width, width), none twice
    alike: Index
    node: Index
    missed: Real  # (3, parts) shares of the largest entries
    most: Real  # (3, 1, parts, width, width) of entries at all nodes, not scaled

    @classmethod
    def of(
        cls, rope: SpaceRope, which: Index, frequency: Real, factors_at: Callable[[Real], Factors]
    ) -> Between:
        """Solve the nodes of increasing frequencies."""
        nodes, weight = between(frequency, NODES)
        factors = factors_at(nodes)
        z = rope.scale(which, np.abs(factors.inertia))
        parts = parts_at(rope, which, factors, z)
        values = parts.matrices / _scales(z)
        # scales of lines of their own are no polynomials
        last = np.tensordot(fitted(NODES)[-2:], values, axes=(1, 1)) * _scales(z[-1:])[:, 0]
        size = np.abs(values * _scales(z[-1:])).max(axis=(1, 3, 4))
        missed = np.abs(last).max(axis=(0, 3, 4)) / np.where(size > 0, size, 1.0)
        flat = values.reshape(3, NODES, -1).view(np.float64)
        most = np.abs(values).max(axis=1, keepdims=True)
        return cls(weight, flat, values.shape[2:], parts.alike, parts.node, missed, most)

    def at(self, lines: slice, z: Real) -> SpaceParts:
        """Return the parts at some lines."""
        weight, width = self.weight[lines], self.shape[-1]
        found = np.empty((3, len(weight), self.values.shape[2]))
        for k, values in enumerate(self.values):
            for first in range(0, values.shape[1], TOGETHER):
                some = np.s_[:, first : first + TOGETHER]
                np.matmul(weight, values[some], out=found[k][some])
        # real and imaginary parts beside each other
        pairs = found.reshape(3, len(weight), -1, 2 * width**2)
        pairs *= np.repeat(_scales(z).reshape(3, len(weight), 1, -1), 2, axis=3)
        matrices = found.view(np.complex128).reshape(3, len(weight), *self.shape)
        # what is small at a line has the roundings of what is large at others
        size = (self.most * _scales(z)).max(axis=(3, 4))
        known = size * (1 + self.missed[:, None] / (ROUNDINGS * np.finfo(float).eps))
        return SpaceParts(matrices, self.alike, self.node, known)


def _scales(z: Real) -> Real:
    """Return what scaled D, G and Q are of those in metres and newtons, (3, n, 1, width, width)."""
    one, other = z[:, None, :, None], z[:, None, None, :]
    return np.stack([other / one, 1 / (one * other), one * other])
