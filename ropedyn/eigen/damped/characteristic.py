"""The characteristic function of a damped chain over the complex rate s of motion e^(s t)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ... import _core
from ...base.array import Complex, Real
from ...base.check import COORDINATES
from ...chain.chain import Chain
from ...scene.damping import INERTIA, SECTION, TENSION, Damping

ROUNDING = 4.0  # Rounding of a value of the function, in units of eps sqrt(steps).


@dataclass(frozen=True)
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

    @property
    def is_real(self) -> bool:
        """Whether those of conjugate rates are conjugate."""
        return not (self.constant.imag.any() or self.linear.imag.any())

    def bound(self, radius: float) -> Complex:
        """Return the least |section| and the largest of the others where |s| <= radius, (5, 1)."""
        most = np.abs(self.constant) + np.abs(self.linear) * radius
        most[INERTIA] += radius**2
        most[SECTION] = abs(self.constant[SECTION]) - abs(self.linear[SECTION]) * radius
        return most[:, None].astype(np.complex128)


def elastic(chain: Chain) -> list[int]:
    """Return which of sections and tension hold a chain together."""
    names = {COORDINATES[c] for c in chain.coordinate}
    parts = [SECTION] if names & {"x", "alpha", "beta"} else []
    return parts + ([TENSION] if "z" in names and chain.tension.any() else [])


def horizon(chain: Chain, rates: Rates) -> float:
    """Return the least |s| [rad/s] where what holds a chain together comes to nothing."""
    # with section 1 + gamma s that is 1/gamma: infinitely many overdamped motions of ever shorter
    # waves accumulate there
    least = (abs(rates.constant[k] / rates.linear[k]) for k in elastic(chain) if rates.linear[k])
    return float(min(least, default=np.inf))


@dataclass
class Characteristic:
    """An analytic function that vanishes at the eigenvalues; see csrc/sweep/characteristic.h."""

    chain: Chain  # one component, between nodes that nothing moves
    rates: Rates  # its factors
    reach: float  # where it may be asked for: |s| below [rad/s]
    sweeps: int = 0  # how often it was
    steps: int = field(init=False)  # pieces shorter than the waves at its reach
    rounding: float = field(init=False)  # of values
    bound: Complex = field(init=False)

    def __post_init__(self) -> None:
        self.bound = self.rates.bound(self.reach)
        self.steps = int(_core.steps(self.chain, self.bound))
        self.rounding = ROUNDING * float(np.finfo(float).eps * np.sqrt(self.steps))

    @property
    def is_paired(self) -> bool:
        """Whether roots come in conjugate pairs."""
        return self.rates.is_real and not self.chain.is_hysteretic

    def __call__(self, s: Complex) -> tuple[Complex, Real]:
        """Return value and magnitude, each of the shape of s."""
        factor = np.ascontiguousarray(self.rates.at(s.ravel()))
        value, magnitude, _ = _core.characteristic(self.chain, factor, self.bound)
        self.sweeps += s.size
        return value.reshape(s.shape), magnitude.reshape(s.shape)
