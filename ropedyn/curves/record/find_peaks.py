"""Peaks of a record."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...base import check
from ...base.array import Real
from ...base.errors import SceneError, SolveError
from ...base.progress import Progress, reporter
from ...signal.output_peaks import Sought, output_peaks
from ...signal.record_lines import resampled
from ..peaks import Peaks
from .repair import long_enough

if TYPE_CHECKING:
    from .record import Record

CYCLES = 40  # The longest piece holds so many cycles of the lowest peak.
USUAL = 0.8  # Highest peak over half the rate, which the filters of recorders leave.


def pieces(record: Record) -> list[Real]:
    """Return the pieces (channels, t) of the channels that can be believed."""
    if not record.used:
        raise SolveError("record must have a channel that is not dead, got none")
    value = np.asarray(record.value)[list(record.used)]
    return [value[:, start:stop] for start, stop in long_enough(record.pieces)]


def lowest_of(record: Record) -> float:
    """Return the lowest frequency that a record can show [Hz]."""
    longest = max(stop - start for start, stop in record.pieces)
    return CYCLES * record.rate / longest


def find_peaks(record: Record, below: float | None, progress: Progress) -> Peaks:
    """Find the peaks of a record; see `Record.peaks`."""
    report = reporter(progress)
    lowest, half = lowest_of(record), record.rate / 2
    highest = USUAL * half if below is None else check.number(below, "below", "Hz")
    if not lowest < USUAL * half:
        raise SolveError(
            f"record must hold {round(CYCLES * 2 / USUAL)} samples without a gap for a peak, got "
            f"{round(CYCLES * record.rate / lowest)}"
        )
    if not lowest < highest <= half:
        raise SceneError(
            f"below must lie between {lowest:.4g} Hz, of which the record has {CYCLES} cycles, and "
            f"{half:.6g} Hz, half its rate, got {highest:.6g}"
        )
    parts, rate = resampled(pieces(record), record.rate, highest)
    found = output_peaks(parts, rate, Sought(record.quantity, lowest, highest), report)
    if not found:
        raise SolveError(
            f"record must have a peak between {lowest:.4g} and {highest:.4g} Hz that stands out "
            "of its noise, got none: record for longer"
        )
    return Peaks(
        [one.frequency for one in found],
        std=[one.std for one in found],
        damping_ratio=[one.ratio for one in found],
        damping_ratio_std=[one.ratio_std for one in found],
        kind=[one.kind for one in found],
        shape=[one.shape for one in found],
        sensors=[record.response[k] for k in record.used],
        snr=[one.signal for one in found],
        band=[(one.low, one.high) for one in found],
    )
