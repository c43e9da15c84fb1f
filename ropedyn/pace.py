"""How many steps: so many that their error is within the tolerance.

A run is marched with steps h and with steps h/m. The scheme is of second order, so that the error
of the finer one is their distance over m^2 - 1 (Richardson 1911); it tells how much finer the steps
must be, and the run with those is checked against the last one in the same way. What the errors of
all steps amount to at any time is seen as a whole, whether they add up or die away.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from .errors import SolveError
from .lumps import Lumps
from .passage import Passage, Walk
from .port import is_force, moving
from .tension import Tension
from .timeline import Timeline, timeline
from .transient import Run

Real = NDArray[np.float64]

TOLERANCE = 1e-4
"""Where neither tolerance nor step is given."""

LEAST = 64
"""Steps of a whole run."""

PER_PERIOD = 16
"""Steps in a period of what pushes."""

PER_BREAK = 8
"""Steps between two times where forces break."""

MOST_STEPS = 100_000_000
"""Of a run that is within a tolerance."""

MARGIN = 1.1
"""Steps are finer by this factor than the estimate says."""

FAR = 0.05
"""Where the error is larger than this, it says little about how fine steps must be."""

RESOLVED = 0.1
"""The shape of the whole rope must be known to this part of itself."""

NOTHING = 1e-6
"""Responses smaller than this part of the motion of any node count as so much."""


@dataclass(frozen=True, eq=False)
class Pace:
    """A run with enough steps.

    Attributes
    ----------
    passage : Passage
        The finest.
    error : ndarray, shape (responses, t)
        Estimated, of the steps.
    stages, factorisations : int
        Of all that were marched.
    """

    passage: Passage
    error: Real
    stages: int
    factorisations: int


def steps_of(run: Run, chains: list[Lumps]) -> Timeline:
    """Return the steps that are asked for, or those that a tolerance begins with."""
    functions = [f for lumps in chains for f in (*lumps.forces, *lumps.motions)]
    breaks = [at for f in functions for at in f.breaks]
    if run.step is not None:
        return timeline(run.time, run.snapshots, breaks, _constant(run.step))
    highest = max((f.highest for f in functions), default=0.0)
    tension = run.model.scene.tension
    if isinstance(tension, Tension):
        highest = max(highest, tension.frequency)
    span = float(run.time[-1] - run.time[0])
    most = min(span / LEAST, 1 / (PER_PERIOD * highest) if highest > 0 else math.inf)
    edges = np.array([run.time[0], *(b for b in breaks if run.time[0] < b < run.time[-1])])
    edges = np.append(np.unique(edges), run.time[-1])

    def between(begin: Real, end: Real) -> Real:
        at = np.searchsorted(edges, (begin + end) / 2) - 1
        return np.minimum(np.diff(edges)[at] / PER_BREAK, most)

    return timeline(run.time, run.snapshots, breaks, between)


def _constant(step: float) -> Callable[[Real, Real], Real]:
    return lambda begin, end: np.full(len(begin), step)


def within(run: Run, chains: list[Lumps], g: float) -> Pace:
    """March with finer and finer steps until their error is within the tolerance."""
    line = steps_of(run, chains)
    tolerance = TOLERANCE if run.tolerance is None else run.tolerance
    work = np.zeros(2, dtype=np.intp)
    factor, begin = 1, 0.0
    last: tuple[int, Passage] | None = None
    trend: list[tuple[int, float]] = []
    while True:
        fine = line.finer(factor)
        end = begin + (0.9 * (1 - begin) if last else 0.05)
        passage = Walk(run, chains, fine, g, (begin, end)).through()
        begin = end
        work += (passage.stages, passage.factorisations)
        error = np.full(passage.value.shape, np.inf)
        growth = 2.0
        if isinstance(passage.error, SolveError) and 4 * fine.steps <= MOST_STEPS // 100:
            growth, last = 4.0, None
        elif passage.error is not None:
            break
        elif last is not None:
            error = _distance(passage, last[1], factor / last[0], _order(trend))
            worst = _worst(run, passage, last[1], error)
            trend.append((factor, worst))
            if worst <= tolerance:
                break
            growth = _growth(worst, tolerance, _order(trend))
        if passage.error is None:
            last = (factor, passage)
        if growth * fine.steps > MOST_STEPS:
            passage.error = SolveError(
                f"tolerance {tolerance:g} needs more than {MOST_STEPS} steps: with {fine.steps} "
                f"the error is {trend[-1][1] if trend else math.inf:.3g}"
            )
            break
        factor *= math.ceil(growth)
    run.progress(1.0)
    return Pace(passage, error, int(work[0]), int(work[1]))


def _distance(fine: Passage, coarse: Passage, ratio: float, order: float) -> Real:
    """Return the error of the finer one."""
    return np.asarray(np.abs(fine.value - coarse.value) / (ratio**order - 1))


def _order(trend: list[tuple[int, float]]) -> float:
    """Return with which power of the step errors fell last, 1 to 2: laws that bend have less."""
    if len(trend) < 2:
        return 2.0
    (coarse, large), (fine, small) = trend[-2:]
    if not 0 < small < large < math.inf:
        return 1.0
    return min(max(math.log(large / small) / math.log(fine / coarse), 1.0), 2.0)


def _growth(worst: float, tolerance: float, order: float) -> float:
    """Return how much finer steps must be."""
    wanted = MARGIN * (worst / tolerance) ** (1 / order)
    return min(max(wanted, 2.0), 8.0 if worst > FAR else 64.0)


def _worst(run: Run, fine: Passage, coarse: Passage, error: Real) -> float:
    """Return the largest error of any response, relative to its largest value."""
    size = np.maximum(np.abs(fine.value).max(axis=1), _floor(run, fine))
    most = error.max(axis=1)
    relative = np.divide(most, size, out=np.zeros_like(most), where=most > 0)
    scale = fine.largest[0]
    apart = np.abs(fine.last - coarse.last).max(axis=0)
    shape = np.divide(apart, scale, out=np.zeros_like(apart), where=apart > 0)
    return max(float(relative.max()), FAR if shape.max() > RESOLVED else 0.0)


def _floor(run: Run, passage: Passage) -> Real:
    """Return what responses are to be known to, however small they are."""
    floor = np.zeros(len(run.responses))
    for k, response in enumerate(run.responses):
        if not is_force(response):
            u, v = passage.largest[:, run.model.coordinates.index(moving(response))]
            floor[k] = (u, v, v * v / u if u > 0 else 0.0)[run.order] * NOTHING
    return floor


def halved(run: Run, chains: list[Lumps], g: float) -> Passage:
    """March with half the steps that are asked for."""
    return Walk(run, chains, steps_of(run, chains).finer(2), g).through()


def silent(fraction: float) -> None:
    """Say nothing."""


def quiet(run: Run) -> Run:
    """Return a run that can be kept and pickled."""
    return replace(run, progress=silent)
