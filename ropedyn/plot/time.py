"""Figures of motion over time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base import check
from ..base.errors import SceneError
from ..base.unit import NAME, UNIT
from .answers import new_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..motion.history import History
    from ..signal.ringdown import RingDown
    from ..signal.spectrum import Spectrum


def plot_history(history: History, ax: Axes | None) -> Axes:
    """Plot the responses over time."""
    ax = new_axes(ax)
    for name, value in zip(history.labels, history.value):
        ax.plot(history.time, value, linewidth=1.0, label=name)
    ax.set(xlabel="time [s]", ylabel=history.quantity, title="motion over time")
    ax.grid(True, color="0.92")
    ax.legend(fontsize="small")
    return ax


def plot_snapshots(history: History, ax: Axes | None, coordinate: str | None) -> Axes:
    """Plot one coordinate along the rope, early times dark and late ones bright."""
    if coordinate is None:
        coordinate = "z" if "z" in history.coordinates else history.coordinates[0]
    check.one_of(coordinate, "coordinate", history.coordinates)
    times = history.snapshot_time
    if len(times) == 0:
        raise SceneError("snapshots must have been asked for, got none")
    from matplotlib import colormaps

    at = history.coordinates.index(coordinate)
    ax = new_axes(ax)
    shades = colormaps["viridis"](np.linspace(0.0, 0.9, len(times)))
    for time, shape, shade in zip(times, history.snapshot[:, :, at], shades):
        ax.plot(history.x, shape, color=shade, label=f"{time:.4g} s")
    ax.axhline(0.0, color="0.7", linewidth=0.8, zorder=0)
    ax.set(xlabel="position along the rope [m]", ylabel=f"{NAME[coordinate]} [{UNIT[coordinate]}]")
    ax.set_title("the rope over time")
    ax.legend(title="time", fontsize="small", ncols=1 + len(times) // 12)
    return ax


def plot_spectrum(spectrum: Spectrum, ax: Axes | None) -> Axes:
    """Plot amplitudes over frequency on a logarithmic scale."""
    ax = new_axes(ax)
    for name, amplitude in zip(spectrum.labels, spectrum.amplitude):
        if amplitude.any():
            ax.semilogy(spectrum.frequency, amplitude, linewidth=1.0, label=name)
    ax.set(xlabel="frequency [Hz]", ylabel=f"{spectrum.quantity}, amplitude")
    ax.set_title(f"spectrum, window {spectrum.window}")
    ax.grid(True, which="both", color="0.92")
    if ax.lines:
        ax.legend(fontsize="small")
    return ax


def plot_ring_down(found: RingDown, ax: Axes | None) -> Axes:
    """Plot damping ratios over frequency, with standard errors."""
    ax = new_axes(ax)
    ax.errorbar(
        found.frequency,
        100 * found.damping_ratio,
        xerr=found.frequency_std,
        yerr=100 * found.damping_ratio_std,
        fmt="o",
        capsize=3,
    )
    ax.set(xlabel="frequency [Hz]", ylabel="damping ratio [%]")
    ax.set_title(f"ring-down of {found.label}")
    ax.grid(True, color="0.92")
    return ax
