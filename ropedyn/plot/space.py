"""Figures of ropes in space: the axis, and a mode on it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..base.array import Real
from ..base.drawing import draws
from ..base.errors import SceneError
from ..eigen.animation import extent
from ..space.compile import axis_of
from ..space.model import SpaceModel
from ..space.shape import ShapeInSpace
from .figure import BLUE, light_grid, new_figure

if TYPE_CHECKING:
    from matplotlib.axes import Axes

POINTS = 400  # Of an axis that is drawn alone.
SEEN = {"front": (0, 2), "top": (0, 1), "side": (1, 2)}
"""Directions of space that a view shows, to the right and up."""


@draws(SpaceModel)
def plot_in_space(
    model: SpaceModel, ax: Axes | None, *, shape: ShapeInSpace | None, view: str
) -> Axes:
    """Plot the axis, and a shape beside it, as they look from one side."""
    ax = axes_of(view) if ax is None else ax
    if view == "isometric" and not hasattr(ax, "set_zlabel"):
        raise SceneError('ax must have the projection "3d" for an isometric view, got a plane one')
    axis = axis_of(model.scene)
    rest = axis.position(np.linspace(0.0, axis.length, POINTS)) if shape is None else shape.rest
    line_in_space(ax, rest, view, color="0.6", linewidth=1.0, label="at rest")
    if shape is not None:
        line_in_space(ax, shape.moved, view, color=BLUE, linewidth=1.8, label=shape.title)
        ax.set_title(shape.title)
    name_space(ax, rest, view)
    return ax


def axes_of(view: str) -> Axes:
    """Return the axes of a new figure for a view."""
    figure, (ax,) = new_figure(1, height=6.0)
    if view != "isometric":
        return ax
    ax.remove()
    found: Axes = figure.add_subplot(projection="3d")
    return found


def line_in_space(ax: Any, points: Real, view: str, **how: Any) -> Any:
    """Draw a line through points (n, 3), and return it."""
    return ax.plot(*seen(points, view), **how)[0]


def seen(points: Real, view: str) -> list[Real]:
    """Return the coordinates of points that a view shows."""
    return [points[:, i] for i in SEEN.get(view, (0, 1, 2))]


def name_space(ax: Any, rest: Real, view: str) -> None:
    """Name the directions, and give them one scale."""
    if view == "isometric":
        ax.set(xlabel="X [m]", ylabel="Y [m]", zlabel="Z [m]")
        ax.view_init(elev=35.264, azim=-45.0)
        half, middle = max(extent(rest) / 2, 1e-9), (rest.max(axis=0) + rest.min(axis=0)) / 2
        low, high = middle - half, middle + half
        ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), zlim=(low[2], high[2]))
        ax.set_box_aspect((1, 1, 1))
        return
    right, up = ("XYZ"[i] for i in SEEN[view])
    ax.set(xlabel=f"{right} [m]", ylabel=f"{up} [m]")
    ax.set_aspect("equal", adjustable="datalim")
    light_grid(ax)
