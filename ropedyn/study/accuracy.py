"""What accuracy costs: time and error of every way to the answer of a question."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..ask import AnyQuestion
from ..base import check
from ..base.answer import Answer, Cost, axes
from ..base.array import Index, Integer, Real
from ..base.computed import waited
from ..base.errors import SceneError
from ..base.progress import Progress, reporter
from ..base.table import Table, numbers
from ..base.unit import power
from ..chain.chain import KINDS
from ..chain.compile import MOST_ELEMENTS
from ..scene.scene import Scene
from .truth import CUTS, Truth
from .verdict import verdict_of
from .way import check_question, priced, words

TOLERANCES = (1e-3, 1e-6, 1e-9, 1e-12)  # The cheapest way is looked for within each of them.
ROUNDING = 64 * float(np.finfo(float).eps)  # Smaller errors are equal.


@dataclass(frozen=True, eq=False)
class AccuracyCost(Answer):
    """Time and error of every way to the answer of a question; made by `accuracy_cost`.

    Attributes
    ----------
    question : str
        What was asked.
    reference : str
        What errors were measured against.
    element : ndarray of str, shape (rows,)
        Kind of the elements.
    elements : ndarray of int, shape (rows,)
        How many; of continuous spans how many spans.
    solver : ndarray of str, shape (rows,)
        "sweep", "lapack" or "band"; of motion over time the method.
    seconds : ndarray, shape (rows,)
        Processor time of the question, one thread: the median [s]; of modes that of frequencies,
        shapes come when they are asked for.
    lower_quartile, upper_quartile : ndarray, shape (rows,)
        Of the same [s].
    seconds_with_bound : ndarray, shape (rows,)
        The same as `seconds`, with the error bars of mesh and rounding read; NaN where answers have
        none.
    compile_seconds : ndarray, shape (rows,)
        Median processor time of `Scene.compile` [s].
    error : ndarray, shape (rows,)
        True relative error, the largest of all modes or lines; 1.1e-16 where none is seen. Modes
        are compared in order, rates and multipliers with the nearest; motion over time in parts of
        the largest value of each response, and no error of it is seen below that of the method for
        continuous spans. Values of which continuous spans have no correct digit themselves, as a
        response that is 0 by symmetry, are left out.
    estimated_error : ndarray, shape (rows,)
        Estimated relative error, of mesh and rounding together, the largest too; infinite where
        answers do not tell it.
    digits_lost : ndarray, shape (rows,)
        Decimal digits lost to rounding, of 15.7: those in which an assembled solver differs from
        the sweep along the same chain; of the sweep those that its own bound gives up. Of motion
        over time those lost to the method: in which one differs from ``"auto"``, or given up. NaN
        where answers tell no bound.
    memory : ndarray, shape (rows,)
        The most memory that compiling and asking took at once [B].
    refusal : ndarray of str, shape (rows,)
        Why there is no answer, empty where there is one; numbers of such rows are NaN.
    parts, part : int, str
        How many parts an answer has that share what it costs, such as 100 and "rope".
    cost : Cost
        Of all of it, the repetitions too: what the caller waited.

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
    >>> question = rd.ask.modes(1)
    >>> cost = rd.accuracy_cost(scene, question, elements=[8, 64], solver="sweep", repeat=1)
    >>> cost.element.tolist(), cost.elements.tolist()
    (['rigid', 'rigid', 'tensed', 'tensed', 'continuous'], [8, 64, 8, 64, 1])
    >>> cost.error[:2].round(6)
    array([0.006413, 0.0001  ])
    >>> bool((cost.total_seconds > 0).all()), cost.cheapest[1e-12], cost.cost.method
    (True, 4, 'trials')
    >>> print(cost.front[-1], cost.verdict[:28])
    4 For a relative error of 1e-3
    """

    question: str
    reference: str
    element: NDArray[np.str_] = field(metadata=axes("row"))
    elements: Integer = field(metadata=axes("row"))
    solver: NDArray[np.str_] = field(metadata=axes("row"))
    seconds: Real = field(metadata=axes("row", unit="s"))
    lower_quartile: Real = field(metadata=axes("row", unit="s"))
    upper_quartile: Real = field(metadata=axes("row", unit="s"))
    seconds_with_bound: Real = field(metadata=axes("row", unit="s"))
    compile_seconds: Real = field(metadata=axes("row", unit="s"))
    error: Real = field(metadata=axes("row"))
    estimated_error: Real = field(metadata=axes("row"))
    digits_lost: Real = field(metadata=axes("row"))
    memory: Real = field(metadata=axes("row", unit="B"))
    refusal: NDArray[np.str_] = field(metadata=axes("row"))
    parts: int
    part: str
    cost: Cost

    @property
    def total_seconds(self) -> Real:
        """From the scene to the answer: compile and question [s], shape (rows,)."""
        return self.compile_seconds + self.seconds

    @property
    def cheapest(self) -> dict[float, int | None]:
        """Row that takes the least time from the scene within each of 1e-3, 1e-6, 1e-9, 1e-12.

        None where no row is within it; see `cheapest_within`.
        """
        return {tolerance: self.cheapest_within(tolerance) for tolerance in TOLERANCES}

    def cheapest_within(self, tolerance: float, *, before: float = np.inf) -> int | None:
        """Return the row that takes the least time of those whose true error is within a tolerance.

        Of rows whose time quartiles do not tell from the least it is the most accurate.

        Parameters
        ----------
        tolerance : float
            Relative error.
        before : float
            Only of rows whose time is less than this [s] by its quartiles.

        Returns
        -------
        int or None
            None where no row is within it.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
        >>> question = rd.ask.modes(1)
        >>> cost = rd.accuracy_cost(scene, question, elements=[8, 64], solver="sweep", repeat=1)
        >>> cost.cheapest_within(1e-9)
        4
        """
        within = check.number(tolerance, "tolerance", sign="positive")
        soonest = self.compile_seconds + self.lower_quartile
        latest = self.compile_seconds + self.upper_quartile
        enough = np.flatnonzero((self.error <= within) & (latest < before))
        if len(enough) == 0:
            return None
        quickest = enough[np.argmin(self.total_seconds[enough])]
        tied = enough[soonest[enough] <= latest[quickest]]
        # of errors that rounding makes equal no mesh, and the quickest
        meshed, error = self.element[tied] != "continuous", np.maximum(self.error[tied], ROUNDING)
        return int(tied[np.lexsort((self.total_seconds[tied], meshed, error))[0]])

    @property
    def front(self) -> Index:
        """Rows that no other one beats both in time and in error, the quickest first."""
        order = np.lexsort((self.error, self.total_seconds))
        order = order[self.refusal[order] == ""]
        before = np.minimum.accumulate(np.append(np.inf, self.error[order]))[:-1]
        return order[self.error[order] < before]

    @property
    def verdict(self) -> str:
        """Two sentences: what to take for 1e-3, 1e-6, 1e-12, and what the cheapest would save."""
        return verdict_of(self)

    def way(self, row: int) -> str:
        """Say in words how a row answers, such as ``tensed, 64, sweep``.

        Examples
        --------
        >>> import ropedyn as rd
        >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
        >>> cost = rd.accuracy_cost(scene, rd.ask.modes(1), elements=8, element="tensed", repeat=1)
        >>> cost.way(0), cost.way(1)
        ('tensed, 8, sweep', 'tensed, 8, lapack')
        """
        check.count(row, "row", least=0, most=len(self.element) - 1)
        return words(self.element[row], self.elements[row], self.solver[row])

    def table(self) -> Table:
        """Return one row for each way, the cheapest ones marked."""
        marks: list[list[str]] = [[] for _ in self.element]
        for tolerance, row in self.cheapest.items():
            if row is not None:
                marks[row].append(power(tolerance))
        columns: dict[str, Any] = {
            "element": self.element,
            "elements": self.elements,
            "solver": self.solver,
            "time [s]": numbers(self.total_seconds),
            "from [s]": numbers(self.compile_seconds + self.lower_quartile),
            "to [s]": numbers(self.compile_seconds + self.upper_quartile),
            "with error bar [s]": numbers(self.compile_seconds + self.seconds_with_bound),
            "true error": numbers(self.error),
            "estimated error": numbers(self.estimated_error),
            "digits lost": numbers(self.digits_lost.round(1)),
            "memory [MB]": numbers((self.memory / 1e6).round(3)),
            "cheapest for": tuple(", ".join(mark) or None for mark in marks),
        }
        if any(self.refusal.tolist()):
            columns["refused"] = tuple(text or None for text in self.refusal.tolist())
        about = f"{self.question}: relative error against {self.reference}"
        return Table.of(f"{self.verdict}\n\n{about}", columns)


@waited
def accuracy_cost(
    scene: Scene,
    question: AnyQuestion,
    *,
    elements: int | Sequence[int] | None = None,
    element: str | Sequence[str] = ("rigid", "tensed", "continuous"),
    solver: str | Sequence[str] | None = None,
    repeat: int = 7,
    progress: Progress = None,
) -> AccuracyCost:
    """Measure what every way to the answer of a question costs, and how wrong it is.

    Errors are measured against continuous spans, which have no mesh; those of continuous spans
    against the same spans cut into 3, 5 and 7 parts, the same rope by other arithmetic.

    Parameters
    ----------
    scene : Scene
        What is asked about.
    question : question
        Of any kind, such as ``rd.ask.modes(10)``, ``rd.ask.frf(frequency, drive=("z", 0.5))`` or
        ``rd.ask.motion(time, drive=("z", 0.5), force=rd.Step(1.0))``.
    elements : int or sequence of int, optional
        Of chains; powers of two from 8 to 4096, as far as slow solvers take some 0.03 s, where left
        out.
    element : str or sequence of str
        Kinds of element; of continuous spans there is a row for each solver that takes them.
    solver : str or sequence of str, optional
        ``"sweep"`` and ``"lapack"`` where left out, for a frequency response also ``"band"``; of
        motion over time one of the methods of `Model.transient`, ``"auto"`` where left out.
    repeat : int
        How often each is timed, in turns, warmed up; calls that take more than 0.01 s at most three
        times, more than 0.3 s once. Of the times the median and the quartiles are kept, of the
        processor, one thread.
    progress : None, True or callable
        True prints, a callable takes, the fraction that is done.

    Returns
    -------
    AccuracyCost
        What is refused on a chain, as more modes than it has, is a row with the reason.

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    SceneError
        If a value has no meaning, or there is nothing to measure.
    SolveError
        If continuous spans have no answer, or no correct digit of it.

    Examples
    --------
    >>> import ropedyn as rd
    >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
    >>> cost = rd.accuracy_cost(scene, rd.ask.modes(1), elements=[8, 16, 32], repeat=1)
    >>> cost.error[:3].round(5)  # of a string (pi/2n)^2/6
    array([0.00641, 0.00161, 0.0004 ])
    >>> print(cost.error[-1] < 1e-14)  # continuous spans
    True
    """
    check_question(scene, question)
    kinds = _words(element, "element", KINDS)
    given = question.usual if solver is None else solver
    solvers = _words(given, "solver", question.solvers)
    counts = None if elements is None else _counts(elements)
    check.count(repeat, "repeat", most=10_000)
    report = reporter(progress)
    if kinds == ("continuous",) and not set(solvers) & set(question.of_spans):
        able = " or ".join(f'"{one}"' for one in question.of_spans)
        raise SceneError(f"solver must have {able} for continuous spans, got {solvers}")
    truth = Truth.of(scene, question)
    ways = truth.ways(kinds, counts, solvers)
    cuts = ", ".join(map(str, CUTS[:-1]))
    nothing = dict.fromkeys(("error", "estimated_error", "digits_lost", "memory"), np.nan)
    attempts = [partial(truth.tried, *way) for way in ways]
    columns, times = priced(attempts, nothing, repeat, report, bounds=True)
    unknown = ~np.isfinite(columns["estimated_error"])
    # reading more takes no less: what is measured to be less is noise
    bounded = np.where(unknown, np.nan, np.maximum(times.seconds, times.seconds_with_bound))
    times = times._replace(seconds_with_bound=bounded)
    parts, part = question.parts
    return AccuracyCost(
        question=str(question),
        reference=f"continuous spans, of these against cuts into {cuts} and {CUTS[-1]} parts",
        **{name: np.array(c) for name, c in zip(("element", "elements", "solver"), zip(*ways))},
        **times._asdict(),
        **columns,
        parts=parts,
        part=part,
        cost=Cost("trials", sum(n for _, n, _ in ways), 0),
    )


def _words(given: Any, name: str, words: Sequence[str]) -> tuple[str, ...]:
    """Return one word or several, each once."""
    if not isinstance(given, (tuple, list)):
        return (check.one_of(given, name, words),)
    if not given:
        raise SceneError(f"{name} must have at least one of {', '.join(words)}, got {given!r}")
    return tuple(dict.fromkeys(check.one_of(w, f"{name}[{k}]", words) for k, w in enumerate(given)))


def _counts(given: Any) -> tuple[int, ...]:
    """Return one number of elements or several, each once, increasing."""
    several = isinstance(given, (tuple, list, range))
    if not several and not (isinstance(given, np.ndarray) and given.ndim > 0):
        return (check.count(given, "elements", most=MOST_ELEMENTS),)
    if len(given) == 0:
        raise SceneError(f"elements must have at least one number, got {check.shown(given)}")
    return tuple(
        sorted({check.count(n, f"elements[{k}]", most=MOST_ELEMENTS) for k, n in enumerate(given)})
    )
