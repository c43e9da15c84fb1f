"""Modes in motion: one period of a shape, in a notebook or in a file."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import check
from ..base.answer import Frozen
from ..base.array import Real
from ..base.atomic import replacing
from ..base.errors import SceneError
from ..base.unit import FAMILY, NAME, UNIT
from .answers import new_figure

if TYPE_CHECKING:
    from matplotlib.animation import AbstractMovieWriter
    from matplotlib.lines import Line2D

    from ..eigen.damped.damped_modes import DampedModes
    from ..eigen.modes import Modes

SMALL = 1e-6
"""A coordinate that moves less beside the mode's own (rad, or parts of the length) is not shown."""


@dataclass(frozen=True, eq=False, repr=False)
class Animation(Frozen):
    """One period of a mode, Re(shape e^(i omega t)): a notebook shows it, `save` writes it.

    Attributes
    ----------
    title : str
        Mode, frequency and family.
    coordinates : tuple of str
        Those that are shown, the mode's own first, each in a panel of its own: a shape in metres is
        far larger than a rope moves. The bending rotation is shown where it is the mode's own.
    x : ndarray, shape (nodes,)
        Where the shape is given [m].
    motion : ndarray, shape (frames, nodes, coordinates)
        The shape at equal steps through the period [m, rad].
    envelope : ndarray, shape (nodes, coordinates)
        How far each place moves [m, rad].
    seconds : float
        What the period takes on the screen [s].
    """

    title: str
    coordinates: tuple[str, ...]
    x: Real
    motion: Real
    envelope: Real
    seconds: float

    def __repr__(self) -> str:
        return f"<Animation of {self.title}, {len(self.motion)} frames>"

    def _repr_html_(self) -> str:
        return self.to_html()

    def to_html(self) -> str:
        """Return the frames and what plays them as HTML.

        Examples
        --------
        >>> import ropedyn as rd
        >>> modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile(elements=4).modes(1)
        >>> modes.animate(0, frames=2).to_html().count("data:image/png;base64")
        2
        """
        from tempfile import TemporaryDirectory

        with TemporaryDirectory() as folder:
            file = Path(folder, "animation.html")
            self._write(file)
            return file.read_text(encoding="utf-8")

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the animation as a file, whole or not at all.

        Parameters
        ----------
        path : path
            ``.gif``, ``.html`` or, where ffmpeg is installed, ``.mp4``.

        Raises
        ------
        TypeError
            If it is no path.
        SceneError
            If it has another suffix, or ``.mp4`` and ffmpeg is not installed.
        OSError
            If the file cannot be written.

        Examples
        --------
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> import ropedyn as rd
        >>> modes = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0).compile(elements=4).modes(1)
        >>> with TemporaryDirectory() as folder:
        ...     modes.animate(0, frames=2).save(Path(folder, "mode.gif"))
        ...     Path(folder, "mode.gif").read_bytes()[:6]
        b'GIF89a'
        """
        file = check.path(path)
        _writer(file, 1.0)
        with replacing(file) as draft:
            self._write(draft)

    def _write(self, file: Path) -> None:
        rows = len(self.coordinates)
        figure, panels = new_figure(rows, height=2.4 + 1.0 / rows)
        lines = [self._panel(k, ax) for k, ax in enumerate(panels)]
        panels[0].set_title(self.title)
        panels[-1].set_xlabel("position along the rope [m]")
        # the layout is found once: finding it again takes longer than a frame
        figure.draw_without_rendering()
        figure.set_layout_engine("none")
        writer = _writer(file, len(self.motion) / self.seconds)
        with writer.saving(figure, str(file), dpi=80):
            for frame in self.motion:
                for line, u in zip(lines, frame.T):
                    line.set_ydata(u)
                writer.grab_frame()

    def _panel(self, k: int, ax: Any) -> Line2D:
        """Draw what stands still of a coordinate, and return the line that moves."""
        c, far = self.coordinates[k], self.envelope[:, k]
        ax.fill_between(self.x, -far, far, color="0.93")
        ax.axhline(0.0, color="0.7", linewidth=0.8)
        ax.set(xlim=(self.x[0], self.x[-1]), ylabel=f"{NAME[c]} [{UNIT[c]}]")
        ax.set_ylim(*(1.1 * far.max() * np.array([-1.0, 1.0])))
        (line,) = ax.plot(self.x, self.motion[0, :, k], linewidth=2.0)
        return line


def animated(
    modes: Modes | DampedModes,
    k: int,
    *,
    path: str | os.PathLike[str] | None,
    frames: int,
    seconds: float,
) -> Animation:
    """Make the animation of one mode; see `FreeMotion.animate`."""
    check.count(k, "k", least=0, most=len(modes.frequency) - 1)
    count = check.count(frames, "frames", least=2, most=1000)
    duration = check.number(seconds, "seconds", "s", sign="positive")
    f = modes.frequency[k]
    if not f > 0:
        raise SceneError(f"k must be that of a mode that oscillates, got {k}, whose frequency is 0")
    shown = _shown(modes, k)
    shape = modes.shape[k][:, [modes.coordinates.index(c) for c in shown]]
    turn = np.exp(2j * np.pi * np.arange(count) / count)
    animation = Animation(
        f"mode {k + 1}: {f:.4g} Hz, {modes.family[k]}",
        shown,
        modes.x,
        (turn[:, None, None] * shape).real,
        np.abs(shape),
        duration,
    )
    if path is not None:
        animation.save(path)
    return animation


def _shown(modes: Modes | DampedModes, k: int) -> tuple[str, ...]:
    """Return the mode's own coordinate and the others that move; beta follows from z."""
    length = modes.x[-1] - modes.x[0]
    far = np.abs(modes.shape[k]).max(axis=0) / np.where(
        np.isin(modes.coordinates, ("x", "z")), length, 1.0
    )
    own = next(c for c in modes.coordinates if FAMILY[c] == modes.family[k])
    least = SMALL * far[modes.coordinates.index(own)]
    others = (c for c, size in zip(modes.coordinates, far) if size > least)
    return (own, *(c for c in others if c not in (own, "beta")))


def _writer(file: Path, rate: float) -> AbstractMovieWriter:
    """Return what writes frames [1/s] into a file of this name."""
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
    return makers[suffix](fps=rate)
