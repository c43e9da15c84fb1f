"""What an identification found."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import check
from .answer import TRANSIENT, Answer, Cost, axes
from .errors import SceneError
from .named import Named
from .orders import RunnerUp
from .scene import Scene
from .table import Table, numbers

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .alternative import Alternative
    from .identification import Identification
    from .solution import Solution


@dataclass(frozen=True, eq=False)
class Fit(Answer):
    """Numbers of a scene that make its natural frequencies those of measured peaks.

    Attributes
    ----------
    unknown : tuple of str
        Paths of the numbers.
    value, std : Named, shape (p,)
        Each number, ``fit.value["tension"]``, and its standard deviation by the exact derivatives;
        infinite where the peaks do not tell it. A stiffness that went to 0, because the peaks do
        not show it, is 0.
    correlation : ndarray, shape (p, p)
        NaN where one of both is not told.
    orders : ndarray of int, shape (k,)
        Which mode each peak is, from 1; 0 where it is none.
    measured, calculated : ndarray, shape (k,)
        [Hz]; calculated is NaN where the peak is no mode.
    measured_std : ndarray, shape (k,)
        Of the peaks [Hz]: as they were given; else the relative noise that the residuals show,
        equal for all.
    freedom : float or None
        Degrees of freedom the noise was estimated with; None where it was given.
    chi_square : float
        Sum of the squared residuals in units of `measured_std`.
    runner_up : RunnerUp or None
        The second best orders and how much worse they are, where orders were searched.
    notes : tuple of str
        What the peaks cannot tell, and what they tell instead.
    cost : Cost
    """

    unknown: tuple[str, ...]
    value: Named = field(metadata=axes("unknown"))
    std: Named = field(metadata=axes("unknown"))
    correlation: NDArray[np.float64] = field(metadata=axes("unknown", "other"))
    orders: NDArray[np.int64] = field(metadata=axes("peak"))
    measured: NDArray[np.float64] = field(metadata=axes("peak", unit="Hz"))
    measured_std: NDArray[np.float64] = field(metadata=axes("peak", unit="Hz"))
    calculated: NDArray[np.float64] = field(metadata=axes("peak", unit="Hz"))
    freedom: float | None
    chi_square: float
    runner_up: RunnerUp | None
    notes: tuple[str, ...]
    cost: Cost
    solution: Solution | None = field(default=None, repr=False, metadata=TRANSIENT)
    identification: Identification | None = field(default=None, repr=False, metadata=TRANSIENT)

    def __post_init__(self) -> None:
        for name in ("value", "std"):
            object.__setattr__(self, name, Named(getattr(self, name), self.unknown))
        if self.runner_up is not None:
            object.__setattr__(self, "runner_up", RunnerUp(*self.runner_up))
        super().__post_init__()

    @property
    def residual(self) -> NDArray[np.float64]:
        """Calculated less measured frequencies [Hz], shape (k,)."""
        return self.calculated - self.measured

    @property
    def rms(self) -> float:
        """Root mean square of the relative residuals."""
        used = self.orders > 0
        return float(np.sqrt(np.mean((self.residual / self.measured)[used] ** 2)))

    @property
    def value_is_bound(self) -> bool:
        """Whether a number went to 0 or infinity."""
        return bool(((self.value == 0) | np.isinf(self.value)).any())

    @cached_property
    def alternatives(self) -> tuple[Alternative, ...]:
        """What other ends would tell, pinned or clamped both, where the scene's are such words.

        Found when it is first asked for.

        Raises
        ------
        SceneError
            If the fit was read from a file.

        Examples
        --------
        A cord that hangs on 1.97 N:

        >>> import ropedyn as rd
        >>> rope = rd.Rope(1.08, 0.0022, bending_stiffness=1e-4)
        >>> scene = rd.Scene(rope, tension=1.0, ends=("pinned", "pinned"))
        >>> peaks = [13.88, 27.89, 42.13, 56.85, 71.87]
        >>> fit = rd.identify(scene, peaks, ["tension", "bending_stiffness"])
        >>> (other,) = fit.alternatives
        >>> other.ends, other.verdict, round(other.change["tension"], 3)
        ('clamped', 'as well', -0.069)
        """
        if self.identification is None:
            raise SceneError("a fit from a file has no scene: identify again")
        from .alternative import alternatives_of

        return alternatives_of(self)

    @property
    def scene(self) -> Scene:
        """The scene with the numbers that were found."""
        return self._solution.scene

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
        The quantile is the normal one where peaks were given a standard deviation, and Student's t
        where that was estimated.

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
        level = check.number(level, "level", sign="positive")
        if level >= 1:
            raise SceneError(f"level must be between 0 and 1, got {level!r}")
        check.one_of(method, "method", ("profile", "linear"))
        solution = self._solution
        by = solution.interval if method == "profile" else solution.linear_interval
        return Named(by(level), self.unknown)

    def table(self) -> Table:
        """Return one row for each number."""
        columns: dict[str, Any] = {
            "unknown": self.unknown,
            "value": self.value,
            "std": self.std,
        }
        return Table.of("identified", columns)

    @property
    def peaks(self) -> Table:
        """One row for each peak."""
        columns: dict[str, Any] = {
            "measured [Hz]": self.measured,
            "std [Hz]": self.measured_std,
            "mode": tuple(k or None for k in self.orders.tolist()),
            "calculated [Hz]": numbers(self.calculated),
            "residual [Hz]": numbers(self.residual),
        }
        return Table.of("calculated against measured peaks", columns)

    def report(self) -> str:
        """Return values, peaks and all that limits what they mean, as text.

        Intervals are those of 95 %; a fit from a file has none, and no alternatives.

        Returns
        -------
        str
        """
        numbers = self.table() if self.solution is None else self._with_intervals()
        lines = [str(numbers), "", str(self.peaks), ""]
        lines.append(f"rms residual {100 * self.rms:.3g} %; {self._said_of_noise}")
        if self.runner_up is not None:
            lines.append(f"second best orders {list(self.runner_up.orders)}: {self._worse}")
        if self.identification is not None:
            lines += map(str, self.alternatives)
        return "\n".join([*lines, *(f"note: {note}" for note in self.notes)])

    def _with_intervals(self) -> Table:
        columns = {name: self.table().column(name) for name in self.table().columns}
        low, high = self.interval().T.tolist()
        return Table.of("identified", columns | {"95 % from": low, "to": high})

    @property
    def _said_of_noise(self) -> str:
        if self.freedom is None:
            return f"chi-square {self.chi_square:.3g} of {int((self.orders > 0).sum())} peaks"
        return f"noise estimated with {self.freedom:.3g} degrees of freedom"

    @property
    def _worse(self) -> str:
        assert self.runner_up is not None
        return f"chi-square larger by {self.runner_up.worse:.3g}"

    def plot(self, ax: Axes | None = None) -> Axes:
        """Plot residuals over orders with the uncertainty of the peaks."""
        from .plotting_fit import plot_fit

        return plot_fit(self, ax)
