"""Figures 2 to 4 of the 2015 study: its element on any axis, what loads and what moves its end."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from matplotlib.figure import Figure

from ..axis.axis import Axis
from ..axis.flexibility import SIGN, end_flexibility
from ..base.array import Real
from .figure import BLUE, GREEN, ORANGE, RED, new_figure

AXIS = Axis.helix(0.05, 0.35, 0.55)  # Of the element that is drawn.
STIFFNESS = (1.5, 2.0, 3.0)  # Of alpha, beta and gamma [N m^2].
FORCE, MOMENT = np.array([-0.5, -1.2, 0.4]), np.array([0.04, 0.03, -0.02])
"""V0 and L0 on the body, along xi, eta, zeta [N, N m]."""
PART = 0.45  # Of its length, where the study's A is.
LONG = 0.028  # Arrows of frames [m].
FAR = 0.03  # Of the displacement that is drawn [m].
VIEW = {"elev": 38.0, "azim": -78.0}


class LoadedElement(NamedTuple):
    """An element held at its left end, a force and a moment on the body at its right end M.

    Vectors in space.
    """

    axis: Axis
    force: Real
    moment: Real

    @classmethod
    def drawn(cls) -> LoadedElement:
        """Return the one of the figures."""
        own = AXIS.frame(AXIS.length)
        return cls(AXIS, own @ FORCE, own @ MOMENT)

    def cut(self, s: float) -> tuple[Real, Real]:
        """Return the study's V and L at a section: V = V0, L = L0 - r x V0, r from M (Eq. 3)."""
        r = self.axis.position(s) - self.axis.position(self.axis.length)
        return self.force, self.moment - np.cross(r, self.force)

    def moved(self) -> tuple[Real, Real]:
        """Return displacement and rotation of the body by the integral of Eq. 6."""
        own = self.axis.frame(self.axis.length)
        load = np.concatenate([own.T @ self.force, own.T @ self.moment]) * SIGN
        answer = end_flexibility(self.axis, STIFFNESS) @ load * SIGN
        return own @ answer[:3], own @ answer[3:]


def element() -> Figure:
    """Draw the axis and its frames, the body displaced, and the balance of a part."""
    figure, (ax,) = new_figure(1, height=3.6)
    ax.remove()
    figure.set_size_inches(12.0, 3.6)
    loaded = LoadedElement.drawn()
    for k, draw in enumerate((_frames, _displaced, _balanced)):
        own: Any = figure.add_subplot(1, 3, k + 1, projection="3d")
        draw(own, loaded)
        _finish(own)
    return figure


def _frames(ax: Any, loaded: LoadedElement) -> None:
    axis, at = loaded.axis, PART * loaded.axis.length
    _line(ax, axis, 0.0, axis.length)
    _frame(
        ax, axis.position(axis.length), axis.frame(axis.length), (r"$\xi$", r"$\eta$", r"$\zeta$")
    )
    _frame(ax, axis.position(at), axis.frame(at), ("x", "y", "z"))
    _name(ax, axis.position(axis.length), "M")
    _name(ax, axis.position(at), "A")
    ax.set_title("2: axis r(s), section and body")


def _displaced(ax: Any, loaded: LoadedElement) -> None:
    axis = loaded.axis
    M, own, (u, theta) = axis.position(axis.length), axis.frame(axis.length), loaded.moved()
    by = FAR / float(np.linalg.norm(u))
    # Rodrigues' rotation by the vector that is drawn
    angle = by * theta
    size = float(np.linalg.norm(angle))
    x, y, z = angle / size
    W = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    turned = (np.eye(3) + np.sin(size) * W + (1 - np.cos(size)) * W @ W) @ own
    _line(ax, axis, 0.0, axis.length)
    _frame(ax, M, own, (r"$\xi$", r"$\eta$", r"$\zeta$"))
    _frame(ax, M + by * u, turned, (r"$\xi'$", r"$\eta'$", r"$\zeta'$"))
    _arrow(ax, M, by * u, ORANGE, "u")
    _name(ax, M, "M")
    ax.set_title(f"3: the body moved by its load, {by:.0f} times")


def _balanced(ax: Any, loaded: LoadedElement) -> None:
    axis, at = loaded.axis, PART * loaded.axis.length
    M, A = axis.position(axis.length), axis.position(at)
    V, L = loaded.cut(at)
    _line(ax, axis, at, axis.length)
    force = LONG * 1.3 / float(np.linalg.norm(V))
    most = max(float(np.linalg.norm(one)) for one in (L, loaded.moment))
    moment = LONG * 1.3 / most
    _arrow(ax, M, -force * loaded.force, BLUE, "$-V^0$")
    _arrow(ax, M, -moment * loaded.moment, RED, "$-L^0$")
    _arrow(ax, A, force * V, BLUE, "V")
    _arrow(ax, A, moment * L, RED, "L")
    _arrow(ax, M, A - M, "0.6", "r(s)")
    _name(ax, M, "M")
    _name(ax, A, "A")
    ax.set_title("4: the part MA in balance")


def _line(ax: Any, axis: Axis, begin: float, end: float) -> None:
    points = axis.position(np.linspace(begin, end, 200))
    ax.plot(*points.T, color="0.25", linewidth=2.5)


def _frame(ax: Any, at: Real, frame: Real, names: tuple[str, ...]) -> None:
    for column, name in zip(frame.T, names):
        _arrow(ax, at, LONG * column, GREEN, name)


def _arrow(ax: Any, at: Real, vector: Real, colour: str, name: str) -> None:
    ax.quiver(*at, *vector, color=colour, linewidth=1.4, arrow_length_ratio=0.18)
    ax.text(*(at + 1.15 * vector), name, color=colour, fontsize="small")


def _name(ax: Any, at: Real, name: str) -> None:
    ax.text(*(at + np.array([-0.004, 0.007, 0.0])), name, fontweight="bold")


def _finish(ax: Any) -> None:
    """Give the three directions one scale, and nothing around them."""
    points = AXIS.position(np.linspace(0.0, AXIS.length, 50))
    half, middle = 0.62 * np.ptp(points, axis=0).max(), (points.max(0) + points.min(0)) / 2
    for set_limits, m in zip((ax.set_xlim, ax.set_ylim, ax.set_zlim), middle):
        set_limits(m - half, m + half)
    ax.set_box_aspect((1, 1, 1), zoom=1.4)
    ax.view_init(**VIEW)
    ax.set_axis_off()
