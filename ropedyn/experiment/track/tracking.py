"""Tracking: each record identified, and what all of them tell of each."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from statistics import NormalDist
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...base import check
from ...base.array import Flags, Real
from ...base.errors import IdentifyWarning, RopedynError, SceneError
from ...base.progress import Progress, reporter
from ...scene.agree import refuse_axis
from ...scene.scene import Scene
from ..identify.fit import Fit
from ..identify.identify import identify
from .track import DAY, Track, quantile
from .walk import Walk, walk

LEVEL = 0.95  # Of the intervals and budgets that are read.
LEAST_STD = 1e-6  # A record does not tell the tension better than this, relative.
FEWEST, FEWEST_WITH_TEMPERATURE = 2, 4  # Records; with 3 the coefficient alone explains too much.
FEW = 5  # Of fewer records the step is hardly told.
ODD = 0.01  # Chance that of all records one that is right is called off.
SCATTERED = 1.5  # More scatter than so many times what fits leave open is noted.


def track(
    scene: Scene,
    measured: Sequence[Any],
    unknown: str | Sequence[str] = "tension",
    *,
    time: ArrayLike | None = None,
    temperature: ArrayLike | None = None,
    ends: str | None = None,
    prior: Any = None,
    progress: Progress = None,
) -> Track:
    """Follow the tension of a rope through many records.

    Each record is identified alone. The logarithm of the tension is then a random walk, with a
    part that is linear in the temperature where that is given. What ends, mass and length leave
    open is the same on all days and is not averaged away; what the peaks of each day make of it
    differs, and the days tell by their scatter how much that is. The step of the walk is told too.

    Parameters
    ----------
    scene : Scene
        As `identify` takes it.
    measured : list of Record, Peaks, Fit or whatever `identify` takes
        In the order of time. A `Fit` was identified before, of this scene.
    unknown : str or sequence of str
        Paths of what is sought, "tension" among them.
    time : array_like of float [day] or of datetime64, shape (n,), optional
        Of each record, not decreasing; 0, 1, 2 .. where left out.
    temperature : array_like, shape (n,), optional
        Of each record [K or deg C].
    ends, prior
        As `identify` takes them.
    progress : None, True or callable
        True prints the share of records that are done to stderr, a callable takes it.

    Returns
    -------
    Track
        Records whose fit is not "trusted" are left out of the walk and named in `Track.notes`.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    SceneError
        If a value has no meaning, or too few records tell a tension: two are needed, four where
        the temperature is given.

    Notes
    -----
    Of what a record leaves open the part "peaks" of `Fit.budget` is surely its own. It is taken a
    factor of 1 or more larger, told by the scatter; the rest is common to all records.

    References
    ----------
    J. Durbin, S. J. Koopman, Time Series Analysis by State Space Methods, 2nd ed. (2012), chapter
    2.

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
    >>> one = {"std": 0.05, "order": [1, 2, 3]}
    >>> records = [rd.Peaks([f, 2 * f, 3 * f], **one) for f in (25.0, 25.1, 25.05)]
    >>> track = rd.track(scene, records)
    >>> track.status, track.measured.round(1).tolist()
    (('trusted', 'trusted', 'trusted'), [1000.0, 1008.0, 1004.0])
    """
    check.instance(scene, "scene", Scene, "a Scene")
    refuse_axis(scene, "tracking")
    check.instance(measured, "measured", (list, tuple), "a list of records or peaks, one a day")
    paths = _with_tension(unknown)
    n = len(measured)
    day, since = _days(time, n)
    warmth = None if temperature is None else _each(temperature, "temperature", n)
    options = {name: one for name, one in (("ends", ends), ("prior", prior)) if one is not None}
    fits = _fits(scene, measured, paths, options, progress)
    days = [_day_of(fit) for fit in fits]
    told = np.array([np.isfinite(one.ln_tension) for one in days])
    _enough(told, days, day, warmth)
    y, own, whole = (np.array(column) for column in list(zip(*days))[:3])
    found = walk(day, y, own, whole, warmth)
    return Track(
        time=day,
        since=since,
        status=tuple(one.status for one in days),
        measured=np.exp(y),
        measured_std=np.exp(y) * own,
        notes=_notes(found, days, day),
        temperature=warmth,
        fits=tuple(fit if isinstance(fit, Fit) else None for fit in fits),
        **_fields(found),
    )


def _fields(found: Walk) -> dict[str, Any]:
    """Return the fields of a track that the walk tells."""
    tension, level = np.exp(found.mean), np.exp(found.level)
    a, std = (None if np.isnan(one) else one for one in found.coefficient)
    return {
        "tension": tension,
        "std": tension * found.std,
        "own_std": tension * found.own_std,
        "level": level,
        "level_std": level * found.level_std,
        "coefficient": a,
        "coefficient_std": std,
        "step": found.step[0],
        "step_interval": found.step[1:],
        "scatter": found.scatter,
        "off": found.off,
    }


# --- what each record tells ---------------------------------------------------------------------


class Day(NamedTuple):
    """What one record tells: NaN and a reason where it is left out."""

    ln_tension: float
    own_std: float  # of it: by the peaks
    whole_std: float  # of it: by all that is not known
    status: str
    reason: str


def _fits(
    scene: Scene, measured: Sequence[Any], paths: Any, options: dict[str, Any], progress: Progress
) -> list[Fit | RopedynError]:
    """Identify each record; an error in place of those that tell nothing."""
    report = reporter(progress)
    fits: list[Fit | RopedynError] = []
    for i, one in enumerate(measured):
        try:
            fits.append(one if isinstance(one, Fit) else _fit(scene, one, paths, options))
        except TypeError as error:
            raise TypeError(f"measured[{i}]: {error}") from error
        report((i + 1) / len(measured))
    return fits


def _fit(scene: Scene, one: Any, paths: Any, options: dict[str, Any]) -> Fit | RopedynError:
    """Identify one record; its notes stay with the fit."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", IdentifyWarning)
        try:
            return identify(scene, one, paths, **options)
        except RopedynError as error:
            return error


