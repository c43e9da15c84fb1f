"""Fits of parameters to peaks whose orders are assumed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Integer, Real
from .order_grid import Calculated, quotients_at
from .order_likelihood import Likelihood
from .rayleigh import Quotients

SETTLED = 0.02  # A fit ends when frequencies are off by less, in standard uncertainties.
ROUNDS = 8  # One fit takes so many calculations at most.
HOPELESS = 50.0  # A fit is given up when it is dearer than the second best by more.
STRIDE = 4.0  # A parameter changes by at most this factor at once.


@dataclass(frozen=True, eq=False)
class Tangent:
    """What was calculated at some parameters."""

    parameters: Real  # (p,)
    quotients: Quotients


@dataclass(frozen=True, eq=False)
class OrderFit:
    """The likeliest parameters for orders."""

    orders: Integer  # (k,)
    parameters: Real  # (p,)
    frequency: Real  # (m,) with these parameters [Hz]
    cost: float  # see `Likelihood`
    misfit: float  # see `Likelihood`
    tangent: Tangent  # what they were found from


class OrderFits:
    """Fits by their orders, each made once."""

    def __init__(
        self, likelihood: Likelihood, calculated: Calculated, limits: tuple[Real, Real]
    ) -> None:
        self.likelihood, self.calculated, self.limits = likelihood, calculated, limits
        self.count = len(likelihood.frequency) + likelihood.missing
        self.made: dict[bytes, OrderFit | None] = {}

    def ranked(self) -> list[OrderFit]:
        """Return those that were not given up, the likeliest first."""
        return sorted((one for one in self.made.values() if one), key=lambda one: one.cost)

    def settle(self, orders: Integer, parameters: Real) -> None:
        """Fit, number the peaks anew, and again until the numbers stay."""
        tangent = self._tangent(parameters)
        while tangent is not None and orders.tobytes() not in self.made:
            found = self.fit(orders, tangent)
            if found is None:
                return
            tangent = found.tangent
            anew, cost = self.likelihood.numbered(found.frequency[None], self.likelihood.sigma)
            if np.isfinite(cost[0]):
                orders = anew[0]

    def look_around(self) -> None:
        """Fit what differs least from the best, until that stays the best."""
        looked: set[bytes] = set()
        while ranked := self.ranked():
            best = ranked[0]
            key = best.orders.tobytes()
            if key in looked:
                return
            looked.add(key)
            for orders in self.likelihood.others(best.frequency, best.orders):
                if orders.tobytes() not in self.made:
                    self.fit(orders, best.tangent)

    def fit(self, orders: Integer, tangent: Tangent) -> OrderFit | None:
        """Fit parameters to peaks of these orders; None where that is given up."""
        self.made[orders.tobytes()] = found = self._fitted(orders, tangent)
        return found

    def _fitted(self, orders: Integer, tangent: Tangent) -> OrderFit | None:
        """Follow tangents until one is exact enough: their errors are of second order."""
        likelihood, real = self.likelihood, orders > 0
        second = self.ranked()[1].cost if len(self.ranked()) > 1 else np.inf
        for left in range(ROUNDS, 0, -1):
            parameters, quotients = tangent.parameters, tangent.quotients
            if len(quotients.frequency) < orders.max():
                return None
            ratio = self._ratio(orders, tangent)
            frequency = quotients.at(ratio)
            moved = np.abs(ratio**quotients.power - 1)
            change = (np.abs(quotients.share[orders[real] - 1]) * moved).sum(axis=-1) / 2
            error = np.zeros(len(orders))
            error[real] = change**2
            sigma = likelihood.coarser(error)
            cost = likelihood.cost(frequency, orders, sigma)
            if cost > second + HOPELESS:
                return None
            tight = SETTLED * likelihood.sigma
            if left == 1 or (error * likelihood.frequency <= tight).all():
                break
            following = self._tangent(parameters * ratio)
            if following is None:
                return None
            tangent = following
        cost = likelihood.cost(frequency, orders, likelihood.sigma)
        misfit = likelihood.misfit(frequency, orders)
        return OrderFit(orders, parameters * ratio, frequency, cost, misfit, tangent)

    def _ratio(self, orders: Integer, tangent: Tangent) -> Real:
        peaks, parameters = self.likelihood, tangent.parameters
        bounds = (
            np.maximum(self.limits[0] / parameters, 1 / STRIDE),
            np.minimum(self.limits[1] / parameters, STRIDE),
        )
        stay = np.ones(len(parameters)), STRIDE
        weight = peaks.frequency / peaks.sigma
        return tangent.quotients.fit(peaks.frequency, weight, orders, stay, bounds)

    def _tangent(self, parameters: Real) -> Tangent | None:
        quotients = quotients_at(self.calculated, parameters, self.count)
        return None if quotients is None else Tangent(parameters, quotients)
