"""Which mode each peak is: the likeliest numbers that rise with frequency."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...base.array import Integer, Real


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

    def price_of_spurious(self, sigma: Real) -> Real:
        """Return the price of a peak that is no mode, shape (k,)."""
        return 2 * np.log(self.band[1] / (self.stray * np.sqrt(2 * np.pi) * sigma))

    def price_of_missing(self, calculated: Real) -> Real:
        """Return the prices of modes that no peak is, in the shape of their frequencies."""
        low, high = self.band
        within = (calculated >= low) & (calculated <= high)
        return np.where(within, -2 * np.log(self.overlooked), 0.0)

    def prices(self, calculated: Real, sigma: Real) -> tuple[Real, Real]:
        """Return prices of each peak as each mode, (..., k, m), and as none, (..., k).

        A peak that is a mode saves the price of that one missing.
        """
        z = (calculated[..., None, :] - self.frequency[:, None]) / sigma[:, None]
        seen = z * z - 2 * np.log1p(-self.overlooked)
        seen -= self.price_of_missing(calculated)[..., None, :]
        return seen, np.broadcast_to(self.price_of_spurious(sigma), seen.shape[:-1])

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
        """Return the likeliest orders that differ from these in each peak, shape (h, k).

        The next best is among them (Murty's ranking, Operations Research 16 (1968) 682).
        """
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
