"""A mass on a spring that the rope carries."""

from __future__ import annotations

import math
from dataclasses import KW_ONLY
from typing import ClassVar

import numpy as np

from ...base.errors import SceneError
from ...base.parameter import number, one_of
from .node import PLANES, Attached, AttachedRate, NodeRate, NodeTerm, Part


class Resonator(Part):
    """A mass on a spring: a tuned absorber, an attached instrument.

    It moves transversely, with the rope's z, or y, as the motion of its foot. In undamped modes it
    is free of damping, as the rope is. Rayleigh damping of the rope acts on its mass, other
    dampings of the rope do not act on it.

    Parameters
    ----------
    x : float
        Where it stands [m].
    mass : float
        [kg].
    frequency : float
        Its own, with its foot held [Hz]: the spring has mass (2 pi frequency)^2.
    damping_ratio : float, optional
        Of the critical damping at that frequency: a dashpot 2 damping_ratio mass (2 pi frequency)
        beside the spring.
    plane : {"z", "y"}
        In which it moves; in the other one it weighs nothing: there a second one moves.

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite, the mass or the frequency is not positive or the damping is
        negative; in a model, if z cannot move where it stands.

    Examples
    --------
    An absorber tuned to the drive keeps its foot still:

    >>> import ropedyn as rd
    >>> absorber = rd.Resonator(0.5, 0.01, 16.0)
    >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, parts=[absorber]).compile()
    >>> bool(abs(model.frf([16.0], drive=("z", 0.5)).value[0, 0]) < 1e-15)
    True
    """

    kind: ClassVar[str] = "resonator"

    mass: float = number("kg", sign="positive")
    frequency: float = number("Hz", sign="positive")
    _: KW_ONLY
    damping_ratio: float = number(sign="nonnegative", default=0.0)
    plane: str = one_of(PLANES, default="z")

    def _agree(self) -> None:
        if not np.isfinite(self._values).all() or 0.0 in self._values[1:3]:
            raise SceneError(
                "frequency must leave the stiffness mass (2 pi frequency)^2 a number [N/m], got "
                f"{self.mass!r} kg and {self.frequency!r} Hz"
            )

    @property
    def _values(self) -> tuple[float, float, float, float]:
        """Mass, stiffness, eigenvalue with its foot held and damping, as the core takes them."""
        omega = np.float64(2 * math.pi * self.frequency)
        with np.errstate(over="ignore", under="ignore", invalid="ignore"):
            stiffness = self.mass * omega * omega
            damping = 2 * self.damping_ratio * self.mass * omega
            square = omega * omega
        return self.mass, float(stiffness), float(square), float(damping)

    @property
    def stands_on(self) -> tuple[str, ...]:
        """The displacement of its foot."""
        return (self.plane,)

    def term(self) -> NodeTerm:
        """Return the structure, which moves with its plane."""
        return NodeTerm(attached=[Attached(self.kind, {self.plane: 1.0}, {}, self._values)])

    def rates(self) -> dict[str, NodeRate]:
        """Return those of a spring mass (2 pi frequency)^2; undamped modes feel no dashpot."""
        attached = {
            "mass": AttachedRate(size=1 / self.mass),
            "frequency": AttachedRate(stiffness=2 / self.frequency),
            "damping_ratio": AttachedRate(damping=1.0),
        }
        return {name: NodeRate(attached=[rate]) for name, rate in attached.items()}
