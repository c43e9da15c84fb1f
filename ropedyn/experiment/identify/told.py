"""What the peaks of one rope tell if their orders are known: the part of a fit that computes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Integer, Real
from ...base.errors import SceneError
from ...curves.peaks import Peaks
from ...scene.path import with_values
from ...scene.scene import Scene
from ..posterior.posterior import Posterior, PosteriorTask, posterior
from .fit_peaks import Options
from .known import METHODS, Known, Solved, intervals
from .notes import notes_of
from .solution import Solution


@dataclass(frozen=True, eq=False)
class Told:
    """Numbers of one rope under one numbering, and all that is said about them."""

    known: Known
    value: Real  # (p,)
    std: Real  # (p,) NaN where an interval has no two sides alike
    correlation: Real  # (p, p)
    calculated: Real  # (k,) [Hz] NaN of peaks that are no mode
    residual: Real  # (k,) [Hz] calculated less measured
    measured_std: Real  # (k,) [Hz]
    freedom: float | None  # the noise was estimated with; None where it is as given
    chi_square: float
    probability: float  # of chance alone to be off by as much; NaN where the noise was estimated
    budget: dict[str, float]  # relative half-widths of 95 % by cause
    ends: tuple[str, ...]  # what the peaks say of the ends
    assumed: tuple[str, ...]
    notes: tuple[str, ...]
    method: str
    evaluations: int


def by_least_squares(
    solution: Solution, how: Options, measured: Real, weight: Real, orders: Integer
) -> Told:
    """Return what the solution of one rope tells, the ends being given."""
    k, freedom = len(measured), float(solution.record["freedom"][0])
    calculated = measured + solution.record["residual"][0, :k] * weight
    square = float(solution.off[0] / solution.nominal[0] ** 2)
    return Told(
        known=Solved(solution),
        value=solution.value[0],
        std=solution.std[0],
        correlation=solution.uncertainty.correlation[0],
        calculated=np.where(orders > 0, calculated, np.nan),
        residual=calculated - measured,
        measured_std=solution.nominal[0] * weight,
        freedom=None if np.isnan(freedom) else freedom,
        chi_square=square,
        probability=_probability(solution, square, int((orders > 0).sum())),
        budget=_budget(solution),
        ends=(),
        assumed=assumed_of(how),
        notes=notes_of(solution),
        method="least squares",
        evaluations=int(solution.record["evaluations"][0]),
    )


def _probability(solution: Solution, square: float, peaks: int) -> float:
    """Return how often chance alone is off by as much."""
    from scipy.special import chdtrc

    freedom = peaks - len(solution.unknowns)
    given = not np.isnan(solution.task.noise[solution.rows[0]])
    return float(chdtrc(freedom, square)) if given and freedom > 0 else float("nan")


def _budget(solution: Solution) -> dict[str, float]:
    """Return the relative half-width of the first number, which peaks alone make."""
    low, high = intervals(solution, 0.95, "linear")[0, 0]
    value = abs(float(solution.value[0, 0]))
    return {"peaks": float((high - low) / (2 * value)) if 0 < value < np.inf else float("inf")}


def assumed_of(how: Options) -> tuple[str, ...]:
    """Return what was taken to be known, in words."""
    known = [f"{path} {value:g} +- {std:g}" for path, (value, std) in how.prior.items()]
    return (*known, *((f"model off by {how.model_std:g} of each frequency",) * bool(how.model_std)))


@dataclass(frozen=True, eq=False)
class Sampled:
    """The numbers of one rope by their posterior."""

    posterior: Posterior
    given: Scene  # whose numbers are replaced

    @property
    def scene(self) -> Scene:
        """Return the scene with the medians; its ends stay as they were given."""
        return with_values(self.given, dict(zip(self.posterior.unknown, self.posterior.value)))

    def interval(self, level: float, method: str) -> Real:
        """Return their intervals, shape (p, 2)."""
        if method != METHODS[0]:
            raise SceneError(f'method must be left out where ends are unknown, got "{method}"')
        return np.asarray(self.posterior.interval(level))


def by_posterior(peaks: Peaks, how: Options, orders: Integer, scene: Scene) -> Told:
    """Return what the posterior of one rope tells, the ends being unknown."""
    measured = np.asarray(peaks.frequency)
    found = posterior(
        PosteriorTask(
            scene,
            how.paths,
            measured,
            None if peaks.std is None else np.asarray(peaks.std),
            orders,
            how.prior,
            model_std=how.model_std,
            seed=how.seed,
        )
    )
    return Told(
        known=Sampled(found, scene),
        value=found.value,
        std=found.std,
        correlation=found.correlation,
        calculated=np.where(orders > 0, found.calculated, np.nan),
        residual=found.calculated - measured,
        measured_std=found.measured_std,
        freedom=found.freedom,
        chi_square=found.chi_square,
        probability=found.probability,
        budget=dict(found.budget),
        ends=found.ends_said,
        assumed=found.assumed,
        notes=found.notes,
        method="posterior",
        evaluations=found.evaluations,
    )
