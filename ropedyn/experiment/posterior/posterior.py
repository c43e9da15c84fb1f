"""The posterior of a tension, with ends, mass and length that are not known exactly."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.answer import Cost
from ...base.array import Real
from ...base.computed import waited
from .answer import Posterior
from .budget import budget_of
from .ends_told import ends_told
from .mixture import quantile
from .ridge import Cloud, Ridge
from .space import TENSION, space_of
from .task import PosteriorTask
from .tempering import tempered
from .words import assumed, limit_shares, notes_of

POINTS, POINTS_ALONE = 1200, 150
"""Points of scenes in closed form, and of those that are solved one by one."""


@waited
def posterior(task: PosteriorTask) -> Posterior:
    """Say what peaks tell of a rope.

    Raises
    ------
    SceneError
        If the scene has no family, or something that is asked or known of it has no meaning.
    SolveError
        If no rope that was thought of beforehand can be solved.
    """
    rng = np.random.default_rng(task.seed)
    space = space_of(task)
    ridge = Ridge.of(task, space)
    found = tempered(ridge, POINTS if ridge.family.closed else POINTS_ALONE, rng)
    cloud = found.cloud
    sample, scale = ridge.numbers(cloud, task.unknown)
    best = cloud.take(np.array([int(np.argmax(cloud.likelihood))]))
    calculated = np.full(len(task.orders), np.nan)
    calculated[task.used] = ridge.frequency(best)[0]
    fit = _fit(task, cloud, best)
    reaches = limit_shares(space, cloud, task.unknown)
    return Posterior(
        unknown=tuple(task.unknown),
        sample=sample,
        scale=scale,
        sample_freedom=ridge.freedom,
        reaches=reaches,
        budget=_budget(task, ridge, cloud, sample, scale),
        orders=np.array(task.orders, dtype=np.int64),
        measured=np.array(task.frequency, dtype=float),
        calculated=calculated,
        chi_square=fit.chi_square,
        freedom=fit.freedom,
        probability=fit.probability,
        assumed=assumed(task, space),
        notes=notes_of(task, found, ridge, reaches, fit.probability),
        ends=ends_told(task, ridge, cloud, rng),
        cost=Cost("tempered points", 0, space.size),
    )


class _Explained(NamedTuple):
    """How well the likeliest point fits."""

    chi_square: float
    freedom: float
    probability: float


def _fit(task: PosteriorTask, cloud: Cloud, best: Cloud) -> _Explained:
    """Say what noise leaves of chi-square, and compare both where its size is given.

    What it exceeds its least value by on average is how many numbers the peaks tell (Spiegelhalter
    et al., J. R. Stat. Soc. B 64, p. 583), the tension not counted, which is always the best.
    """
    from scipy.special import chdtrc

    least, peaks = float(best.chi_square[0]), int(task.used.sum())
    widened = (task.freedom + least) / (task.freedom + peaks - 1)
    told = float(cloud.chi_square.mean() - least) / widened + (TENSION in task.unknown)
    freedom = max(peaks - told, 0.0)
    if task.std is None:
        return _Explained(np.nan, freedom, np.nan)
    # with less than half a degree of freedom nothing is left to be tested
    return _Explained(least, freedom, float(chdtrc(freedom, least)) if freedom > 0.5 else np.nan)


def _budget(
    task: PosteriorTask, ridge: Ridge, cloud: Cloud, sample: Real, scale: Real
) -> dict[str, float]:
    """Return that of the tension, or of the first number."""
    path = TENSION if TENSION in task.unknown else task.unknown[0]
    i = task.unknown.index(path)
    low, middle, high = (
        quantile(sample[:, i], scale[:, i], ridge.freedom, share) for share in (0.025, 0.5, 0.975)
    )
    peak, model = task.log_std
    part = float(np.mean(model**2 / (peak**2 + model**2)))
    half = abs((high - low) / (2 * middle))
    return budget_of(ridge, cloud, path, half=half, model=part)
