"""Figures of what was measured: beside what is calculated, and what it tells."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import check
from ..base.errors import SceneError
from ..experiment.compare.compare import Comparison
from ..experiment.identify.fit import Fit
from ..experiment.identify.fits import Fits
from ..experiment.identify.report import shown
from ..experiment.identify.response_fit import ResponseFit
from ..experiment.plan.wire_shifts import WireShifts
from ..experiment.track.track import Track
from ..scene.bench.static_test import StaticTest
from ..scene.path import unit_of
from .figure import (
    BLUE,
    GREEN,
    ORANGE,
    RED,
    colour,
    legend,
    light_grid,
    plots,
    unbroken,
    with_unit,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

PAIR, ALONE = GREEN, RED
"""Colours of peaks with a partner and without."""
PHASES = (-180, -90, 0, 90, 180)  # Ticks of a phase [deg].


@plots(Comparison)
def plot_comparison(comparison: Comparison, ax: Axes, of: str | None) -> None:
    """Plot what was compared."""
    if of is None:
        of = "peaks" if comparison.frequency is None else "response"
    draw, needed = KINDS[check.one_of(of, "of", KINDS)]
    if needed is not None and getattr(comparison, needed) is None:
        raise SceneError(f"of must be something that was compared, got {of!r}: no {needed}")
    draw(comparison, ax)


def _pairs(comparison: Comparison, ax: Axes) -> None:
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


def _amplitude(comparison: Comparison, ax: Axes) -> None:
    """Plot amplitudes, with lines where the peaks are."""
    _both(comparison, ax, np.abs)
    ax.set_yscale("log")
    _mark_peaks(comparison, ax)
    ax.set(ylabel=with_unit(ax, "amplitude"), title="measured and calculated response")
    ax.legend(fontsize="small")


def _phase(comparison: Comparison, ax: Axes) -> None:
    """Plot phases."""
    _both(comparison, ax, lambda value: np.degrees(np.angle(value)), unbroken)
    ax.set(ylabel="phase [deg]", title="measured and calculated response", yticks=PHASES)
    ax.legend(fontsize="small")


def _frac(comparison: Comparison, ax: Axes) -> None:
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


def _mac(comparison: Comparison, ax: Axes) -> None:
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


def _both(
    comparison: Comparison,
    ax: Axes,
    of: Callable[[Any], Any],
    line: Callable[[Any, Any], Any] = lambda f, value: (f, value),
) -> None:
    """Plot measured dots and calculated lines, a colour for each response."""
    f = comparison.frequency
    assert f is not None
    assert comparison.measured_value is not None
    assert comparison.calculated_value is not None
    pairs = zip(comparison.response, comparison.measured_value, comparison.calculated_value)
    for k, (name, measured, calculated) in enumerate(pairs):
        shade = colour(k)
        ax.plot(f, of(measured), ".", markersize=3, color=shade, label=f"measured {name}")
        ax.plot(*line(f, of(calculated)), color=shade, label="" if k else "lines: calculated")
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
    for peaks, shade, style, label in marks:
        if len(peaks):
            ax.vlines(peaks, bottom, top, colors=shade, linestyles=style, lw=0.8, label=label)
    ax.set_ylim(bottom, top)


KINDS = {
    "response": (_amplitude, "frequency"),
    "phase": (_phase, "frequency"),
    "frac": (_frac, "frac"),
    "mac": (_mac, "mac"),
    "peaks": (_pairs, None),
}
"""What draws each, and the field of a comparison that it needs."""


@plots(Fit)
def plot_fit(fit: Fit, ax: Axes, of: str) -> None:
    """Plot what a fit says."""
    OF_FIT[check.one_of(of, "of", OF_FIT)](fit, ax)


def _residuals(fit: Fit, ax: Axes) -> None:
    """Plot residuals over orders, in per cent of the measured frequency."""
    used = fit.orders > 0
    per_cent = 100 / fit.measured[used]
    error = fit.measured_std[used] * per_cent
    ax.errorbar(
        fit.orders[used],
        fit.residual[used] * per_cent,
        yerr=np.where(np.isfinite(error), error, 0.0),
        fmt="o",
        capsize=3,
    )
    ax.axhline(0.0, color="0.7", linewidth=0.8, zorder=0)
    ax.set(xlabel="mode", ylabel="calculated less measured [%]")
    ax.set_xticks(np.unique(fit.orders[used]))
    ax.set_title(_found(fit))
    light_grid(ax)


def _budget(fit: Fit, ax: Axes) -> None:
    """Plot intervals of the first number of a few levels, and below them what makes them."""
    path, levels = fit.unknown[0], (0.5, 0.8, 0.95, 0.99)
    for level in levels:
        low, high = fit.interval(level)[path]
        if np.isfinite([low, high]).all():
            ax.barh(0, high - low, left=low, height=0.8, color=BLUE, alpha=0.25)
    value = float(fit.value[path])
    ax.plot([value, value], [-0.4, 0.4], color=BLUE)
    parts = sorted(fit.budget.items(), key=lambda part: -part[1])
    parts = [(cause, half) for cause, half in parts if 0 < half < np.inf]
    for k, (_, half) in enumerate(parts, 1):
        ax.barh(k, 2 * half * value, left=value * (1 - half), height=0.5, color="0.6")
    words = f"{path}, 50, 80, 95, 99 %"
    ax.set_yticks(range(len(parts) + 1), [words, *(f"95 % by {cause}" for cause, _ in parts)])
    ax.invert_yaxis()
    ax.set(xlabel=f"{path} [{unit_of(path) or '1'}]", title=_found(fit))
    light_grid(ax)


def _ends(fit: Fit, ax: Axes) -> None:
    """Plot how likely each fixity of the ends is."""
    fixity, likelihood = fit.remarks.fixity, fit.remarks.likelihood_of_fixity
    if fixity is None or likelihood is None or not len(fixity):
        raise SceneError('of must be "residuals" or "budget" where ends are given, got "ends"')
    for i, each in enumerate(likelihood):
        ax.step(fixity, np.exp(each), where="mid", label=f"end {i}")
    ax.set(xlabel="fixity: 0 pinned, 1 clamped", ylabel="likelihood", xlim=(0.0, 1.0))
    ax.set_ylim(bottom=0.0)
    ax.set_title("what the peaks say of the ends")
    ax.legend(fontsize="small")
    light_grid(ax)


OF_FIT = {"residuals": _residuals, "budget": _budget, "ends": _ends}
"""What draws each part of a fit."""


@plots(Fits)
def plot_fits(fits: Fits, ax: Axes, unknown: str | None) -> None:
    """Plot one number of many ropes."""
    path = fits.unknown[0] if unknown is None else check.one_of(unknown, "unknown", fits.unknown)
    at = fits.unknown.index(path)
    std = fits.std[:, at]
    error = np.where(np.isfinite(std), std, 0.0)
    ax.errorbar(np.arange(len(fits)), fits.value[:, at], yerr=error, fmt="o", capsize=3)
    ax.set(xlabel="rope", ylabel=f"{path} [{unit_of(path) or '1'}]")
    ax.locator_params(axis="x", integer=True)
    light_grid(ax)


@plots(Track)
def plot_track(track: Track, ax: Axes) -> None:
    """Plot tension over time, the band that is certain and the one of changes, and each record."""
    time = track.dates()
    for common, alpha, label in ((True, 0.2, "95 %"), (False, 0.4, "95 % of changes")):
        low, high = track.interval(0.95, common=common).T
        ax.fill_between(time, low, high, color=BLUE, alpha=alpha, linewidth=0, label=label)
    ax.plot(time, track.tension, color=BLUE, label="all records")
    told = np.isfinite(track.measured)
    alone, half = track.measured[told], 1.96 * track.measured_std[told]
    ax.errorbar(
        time[told], alone, half, fmt="o", markersize=4, color=ORANGE, label="each alone, 95 %"
    )
    out = "x" if (~told).any() else ""
    ax.plot(time[~told], track.tension[~told], out, color=ALONE, label="left out" if out else None)
    ax.set(xlabel="time" if track.since else "time [day]", ylabel="tension [N]")
    ax.set_title(f"tension over time, {told.sum()} of {len(time)} records")
    light_grid(ax)
    legend(ax)


@plots(ResponseFit)
def plot_response_fit(fit: ResponseFit, ax: Axes) -> None:
    """Plot measured amplitudes as dots and calculated ones as lines over frequency."""
    for name, measured, calculated in zip(fit.labels, fit.measured, fit.calculated):
        (line,) = ax.semilogy(fit.frequency, np.abs(calculated), label=name)
        ax.semilogy(fit.frequency, np.abs(measured), ".", color=line.get_color(), markersize=3)
    ax.set(xlabel="frequency [Hz]", ylabel=with_unit(ax, f"amplitude of the {fit.quantity}"))
    ax.set_title(_found(fit))
    legend(ax, "line calculated, dots measured")
    light_grid(ax)


def _found(fit: Fit | ResponseFit) -> str:
    """Return what was found in a few digits."""
    if np.isnan(fit.value).all():
        return "refused: the notes say why"
    return "identified: " + ", ".join(f"{p} {shown(v, unit_of(p))}" for p, v in fit.value.items())


@plots(StaticTest)
def plot_static_test(test: StaticTest, ax: Axes) -> None:
    """Plot readings over loads, with the line of least squares."""
    ends = np.array([min(0.0, test.load.min()), max(0.0, test.load.max())])
    ax.plot(test.load, test.reading, "o", label="readings")
    ax.plot(ends, test.offset + test.line.slope * ends, label="least squares")
    ax.set(xlabel=test.load_label, ylabel=test.reading_label, title=test.title)
    light_grid(ax)
    ax.legend(fontsize="small")


@plots(WireShifts)
def plot_wire_shifts(shifts: WireShifts, ax: Axes) -> None:
    """Plot relative shifts over places, and above the lines what measurements tell."""
    styles = ("-", "--", ":", "-.")
    for k, (f, family) in enumerate(zip(shifts.frequency, shifts.family)):
        for i, n in enumerate(shifts.n):
            name = f"{f:.1f} Hz, {family}" if i == 0 else f"{n} broken" if k == 0 else None
            share = 100 * np.abs(shifts.shift[i, k]) / f
            style = styles[i % len(styles)]
            ax.semilogy(shifts.x, share, style, color=colour(k), label=name)
        ax.axhline(100 * shifts.least[k] / f, color=colour(k), linewidth=0.8, alpha=0.6)
    ax.set(xlabel="position along the rope [m]", ylabel="shift of frequency, amount [%]")
    legend(ax)
    light_grid(ax)
