"""Damping: complex factors on the five parts of the dynamic stiffness.

Whatever the damping, the dynamic stiffness at the angular frequency omega is

    section K_elastic + tension K_tension + spring K_springs + inertia M + dashpot C

with section = tension = spring = 1, inertia = -omega^2 and dashpot = i omega where nothing else is
damped. A kind of damping is what it adds to the factors.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Protocol

import numpy as np
from numpy.typing import NDArray

from . import check

SECTION, TENSION, SPRING, INERTIA, DASHPOT = PARTS = range(5)


class Damping(Protocol):
    """What the analyses ask of a damping."""

    kind: ClassVar[str]
    """Name of the effect."""

    def factors(self, omega: NDArray[np.float64]) -> NDArray[np.complex128]:
        """Return what it adds to the factors, shape (..., 5)."""


@dataclass(frozen=True)
class StiffnessDamping:
    """Elastic stiffness times (1 + i omega gamma): sections and springs, not tension.

    Parameters
    ----------
    gamma : float
        [s].

    Raises
    ------
    TypeError
        If it is not a number.
    SceneError
        If it is not finite or is negative.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.StiffnessDamping(1e-4).gamma
    0.0001
    """

    kind: ClassVar[str] = "stiffness damping"

    gamma: float

    def __post_init__(self) -> None:
        gamma = check.number(self.gamma, "gamma", "s", sign="nonnegative")
        object.__setattr__(self, "gamma", gamma)

    def factors(self, omega: NDArray[np.float64]) -> NDArray[np.complex128]:
        """Return i omega gamma on sections and springs."""
        return 1j * omega[..., None] * np.array([self.gamma, 0.0, self.gamma, 0.0, 0.0])


@dataclass(frozen=True)
class RayleighDamping:
    """Damping matrix mass M + stiffness K, with the tension in K.

    Parameters
    ----------
    mass : float
        [1/s].
    stiffness : float
        [s].

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite or is negative.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.RayleighDamping(0.5, 1e-4).mass
    0.5
    """

    kind: ClassVar[str] = "rayleigh damping"

    mass: float
    stiffness: float

    def __post_init__(self) -> None:
        for name, unit in (("mass", "1/s"), ("stiffness", "s")):
            value = check.number(getattr(self, name), name, unit, sign="nonnegative")
            object.__setattr__(self, name, value)

    def factors(self, omega: NDArray[np.float64]) -> NDArray[np.complex128]:
        """Return i omega times the coefficients."""
        coefficients = [self.stiffness, self.stiffness, self.stiffness, self.mass, 0.0]
        return 1j * omega[..., None] * np.array(coefficients)


KINDS = (StiffnessDamping, RayleighDamping)
"""Every kind of damping."""


def factors(dampings: Sequence[Damping], omega: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Return the factors of a sum of dampings.

    Parameters
    ----------
    dampings : sequence
        None is no damping at all.
    omega : ndarray
        Angular frequency [rad/s].

    Returns
    -------
    ndarray, shape (..., 5)
        On sections, tension, springs, inertia and dashpots.
    """
    total = np.ones((*omega.shape, len(PARTS)), dtype=np.complex128)
    total[..., INERTIA] = -(omega**2)
    total[..., DASHPOT] = 1j * omega
    for damping in dampings:
        total = total + damping.factors(omega)
    return total


def separable(dampings: Sequence[Damping]) -> bool:
    """Whether sections and tension are damped alike, so that their sum has one factor."""
    share = factors(dampings, np.array(1.0))
    return bool(share[SECTION] == share[TENSION])
