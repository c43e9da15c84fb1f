"""Measured peaks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from . import check
from .answer import Answer, axes
from .errors import SceneError
from .table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes


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

    def __post_init__(self) -> None:
        frequency = check.numbers(self.frequency, "frequency", "Hz", sign="positive")
        object.__setattr__(self, "frequency", frequency)
        if self.std is not None:
            std = check.numbers(self.std, "std", "Hz", sign="nonnegative")
            if len(std) not in (1, len(frequency)):
                raise SceneError(
                    f"std must be one number or {len(frequency)}, as frequency, got {len(std)}"
                )
            object.__setattr__(self, "std", tuple(np.broadcast_to(std, frequency.shape).tolist()))
        if self.order is not None:
            object.__setattr__(self, "order", _checked_order(self.order, len(frequency)))
        super().__post_init__()

    def table(self) -> Table:
        """Return one row for each peak."""
        columns: dict[str, Any] = {"frequency [Hz]": self.frequency}
        if self.std is not None:
            columns["std [Hz]"] = self.std
        if self.order is not None:
            columns["order"] = self.order
        return Table.of("peaks", columns)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the peaks as lines over frequency."""
        from .plotting import plot_peaks

        return plot_peaks(np.asarray(self.frequency), ax)


def _checked_order(order: Any, peaks: int) -> tuple[int, ...]:
    what = f"{peaks} different whole numbers from 1, one for each frequency"
    check.instance(order, "order", (list, tuple, np.ndarray), what)
    if len(order) != peaks:
        raise SceneError(f"order must be {what}, got {check.shown(order)}")
    most = np.iinfo(np.int32).max
    checked = tuple(check.count(k, f"order[{i}]", most=most) for i, k in enumerate(order))
    if len(set(checked)) < peaks:
        raise SceneError(f"order must be {what}, got {check.shown(order)}")
    return checked
