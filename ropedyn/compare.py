"""Calculated against measured peaks."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import check
from .answer import Answer, axes
from .eigen import solve_modes
from .errors import SceneError
from .frf import FRF
from .model import Model
from .modes import Modes
from .peaks import Peaks
from .table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False)
class Comparison(Answer):
    """Pairs of measured and calculated peaks.

    Attributes
    ----------
    order : ndarray of int, shape (k,)
        Which calculated peak each measured one is, from 1; 0 where none is left for it.
    measured, calculated : ndarray, shape (k,)
        [Hz]; calculated is 0 where there is no partner.
    difference : ndarray, shape (k,)
        (calculated - measured)/measured [%]; -100 where there is no partner.
    all_calculated : ndarray, shape (m,)
        Every calculated peak, paired or not [Hz].
    """

    order: NDArray[np.int64] = field(metadata=axes("peak"))
    measured: NDArray[np.float64] = field(metadata=axes("peak", unit="Hz"))
    calculated: NDArray[np.float64] = field(metadata=axes("peak", unit="Hz"))
    difference: NDArray[np.float64] = field(metadata=axes("peak", unit="%"))
    all_calculated: NDArray[np.float64] = field(metadata=axes("calculated", unit="Hz"))

    @property
    def peaks(self) -> Table:
        """The pairs with their differences."""
        none = self.order == 0
        blank = [
            tuple(None if gone else value for gone, value in zip(none, column.tolist()))
            for column in (self.order, self.calculated, self.difference)
        ]
        columns: dict[str, Any] = {
            "measured [Hz]": self.measured,
            "calculated [Hz]": blank[1],
            "difference [%]": blank[2],
            "mode": blank[0],
        }
        return Table.of("calculated against measured peaks", columns)

    def table(self) -> Table:
        """Return the pairs with their differences."""
        return self.peaks

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot calculated over measured frequencies."""
        from .plotting import plot_comparison

        return plot_comparison(self, ax)


def compare(calculated: Model | Modes | FRF, measured: Peaks) -> Comparison:
    """Compare natural frequencies, or the peaks of a response, with measured peaks.

    Parameters
    ----------
    calculated : Model, Modes or FRF
        Of a model the modes that are needed are computed; of an FRF the first response counts.
    measured : Peaks
        With their orders each is compared with that mode; without, pairs are chosen so that the
        sum of squared logarithms of the frequency ratios is smallest.

    Returns
    -------
    Comparison

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    SceneError
        If there is no calculated peak, or fewer than the orders ask for.

    Examples
    --------
    >>> import ropedyn as rd
    >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile(elements=64)
    >>> rd.compare(model, rd.Peaks([15.5, 32.0])).order.tolist()
    [1, 2]
    """
    check.instance(calculated, "calculated", (Model, Modes, FRF), "a Model, Modes or FRF")
    check.instance(measured, "measured", Peaks, "Peaks")
    peaks = np.asarray(measured.frequency, dtype=np.float64)
    found = _frequencies(calculated, measured)
    if measured.order is not None:
        order = np.array(measured.order, dtype=np.int64)
        if order.max() > len(found):
            raise SceneError(
                f"measured.order must be at most {len(found)}, the calculated peaks there are, "
                f"got {order.max()}"
            )
    else:
        order = _paired(peaks, found)
    partner = np.where(order > 0, found[order - 1], 0.0)
    return Comparison(
        order=order,
        measured=peaks,
        calculated=partner,
        difference=100 * (partner - peaks) / peaks,
        all_calculated=found,
    )


def _frequencies(calculated: Model | Modes | FRF, measured: Peaks) -> NDArray[np.float64]:
    """Return the calculated peaks that measured ones may be [Hz]."""
    if isinstance(calculated, Model):
        calculated = _enough_modes(calculated, measured)
    if isinstance(calculated, Modes):
        found = calculated.frequency[calculated.frequency > 0]
    else:
        found = calculated.peaks()[0].frequency
    if len(found) == 0:
        raise SceneError("calculated must have at least one peak, got none")
    return found


def _enough_modes(model: Model, measured: Peaks) -> Modes:
    """Return every mode that may be the partner of a measured peak."""
    peaks = np.asarray(measured.frequency)
    if measured.order is not None:
        number = max(measured.order)
    else:
        # those below the highest peak, and above it one for each
        number = model.count(below=float(peaks.max())) + len(peaks)
    rigid = len(model.coordinates) + 1
    return solve_modes(model, number + rigid, below=None, solver="sweep", strict=False)


def _paired(peaks: NDArray[np.float64], found: NDArray[np.float64]) -> NDArray[np.int64]:
    from scipy.optimize import linear_sum_assignment

    cost = np.log(np.divide.outer(peaks, found)) ** 2
    order = np.zeros(len(peaks), dtype=np.int64)
    rows, columns = linear_sum_assignment(cost)
    order[rows] = columns + 1
    return order
