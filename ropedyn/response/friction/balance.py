"""The balance of a rope whose layers slip, at the frequency of the drive alone.

The rope with sticking wires answers to the drive and, in each cell, to the moment that lacks,

    kappa = kappa_F - G g(|kappa|) kappa,  g = M_1/a - sum b of the layers,

G the curvatures of cells under pairs of moments at their ends, H of `frf` between the rotations
there. Unknown is the complex amplitude kappa of the mean curvature of each cell.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...base.array import Complex, Real
from .loops import Loops, loops

ENOUGH = 1e-9  # Of the largest curvature: the change at which motion is found.
NEWTON = 15  # Steps at most.
BALANCED = 1e-7  # Of it: what may be missing.
SAME = 1e-4  # Motions that differ by less are one, relative.
SHARES = np.geomspace(1e-3, 1.0, 40)  # Of the amplitude, by which it is raised from rest.


class Layers(NamedTuple):
    """What sticks in each cell."""

    stiffness: Real  # (cells, k) [N m^2]
    first: Real  # (cells, k) curvature from which it slips [1/m]

    def at(self, amplitude: Real) -> Loops:
        """Return the harmonics of their moments."""
        return loops(self.stiffness, self.first, amplitude)

    @property
    def whole(self) -> Real:
        """What all add where they stick, (cells,)."""
        return np.asarray(self.stiffness.sum(axis=1))


class SlipMotion(NamedTuple):
    """The motion at one frequency."""

    kappa: Complex  # (cells,)
    several: bool  # whether there is another


@dataclass(frozen=True, eq=False)
class SlipBalance:
    """One frequency."""

    layers: Layers
    driven: Complex  # (cells,) kappa_F [1/m]
    moved: Complex  # (cells, cells) G [1/(m N m)]

    def lack(self, kappa: Complex) -> Complex:
        """Return the moments that lack, g kappa [N m]."""
        return (self.layers.at(np.abs(kappa)).first - self.layers.whole) * kappa

    def found(self, near: list[Complex], *, alone: bool) -> SlipMotion | None:
        """Return the motion that is reached from rest, and whether there is another.

        Looked for from neighbouring motion and, unless that is enough alone, from wires that all
        stick and that all slide.
        """
        starts = near if alone else [*near, self.driven, self.sliding()]
        reached = [one for one in map(self.solved, starts) if one is not None]
        apart = [np.abs(one - reached[0]).max() for one in reached[1:]]
        if reached and max(apart, default=0.0) <= SAME * np.abs(reached[0]).max():
            return SlipMotion(reached[0], False)
        raised = self.raised()
        return None if raised is None else SlipMotion(raised, bool(reached))

    def solved(self, start: Complex, share: float = 1.0) -> Complex | None:
        """Return the curvatures near some, under a share of the drive; None if none are found."""
        kappa = start
        for _ in range(NEWTON):
            missing, slope = self._about(kappa, share)
            step = np.linalg.solve(slope, -np.concatenate([missing.real, missing.imag]))
            kappa = kappa + _whole(step)
            if np.abs(step).max() <= ENOUGH * np.abs(kappa).max():
                return kappa
        return self._searched(start, share)

    def _searched(self, start: Complex, share: float) -> Complex | None:
        """Return them where Newton's steps lead too far: those of Powell's method do not."""
        from scipy.optimize import root

        scale = float(np.abs(start).max()) or 1.0

        def gap(x: Real) -> tuple[Real, Real]:
            missing, slope = self._about(scale * _whole(x), share)
            return np.concatenate([missing.real, missing.imag]) / scale, slope

        x = np.concatenate([start.real, start.imag]) / scale
        found: Any = root(gap, x, jac=True, method="hybr", options={"xtol": ENOUGH})
        left = np.abs(found.fun).max() <= BALANCED * np.abs(found.x).max()
        return scale * _whole(found.x) if left else None

    def sliding(self) -> Complex:
        """Return the curvatures where no layer holds anything."""
        lost = np.eye(len(self.driven)) - self.moved * self.layers.whole
        return np.asarray(np.linalg.solve(lost, self.driven))

    def raised(self) -> Complex | None:
        """Return the curvatures that are reached when the drive is raised from nothing."""
        kappa: Complex | None = self.driven
        before = 1.0
        for share in SHARES.tolist():
            assert kappa is not None
            kappa = self.solved(kappa * (share / before), share)
            if kappa is None:
                return None
            before = share
        return kappa

    def _about(self, kappa: Complex, share: float) -> tuple[Complex, Real]:
        """Return what is not balanced, and its slope over real and imaginary parts.

        d(g kappa) = g dkappa + g' kappa Re(conj(kappa) dkappa)/|kappa|
        """
        amplitude = np.abs(kappa)
        found = self.layers.at(amplitude)
        g = found.first - self.layers.whole
        unit = np.divide(kappa, amplitude, out=np.zeros_like(kappa), where=amplitude > 0)
        missing = kappa - share * self.driven + self.moved @ (g * kappa)
        by_real = self.moved * (g + found.slope * kappa * unit.real)
        by_imag = self.moved * (1j * g + found.slope * kappa * unit.imag)
        slope = np.block([[by_real.real, by_imag.real], [by_real.imag, by_imag.imag]])
        return missing, slope + np.eye(2 * len(kappa))


def _whole(x: Real) -> Complex:
    """Return complex numbers of their real and then their imaginary parts."""
    real, imag = np.split(x, 2)
    return np.asarray(real + 1j * imag, dtype=np.complex128)
