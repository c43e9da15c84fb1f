"""What a measurement says about frequencies, of whatever form, for a comparison."""

from __future__ import annotations

from dataclasses import replace
from numbers import Real as RealNumber
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import check
from .errors import SceneError
from .measured import Measured
from .merged import merged
from .peaks import Peaks
from .resonance import Resonances

Real = NDArray[np.float64]


class Seen(NamedTuple):
    """What was measured."""

    frequency: Real
    """(k,) of the peaks [Hz]."""
    std: Real
    """(k,) [Hz], NaN where it is not known."""
    damping_ratio: Real
    """(k,) NaN where it is not known."""
    order: NDArray[np.int64] | None
    """(k,) where it is given."""
    curves: Measured | None
    """Without a line at 0 Hz."""

    @property
    def highest(self) -> float:
        """Highest peak, or line where there is none [Hz]."""
        if len(self.frequency):
            return float(self.frequency.max())
        return 0.0 if self.curves is None else float(self.curves.frequency[-1])

    @property
    def last(self) -> int:
        """The highest order that is given."""
        return 0 if self.order is None else int(self.order.max())


def seen_in(measured: Any) -> Seen:
    """Return what was measured, of whatever form."""
    what = "Peaks, a Measured, Resonances or frequencies [Hz]"
    given = (Peaks, Measured, Resonances, list, tuple, np.ndarray, RealNumber)
    check.instance(measured, "measured", given, what)
    if isinstance(measured, Measured):
        curves = _above_zero(measured)
        peaks = merged(curves.peaks())
        return Seen(peaks.frequency, peaks.std, peaks.damping_ratio, None, curves)
    if isinstance(measured, Resonances):
        peaks = merged([measured])
        return Seen(peaks.frequency, peaks.std, peaks.damping_ratio, None, None)
    if not isinstance(measured, Peaks):
        frequency = check.numbers(measured, "measured", "Hz", sign="positive")
        unknown = np.full(len(frequency), np.nan)
        return Seen(frequency, unknown, unknown, None, None)
    frequency = np.asarray(measured.frequency, dtype=np.float64)
    unknown = np.full(len(frequency), np.nan)
    std = unknown if measured.std is None else np.asarray(measured.std, dtype=np.float64)
    order = None if measured.order is None else np.array(measured.order, dtype=np.int64)
    return Seen(frequency, std, unknown, order, None)


def _above_zero(measured: Measured) -> Measured:
    """Leave out a line at 0 Hz: velocities are 0 there and free bodies have no displacement."""
    lines = measured.frequency > 0
    if lines.all():
        return measured
    if not lines.any():
        raise SceneError("measured must have lines above 0 Hz, got none")
    coherence = None if measured.coherence is None else measured.coherence[:, lines]
    frequency, value = measured.frequency[lines], measured.value[:, lines]
    return replace(measured, frequency=frequency, value=value, coherence=coherence)
