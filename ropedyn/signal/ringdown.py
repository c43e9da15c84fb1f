"""Frequencies and damping from the decay of free motion."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.answer import Answer, axes
from ..base.array import Complex, Real
from ..base.errors import SceneError, SolveError
from ..base.table import Table
from .pencil import decaying
from .spectrum import time_step

LEAST = 16  # A record of free motion must have so many times.
CREEP = 1e-6  # Motion whose phase turns less than by this part of its rate does not oscillate.
VAGUE = 0.02  # A mode whose rate is not known to this part of it is none.
FAINT = 5e-4  # Nor is what has less than this part of the largest amplitude: it may be what the
# low-pass has left of another, or rounding.
STOP_BAND = 100.0  # The low-pass stops by so much [dB].
WIDEST = 250  # Half the pass band times the length of the record is at most this.


@dataclass(frozen=True, eq=False)
class RingDown(Answer):
    """Modes that decay in one response.

    Attributes
    ----------
    label : str
        Of the response.
    since : float
        From when on motion was free [s].
    frequency, frequency_std : ndarray, shape (k,)
        Undamped natural frequency |s|/2 pi and its standard error [Hz].
    damping_ratio, damping_ratio_std : ndarray, shape (k,)
        -Re s/|s|, negative where the motion grows, and its standard error.
    amplitude : ndarray of complex, shape (k,)
        Motion is Re(amplitude exp(s (t - since))).
    residual : ndarray, shape (k,)
        Rms of what no mode explains, over the rms of the record, near each frequency.

    Examples
    --------
    >>> import numpy as np
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=10.0, damping=rd.ModalDamping(0.01))
    >>> time = np.linspace(0.0, 4.0, 2001)
    >>> history = scene.compile().transient(time, start={("z", 0.5): 0.4}, response=("z", 0.5))
    >>> decay = history.ring_down(5.0)
    >>> decay.frequency.round(4), decay.damping_ratio.round(4)
    (array([5.]), array([0.01]))
    """

    label: str
    since: float
    frequency: Real = field(metadata=axes("mode", unit="Hz"))
    frequency_std: Real = field(metadata=axes("mode", unit="Hz"))
    damping_ratio: Real = field(metadata=axes("mode"))
    damping_ratio_std: Real = field(metadata=axes("mode"))
    amplitude: Complex = field(metadata=axes("mode"))
    residual: Real = field(metadata=axes("mode"))

    def table(self) -> Table:
        """Return one row for each mode."""
        columns = {
            "frequency [Hz]": self.frequency,
            "std of frequency [Hz]": self.frequency_std,
            "damping ratio": self.damping_ratio,
            "std of damping ratio": self.damping_ratio_std,
            "amplitude": np.abs(self.amplitude),
            "residual": self.residual,
        }
        return Table.of(f"ring-down of {self.label}", columns)


class Band(NamedTuple):
    """A record near one frequency: y_j = sum of taps_m x_(q j + m) e^(-i shift (q j + m) step)."""

    # a mode e^(s t) stays one: e^((s - i shift) t) times what the taps make of it

    y: Complex
    step: float  # between the times of y [s]
    shift: float  # [rad/s]
    taps: Real
    fine: float  # between the times of the record [s]


def ring_down(
    time: Real,
    value: Real,
    force: Real,
    *,
    labels: Sequence[str],
    response: int,
    near: Any,
    since: float | None,
) -> RingDown:
    """Estimate modes of free motion, of one of the responses (responses, t)."""
    # see `History.ring_down`; motion is free since the forces (drives, t) last changed
    check.count(response, "response", least=0, most=len(value) - 1)
    step = time_step(time)
    first = _first_free(time, force, since)
    x = value[response, first:]
    if len(x) < LEAST:
        raise SceneError(
            f"since must leave {LEAST} times of free motion at least, got {len(x)} from "
            f"{float(time[min(first, len(time) - 1)])!r} s on"
        )
    if not x.any():
        raise SolveError(f"nothing moves in response {response} since {time[first]:g} s")
    if near is None:  # the largest line that is not the lowest
        # motion is strongest where it begins: a window that is 0 there would leave none of it
        lines = np.abs(np.fft.rfft(np.hanning(2 * len(x))[len(x) :] * (x - x.mean())))
        frequencies = np.array([(1 + int(lines[1:-1].argmax())) / (len(x) * step)])
    else:
        frequencies = check.numbers(near, "near", "Hz", sign="positive")
        if frequencies.max() >= 0.5 / step:
            raise SceneError(
                f"near must be below half the rate of the times, {0.5 / step:g} Hz, got "
                f"{frequencies.max():g}"
            )
    rows = [_mode_near(_band(x, step, f), f) for f in frequencies.tolist()]
    rate, size, variance, residual = (np.array(column) for column in zip(*rows))
    modulus = np.abs(rate)
    std = np.sqrt(variance / 2)
    return RingDown(
        label=labels[response],
        since=float(time[first]),
        frequency=modulus / (2 * np.pi),
        frequency_std=std / (2 * np.pi),
        damping_ratio=-rate.real / modulus,
        damping_ratio_std=std * rate.imag / modulus**2,
        amplitude=size,
        residual=residual,
    )


def _first_free(time: Real, force: Real, since: float | None) -> int:
    """Return the first time from which on no force changes."""
    if since is not None:
        return int(np.searchsorted(time, check.number(since, "since", "s")))
    changes = np.flatnonzero((np.diff(force, axis=1) != 0).any(axis=0))
    return int(changes[-1]) + 1 if len(changes) else 0


def _band(x: Real, step: float, f: float) -> Band:
    """Keep what is near a frequency, or below thrice it where the record is short, and thin it."""
    n, shift = len(x), 2 * np.pi * f
    width = min(f / 4, WIDEST / (n * step))
    # what stands still, and the same mode at -f, are beyond the edge of the stop band; the nearer
    # that, the fewer other modes are within, and the longer the filter: it costs as much record
    for edge in (2 * width, 3 * width, 3.8 * width):
        if (found := _low_pass(width, edge, step, n // 8)) is not None:
            return _shifted(x, step, shift, *found)
    for lowest, edge, at in ((width, 3.8 * width, shift), (f, 3 * f, 0.0)):
        if (found := _low_pass(lowest, edge, step, n // 3)) is not None:
            return _shifted(x, step, at, *found)
    # too few periods or too few times of each: the record as it is, a mean of neighbours
    q = max(1, min(n // 400, int(1 / (8 * f * step))))
    return _shifted(x, step, 0.0, np.full(q, 1 / q), q)


def _low_pass(width: float, edge: float, step: float, most: int) -> tuple[Real, int] | None:
    """Return the taps that pass `width` and stop at `edge` [Hz], and how they let it be thinned."""
    # nothing where they are more than `most`, or nothing can be thinned
    from scipy.signal import firwin, kaiserord

    if 4 * edge * step >= 1:
        return None
    length, beta = kaiserord(STOP_BAND, 2 * (edge - width) * step)
    if length > most:
        return None
    taps = firwin(length, (width + edge) / 2, window=("kaiser", beta), fs=1 / step)
    return taps, int(1 / (2 * edge * step))


def _shifted(x: Real, step: float, shift: float, taps: Real, q: int) -> Band:
    from scipy.signal import oaconvolve

    turned = x * np.exp(-1j * shift * step * np.arange(len(x)))
    y = oaconvolve(turned, taps[::-1], mode="valid")[::q]
    return Band(y, q * step, shift, taps, step)


def _mode_near(band: Band, f: float) -> tuple[complex, complex, float, float]:
    """Return rate [1/s], amplitude, variance of the rate and residual of the mode near f."""
    from scipy.signal import correlate

    # white noise in the band has this correlation at the lags of y
    thinned = round(band.step / band.fine)
    full = correlate(band.taps, band.taps)[len(band.taps) - 1 :: thinned]
    noise = np.zeros(len(band.y))
    noise[: len(full)] = full[: len(noise)] / full[0]
    found = decaying(band.y, noise)
    if found is None:
        raise SolveError(f"no mode near {f:g} Hz is told from noise")
    rate = found.log / band.step + 1j * band.shift
    variance = found.variance / band.step**2
    told = (rate.imag > CREEP * np.abs(rate)) & (variance < (VAGUE * np.abs(rate)) ** 2)
    told &= np.abs(found.size) > FAINT * np.abs(found.size).max()
    if not told.any():
        raise SolveError(f"nothing oscillates near {f:g} Hz")
    k = int(np.where(told, np.abs(np.abs(rate) - 2 * np.pi * f), np.inf).argmin())
    gain = band.taps @ np.exp((rate[k] - 1j * band.shift) * band.fine * np.arange(len(band.taps)))
    # of a real record half the mode is at -f
    return rate[k], 2 * found.size[k] / gain, float(variance[k]), found.residual
