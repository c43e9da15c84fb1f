"""Figures of growth under a tension that pulsates."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .answers import new_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..parametric.floquet import Floquet
    from ..parametric.stability import StabilityMap


LABELS = 32
"""Height of the names of tongues [pt]."""


def plot_floquet(floquet: Floquet, ax: Axes | None) -> Axes:
    """Plot multipliers in the complex plane."""
    ax = new_axes(ax)
    angle = np.linspace(0.0, 2 * np.pi, 361)
    ax.plot(np.cos(angle), np.sin(angle), color="0.7", linewidth=0.8, label="unit circle")
    grows = np.abs(floquet.multiplier) > 1 + floquet.rounding_error
    for these, color, name in ((~grows, "C0", "stays or decays"), (grows, "C3", "grows")):
        value = floquet.multiplier[these]
        if value.size:
            ax.plot(value.real, value.imag, "o", color=color, label=name)
    ax.set(xlabel="real part", ylabel="imaginary part", aspect="equal")
    ax.set_title(f"multipliers over one period, {1 / floquet.period:.4g} Hz")
    ax.legend(fontsize="small")
    return ax


def plot_stability(stability: StabilityMap, ax: Axes | None) -> Axes:
    """Plot growth as colours over frequency and amplitude.

    Dashed: the boundaries of tongues of order 1 without damping, to first order in the amplitude.
    """
    ax = new_axes(ax)
    f, a = stability.frequency, stability.amplitude
    shown = np.ma.masked_where(stability.stable, stability.growth)
    if shown.count():
        colours = ax.pcolormesh(f, a, shown, shading="nearest", cmap="Reds", vmin=0.0)
        ax.figure.colorbar(colours, ax=ax, label="growth [1/s]")
    for tongue in stability.tongues:
        if tongue.order == 1:
            side = tongue.spread * a[-1]
            wedge = tongue.frequency + np.array([-side, 0.0, side])
            ax.plot(wedge, [a[-1], 0.0, a[-1]], color="0.4", linewidth=0.6, linestyle="--")
            ax.annotate(
                tongue.label,
                (tongue.frequency, 1.0),
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
    return ax
