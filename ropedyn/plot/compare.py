"""Figures of comparisons: measured and calculated over each other."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import check
from ..base.errors import SceneError
from .answers import new_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..experiment.compare.compare import Comparison

PAIR, ALONE = "C2", "C3"
"""Of peaks with a partner and without."""

PHASES = (-180, -90, 0, 90, 180)
"""Ticks [deg]."""


def plot_comparison(comparison: Comparison, ax: Axes | None, of: str | None) -> Axes:
    """Plot what was compared."""
    if of is None:
        of = "peaks" if comparison.frequency is None else "response"
    draw, needed = KINDS[check.one_of(of, "of", KINDS)]
    if needed is not None and getattr(comparison, needed) is None:
        raise SceneError(f"of must be something that was compared, got {of!r}: no {needed}")
    ax = new_axes(ax)
    draw(comparison, ax)
    return ax


def plot_pairs(comparison: Comparison, ax: Axes) -> None:
    """Plot calculated over measured peaks, with the line where both agree."""
    paired = comparison.order > 0
    measured, calculated = comparison.measured[paired], comparison.calculated[paired]
    top = 1.1 * max([*comparison.measured, *calculated], default=1.0)
    ax.plot([0.0, top], [0.0, top], color="0.7", label="agreement")
    std, error = (np.where(np.isfinite(s), s, 0.0) for s in (comparison.std, comparison.error))
    ax.errorbar(
        measured,
        calculated,
        xerr=2 * std[paired],
        yerr=2 * error[paired],
        fmt="o",
        color=PAIR,
        label="pairs, 2 std",
    )
    for f, g, difference in zip(measured, calculated, comparison.difference[paired]):
        ax.annotate(f"{difference:+.1f} %", (f, g), textcoords="offset points", xytext=(8, -10))
    alone = comparison.measured[~paired]
    ax.plot(alone, alone, "x", color=ALONE, label="without partner" if len(alone) else None)
    ax.set(xlabel="measured [Hz]", ylabel="calculated [Hz]", xlim=(0.0, top), ylim=(0.0, top))
    ax.set_title("calculated against measured peaks")
    ax.legend(fontsize="small")


def plot_amplitude(comparison: Comparison, ax: Axes) -> None:
    """Plot amplitudes, with lines where the peaks are."""
    _plot_both(comparison, ax, np.abs)
    ax.set_yscale("log")
    _mark_peaks(comparison, ax)
    ax.set(ylabel="amplitude", title="measured and calculated response")
    ax.legend(fontsize="small")


def plot_phase(comparison: Comparison, ax: Axes) -> None:
    """Plot phases."""
    _plot_both(comparison, ax, lambda value: np.degrees(np.angle(value)))
    ax.set(ylabel="phase [deg]", title="measured and calculated response", yticks=PHASES)
    ax.legend(fontsize="small")


def plot_frac(comparison: Comparison, ax: Axes) -> None:
    """Plot FRAC over frequency."""
    f = comparison.frequency
    assert f is not None
    assert comparison.frac_over_frequency is not None
    assert comparison.frac is not None
    curves = zip(comparison.response, comparison.frac_over_frequency, comparison.frac)
    for name, value, whole in curves:
        ax.plot(f, value, label=f"{name}, over all lines {whole:.3f}")
    ax.set(xlabel="frequency [Hz]", ylabel="FRAC [1]", ylim=(0.0, 1.05))
    ax.set_title(f"likeness of the responses in bands of {comparison.band:.3g} Hz")
    ax.legend(fontsize="small")


def plot_mac(comparison: Comparison, ax: Axes) -> None:
    """Plot MAC as colours, each pair of peaks framed."""
    assert comparison.mac is not None
    colours = ax.imshow(comparison.mac, vmin=0.0, vmax=1.0, cmap="viridis", aspect="auto")
    for k in np.flatnonzero(comparison.order > 0).tolist():
        ax.plot(comparison.order[k] - 1, k, "s", color=ALONE, fillstyle="none", markersize=12)
    for set_ticks, frequency in (
        (ax.set_yticks, comparison.measured),
        (ax.set_xticks, comparison.all_calculated),
    ):
        set_ticks(np.arange(len(frequency)), [f"{f:.4g}" for f in frequency])
    ax.set(xlabel="calculated [Hz]", ylabel="measured [Hz]", title="likeness of the shapes")
    ax.figure.colorbar(colours, ax=ax, label="MAC [1], pairs of peaks framed")


def _plot_both(comparison: Comparison, ax: Axes, of: Callable[[Any], Any]) -> None:
    """Plot measured dots and calculated lines, a colour for each response."""
    f = comparison.frequency
    assert f is not None
    assert comparison.measured_value is not None
    assert comparison.calculated_value is not None
    pairs = zip(comparison.response, comparison.measured_value, comparison.calculated_value)
    for k, (name, measured, calculated) in enumerate(pairs):
        colour = f"C{k}"
        ax.plot(f, of(measured), ".", markersize=3, color=colour, label=f"measured {name}")
        ax.plot(f, of(calculated), color=colour, label="" if k else "lines: calculated")
    ax.set_xlabel("frequency [Hz]")
    ax.grid(True, which="both", color="0.92")


def _mark_peaks(comparison: Comparison, ax: Axes) -> None:
    """Mark measured peaks, those without partner in another colour, and what was calculated."""
    paired = comparison.order > 0
    bottom, top = ax.get_ylim()
    marks: tuple[tuple[Any, str, Any, str], ...] = (
        (comparison.measured[paired], PAIR, ":", "measured peaks with partner"),
        (comparison.calculated[paired], PAIR, "-", "their partners"),
        (comparison.measured[~paired], ALONE, ":", "measured peaks without partner"),
    )
    for peaks, colour, style, label in marks:
        if len(peaks):
            ax.vlines(peaks, bottom, top, colors=colour, linestyles=style, lw=0.8, label=label)
    ax.set_ylim(bottom, top)


KINDS = {
    "response": (plot_amplitude, "frequency"),
    "phase": (plot_phase, "frequency"),
    "frac": (plot_frac, "frac"),
    "mac": (plot_mac, "mac"),
    "peaks": (plot_pairs, None),
}
"""What draws each, and the field of a comparison that it needs."""
