"""Measured peaks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from ..base import check
from ..base.answer import Answer, axes
from ..base.errors import SceneError
from ..base.table import Table
from .curves import Curves
from .merge_peaks import merge_peaks
from .resonance import Resonances


@dataclass(frozen=True, eq=False)
class Peaks(Answer):
    """Resonance peaks of a measurement, or published ones.

    Parameters
    ----------
    frequency : array_like, shape (k,)
        [Hz], each > 0.
    std : array_like, shape (k,) or one number, optional
        Standard uncertainty [Hz].
    order : sequence of int, shape (k,), optional
        Which mode each peak is, from 1; left out where that is not known.
    damping_ratio : array_like, shape (k,) or one number, optional
        Share of critical damping.

    Raises
    ------
    TypeError
        If something is not a number.
    SceneError
        If a frequency is not positive, lengths differ, or an order is used twice.

    Examples
    --------
    >>> import ropedyn as rd
    >>> rd.Peaks([64.0, 130.0, 193.0]).frequency.tolist()
    [64.0, 130.0, 193.0]
    """

    frequency: ArrayLike = field(metadata=axes("peak", unit="Hz"))
    _: KW_ONLY
    std: Any = None
    order: Sequence[int] | None = None
    damping_ratio: Any = None

    def __post_init__(self) -> None:
        frequency = check.numbers(self.frequency, "frequency", "Hz", sign="positive")
        object.__setattr__(self, "frequency", frequency)
        for name, unit, sign in ("std", "Hz", "nonnegative"), ("damping_ratio", "", "any"):
            given = getattr(self, name)
            if given is not None:
                object.__setattr__(self, name, _each(given, name, unit, sign, len(frequency)))
        if self.order is not None:
            object.__setattr__(self, "order", _checked_order(self.order, len(frequency)))
        super().__post_init__()

    @classmethod
    def of(cls, measured: Curves | Resonances | Sequence[Resonances]) -> Self:
        """Return the resonances of all responses as one list.

        Peaks of different responses that are nearer than a line, half the width at half power or
        3 standard uncertainties are one: their mean, weighted by the uncertainties, whose own
        follows from these, or from the scatter where that is more.

        Parameters
        ----------
        measured : Measured or FRF, or Resonances or a sequence of them
            Responses, or what their ``peaks()`` found.

        Returns
        -------
        Peaks
            With `std` and `damping_ratio`.

        Raises
        ------
        TypeError
            If it is none of these.
        SceneError
            If there is no peak.

        Examples
        --------
        >>> import numpy as np
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.ModalDamping(0.01))
        >>> points = [("z", 0.4), ("z", 0.25)]
        >>> frf = scene.compile().frf(np.arange(5.0, 40.0, 0.1), drive=points[0], response=points)
        >>> print(rd.Peaks.of(frf).frequency.round(2))
        [15.81 31.62]
        """
        given = (measured,) if isinstance(measured, Resonances) else measured
        what = "responses such as a Measured, or the Resonances of some"
        check.instance(given, "measured", (Curves, list, tuple), what)
        if not isinstance(given, Curves):
            for k, one in enumerate(given):
                check.instance(one, f"measured[{k}]", Resonances, "Resonances")
        found = merge_peaks(given)
        return cls(found.frequency, std=found.std, damping_ratio=found.damping_ratio)

    def table(self) -> Table:
        """Return one row for each peak."""
        columns: dict[str, Any] = {"frequency [Hz]": self.frequency}
        if self.std is not None:
            columns["std [Hz]"] = self.std
        if self.order is not None:
            columns["order"] = self.order
        if self.damping_ratio is not None:
            columns["damping ratio"] = self.damping_ratio
        return Table.of("peaks", columns)


def _each(given: Any, name: str, unit: str, sign: str, peaks: int) -> tuple[float, ...]:
    """Return a number for each peak; one is for all."""
    values = check.numbers(given, name, unit, sign=sign)
    if len(values) not in (1, peaks):
        raise SceneError(f"{name} must be one number or {peaks}, as frequency, got {len(values)}")
    return tuple(np.broadcast_to(values, peaks).tolist())


def _checked_order(order: Any, peaks: int) -> tuple[int, ...]:
    what = f"{peaks} different whole numbers from 1, one for each frequency"
    check.instance(order, "order", (list, tuple, range, np.ndarray), what)
    if len(order) != peaks:
        raise SceneError(f"order must be {what}, got {check.shown(order)}")
    most = np.iinfo(np.int32).max
    checked = tuple(check.count(k, f"order[{i}]", most=most) for i, k in enumerate(order))
    if len(set(checked)) < peaks:
        raise SceneError(f"order must be {what}, got {check.shown(order)}")
    return checked
