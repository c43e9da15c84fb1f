"""Identifications of many ropes."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol, overload

import numpy as np
from numpy.typing import NDArray

from ...base.answer import TRANSIENT, Answer, Cost, axes, sealed, unsealed
from ...base.array import Flags, Real
from ...base.computed import Lazy, computed, lazy
from ...base.drawing import draw
from ...base.errors import RopedynError, SceneError, SolveError
from ...base.progress import Progress
from ...base.table import Table, numbers
from ...curves.peaks import Peaks
from ...family.rows import Filled, Means, Shared, one_by_one
from ...response.question import workers_of
from ..fitting.solution import Solution
from .fit import Fit
from .found import Found, by_peaks_alone
from .known import (
    LEVELS,
    METHODS,
    TOLD,
    checked_level,
    intervals,
    kept_bounds,
    without_end,
)
from .notes import notes_of, noteworthy
from .one_rope import RopeTask
from .told import Told

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CLEAR = 0.1  # Of itself: a number with less of a standard deviation has an interval with two ends.
MOST_KEPT = 100  # Fits of one rope each take 50 kB of a file, and as many milliseconds.
NAMED = 5  # Ropes of which the same is noted are named up to so many.


class Batch(Protocol):
    """Fits of many ropes."""

    def fit(self, i: int) -> Fit | None:
        """Return that of one rope, None where it has none."""

    def errors(self) -> Mapping[int, RopedynError]:
        """Return why ropes have none, by their number."""

    def interval(self, level: float, method: str) -> Real:
        """Return intervals of all, NaN of those that have none, shape (n, p, 2)."""


class SideBySide:
    """Fits by least squares, made of the solution of all when they are asked for."""

    def __init__(self, found: Found, measured: Sequence[Peaks]) -> None:
        self.found, self.measured = found, measured

    def fit(self, i: int) -> Fit | None:
        """Return that of one rope, None where it has none."""
        if i in self.found.reasons:
            return None
        identification, peaks = self.found.identification, self.measured[i]
        k = self.found.ropes["peaks"][i]
        how = identification.how._replace(orders=self.found.ropes["orders"][i, :k])
        return RopeTask(identification.scene, how, peaks, partial(self._tell, i)).fit()

    def _tell(self, i: int, how: Any, peaks: Peaks, orders: Any, scene: Any) -> Told:
        found = self.found.identification
        if scene is found.scene and how.prior is found.how.prior:
            return self.found.told(i)
        return by_peaks_alone(how, peaks, orders, scene)

    def errors(self) -> Mapping[int, RopedynError]:
        """Return why ropes have none, by their number."""
        return {i: self.found.error(i) for i in sorted(self.found.reasons)}

    def interval(self, level: float, method: str) -> Real:
        """Return intervals of all, NaN of those that have none, shape (n, p, 2)."""
        return self.found.interval(level, method)


class EachAlone:
    """Fits that were made one by one."""

    def __init__(self, fits: Sequence[Fit | None], failed: Mapping[int, RopedynError]) -> None:
        self.fits, self.failed = fits, failed

    def fit(self, i: int) -> Fit | None:
        """Return that of one rope, None where it has none."""
        return self.fits[i]

    def errors(self) -> Mapping[int, RopedynError]:
        """Return why ropes have none, by their number."""
        return self.failed

    def interval(self, level: float, method: str) -> Real:
        """Return intervals of all, NaN of those that have none, shape (n, p, 2)."""
        there = [one for one in self.fits if one is not None]
        blank = np.full((len(there[0].unknown) if there else 1, 2), np.nan)
        return np.array(
            [blank if one is None else one.interval(level, method=method) for one in self.fits]
        )


@dataclass(frozen=True, eq=False)
class Fits(Answer, Sequence[Fit | None]):
    """What was identified of many ropes, in their order.

    A sequence of `Fit`, None where one failed; each is made when it is asked for.

    Attributes
    ----------
    unknown : tuple of str
        Paths of the numbers.
    value, std : ndarray, shape (ropes, p)
        NaN of ropes that have no solution.
    rms : ndarray, shape (ropes,)
        Root mean square of relative residuals.
    status : tuple of str
        Of each rope: "trusted", "ambiguous" or "refused", as `Fit.status`; what has no solution is
        refused.
    failure : tuple of str
        Why one has no solution; empty of the others.
    notes : tuple of str
        What the peaks cannot tell, and of which ropes.
    cost : Cost
        Of all together.

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=500.0)
    >>> peaks = [rd.Peaks([f, 2 * f], std=0.1) for f in (25.0, 30.0)]
    >>> fits = rd.identify(scene, peaks, "tension", orders=[1, 2])
    >>> len(fits), fits.value.round(3).tolist(), fits.status
    (2, [[1000.0], [1440.0]], ('trusted', 'trusted'))
    """

    unknown: tuple[str, ...]
    value: Real = field(metadata=axes("rope", "unknown"))
    std: Real = field(metadata=axes("rope", "unknown"))
    rms: Real = field(metadata=axes("rope"))
    status: tuple[str, ...]
    failure: tuple[str, ...]
    notes: tuple[str, ...]
    cost: Cost
    bounds: Lazy[Real] = lazy(np.ndarray, axes("level", "rope", "unknown", "bound"))
    whole: Lazy[NDArray[np.str_]] = lazy(np.ndarray, axes("rope"))
    batch: Batch | None = field(default=None, repr=False, metadata=TRANSIENT)

    @computed
    def failed(self) -> Mapping[int, RopedynError]:
        """Why ropes have no solution, by their number from 0."""
        return self._batch.errors()

    @computed
    def _batch(self) -> Batch:
        if self.batch is not None:
            return self.batch
        each = (base64.b64decode(one) for one in self.whole.tolist())
        fits = [unsealed(one, Path("fits")) if one else None for one in each]
        return EachAlone(fits, {i: RopedynError(why) for i, why in enumerate(self.failure) if why})

    def __len__(self) -> int:
        return len(self.rms)

    @overload
    def __getitem__(self, at: int) -> Fit | None: ...
    @overload
    def __getitem__(self, at: slice) -> tuple[Fit | None, ...]: ...
    def __getitem__(self, at: int | slice) -> Fit | tuple[Fit | None, ...] | None:
        """Return the fit of a rope; a file keeps those of 100 ropes at most."""
        if isinstance(at, slice):
            return tuple(self._batch.fit(i) for i in range(len(self))[at])
        return self._batch.fit(range(len(self))[at])

    def __iter__(self) -> Iterator[Fit | None]:
        return (self[i] for i in range(len(self)))

    def interval(self, level: float = 0.95, *, method: str = "profile") -> Real:
        """Find confidence intervals of all ropes, as `Fit.interval` does.

        Parameters
        ----------
        level, method
            As `Fit.interval` takes them.

        Returns
        -------
        ndarray, shape (ropes, p, 2)
            NaN of ropes that have no solution.

        Raises
        ------
        TypeError, SceneError
            As `Fit.interval` does.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=500.0)
        >>> peaks = [rd.Peaks([f, 2 * f], std=0.1) for f in (25.0, 30.0)]
        >>> fits = rd.identify(scene, peaks, "tension", orders=[1, 2])
        >>> fits.interval(method="linear").round(1).tolist()
        [[[993.0, 1007.0]], [[1431.6, 1448.4]]]
        """
        level = checked_level(level, method)
        if self.batch is not None:
            return self.batch.interval(level, method)
        if level not in LEVELS or method != METHODS[0]:
            raise SceneError(
                f'level must be one of {LEVELS} and method "{METHODS[0]}" of fits from a file, got '
                f"{level!r} and {method!r}: identify again"
            )
        return np.asarray(self.bounds[LEVELS.index(level)])

    def report(self) -> str:
        """Return how many ropes came to which state, and why others did not, as text.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
        >>> peaks = rd.Peaks([25.0, 50.0, 75.0], std=0.1)
        >>> print(rd.identify(scene, [peaks], "tension").report())
        1 ropes: 1 trusted
        """
        states = {one: self.status.count(one) for one in dict.fromkeys(self.status)}
        said = [f"{count} {one}" for one, count in states.items()]
        lines = [f"{len(self)} ropes: {', '.join(said) or 'none'}"]
        lines += [f"note: {note}" for note in self.notes]
        for i, (state, why) in enumerate(zip(self.status, self.failure)):
            if why:
                lines.append(f"rope {i} {state}: {why}")
        return "\n".join(lines)

    def table(self) -> Table:
        """Return one row for each rope."""
        columns: dict[str, Any] = {"rope": np.arange(len(self))}
        bounds = self.interval()
        for k, path in enumerate(self.unknown):
            columns[path] = numbers(self.value[:, k])
            columns[f"std of {path}"] = numbers(self.std[:, k])
            columns[f"{path}, 95 % from"] = numbers(bounds[:, k, 0])
            columns[f"{path}, to"] = numbers(bounds[:, k, 1])
        columns["rms residual [%]"] = numbers(100 * self.rms)
        columns["status"] = self.status
        if any(self.failure):
            columns["failure"] = tuple(why or None for why in self.failure)
        return Table.of("identified", columns)

    def plot(self, ax: Axes | None = None, *, unknown: str | None = None) -> Axes:
        """Plot one number of each rope with its standard deviation, the first by default."""
        return draw(self, "plot", ax, unknown=unknown)


def fits_of(found: Found, measured: Sequence[Peaks]) -> Fits:
    """Gather what was found side by side."""
    solution, ropes, n = found.solution, found.ropes, len(found.ropes)
    how, at = found.identification.how, solution.rows
    p = len(how.paths)
    value, std, rms = np.full((n, p), np.nan), np.full((n, p), np.nan), np.full(n, np.nan)
    value[at], std[at] = solution.value[:, :p], solution.std[:, :p]
    relative = (ropes["weight"] / ropes["measured"])[at]
    off = solution.record["residual"][:, : solution.peaks] * relative
    rms[at] = np.sqrt(np.sum(off**2, axis=1) / (ropes["orders"][at] > 0).sum(axis=1))
    evaluations = int(solution.record["evaluations"].sum())
    elements = how.elements or 0
    batch = SideBySide(found, measured)
    status = np.full(n, "refused", dtype=object)
    status[at] = np.where(_without_end(solution), "ambiguous", "trusted")
    return Fits(
        unknown=how.paths,
        value=value,
        std=std,
        rms=rms,
        status=tuple(status.tolist()),
        failure=tuple(found.reasons[i][1] if i in found.reasons else "" for i in range(n)),
        notes=_notes(solution),
        cost=Cost("least squares", elements, n * p, factorisations=evaluations),
        bounds=partial(kept_bounds, batch.interval),
        whole=partial(_whole, batch, n),
        batch=batch,
    )


def _whole(batch: Batch, n: int) -> NDArray[np.str_]:
    """Return the file of each fit as text, empty where there is none."""
    if n > MOST_KEPT:
        raise SceneError(f"a file keeps {MOST_KEPT} fits at most, got {n}: identify again")
    fits = (batch.fit(i) for i in range(n))
    return np.array(["" if one is None else base64.b64encode(sealed(one)).decode() for one in fits])


def _without_end(solution: Solution) -> Flags:
    """Say of which ropes the interval of some number reaches infinity, shape (n,)."""
    shown = solution.unknowns.shown
    value, std = solution.value[:, :shown], solution.std[:, :shown]
    clear = (std < CLEAR * np.abs(value)).all(axis=1) & ~noteworthy(solution)
    endless, doubtful = np.zeros(len(clear), dtype=np.bool_), np.flatnonzero(~clear)
    if len(doubtful):
        found = intervals(solution.take(doubtful), TOLD, METHODS[0])[:, :shown]
        endless[doubtful] = without_end(found).any(axis=1)
    return endless


def each_alone(
    tasks: Sequence[RopeTask],
    refused: Mapping[int, SceneError],
    *,
    threads: int | None,
    executor: Executor | None,
    progress: Progress,
) -> Fits:
    """Identify ropes one by one."""
    n, how = len(tasks), tasks[0].how
    rows, fits = np.empty(n, dtype=object), np.empty(n, dtype=object)
    rows[:] = [None if i in refused else task for i, task in enumerate(tasks)]
    shared = Shared(rows, workers_of(threads), executor, progress)
    reasons, _ = shared.fill([fits], [Means(_fit_rows, 1)])
    failed: dict[int, RopedynError] = {
        i: SceneError(text) if kind == "SceneError" else SolveError(text)
        for i, kind, text in reasons
        if i not in refused
    }
    failed |= refused
    there: list[Fit | None] = fits.tolist()
    nan = np.full(len(how.paths), np.nan)
    batch = EachAlone(there, dict(sorted(failed.items())))
    costs = [one.cost for one in there if one is not None]
    return Fits(
        unknown=how.paths,
        value=np.array([nan if one is None else one.value for one in there]),
        std=np.array([nan if one is None else one.std for one in there]),
        rms=np.array([np.nan if one is None else one.rms for one in there]),
        status=tuple("refused" if one is None else one.status for one in there),
        failure=tuple(str(failed[i]) if i in failed else "" for i in range(n)),
        notes=_gathered({i: one.notes for i, one in enumerate(there) if one is not None}),
        cost=Cost(
            costs[0].method if costs else "none",
            how.elements or 0,
            n * len(how.paths),
            factorisations=sum(one.factorisations for one in costs),
        ),
        bounds=partial(kept_bounds, batch.interval),
        whole=partial(_whole, batch, n),
        batch=batch,
    )


def _fit_rows(tasks: Any) -> Filled:
    """Identify some ropes; None stands for one that is refused."""
    return one_by_one(_fit_row, tasks)


def _fit_row(task: Any) -> tuple[Fit]:
    if task is None:
        raise SceneError("refused")
    return (task.fit(),)


def _notes(solution: Solution) -> tuple[str, ...]:
    """Return what was not told."""
    at = np.flatnonzero(noteworthy(solution))
    return _gathered(
        {int(solution.rows[k]): notes_of(solution.take(np.array([k]))) for k in at.tolist()}
    )


def _gathered(notes: Mapping[int, Sequence[str]]) -> tuple[str, ...]:
    """Return equal sentences once, with the ropes."""
    ropes: dict[str, list[int]] = {}
    for i, some in notes.items():
        for note in some:
            ropes.setdefault(note, []).append(i)
    return tuple(f"{_named(some)}: {note}" for note, some in ropes.items())


def _named(ropes: list[int]) -> str:
    """Name some ropes."""
    few, others = ", ".join(map(str, ropes[:NAMED])), len(ropes) - NAMED
    many = f" and {others} others" if others > 0 else ""
    return f"rope{'s' if len(ropes) > 1 else ''} {few}{many}"
