"""How many steps: so many that their error is within the tolerance.

A run is marched with steps h and with steps h/m. Where errors fall as h^p, that of the finer one is
their distance over m^p - 1 (Richardson 1911). It tells how much finer the steps must be, and the
run with those is checked against the last one in the same way. p is 2 of smooth motion that the
steps resolve, less where laws bend or fast motion is only just resolved: what two distances say,
and 1 as long as there is one. Runs far apart prove little: the last two must agree themselves, as
two do of which one has twice the steps of the other. What the errors of all steps amount to at any
time is seen as a whole, whether they add up or die away.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from ...base.array import Real
from ...base.errors import SolveError
from ...base.unit import UNIT
from ...chain.port import is_force, moving
from ...scene.force import is_sampled
from ...scene.tension import Tension
from ..request import Run
from .lumped import Lumps
from .run import Marching, Passage
from .timeline import Timeline, timeline

TOLERANCE = 1e-4  # Errors are within this where neither tolerance nor step is given.
LEAST = 64  # A whole run takes so many steps at least,
PER_PERIOD = 16  # a period of what pushes so many,
PER_BREAK = 8  # and so many lie between two times where forces break.
MOST_STEPS = 100_000_000  # A run within a tolerance takes so many steps at most.
AGREE = 1 / 3  # The finer run has this part of the distance of two runs as its error at least.
TIMES, AROUND = 1.5, 4
"""What two runs tell is the error so many times over, within so many times that are asked for."""
AIM = 2.5  # The next run is to have the tolerance over this as its error: twice its steps suffice.
ORDERS = (0.5, 2.0)  # Errors fall with such powers of the step: friction and contact slower.
FAR = 0.05  # Where the error is larger than this, it says little about how fine steps must be.
RESOLVED = 0.1  # The shape of the whole rope must be known to this part of itself.
NOTHING = 1e-6  # Responses smaller than this part of the motion of any node count as so much.
ROUNDING = 1e-9
"""They count as this part at least of the motion of other coordinates, of which what is 0 by
symmetry is the rounding."""


def steps_of(run: Run, chains: list[Lumps]) -> Timeline:
    """Return the steps that are asked for, or those that a tolerance begins with."""
    functions = [f for lumps in chains for f in (*lumps.forces, *lumps.motions)]
    breaks = [at for f in functions for at in f.breaks]
    stops = [*breaks, *_corners(run, chains)]
    if (step := run.step) is not None:
        at = run.time, run.snapshots
        return timeline(*at, stops, lambda begin, end: np.full(len(begin), step))
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

    return timeline(run.time, run.snapshots, stops, between)


def _corners(run: Run, chains: list[Lumps]) -> list[float]:
    """Return the times at which velocities jump of what follows samples at once."""
    followed = [
        force
        for lumps in chains
        for force in (*lumps.motions, *itertools.compress(lumps.forces, lumps.is_bare))
    ]
    return run.time[1:-1].tolist() if run.order and any(map(is_sampled, followed)) else []


def march_within(run: Run, chains: list[Lumps], g: float) -> Passage:
    """March with finer and finer steps until their error is within the tolerance."""
    line = steps_of(run, chains)
    tolerance = TOLERANCE if run.tolerance is None else run.tolerance
    work = np.zeros(2, dtype=np.intp)
    trend = Trend()
    factor, begin = 1, 0.0
    while True:
        fine = line.finer(factor)
        end = begin + (0.9 * (1 - begin) if trend.last else 0.05)
        passage = Marching(run, chains, fine, g, (begin, end)).through()
        begin = end
        work += (passage.stages, passage.factorisations)
        if isinstance(passage.error, SolveError) and fine.steps <= MOST_STEPS // 100:
            trend = Trend()
            factor *= 4
            continue
        if passage.error is not None:
            passage.step_error = np.full(passage.value.shape, np.inf)
            break
        passage.step_error, worst = trend.add(run, factor, passage)
        if worst <= tolerance:
            break
        growth = 2
        if math.isfinite(trend.error):
            wanted = math.ceil(math.sqrt(trend.error / (AIM * tolerance)))
            growth = min(max(wanted, 2), 8 if worst > FAR else 64)
        if growth * fine.steps > MOST_STEPS:
            passage.error = SolveError(
                f"tolerance {tolerance:g} needs more than {MOST_STEPS} steps: with {fine.steps} "
                f"the error is {worst:.3g}"
            )
            break
        factor *= growth
    run.progress(1.0)
    passage.stages, passage.factorisations = work.tolist()
    return passage


class Trend:
    """How the distances between runs with finer and finer steps fall."""

    def __init__(self) -> None:
        self.last: tuple[int, Passage] | None = None
        self.error = math.inf
        self._before: tuple[float, float] | None = None

    def add(self, run: Run, factor: int, passage: Passage) -> tuple[Real, float]:
        """Return the error of a finer run, and the largest relative to what is largest."""
        if self.last is None:
            self.last = (factor, passage)
            return np.full(passage.value.shape, np.inf), np.inf
        ratio, coarse = factor / self.last[0], self.last[1]
        self.last = (factor, passage)
        apart = np.abs(passage.value - coarse.value)
        size = np.maximum(np.abs(passage.value).max(axis=1), _floor(run, passage))
        most = apart.max(axis=1)
        distance = float(np.divide(most, size, out=np.zeros_like(most), where=most > 0).max())
        order, guess = 1.0, 2.0
        if self._before is not None:
            order = guess = _order(*self._before, ratio, distance)
        self._before = (ratio, distance)
        self.error = distance / (ratio**guess - 1)
        share = max(1 / (ratio**order - 1), AGREE)
        # both must have seen the same motion of the whole rope, however coarsely
        moved = np.abs(passage.last - coarse.last).max(axis=0)
        largest = np.maximum(passage.largest, NOTHING * _others(run, passage))[0]
        resolved = bool((moved <= RESOLVED * largest).all())
        worst = TIMES * distance * share
        return covering(apart * share), max(worst, 0.0 if resolved else FAR)


def covering(told: Real) -> Real:
    """Return what covers errors that two runs tell, also where runs cross, shape (responses, t)."""
    from scipy.ndimage import maximum_filter1d

    return np.asarray(TIMES * maximum_filter1d(told, 2 * AROUND + 1, axis=-1))


def _order(ratio: float, distance: float, next_ratio: float, next_distance: float) -> float:
    """Return p of errors C h^p from the distances of three runs, within `ORDERS`."""
    low, high = ORDERS

    def fall(p: float) -> float:
        return ratio**-p * (1 - next_ratio**-p) / (1 - ratio**-p)

    if next_distance >= fall(low) * distance:
        return low
    if next_distance <= fall(high) * distance:
        return high
    for _ in range(20):
        middle = (low + high) / 2
        falls = next_distance < fall(middle) * distance
        low, high = (middle, high) if falls else (low, middle)
    return low


def _floor(run: Run, passage: Passage) -> Real:
    """Return what responses are to be known to, however small they are."""
    floor = np.zeros(len(run.responses))
    size = np.maximum(NOTHING * passage.largest, ROUNDING * _others(run, passage))
    for k, response in enumerate(run.responses):
        if not is_force(response):
            at = run.model.coordinates.index(moving(response))
            (u, v), least = passage.largest[:, at], size[:, at]
            rate = v / u if run.order == 2 and u > 0 else 0.0
            floor[k] = (*least, rate * least[1])[run.order]
    return floor


def _others(run: Run, passage: Passage) -> Real:
    """Return the largest motion of what each coordinate moves with, shape (2, coordinates)."""
    model, size = run.model, np.zeros_like(passage.largest)
    for component in model.components:
        at = [model.coordinates.index(c) for c in component]
        # a rotation moves what is as far away as the rope is long
        arm = np.array([1.0 if UNIT[c] == "m" else model.scene.rope.length for c in component])
        most = (passage.largest[:, at] * arm).max(axis=1, keepdims=True)
        size[:, at] = most / arm
    return size


def march_given(run: Run, chains: list[Lumps], g: float, factor: int = 1) -> Passage:
    """March with the steps that are asked for, or with so many for each."""
    return Marching(run, chains, steps_of(run, chains).finer(factor), g).through()
