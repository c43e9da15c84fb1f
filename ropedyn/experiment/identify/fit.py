"""What an identification found."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ...base.answer import TRANSIENT, Cost, axes
from ...base.array import Integer, Real
from ...base.computed import Lazy, Read, lazy
from ...base.drawing import draw
from ...base.named import Named
from ...base.table import Table, numbers
from ...scene.scene import Scene
from .candidates import Candidates
from .known import KEPT_SCENE, Identified, Known
from .other_ends import Remarks
from .report import report_of, sheet_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, eq=False)
class Fit(Identified):
    """Numbers of a scene that make its natural frequencies those of measured peaks.

    Attributes
    ----------
    scene : Scene
        With the numbers that were found.
    unknown : tuple of str
        Paths of the numbers.
    status : {"trusted", "ambiguous", "refused"}
        Whether the peaks tell which modes they are, and every number: ``"trusted"`` where orders
        were given, or one numbering has more than 95 % of the probability and at least three modes;
        ``"ambiguous"`` where other numberings cannot be left out, which `candidates` has, or the
        interval of 95 % of some number has no end; ``"refused"`` where there is no numbering, with
        numbers that are NaN and a note that says why.
    value, std : Named, shape (p,)
        Each number, ``fit.value["tension"]``, and its standard deviation; infinite where the peaks
        do not tell it, NaN where the interval has one bound. A stiffness that they do not show
        is 0. With unknown ends the median of the posterior.
    correlation : ndarray, shape (p, p)
        NaN where one of both is not told.
    orders : ndarray of int, shape (k,)
        Which mode each peak is, from 1; 0 where it is none.
    measured, calculated : ndarray, shape (k,)
        [Hz]; calculated is NaN where the peak is no mode.
    measured_std : ndarray, shape (k,)
        Of the peaks [Hz]: as given, else the relative noise that all residuals show.
    freedom : float or None
        Degrees of freedom the noise was estimated with; None where it is as given.
    chi_square : float
        Sum of the squared residuals in units of `measured_std`.
    probability : float
        With which chance alone is off by as much; NaN where the noise was estimated.
    candidates : Candidates
        Numberings worth naming, the likeliest first, each with `Candidate.probability`,
        `Candidate.value`, `Candidate.orders` and its interval. Found when first read.
    budget : dict of str to float
        Relative half-widths of the interval of 95 % of the first number by what causes them:
        ``"peaks"``, ``"ends"``, ``"mass"``, ``"length"`` ...
    ends : {"unknown", "given"}
        Whether the rotational stiffness of the ends was taken to be unknown.
    said_of_ends : tuple of str
        What the peaks say of the ends, and what other ends would give.
    cross_checks : tuple of str
        Tensions by closed formulas of the field, for what they are worth.
    said_of_prior : tuple of str
        What the same peaks tell without the prior of what is unknown: orders and intervals.
    assumed : tuple of str
        All that was taken to be known beforehand.
    notes : tuple of str
        What the peaks cannot tell, and what they tell instead.
    details : tuple of dict
        Of each peak what a record says: ``"damping"``, ``"snr"``, ``"band"``, ``"kind"``,
        ``"shape"``.
    record : dict or None
        What was done to the record that the peaks are of.
    seed : int
        Of the random numbers; the same gives the same bits.
    cost : Cost

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
    >>> fit = rd.identify(scene, rd.Peaks([25.1, 49.9, 75.0], std=0.1), "tension")
    >>> [round(float(one["tension"]), 1) for one in (fit.value, fit.std)], fit.orders
    ([999.4, 2.1], array([1, 2, 3]))
    >>> fit.status, fit.interval(0.95)["tension"].round(1), fit.value_is_bound
    ('trusted', array([ 995.2, 1003.6]), False)
    >>> fit.residual.round(3), round(fit.rms, 4)
    (array([-0.107,  0.086, -0.021]), 0.0027)
    >>> round(fit.scene.tension, 1), fit.peaks().column("mode")
    (999.4, (1, 2, 3))
    >>> print(fit.report().splitlines()[0])
    tension  999.4 N   95 %: 995.2 to 1004 N
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
    probability: float
    status: str
    budget: dict[str, float]
    ends: str
    assumed: tuple[str, ...]
    notes: tuple[str, ...]
    seed: int
    cost: Cost
    candidates: Lazy[Candidates] = lazy(Candidates)
    scene: Lazy[Scene] = lazy(Scene, KEPT_SCENE)
    bounds: Lazy[Real] = lazy(np.ndarray, axes("level", "unknown", "bound"))
    remarks: Lazy[Remarks] = lazy(Remarks)
    details: tuple[dict[str, Any], ...] = ()
    record: dict[str, Any] | None = None
    known: Known | None = field(default=None, repr=False, metadata=TRANSIENT)

    said_of_ends = Read[tuple[str, ...]]("remarks", "What the peaks, or other ends, say of ends.")
    cross_checks = Read[tuple[str, ...]]("remarks", "Tensions by closed formulas of the field.")
    said_of_prior = Read[tuple[str, ...]]("remarks", "What the peaks tell without the prior.")

    @property
    def residual(self) -> Real:
        """Calculated less measured frequencies [Hz], shape (k,)."""
        return self.calculated - self.measured

    @property
    def rms(self) -> float:
        """Root mean square of the relative residuals; NaN where no peak is a mode."""
        used = self.orders > 0
        if not used.any():
            return float("nan")
        return float(np.sqrt(np.mean((self.residual / self.measured)[used] ** 2)))

    @property
    def left_out(self) -> tuple[str, ...]:
        """The peaks that are taken for no mode, in words.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
        >>> peaks = rd.Peaks([25.1, 31.7, 49.9, 75.0], std=0.1)
        >>> rd.identify(scene, peaks, "tension", orders=[1, 0, 2, 3]).left_out
        ('peak 2 at 31.7 Hz is taken for no mode of the rope (stray)',)
        """
        frequency, details = self.measured, self.details or ({},) * len(self.orders)
        kinds = [one.get("kind", "mode") for one in details]
        return tuple(
            f"peak {i + 1} at {frequency[i]:.6g} Hz is taken for no mode of the rope "
            f"({'stray' if kinds[i] == 'mode' else kinds[i]})"
            for i in np.flatnonzero(self.orders == 0).tolist()
        )

    @property
    def value_is_bound(self) -> bool:
        """Whether a number went to 0 or infinity."""
        return bool(((self.value == 0) | np.isinf(self.value)).any())

    def table(self) -> Table:
        """Return one row for each number, with its interval and the status of the fit."""
        table = super().table()
        columns = {name: table.column(name) for name in table.columns}
        status = (self.status,) * len(self.unknown)
        return Table.of("identified", {**columns, "status": status})

    def plot(self, ax: Axes | None = None, *, of: str = "residuals") -> Axes:
        """Plot the fit.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where; a new figure's where left out.
        of : {"residuals", "budget", "ends"}
            Residuals by order; the intervals of the first number with what makes them; or how
            likely each stiffness of the ends is.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        SceneError
            If there is nothing of that, as of ends that were given.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
        >>> fit = rd.identify(scene, rd.Peaks([25.1, 49.9, 75.0], std=0.1), "tension")
        >>> fit.plot(of="budget").get_xlabel()
        'tension [N]'
        """
        return draw(self, "plot", ax, of=of)

    def peaks(self) -> Table:
        """Return one row for each peak: which mode it is, and how far off."""
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

        Returns
        -------
        str
            What would decide comes first where the fit is ambiguous, and the ends where they were
            taken as given. Intervals are those of 95 %.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
        >>> fit = rd.identify(scene, rd.Peaks([25.1, 49.9, 75.0], std=0.1), "tension")
        >>> fit.report().splitlines()[0]
        'tension  999.4 N   95 %: 995.2 to 1004 N'
        """
        return report_of(self)

    def to_json(self) -> str:
        """Return the answer as JSON of the schema "ropedyn.tension/1".

        Returns
        -------
        str
            Its schema is the file ``tension-1.schema.json`` of the package. What is not known is
            null.

        Examples
        --------
        >>> import json
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
        >>> fit = rd.identify(scene, rd.Peaks([25.1, 49.9, 75.0], std=0.1), "tension")
        >>> sheet = json.loads(fit.to_json())
        >>> sheet["schema"], sheet["status"], round(sheet["tension"]["median"], 1)
        ('ropedyn.tension/1', 'trusted', 999.4)
        """
        return sheet_of(self)
