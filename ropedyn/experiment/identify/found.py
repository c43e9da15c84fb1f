"""What was identified of many ropes, and what each of them tells when it is asked."""

from __future__ import annotations

import time
from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...base.errors import RopedynError, SceneError, SolveError
from ...base.progress import Progress
from ...family.rows import Means, Shared
from ...response.question import workers_of
from ...scene.scene import Scene
from .fit import Fit, alternatives_of
from .fit_peaks import Identification, Options, Ropes
from .identified import found_by
from .notes import notes_of
from .solution import Solution, kind_of_solution

ROPES = 1024  # Sent together.

Reasons = Mapping[int, tuple[str, str]]
"""Kind of the error and its text, by the rope."""


@dataclass(frozen=True, eq=False)
class Found:
    """What was identified of many ropes."""

    identification: Identification
    ropes: Ropes  # with the orders that were found
    solution: Solution  # of the ropes that have one
    reasons: Reasons  # of the others
    seconds: float  # wall time of each

    def error(self, i: int) -> RopedynError:
        """Return why a rope has no solution."""
        kind, text = self.reasons[i]
        return SceneError(text) if kind == "SceneError" else SolveError(text)

    def fit(self, i: int) -> Fit | None:
        """Return what was found of a rope, None where that is nothing."""
        if i in self.reasons:
            return None
        ropes, row, how = self.ropes[i : i + 1], np.zeros(1, np.intp), self.identification.how
        record = self.solution.record[self.solution.rows == i]
        solution = Solution(self.identification.task(ropes), row, record)
        k = ropes["peaks"][0]
        measured, weight, orders = (ropes[name][0, :k] for name in ("measured", "weight", "orders"))
        frequency = measured + record["residual"][0, :k] * weight
        other = partial(instead, how, ropes.copy())
        return Fit(
            orders=orders,
            measured=measured,
            measured_std=solution.noise[0] * weight,
            calculated=np.where(orders > 0, frequency, np.nan),
            runner_up=ropes["runner_up"][0],
            notes=notes_of(solution),
            alternatives_source=partial(alternatives_of, self.identification.scene, other),
            **found_by(
                solution,
                seconds=self.seconds,
                elements=how.elements,
                evaluations=int(record["evaluations"][0]),
            ),
        )


def find(
    scene: Scene,
    how: Options,
    ropes: Ropes,
    refused: Reasons,
    *,
    threads: int | None = 1,
    executor: Executor | None = None,
    progress: Progress = None,
) -> Found:
    """Identify ropes that a scene describes alike, but those that are refused."""
    began = time.perf_counter()
    identification = Identification.of(scene, how, ropes)
    (n, k), p = ropes["measured"].shape, len(how.paths)
    ropes, record = ropes.copy(), np.zeros(n, kind_of_solution(k + len(how.prior), p))
    shared = Shared(ropes.copy(), workers_of(threads), executor, progress)
    failed, _ = shared.fill([record, ropes], [Means(identification.solve, ROPES)])
    reasons = {**{row: (kind, text) for row, kind, text in failed}, **refused}
    rows = np.delete(np.arange(n), list(reasons))
    return Found(
        identification=identification,
        ropes=ropes,
        solution=Solution(identification.task(ropes), rows, record[rows]),
        reasons=reasons,
        seconds=(time.perf_counter() - began) / max(n, 1),
    )


def instead(how: Options, ropes: Ropes, scene: Scene) -> Fit:
    """Fit another scene to the same peaks of one rope."""
    ropes["guess"], ropes["searched"], ropes["runner_up"] = 0.0, False, None
    found = find(scene, how, ropes, {})
    fit = found.fit(0)
    if fit is None:
        raise found.error(0)
    return fit
