"""Damping: complex factors on the five parts of the dynamic stiffness, drag, and modal ratios.

The dynamic stiffness at the angular frequency omega is

    section K_elastic + tension K_tension + spring K_springs + inertia M + dashpot C

with section = tension = spring = 1, inertia = -omega^2 and dashpot = i omega where nothing else is
damped; omega = -i s is complex for the one at any s. A kind of damping is what it adds to these
factors, to C along the rope, and to the ratios of modes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import Any, ClassVar, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from ..base import check
from ..base.array import Complex, Real
from ..base.errors import SceneError
from ..base.parameter import Description, depending, given, number
from ..base.unit import is_quantity

SECTION, TENSION, SPRING, INERTIA, DASHPOT = PARTS = range(5)

NOTHING: Mapping[int, float] = MappingProxyType({})


class DampingTerm(NamedTuple):
    """What a damping adds."""

    rate: Mapping[int, float] = NOTHING  # times i omega, to factors of parts [s, of inertia 1/s]
    loss: Mapping[int, float] = NOTHING  # times i, to factors of parts
    drag: float = 0.0  # along the rope, to C of transverse and axial motion [N s/m^2]
    ratio: float | tuple[float, ...] = 0.0  # to that of all modes, or of the lowest ones
    slip: tuple[float, ...] = ()  # curvature per tension at which layers of wires slip [1/(m N)]


class Damping(Protocol):
    """What the analyses ask of a damping.

    >>> import ropedyn as rd
    >>> rd.ViscousDamping(2.0).term().drag
    2.0
    """

    kind: ClassVar[str]  # name of the effect

    def term(self) -> DampingTerm:
        """Return what it adds."""


class StiffnessDamping(Description):
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

    gamma: float = number("s", sign="nonnegative")

    def term(self) -> DampingTerm:
        """On sections and springs."""
        return DampingTerm(rate={SECTION: self.gamma, SPRING: self.gamma})


class RayleighDamping(Description):
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

    mass: float = number("1/s", sign="nonnegative")
    stiffness: float = number("s", sign="nonnegative")

    def term(self) -> DampingTerm:
        """On all stiffness, and on inertia."""
        stiffness = dict.fromkeys((SECTION, TENSION, SPRING), self.stiffness)
        return DampingTerm(rate={**stiffness, INERTIA: self.mass})


class LossFactor(Description):
    """Elastic stiffness times (1 + i eta): sections and springs, not tension.

    It has a meaning at each frequency, not in time. At 0 Hz the response is
    the complex one of the limit, and lags its force. `Model.static` is real and knows nothing of
    it, and there is no damping matrix. Damped modes are those of the stiffness times (1 + i eta).

    Parameters
    ----------
    eta : float
        [1].

    Raises
    ------
    TypeError
        If it is not a number.
    SceneError
        If it is not finite or is negative.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.LossFactor(0.02).eta
    0.02
    """

    kind: ClassVar[str] = "loss factor"

    eta: float = number(sign="nonnegative")

    def term(self) -> DampingTerm:
        """On sections and springs."""
        return DampingTerm(loss={SECTION: self.eta, SPRING: self.eta})


class ViscousDamping(Description):
    """A force per length against the velocity of the rope, transverse and axial.

    Continuous spans have it along the rope; chains have it lumped at the nodes, as their mass is.

    Parameters
    ----------
    coefficient : float
        [N s/m^2].

    Raises
    ------
    TypeError
        If it is not a number.
    SceneError
        If it is not finite or is negative.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.ViscousDamping(0.7).coefficient
    0.7
    """

    kind: ClassVar[str] = "viscous damping"

    coefficient: float = number("N s/m^2", sign="nonnegative")

    def term(self) -> DampingTerm:
        """Along the rope."""
        return DampingTerm(drag=self.coefficient)


def _checked_ratio(ratio: Any) -> float | tuple[float, ...]:
    if is_quantity(ratio) and np.ndim(ratio.magnitude):
        return tuple(check.numbers(ratio, "ratio", sign="nonnegative").tolist())
    several = ratio.ndim == 1 if isinstance(ratio, np.ndarray) else isinstance(ratio, (list, tuple))
    if not several:
        return check.number(ratio, "ratio", sign="nonnegative")
    if len(ratio) == 0:
        raise SceneError("ratio must be a number or one for each mode, got []")
    return tuple(
        check.number(one, f"ratio[{k}]", sign="nonnegative") for k, one in enumerate(ratio)
    )


class ModalDamping(Description):
    """A damping ratio for each mode of the undamped model, in the order of `Model.modes`.

    A frequency response is the sum over modes with the static one of all others, see `Model.frf`.
    Modes of two planes that have one frequency come in the order of `Model.coordinates`.

    Parameters
    ----------
    ratio : float or sequence of float
        Of every mode, or of the lowest ones, one each. A response needs one for each mode below its
        highest frequency; the ratio of a mode that none is given for is NaN.

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If something is not finite or is negative, or there is no number.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.ModalDamping([0.01, 0.02]).ratio
    (0.01, 0.02)
    """

    kind: ClassVar[str] = "modal damping"

    ratio: float | tuple[float, ...] = given(_checked_ratio)

    def term(self) -> DampingTerm:
        """On modes."""
        return DampingTerm(ratio=self.ratio)


def _checked_stiffness(value: Any) -> tuple[float, ...]:
    return tuple(check.numbers(value, "stiffness", "N m^2", sign="positive").tolist())


def _checked_slip(value: Any, name: str, friction: WireFriction) -> tuple[float, ...]:
    slip = tuple(check.numbers(value, name, "1/(m N)", sign="nonnegative").tolist())
    if len(slip) != len(friction.stiffness):
        raise SceneError(
            f"{name} must hold a number for each of the {len(friction.stiffness)} layers of "
            f"stiffness, got {len(slip)}"
        )
    return slip


class WireFriction(Description):
    """Friction between wires in bending: layers stick until tension can hold them no longer.

    Stiffness and loss depend on the amplitude of the curvature: `Model.frf` and
    `Model.stepped_sine` find them at each place of the rope (`FrictionResponse`) for a force that
    is given; what has no amplitude is refused. The rope has the stiffness of wires that stick.

    Parameters
    ----------
    stiffness : sequence of float
        What each layer adds to the bending stiffness while it sticks [N m^2].
    slip : sequence of float
        Curvature per tension from which each slips [1/(m N)].

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If there is no layer, not one number each, a stiffness is not positive or a slip negative.

    Examples
    --------
    `Section.wire_friction` computes it:

    >>> import ropedyn as rd
    >>> made = rd.Construction.standard("1x7", diameter=12e-3)
    >>> round(made.section().wire_friction(0.3).stiffness[0], 3)
    111.461
    """

    kind: ClassVar[str] = "wire friction"

    stiffness: tuple[float, ...] = given(_checked_stiffness)
    slip: tuple[float, ...] = depending(_checked_slip)

    def term(self) -> DampingTerm:
        """On layers of wires, as far as they slip."""
        return DampingTerm(slip=self.slip)


KINDS = (
    StiffnessDamping,
    RayleighDamping,
    LossFactor,
    ViscousDamping,
    ModalDamping,
    WireFriction,
)
"""Every kind of damping."""


def factors(dampings: Sequence[Damping], omega: NDArray[Any]) -> Complex:
    """Return the factors of a sum of dampings."""
    turn = 1j * omega
    total = np.ones((len(PARTS), *omega.shape), dtype=turn.dtype)
    total[INERTIA] = -(omega**2)
    total[DASHPOT] = turn
    for term in (damping.term() for damping in dampings):
        for part, rate in term.rate.items():
            total[part] += turn * rate
        for part, loss in term.loss.items():
            total[part] += 1j * loss
    return total.T


def separable(dampings: Sequence[Damping]) -> bool:
    """Whether sections and tension are damped alike, so that their sum has one factor."""
    share = factors(dampings, np.array(1.0))
    return bool(share[SECTION] == share[TENSION])


def drag(dampings: Sequence[Damping]) -> float:
    """Return the damping along the rope of a sum of dampings [N s/m^2]."""
    return sum(damping.term().drag for damping in dampings)


def ratios(dampings: Sequence[Damping], count: int) -> Real:
    """Return what a sum of dampings adds to the damping ratios of the lowest modes."""
    total = np.zeros(count)
    for ratio in (damping.term().ratio for damping in dampings):
        given = np.array(ratio if isinstance(ratio, tuple) else (ratio,) * count)[:count]
        total[: len(given)] += given
        total[len(given) :] = np.nan
    return total


def having(dampings: Sequence[Damping], *fields: str) -> tuple[Damping, ...]:
    """Return those dampings that add anything but 0 by one of these fields of their term."""
    return tuple(one for one in dampings if any(_adds(one.term(), field) for field in fields))


def _adds(term: DampingTerm, field: str) -> bool:
    value = getattr(term, field)
    if isinstance(value, Mapping):
        return any(value.values())
    return any(value) if isinstance(value, tuple) else bool(value)
