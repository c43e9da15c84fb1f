"""Figures of what accuracy and effects cost, and of what hard cases keep."""

from __future__ import annotations

from textwrap import fill
from typing import TYPE_CHECKING

import numpy as np

from ..base.array import Index
from ..base.unit import duration, power
from ..study.accuracy import AccuracyCost
from ..study.effect import EffectCost
from ..study.effect_words import BESIDE, beside
from ..study.hard.hard_cases import HardCases
from .figure import BLUE, GREEN, ORANGE, RED, light_grid, plots

if TYPE_CHECKING:
    from matplotlib.axes import Axes

COLOR = {"difference": RED, "rigid": BLUE, "tensed": ORANGE, "continuous": GREEN}
LINE = {"sweep": "-", "auto": "-", "lapack": "--"}
"""Colours of each kind of element, and lines of solvers, dotted those of the others."""
CHANGE, TIME = BLUE, ORANGE
"""Colours of what an effect changes, and of its share of time."""


@plots(AccuracyCost, height=lambda cost: 6.0)
def plot_accuracy(cost: AccuracyCost, ax: Axes) -> None:
    """Plot true errors over time: every way, and the front that no other way beats."""
    from matplotlib.ticker import LogLocator, NullFormatter

    total = cost.total_seconds
    spread = np.stack([cost.seconds - cost.lower_quartile, cost.upper_quartile - cost.seconds])
    for element, solver in dict.fromkeys(zip(cost.element.tolist(), cost.solver.tolist())):
        rows = (cost.element == element) & (cost.solver == solver) & (cost.refusal == "")
        if not rows.any():
            continue
        n = cost.elements[rows]
        chain = f"{element}, {solver}, {n[0]} to {n[-1]} elements"
        ax.errorbar(
            total[rows],
            cost.error[rows],
            xerr=spread[:, rows],
            label="continuous" if element == "continuous" else chain,
            color=COLOR[element],
            linestyle=LINE.get(solver, ":"),
            linewidth=1.0,
            marker="*" if element == "continuous" else ".",
            markersize=12 if element == "continuous" else 7,
        )
    _plot_front(cost, ax)
    for tolerance in cost.cheapest:
        ax.axhline(tolerance, color="0.6", linewidth=0.8, linestyle=":", zorder=0)
    ax.set(xscale="log", yscale="log")
    ax.xaxis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0)))
    ax.xaxis.set_major_formatter(lambda seconds, _: duration(seconds))
    ax.xaxis.set_minor_formatter(NullFormatter())
    ax.set(xlabel="time from the scene to the answer", ylabel="largest relative error [1]")
    ax.set_title(f"{cost.question}\n{fill(cost.verdict, 84)}", fontsize="small")
    light_grid(ax)
    if ax.containers:
        ax.legend(fontsize="small")


def _plot_front(cost: AccuracyCost, ax: Axes) -> None:
    """Plot the ways that no other one beats as steps, and what they take with the error bar."""
    front = cost.front
    if len(front) == 0:
        return
    total, error = cost.total_seconds[front], cost.error[front]
    ax.step(
        total, error, where="post", color="black", linewidth=2.0, alpha=0.4, label="best of all"
    )
    for tolerance, row in cost.cheapest.items():
        if row is not None:
            words = f" {power(tolerance)}: {cost.way(row)}"
            ax.annotate(
                words, (cost.total_seconds[row], tolerance), fontsize="x-small", va="bottom"
            )
    bound = (cost.compile_seconds + cost.seconds_with_bound)[front]
    if np.isfinite(bound).any():
        ax.hlines(error, total, bound, color="black", linewidth=0.8, linestyle=":")
        ax.plot(bound, error, "|", color="black", label="with the error bar read")


@plots(EffectCost, height=lambda cost: 2.0 + 0.3 * len(cost.effect))
def plot_effects(cost: EffectCost, ax: Axes) -> None:
    """Plot a row for each effect: the largest change as a bar, the share of time as a point."""
    # on top what changes most for its time; at the bottom that without which there is no answer
    rows, least, most = _effect_rows(cost)
    y = np.arange(len(rows))
    ax.set(xscale="log", xlim=(least, most), yticks=y, ylim=(len(rows) - 0.5, -0.7))
    notes = (_effect_note(cost, row) for row in rows.tolist())
    ax.set_yticklabels([f"{cost.effect[row]}{note}" for row, note in zip(rows, notes)])
    name, _, unit = next(iter(cost.change)).partition(" ")
    of = {"[dB]": "level", "[Hz]": "frequency"}.get(unit, "the answer")
    ax.set(xlabel=f"{name} change of {of} without the effect {unit}")
    ax.set_title(f"what effects change and cost: {cost.question}", fontsize="medium")
    ax.grid(True, axis="x", color="0.92")
    ax.set_axisbelow(True)
    for k, row in zip(y.tolist(), rows.tolist()):
        change = cost.largest[row]
        if cost.beyond_error[row] and change > 0:
            ax.barh(k, min(change, most) - least, left=least, height=0.5, color=CHANGE, alpha=0.5)
    _plot_shares(cost, rows, ax)


def _effect_rows(cost: EffectCost) -> tuple[Index, float, float]:
    """Return effects by change per time, largest first, and limits of the changes to show."""
    weight = np.where(np.isnan(cost.per_second), np.inf, cost.per_second)
    weight = np.where(cost.beyond_error, weight, -1.0)
    weight[cost.refusal != ""] = -2.0
    shown = cost.largest[cost.beyond_error & np.isfinite(cost.largest) & (cost.largest > 0)]
    least, most = (shown.min(), shown.max()) if shown.size else (0.1, 1.0)
    least, most = 10 ** np.floor(np.log10(least) - 0.5), 10 ** np.ceil(np.log10(most) + 0.2)
    return np.argsort(-weight, kind="stable"), float(least), float(most)


def _effect_note(cost: EffectCost, row: int) -> str:
    """Say what a bar cannot, on a line of its own."""
    if not cost.beyond_error[row]:
        return f"\n{cost.matters[row]}"
    if cost.changed[row] in BESIDE:
        return f"\n{', '.join(beside(cost, row))}"
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


@plots(HardCases, height=lambda table: 1.6 + 0.2 * len(table.case))
def plot_hard_cases(table: HardCases, ax: Axes) -> None:
    """Plot digits kept, a row for each case that has numbers: the hardest at the bottom."""
    rows = np.flatnonzero(~np.isnan(table.promised))
    rows = rows[np.argsort(table.decades[rows], kind="stable")]
    y = np.arange(len(rows))
    ax.hlines(y, table.peer_kept[rows], table.kept[rows], color="0.8", zorder=0)
    ax.scatter(table.promised[rows], y, marker="|", color="black", s=60, label="promised")
    ax.scatter(table.peer_kept[rows], y, marker="x", color=RED, label="SciPy")
    ax.scatter(table.kept[rows], y, marker="o", color=GREEN, s=30, label="ropedyn")
    ax.set(yticks=y, ylim=(len(rows) - 0.4, -0.6), xlim=(-0.4, 16.4))
    names = zip(table.case[rows].tolist(), table.decades[rows].tolist())
    ax.set_yticklabels([f"{name}  [{decades:g}]" for name, decades in names], fontsize="small")
    ax.set(xlabel="right digits", ylabel="case, and how many powers of ten meet in it")
    ax.set_title("what is kept of hard cases, the hardest at the bottom", fontsize="medium")
    ax.grid(True, axis="x", color="0.92")
    ax.set_axisbelow(True)
    ax.legend(fontsize="small", loc="upper center", bbox_to_anchor=(0.5, -0.05), ncols=3)
