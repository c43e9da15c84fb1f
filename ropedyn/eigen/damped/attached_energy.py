"""Energies of the structures that nodes carry, in damped motion."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.polynomial import legendre

from ... import _core
from ...base.array import Complex, Real
from ...chain.chain import ATTACHED, Chain
from ...scene.damping import DASHPOT, INERTIA

LEAST = 12  # The curvature of a wire whose waves are long has so many polynomials.
MOST = 120
"""Polynomials of forty half waves; energies of shorter waves are those of smoother motion."""
WIRE = ATTACHED.index("broken wire")


class AttachedEnergy(NamedTuple):
    """What structures have in some motions of a chain."""

    # (kinds, k, 3) of each kind in `ATTACHED`: twice the strain energy, what they add to the modal
    # mass, and losses, of undamped modes alone
    energy: Real
    motion: Real  # (k,) the largest of any

    @classmethod
    def none(cls, count: int) -> AttachedEnergy:
        """Return those of nothing."""
        return cls(np.zeros((len(ATTACHED), count, 3)), np.zeros(count))

    @classmethod
    def real(cls, chain: Chain, shape: Real, motion: Real, eigenvalue: Real) -> AttachedEnergy:
        """Return those of undamped modes, whose own motion is known."""
        every = cls.none(len(shape))
        for plane in chain.planes if chain.carried else ():
            part, u = plane.chain, np.ascontiguousarray(shape[..., plane.kept])
            for kind in part.carried:
                these = part.carries(kind)
                own = np.ascontiguousarray(motion[:, plane.carried][:, these])
                # nodes alone carry them: how the tension grows between is nothing to them
                nodes = part.carrying(these)._replace(rise=None)
                energy = _core.carried(nodes, u, own, eigenvalue)
                every.energy[ATTACHED.index(kind)] += energy
        np.abs(motion).max(axis=1, initial=0.0, out=every.motion)
        return every

    def of(self, chain: Chain) -> Real:
        """Return the energies of the kinds that a chain carries, shape (kinds, k, 3)."""
        return self.energy[[ATTACHED.index(kind) for kind in chain.carried]]

    @classmethod
    def at(cls, chain: Chain, factor: Complex, shape: Complex) -> AttachedEnergy:
        """Return those of shapes, (k, nodes, width), with the factors (5, k) of their rates."""
        every = cls.none(len(shape))
        if chain.attached_kind is None:
            return every
        assert chain.attached_row is not None
        assert chain.attached_value is not None
        factor = np.ascontiguousarray(factor)
        for k, kind in enumerate(chain.attached_kind):
            foot_at = chain.feet[k]
            if foot_at < 0:
                continue
            moved = shape[:, foot_at]
            foot = moved @ chain.attached_row[k].T
            tip = np.abs((_core.tip(chain, k, factor)[0].T * foot).sum(axis=1))
            np.maximum(every.motion, tip, out=every.motion)
            value = chain.attached_value[k]
            if kind == WIRE:
                strain, kinetic = _wire(value, factor[INERTIA], foot)
            else:
                strain, kinetic = _resonator(value, factor[INERTIA], factor[DASHPOT], foot[:, 0])
            every.energy[kind, :, 0] += strain
            every.energy[kind, :, 1] += kinetic
        return every


def _resonator(value: Real, inertia: Complex, dashpot: Complex, foot: Complex) -> tuple[Real, Real]:
    """Twice k |Y - u|^2/2 and m |Y|^2, Y = k' u/(k' + m s^2) and k' = k + c s."""
    mass, spring, _, drag = value
    stiff = spring + drag * dashpot
    moved = foot / (stiff + mass * inertia)
    return spring * np.abs(mass * inertia * moved) ** 2, mass * np.abs(stiff * moved) ** 2


def _wire(value: Real, inertia: Complex, foot: Complex) -> tuple[Real, Real]:
    """Energies of a cantilever with a free tip by Galerkin's method."""
    # with xi = x/l and w = u + l beta xi + sum of a_j phi_j, phi_j'' = P_j(2 xi - 1) and phi_j =
    # phi_j' = 0 at the root: k (1 + 2 i z) a_j/(2 j + 1) + s^2 m (integral of phi_j w) = 0
    mass, spring, length, ratio = value
    waves = float((np.abs(inertia) * mass / spring).max(initial=0.0) ** 0.25)
    count = min(LEAST + int(waves), MOST)
    node, weight = legendre.leggauss(count + 2)
    xi, weight = (node + 1) / 2, weight / 2
    phi = _bent(count, node)
    stiff = 1 / (2 * np.arange(count) + 1)
    square: Real = (phi * weight) @ phi.T
    still = foot[:, :1] + length * foot[:, 1:] * xi
    ratio_of = (inertia * mass / (spring * (1 + 2j * ratio)))[:, None]
    system = np.diag(stiff) + ratio_of[:, :, None] * square
    bent = np.linalg.solve(system, (-ratio_of * (still @ (phi * weight).T))[:, :, None])[:, :, 0]
    moved = still + bent @ phi
    strain = spring * (np.abs(bent) ** 2 @ stiff)
    return strain, mass * (np.abs(moved) ** 2 @ weight)


def _bent(count: int, node: Real) -> Real:
    """Return phi_j at t = 2 xi - 1, integrated twice with dxi = dt/2; shape (count, nodes)."""
    twice = [legendre.legint(np.eye(count)[j], m=2, lbnd=-1) / 4 for j in range(count)]
    return np.stack([legendre.legval(node, one) for one in twice])
