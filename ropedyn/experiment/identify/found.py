"""Identify ropes whose orders and ends are said, side by side, by least squares."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np

from ...base.array import Flags, Integer, Real
from ...base.errors import RopedynError, SceneError, SolveError
from ...base.progress import Progress
from ...curves.peaks import Peaks
from ...family.rows import Means, Shared
from ...response.question import workers_of
from ...scene.scene import Scene
from ..fitting.solution import Solution, kind_of_solution
from .fit_peaks import Identification, Options, Ropes, kind_of_ropes
from .known import intervals
from .told import Told, by_least_squares

ROPES = 1024  # Sent together.

Reasons = Mapping[int, tuple[str, str]]
"""Kind of the error and its text, by the rope."""


@dataclass(frozen=True, eq=False)
class Found:
    """What was identified of many ropes."""

    identification: Identification
    ropes: Ropes
    solution: Solution  # of the ropes that have one
    reasons: Reasons  # of the others

    def error(self, i: int) -> RopedynError:
        """Return why a rope has no solution."""
        kind, text = self.reasons[i]
        return SceneError(text) if kind == "SceneError" else SolveError(text)

    def told(self, i: int) -> Told:
        """Return what was found of a rope that has a solution."""
        ropes, row, how = self.ropes[i : i + 1], np.zeros(1, np.intp), self.identification.how
        record = self.solution.record[self.solution.rows == i]
        solution = Solution(self.identification.task(ropes), row, record)
        k = ropes["peaks"][0]
        measured, weight, orders = (ropes[name][0, :k] for name in ("measured", "weight", "orders"))
        return by_least_squares(solution, how, measured, weight, orders)

    def interval(self, level: float, method: str) -> Real:
        """Return intervals of all ropes, NaN of those without a solution, shape (n, p, 2)."""
        bounds = np.full((len(self.ropes), len(self.identification.how.paths), 2), np.nan)
        bounds[self.solution.rows] = intervals(self.solution, level, method)[:, : bounds.shape[1]]
        return bounds


def find(
    scene: Scene,
    how: Options,
    measured: Sequence[Peaks],
    orders: Sequence[Integer],
    refused: Mapping[int, SceneError],
    *,
    threads: int | None = 1,
    executor: Executor | None = None,
    progress: Progress = None,
) -> Found:
    """Identify ropes that a scene describes alike, but those that are refused."""
    ropes = _rows(measured, orders, refused, how)
    identification = Identification.of(scene, how, ropes)
    n, k = ropes["measured"].shape
    p = len(identification.calculated.unknowns)
    record = np.zeros(n, kind_of_solution(k + len(how.prior), p))
    shared = Shared(ropes, workers_of(threads), executor, progress)
    failed, _ = shared.fill([record], [Means(identification.solve, ROPES)])
    reasons = {row: (kind, text) for row, kind, text in failed}
    reasons |= {i: ("SceneError", str(error)) for i, error in refused.items()}
    rows = np.delete(np.arange(n), list(reasons))
    return Found(
        identification=identification,
        ropes=ropes,
        solution=Solution(identification.task(ropes), rows, record[rows]),
        reasons=reasons,
    )


def by_peaks_alone(how: Options, peaks: Peaks, orders: Integer, scene: Scene) -> Told:
    """Return what least squares tell of one rope."""
    found = find(scene, how, [peaks], [orders], {})
    if found.reasons:
        raise found.error(0)
    return found.told(0)


def _rows(
    measured: Sequence[Peaks],
    orders: Sequence[Integer],
    refused: Mapping[int, SceneError],
    how: Options,
) -> Ropes:
    """Return what was measured as rows; a rope that is refused has no peak that is a mode."""
    count = np.array([np.size(one.frequency) for one in measured], dtype=np.int64)
    known = np.array([one.std is not None for one in measured], dtype=bool)
    inside = np.arange(count.max(initial=1)) < count[:, None]
    frequency = _filled(inside, [one.frequency for one in measured], 1.0)
    std = _filled(inside & known[:, None], [one.std for one in measured], 0.0)
    weight = np.where(inside & known[:, None], np.hypot(std, how.model_std * frequency), frequency)
    ropes = np.zeros(len(measured), kind_of_ropes(inside.shape[1], how.numbers))
    ropes["peaks"], ropes["measured"], ropes["weight"] = count, frequency, weight
    ropes["orders"] = _filled(inside, orders, 0).astype(np.int64)
    ropes["noise"] = np.where(known, 1.0, np.nan)
    none = list(refused)
    ropes["measured"][none], ropes["weight"][none], ropes["orders"][none] = 1.0, 1.0, 0
    return ropes


def _filled(where: Flags, rows: Sequence[object], fill: float) -> Real:
    """Return rows of different lengths, None among them, in an array."""
    filled = np.full(where.shape, fill)
    if where.any():
        filled[where] = np.concatenate([np.asarray(one) for one in rows if one is not None])
    return filled
