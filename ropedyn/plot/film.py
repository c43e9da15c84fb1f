"""Animations as files."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.atomic import replacing
from ..base.drawing import draws
from ..base.errors import SceneError
from ..base.unit import NAME, UNIT
from ..eigen.animation import Animation
from .figure import BLUE, new_figure
from .space import axes_of, line_in_space, name_space, seen

if TYPE_CHECKING:
    from matplotlib.animation import AbstractMovieWriter
    from matplotlib.lines import Line2D


@draws(Animation, "film")
def film(animation: Animation, file: Path) -> None:
    """Write a file as its name says, whole or not at all."""
    writer = _writer(file)
    with replacing(file) as draft:
        scene = _in_panels(animation) if animation.rest is None else _in_space(animation)
        figure = scene.figure
        # the layout is found once: finding it again takes longer than a frame
        figure.draw_without_rendering()
        figure.set_layout_engine("none")
        frames = writer(fps=len(animation.motion) / animation.seconds)
        with frames.saving(figure, str(draft), dpi=80):
            for frame in animation.motion:
                scene.move(frame)
                frames.grab_frame()


class Film(NamedTuple):
    """A figure, and what takes it to a frame (nodes, coordinates)."""

    figure: Any
    move: Callable[[Real], None]


def _in_panels(animation: Animation) -> Film:
    rows = len(animation.coordinates)
    figure, panels = new_figure(rows, height=2.4 + 1.0 / rows)
    lines = [_panel(animation, k, ax) for k, ax in enumerate(panels)]
    panels[0].set_title(animation.title)
    panels[-1].set_xlabel("position along the rope [m]")

    def move(frame: Real) -> None:
        for line, u in zip(lines, frame.T):
            line.set_ydata(u)

    return Film(figure, move)


def _in_space(animation: Animation) -> Film:
    rest, view = animation.rest, animation.view
    assert rest is not None
    ax: Any = axes_of(view)
    line_in_space(ax, rest, view, color="0.6", linewidth=1.0)
    line = line_in_space(ax, rest + animation.motion[0], view, color=BLUE, linewidth=2.0)
    ax.set_title(animation.title)
    name_space(ax, np.concatenate([rest - animation.envelope, rest + animation.envelope]), view)

    def move(frame: Real) -> None:
        at = seen(rest + frame, view)
        (line.set_data_3d if len(at) == 3 else line.set_data)(*at)

    return Film(ax.figure, move)


def _panel(animation: Animation, k: int, ax: Any) -> Line2D:
    """Draw what stands still of a coordinate, and return the line that moves."""
    c, x, far = animation.coordinates[k], animation.x, animation.envelope[:, k]
    ax.fill_between(x, -far, far, color="0.93")
    ax.axhline(0.0, color="0.7", linewidth=0.8)
    ax.set(xlim=(x[0], x[-1]), ylabel=f"{NAME[c]} [{UNIT[c]}]")
    ax.set_ylim(*(1.1 * far.max() * np.array([-1.0, 1.0])))
    (line,) = ax.plot(x, animation.motion[0, :, k], linewidth=2.0)
    return line


def _writer(file: Path) -> Callable[..., AbstractMovieWriter]:
    """Return what writes frames into a file of this name."""
    from matplotlib.animation import FFMpegWriter, HTMLWriter, PillowWriter

    makers: dict[str, Callable[..., AbstractMovieWriter]] = {
        ".gif": PillowWriter,
        ".html": partial(HTMLWriter, embed_frames=True, embed_limit=np.inf),
        ".mp4": FFMpegWriter,
    }
    suffix = file.suffix.lower()
    if suffix not in makers:
        raise SceneError(f"path must end in {', '.join(makers)}, got {check.shown(str(file))}")
    if suffix == ".mp4" and not FFMpegWriter.isAvailable():
        raise SceneError(
            f"path must end in .gif or .html where ffmpeg is not installed, got "
            f"{check.shown(str(file))}"
        )
    return makers[suffix]
