"""Random sections of a construction: what is not known of its numbers, drawn together."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.array import Real
from . import stiffness
from .strand import Bar, Number, Ring, Strand, helix

BLOCK = 256  # Draws that are computed together, so that they stay in the cache.


class Scatter(NamedTuple):
    """Factors on the numbers of a construction, an entry for each draw."""

    modulus: Real
    size: Real  # of diameters and radii
    lays: tuple[Real, Real]  # of layers of the rope, and of those in its strands
    core: Real  # stiffness of the core against growth of radii, per EA at fixed radii
    stick: Real  # 0 where wires slip in torsion, 1 where they stick
    grip: Real  # the same in bending, on a logarithmic scale

    def block(self, at: slice) -> Scatter:
        """Return some of the draws."""
        one, two = self.lays
        return Scatter(
            self.modulus[at],
            self.size[at],
            (one[at], two[at]),
            self.core[at],
            self.stick[at],
            self.grip[at],
        )


def sections(strand: Strand, scatter: Scatter) -> Real:
    """Return EA, D, C and B of each draw, shape (n, 4)."""
    n = len(scatter.modulus)
    blocks = [slice(at, min(at + BLOCK, n)) for at in range(0, n, BLOCK)]
    return np.concatenate([_sections(strand, scatter.block(at)) for at in blocks])


def _sections(strand: Strand, scatter: Scatter) -> Real:
    drawn = _drawn(strand, scatter, 0)
    slip, stick = (stiffness.torsion(drawn, state) for state in (stiffness.SLIP, stiffness.STICK))
    K = slip + scatter.stick[:, None, None] * (stick - slip)
    K = stiffness.held_by_core(K, scatter.core * K[:, 0, 0])
    least = stiffness.bending_slip(drawn)
    most = least + sum(stiffness.bending_tension(drawn))
    B = least * (most / least) ** scatter.grip
    return np.stack([K[:, 0, 0], K[:, 0, 1], K[:, 1, 1], B], axis=-1)


def _drawn(strand: Strand, scatter: Scatter, level: int) -> Strand:
    """Return a strand whose numbers are arrays over draws."""
    bars = tuple(_bar(bar, scatter) for bar in strand.bars)
    return Strand(bars, tuple(_ring(ring, scatter, level) for ring in strand.rings), strand.core)


def _ring(ring: Ring, scatter: Scatter, level: int) -> Ring:
    lay = 2 * np.pi / abs(ring.on.turn) * scatter.lays[level]
    on = helix(ring.on.radius * scatter.size, lay, int(np.sign(ring.on.turn)))
    if isinstance(ring.element, Bar):
        return Ring(ring.n, _bar(ring.element, scatter), on)
    return Ring(ring.n, _drawn(ring.element, scatter, 1), on)


def _bar(bar: Bar, scatter: Scatter) -> Bar:
    E, area = scatter.modulus, scatter.size**2
    inertia: Number = area * area
    return Bar(
        bar.EA * E * area,
        bar.C * E * inertia,
        bar.B * E * inertia,
        bar.mass * area,
        bar.polar * inertia,
        bar.area * area,
        bar.diameter * scatter.size,
    )
