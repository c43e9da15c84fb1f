"""Figures that need no display and no pyplot, and what several of them have."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.drawing import draws
from ..base.errors import SceneError
from ..base.table import Key
from ..base.unit import NAME, UNIT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Plot = Callable[..., None]
NAMED = 16  # Curves that a legend beside a figure has room for.
BLUE, ORANGE, GREEN, RED, PURPLE, SKY, BLACK = PALETTE = (
    "#0072B2",
    "#E69F00",
    "#009E73",
    "#D55E00",
    "#CC79A7",
    "#56B4E9",
    "#000000",
)
"""Colours that the colour-blind tell apart (Okabe and Ito 2008)."""


def colour(k: int) -> str:
    """Return that of the k-th of several."""
    return PALETTE[k % len(PALETTE)]


def new_figure(rows: int, *, height: float = 4.5) -> tuple[Figure, list[Axes]]:
    """Return a figure with axes one above the other."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, height * rows), layout="constrained")
    FigureCanvasAgg(figure)
    axes: Any = figure.subplots(rows, 1, squeeze=False)
    for ax in axes[:, 0]:
        ax.set_prop_cycle(color=PALETTE)
    return figure, list(axes[:, 0])


def plots(
    kind: type[Any], verb: str = "plot", *, height: Callable[[Any], float] = lambda _: 4.5
) -> Callable[[Plot], Plot]:
    """Register what plots a kind into given axes, or those of a new figure of this height [in]."""

    def register(plot: Plot) -> Plot:
        @draws(kind, verb)
        @wraps(plot)
        def drawing(thing: Any, ax: Axes | None, **options: Any) -> Axes:
            ax = new_figure(1, height=height(thing))[1][0] if ax is None else ax
            plot(thing, ax, **options)
            return ax

        return plot

    return register


def coordinate_of(thing: Any, coordinate: str | None) -> str:
    """Return the coordinate to show: the one asked for, else z where there is one."""
    if coordinate is None:
        coordinate = "z" if "z" in thing.coordinates else thing.coordinates[0]
    return check.one_of(coordinate, "coordinate", thing.coordinates)


def along_the_rope(ax: Axes, coordinate: str) -> None:
    """Name the axes of a coordinate along the rope, and mark where it is 0."""
    ax.axhline(0.0, color="0.7", linewidth=0.8, zorder=0)
    ax.set(xlabel="position along the rope [m]", ylabel=f"{NAME[coordinate]} [{UNIT[coordinate]}]")


def amplitudes(ax: Axes, quantity: str) -> None:
    """Name the axes of logarithmic amplitudes over frequency, and what is drawn into them."""
    ax.set(xlabel="frequency [Hz]", ylabel=with_unit(ax, f"{quantity}, amplitude"))
    ax.grid(True, which="both", color="0.92")
    if ax.lines:
        ax.legend(fontsize="small")


def with_unit(ax: Axes, words: str) -> str:
    """Return the name of an axis with the unit of what is drawn, where all has the same one."""
    units = {Key.of(name).unit for name in ax.get_legend_handles_labels()[1]} - {""}
    return f"{words} [{units.pop()}]" if len(units) == 1 else words


def unbroken(frequency: Real, phase: Real) -> tuple[Real, Real]:
    """Part a phase where it goes around [degrees], so that no line crosses the figure."""
    around = np.flatnonzero(np.abs(np.diff(phase)) > 180.0) + 1
    return np.insert(frequency, around, np.nan), np.insert(phase, around, np.nan)


def below(ax: Axes) -> Axes:
    """Return axes under these, which give them a third of their height."""
    spec = ax.get_subplotspec()
    if spec is None:
        raise SceneError("ax must be one of a grid of subplots where the phase is shown")
    grid: Any = spec.subgridspec(2, 1, height_ratios=(2, 1))
    ax.set_subplotspec(grid[0])
    under: Axes = ax.figure.add_subplot(grid[1], sharex=ax)
    under.set_prop_cycle(color=PALETTE)
    return under


def legend(ax: Axes, title: str | None = None) -> None:
    """Name what is drawn beside it, where room is made for that; else within."""
    place: dict[str, Any] = {"loc": "best"}
    figure = ax.get_figure()
    if figure is not None and figure.get_layout_engine() is not None:
        place = {"loc": "upper left", "bbox_to_anchor": (1.0, 1.0)}
    curves, names = ax.get_legend_handles_labels()
    if len(names) > NAMED:
        left = len(names) - NAMED + 1
        curves, names = curves[: NAMED - 1], names[: NAMED - 1]
        curves += ax.plot([], [], " ")
        names.append(f"and {left} more")
    ax.legend(curves, names, title=title, fontsize="small", **place)


def light_grid(ax: Axes) -> None:
    """Draw a grid that stays behind what is drawn."""
    ax.grid(True, color="0.92")
