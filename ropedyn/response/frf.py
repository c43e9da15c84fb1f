"""Frequency response."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol, Self

import numpy as np

from ..base.answer import TRANSIENT, Cost, Frozen, axes
from ..base.array import Complex, Flags, Real
from ..base.computed import Late, Lazy, Read, changed, computed, lazy
from ..base.errors import SceneError
from ..base.unit import QUANTITIES
from ..chain.port import Point
from ..curves.curves import Curves
from .rounding import TINY, relative


class ResponseRates(Protocol):
    """What derivatives of a response are computed from."""

    @property
    def model(self) -> Any:
        """The model that was asked."""

    def of(self, path: str, quantity: str) -> Complex:
        """Return the derivative of a quantity, shape (drives, responses, f)."""

    def error(self, path: str, quantity: str) -> Real:
        """Return a bound of the error of that, shape (drives, responses, f)."""


@dataclass(frozen=True, eq=False)
class MeshOfResponse(Frozen):
    """What continuous spans say about the response of a chain; see `FRF`."""

    mesh_error: Real = field(metadata=axes("drive", "response", "frequency"))


@dataclass(frozen=True, eq=False)
class RoundingOfResponse(Frozen):
    """How far rounding may have moved a response; see `FRF`."""

    rounding_error: Real = field(metadata=axes("drive", "response", "frequency"))
    rounding_limit: Real = field(metadata=axes("drive", "response", "frequency"))
    rounding_measured: Flags = field(metadata=axes("drive", "response", "frequency"))

    @classmethod
    def of(
        cls, value: Complex, limit: Real, was_measured: Flags | bool = False
    ) -> RoundingOfResponse:
        """Return what an absolute error says."""
        flags: Flags = np.broadcast_to(was_measured, value.shape).copy()
        return cls(relative(value, limit), limit, flags)

    @classmethod
    def of_relative(cls, value: Complex, error: Real) -> RoundingOfResponse:
        """Return what a relative bound says."""
        limit = error * np.maximum(np.abs(value), TINY)
        return cls(error, limit, np.zeros(value.shape, dtype=np.bool_))


@dataclass(frozen=True, eq=False)
class FRF(Curves):
    """Frequency response: motion is Re(value exp(+i omega t)) per unit force.

    Attributes
    ----------
    drive : tuple of points
        Where and on what the forces act, or whose motion is given; one, unless a list was asked
        for.
    response : tuple of points
        What is watched.
    quantity : {"receptance", "mobility", "accelerance"}
        Displacement, velocity or acceleration per force, or per displacement of an end.
    frequency : ndarray, shape (f,)
        [Hz].
    value : ndarray of complex, shape (responses, f) or (drives, responses, f)
        [m/N, rad/N, m/(N m), rad/(N m), of internal forces N/N and so on, per motion of an end
        m/m, rad/m and so on; and these per s or s^2].
    rounding_error : ndarray, as value
        Bound of the relative error that rounding causes, computed when it is first asked for;
        infinite where only the value is 0.
    rounding_limit : ndarray, as value
        The same of the absolute error, in the unit of the value.
    rounding_measured : ndarray of bool, as value
        True where that is the distance to the same response in wider numbers, with their own
        error, which takes some hundred times as long as the response; else it is a bound to first
        order, which is some hundred times the error: where a string has no tension at an end, of
        `ModalDamping`, on a resonance that takes no part, and of questions too long for wider
        numbers. On an axis False: there it is told by 16 answers for numbers that are a little off,
        some ten times the error.
    rounding_bound : ndarray, as value
        Bound of the relative error of rounding to first order, without wider numbers, computed when
        it is first asked for: some hundred times the error, in about the time of the response. As
        `rounding_error` where nothing is measured.
    mesh_error : ndarray, as value
        Relative error that the elements cause, computed when it is first asked for. Not an
        estimate: the distance to the response of the continuous spans of the same scene, and the
        rounding error of that, over the value. 0 for continuous spans, because they have none;
        infinite where they have no answer, as on an undamped resonance of theirs, and where only
        the value is 0. Refined, chains of difference elements lead elsewhere; theirs is the
        distance to the same continuous spans. With `ModalDamping`, also the bound of what the modes
        give that were left out.
    cost : Cost
        What it cost.
    stable : ndarray of bool, shape (f,), or None
        Of steady motion under a stepped sine: whether it comes back to itself when it is disturbed,
        computed when it is first asked for; False too where that cannot be told, as on a fold, and
        where friction slips and periods stay unlike, whose mean is the value.
    decay : float
        The value is the response at s = i omega + decay [1/s], 0 unless it was asked for: that of
        K + s C + s^2 M, with s and s^2 times the displacement as velocity and acceleration. A loss
        factor stays 1 + i eta.
    """

    drive: tuple[Point, ...]
    response: tuple[Point, ...]
    quantity: str
    frequency: Real = field(metadata=axes("frequency", unit="Hz"))
    value: Complex = field(metadata=axes("drive", "response", "frequency"))
    cost: Cost
    rounding: Lazy[RoundingOfResponse] = lazy(RoundingOfResponse)
    rounding_bound: Lazy[Real] = lazy(np.ndarray, axes("drive", "response", "frequency"))
    mesh: Lazy[MeshOfResponse] = lazy(MeshOfResponse)
    solve_rates: Callable[[], ResponseRates] | None = field(
        default=None, repr=False, metadata=TRANSIENT
    )
    decay: float = 0.0
    stable: Lazy[Flags | None] = lazy(np.ndarray, axes("frequency"), optional=True)

    rounding_error = Read[Real]("rounding", "Bound of the relative error of rounding, as value.")
    rounding_limit = Read[Real]("rounding", "Bound of the error of rounding, as value.")
    rounding_measured = Read[Flags]("rounding", "Whether that was measured, as value.")
    mesh_error = Read[Real]("mesh", "Relative error that the elements cause, as value.")

    @computed
    def rates(self) -> ResponseRates:
        """What derivatives are computed from."""
        if self.solve_rates is None:
            raise SceneError(
                "a response from a file or from motion over time has no model to ask for "
                "derivatives: compile the scene again and ask it for its frf"
            )
        return self.solve_rates()

    def to(self, quantity: str) -> Self:
        """Return the same response as another quantity; see `Curves.to`."""
        found = super().to(quantity)
        times = np.abs(self.s) ** (QUANTITIES[quantity] - QUANTITIES[self.quantity])

        def rounding() -> RoundingOfResponse:
            limit = self.rounding_limit * times
            return RoundingOfResponse.of(found.value, limit, self.rounding_measured)

        def bound() -> Real:
            of = RoundingOfResponse.of_relative(self.value, self.rounding_bound).rounding_limit
            with np.errstate(invalid="ignore"):
                return relative(found.value, np.where(times == 0, 0.0, of * times))

        return changed(found, rounding=Late(rounding), rounding_bound=Late(bound))

    def derivative(self, path: str) -> Complex:
        """Find the derivative of the response with respect to a number of the scene.

        Exact: the dynamic stiffness Z is symmetric, damped or not, so that
        dH/dp = -u_r^T (dZ/dp) u_d with the motion that the drive causes and that which a unit load
        on the response would. Both are solved once for all numbers. Of a sum over modes the
        residues and the eigenvalues change so.

        Parameters
        ----------
        path : str
            As in `Modes.derivative`; also of dampings, as ``"damping.gamma"`` or
            ``"damping[1].eta"``, and of dashpots, as ``"ends[0].dashpot.beta"``.

        Returns
        -------
        ndarray of complex, as value
            In units of the value per unit of the number. To rounding, see `derivative_error`.

        Raises
        ------
        TypeError
            If the path is not a string.
        SceneError
            If the path is not that of a number that acts in the scene, or that of a part which does
            not stand alone, if a drive or a response stands where the scene changes or between
            nodes of ``"rigid"`` or ``"difference"`` elements, or if the response was read from a
            file or stepped over time.

        Examples
        --------
        Pulled tighter a string gives way less at its middle, as L/4 T:

        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile()
        >>> frf = model.frf([0.0], drive=("z", 0.5))
        >>> frf.derivative("tension").real.round(9)
        array([[-2.5e-05]])
        """
        value = self.rates.of(path, self.quantity)
        return value if self.value.ndim == 3 else value[0]

    def derivative_error(self, path: str) -> Real:
        """Bound the rounding error of a derivative.

        By 16 derivatives of numbers that are a little off, and as long as those take: some ten
        times the error, of a sum over modes some sixty times. What such a sum leaves out is no
        rounding and not in it.

        Parameters
        ----------
        path : str
            As in `derivative`.

        Returns
        -------
        ndarray, as value
            Absolute, in units of the derivative.

        Raises
        ------
        TypeError
            If the path is not a string.
        SceneError
            As in `derivative`.

        Examples
        --------
        >>> import ropedyn as rd
        >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile()
        >>> frf = model.frf([0.0], drive=("z", 0.5))
        >>> bool(frf.derivative_error("tension")[0, 0] < 1e-12 * 2.5e-05)
        True
        """
        error = self.rates.error(path, self.quantity)
        return error if self.value.ndim == 3 else error[0]
