"""Figures: each takes axes and returns them, and never shows them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import check
from ..base.array import Index, Real
from ..base.unit import NAME, UNIT, place, power
from ..curves.curves import Curves, named_curves

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..eigen.damage import Damage
    from ..eigen.damped.damped_modes import DampedModes
    from ..eigen.modes import Modes
    from ..response.deflection import Deflection
    from ..study.accuracy import AccuracyCost
    from ..study.effect import EffectCost


COLOR = {"difference": "C3", "rigid": "C0", "tensed": "C1", "continuous": "C2"}
LINE = {"sweep": "-", "lapack": "--", "band": ":"}
"""Of each kind of element, and of each solver."""

CHANGE, TIME = "C0", "C1"
"""Of what an effect changes, and of its share of time."""


def new_axes(ax: Axes | None) -> Axes:
    """Return the axes, or those of a new figure that no window shows."""
    if ax is not None:
        return ax
    return new_figure(1)[1][0]


def new_figure(rows: int, *, height: float = 4.5) -> tuple[Figure, list[Axes]]:
    """Return a figure with axes one above the other; it needs no display and no pyplot."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, height * rows), layout="constrained")
    FigureCanvasAgg(figure)
    axes: Any = figure.subplots(rows, 1, squeeze=False)
    return figure, list(axes[:, 0])


def plot_modes(modes: Modes | DampedModes, ax: Axes | None, coordinate: str | None) -> Axes:
    """Plot shapes of one coordinate along the rope, of complex ones the real part."""
    if coordinate is None:
        coordinate = "z" if "z" in modes.coordinates else modes.coordinates[0]
    check.one_of(coordinate, "coordinate", modes.coordinates)
    at = modes.coordinates.index(coordinate)
    ax = new_axes(ax)
    for k, f in enumerate(modes.frequency):
        ax.plot(
            modes.x, modes.shape[k, :, at].real, label=f"{k + 1}: {f:.4g} Hz, {modes.family[k]}"
        )
    ax.axhline(0.0, color="0.7", linewidth=0.8, zorder=0)
    ax.set(xlabel="position along the rope [m]", ylabel=f"{NAME[coordinate]} [{UNIT[coordinate]}]")
    ax.set_title("mode shapes, largest component of the mode's own coordinate 1")
    ax.legend(title="mode", fontsize="small")
    return ax


def plot_damage(damage: Damage, ax: Axes | None, of: str | None) -> Axes:
    """Plot what a loss changes as colours over modes and positions."""
    of = check.one_of(next(iter(damage.change)) if of is None else of, "of", damage.change)
    value = damage.change[of]
    ax = new_axes(ax)
    rows = np.arange(len(damage.frequency) + 1) + 0.5
    largest = float(np.abs(value).max(initial=0.0)) or 1.0
    colours = ax.pcolormesh(
        damage.edge, rows, value, cmap="RdBu_r", vmin=-largest, vmax=largest, shading="flat"
    )
    ax.set(xlabel="position along the rope [m]", ylabel="mode", yticks=rows[:-1] + 0.5)
    ax.set_yticklabels([f"{k + 1}: {f:.4g} Hz" for k, f in enumerate(damage.frequency)])
    ax.set_title(f"where a loss of {of.replace('_', ' ')} changes frequencies")
    ax.figure.colorbar(colours, ax=ax, label="relative change per relative loss [1/m]")
    return ax


def plot_curves(curves: Curves, ax: Axes | None) -> Axes:
    """Plot amplitudes over frequency on a logarithmic scale."""
    ax = new_axes(ax)
    for name, _, curve in named_curves(curves):
        if curve.any():
            ax.semilogy(curves.frequency, np.abs(curve), label=name)
    drives = ", ".join(map(place, curves.drive))
    ax.set(xlabel="frequency [Hz]", ylabel=f"{curves.quantity}, amplitude")
    ax.set_title(f"frequency response, driven in {drives}")
    ax.grid(True, which="both", color="0.92")
    if ax.lines:
        ax.legend(fontsize="small")
    return ax


def plot_deflection(deflection: Deflection, ax: Axes | None) -> Axes:
    """Plot each coordinate along the rope, scaled to its largest value."""
    ax = new_axes(ax)
    for k, c in enumerate(deflection.coordinates):
        u = deflection.displacement[:, k]
        largest = np.abs(u).max()
        if largest > 0:
            ax.plot(deflection.x, u / largest, label=f"{NAME[c]}, largest {largest:.3g} {UNIT[c]}")
    ax.set(xlabel="position along the rope [m]", ylabel="share of the largest [1]")
    ax.set_title("static deflection")
    ax.legend(fontsize="small")
    return ax


def plot_peaks(frequency: Real, ax: Axes | None, height: Real | None = None) -> Axes:
    """Plot peaks as vertical lines over frequency."""
    ax = new_axes(ax)
    ax.vlines(frequency, 0.0, np.ones_like(frequency) if height is None else height)
    ax.set(xlabel="frequency [Hz]", title="peaks")
    return ax


