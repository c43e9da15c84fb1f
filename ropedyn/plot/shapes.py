"""Figures of what stands along the rope: modes, damage, deflections, snapshots, plans."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.errors import SceneError
from ..base.unit import NAME, UNIT, place
from ..eigen.damage import Damage
from ..eigen.free_motion import FreeMotion
from ..experiment.plan.plan import Plan
from ..motion.history import History
from ..response.deflection import Deflection
from .figure import along_the_rope, colour, coordinate_of, legend, plots

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..eigen.damped.damped_modes import DampedModes
    from ..eigen.modes import Modes


AT_ENDS = 0.05  # Part of the rope at each end.


@plots(FreeMotion)
def plot_modes(modes: Modes | DampedModes, ax: Axes, coordinate: str | None) -> None:
    """Plot shapes of one coordinate, of complex ones the real part; modes in y show y."""
    shown = coordinate_of(modes, coordinate)
    for k, f in enumerate(modes.frequency):
        across = coordinate is None and modes.plane[k] == "y"
        at = modes.coordinates.index("y" if across else shown)
        label = f"{k + 1}: {f:.4g} Hz, {modes.family[k]}{' in the plane of y' if across else ''}"
        ax.plot(modes.x, modes.shape[k, :, at].real, label=label)
    along_the_rope(ax, shown)
    ax.set_title("mode shapes, largest component of the mode's own coordinate 1")
    legend(ax, "mode")


@plots(History, "snapshots")
def plot_snapshots(history: History, ax: Axes, coordinate: str | None) -> None:
    """Plot one coordinate, early times dark and late ones bright."""
    coordinate = coordinate_of(history, coordinate)
    times = history.snapshot_time
    if len(times) == 0:
        raise SceneError("snapshots must have been asked for, got none")
    from matplotlib import colormaps

    at = history.coordinates.index(coordinate)
    shades = colormaps["viridis"](np.linspace(0.0, 0.9, len(times)))
    for time, shape, shade in zip(times, history.snapshot[:, :, at], shades):
        ax.plot(history.x, shape, color=shade, label=f"{time:.4g} s")
    along_the_rope(ax, coordinate)
    ax.set_title("the rope over time")
    ax.legend(title="time", fontsize="small", ncols=1 + len(times) // 12)


@plots(Damage)
def plot_damage(damage: Damage, ax: Axes, of: str | None) -> None:
    """Plot what a loss changes as colours over modes and positions."""
    of = check.one_of(next(iter(damage.change)) if of is None else of, "of", damage.change)
    value = damage.change[of]
    rows = np.arange(len(damage.frequency) + 1) + 0.5
    largest = _within(damage.edge, value)
    colours = ax.pcolormesh(
        damage.edge, rows, value, cmap="RdBu_r", vmin=-largest, vmax=largest, shading="flat"
    )
    ax.set(xlabel="position along the rope [m]", ylabel="mode", yticks=rows[:-1] + 0.5)
    ax.set_yticklabels([f"{k + 1}: {f:.4g} Hz" for k, f in enumerate(damage.frequency)])
    ax.set_title(f"where a loss of {of.replace('_', ' ')} changes frequencies")
    beyond = "both" if np.abs(value).max(initial=0.0) > largest else "neither"
    label = "relative change per relative loss [1/m]"
    ax.figure.colorbar(colours, ax=ax, label=label, extend=beyond)


def _within(edge: Real, value: Real) -> float:
    """Return the largest change away from the ends, whose layers would hide all others."""
    middle = (edge[1:] + edge[:-1]) / 2 - edge[0]
    inner = np.abs(middle / (edge[-1] - edge[0]) - 0.5) < 0.5 - AT_ENDS
    return float(np.abs(value[:, inner]).max(initial=0.0) or np.abs(value).max(initial=0.0)) or 1.0


@plots(Deflection)
def plot_deflection(deflection: Deflection, ax: Axes) -> None:
    """Plot each coordinate, scaled to its largest value."""
    for k, c in enumerate(deflection.coordinates):
        u = deflection.displacement[:, k]
        largest = np.abs(u).max()
        if largest > 0:
            ax.plot(deflection.x, u / largest, label=f"{NAME[c]}, largest {largest:.3g} {UNIT[c]}")
    ax.set(xlabel="position along the rope [m]", ylabel="share of the largest [1]")
    ax.set_title(deflection.table().title)
    ax.legend(fontsize="small")


@plots(Plan)
def plot_plan(plan: Plan, ax: Axes) -> None:
    """Plot how far each mode moves over its largest, and the chosen places."""
    same = plan.drive[0] == plan.response[0][0]
    for k, (mode, f) in enumerate(zip(plan.mode.tolist(), plan.frequency.tolist())):
        name = f"{mode}: {f:.4g} Hz, seen {100 * plan.seen[k]:.0f} %"
        ax.plot(plan.x, np.abs(plan.driven[k]), color=colour(k), label=name)
        if not same:
            ax.plot(plan.x, np.abs(plan.heard[k]), color=colour(k), linestyle="--")
    ax.axvline(plan.drive[1], color="black", label=f"drive {place(plan.drive)}")
    for response in plan.response:
        ax.axvline(response[1], color="black", linestyle=":", label=f"listen to {place(response)}")
    coordinate = plan.drive[0] if same else f"{plan.drive[0]} (dashed: {plan.response[0][0]})"
    ax.set(xlabel="position along the rope [m]", ylabel=f"|{coordinate}| over its largest [1]")
    ax.set(ylim=(0.0, 1.05), title="where modes can be driven and heard")
    legend(ax, "mode")
