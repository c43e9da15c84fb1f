"""Stiffness and inertia of a section from its wires.

Strains are extension, twist per length and relative growth of radii; K is (..., 3, 3), EA, D and C
in its first two rows, and has the energy of a length of rope e K e/2. Elements of a rope keep
their radii; wires are Euler-Bernoulli bars.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.array import Real
from .strand import Bar, Helix, Number, Ring, Strand

SLIP, STICK, STRAIGHT = TORSIONS = ("slip", "stick", "straight")

PHASE = 2 * np.pi * np.arange(32) / 32
"""Places of a wire around its strand; means of smooth periodic functions converge at once."""


class Inertia(NamedTuple):
    """Per length of rope."""

    mass: Number  # [kg/m]
    polar: Number  # [kg m]
    rotary: Number  # about a diameter, mean over the lay [kg m]
    area: Number  # of wires, each across its own axis [m^2]


def outer(one: Real, other: Real) -> Real:
    """Return products of rows."""
    return one[..., :, None] * other[..., None, :]


def both(one: Real, other: Real) -> Real:
    """Return the symmetric sum of products of rows."""
    product = outer(one, other)
    return product + np.swapaxes(product, -1, -2)


def weighed(number: Number, matrix: Real) -> Real:
    """Return matrices times numbers."""
    return np.asarray(number)[..., None, None] * matrix


def _along_axis(EA: Number, C: Number) -> Real:
    """Return K of a straight bar."""
    K = np.zeros((*np.shape(EA + C), 3, 3))
    K[..., 0, 0], K[..., 1, 1] = EA, C
    return K


def torsion(element: Bar | Strand, state: str) -> Real:
    """Return K: wires slip in their strands, stick, or strands are straight bundles on helices."""
    if isinstance(element, Bar):
        return _along_axis(element.EA, element.C)
    axis: Real = sum((_along_axis(bar.EA, bar.C) for bar in element.bars), np.zeros((3, 3)))
    return sum((_ring_torsion(ring, state) for ring in element.rings), axis)


def _ring_torsion(ring: Ring, state: str) -> Real:
    """K += n/S [EA a a + D (a h + h a) + C h h + B g g] with D, C, B of the element."""
    on, element = ring.on, ring.element
    if isinstance(element, Bar) or state == STRAIGHT:
        K = _on_helix(torsion(element, STRAIGHT), on)
    else:
        K = _on_helix(_without_tension(element), on) + _wire_tension(element, on, state)
    K = K + weighed(bending_slip(element), outer(on.g, on.g))
    return weighed(ring.n / on.S, K)


def _on_helix(of_strand: Real, on: Helix) -> Real:
    """Return what K of a strand along its own axis gives for strains of the rope."""
    EA, D, C = of_strand[..., 0, 0], of_strand[..., 0, 1], of_strand[..., 1, 1]
    K = weighed(EA, outer(on.a, on.a)) + weighed(D, both(on.a, on.h))
    return K + weighed(C, outer(on.h, on.h))


def _without_tension(strand: Strand) -> Real:
    """Return K of a straight strand whose wires bend and twist alone."""
    K: Real = sum((_along_axis(0 * bar.EA, bar.C) for bar in strand.bars), np.zeros((3, 3)))
    for ring in strand.rings:
        on, wire = ring.on, _wire(ring)
        bent = weighed(wire.C, outer(on.h, on.h)) + weighed(wire.B, outer(on.g, on.g))
        K = K + weighed(ring.n / on.S, bent)
    return K


def _wire_tension(strand: Strand, on: Helix, state: str) -> Real:
    """Return K of the tension of wires in double helices, per length of the strand.

    dl = ((1 - k0 rho cos) a - rho cos (1 - k0 rho cos) g + rho^2 q h)/l0, of a wire on the
    radius rho of a strand with the curvature k0, l0 its length per length of strand.
    """
    EA = sum(bar.EA for bar in strand.bars)
    K = weighed(EA, outer(on.a, on.a))
    for ring in strand.rings:
        near, sideways, across, l0 = _double_helix(ring, on)
        a, g, h = (row[..., None, :] for row in (on.a, on.g, on.h))
        dl = (near[..., None] * (a - sideways[..., None] * g) + across * h) / l0[..., None]
        if state == SLIP:
            mean = dl.mean(axis=-2)
            of_wires = weighed(1 / l0.mean(axis=-1), outer(mean, mean))
        else:
            of_wires = np.swapaxes(dl, -1, -2) @ (dl / l0[..., None]) / len(PHASE)
        K = K + weighed(ring.n * _wire(ring).EA, of_wires)
    return K


def _double_helix(ring: Ring, on: Helix) -> tuple[Real, Real, Real, Real]:
    """Return 1 - k0 rho cos, rho cos, rho^2 q (..., 1, 1) and l0 at places around the strand."""
    rho, q = (np.asarray(v)[..., None] for v in (ring.on.radius, ring.on.turn))
    sideways = rho * np.cos(PHASE)
    near = 1 - np.asarray(on.curvature)[..., None] * sideways
    return near, sideways, (rho * rho * q)[..., None], np.hypot(near, rho * q)


def _wire(ring: Ring) -> Bar:
    """Return the wire of a ring of a strand: there are no strands of strands."""
    assert isinstance(ring.element, Bar)
    return ring.element


def bending_slip(element: Bar | Strand) -> Number:
    """Return B where every wire slides: helical springs side by side, nested.

    n 2 S/((1 + S^2)/B + c^2 S22) of elements whose twist per torque is S22 where tension is free.
    """
    if isinstance(element, Bar):
        return element.B
    B = sum(bar.B for bar in element.bars)
    for ring in element.rings:
        on = ring.on
        bent, turned = (1 + on.S * on.S) / bending_slip(ring.element), _free_twist(ring.element)
        B = B + ring.n * 2 * on.S / (bent + on.c * on.c * turned)
    return B


def _free_twist(element: Bar | Strand) -> Number:
    """Return twist per torque where tension is free: EA/(EA C - D^2)."""
    if isinstance(element, Bar):
        return 1 / element.C
    K = torsion(element, STRAIGHT)
    EA, D, C = K[..., 0, 0], K[..., 0, 1], K[..., 1, 1]
    return EA / (EA * C - D * D)


def bending_tension(strand: Strand) -> list[Number]:
    """Return what the tension of wires adds to B where they stick, of each ring.

    n/2 EA r^2 S^3 of wires in single helices; in double ones n/S sum EA <y^2 z'^4/l0^3> with
    y^2 = [(r - rho cos)^2 + (rho S sin)^2]/2 and z' = S (1 - k0 rho cos) + rho q c cos.
    """
    return [ring_bending(ring) for ring in strand.rings]


def ring_bending(ring: Ring) -> Number:
    """Return what the tension of wires adds to B where they stick, of one ring."""
    on = ring.on
    if isinstance(ring.element, Bar):
        return single(ring, ring.element.EA)
    B = single(ring, sum(bar.EA for bar in ring.element.bars))
    for inner in ring.element.rings:
        near, sideways, _, l0 = _double_helix(inner, on)
        S, c, radius, rho, q = (
            np.asarray(v)[..., None]
            for v in (on.S, on.c, on.radius, inner.on.radius, inner.on.turn)
        )
        y2 = ((radius - sideways) ** 2 + (rho * S * np.sin(PHASE)) ** 2) / 2
        along = S * near + q * c * sideways
        mean = (y2 * along**4 / l0**3).mean(axis=-1)
        B = B + ring.n / on.S * inner.n * _wire(inner).EA * mean
    return B


def single(ring: Ring, EA: Number) -> Number:
    """Return n/2 EA r^2 S^3, of elements that stick in single helices."""
    return ring.n / 2 * EA * ring.on.radius**2 * ring.on.S**3


def inertia(element: Bar | Strand) -> Inertia:
    """Return mass and inertias; of strands as if they were straight along their helix.

    mass += n/S m, polar += n/S (m r^2 + p), rotary += n/S [m r^2/2 + (p c^2 + j (2 - c^2))/2]
    """
    if isinstance(element, Bar):
        return Inertia(element.mass, element.polar, element.polar / 2, element.area)
    parts = [inertia(bar) for bar in element.bars]
    for ring in element.rings:
        on, (m, p, j, A) = ring.on, inertia(ring.element)
        n, at, c2 = ring.n / on.S, m * on.radius**2, on.c * on.c
        rotary = (at + p * c2 + j * (2 - c2)) / 2
        parts.append(Inertia(n * m, n * (at + p), n * rotary, ring.n * A))
    return Inertia(*map(sum, zip(*parts)))


def double_helix_mass(strand: Strand) -> Number:
    """Return the mass with the exact lengths of double helices [kg/m]."""
    mass = sum(bar.mass for bar in strand.bars)
    for ring in strand.rings:
        on, n = ring.on, ring.n / ring.on.S
        if isinstance(ring.element, Bar):
            mass = mass + n * ring.element.mass
            continue
        of_strand = sum(bar.mass for bar in ring.element.bars)
        for inner in ring.element.rings:
            length = _double_helix(inner, on)[-1].mean(axis=-1)
            of_strand = of_strand + inner.n * _wire(inner).mass * length
        mass = mass + n * of_strand
    return mass


def held_by_core(K: Real, radial: Number | None) -> Real:
    """Return EA, D, C where the core resists growth of radii by energy radial eta^2/2 [N].

    None: radii are kept.
    """
    rigid = K[..., :2, :2]
    if radial is None:
        return rigid
    to_radii = K[..., :2, 2]
    return rigid - weighed(1 / (K[..., 2, 2] + radial), outer(to_radii, to_radii))
