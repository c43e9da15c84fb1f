"""Likelihood of orders of peaks, and fits of parameters to orders that are assumed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Integer, Real
from .order_grid import Calculated, Quotients, quotients_at

SETTLED = 0.02  # A fit ends when frequencies are off by less, in standard uncertainties.
ROUNDS = 8  # One fit takes so many calculations at most.
HOPELESS = 50.0  # A fit is given up when it is dearer than the second best by more.
STRIDE = 4.0  # A parameter changes by at most this factor at once.


@dataclass(frozen=True, eq=False)
class Likelihood:
    """How likely measured peaks are, in increasing order, if they are certain modes.

    -2 ln of the likelihood is, up to a constant, with z = (calculated - measured)/sigma the sum of

        z^2 - 2 ln(1 - q)                 for a peak that is a mode,
        -2 ln q                           for a mode of the band that no peak is,
        2 ln(W/(r sqrt(2 pi) sigma))      for a peak that is no mode: r of them from 0 to W.
    """

    frequency: Real  # (k,) [Hz]
    sigma: Real  # (k,) [Hz]
    band: tuple[float, float]  # where modes would have been seen [Hz]
    overlooked: float  # q, between 0 and 1
    stray: float  # r, positive
    missing: int  # at most so many modes below the highest one seen are
    spurious: int  # at most so many peaks are no modes

    def coarser(self, error: float | Real) -> Real:
        """Return sigma with a relative error of the calculation, shape (k,)."""
        return np.hypot(self.sigma, error * self.frequency)

    def price_of_missing(self, calculated: Real) -> Real:
        """Return the prices of modes that no peak is, in the shape of their frequencies."""
        low, high = self.band
        within = (calculated >= low) & (calculated <= high)
        return np.where(within, -2 * np.log(self.overlooked), 0.0)

    def prices(self, calculated: Real, sigma: Real) -> tuple[Real, Real]:
        """Return prices of peaks as modes less missing ones, (.., k, m), and as none, (.., k)."""
        z = (calculated[..., None, :] - self.frequency[:, None]) / sigma[:, None]
        seen = z * z - 2 * np.log1p(-self.overlooked)
        seen -= self.price_of_missing(calculated)[..., None, :]
        none = 2 * np.log(self.band[1] / (self.stray * np.sqrt(2 * np.pi) * sigma))
        return seen, np.broadcast_to(none, seen.shape[:-1])

    def cost(self, calculated: Real, orders: Integer, sigma: Real) -> float:
        """Return -2 ln of the likelihood, up to a constant, of peaks of these orders."""
        seen, none = self.prices(calculated, sigma)
        real = orders > 0
        price = seen[real, orders[real] - 1].sum() + none[~real].sum()
        return float(price + self.price_of_missing(calculated).sum())

    def misfit(self, calculated: Real, orders: Integer) -> float:
        """Return the sum of z^2."""
        real = orders > 0
        z = (calculated[orders[real] - 1] - self.frequency[real]) / self.sigma[real]
        return float(z @ z)

    def numbered(self, calculated: Real, sigma: Real) -> tuple[Integer, Real]:
        """Find the likeliest orders and their cost, shape (h, k) and (h,), of (h, m) calculated."""
        seen, none = self.prices(calculated, sigma)
        orders, cost = numbered(seen, none, self.missing, self.spurious)
        return orders, cost + self.price_of_missing(calculated).sum(axis=-1)

    def others(self, calculated: Real, orders: Integer) -> Integer:
        """Return the likeliest orders that differ in a peak, (h, k) (Murty, Oper. Res. 16, 682)."""
        seen, none = (
            np.repeat(one[None], len(orders), 0) for one in self.prices(calculated, self.sigma)
        )
        each, real = np.arange(len(orders)), orders > 0
        seen[each[real], each[real], orders[real] - 1] = np.inf
        none[each[~real], each[~real]] = np.inf
        found, cost = numbered(seen, none, self.missing, self.spurious)
        return found[np.isfinite(cost)]


def numbered(seen: Real, none: Real, missing: int, spurious: int) -> tuple[Integer, Real]:
    """Find the cheapest orders that increase, by dynamic programming.

    After i peaks, s of them no mode, and m modes skipped, the last seen is the mode i - s + m. The
    next peak is no mode, V(i+1, m, s+1) = V(i, m, s) + none(i), or the next mode after skipping
    some more, V(i+1, m', s) = min over m <= m' of V(i, m, s) + seen(i, i + 1 - s + m').
    """
    many, peaks, modes = seen.shape
    skipped = np.arange(missing + 1)
    V = np.full((peaks + 1, many, missing + 1, spurious + 1), np.inf)
    V[0, :, 0, 0] = 0.0
    for i in range(peaks):
        for s in range(min(spurious, i) + 1):
            mode = i - s + skipped
            there = mode < modes
            best = np.minimum.accumulate(V[i, :, :, s], axis=1)
            V[i + 1][:, there, s] = best[:, there] + seen[:, i, mode[there]]
        for s in range(1, spurious + 1):
            without = V[i, :, :, s - 1] + none[:, i, None]
            np.minimum(V[i + 1, :, :, s], without, out=V[i + 1, :, :, s])
    return _traced_back(V, none)


def _traced_back(V: Real, none: Real) -> tuple[Integer, Real]:
    peaks, many = len(V) - 1, V.shape[1]
    each = np.arange(many)
    last = V[-1].reshape(many, V.shape[2] * V.shape[3])
    end = last.argmin(axis=1)
    m, s = np.unravel_index(end, V.shape[2:])
    orders = np.zeros((many, peaks), dtype=np.int64)
    for i in range(peaks - 1, -1, -1):
        stray = (s > 0) & (V[i + 1, each, m, s] == V[i, each, m, s - 1] + none[:, i])
        orders[:, i] = np.where(stray, 0, i + 1 - s + m)
        before = np.where(np.arange(V.shape[2]) <= m[:, None], V[i, each, :, s], np.inf)
        m = np.where(stray, m, before.argmin(axis=1))
        s = s - stray
    return orders, last[each, end]


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
