"""Fit of numbers of a scene to measured peaks whose modes are known."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial

import numpy as np

from ...base.answer import Cost
from ...base.array import Index, Real
from ...base.computed import computed
from ...base.errors import SceneError
from ...scene.scene import Scene
from ..fitting.misfit import PeakMisfit, PriorMisfit
from ..fitting.natural_frequencies import NaturalFrequencies
from ..fitting.unknown import Unknowns
from ..orders.orders import RunnerUp
from .alternative import alternatives_of
from .fit import Fit
from .notes import notes_of
from .peak_start import start_of_peaks
from .solution import Solution, solve


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
            unknown=self.unknowns.paths,
            value=solution.value,  # type: ignore[arg-type]
            std=solution.std,  # type: ignore[arg-type]
            correlation=solution.uncertainty.correlation,
            orders=self.orders.astype(np.int64),
            measured=self.frequency,
            measured_std=solution.noise * self.misfit.weight,
            calculated=np.where(self.orders > 0, frequency, np.nan),
            freedom=solution.freedom,
            chi_square=float(np.sum((off / solution.noise) ** 2)),
            runner_up=self.runner_up,
            notes=notes_of(solution),
            cost=Cost(
                seconds=seconds,
                method="least squares",
                elements=self.calculated.elements or 0,
                unknowns=len(self.unknowns),
                factorisations=minimum.evaluations,
            ),
            solution=solution,
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
        unseen = np.asarray(~self.misfit(u)[1].any(axis=0))
        for path, is_unseen, i in zip(self.unknowns.paths, unseen, range(len(unseen))):
            if is_unseen and path not in self.prior:
                raise SceneError(
                    f"unknown[{i}] must change the natural frequencies of these peaks, got "
                    f"{path!r}, which does not"
                )
