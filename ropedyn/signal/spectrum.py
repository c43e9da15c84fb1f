"""Amplitudes of motion over frequency."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ..base import check
from ..base.answer import Answer, axes
from ..base.array import Complex, Real
from ..base.errors import SceneError
from ..base.table import Table
from ..base.unit import label

UNIFORM = 1e-6  # Times this part of a step away from equal steps are at equal steps.


@dataclass(frozen=True, eq=False)
class Spectrum(Answer):
    """Amplitudes of the responses over frequency.

    Attributes
    ----------
    response : tuple of points
        What was watched.
    quantity : {"displacement", "velocity", "acceleration"}
        Of the responses.
    window : str
        That weighted the times.
    bandwidth : float
        Equivalent noise bandwidth of the window [Hz].
    frequency : ndarray, shape (f,)
        [Hz], from 0 to half the rate of the times.
    value : ndarray of complex, shape (responses, f)
        Motion is the sum of Re(value exp(+i omega t)): a steady motion A cos(omega t + phi) at one
        of these frequencies shows as A exp(i phi) there, whatever the window.

    Examples
    --------
    >>> import numpy as np
    >>> import ropedyn as rd
    >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0).compile()
    >>> time = np.linspace(0.0, 2.0, 401)[:-1]
    >>> history = model.transient(time, start={("z", 0.5): 0.4}, response=("z", 0.5))
    >>> spectrum = history.spectrum(window="boxcar")
    >>> line = spectrum.amplitude[0].argmax()
    >>> print(spectrum.frequency[line], spectrum.amplitude[0, line].round(6))
    5.0 0.008122
    >>> mean_square = (spectrum.psd[0] * spectrum.bandwidth).sum()
    >>> print((mean_square / (history.value**2).mean()).round(9))
    1.0
    """

    response: tuple[tuple[str, float], ...]
    quantity: str
    window: str
    bandwidth: float
    frequency: Real = field(metadata=axes("frequency", unit="Hz"))
    value: Complex = field(metadata=axes("response", "frequency"))

    @property
    def amplitude(self) -> Real:
        """Modulus of the value, shape (responses, f)."""
        return np.abs(self.value)

    @property
    def psd(self) -> Real:
        """One-sided power spectral density, shape (responses, f): unit of the value squared per Hz.

        Its sum times the distance of the frequencies is the mean square of the windowed motion.
        """
        power = self.amplitude**2 / 2
        # what stands still has the mean square of its amplitude
        power[:, self.frequency == 0] *= 2
        return power / self.bandwidth

    @property
    def labels(self) -> tuple[str, ...]:
        """What each response is, with its unit."""
        return tuple(label(r, quantity=self.quantity) for r in self.response)

    def table(self) -> Table:
        """Return amplitude and phase of every response over frequency."""
        columns: dict[str, Any] = {"frequency [Hz]": self.frequency}
        for name, value in zip(self.labels, self.value):
            columns[f"|{name}|"] = np.abs(value)
            columns[f"phase of {name} [deg]"] = np.degrees(np.angle(value))
        return Table.of(f"spectrum of {self.quantity}", columns)


def spectrum(
    time: Real, value: Real, window: str, *, response: tuple[Any, ...], quantity: str
) -> Spectrum:
    """Return the spectrum of responses over time, (responses, t); see `History.spectrum`."""
    step, n = time_step(time), len(time)
    weight = window_weights(window, n)
    frequency = np.arange(n // 2 + 1) / (n * step)
    lines = np.fft.rfft(weight * value) * (2 / weight.sum())
    # 0 and half the rate have no partner at a negative frequency
    lines[:, 0] /= 2
    if n % 2 == 0:
        lines[:, -1] /= 2
    return Spectrum(
        response=response,
        quantity=quantity,
        window=window,
        bandwidth=float((weight**2).sum() / weight.sum() ** 2 / step),
        frequency=frequency,
        value=lines * np.exp(-2j * np.pi * frequency * time[0]),
    )


def window_weights(window: Any, n: int) -> Real:
    """Return the weights of n times."""
    from scipy.signal import get_window

    try:
        return np.asarray(
            get_window(check.instance(window, "window", str, "the name of a window"), n)
        )
    except ValueError as error:
        raise SceneError(
            f"window must be one that scipy.signal knows without a number, got {window!r}"
        ) from error


def time_step(time: Real) -> float:
    """Return the step between times."""
    step = float((time[-1] - time[0]) / (len(time) - 1))
    away = np.abs(time - (time[0] + step * np.arange(len(time))))
    if away.max() > UNIFORM * step:
        k = int(away.argmax())
        raise SceneError(
            f"time must have equal steps, of {step:g} s on average, got time[{k}] = "
            f"{float(time[k])!r} s"
        )
    return step


def amplitude(time: Real, value: Real, frequency: Any, last: float | None) -> Complex:
    """Fit steady motion to responses over time, (responses, t); see `History.amplitude`."""
    given = check.frequencies(frequency)
    if last is not None:
        first = time[-1] - check.number(last, "last", "s", sign="positive")
        time = time[time >= first]
    if len(np.unique(given)) < len(given) or (given == 0).any():
        raise SceneError(f"frequency must be different numbers > 0, got {check.shown(frequency)}")
    n, unknowns = len(time), 2 * len(given) + 2
    if n < unknowns:
        raise SceneError(f"last must hold {unknowns} times at least, got {n}")
    rate = (n - 1) / (time[-1] - time[0])
    if given.max() >= rate / 2:
        raise SceneError(
            f"frequency must be below half the rate of the times, {rate / 2:g} Hz, got "
            f"{float(given.max())!r}"
        )
    turn = np.exp(2j * np.pi * np.outer(time, given))
    # Re(value turn) = value' turn' - value'' turn''; what stands still, what drifts
    drift = np.linspace(-1, 1, n) if n == 1 else 2 * (time - time[0]) / (time[-1] - time[0]) - 1
    basis = np.column_stack([turn.real, -turn.imag, np.ones(n), drift])
    found, _, rank, _ = np.linalg.lstsq(basis, value[:, -n:].T, rcond=1e-9)
    if rank < unknowns:
        raise SceneError(
            f"last must be long enough to tell {check.shown(frequency)} Hz from what stands still "
            f"or drifts, got {float(time[-1] - time[0]):g} s"
        )
    k = len(given)
    size = (found[:k] + 1j * found[k : 2 * k]).T
    return size if np.ndim(frequency) else size[:, 0]


def amplitudes(value: Real, samples: int) -> Complex:
    """Return the complex amplitudes over each of some periods, shape (responses, periods)."""
    turn = np.exp(-2j * np.pi * np.arange(samples) / samples)
    return np.asarray(2 / samples * (value.reshape(len(value), -1, samples) @ turn))
