"""Figures of records: over time, over frequency, over both."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.unit import label
from ..curves.record.record import Record
from ..curves.record.spectrum import RecordSpectrum, segment_of
from .figure import legend, light_grid, plots, with_unit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOMENTS = 50  # Densities that a spectrogram shows at least, unless said.
DECADES = 6.0  # Below the largest density that a spectrogram shows.


@plots(Record)
def plot_record(record: Record, ax: Axes) -> None:
    """Plot the channels over time; those that are not used grey."""
    for k, (name, row) in enumerate(zip(record.labels, record.value)):
        color, more = (None, "") if k in record.used else ("0.7", ", not used")
        ax.plot(record.time, row, linewidth=0.6, label=name + more, color=color)
    ax.set(xlabel="time [s]", ylabel=with_unit(ax, record.quantity), title="record")
    light_grid(ax)
    legend(ax)


@plots(RecordSpectrum)
def plot_record_spectrum(spectrum: RecordSpectrum, ax: Axes) -> None:
    """Plot densities over frequency on a logarithmic scale."""
    for name, psd in zip(spectrum.labels, spectrum.psd):
        if psd[1:].any():
            ax.semilogy(spectrum.frequency[1:], psd[1:], linewidth=0.8, label=name)
    ax.set(xlabel="frequency [Hz]", ylabel=with_unit(ax, "power spectral density"))
    ax.set_title(f"{spectrum.averages:g} averages, window {spectrum.window}")
    ax.grid(True, which="both", color="0.92")
    if ax.lines:
        legend(ax)


@plots(Record, "spectrogram")
def plot_spectrogram(
    record: Record, ax: Axes, channel: int = 0, segment: float | None = None
) -> None:
    """Plot the density of one channel as colours over time and frequency."""
    from matplotlib.colors import LogNorm
    from scipy import signal

    length = segment_of(record, segment, MOMENTS)
    row = np.asarray(record.value)[channel]
    parts = [
        (start, signal.spectrogram(row[start:stop], record.rate, "hann", length, length // 2))
        for start, stop in record.pieces
        if stop - start >= length
    ]
    most = max(float(psd.max()) for _, (_, _, psd) in parts)
    least = 10**-DECADES * max(most, np.finfo(float).tiny)
    how: dict[str, Any] = {"shading": "nearest", "norm": LogNorm(least, max(most, 2 * least))}
    for start, (frequency, time, psd) in parts:
        at = record.time[start] + time
        colours = ax.pcolormesh(at, frequency, np.maximum(psd, least), **how)
    name = label(record.response[channel], quantity=record.quantity)
    ax.figure.colorbar(colours, ax=ax, label="power spectral density")
    ax.set(xlabel="time [s]", ylabel="frequency [Hz]", title=name)
