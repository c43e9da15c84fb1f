"""How well numbers are known: what every fit has, in memory and from a file."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Protocol

import numpy as np

from ...base import check
from ...base.answer import Answer, kept_as
from ...base.array import Flags, Real
from ...base.errors import SceneError
from ...base.named import Named
from ...base.table import Table, numbers
from ...scene.scene import Scene
from ...scene.toml import built, document
from ..fitting.solution import Solution

KEPT_SCENE = kept_as(document, partial(built, Scene))
"""How a file keeps the scene of a fit."""

LEVELS = (0.5, 0.68, 0.8, 0.9, 0.95, 0.98, 0.99, 0.999)
"""Levels whose intervals a file keeps."""

METHODS = ("profile", "linear")

TOLD = 0.95
"""Level whose interval must have an end where a number is trusted."""


class Known(Protocol):
    """Numbers of one scene, and how well they are known."""

    @property
    def scene(self) -> Scene:
        """Return the scene with them."""

    def interval(self, level: float, method: str) -> Real:
        """Return their intervals, shape (p, 2)."""


class Solved:
    """The numbers of one rope by least squares."""

    def __init__(self, solution: Solution) -> None:
        self.solution = solution

    @property
    def scene(self) -> Scene:
        """Return the scene with them; numbers that went to 0 or infinity are far out."""
        return self.solution.unknowns.at(self.solution.u[0])

    def interval(self, level: float, method: str) -> Real:
        """Return their intervals, shape (p, 2)."""
        return intervals(self.solution, level, method)[0, : self.solution.unknowns.shown]


def intervals(solution: Solution, level: float, method: str) -> Real:
    """Return bounds of the numbers of each rope, shape (n, p, 2)."""
    return solution.interval(level) if method == "profile" else solution.linear_interval(level)


def without_end(interval: Real) -> Flags:
    """Say which intervals, shape (..., 2), reach infinity."""
    return np.asarray(np.isinf(interval).any(axis=-1))


def checked_level(level: Any, method: Any) -> float:
    """Check what is asked of an interval."""
    level = check.number(level, "level", sign="positive")
    if level >= 1:
        raise SceneError(f"level must be between 0 and 1, got {level!r}")
    check.one_of(method, "method", METHODS)
    return level


class Kept(Protocol):
    """What is known in memory, and by its bounds in a file."""

    @property
    def known(self) -> Known | None:
        """Return how, None of what is from a file."""

    @property
    def bounds(self) -> Real:
        """Return intervals of `LEVELS`, shape (levels, p, 2)."""


def kept_bounds(interval: Callable[[float, str], Real]) -> Real:
    """Return the intervals that a file keeps, shape (levels, ..., p, 2)."""
    return np.array([interval(level, METHODS[0]) for level in LEVELS])


def kept_interval(kept: Kept, level: float, method: str) -> Real:
    """Return intervals, shape (p, 2), or those that a file has kept."""
    if kept.known is not None:
        return kept.known.interval(level, method)
    if level not in LEVELS or method != METHODS[0]:
        raise SceneError(
            f'level must be one of {LEVELS} and method "{METHODS[0]}" of a fit from a file, got '
            f"{level!r} and {method!r}: identify again"
        )
    return np.asarray(kept.bounds[LEVELS.index(level)])


class Identified(Answer):
    """Base of what holds numbers of a scene and how well they are known."""

    unknown: tuple[str, ...]
    value: Named
    std: Named
    bounds: Real
    scene: Scene
    known: Known | None

    def __post_init__(self) -> None:
        for name in ("value", "std"):
            object.__setattr__(self, name, Named(getattr(self, name), self.unknown))
        super().__post_init__()

    def interval(self, level: float = 0.95, *, method: str = "profile") -> Named:
        """Find confidence intervals.

        Parameters
        ----------
        level : float
            With which the truth is covered, between 0 and 1. A fit from a file has kept 0.5, 0.68,
            0.8, 0.9, 0.95, 0.98, 0.99 and 0.999.
        method : {"profile", "linear"}
            Of least squares. ``"profile"``: where the sum of squares, least over the others, has
            grown by the square of the quantile: right also where the numbers act in a curved way,
            such as a bending stiffness that hardly shows, whose interval begins at 0. It takes some
            solutions for each bound. ``"linear"``: the quantile times the standard deviation to
            either side.

        Returns
        -------
        Named, shape (p, 2)
            The bounds; 0 or infinite where there is none. Of an ambiguous fit the interval holds
            those of all candidates that have a twentieth of the probability of the likeliest.

        Raises
        ------
        TypeError
            If the level is not a number.
        SceneError
            If an argument has no meaning, or the fit was read from a file that has not kept it.

        Notes
        -----
        Of least squares the quantile is the normal one where what was measured came with a standard
        deviation that the residuals do not refute, and Student's t else. With unknown ends the
        bounds are quantiles of the posterior.

        References
        ----------
        D. M. Bates, D. G. Watts, Nonlinear Regression Analysis (1988), section 6.1.

        Examples
        --------
        Of a bending stiffness that six peaks hardly show the interval begins at 0:

        >>> import ropedyn as rd
        >>> rope = rd.Rope(2.0, 0.5, bending_stiffness=1.0)
        >>> scene = rd.Scene(rope, tension=900.0, ends=("pinned", "pinned"))
        >>> peaks = rd.Peaks([11.19, 22.33, 33.58, 44.72, 55.94, 67.19], std=0.1)
        >>> fit = rd.identify(scene, peaks, ["tension", "bending_stiffness"], ends="given")
        >>> print(fit.interval()["bending_stiffness"].round(2))
        [0.   0.18]
        """
        return Named(self._interval(checked_level(level, method), method), self.unknown)

    def _interval(self, level: float, method: str) -> Real:
        return kept_interval(self, level, method)

    def table(self) -> Table:
        """Return one row for each number."""
        low, high = self.interval().T
        columns: dict[str, Any] = {
            "unknown": self.unknown,
            "value": numbers(self.value),
            "std": numbers(self.std),
            "95 % from": numbers(low),
            "to": numbers(high),
        }
        return Table.of("identified", columns)