def _day_of(fit: Fit | RopedynError) -> Day:
    """Return what a fit leaves open, and what of it its own peaks do."""
    if isinstance(fit, RopedynError):
        return _nothing("failed", str(fit))
    if fit.status != "trusted":
        return _nothing(fit.status, fit.status)
    low, high = fit.interval(LEVEL)["tension"]
    if not 0 < low < high < np.inf:
        return _nothing("open", f"its tension is told from {low:.4g} to {high:.4g} N only")
    z = quantile(LEVEL)
    whole = max(np.log(high / low) / (2 * z), LEAST_STD)
    own = min(max(fit.budget["peaks"] / z, LEAST_STD), whole)
    # the likeliest end may be another one in each record; the middle of what all ends leave is not
    ln_tension = float(np.log(low * high) / 2)
    return Day(ln_tension, float(own), float(whole), fit.status, "")


def _nothing(status: str, reason: str) -> Day:
    return Day(np.nan, np.nan, np.nan, status, reason)


# --- what was given, and what limits the answer -------------------------------------------------


def _with_tension(unknown: Any) -> Any:
    """Return the paths, the tension among them."""
    paths = (unknown,) if isinstance(unknown, str) else unknown
    check.instance(paths, "unknown", (list, tuple), 'paths such as ["tension"]')
    if "tension" not in paths:
        raise SceneError(f'unknown must have "tension" among its paths, got {check.shown(unknown)}')
    return list(paths)


def _each(values: Any, name: str, n: int) -> Real:
    """Return a number of each record."""
    array = check.numbers(values, name)
    if len(array) != n:
        raise SceneError(f"{name} must have {n} values, one for each of measured, got {len(array)}")
    return array


def _days(time: Any, n: int) -> tuple[Real, str]:
    """Return the time of each record in days, and since when."""
    if time is None:
        return np.arange(float(n)), ""
    given, since = np.asarray(time), ""
    if given.dtype.kind == "M":
        if given.ndim != 1 or given.size == 0 or np.isnat(given).any():
            raise SceneError(f"time must be dates, one for each record, got {check.shown(time)}")
        since = str(given[0].astype("datetime64[ms]"))
        time = (given - given[0]).astype("timedelta64[ms]").astype(np.float64) / DAY
    day = _each(time, "time", n)
    back = np.flatnonzero(np.diff(day) < 0)
    if len(back):
        at = int(back[0]) + 1
        raise SceneError(
            f"time must not decrease, got {given[at]} after {given[at - 1]} at time[{at}]: "
            "sort the records"
        )
    return day, since


def _enough(told: Flags, days: Sequence[Day], day: Real, warmth: Real | None) -> None:
    """Refuse what tells no walk."""
    least = FEWEST if warmth is None else FEWEST_WITH_TEMPERATURE
    if told.sum() < least:
        why = next(
            (f": record {i} is {one.reason}" for i, one in enumerate(days) if one.reason), ""
        )
        raise SceneError(
            f"measured must have at least {least} records that tell a tension, got "
            f"{int(told.sum())}{why}"
        )
    if np.ptp(day[told]) == 0:
        raise SceneError(
            f"time must differ between records that tell a tension, got {day[told][0]}"
        )
    if warmth is not None and np.ptp(warmth[told]) == 0:
        raise SceneError(f"temperature must differ between records, got {warmth[told][0]} for all")


def _notes(found: Walk, days: Sequence[Day], day: Real) -> tuple[str, ...]:
    """Say which records are left out, which are off, and what the records do not tell."""
    named = [f"record {i} (day {day[i]:.6g})" for i in range(len(days))]
    notes = [f"{named[i]} left out: {one.reason}" for i, one in enumerate(days) if one.reason]
    told = [one for one in days if not one.reason]
    most = NormalDist().inv_cdf(1 - 0.5 * ODD / len(told))
    off = np.nan_to_num(np.abs(found.off))
    notes += [
        f"{named[i]} is {off[i]:.1f} standard deviations off what the others say: look at its "
        "orders, or leave it out"
        for i in np.flatnonzero(off > most).tolist()
    ]
    if found.scatter > SCATTERED * np.median([one.whole_std / one.own_std for one in told]):
        notes.append(
            f"records scatter {found.scatter:.2g} times as much as their peaks say, more than "
            "anything that was thought unknown explains: std contains it"
        )
    if len(told) < FEW:
        low, high = (100 * bound for bound in found.step[1:])
        notes.append(
            f"{len(told)} records hardly tell how far the tension moves in a day: "
            f"{low:.2g} to {high:.2g} %"
        )
    return tuple(notes)
