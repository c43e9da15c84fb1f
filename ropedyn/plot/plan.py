"""Figure of the plan of a measurement."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.unit import place
from .answers import new_axes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..experiment.plan.plan import Plan


def plot_plan(plan: Plan, ax: Axes | None) -> Axes:
    """Plot how far each mode moves along the rope over its largest, and the chosen places."""
    ax = new_axes(ax)
    same = plan.drive[0] == plan.response[0][0]
    for k, (mode, f) in enumerate(zip(plan.mode.tolist(), plan.frequency.tolist())):
        name = f"{mode}: {f:.4g} Hz, seen {100 * plan.seen[k]:.0f} %"
        ax.plot(plan.x, np.abs(plan.driven[k]), color=f"C{k % 10}", label=name)
        if not same:
            ax.plot(plan.x, np.abs(plan.heard[k]), color=f"C{k % 10}", linestyle="--")
    ax.axvline(plan.drive[1], color="black", label=f"drive {place(plan.drive)}")
    for response in plan.response:
        ax.axvline(response[1], color="black", linestyle=":", label=f"listen to {place(response)}")
    coordinate = plan.drive[0] if same else f"{plan.drive[0]} (dashed: {plan.response[0][0]})"
    ax.set(xlabel="position along the rope [m]", ylabel=f"|{coordinate}| over its largest [1]")
    ax.set(ylim=(0.0, 1.05), title="where modes can be driven and heard")
    ax.legend(title="mode", fontsize="small")
    return ax
