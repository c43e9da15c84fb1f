"""Fit of numbers of a scene to measured peaks whose modes are known."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...base.array import Flags, Index, Real
from ...base.computed import computed
from ...base.errors import SceneError, SolveError
from ...scene.scene import Scene
from ..fitting.minimum import BLIND, told_directions
from ..fitting.misfit import PeakMisfit, PriorMisfit, unseen_of
from ..fitting.natural_frequencies import NaturalFrequencies
from ..fitting.unknown import Unknowns
from ..orders.orders import RunnerUp
from .fit import Fit, alternatives_of
from .identified import found_by
from .notes import notes_of
from .solution import Solution, solve

LEAST = 0.1  # A number falls to no less than this part of itself in a step.
NEAR = 0.1  # Smaller relative changes need no further step.
STEPS = 8  # At most so many steps are taken.
SETTLED = 0.9  # A step that leaves more than this share of the sum of squares goes too far.
# What fell until frequencies hardly feel it goes back to where they do, at most to its guess.
UNFELT, BACK = 1e-4, 1e-2


@dataclass(frozen=True, eq=False)
class Identification:
    """Numbers of a scene that are sought by peaks."""

    calculated: NaturalFrequencies  # natural frequencies as functions of what is sought
    frequency: Real  # (k,) of the peaks [Hz]
    std: Real | None  # (k,) their standard deviations [Hz]
    orders: Index  # (k,) which mode each is, from 1; 0 where it is none
    prior: Mapping[str, tuple[float, float]]  # value and standard deviation of what is known
    runner_up: RunnerUp | None = None  # of the orders, where they were searched

    @property
    def unknowns(self) -> Unknowns:
        """What is sought."""
        return self.calculated.unknowns

    @computed
    def misfit(self) -> PeakMisfit:
        """Differences in units of their standard deviations; relative ones where there are none."""
        weight = self.frequency if self.std is None else self.std
        return PeakMisfit(self.calculated, self.frequency, weight, self.orders)

    @property
    def known(self) -> PriorMisfit | None:
        """What is known of the unknown beforehand."""
        return PriorMisfit.of(self.unknowns, self.prior)

    def instead(self, scene: Scene) -> Fit:
        """Fit another scene to the same."""
        unknowns = Unknowns.of(scene, self.unknowns.paths)
        calculated = dataclasses.replace(self.calculated, unknowns=unknowns)
        return dataclasses.replace(self, calculated=calculated, runner_up=None).fit()

    def fit(self) -> Fit:
        """Solve."""
        began = time.perf_counter()
        self._refuse_few()
        start = start_of_peaks(self.misfit, np.zeros(len(self.unknowns)))
        self._refuse_unseen(start)
        solution = solve(
            self.unknowns,
            self.misfit,
            start,
            rows=len(self.frequency),
            known=self.known,
            noise=None if self.std is None else 1.0,
        )
        return self._answer(solution, time.perf_counter() - began)

    def _answer(self, solution: Solution, seconds: float) -> Fit:
        minimum = solution.minimum
        off = minimum.residual[: solution.rows]
        frequency = self.frequency + off * self.misfit.weight
        found = Fit(
            orders=self.orders.astype(np.int64),
            measured=self.frequency,
            measured_std=solution.noise * self.misfit.weight,
            calculated=np.where(self.orders > 0, frequency, np.nan),
            runner_up=self.runner_up,
            notes=notes_of(solution),
            **found_by(
                solution,
                seconds=seconds,
                elements=self.calculated.elements,
                evaluations=minimum.evaluations,
            ),
        )
        source = partial(alternatives_of, found, self.unknowns.scene, self.instead)
        return dataclasses.replace(found, alternatives_source=source)

    def _refuse_few(self) -> None:
        peaks, prior = int((self.orders > 0).sum()), 0 if self.known is None else len(self.known.at)
        if peaks + prior < len(self.unknowns):
            raise SceneError(
                f"measured must have at least {len(self.unknowns) - prior} peaks for "
                f"{len(self.unknowns)} unknown and {prior} prior values, got {peaks}"
            )

    def _refuse_unseen(self, u: Real) -> None:
        """Refuse numbers that no peak depends on, unless they are known beforehand."""
        for i in unseen_of(self.misfit(u)[1], self.known):
            raise SceneError(
                f"unknown[{i}] must change the natural frequencies of these peaks, got "
                f"{self.unknowns.paths[i]!r}, which does not"
            )


def start_of_peaks(misfit: PeakMisfit, u: Real) -> Real:
    """Return variables at which frequencies are near the measured ones."""
    # with frozen shapes, exact for pinned ropes, u^T K u = lambda u^T M u is linear in p:
    # sum dp dlambda/dp (lambda*/lambda of inertia) = lambda* - lambda, lambda* measured
    best, least, felt = u, np.inf, np.zeros((1, len(u)))
    for _ in range(STEPS):
        try:
            frequency, slope = misfit.of_peaks(u)
        except (SceneError, SolveError):
            if np.isinf(least):
                raise
            break
        used = misfit.orders > 0
        ratio = (frequency / misfit.measured)[used] ** 2
        off = float(np.sum(np.log(ratio) ** 2))
        if off >= least:
            break
        best, settled, least = u, off > SETTLED * least, off
        felt = slope / frequency[:, None]
        if settled:
            break
        unknowns = misfit.calculated.unknowns
        relative = 2 * (slope / frequency[:, None])[used]
        inertia = relative.sum(axis=0) * unknowns.start < 0
        matrix = np.where(inertia, relative, relative * ratio[:, None])
        change = _step(matrix, 1 - ratio, unknowns.by_factor)
        if np.abs(change).max() < NEAR:
            break
        u = u + np.log1p(change)
    directions = told_directions(felt)
    if 0 < directions.shape[1] < len(u):
        return directions @ (directions.T @ best)
    share = np.maximum(np.linalg.norm(felt, axis=0), np.finfo(float).tiny)
    back = np.clip(np.log(BACK / share), 0.0, np.maximum(-best, 0.0))
    return best + np.where(share < UNFELT, back, 0.0)


def _step(matrix: Real, target: Real, movable: Flags) -> Real:
    """Solve matrix change = target by least squares, none below its least, some not at all."""
    change = np.zeros(len(movable))
    free = movable.copy()
    while free.any():
        rest = target - matrix[:, ~free] @ change[~free]
        change[free] = np.linalg.lstsq(matrix[:, free], rest, rcond=BLIND)[0]
        low = free & (change < LEAST - 1)
        if not low.any():
            break
        change[low] = LEAST - 1
        free &= ~low
    return change
