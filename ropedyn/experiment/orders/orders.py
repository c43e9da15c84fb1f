"""Which mode each peak is: as given, as the peaks say, or searched."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ...base import check
from ...base.array import Index, Real
from ...base.errors import SceneError, SolveError
from ...curves.peaks import Peaks
from ..fitting.minimum import BLIND
from ..fitting.natural_frequencies import NaturalFrequencies
from .order_search import OVERLOOKED, search

NOISE = 0.005  # Relative standard deviation of peaks that have none, to judge the lowest modes.


UNLIKELY = 0.05  # Noise alone exceeds what is accepted of the lowest modes so often.


class RunnerUp(NamedTuple):
    """The second best way to see peaks as modes."""

    orders: tuple[int, ...]  # of each peak from 1; 0 where it is no mode
    worse: float  # by how much chi-square is larger, with the price of what is missing or none


def given_orders(orders: Any, peaks: Peaks) -> Index | None:
    """Return the modes of the peaks where somebody says them, from 1, 0 where they are none."""
    k = np.size(peaks.frequency)
    what = f'"auto", None or {k} whole numbers, one for each peak, those from 1 different'
    if orders is None:
        return None
    if isinstance(orders, str):
        check.one_of(orders, "orders", ("auto",))
        return None if peaks.order is None else np.array(peaks.order, dtype=np.intp)
    check.instance(orders, "orders", (list, tuple, np.ndarray), what)
    most = np.iinfo(np.int32).max
    each = [check.count(n, f"orders[{i}]", least=0, most=most) for i, n in enumerate(orders)]
    modes = [n for n in each if n > 0]
    if len(each) != k or len(set(modes)) < len(modes) or not modes:
        raise SceneError(f"orders must be {what}, got {check.shown(orders)}")
    return np.array(each, dtype=np.intp)


def lowest_orders(frequency: Real) -> Index:
    """Return the lowest modes for peaks in any order, shape (..., k)."""
    return np.argsort(np.argsort(frequency, axis=-1, kind="stable"), axis=-1) + 1


@dataclass(frozen=True, eq=False)
class Factors:
    """Natural frequencies as functions of the factors by which some numbers leave a centre."""

    calculated: NaturalFrequencies  # as functions of the variables
    centre: Real  # (p,) of the variables
    which: Index  # (q,) the numbers; the others stay

    @classmethod
    def of(cls, calculated: NaturalFrequencies, centre: Real, count: int) -> Factors:
        """Choose numbers that the lowest modes tell apart, inertia last."""
        unknowns = calculated.unknowns
        frequency, slope = calculated.lowest(centre, count)
        relative = slope / frequency[:, None]
        inertia = relative.sum(axis=0) * unknowns.start < 0
        which: list[int] = []
        for i in np.argsort(inertia, kind="stable").tolist():
            if not unknowns.by_factor[i]:
                continue
            size = np.linalg.svd(relative[:, [*which, i]], compute_uv=False)
            if len(size) > len(which) and size[-1] > BLIND * size[0]:
                which.append(i)
        return cls(calculated, centre, np.array(which, dtype=np.intp))

    def __call__(self, factor: Real, count: int) -> tuple[Real, Real]:
        """Return the lowest frequencies, or all there are, and their derivatives."""
        u = self.centre.copy()
        u[self.which] += np.log(factor)
        frequency, slope = self.calculated.lowest(u, count)
        return frequency, slope[:, self.which] / factor


def lowest_suffice(residual: Real, frequency: Real, std: Real | None, freedom: int) -> bool:
    """Say whether the lowest modes explain the peaks as well as noise or a missing mode allow."""
    from scipy.special import chdtri

    off = residual / (NOISE * frequency if std is None else std)
    limit = -2 * float(np.log(OVERLOOKED))
    if std is not None and freedom > 0:
        limit = max(limit, float(chdtri(freedom, UNLIKELY)))
    return bool(off @ off <= limit)


def found_orders(
    calculated: NaturalFrequencies,
    centres: Sequence[Real],
    frequency: Real,
    std: Real | None,
    *,
    missing: int | None,
    spurious: int,
) -> tuple[Index, RunnerUp | None]:
    """Search the modes of the peaks."""
    ranked: dict[tuple[int, ...], float] = {}
    failure: SolveError | None = None
    about = [Factors.of(calculated, centre, len(frequency)) for centre in centres]
    most = max(len(factors.which) for factors in about)
    for factors in about:
        # likelihoods of fewer numbers do not compare: a stiffness at 0 is none
        if len(factors.which) < max(1, most):
            continue
        try:
            found = search(
                frequency,
                std,
                factors,
                np.ones(len(factors.which)),
                missing=missing,
                spurious=spurious,
            )
        except SolveError as error:
            failure = error
            continue
        for one in found:
            orders = tuple(one.orders.tolist())
            ranked[orders] = min(one.cost, ranked.get(orders, np.inf))
    if not ranked:
        if failure is not None:
            raise failure
        return lowest_orders(frequency), None
    best, *others = sorted(ranked, key=ranked.__getitem__)
    second = RunnerUp(others[0], float(ranked[others[0]] - ranked[best])) if others else None
    return np.array(best, dtype=np.intp), second
