"""Rows of numbers shared by threads or an executor: chunks go out, arrays come back."""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from concurrent.futures import Executor, Future, ThreadPoolExecutor
from contextlib import closing
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.answer import Answer, Cost
from ..base.array import Index, Real
from ..base.errors import RopedynError, SceneError, SolveError
from ..base.progress import Progress, reporter
from ..base.threads import Errands

Array = np.ndarray[Any, Any]

Reasons = tuple[tuple[int, str, str], ...]
"""Of each row that failed its number, the name of the error and its text."""


class Filled(NamedTuple):
    """What a chunk of rows has given; of rows that are neither there nor failed nothing is said."""

    at: Index
    """Rows that are answered."""
    arrays: tuple[Array, ...]
    """Of these rows, in their order."""
    failed: dict[int, tuple[str, str]]
    """Name of the error and its text, by the row."""


class Means(NamedTuple):
    """A way to solve rows, and how many at a time."""

    solve: Callable[[Any], Filled]
    size: int


def one_by_one(solve: Callable[[Real], tuple[Any, ...]], rows: Real) -> Filled:
    """Solve each row for itself; what refuses a row has not solved it."""
    answers: dict[int, tuple[Any, ...]] = {}
    failed: dict[int, tuple[str, str]] = {}
    for k, row in enumerate(rows):
        try:
            answers[k] = solve(row)
        except (RopedynError, ArithmeticError) as error:
            failed[k] = type(error).__name__, str(error)
    arrays = tuple(np.array(column) for column in zip(*answers.values()))
    return Filled(np.array(list(answers), dtype=np.intp), arrays, failed)


@dataclass(frozen=True, eq=False)
class RowsAnswer(Answer):
    """What the answers have in common that have a row for each case."""

    paths: tuple[str, ...]
    reasons: tuple[tuple[int, str, str], ...]
    cost: Cost

    @property
    def failed(self) -> dict[int, RopedynError]:
        """Why a row has no answer, by its number from 0."""
        kinds = {"SceneError": SceneError}
        return {row: kinds.get(kind, SolveError)(text) for row, kind, text in self.reasons}


@dataclass
class Shared:
    """Rows, and who works on them."""

    rows: Array
    threads: int
    executor: Executor | None
    progress: Progress

    def __post_init__(self) -> None:
        if self.executor is not None:
            what = "an executor such as ThreadPoolExecutor(), or client.get_executor() of Dask"
            check.instance(self.executor, "executor", Executor, what)
        self.report = reporter(self.progress)

    def fill(self, blank: Sequence[Array], stages: Sequence[Means]) -> tuple[Reasons, list[int]]:
        """Fill arrays by rows; each stage takes the rows that those before it left.

        Return why rows failed, and how many each stage answered.
        """
        rest: Index = np.arange(len(self.rows))
        reasons: dict[int, tuple[str, str]] = {}
        answered = []
        for stage in stages:
            answered.append(0)
            left = []
            with closing(self._solved(stage, rest)) as solved:
                for chunk, part in solved:
                    whole = len(part.at) == len(chunk)
                    for filled, some in zip(blank, part.arrays):
                        filled[chunk if whole else chunk[part.at]] = some
                    answered[-1] += len(part.at)
                    if not whole:
                        left.append(np.delete(chunk, [*part.at, *part.failed]))
                        reasons |= {int(chunk[k]): why for k, why in part.failed.items()}
                    self.report((sum(answered) + len(reasons)) / len(self.rows))
            rest = np.sort(np.concatenate(left)) if left else rest[:0]
        return tuple((row, *reasons[row]) for row in sorted(reasons)), answered

    def _solved(self, stage: Means, rows: Index) -> Generator[tuple[Index, Filled]]:
        chunks = [rows[k : k + stage.size] for k in range(0, len(rows), stage.size)]
        threads = min(self.threads, len(chunks))
        if self.executor is None and threads <= 1:
            for chunk in chunks:
                yield chunk, stage.solve(self.rows[chunk])
            return
        with Errands[Index, Filled](self.executor or ThreadPoolExecutor(threads)) as sent:
            try:
                for chunk in chunks:
                    sent.send(chunk, stage.solve, self.rows[chunk])
                while sent:
                    chunk, future = sent.receive()
                    yield chunk, self._received(future, len(chunk))
            finally:
                if sent.executor is not self.executor:
                    sent.executor.shutdown(wait=False, cancel_futures=True)

    def _received(self, future: Future[Filled], sent: int) -> Filled:
        """Return a part; rows that another's executor lost have failed."""
        from concurrent.futures import CancelledError

        if self.executor is None:
            return future.result()
        try:
            return future.result()
        except (Exception, CancelledError) as error:
            why = "SolveError", f"the executor lost this row: {error!r}"
            return Filled(np.arange(0), (), dict.fromkeys(range(sent), why))
