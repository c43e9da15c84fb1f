"""Figures over frequency and over time, and of growth."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base import check
from ..base.unit import place
from ..curves.curves import Curves, named_curves
from ..curves.peaks import Peaks
from ..curves.resonance import Resonances
from ..family.frf import FamilyFRF
from ..family.modes import FamilyModes
from ..motion.history import History
from ..motion.periodic.branches import Branches
from ..parametric.floquet import Floquet
from ..parametric.stability import StabilityMap
from ..parametric.tongues import Boundary
from ..signal.ringdown import RingDown
from ..signal.spectrum import Spectrum
from .figure import (
    BLUE,
    RED,
    amplitudes,
    below,
    colour,
    legend,
    light_grid,
    plots,
    unbroken,
    with_unit,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

LABELS = 32  # Height of the names of tongues [pt].
APART = 0.02  # So much of the width they have at least.


@plots(Curves)
def plot_curves(curves: Curves, ax: Axes, *, phase: bool = False) -> None:
    """Plot amplitudes over frequency on a logarithmic scale, and phases below."""
    check.instance(phase, "phase", bool, "True or False")
    under = below(ax) if phase else None
    for name, _, curve in named_curves(curves):
        if curve.any():
            ax.semilogy(curves.frequency, np.abs(curve), label=name)
        if under is not None and curve.any():
            under.plot(*unbroken(curves.frequency, np.degrees(np.angle(curve))))
    ax.set_title(f"frequency response, driven in {', '.join(map(place, curves.drive))}")
    amplitudes(ax, curves.quantity)
    if under is not None:
        ax.set_xlabel("")
        ax.tick_params(labelbottom=False)
        light_grid(under)
        under.set(xlabel="frequency [Hz]", ylabel="phase [degrees]", ylim=(-190.0, 190.0))
        under.set_yticks([-180, -90, 0, 90, 180])


@plots(Branches)
def plot_branches(branches: Branches, ax: Axes) -> None:
    """Plot amplitudes over frequency on a logarithmic scale, dashed where motion is not stable."""
    for branch in branches:
        for name, r, curve in named_curves(branch):
            stable = np.asarray(branch.stable, dtype=np.bool_)
            for these, style, told in ((stable, "-", name), (~stable, "--", "_" + name)):
                shown = np.where(these, np.abs(curve), np.nan)
                ax.semilogy(branch.frequency, shown, style, color=colour(r), label=told)
    ax.set_title(f"steady motion, driven in {', '.join(map(place, branches.drive))}")
    amplitudes(ax, branches.quantity)


@plots(FamilyFRF)
def plot_family_frf(found: FamilyFRF, ax: Axes) -> None:
    """Plot the first response of every row over frequency on a logarithmic scale."""
    for row in found.value.reshape(len(found.value), -1, len(found.frequency))[:, 0]:
        ax.semilogy(found.frequency, np.abs(row), linewidth=0.8)
    ax.set(xlabel="frequency [Hz]", ylabel=f"{found.quantity}, amplitude")
    light_grid(ax)


@plots(FamilyModes)
def plot_family_modes(found: FamilyModes, ax: Axes) -> None:
    """Plot every mode over the rows."""
    for k, frequency in enumerate(found.frequency.T, start=1):
        ax.plot(frequency, ".-", label=k)
    ax.set(xlabel="row", ylabel="frequency [Hz]")
    ax.locator_params(axis="x", integer=True)
    if ax.lines:
        legend(ax, "mode")
    light_grid(ax)


@plots(Spectrum)
def plot_spectrum(spectrum: Spectrum, ax: Axes) -> None:
    """Plot amplitudes over frequency on a logarithmic scale."""
    for name, amplitude in zip(spectrum.labels, spectrum.amplitude):
        if amplitude.any():
            ax.semilogy(spectrum.frequency, amplitude, linewidth=1.0, label=name)
    ax.set_title(f"spectrum, window {spectrum.window}")
    amplitudes(ax, spectrum.quantity)


@plots(Peaks)
@plots(Resonances)
def plot_peaks(peaks: Peaks | Resonances, ax: Axes) -> None:
    """Plot peaks as vertical lines over frequency, as high as their amplitudes if they have any."""
    height = np.ones_like(peaks.frequency)
    if isinstance(peaks, Resonances):
        height = peaks.amplitude
        ax.set_ylabel(f"amplitude of {peaks.label}")
    ax.vlines(np.asarray(peaks.frequency), 0.0, height)
    ax.set(xlabel="frequency [Hz]", title="peaks")


@plots(History)
def plot_history(history: History, ax: Axes) -> None:
    """Plot the responses over time."""
    for name, value in zip(history.labels, history.value):
        ax.plot(history.time, value, linewidth=1.0, label=name)
    ax.set(xlabel="time [s]", ylabel=with_unit(ax, history.quantity), title="motion over time")
    light_grid(ax)
    legend(ax)


@plots(RingDown)
def plot_ring_down(found: RingDown, ax: Axes) -> None:
    """Plot damping ratios over frequency, with standard errors."""
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
    light_grid(ax)


@plots(Floquet)
def plot_floquet(floquet: Floquet, ax: Axes) -> None:
    """Plot multipliers in the complex plane."""
    angle = np.linspace(0.0, 2 * np.pi, 361)
    ax.plot(np.cos(angle), np.sin(angle), color="0.7", linewidth=0.8, label="unit circle")
    grows = np.abs(floquet.multiplier) > 1 + floquet.rounding_error
    for these, color, name in ((~grows, BLUE, "stays or decays"), (grows, RED, "grows")):
        value = floquet.multiplier[these]
        if value.size:
            ax.plot(value.real, value.imag, "o", color=color, label=name)
    ax.set(xlabel="real part", ylabel="imaginary part", aspect="equal")
    ax.set_title(f"multipliers over one period, {1 / floquet.period:.4g} Hz")
    ax.legend(fontsize="small")


@plots(StabilityMap)
def plot_stability(stability: StabilityMap, ax: Axes) -> None:
    """Plot growth as colours over frequency and amplitude."""
    # dashed: the boundaries of tongues of order 1 without damping, to first order in the amplitude
    f, a = stability.frequency, stability.amplitude
    shown = np.ma.masked_where(stability.stable, stability.growth)
    if shown.count():
        colours = ax.pcolormesh(f, a, shown, shading="nearest", cmap="Reds", vmin=0.0)
        ax.figure.colorbar(colours, ax=ax, label="growth [1/s]")
    named = -np.inf
    for tongue in sorted(stability.tongues, key=lambda one: one.frequency):
        if tongue.order == 1:
            side = tongue.spread * a[-1]
            wedge = tongue.frequency + np.array([-side, 0.0, side])
            ax.plot(wedge, [a[-1], 0.0, a[-1]], color="0.4", linewidth=0.6, linestyle="--")
            # no name stands on that of the tongue before
            named = max(tongue.frequency, named + APART * (f[-1] - f[0]))
            ax.annotate(
                tongue.label,
                (named, 1.0),
                xycoords=("data", "axes fraction"),
                textcoords="offset points",
                xytext=(0, 3),
                rotation=60,
                rotation_mode="anchor",
                fontsize="x-small",
            )
    ax.set(xlabel="frequency of the tension [Hz]", ylabel="amplitude of the tension [N]")
    ax.set(xlim=(f[0], f[-1]), ylim=(a[0], a[-1]) if len(a) > 1 else None)
    ax.set_title("where transverse motion grows", pad=LABELS if stability.tongues else None)


@plots(Boundary)
def plot_boundary(boundary: Boundary, ax: Axes) -> None:
    """Mark where stability changes, each edge beside the order of its resonance."""
    orders = np.unique(boundary.order)
    ax.plot(boundary.frequency, boundary.order, "|", color=RED, markersize=24, markeredgewidth=1.5)
    ax.set(xlabel="frequency of the tension [Hz]", ylabel="order of the resonance", yticks=orders)
    if orders.size:
        ax.set_ylim(orders[0] - 0.5, orders[-1] + 0.5)
    else:
        nowhere = "nowhere between the frequencies of the map"
        ax.text(0.5, 0.5, nowhere, transform=ax.transAxes, ha="center")
        ax.set(xticks=[])
    ax.set_title(boundary.table().title)
    light_grid(ax)
