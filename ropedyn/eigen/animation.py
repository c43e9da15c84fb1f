"""Modes in motion: one period of a shape, in a notebook or in a file."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..axis.axis import Axis
from ..base import check
from ..base.answer import Frozen
from ..base.array import Complex, Real
from ..base.drawing import draw

SMALL = 1e-6
"""A coordinate that moves less beside the mode's own (rad, or parts of the length) is not shown."""


@dataclass(frozen=True, eq=False, repr=False)
class Animation(Frozen):
    """One period of a mode, Re(shape e^(i omega t)): a notebook shows it, `write` keeps it.

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
    rest : ndarray, shape (nodes, 3), optional
        Where the axis lies in space [m], if that is shown: coordinates are X, Y and Z then, and the
        motion is magnified as the title says.
    view : str
        How that is looked at.
    """

    title: str
    coordinates: tuple[str, ...]
    x: Real
    motion: Real
    envelope: Real
    seconds: float
    rest: Real | None = None
    view: str = ""

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
            draw(self, "film", file)
            return file.read_text(encoding="utf-8")

    def write(self, path: str | os.PathLike[str]) -> None:
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
        ...     modes.animate(0, frames=2).write(Path(folder, "mode.gif"))
        ...     Path(folder, "mode.gif").read_bytes()[:6]
        b'GIF89a'
        """
        draw(self, "film", check.path(path))


VIEWS = ("isometric", "front", "top", "side")
PART = 0.1  # Of the axis' extent, by which the farthest point moves.
LEFT = 1e-12  # Of the length: frames of joints are those of the piece on their left.


def extent(points: Real) -> float:
    """Return the diagonal of the box around points (n, 3) [m]."""
    return float(np.linalg.norm(np.ptp(points, axis=0)))


def in_space(
    axis: Axis, coordinates: tuple[str, ...], x: Real, shape: NDArray[Any]
) -> tuple[Real, NDArray[Any]]:
    """Return where an axis lies and where a shape (nodes, coordinates) takes it, (nodes, 3)."""
    own = np.zeros((len(x), 3), dtype=shape.dtype)
    for i, coordinate in enumerate(("x", "y", "z")):
        if coordinate in coordinates:
            own[:, i] = shape[:, coordinates.index(coordinate)]
    # of a rope on its catenary places are told along the chord
    s = x * (axis.length / x[-1])
    frames = axis.frame(s * (1 - LEFT))
    return axis.position(s), np.einsum("nij,nj->ni", frames, own)


def scale_of(rest: Real, moved: NDArray[Any], scale: float | None) -> float:
    """Return by what a displacement is multiplied, a tenth of the extent where nothing is said."""
    far = float(np.linalg.norm(moved, axis=1).max())
    if scale is None:
        scale = PART * extent(rest) / far if far > 0 else 1.0
    return check.number(scale, "scale")


def flying(
    title: str,
    rest: Real,
    moved: NDArray[Any],
    *,
    view: str,
    frames: int,
    seconds: float,
) -> Animation:
    """Turn a displacement in space, (nodes, 3), through a period, magnified."""
    by = scale_of(rest, moved, None)
    turn = np.exp(2j * np.pi * np.arange(frames) / frames)
    motion = (turn[:, None, None] * (by * moved)).real
    return Animation(
        f"{title}, {by:.3g} times",
        ("X", "Y", "Z"),
        np.arange(len(rest), dtype=np.float64),
        motion,
        np.abs(by * moved),
        seconds,
        rest,
        view,
    )


def animated(
    title: str,
    coordinates: tuple[str, ...],
    x: Real,
    shape: Real | Complex,
    *,
    own: str,
    frames: int,
    seconds: float,
) -> Animation:
    """Turn a shape, (nodes, coordinates), through a period; `own` is the coordinate of its mode."""
    shown = _shown(coordinates, x, shape, own)
    shape = shape[:, [coordinates.index(c) for c in shown]]
    turn = np.exp(2j * np.pi * np.arange(frames) / frames)
    motion = (turn[:, None, None] * shape).real
    return Animation(title, shown, x, motion, np.abs(shape), seconds)


def _shown(
    coordinates: tuple[str, ...], x: Real, shape: Real | Complex, own: str
) -> tuple[str, ...]:
    """Return the mode's own coordinate and the others that move; beta and gamma follow."""
    length = x[-1] - x[0]
    far = np.abs(shape).max(axis=0) / np.where(np.isin(coordinates, ("x", "y", "z")), length, 1.0)
    least = SMALL * far[coordinates.index(own)]
    others = (c for c, size in zip(coordinates, far) if size > least)
    return (own, *(c for c in others if c not in (own, "beta", "gamma")))
