"""Proportional damping: complex modes from undamped ones, in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Complex, Real
from ...chain.chain import Chain
from ...scene.damping import DASHPOT, INERTIA, SPRING
from .rates import Rates, elastic


@dataclass(frozen=True)
class Proportional:
    """The dynamic stiffness (stiff + soften s) K + (s^2 + drag s) M.

    So each undamped mode K phi = lambda M phi has the two rates

        s^2 + (drag + soften lambda) s + stiff lambda = 0
    """

    stiff: complex  # 1 where nothing is damped
    soften: complex  # [s]
    drag: complex  # [1/s]

    def rates(self, eigenvalue: Real) -> Complex:
        """Return both rates of undamped modes, shape (k, 2) [rad/s]."""
        # with p = (drag + soften lambda)/2: -p +- sqrt(p^2 - stiff lambda); where that cancels the
        # smaller is their product over the larger
        p = (self.drag + self.soften * eigenvalue) / 2
        root = np.sqrt(np.asarray(p * p - self.stiff * eigenvalue, dtype=np.complex128))
        root = np.where((root * np.conj(p)).real < 0, -root, root)
        large, small = -p - root, root - p
        cancels = np.abs(small) < np.abs(large) / 2
        np.divide(self.stiff * eigenvalue, large, out=small, where=cancels)
        return np.asarray(np.stack([small, large], axis=-1) + 0.0)  # no -0

    def sensitivity(self, s: Complex, eigenvalue: Real) -> Real:
        """Return |ds/dlambda| = |(stiff + soften s)/(2 s + drag + soften lambda)|."""
        slope = np.abs(2 * s + self.drag + self.soften * eigenvalue)
        change = np.abs(self.stiff + self.soften * s)
        return np.divide(change, slope, out=np.full(slope.shape, np.inf), where=slope > 0)

    def mass_ratio(self, s: Complex, eigenvalue: Real) -> Complex:
        """Return phi^T D'(s) phi/(2 s phi^T M phi)."""
        slope = 2 * s + self.drag + self.soften * eigenvalue
        return np.divide(slope, 2 * s, out=np.ones_like(s), where=s != 0)

    def highest(self, radius: float) -> float:
        """Return a bound of the eigenvalues of modes that have a rate of |s| < radius."""
        room = abs(self.stiff) - abs(self.soften) * radius
        return radius * (radius + abs(self.drag)) / room if room > 0 else np.inf


def proportional(chain: Chain, rates: Rates) -> Proportional | None:
    """Say how the damping of a chain is proportional, or None where it is not."""
    # everything that holds the chain has one factor, and dashpots are to masses everywhere as one
    # number
    parts = elastic(chain)
    if chain.stiffness.any() or (chain.hinge is not None and chain.hinge.any()):
        parts.append(SPRING)
    stiff, soften = rates.constant[parts], rates.linear[parts]
    if (stiff != stiff[0]).any() or (soften != soften[0]).any():
        return None
    ratio = _dashpots_per_mass(chain)
    if ratio is None:
        return None
    # what nodes carry knows no factors but that of inertia
    if chain.carried and (chain.resists or ratio or stiff[0] != 1 or soften[0] != 0):
        return None
    drag = rates.linear[INERTIA] + ratio * rates.linear[DASHPOT]
    return Proportional(complex(stiff[0]), complex(soften[0]), complex(drag))


def _dashpots_per_mass(chain: Chain) -> float | None:
    """Return the one ratio of dashpots to masses [1/s], 0 without any, None of several."""
    if chain.damping is None and chain.drag is None:
        return 0.0
    free = chain.held == 0
    kept = free[:, :, None] & free[:, None, :]
    kept &= np.isin(np.arange(len(free)), chain.term)[:, None, None]
    damping, mass = _or_none(chain.damping, chain.mass)[kept], chain.mass[kept]
    if chain.inertia is not None:
        used = np.unique(chain.element)
        drag = _or_none(chain.drag, chain.inertia)[used].ravel()
        damping = np.concatenate([damping, drag])
        mass = np.concatenate([mass, chain.inertia[used].ravel()])
    return _ratio(damping, mass)


def _or_none(array: Real | None, like: Real) -> Real:
    return np.zeros_like(like) if array is None else array


def _ratio(damping: Real, mass: Real) -> float | None:
    if ((mass == 0) & (damping != 0)).any():
        return None
    moved = mass != 0
    if not moved.any():
        return 0.0
    ratio = damping[moved] / mass[moved]
    # products of the same numbers in another order
    near = np.ptp(ratio) <= 4 * np.finfo(float).eps * np.abs(ratio).max()
    return float(ratio.mean()) if near else None
