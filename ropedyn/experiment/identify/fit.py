"""What an identification found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...base.answer import TRANSIENT, Cost, axes
from ...base.array import Integer, Real
from ...base.computed import computed
from ...base.errors import RopedynError, SceneError
from ...base.named import Named
from ...base.table import Table, numbers
from ...scene.scene import Scene
from ..orders.orders import RunnerUp
from .identified import Identified
from .solution import LEAST_NOISE, Solution

WORDS = ("pinned", "clamped")  # Ends that are tried in place of each other.
LEVEL = 0.95  # Level of the test whether something fits worse.


@dataclass(frozen=True, eq=False)
class Alternative:
    """The same peaks with other ends."""

    ends: str  # the word for both
    fit: Fit  # what they tell then
    verdict: str  # how it fits: "better", "as well" or "worse"
    change: dict[str, float]  # of each number that both tell, relative to the scene's own ends

    def __str__(self) -> str:
        numbers = [f"{path} {100 * part:+.2g} %" for path, part in self.change.items()]
        but = "but give" if self.verdict == "as well" else "and give"
        found = f" {but} {', '.join(numbers)}" if numbers else ""
        off = f"rms residual {100 * self.fit.rms:.2g} %"
        return f"{self.ends} ends fit {self.verdict} ({off}){found}"


@dataclass(frozen=True, eq=False)
class Fit(Identified):
    """Numbers of a scene that make its natural frequencies those of measured peaks.

    Attributes
    ----------
    unknown : tuple of str
        Paths of the numbers.
    value, std : Named, shape (p,)
        Each number, ``fit.value["tension"]``, and its standard deviation by the exact derivatives;
        infinite where the peaks do not tell it. A stiffness that they do not show is 0.
    correlation : ndarray, shape (p, p)
        NaN where one of both is not told.
    orders : ndarray of int, shape (k,)
        Which mode each peak is, from 1; 0 where it is none.
    measured, calculated : ndarray, shape (k,)
        [Hz]; calculated is NaN where the peak is no mode.
    measured_std : ndarray, shape (k,)
        Of the peaks [Hz]: as given, else the relative noise that all residuals show.
    freedom : float or None
        Degrees of freedom the noise was estimated with; None where it was given.
    chi_square : float
        Sum of the squared residuals in units of `measured_std`.
    runner_up : RunnerUp or None
        The second best orders and how much worse they are, where orders were searched.
    notes : tuple of str
        What the peaks cannot tell, and what they tell instead.
    cost : Cost

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=500.0)
    >>> fit = rd.identify(scene, rd.Peaks([25.1, 49.9, 75.0], std=0.1), "tension")
    >>> [round(float(one["tension"]), 1) for one in (fit.value, fit.std)], fit.orders
    ([999.4, 2.1], array([1, 2, 3]))
    >>> fit.interval(0.95)["tension"].round(1), fit.value_is_bound
    (array([ 995.2, 1003.6]), False)
    >>> fit.residual.round(3), round(fit.rms, 4)
    (array([-0.107,  0.086, -0.021]), 0.0027)
    >>> round(fit.scene.tension, 1), fit.alternatives
    (999.4, ())
    >>> print(fit.report().splitlines()[-1])
    rms residual 0.266 %; chi-square 1.93 of 3 peaks
    """

    unknown: tuple[str, ...]
    value: Named = field(metadata=axes("unknown"))
    std: Named = field(metadata=axes("unknown"))
    correlation: Real = field(metadata=axes("unknown", "other"))
    orders: Integer = field(metadata=axes("peak"))
    measured: Real = field(metadata=axes("peak", unit="Hz"))
    measured_std: Real = field(metadata=axes("peak", unit="Hz"))
    calculated: Real = field(metadata=axes("peak", unit="Hz"))
    freedom: float | None
    chi_square: float
    runner_up: RunnerUp | None
    notes: tuple[str, ...]
    cost: Cost
    solution: Solution | None = field(default=None, repr=False, metadata=TRANSIENT)
    alternatives_source: Callable[[Fit], tuple[Alternative, ...]] | None = field(
        default=None, repr=False, metadata=TRANSIENT
    )

    def __post_init__(self) -> None:
        if self.runner_up is not None:
            object.__setattr__(self, "runner_up", RunnerUp(*self.runner_up))
        super().__post_init__()

    @property
    def residual(self) -> Real:
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

    @computed
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
        if self.alternatives_source is None:
            raise SceneError("a fit from a file has no scene: identify again")
        return self.alternatives_source(self)

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
        noise = f"chi-square {self.chi_square:.3g} of {int((self.orders > 0).sum())} peaks"
        if self.freedom is not None:
            noise = f"noise estimated with {self.freedom:.3g} degrees of freedom"
        lines.append(f"rms residual {100 * self.rms:.3g} %; {noise}")
        if self.runner_up is not None:
            orders, worse = list(self.runner_up.orders), self.runner_up.worse
            lines.append(f"second best orders {orders}: chi-square larger by {worse:.3g}")
        if self.alternatives_source is not None:
            lines += map(str, self.alternatives)
        return "\n".join([*lines, *(f"note: {note}" for note in self.notes)])

    def _with_intervals(self) -> Table:
        columns = {name: self.table().column(name) for name in self.table().columns}
        low, high = self.interval().T.tolist()
        return Table.of("identified", columns | {"95 % from": low, "to": high})


def alternatives_of(
    scene: Scene, instead: Callable[[Scene], Fit], fit: Fit
) -> tuple[Alternative, ...]:
    """Fit with both ends pinned and with both clamped, where the scene's are such words."""
    if "beta" not in scene.coordinates or not all(end in WORDS for end in scene.ends):
        return ()
    found = []
    for word in WORDS:
        if scene.ends != (word, word):
            try:
                # what was found is a guess, where nothing went to 0 or infinity
                guess = scene if fit.value_is_bound else fit.scene
                other = instead(guess.replace(ends=(word, word)))
            except RopedynError:
                continue
            found.append(Alternative(word, other, _verdict(fit, other), _change(fit, other)))
    return tuple(found)


def _change(fit: Fit, other: Fit) -> dict[str, float]:
    """Return relative changes of the numbers that both tell."""
    before, after = dict(fit.value), dict(other.value)
    told = np.flatnonzero(np.isfinite(fit.std) & np.isfinite(other.std))
    return {p: float(after[p] / before[p] - 1) for p in (fit.unknown[i] for i in told)}


def _verdict(fit: Fit, other: Fit) -> str:
    """Say how another fit compares, by chi-square or, where the noise is not known, by F."""
    from scipy.special import chdtri, fdtri

    if fit.freedom is None:
        most = float(chdtri(1, 1 - LEVEL))
        return _said(other.chi_square - fit.chi_square, -most, most)
    if fit.freedom < 0.5:
        return "as well"
    most = float(fdtri(fit.freedom, fit.freedom, LEVEL))
    return _said((other.rms / max(fit.rms, LEAST_NOISE)) ** 2, 1 / most, most)


def _said(value: float, low: float, high: float) -> str:
    if value > high:
        return "worse"
    return "better" if value < low else "as well"
