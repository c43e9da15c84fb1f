"""Figures of identification."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base import check
from .answers import new_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..experiment.identify.fit import Fit
    from ..experiment.identify.fits import Fits
    from ..experiment.identify.response_fit import ResponseFit


def plot_fit(fit: Fit, ax: Axes | None) -> Axes:
    """Plot residuals over orders, in per cent of the measured frequency."""
    ax = new_axes(ax)
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
    ax.grid(True, color="0.92")
    return ax


def plot_fits(fits: Fits, ax: Axes | None, unknown: str | None) -> Axes:
    """Plot one number of many ropes."""
    path = fits.unknown[0] if unknown is None else check.one_of(unknown, "unknown", fits.unknown)
    at, ax = fits.unknown.index(path), new_axes(ax)
    std = fits.std[:, at]
    error = np.where(np.isfinite(std), std, 0.0)
    ax.errorbar(np.arange(len(fits)), fits.value[:, at], yerr=error, fmt="o", capsize=3)
    ax.set(xlabel="rope", ylabel=path)
    ax.grid(True, color="0.92")
    return ax


def plot_response_fit(fit: ResponseFit, ax: Axes | None) -> Axes:
    """Plot measured amplitudes as dots and calculated ones as lines over frequency."""
    ax = new_axes(ax)
    for name, measured, calculated in zip(fit.labels, fit.measured, fit.calculated):
        (line,) = ax.semilogy(fit.frequency, np.abs(calculated), label=name)
        ax.semilogy(fit.frequency, np.abs(measured), ".", color=line.get_color(), markersize=3)
    ax.set(xlabel="frequency [Hz]", ylabel=f"amplitude of the {fit.quantity}")
    ax.set_title(_found(fit))
    ax.legend(title="line calculated, dots measured", fontsize="small")
    ax.grid(True, color="0.92")
    return ax


def _found(fit: Fit | ResponseFit) -> str:
    """Return what was found in a few digits."""
    return "identified: " + ", ".join(f"{path} {value:.5g}" for path, value in fit.value.items())
