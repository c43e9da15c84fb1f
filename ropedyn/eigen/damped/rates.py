"""What damping makes of the parts of the dynamic stiffness at a complex rate s of e^(s t)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...base.array import Complex
from ...chain.chain import PLANE, Chain
from ...scene.damping import INERTIA, SECTION, TENSION, Damping


@dataclass(frozen=True, eq=False)
class Rates:
    """The factors of the five parts of the dynamic stiffness, polynomials in s."""

    # (5,) of sections, tension, springs, inertia, dashpots; inertia has s^2 as well
    constant: Complex
    linear: Complex

    @classmethod
    def of(cls, dampings: Sequence[Damping]) -> Rates:
        """Return those of a sum of dampings, but of what they add to the ratios of modes."""
        constant = np.array([1.0, 1.0, 1.0, 0.0, 0.0], dtype=np.complex128)
        linear = np.array([0.0, 0.0, 0.0, 0.0, 1.0], dtype=np.complex128)
        for term in (damping.term() for damping in dampings):
            for part, rate in term.rate.items():
                linear[part] += rate
            for part, loss in term.loss.items():
                constant[part] += 1j * loss
        return cls(constant, linear)

    def at(self, s: Complex) -> Complex:
        """Return the factors, shape (5, *s.shape)."""
        factor = self.constant[:, None] + np.multiply.outer(self.linear, s)
        factor[INERTIA] += s * s
        return factor


def elastic(chain: Chain) -> list[int]:
    """Return which of sections and tension hold a chain together."""
    names = {PLANE[c] for c in chain.coordinate}
    parts = [SECTION] if names & {"x", "alpha", "beta"} else []
    return parts + ([TENSION] if "z" in names and chain.tension.any() else [])


def horizon(chain: Chain, rates: Rates) -> float:
    """Return the least |s| [rad/s] where what holds a chain together comes to nothing."""
    # with section 1 + gamma s that is 1/gamma: infinitely many overdamped motions of ever shorter
    # waves accumulate there
    least = (abs(rates.constant[k] / rates.linear[k]) for k in elastic(chain) if rates.linear[k])
    return float(min(least, default=np.inf))
