"""Hard cases run on the spot: the digits that are kept, by ropedyn and by SciPy."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ...base import check
from ...base.answer import Answer, Cost, axes
from ...base.array import Flags, Real
from ...base.computed import waited
from ...base.errors import SceneError
from ...base.progress import Progress, reporter
from ...base.table import Table, numbers
from .case import Digits, hard_list
from .drawn import attack
from .peer import SPARSE, peer_of


@dataclass(frozen=True, eq=False)
class HardCases(Answer):
    """What is kept of cases that are hard to keep stable; made by `hard_cases`.

    Attributes
    ----------
    case : ndarray of str, shape (rows,)
        What it is; the hardest have most decades.
    hard : ndarray of str, shape (rows,)
        What makes it hard.
    decades : ndarray, shape (rows,)
        How far apart the scales are that meet in it, in powers of ten.
    promised : ndarray, shape (rows,)
        Right digits that are promised; NaN where no number is right and a refusal is promised.
    kept : ndarray, shape (rows,)
        Right digits of the worst number of the answer, at most 15.95, against values of 40 digits.
    stated : ndarray, shape (rows,)
        Digits that the answer's own bounds leave; NaN where it has none.
    passed : ndarray of bool, shape (rows,)
        Whether what is promised is kept and no bound is exceeded.
    refusal : ndarray of str, shape (rows,)
        What was said instead of an answer, or empty.
    seconds : ndarray, shape (rows,)
        Wall time from the scene to the answer [s].
    peer : ndarray of str, shape (rows,)
        The function of SciPy that was asked the same, or empty.
    peer_kept : ndarray, shape (rows,)
        Digits that it keeps, of chains the best of several numbers of elements; NaN without one.
    test : ndarray of str, shape (rows,)
        The test that covers the case.
    drawn : int
        How many random scenes were attacked.
    refused : int
        How many of them had no modes, or none that are certified, and said so.
    failures : tuple of str
        What failed in which random scene, with the scene.
    cost : Cost
        What it cost.

    Examples
    --------
    >>> import ropedyn as rd
    >>> table = rd.hard_cases(random=2, seed=1)
    >>> table.ok, table.drawn, table.failures
    (True, 2, ())
    """

    said = ("failures",)

    case: NDArray[np.str_] = field(metadata=axes("row"))
    hard: NDArray[np.str_] = field(metadata=axes("row"))
    decades: Real = field(metadata=axes("row"))
    promised: Real = field(metadata=axes("row"))
    kept: Real = field(metadata=axes("row"))
    stated: Real = field(metadata=axes("row"))
    passed: Flags = field(metadata=axes("row"))
    refusal: NDArray[np.str_] = field(metadata=axes("row"))
    seconds: Real = field(metadata=axes("row", unit="s"))
    peer: NDArray[np.str_] = field(metadata=axes("row"))
    peer_kept: Real = field(metadata=axes("row"))
    test: NDArray[np.str_] = field(metadata=axes("row"))
    drawn: int
    refused: int
    failures: tuple[str, ...]
    cost: Cost

    @property
    def ok(self) -> bool:
        """Whether every case keeps what it promises and no random scene failed."""
        return bool(self.passed.all()) and not self.failures

    @property
    def verdict(self) -> str:
        """What came out, in a few sentences."""
        good, rows = int(self.passed.sum()), len(self.case)
        lost = f" (not so: {'; '.join(self.case[~self.passed].tolist())})" if good < rows else ""
        asked = self.peer != ""
        half = int((self.peer_kept[asked] < self.kept[asked] / 2).sum())
        wrong = len(self.failures)
        of_random = (
            f" {self.drawn} random scenes: {wrong or 'no'} check{'s' * (wrong != 1)} failed, "
            f"{self.refused} had no certified answer and said so."
        )
        return (
            f"{good} of {rows} hard cases keep the digits they promise, and no bound they state is "
            f"exceeded{lost}. SciPy on assembled matrices, the best of {SPARSE[0]} to {SPARSE[-1]} "
            f"elements, keeps less than half of their digits in {half} of the {int(asked.sum())} "
            f"it can be asked.{of_random * (self.drawn > 0)}"
        )

    def table(self) -> Table:
        """Return one row for each case, those whose scales are closest first."""
        order = np.argsort(self.decades, kind="stable")
        columns = {
            "case": self.case,
            "decades": self.decades,
            "digits promised": numbers(self.promised),
            "kept": numbers(np.where(self.refusal == "", self.kept, np.nan).round(1)),
            "stated": numbers(self.stated.round(1)),
            "passed": np.where(self.passed, "yes", "no"),
            "time [s]": numbers(self.seconds.round(4)),
            "SciPy keeps": numbers(self.peer_kept.round(1)),
            "by": tuple(name or None for name in self.peer.tolist()),
            "hard because": self.hard,
            "test": self.test,
        }
        rows = {name: tuple(np.array(c, dtype=object)[order]) for name, c in columns.items()}
        return Table.of(self.verdict, rows)


@waited
def hard_cases(random: int = 0, seed: int | None = None, *, progress: Progress = None) -> HardCases:
    """Run cases that are hard to keep stable, and attack random hard scenes.

    Every case is held against a value of 40 digits that ships with the package, from closed forms
    or exact transfer matrices in mpmath, and put to SciPy where that has an answer within a second.

    Parameters
    ----------
    random : int
        How many random scenes to draw. Of each the counts are held against the modes, the answers
        of two ways of cutting it against each other, a response against its reciprocal, and the
        work of a force against the energy of the parts, all within the bounds that are stated.
    seed : int, optional
        Of the random scenes, which are the same for the same seed; must be given with `random`.
    progress : None, True or callable
        True prints, a callable takes, the fraction that is done.

    Returns
    -------
    HardCases

    Raises
    ------
    TypeError
        If an argument is of the wrong type.
    SceneError
        If a number is negative, or only one of `random` and `seed` is given.

    Examples
    --------
    >>> import ropedyn as rd
    >>> print(rd.hard_cases().verdict.split(",")[0])
    52 of 52 hard cases keep the digits they promise
    """
    check.count(random, "random", least=0, most=1_000_000)
    if (seed is None) != (random == 0):
        raise SceneError(f"seed must be given with random, got {seed!r} with random = {random}")
    if seed is not None:
        check.count(seed, "seed", least=0, most=2**63)
    report = reporter(progress)
    cases = hard_list()
    whole, kept, peers = len(cases) + random, [], []
    for case in cases:
        kept.append(case.run())
        peers.append(peer_of(case))
        report(len(kept) / whole)
    wrong: list[list[str] | None] = []
    for k in range(random):
        wrong.append(attack(seed or 0, k))
        report((len(cases) + len(wrong)) / whole)
    columns = dict(zip(Digits._fields, map(np.array, zip(*kept))))
    columns |= dict(zip(("peer", "peer_kept"), map(np.array, zip(*peers))))
    promised = [np.nan if case.digits is None else float(case.digits) for case in cases]
    return HardCases(
        case=np.array([case.name for case in cases]),
        hard=np.array([case.hard for case in cases]),
        decades=np.array([float(case.decades) for case in cases]),
        promised=np.array(promised),
        test=np.array([case.test for case in cases]),
        drawn=random,
        refused=wrong.count(None),
        failures=tuple(text for one in wrong for text in one or []),
        cost=Cost("trials", 0, 0),
        **columns,
    )
