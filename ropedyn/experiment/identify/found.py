"""What was identified of many ropes, and what each of them tells when it is asked."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Mapping
from concurrent.futures import Executor
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ...base.errors import RopedynError, SceneError, SolveError
from ...base.progress import Progress
from ...family.rows import Array, Means, Shared
from ...response.question import workers_of
from ...scene.path import with_values
from ...scene.scene import Scene
from ..fitting.minimum import Minimum
from ..fitting.natural_frequencies import NaturalFrequencies
from ..fitting.unknown import Unknowns
from .fit import Fit, alternatives_of
from .fit_peaks import Identification, Ropes
from .identified import found_by
from .notes import notes_of
from .solution import Solution

ROPES = 1024  # Sent together.
UNCONVERGED = "NotConverged"


class Options(NamedTuple):
    """How it is identified, checked; see `identify`."""

    paths: tuple[str, ...]
    orders: Any
    missing: int | None
    spurious: int
    prior: Mapping[str, tuple[float, float]]
    elements: int | None
    element: str | None


class Workers(NamedTuple):
    """Who shares ropes; see `identify`."""

    threads: int | None = 1
    executor: Executor | None = None
    progress: Progress = None


@dataclass(frozen=True, eq=False)
class Found:
    """What was identified of many ropes."""

    scene: Scene  # as it was given
    how: Options
    identification: Identification
    ropes: Ropes  # with the orders that were found
    solution: Solution  # of the ropes that have one
    runner_up: Array  # (n,) the second best orders or None
    reasons: Mapping[int, tuple[str, str]]  # kind of the error and its text, of the others
    seconds: float  # wall time of each

    def error(self, i: int) -> RopedynError:
        """Return why a rope has no solution."""
        kind, text = self.reasons[i]
        return SceneError(text) if kind == "SceneError" else SolveError(text)

    def fit(self, i: int) -> Fit | None:
        """Return what was found of a rope, None where that is nothing."""
        if i in self.reasons:
            return None
        (at,) = np.flatnonzero(self.solution.rows == i)
        ropes = self.ropes.take(np.array([i]))
        solution = dataclasses.replace(
            self.solution.take(np.array([at])),
            task=self.identification.task(ropes),
            rows=np.zeros(1, dtype=np.intp),
        )
        k = int(ropes.peaks[0])
        measured, weight, orders = ropes.measured[0, :k], ropes.weight[0, :k], ropes.orders[0, :k]
        frequency = measured + solution.minimum.residual[0, :k] * weight
        return Fit(
            orders=orders,
            measured=measured,
            measured_std=solution.noise[0] * weight,
            calculated=np.where(orders > 0, frequency, np.nan),
            runner_up=self.runner_up[i],
            notes=notes_of(solution),
            alternatives_source=partial(
                alternatives_of, self.scene, partial(instead, self.how, ropes)
            ),
            **found_by(
                solution,
                seconds=self.seconds,
                elements=self.how.elements,
                evaluations=int(solution.minimum.evaluations[0]),
            ),
        )


def find(
    scene: Scene,
    how: Options,
    ropes: Ropes,
    workers: Workers,
    refused: Mapping[int, SceneError],
) -> Found:
    """Identify ropes that a scene describes alike but for those refused; guesses are filled in."""
    began = time.perf_counter()
    tensed = scene
    if scene.mean_tension == 0 and "tension" in how.paths:
        # a string whose lowest peak is its first mode
        tensed = with_values(scene, {"tension": 1.0})
        inside = np.arange(ropes.measured.shape[1]) < ropes.peaks[:, None]
        wave = 2 * scene.rope.length * np.where(inside, ropes.measured, np.inf).min(axis=1)
        at = how.paths.index("tension")
        ropes.guess[:, at] = np.log(scene.rope.linear_density * wave**2)
    calculated = NaturalFrequencies.of(Unknowns.of(tensed, how.paths), how.elements, how.element)
    identification = Identification(
        calculated, how.prior, how.missing, how.spurious, always=how.orders is None
    )
    (n, k), p = ropes.measured.shape, len(how.paths)
    m = k + len(how.prior)
    shapes: list[tuple[tuple[int, ...], Any]] = [
        *(((n, *shape), float) for shape in ((p,), (m,), (m, p))),
        *(((n,), kind) for kind in (np.int64, float, float)),
        *(((n, p), int), ((n,), float), ((n, k), np.int64), ((n,), object)),
    ]
    blank = [np.zeros(shape, kind) for shape, kind in shapes]
    shared = Shared(ropes.packed(), workers_of(workers.threads), *workers[1:])
    reasons, _ = shared.fill(blank, [Means(identification.solve, ROPES)])
    failed = {row: (kind, text) for row, kind, text in reasons}
    failed |= {row: ("SceneError", str(error)) for row, error in refused.items()}
    rows = np.delete(np.arange(n), list(failed))
    u, residual, slope, evaluations, *statistics, orders, runner_up = blank
    ropes = ropes._replace(orders=orders)
    solution = Solution(
        task=identification.task(ropes),
        rows=np.arange(n),
        minimum=Minimum(u, residual, slope, evaluations, np.ones(n, dtype=bool)),
        **dict(zip(("noise", "freedom", "side", "weight"), statistics)),
    )
    return Found(
        scene=scene,
        how=how,
        identification=identification,
        ropes=ropes,
        solution=solution.take(rows) if failed else solution,
        runner_up=runner_up,
        reasons=failed,
        seconds=(time.perf_counter() - began) / max(n, 1),
    )


def instead(how: Options, ropes: Ropes, scene: Scene) -> Fit:
    """Fit another scene to the same peaks of one rope."""
    again = ropes._replace(guess=np.zeros_like(ropes.guess), searched=np.zeros(1, dtype=bool))
    found = find(scene, how, again, Workers(), {})
    fit = found.fit(0)
    if fit is None:
        raise found.error(0)
    return fit
