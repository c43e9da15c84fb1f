"""What identifications from peaks and from whole responses have in common."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...base import check
from ...base.answer import Answer, Cost
from ...base.array import Real
from ...base.errors import SceneError
from ...base.named import Named
from ...base.table import Table
from ...scene.scene import Scene
from .solution import Solution


def found_by(
    solution: Solution, *, seconds: float, elements: int | None, evaluations: int
) -> dict[str, Any]:
    """Return the fields that say what the solution of one rope found."""
    sought, freedom = len(solution.unknowns), float(solution.record["freedom"][0])
    return {
        "unknown": solution.unknowns.paths,
        "value": solution.value[0],
        "std": solution.std[0],
        "correlation": solution.uncertainty.correlation[0],
        "freedom": None if np.isnan(freedom) else freedom,
        "chi_square": float(solution.off[0] / solution.noise[0] ** 2),
        "cost": Cost(seconds, "least squares", elements or 0, sought, factorisations=evaluations),
        "solution": solution,
    }


def intervals(solution: Solution, level: Any, method: Any) -> Real:
    """Check what is asked and return bounds of the numbers of each rope, shape (n, p, 2)."""
    level = check.number(level, "level", sign="positive")
    if level >= 1:
        raise SceneError(f"level must be between 0 and 1, got {level!r}")
    check.one_of(method, "method", ("profile", "linear"))
    return solution.interval(level) if method == "profile" else solution.linear_interval(level)


class Identified(Answer):
    """Base of what holds numbers of a scene, how well they are known, and their solution."""

    unknown: tuple[str, ...]
    value: Named
    std: Named
    solution: Solution | None

    def __post_init__(self) -> None:
        for name in ("value", "std"):
            object.__setattr__(self, name, Named(getattr(self, name), self.unknown))
        super().__post_init__()

    @property
    def scene(self) -> Scene:
        """The scene with the numbers that were found."""
        solution = self._solution
        return solution.unknowns.at(solution.u[0])

    @property
    def _solution(self) -> Solution:
        if self.solution is None:
            raise SceneError("a fit from a file has no scene: identify again")
        return self.solution

    def interval(self, level: float = 0.95, *, method: str = "profile") -> Named:
        """Find confidence intervals.

        Parameters
        ----------
        level : float
            With which the truth is covered, between 0 and 1.
        method : {"profile", "linear"}
            ``"profile"``: where the sum of squares, least over the others, has grown by the square
            of the quantile: right also where the numbers act in a curved way, such as a bending
            stiffness that hardly shows, whose interval begins at 0. It takes some solutions for
            each bound. ``"linear"``: the quantile times the standard deviation to either side.

        Returns
        -------
        Named, shape (p, 2)
            The bounds; 0 or infinite where there is none.

        Raises
        ------
        TypeError
            If the level is not a number.
        SceneError
            If an argument has no meaning, or the fit was read from a file.

        Notes
        -----
        The quantile is the normal one where what was measured came with a standard deviation, and
        Student's t where that was estimated.

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
        >>> fit = rd.identify(scene, peaks, ["tension", "bending_stiffness"])
        >>> print(fit.interval()["bending_stiffness"].round(2))
        [0.   0.18]
        """
        return Named(intervals(self._solution, level, method)[0], self.unknown)

    def table(self) -> Table:
        """Return one row for each number."""
        columns: dict[str, Any] = {"unknown": self.unknown, "value": self.value, "std": self.std}
        return Table.of("identified", columns)
