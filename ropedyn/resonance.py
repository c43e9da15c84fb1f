"""Resonances that show as peaks of a frequency response."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from .answer import Answer, axes
from .table import Table
from .unit import QUANTITIES

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False)
class Resonances(Answer):
    """Peaks of one frequency response.

    Attributes
    ----------
    label : str
        Of the response.
    frequency : ndarray, shape (k,)
        Undamped natural frequency of the one-mode fit [Hz].
    amplitude : ndarray, shape (k,)
        Largest computed amplitude.
    damping_ratio : ndarray, shape (k,)
        Of the one-mode fit.
    """

    label: str
    frequency: NDArray[np.float64] = field(metadata=axes("peak", unit="Hz"))
    amplitude: NDArray[np.float64] = field(metadata=axes("peak"))
    damping_ratio: NDArray[np.float64] = field(metadata=axes("peak"))

    def table(self) -> Table:
        """Return one row for each peak."""
        columns = {
            "frequency [Hz]": self.frequency,
            "amplitude": self.amplitude,
            "damping ratio": self.damping_ratio,
        }
        return Table.of(f"peaks of {self.label}", columns)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot the peaks as lines over frequency, as high as their amplitudes."""
        from .plotting import plot_peaks

        ax = plot_peaks(self.frequency, ax, self.amplitude)
        ax.set_ylabel(f"amplitude of {self.label}")
        return ax


def resonances(
    frequency: NDArray[np.float64], value: NDArray[np.complex128], quantity: str, label: str
) -> Resonances:
    """Find local maxima of the amplitude and fit one mode to each.

    Near a resonance 1/receptance = (omega_0^2 - omega^2 + 2 i zeta omega_0 omega)/A, a straight
    line in omega^2 but for the slow omega of the last term: through the line just below and just
    above the largest one, its zero gives omega_0^2 (1 - 2 i zeta) and so both unknowns. Exact
    for one mode; with others the residual tilts it a little.

    Parameters
    ----------
    frequency : ndarray, shape (f,)
        [Hz], in any order.
    value : ndarray of complex, shape (f,)
        The response.
    quantity : str
        What it is.
    label : str
        Its name.

    Returns
    -------
    Resonances
    """
    from scipy.signal import find_peaks

    frequency, first = np.unique(frequency, return_index=True)
    value = value[first]
    at, _ = find_peaks(np.abs(value))
    omega = 2 * np.pi * frequency
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = (1j * omega) ** QUANTITIES[quantity] / value
    # at 0 Hz a velocity or an acceleration is 0 and says nothing
    before = np.where(np.isfinite(inverse[at - 1]), at - 1, at)
    after = at + 1
    slope = (inverse[after] - inverse[before]) / (omega[after] ** 2 - omega[before] ** 2)
    zero = omega[at] ** 2 - inverse[at] / slope
    natural = np.sqrt(np.maximum(zero.real, 0.0))
    ratio = np.divide(zero.imag, 2 * zero.real, out=np.zeros(len(at)), where=zero.real > 0)
    return Resonances(
        label=label,
        frequency=natural / (2 * np.pi),
        amplitude=np.abs(value[at]),
        damping_ratio=ratio,
    )
