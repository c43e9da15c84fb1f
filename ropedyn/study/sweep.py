"""Many scenes: one function of each of them, here or on an executor."""

from __future__ import annotations

import os
import pickle
from collections import deque
from collections.abc import Callable, Generator, Iterable, Mapping, Sequence
from contextlib import closing
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Generic, TypeVar, overload

import numpy as np

from ..base import check
from ..base.answer import Answer, Cost
from ..base.array import Real
from ..base.atomic import write_bytes
from ..base.computed import waited
from ..base.progress import Progress, reporter
from ..base.table import Table, numbers
from ..base.threads import Errands
from .archive import packed, unpacked
from .outcome import Errand, Failure, Outcome, outcome_of

if TYPE_CHECKING:
    from concurrent.futures import Executor, Future

    import pandas as pd

One = TypeVar("One")
Result = TypeVar("Result")

CHUNKS = 128  # Scenes are sent in so many chunks, or one by one where there are fewer.
NUMBERS = (bool, int, float, complex)  # These have columns of their own in the table.
WIDEST = 20  # A row has at most so many of them.


@dataclass(frozen=True, eq=False, repr=False)
class Sweep(Sequence[Result | None], Generic[Result]):
    """Results of many scenes in their order: a sequence, with None where a scene failed.

    Attributes
    ----------
    results : tuple, length (k,)
        What the function returned.
    failed : dict of int to exception
        Why there is no result, by the number of the scene from 0. An exception of another process
        carries the traceback of there as a note.
    seconds : ndarray, shape (k,)
        Wall time of each scene, NaN where it was not run or did not come back [s].
    cost : Cost
        Wall time of all together, `method` says on what; counts are sums over the costs of results.

    Examples
    --------
    >>> import ropedyn as rd
    >>> found = rd.sweep(lambda length: rd.Rope(length, 0.1), [2.0, -1.0, 4.0])
    >>> found
    <Sweep of 3 scenes, 1 failed>
    >>> found[0].length, found[1], found[2].length
    (2.0, None, 4.0)
    >>> found.failed[1]
    SceneError('length must be a finite number > 0 [m], got -1.0')
    """

    results: tuple[Result | None, ...]
    failed: Mapping[int, BaseException]
    seconds: Real
    cost: Cost

    def __post_init__(self) -> None:
        self.seconds.flags.writeable = False

    def __len__(self) -> int:
        return len(self.results)

    @overload
    def __getitem__(self, index: int) -> Result | None: ...

    @overload
    def __getitem__(self, index: slice) -> tuple[Result | None, ...]: ...

    def __getitem__(self, index: int | slice) -> Result | tuple[Result | None, ...] | None:
        return self.results[index]

    def __repr__(self) -> str:
        return f"<Sweep of {len(self)} scenes, {len(self.failed)} failed>"

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()

    def table(self) -> Table:
        """Return one row for each scene.

        Numbers, rows of a few numbers, mappings and what a `Fit` found have columns of their own,
        other results are named; a scene that failed says why.

        Examples
        --------
        >>> import ropedyn as rd
        >>> table = rd.sweep(lambda length: rd.Rope(length, 0.1).length, [2.0, -1.0]).table()
        >>> table.column("result"), table.column("failed")
        ((2.0, None), (None, 'length must be a finite number > 0 [m], got -1.0'))
        """
        rows = [{} if k in self.failed else _cells(result) for k, result in enumerate(self.results)]
        names = dict.fromkeys(name for row in rows for name in row)
        columns: dict[str, Any] = {"scene": np.arange(len(self)), "time [s]": numbers(self.seconds)}
        columns |= {name: tuple(row.get(name) for row in rows) for name in names}
        if self.failed:
            why = (self.failed.get(k) for k in range(len(self)))
            # an exception without words by its kind
            told = (e and (" ".join(str(e).split()) or type(e).__name__) for e in why)
            columns["failed"] = tuple(told)
        return Table.of("sweep over scenes", columns)

    def to_dataframe(self) -> pd.DataFrame:
        """Return the table as a pandas data frame.

        Raises
        ------
        ImportError
            If pandas is missing.

        Examples
        --------
        >>> import ropedyn as rd
        >>> rd.sweep(abs, [-1, 2]).to_dataframe()["result"].tolist()
        [1, 2]
        """
        return self.table().to_dataframe()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the sweep, every result whole, as one file that `load` reads.

        Results are answers, scenes, numbers, texts, arrays, or lists, tuples and dictionaries of
        these. Of what failed kind, words and notes are kept; unknown kinds are `RopedynError`.

        Raises
        ------
        SceneError
            If a result is something else.
        ImportError
            If xarray or h5netcdf is missing, of sweeps that hold answers.

        Examples
        --------
        >>> from tempfile import NamedTemporaryFile
        >>> import ropedyn as rd
        >>> string = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0)
        >>> found = rd.sweep(lambda scene: scene.compile().modes(2), [string, "no scene"])
        >>> with NamedTemporaryFile() as file:
        ...     found.save(file.name)
        ...     again = rd.Sweep.load(file.name)
        >>> again[0].frequency.round(9), again.failed
        (array([25., 50.]), {1: AttributeError("'str' object has no attribute 'compile'")})
        """
        check.path(path)
        write_bytes(path, packed(vars(self)))

    @staticmethod
    def load(path: str | os.PathLike[str]) -> Sweep[Any]:
        """Read a sweep that was saved, as `ropedyn.load` does too."""
        return Sweep(**unpacked(check.path(path)))


@waited
def sweep(
    function: Callable[[One], Result],
    scenes: Iterable[One],
    *,
    executor: Executor | None = None,
    progress: Progress = None,
) -> Sweep[Result]:
    """Call a function with each of many scenes, and keep what it returns in their order.

    Scenes that fail are reported and do not stop the others, nor does an executor that breaks: what
    it did not finish has failed. Many short calls are sent together, so that each of them costs
    microseconds more; a chunk that takes long hands back what it has not begun.

    Parameters
    ----------
    function : callable
        Takes a scene, returns anything. On other processes it and what it returns are pickled:
        there it must be defined at the top of a module.
    scenes : iterable
        Of scenes, models, or whatever the function takes. It is read to its end at first.
    executor : concurrent.futures.Executor, optional
        `ThreadPoolExecutor`: the core runs without Python's lock, what is written in Python does
        not. `ProcessPoolExecutor`: all of it runs at once. Of a Dask client
        ``client.get_executor()``. Without one, scenes are run here one after the other.
    progress : None, True or callable
        True prints the share of scenes that are done to stderr, a callable takes it.

    Returns
    -------
    Sweep

    Raises
    ------
    TypeError
        If `function` is not callable or, for a process pool, cannot be pickled; if `scenes` is not
        iterable or `executor` no executor.

    Notes
    -----
    What ends it before its time (Ctrl-C, what `progress` raises) cancels what has not begun, and
    carries as its attribute ``sweep`` what is finished.

    Examples
    --------
    A string has f = sqrt(T/mu)/2 L:

    >>> from concurrent.futures import ThreadPoolExecutor
    >>> import ropedyn as rd
    >>> def first(scene):
    ...     return scene.compile().modes(1).frequency[0]
    >>> string = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0)
    >>> tensed = [string.replace(tension=T) for T in (250.0, 1000.0, 4000.0)]
    >>> with ThreadPoolExecutor(2) as pool:
    ...     found = rd.sweep(first, [*tensed, "no scene"], executor=pool)
    >>> [round(float(f), 9) for f in found[:3]], found[3]
    ([12.5, 25.0, 50.0], None)
    >>> found.failed
    {3: AttributeError("'str' object has no attribute 'compile'")}
    """
    if not callable(function):
        raise TypeError(f"function must be callable, got {check.shown(function)}")
    given = _listed(scenes)
    _check_executor(executor, function)
    report = reporter(progress)
    found: dict[int, Outcome] = {}
    here = ((k, outcome_of(function, scene)) for k, scene in enumerate(given))
    outcomes = here if executor is None else _sent(function, given, executor)
    try:
        with closing(outcomes):
            for k, outcome in outcomes:
                found[k] = outcome
                report(len(found) / len(given))
    except BaseException as stop:
        vars(stop)["sweep"] = _gathered(found, len(given), executor)
        raise
    return _gathered(found, len(given), executor)


def _listed(scenes: Iterable[One]) -> list[One]:
    try:
        walk = iter(scenes)
    except TypeError:
        text = f"scenes must be an iterable of scenes, got {check.shown(scenes)}"
        raise TypeError(text) from None
    return list(walk)


def _check_executor(executor: Executor | None, function: Callable[..., Any]) -> None:
    if executor is None:
        return
    from concurrent.futures import Executor

    what = "an executor such as ThreadPoolExecutor(), or client.get_executor() of a Dask client"
    check.instance(executor, "executor", Executor, what)
    try:
        _dumps(executor)(function)
    except Exception as error:
        raise TypeError(
            "function must be one that can be pickled for other processes, defined at the top of a "
            f"module, got {check.shown(function)}: {error}"
        ) from error


def _dumps(executor: Executor) -> Callable[[Any], Any]:
    """Return what an executor pickles functions by, as far as that is known."""
    from concurrent.futures import ProcessPoolExecutor

    if isinstance(executor, ProcessPoolExecutor):
        return pickle.dumps
    if type(executor).__module__.partition(".")[0] in ("distributed", "loky"):
        import cloudpickle

        return cloudpickle.dumps
    return id


# --- the work of all ------------------------------------------------------------------------------


def _sent(
    function: Callable[[One], Any], scenes: Sequence[One], executor: Executor
) -> Generator[tuple[int, Outcome]]:
    """Yield numbers of scenes and their outcomes as they come back."""
    todo = deque(_parts(range(len(scenes)), CHUNKS))
    with Errands[range, list[Outcome]](executor) as sent:
        while todo or sent:
            while todo:
                chunk = todo.popleft()
                sent.send(chunk, Errand(function, scenes[chunk.start : chunk.stop]))
            chunk, future = sent.receive()
            outcomes = _received(future, len(chunk))
            yield from zip(chunk, outcomes)
            rest = chunk[len(outcomes) :]
            # what takes long is spread further; of what failed as a whole the culprit is looked for
            todo.extend(_parts(rest, 2 if outcomes else len(rest)))


def _parts(whole: range, count: int) -> list[range]:
    """Cut a range into so many parts, of one number each where there are fewer."""
    size = max(1, -(-len(whole) // max(1, count)))
    return [whole[k : k + size] for k in range(0, len(whole), size)]


def _received(future: Future[list[Outcome]], sent: int) -> list[Outcome]:
    """Return the outcomes of a chunk, none where one of its scenes may be to blame."""
    from concurrent.futures import BrokenExecutor, CancelledError

    try:
        return future.result()
    except Exception as error:
        if sent > 1 and not isinstance(error, (BrokenExecutor, CancelledError)):
            return []
        return sent * [Outcome(None, Failure(error), np.nan)]


def _gathered(found: Mapping[int, Outcome], count: int, executor: Executor | None) -> Sweep[Any]:
    blank = Outcome(None, None, np.nan)
    outcomes = [found.get(k, blank) for k in range(count)]
    costs = [getattr(outcome.result, "cost", None) for outcome in outcomes]
    known = [cost for cost in costs if isinstance(cost, Cost)]
    return Sweep(
        tuple(outcome.result for outcome in outcomes),
        {k: one.failure.error for k, one in enumerate(outcomes) if one.failure is not None},
        np.array([outcome.seconds for outcome in outcomes]),
        Cost(
            "one after the other" if executor is None else type(executor).__name__,
            elements=sum(cost.elements for cost in known),
            unknowns=sum(cost.unknowns for cost in known),
            sweeps=sum(cost.sweeps for cost in known),
            factorisations=sum(cost.factorisations for cost in known),
            redone=float(np.mean([cost.redone for cost in known])) if known else 0.0,
        ),
    )


# --- the table ------------------------------------------------------------------------------------


def _cells(result: Any) -> dict[str, Any]:
    """Return the columns of a result."""
    named: Any = getattr(result, "value", None) if isinstance(result, Answer) else result
    if hasattr(named, "keys"):
        names = list(named.keys())
        return {str(name): _cell(named[name]) for name in names}
    row = isinstance(result, np.ndarray) and result.ndim == 1
    if row or isinstance(result, (list, tuple)):
        cells = [_cell(one) for one in result]
        if len(cells) <= WIDEST and all(isinstance(one, NUMBERS) for one in cells):
            return {f"result[{k}]": one for k, one in enumerate(cells)}
    return {"result": _cell(result)}


def _cell(value: Any) -> Any:
    if isinstance(value, np.generic):
        value = value.item()
    return value if value is None or isinstance(value, (*NUMBERS, str)) else type(value).__name__