def plot_accuracy(cost: AccuracyCost, ax: Axes | None) -> Axes:
    """Plot true errors over time from the scene to the answer, one curve for each way."""
    ax = new_axes(ax)
    total = cost.total_seconds
    spread = np.stack([cost.seconds - cost.lower_quartile, cost.upper_quartile - cost.seconds])
    handles: list[Any] = []
    for element, solver in dict.fromkeys(zip(cost.element.tolist(), cost.solver.tolist())):
        rows = (cost.element == element) & (cost.solver == solver) & (cost.refusal == "")
        if not rows.any():
            continue
        n = cost.elements[rows]
        chain = f"{element}, {solver}, {n[0]} to {n[-1]} elements"
        curve = ax.errorbar(
            total[rows],
            cost.error[rows],
            xerr=spread[:, rows],
            label="continuous" if element == "continuous" else chain,
            color=COLOR[element],
            linestyle=LINE[solver],
            marker="*" if element == "continuous" else ".",
            markersize=12 if element == "continuous" else 7,
        )
        handles.append(curve)
    found: dict[int, list[str]] = {}
    for tolerance, row in cost.cheapest.items():
        ax.axhline(tolerance, color="0.6", linewidth=0.8, linestyle=":", zorder=0)
        if row is not None:
            found.setdefault(row, []).append(power(tolerance))
    for (row, tolerances), marker in zip(found.items(), ("o", "s", "D", "^")):
        mark = ax.scatter(
            total[row],
            cost.error[row],
            s=130,
            marker=marker,
            facecolors="none",
            edgecolors="black",
            zorder=3,
            label=f"cheapest for {', '.join(tolerances)}: {cost.way(row)}",
        )
        handles.append(mark)
    ax.set(xscale="log", yscale="log")
    ax.set(xlabel="time from the scene to the answer [s]", ylabel="largest relative error [1]")
    ax.set_title(f"what accuracy costs: {cost.question}")
    ax.grid(True, color="0.92")
    ax.legend(handles=handles, fontsize="small")
    return ax


def plot_effects(cost: EffectCost, ax: Axes | None) -> Axes:
    """Plot a row for each effect: the largest change as a bar, the share of time as a point.

    The largest change is on top; effects without which there is no answer are at the bottom.
    """
    rows, least, most = _effect_rows(cost)
    if ax is None:
        ax = new_figure(1, height=2.0 + 0.3 * len(rows))[1][0]
    y = np.arange(len(rows))
    ax.set(xscale="log", xlim=(least, most), yticks=y, ylim=(len(rows) - 0.5, -0.7))
    notes = (_effect_note(cost, row) for row in rows.tolist())
    ax.set_yticklabels([f"{cost.effect[row]}{note}" for row, note in zip(rows, notes)])
    name, _, unit = next(iter(cost.change)).partition(" ")
    of = "level" if unit == "[dB]" else "frequency"
    ax.set(xlabel=f"{name} change of {of} without the effect {unit}")
    ax.set_title(f"what effects change and cost: {cost.question}", fontsize="medium")
    ax.grid(True, axis="x", color="0.92")
    ax.set_axisbelow(True)
    for k, row in zip(y.tolist(), rows.tolist()):
        change = cost.largest[row]
        if cost.beyond_error[row] and change > 0:
            ax.barh(k, min(change, most) - least, left=least, height=0.5, color=CHANGE, alpha=0.5)
    _plot_shares(cost, rows, ax)
    return ax


def _effect_rows(cost: EffectCost) -> tuple[Index, float, float]:
    """Return effects, those that change most first, and limits of the changes to show."""
    weight = np.where(np.isnan(cost.largest), np.inf, cost.largest)
    weight = np.where(cost.beyond_error, weight, 0.0)
    weight[cost.refusal != ""] = -1.0
    shown = cost.largest[cost.beyond_error & np.isfinite(cost.largest) & (cost.largest > 0)]
    least, most = (shown.min(), shown.max()) if shown.size else (0.1, 1.0)
    least, most = 10 ** np.floor(np.log10(least) - 0.5), 10 ** np.ceil(np.log10(most) + 0.2)
    return np.argsort(-weight, kind="stable"), float(least), float(most)


def _effect_note(cost: EffectCost, row: int) -> str:
    """Say what a bar cannot, on a line of its own."""
    if not cost.beyond_error[row]:
        return f"\n{cost.verdict(row)}"
    lost = int(cost.only_with[row])
    what = "mode" if "rms [Hz]" in cost.change else "response"
    return f"\n{lost} {what}{'s' * (lost > 1)} only with it" if lost else ""


def _plot_shares(cost: EffectCost, rows: Index, ax: Axes) -> None:
    """Plot shares of time with their quartiles on an axis above, filled where they are told."""
    above = ax.twiny()
    share, least, most = (100 * each for each in (cost.share, *cost.share_quartiles))
    for k, row in enumerate(rows.tolist()):
        if cost.refusal[row] == "":
            above.errorbar(
                share[row],
                k,
                xerr=[[share[row] - least[row]], [most[row] - share[row]]],
                color=TIME,
                marker="o",
                markerfacecolor="white" if cost.costs[row] == "the same" else TIME,
                capsize=3,
            )
    above.axvline(0.0, color=TIME, linewidth=0.8, linestyle=":", zorder=0)
    above.set_xlabel(
        "share of the time from the scene to the answer [%], hollow: not told apart", color=TIME
    )
    above.tick_params(axis="x", colors=TIME)
