"""Tension over time."""

from __future__ import annotations

from dataclasses import dataclass, field
from statistics import NormalDist
from typing import Any

import numpy as np

from ...base import check
from ...base.answer import TRANSIENT, Answer, axes
from ...base.array import Real
from ...base.errors import SceneError
from ...base.table import Table, numbers
from ..identify.fit import Fit

DAY = 86_400_000  # [ms]


@dataclass(frozen=True, eq=False)
class Track(Answer):
    """Tension over time, a random walk that many records tell.

    What one record leaves open and all records share, such as unknown ends, mass and length, is in
    `std` whole, however many records there are; `own_std` is what is left of a change from one
    record to another.

    Attributes
    ----------
    time : ndarray, shape (n,)
        Of the records [day].
    since : str
        The date and time that are 0, in ISO 8601; empty where the times were plain numbers.
    status : tuple of str
        Of the fit of each record; only those that are "trusted" tell the walk.
    measured, measured_std : ndarray, shape (n,)
        What each record alone tells, the middle of its interval [N], and its standard deviation by
        its own peaks; NaN where left out.
    tension, std, own_std : ndarray, shape (n,)
        What all records tell of the tension at the time of each, left out or not, and its standard
        deviation with and without what all records share [N].
    level, level_std : ndarray, shape (n,)
        The same at the mean temperature [N]; the tension itself where no temperature was given.
    coefficient, coefficient_std : float or None
        Relative change of tension with temperature [1/K].
    step : float
        Standard deviation of the relative change of the level in a day.
    step_interval : tuple of float
        Its interval of 95 %.
    scatter : float
        How many times more than `measured_std` the records scatter, 1 or more: what the peaks of
        each make of the ends is its own too. `own_std` contains it.
    off : ndarray, shape (n,)
        By how many standard deviations a record is off what all others say; NaN where these say
        nothing of it, or it is left out.
    notes : tuple of str
        Records that are left out and why, and what else limits the answer.
    temperature : ndarray, shape (n,), or None
        As it was given [K or deg C].
    fits : tuple of Fit or None
        Of each record; None where it failed, and empty of a track from a file.

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
    >>> one = {"std": 0.05, "order": [1, 2, 3]}
    >>> records = [rd.Peaks([f, 2 * f, 3 * f], **one) for f in (25.0, 25.1, 25.2, 25.3, 25.4)]
    >>> track = rd.track(scene, records, temperature=[20.0, 18.0, 16.0, 14.0, 12.0])
    >>> track.tension.round(-1).tolist(), track.level.round(-1).tolist()
    ([1000.0, 1010.0, 1020.0, 1020.0, 1030.0], [1020.0, 1020.0, 1020.0, 1020.0, 1020.0])
    >>> low, high = track.coefficient_interval
    >>> round(100 * track.coefficient, 1), low < track.coefficient < high
    (-0.4, True)
    >>> print(track.report().splitlines()[-1].partition(" (")[0])
    temperature -0.397 % per K
    """

    time: Real = field(metadata=axes("record", unit="day"))
    since: str
    status: tuple[str, ...]
    measured: Real = field(metadata=axes("record", unit="N"))
    measured_std: Real = field(metadata=axes("record", unit="N"))
    tension: Real = field(metadata=axes("record", unit="N"))
    std: Real = field(metadata=axes("record", unit="N"))
    own_std: Real = field(metadata=axes("record", unit="N"))
    level: Real = field(metadata=axes("record", unit="N"))
    level_std: Real = field(metadata=axes("record", unit="N"))
    coefficient: float | None
    coefficient_std: float | None
    step: float
    step_interval: tuple[float, float]
    scatter: float
    off: Real = field(metadata=axes("record"))
    notes: tuple[str, ...]
    temperature: Real | None = field(default=None, metadata=axes("record"))
    fits: tuple[Fit | None, ...] = field(default=(), repr=False, metadata=TRANSIENT)

    def interval(self, level: float = 0.95, *, common: bool = True) -> Real:
        """Return intervals of the tension at the time of each record.

        Parameters
        ----------
        level : float
            With which the truth is covered, between 0 and 1.
        common : bool
            Whether what all records share counts. Without it intervals of two records that do not
            overlap show a change, and none of them holds the true tension with this level.

        Returns
        -------
        ndarray, shape (n, 2)
            [N], normal in the logarithm.

        Raises
        ------
        TypeError, SceneError
            If an argument is of the wrong type or has no meaning.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
        >>> one = {"std": 0.05, "order": [1, 2, 3]}
        >>> records = [rd.Peaks([f, 2 * f, 3 * f], **one) for f in (25.0, 25.1, 25.05)]
        >>> rd.track(scene, records).interval(0.95).shape
        (3, 2)
        """
        check.instance(common, "common", bool, "True or False")
        z = quantile(level)
        relative = (self.std if common else self.own_std) / self.tension
        return np.asarray(self.tension[:, None] * np.exp(relative[:, None] * np.array([-z, z])))

    @property
    def coefficient_interval(self) -> tuple[float, float] | None:
        """Of 95 %; None without temperature."""
        if self.coefficient is None or self.coefficient_std is None:
            return None
        half = quantile(0.95) * self.coefficient_std
        return self.coefficient - half, self.coefficient + half

    def dates(self) -> Any:
        """Return the times as datetime64, or in days where they were given so.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
        >>> one = {"std": 0.05, "order": [1, 2, 3]}
        >>> records = [rd.Peaks([f, 2 * f, 3 * f], **one) for f in (25.0, 25.1, 25.2)]
        >>> rd.track(scene, records, time=[0.0, 0.5, 1.0]).dates()
        array([0. , 0.5, 1. ])
        """
        if not self.since:
            return self.time
        return np.datetime64(self.since) + (self.time * DAY).astype("timedelta64[ms]")

    def report(self) -> str:
        """Return what the walk is and all that limits it, as text."""
        low, high = (100 * bound for bound in self.step_interval)
        lines = [
            str(self.table()),
            "",
            f"step {100 * self.step:.2g} % in a day (95 %: {low:.2g} to {high:.2g} %), "
            f"scatter {self.scatter:.2g} times what the records say",
        ]
        if self.coefficient is not None and self.coefficient_interval is not None:
            low, high = (100 * bound for bound in self.coefficient_interval)
            lines.append(
                f"temperature {100 * self.coefficient:+.3g} % per K (95 %: {low:.3g} to {high:.3g})"
            )
        return "\n".join([*lines, *(f"note: {note}" for note in self.notes)])

    def table(self) -> Table:
        """Return one row for each record."""
        low, high = self.interval().T
        columns: dict[str, Any] = {"time [day]": self.time}
        if self.since:
            columns = {"time": tuple(str(one)[:19] for one in self.dates())}
        if self.temperature is not None:
            columns["temperature"] = self.temperature
        columns |= {
            "record alone [N]": numbers(self.measured),
            "tension [N]": self.tension,
            "95 % from [N]": low,
            "to [N]": high,
            "std of a change [N]": self.own_std,
            "status": self.status,
        }
        return Table.of("tension over time", columns)


def quantile(level: Any) -> float:
    """Return how many standard deviations to either side cover with a level."""
    checked = check.number(level, "level", sign="positive")
    if checked >= 1:
        raise SceneError(f"level must be between 0 and 1, got {checked!r}")
    return NormalDist().inv_cdf(0.5 + 0.5 * checked)
