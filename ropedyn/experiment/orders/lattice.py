"""Candidates: every peak as every mode at every point of a lattice of what is not known.

At a point ln f_n is known with its slopes. A peak that is taken for a mode moves the point along
one direction, a common factor of all that is stiff or the tension alone, exactly or to first
order; every other peak is then the nearest mode, within what the step of the lattice leaves open,
or none.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np

from ...base.array import Integer, Real
from .chances import EXCITED, Chances
from .standardised import Standardised

REACH = 3.3  # Standard deviations to either side.
STEP = 0.18  # Between points, of the logarithm of bending stiffness relative to the tension;
ALONG = 0.25  # of the tension, where frequencies do not scale with it.
CERTAIN = 0.1  # What is known to so much, relatively, has one point.
FEW = 1.2  # Any other number has three, so many standard deviations apart,
FIXITY = 4.0  # and so has ln c of springs at ends, both alike, where rows are cheap.
FARTHER = 0.6  # A point moves by at most so many steps where its slopes change.
COARSEST = 100.0
ROWS, ROWS_ALONE = 4000, 60  # Points at most: with rows in closed form, and one by one.
ANCHORS = 5  # Peaks that are taken for every mode; half of them, where there are more.
SKIPPED, CUT = -1.6, -10.0  # Of a mode that is not seen, and of all that are not: roughly.
GENEROUS = 2.0  # A peak is a mode before its rivals are known if it is not less likely by more.
RANKED = 6000  # Of the hypotheses so many are looked at for different orders.


class _Axes(NamedTuple):
    """Axes of a lattice."""

    offsets: list[Real]  # (points, p) of each axis
    width: Real  # (p,) standard deviations of what lies between points
    reach: float  # how far a point may move


@dataclass(frozen=True, eq=False)
class Lattice:
    """Points, and what is known of frequencies there."""

    point: Real  # (r, p)
    width: Real  # (p,) standard deviations of what lies between
    along: Real  # (p,) the direction
    reach: float  # how far a point may move along it
    log_frequency: Real  # (r, N)
    slope: Real  # (r, N, p)

    @classmethod
    def of(cls, standardised: Standardised, count: int) -> Lattice:
        """Choose points and calculate there."""
        common = standardised.common(count)
        along = np.eye(len(standardised))[standardised.lead] if common is None else common
        axes = _axes(standardised, common, ROWS if standardised.closed else ROWS_ALONE)
        point = np.array([np.sum(one, axis=0) for one in product(*axes.offsets)])
        log_frequency, slope = standardised(point, count)
        there = np.isfinite(log_frequency).any(axis=1)
        point, log_frequency, slope = point[there], log_frequency[there], slope[there]
        log_frequency = np.where(np.isfinite(log_frequency), log_frequency, np.inf)
        return cls(point, axes.width, along, axes.reach, log_frequency, np.nan_to_num(slope))

    def candidates(
        self, log_measured: Real, std: Real, chances: Chances, number: int
    ) -> tuple[Integer, Real]:
        """Return the likeliest different orders, (h, k), and where they were found, (h, p)."""
        row, mode, step = self._hypotheses(log_measured)
        rise = self.slope @ self.along
        at = self.log_frequency[row] + rise[row] * step[:, None]
        open_ = self._left_open(rise, row, mode)
        orders, score = nearest(at, open_, log_measured, std, chances)
        v = self.point[row] + step[:, None] * self.along
        score = score - 0.5 * np.einsum("hp,hp->h", v, v)
        ranked = np.argsort(-score, kind="stable")[:RANKED]
        ranked = ranked[(orders[ranked] > 0).sum(axis=1) > 1]
        _, first = np.unique(orders[ranked], axis=0, return_index=True)
        chosen = ranked[np.sort(first)[:number]]
        return orders[chosen], v[chosen]

    def _hypotheses(self, log_measured: Real) -> tuple[Integer, Integer, Real]:
        """Return point, mode and step of each way to take an anchor for a mode."""
        k = len(log_measured)
        anchors = np.unique(np.linspace(0, k - 1, min(k, max(ANCHORS, k // 2))).round().astype(int))
        rise = self.slope @ self.along
        with np.errstate(divide="ignore", invalid="ignore"):
            step = (log_measured[anchors] - self.log_frequency[:, :, None]) / rise[:, :, None]
        row, mode, anchor = np.nonzero(np.abs(step) <= self.reach)
        step = step[row, mode, anchor]
        v = self.point[row] + step[:, None] * self.along
        near = np.abs(v).max(axis=1) <= REACH + 1
        return row[near], mode[near], step[near]

    def _left_open(self, rise: Real, row: Integer, mode: Integer) -> Real:
        """Return variances of ln f, (h, N), that the step of the lattice leaves to each mode."""
        each, r = np.arange(len(row)), rise[row]
        share = r / r[each, mode][:, None]
        square = np.zeros_like(share)
        for i in np.flatnonzero(self.width):
            slope = self.slope[:, :, i] * self.width[i]
            own = slope[row]
            square += (own - share * own[each, mode][:, None]) ** 2
        return square


def nearest(
    at: Real, open_: Real, log_measured: Real, std: Real, chances: Chances
) -> tuple[Integer, Real]:
    """Return the nearest modes of peaks, each of one at most, (h, k), and about how likely."""
    h, k = len(at), len(log_measured)
    each = np.arange(h)
    orders, gain = np.zeros((h, k), dtype=np.int64), np.zeros((h, k))
    none = np.log(0.5 / chances.span)
    for j in range(k):
        n = np.abs(at - log_measured[j]).argmin(axis=1)
        square = std[j] ** 2 + open_[each, n]
        off = at[each, n] - log_measured[j]
        price = -0.5 * off**2 / square - 0.5 * np.log(2 * np.pi * square) + chances.of_mode[j, n]
        gain[:, j] = price - none
        orders[:, j] = np.where(gain[:, j] > -GENEROUS, n + 1, 0)
    orders = _without_rivals(orders, gain)
    used, highest = orders > 0, orders.max(axis=1, initial=0)
    score = np.where(used, gain, 0.0).sum(axis=1) + highest * np.log(EXCITED)
    return orders, score + np.maximum((highest - used.sum(axis=1)) * SKIPPED, CUT)


def _without_rivals(orders: Integer, gain: Real) -> Integer:
    """Leave a mode to the likeliest of the peaks that have its order: they are neighbours."""
    each, last, kept = np.arange(len(orders)), np.zeros(len(orders), dtype=np.intp), orders.copy()
    for j in range(1, orders.shape[1]):
        same = (kept[:, j] > 0) & (kept[each, last] == kept[:, j])
        better = gain[:, j] > gain[each, last]
        kept[same & ~better, j] = 0
        loser = same & better
        kept[loser, last[loser]] = 0
        last = np.where(kept[:, j] > 0, j, last)
    return kept


def _axes(standardised: Standardised, common: Real | None, most: int) -> _Axes:
    """Return axes of as many points as there may be, and how far a point may move."""
    coarser = 1.0
    while True:
        lines = [_line(standardised, common, i, coarser) for i in range(len(standardised))]
        spring, unit = standardised.spring, np.eye(len(standardised))
        offsets = [line[:, None] * unit[i] for i, (line, _) in enumerate(lines) if not spring[i]]
        if spring.any():
            # both ends alike
            offsets.append(sum(lines[i][0][:, None] * unit[i] for i in np.flatnonzero(spring)))
        if math.prod(map(len, offsets)) <= most or coarser > COARSEST:
            break
        coarser *= 1.3
    width, lead = np.array([width for _, width in lines]), standardised.lead
    if common is not None:
        return _Axes(offsets, width, (REACH + 1) * float(standardised.spread[lead]))
    # between its points, or about the only one, the tension is found by the slopes
    alone = len(lines[lead][0]) == 1
    reach = REACH + 1 if alone else FARTHER * math.sqrt(12) * float(width[lead])
    width[lead] = 0.0
    return _Axes(offsets, width, reach)


def _line(
    standardised: Standardised, common: Real | None, i: int, coarser: float
) -> tuple[Real, float]:
    """Return the points of a variable, and the standard deviation of what lies between."""
    spread, lead = standardised.spread, standardised.lead
    if common is not None and i == lead:
        return np.zeros(1), 0.0
    if standardised.spring[i]:
        step = FIXITY / spread[i]
        if not standardised.closed:
            return np.zeros(1), 3 * step / math.sqrt(12)
        return step * np.arange(-1.0, 2.0), step / math.sqrt(12)
    # the tension is left to the common factor, so that what is stiff varies relative to it
    relative = common is not None and bool(standardised.stiff[i])
    ratio = math.hypot(spread[i], spread[lead]) / spread[i] if relative else 1.0
    if ratio * spread[i] < CERTAIN:
        return np.zeros(1), 1.0
    if not standardised.main[i]:
        return FEW * ratio * np.arange(-1.0, 2.0), FEW * ratio / math.sqrt(12)
    step = coarser * (ALONG if i == lead else STEP) / spread[i]
    halves = math.ceil(REACH * ratio / step - 0.5)
    return step * np.arange(-halves, halves + 1), step / math.sqrt(12)
