"""What the peaks of one rope tell if their orders are known: the part of a fit that computes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Integer, Real
from ...base.errors import SceneError
from ...curves.peaks import Peaks
from ...scene.path import unit_of, with_values
from ...scene.scene import Scene
from ..fitting.outliers import outliers
from ..fitting.solution import Solution
from ..posterior.answer import Posterior
from ..posterior.posterior import posterior
from ..posterior.task import PosteriorTask
from .fit_peaks import Options
from .known import METHODS, Known, Solved, intervals
from .notes import notes_of

EXACT = 1e-12  # Of a frequency: what is less is rounding, of made peaks, and no deviation.
CAUSES = {"linear_density": "mass"}
"""Words of causes that are not the paths of the numbers."""


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
    fixity: tuple[Real, ...]  # of the ends, with the likelihood of each; nothing of given ones
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
    shown = solution.unknowns.shown
    return Told(
        known=Solved(solution),
        value=solution.value[0, :shown],
        std=solution.std[0, :shown],
        correlation=solution.uncertainty.correlation[0, :shown, :shown],
        calculated=np.where(orders > 0, calculated, np.nan),
        residual=calculated - measured,
        measured_std=solution.nominal[0] * weight,
        freedom=None if np.isnan(freedom) else freedom,
        chi_square=square,
        probability=_probability(solution, square, int((orders > 0).sum())),
        budget=_budget(solution),
        ends=(),
        fixity=(),
        assumed=assumed_of(how),
        notes=(*notes_of(solution), *_outliers(solution, measured, weight)),
        method="least squares",
        evaluations=int(solution.record["evaluations"][0]),
    )


def _probability(solution: Solution, square: float, peaks: int) -> float:
    """Return how often chance alone is off by as much."""
    from scipy.special import chdtrc

    freedom = peaks - solution.unknowns.shown
    given = not np.isnan(solution.task.noise[solution.rows[0]])
    return float(chdtrc(freedom, square)) if given and freedom > 0 else float("nan")


def _outliers(solution: Solution, measured: Real, weight: Real) -> list[str]:
    """Name peaks that are off what the others say by more than rounding."""
    record, given = solution.record, ~np.isnan(solution.task.noise[solution.rows])
    over = solution.nominal[:, None] if given[0] else np.ones((1, 1))
    residual, slope = record["residual"] / over, record["slope"] / over[:, :, None]
    if solution.side.any() or not np.isfinite(residual).all():
        return []
    off = np.abs(record["residual"][:, : len(measured)] * weight)
    residual[:, : len(measured)][off <= EXACT * measured] = 0.0
    found = outliers(residual, slope, given, peaks=len(measured))
    return [one.sentence(measured, solution.unknowns, solution.u[0]) for one in found]


def _budget(solution: Solution) -> dict[str, float]:
    """Return relative half-widths of 95 % of the first number, by what is not known beside it."""
    low, high = intervals(solution, 0.95, "linear")[0, 0]
    value, std = abs(float(solution.value[0, 0])), float(solution.std[0, 0])
    if not (0 < value < np.inf and 0 < std < np.inf):
        return {"peaks": float("inf")}
    half, shown = float(high - low) / (2 * value), solution.unknowns.shown
    # of a joint normal distribution: the share of the variance that a nuisance explains
    correlation = solution.uncertainty.correlation[0]
    shares = {
        CAUSES.get(path, path): float(correlation[0, shown + i] ** 2)
        for i, path in enumerate(solution.unknowns.paths[shown:])
    }
    left = max(1.0 - sum(shares.values()), 0.0)
    return {cause: half * share**0.5 for cause, share in {**shares, "peaks": left}.items()}


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


def by_posterior(how: Options, peaks: Peaks, orders: Integer, scene: Scene) -> Told:
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
            elements=how.elements,
            element=how.element,
        )
    )
    return Told(
        known=Sampled(found, scene),
        value=np.asarray(found.value),
        std=np.asarray(found.std),
        correlation=found.correlation,
        calculated=found.calculated,
        residual=found.calculated - measured,
        measured_std=_std_of_peaks(peaks, found),
        freedom=found.freedom if peaks.std is None else None,
        chi_square=found.chi_square,
        probability=found.probability,
        budget=dict(found.budget),
        ends=(found.ends.words(unit_of(how.paths[0])),),
        fixity=(found.ends.fixity, found.ends.likelihood),
        assumed=found.assumed,
        notes=found.notes,
        method="posterior",
        evaluations=found.cost.factorisations,
    )


def _std_of_peaks(peaks: Peaks, found: Posterior) -> Real:
    """Return the standard deviations of peaks, as residuals show them where they have none [Hz]."""
    measured = np.asarray(peaks.frequency)
    if peaks.std is not None:
        return np.asarray(peaks.std)
    off = (found.calculated / measured - 1)[found.orders > 0]
    return measured * float(np.sqrt(np.sum(off**2) / max(found.freedom, 1.0)))
