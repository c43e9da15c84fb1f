"""What a measurement says about frequencies, of whatever form, for a comparison."""

from __future__ import annotations

from collections.abc import Sequence
from numbers import Real as RealNumber
from typing import Any, NamedTuple

import numpy as np

from ...base import check
from ...base.array import Integer, Real
from ...base.errors import SceneError
from ...base.unit import is_quantity
from ...curves.curves import Curves
from ...curves.measured import Measured, above_zero
from ...curves.merge_peaks import Merged, merge_peaks
from ...curves.peaks import Peaks
from ...curves.resonance import Resonances


class MeasuredPeaks(NamedTuple):
    """What was measured."""

    frequency: Real  # (k,) of the peaks [Hz]
    std: Real  # (k,) [Hz], NaN where it is not known
    damping_ratio: Real  # (k,) NaN where it is not known
    order: Integer | None  # (k,) where it is given
    curves: Measured | None  # without a line at 0 Hz
    left_out: tuple[str, ...] = ()  # maxima that are no peaks, in words

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


def measured_peaks(measured: Any) -> MeasuredPeaks:
    """Return what was measured, of whatever form."""
    what = "Peaks, a Measured, Resonances or frequencies [Hz]"
    given = (Peaks, Measured, Resonances, list, tuple, np.ndarray, RealNumber)
    if not is_quantity(measured):
        check.instance(measured, "measured", given, what)
    if isinstance(measured, Measured):
        curves = above_zero(measured)
        found = curves.peaks()
        left_out = tuple(text for one in found for text in one.left_out)
        return MeasuredPeaks(*peaks_in(curves), None, curves, left_out)
    if isinstance(measured, Resonances):
        return MeasuredPeaks(*peaks_in([measured]), None, None, measured.left_out)
    if not isinstance(measured, Peaks):
        frequency = check.numbers(measured, "measured", "Hz", sign="positive")
        unknown = np.full(len(frequency), np.nan)
        return MeasuredPeaks(frequency, unknown, unknown, None, None)
    frequency = np.asarray(measured.frequency, dtype=np.float64)
    std, ratio = (
        np.full(len(frequency), np.nan if given is None else given, dtype=np.float64)
        for given in (measured.std, measured.damping_ratio)
    )
    order = None if measured.order is None else np.array(measured.order, dtype=np.int64)
    return MeasuredPeaks(frequency, std, ratio, order, None)


def peaks_in(source: Curves | Sequence[Resonances]) -> Merged:
    """Return the peaks of all responses, which may be none."""
    try:
        return merge_peaks(source)
    except SceneError:
        none = np.zeros(0)
        return Merged(none, none, none)
