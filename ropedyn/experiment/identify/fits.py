"""Identifications of many ropes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from ...base.answer import TRANSIENT, Answer, Cost, axes
from ...base.array import Real
from ...base.computed import computed
from ...base.drawing import draw
from ...base.errors import RopedynError, SceneError
from ...base.table import Table, numbers
from .fit import Fit
from .found import Found
from .identified import intervals
from .notes import notes_of, noteworthy
from .solution import Solution

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STATES = {"NotConverged": "not converged"}  # By the kind of the error.
NAMED = 5  # Ropes of which the same is noted are named up to so many.


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
        Of each rope: "converged", "at a bound" where a number went to 0 or infinity,
        "not converged" or "failed".
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
    >>> fits = rd.identify(scene, peaks, "tension")
    >>> len(fits), fits.value.round(3).tolist(), fits.status
    (2, [[1000.0], [1440.0]], ('converged', 'converged'))
    """

    unknown: tuple[str, ...]
    value: Real = field(metadata=axes("rope", "unknown"))
    std: Real = field(metadata=axes("rope", "unknown"))
    rms: Real = field(metadata=axes("rope"))
    status: tuple[str, ...]
    failure: tuple[str, ...]
    notes: tuple[str, ...]
    cost: Cost
    found: Found | None = field(default=None, repr=False, metadata=TRANSIENT)

    @computed
    def failed(self) -> Mapping[int, RopedynError]:
        """Why ropes have no solution, by their number from 0."""
        return {i: self._found.error(i) for i in sorted(self._found.reasons)}

    @property
    def _found(self) -> Found:
        if self.found is None:
            raise SceneError("fits from a file have no scene: identify again")
        return self.found

    def __len__(self) -> int:
        return len(self.rms)

    @overload
    def __getitem__(self, at: int) -> Fit | None: ...
    @overload
    def __getitem__(self, at: slice) -> tuple[Fit | None, ...]: ...
    def __getitem__(self, at: int | slice) -> Fit | tuple[Fit | None, ...] | None:
        """Return the fit of a rope; those of a file have only what the table shows."""
        if isinstance(at, slice):
            return tuple(self._found.fit(i) for i in range(len(self))[at])
        return self._found.fit(range(len(self))[at])

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
        >>> rd.identify(scene, peaks, "tension").interval(method="linear").round(1).tolist()
        [[[993.0, 1007.0]], [[1431.6, 1448.4]]]
        """
        found = np.full((*self.value.shape, 2), np.nan)
        solution = self._found.solution
        found[solution.rows] = intervals(solution, level, method)
        return found

    def report(self) -> str:
        """Return how many ropes came to which state, and why others did not, as text.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(2.0, 0.1), tension=500.0)
        >>> print(rd.identify(scene, [rd.Peaks([25.0, 50.0], std=0.1)], "tension").report())
        1 ropes: 1 converged
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
        for k, path in enumerate(self.unknown):
            columns[path] = numbers(self.value[:, k])
            columns[f"std of {path}"] = numbers(self.std[:, k])
        columns["rms residual [%]"] = numbers(100 * self.rms)
        columns["status"] = self.status
        if any(self.failure):
            columns["failure"] = tuple(why or None for why in self.failure)
        return Table.of("identified", columns)

    def plot(self, ax: Axes | None = None, *, unknown: str | None = None) -> Axes:
        """Plot one number of each rope with its standard deviation, the first by default."""
        return draw(self, "plot", ax, unknown=unknown)


def fits_of(found: Found) -> Fits:
    """Gather the numbers."""
    solution, ropes, n = found.solution, found.ropes, len(found.ropes)
    how, at = found.identification.how, solution.rows
    p = len(how.paths)
    value, std, rms = np.full((n, p), np.nan), np.full((n, p), np.nan), np.full(n, np.nan)
    value[at], std[at] = solution.value, solution.std
    relative = (ropes["weight"] / ropes["measured"])[at]
    off = solution.record["residual"][:, : solution.peaks] * relative
    rms[at] = np.sqrt(np.sum(off**2, axis=1) / (ropes["orders"][at] > 0).sum(axis=1))
    state, failure = np.full(n, "converged", dtype=object), np.full(n, "", dtype=object)
    state[at[solution.side.any(axis=1)]] = "at a bound"
    for i, (kind, text) in found.reasons.items():
        state[i], failure[i] = STATES.get(kind, "failed"), text
    evaluations = int(solution.record["evaluations"].sum())
    seconds, elements = n * found.seconds, how.elements or 0
    return Fits(
        unknown=how.paths,
        value=value,
        std=std,
        rms=rms,
        status=tuple(state.tolist()),
        failure=tuple(failure.tolist()),
        notes=_notes(solution),
        cost=Cost(seconds, "least squares", elements, n * p, factorisations=evaluations),
        found=found,
    )


def _notes(solution: Solution) -> tuple[str, ...]:
    """Return what was not told, equal sentences once, with the ropes."""
    ropes: dict[str, list[int]] = {}
    for k in np.flatnonzero(noteworthy(solution)):
        for note in notes_of(solution.take(np.array([k]))):
            ropes.setdefault(note, []).append(int(solution.rows[k]))
    return tuple(f"{_named(some)}: {note}" for note, some in ropes.items())


def _named(ropes: list[int]) -> str:
    """Name some ropes."""
    few, others = ", ".join(map(str, ropes[:NAMED])), len(ropes) - NAMED
    many = f" and {others} others" if others > 0 else ""
    return f"rope{'s' if len(ropes) > 1 else ''} {few}{many}"
