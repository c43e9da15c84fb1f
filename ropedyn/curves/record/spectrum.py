"""Power spectral density of a record."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base import check
from ...base.answer import Answer, axes
from ...base.array import Real
from ...base.errors import SceneError
from ...base.table import Table
from ...base.unit import label
from ...chain.port import Point
from ...signal.record_lines import density, without_drift
from .find_peaks import lowest_of
from .repair import long_enough

if TYPE_CHECKING:
    from .record import Record

PARTS = 12  # Segments are this part of the longest piece, unless said.
LEAST = 16  # Samples of a segment at least.


@dataclass(frozen=True, eq=False)
class RecordSpectrum(Answer):
    """Power spectral density of the channels of a record.

    Attributes
    ----------
    response : tuple of points
        Where each channel is.
    quantity : {"acceleration", "velocity", "displacement"}
        Of the channels.
    window : str
        That weighted the segments.
    averages : float
        How many segments there were, which half overlap.
    frequency : ndarray, shape (f,)
        [Hz], from 0 to half the rate.
    psd : ndarray, shape (channels, f)
        One-sided density: unit of the channel squared per Hz.

    Examples
    --------
    >>> import numpy as np
    >>> import ropedyn as rd
    >>> record = rd.Record(None, np.sin(np.arange(5000.0)), rate=50.0, response=("z", 3.5))
    >>> spectrum = record.spectrum(10.0)
    >>> spectrum.psd.shape, spectrum.averages
    ((1, 251), 19.0)
    """

    response: tuple[Point, ...]
    quantity: str
    window: str
    averages: float
    frequency: Real = field(metadata=axes("frequency", unit="Hz"))
    psd: Real = field(metadata=axes("response", "frequency"))

    @property
    def labels(self) -> tuple[str, ...]:
        """What each channel is, with the unit of its density."""
        names = [label(point, quantity=self.quantity) for point in self.response]
        return tuple(f"{name[:-1].replace('[', '[(')})^2/Hz]" for name in names)

    def table(self) -> Table:
        """Return the density of every channel over frequency."""
        columns: dict[str, Any] = {"frequency [Hz]": self.frequency}
        columns |= dict(zip(self.labels, self.psd))
        return Table.of(f"power spectral density of {self.quantity}", columns)


def segment_of(record: Record, given: Any, parts: int) -> int:
    """Return the samples of a segment, this part of the longest piece where none is said."""
    longest = max(stop - start for start, stop in record.pieces)
    if given is None:
        return max(longest // parts, min(LEAST, longest))
    seconds = check.number(given, "segment", "s", sign="positive")
    samples = round(seconds * record.rate)
    if not LEAST <= samples <= longest:
        raise SceneError(
            f"segment must last from {LEAST / record.rate:.4g} s, {LEAST} samples, to "
            f"{longest / record.rate:.6g} s, the longest piece of the record, got {seconds:g}"
        )
    return samples


def spectrum_of(record: Record, segment: Any, window: str) -> RecordSpectrum:
    """Return the densities of all channels; see `Record.spectrum`."""
    length = segment_of(record, segment, PARTS)
    value = np.asarray(record.value)
    pieces = [value[:, start:stop] for start, stop in long_enough(record.pieces)]
    level = without_drift(pieces, record.rate, min(lowest_of(record), record.rate / 4))
    found = density(level, record.rate, length, window)
    return RecordSpectrum(
        response=record.response,
        quantity=record.quantity,
        window=window,
        averages=float(found.averages),
        frequency=found.frequency,
        psd=found.power,
    )
