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

    Of one mode 1/receptance = (omega_0^2 - omega^2 + 2 i zeta omega_0 omega)/A, a parabola in
    omega: the one through the three lines about the maximum has its root there at the pole
    omega_0 (sqrt(1 - zeta^2) + i zeta), whose modulus and argument are the two unknowns. Exact for
    one mode; others tilt it a little.

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
    omega = 2 * np.pi * frequency
    with np.errstate(divide="ignore", invalid="ignore"):
        inverse = (1j * omega) ** QUANTITIES[quantity] / value
    at, _ = find_peaks(np.abs(value))
    pole = np.array([_pole(omega, inverse, int(k)) for k in at], dtype=np.complex128)
    return Resonances(
        label=label,
        frequency=np.abs(pole) / (2 * np.pi),
        amplitude=np.abs(value[at]),
        damping_ratio=pole.imag / np.abs(pole),
    )


def _pole(omega: NDArray[np.float64], inverse: NDArray[np.complex128], k: int) -> complex:
    """Return the root of the parabola through line k and its neighbours [rad/s].

    At 0 Hz a velocity or an acceleration is 0 and says nothing: the parabola then goes through
    what lies above, and where there is nothing more it is a straight line.
    """
    first = k - 1 if np.isfinite(inverse[k - 1]) else k
    x, f = omega[first : first + 3], inverse[first : first + 3]
    slope = np.diff(f) / np.diff(x)
    bend = (slope[1] - slope[0]) / (x[2] - x[0]) if len(x) > 2 else 0.0
    # about x[j], the maximum: f + t steep + t^2 bend = 0, the root t that is near
    j = k - first
    steep = slope[0] + bend * (2 * x[j] - x[0] - x[1])
    root = np.sqrt(steep**2 - 4 * bend * f[j])
    far = max(steep + root, steep - root, key=abs)
    return complex(x[j] - 2 * f[j] / far)
