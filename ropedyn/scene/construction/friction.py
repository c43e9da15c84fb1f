"""Bending with friction: layers stick until the tension of their wires can hold them no longer.

Each layer adds b kappa to the moment where it sticks. Around the rope, from the neutral axis, wires
slip up to theta*, and there their tension grows by what friction carries:

    theta* = 0 below kappa_1, sin theta*/theta* = kappa_1/kappa, pi/2 beyond pi/2 kappa_1
    M = 4 b/pi [kappa_1 (sin theta* - theta* cos theta*)
                + kappa (pi/4 - theta*/2 + sin(2 theta*)/4)]
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.array import Real
from . import stiffness
from .strand import Bar, Ring, Strand

NEWTON = 8  # Steps, whose number of right digits doubles from about one.
LEAST = 1e-14  # A square of an angle below which sin x/x is 1.


class Grip(NamedTuple):
    """Layers that stick: what each adds to the bending stiffness, and from where it slips."""

    stiffness: Real  # (k,) [N m^2]
    first: Real  # (k,) kappa_1 [1/m]

    def moment(self, curvature: Real) -> Real:
        """Return what they add to the moment at curvatures >= 0 [N m]."""
        kappa, theta, sin_less = self._slipping(curvature)
        stuck = np.pi / 4 - theta / 2 + np.sin(2 * theta) / 4
        return 4 / np.pi * (self.first * sin_less + kappa * stuck) @ self.stiffness

    def loss(self, curvature: Real) -> Real:
        """Return the work lost per cycle and length between curvatures of both signs [N].

        8 (int_0^a M - M(a) a/2) of loops that are the first curve doubled (Masing).
        """
        kappa, theta, sin_less = self._slipping(curvature)
        lost = self.first * kappa * sin_less / 2 - self.first**2 * theta**3 / 6
        return 32 / np.pi * lost @ self.stiffness

    def _slipping(self, curvature: Real) -> tuple[Real, Real, Real]:
        """Return curvatures (..., 1), theta* (..., k) and sin theta* - theta* cos theta*."""
        kappa = np.asarray(curvature)[..., None]
        slips = kappa > self.first
        share = np.divide(self.first, kappa, out=np.ones(slips.shape), where=slips)
        theta = slip_angle(share)
        return kappa, theta, np.sin(theta) - theta * np.cos(theta)


def slip_angle(share: Real) -> Real:
    """Return theta where sin theta/theta is a share of 1, pi/2 where it is less than 2/pi."""
    inside = np.maximum(share, 2 / np.pi)
    # in t = theta^2 it is 1 - t/6 + .., nearly straight
    t = 6 * (1 - inside) * (1 + 0.3 * (1 - inside))
    for _ in range(NEWTON):
        root = np.sqrt(np.maximum(t, LEAST))
        of_t, slope = np.sin(root) / root, (np.cos(root) - np.sin(root) / root) / (2 * root**2)
        t = np.where(t > LEAST, t - (of_t - inside) / np.where(slope < 0, slope, -1 / 6), t)
    return np.where(share <= 2 / np.pi, np.pi / 2, np.sqrt(np.maximum(t, 0.0)))


class Held(NamedTuple):
    """A ring under tension: what sticking adds to B, the pull in each element, where it slips."""

    bonded: float  # n/2 EA r^2 S^3 [N m^2]
    tension: float  # of an element [N]
    first: float  # kappa_1 [1/m]


def grip(strand: Strand, tension: float, friction: float, lateral: float) -> Grip:
    """Return the layers of a rope whose ends do not turn, those in its strands as a second level.

    What sticking wires add to B beyond strands as wholes is shared among the layers of strands by
    n/2 EA r^2 S^3 of each.
    """
    rows: list[tuple[float, float]] = []
    for ring, one in zip(strand.rings, _held(strand, tension, friction, lateral)):
        rows.append((one.bonded, one.first))
        if not isinstance(ring.element, Bar):
            rest = stiffness.ring_bending(ring) - one.bonded
            inner = _held(ring.element, one.tension, friction, lateral)
            whole = sum(layer.bonded for layer in inner)
            rows += [(rest * layer.bonded / whole, layer.first) for layer in inner]
    table = np.array(rows, dtype=np.float64).reshape(-1, 2)
    return Grip(table[:, 0], table[:, 1])


def tension_stiffness(strand: Strand) -> float:
    """Return sum n EA S^3, the core's too: tension per strain of helices that carry it alone."""
    core = sum(bar.EA for bar in strand.bars)
    return float(core + sum(ring.n * _EA(ring) * ring.on.S**3 for ring in strand.rings))


def _EA(ring: Ring) -> float:
    """Return that of an element along its own axis."""
    return float(stiffness.torsion(ring.element, stiffness.STRAIGHT)[0, 0])


def _held(strand: Strand, tension: float, friction: float, lateral: float) -> list[Held]:
    """Return the rings of a strand, on which those outside press.

    t = EA S^2 T/sum, q = t c^2/r, Q_i = sum_{j > i} (n_j q_j/S_j)/(n_i/S_i),
    kappa_1 = friction (q + lateral Q)/(|c| EA S^2)
    """
    strain = tension / tension_stiffness(strand)
    pressed, found = 0.0, []
    for ring in reversed(strand.rings):
        on, EA = ring.on, _EA(ring)
        pull = EA * on.S**2 * strain
        load, share = pull * on.curvature, ring.n / on.S
        grips = friction * (load + lateral * pressed / share)
        found.append(Held(stiffness.single(ring, EA), pull, grips / (abs(on.c) * EA * on.S**2)))
        pressed += share * load
    return found[::-1]
