"""Rayleigh's quotients of calculated shapes: frequencies near parameters that were calculated."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]
Whole = NDArray[np.int64]

FIRM = 1e4
"""How much narrower the pull is that holds a ratio at its bound."""


@dataclass(frozen=True, eq=False)
class Quotients:
    """Quotients u^T K u/(u^T M u) with shapes u that stay, over ratios r of the parameters.

    A shape's share s_j = dln(f^2)/dln(p_j) of a stiffness is positive, of an inertia negative:

        f(r)^2/f(1)^2 = (1 + sum_stiff s_j (r_j - 1))/(1 + sum_inert |s_j| (r_j - 1)).

    First order for every parameter, and more: exact where shapes do not change, as along a common
    factor of all stiffnesses, or for the pinned rope. For r given f it is linear.

    Attributes
    ----------
    frequency : ndarray, shape (..., m)
        f(1) [Hz], positive.
    share : ndarray, shape (..., m, p)
    """

    frequency: Real
    share: Real

    @classmethod
    def of(cls, parameters: Real, frequency: Real, jacobian: Real) -> Quotients:
        """Take the derivatives of frequencies, shape (m, p), at parameters of shape (p,)."""
        return cls(frequency, 2 * parameters * jacobian / frequency[:, None])

    def take(self, which: NDArray[np.intp]) -> Quotients:
        """Return those of some of the calculated parameters."""
        return Quotients(self.frequency[which], self.share[which])

    def at(self, ratio: Real) -> Real:
        """Return frequencies at ratios of shape (..., p); infinite where the quotient has none."""
        change = ratio[..., None, :] - 1
        stiff = 1 + (np.maximum(self.share, 0) * change).sum(axis=-1)
        inert = 1 + (np.maximum(-self.share, 0) * change).sum(axis=-1)
        fit = (stiff > 0) & (inert > 0)
        quotient = np.divide(stiff, inert, out=np.full(fit.shape, np.inf), where=fit)
        return self.frequency * np.sqrt(quotient)

    def fit(
        self,
        measured: Real,
        weight: Real,
        orders: Whole,
        pull: tuple[Real, float],
        bounds: tuple[Real, Real],
    ) -> Real:
        """Return ratios whose frequencies are the measured ones, by weighted least squares.

        With stiff and inert as above f^2 inert(r) = f(1)^2 stiff(r) for each peak, in r linear.

        Parameters
        ----------
        measured : ndarray, shape (k,)
            [Hz].
        weight : ndarray, shape (..., k)
            1/relative standard uncertainty.
        orders : ndarray of int, shape (..., k)
            From 1; 0 where the peak is no mode.
        pull : tuple of ndarray of shape (..., p) and float
            Ratios expected beforehand, and their relative uncertainty: what peaks do not tell.
        bounds : tuple of ndarray, each broadcastable to shape (..., p)
            Lowest and highest ratios.
        """
        mode = np.maximum(orders - 1, 0)
        calculated = np.take_along_axis(self.frequency, mode, axis=-1)
        share = np.take_along_axis(self.share, mode[..., None], axis=-2)
        # f^2/f(1)^2, so that all is of the order of 1
        square = ((measured / calculated) ** 2)[..., None]
        scale = np.where(orders > 0, weight / 2, 0.0)[..., None] / square
        rows = scale * (np.maximum(share, 0) - square * np.maximum(-share, 0))
        right = scale[..., 0] * (square[..., 0] - 1) + rows.sum(axis=-1)
        centre, width = pull
        tight = 1 / (centre * width)
        ratio = _solved(rows, right, centre, tight)
        low, high = (np.broadcast_to(bound, ratio.shape) for bound in bounds)
        held = np.clip(ratio, low, high)
        if (held == ratio).all():
            return ratio
        # once more for the others, with those at a bound there
        firm = np.where(held == ratio, tight, FIRM * (tight + np.abs(rows).max(axis=-2)))
        ratio = _solved(rows, right, np.where(held == ratio, centre, held), firm)
        return np.clip(ratio, low, high)


def _solved(rows: Real, right: Real, centre: Real, tight: Real) -> Real:
    """Minimise |rows r - right|^2 + |tight (r - centre)|^2."""
    normal = np.einsum("...kp,...kq->...pq", rows, rows)
    normal += (tight**2)[..., None] * np.eye(rows.shape[-1])
    vector = np.einsum("...kp,...k->...p", rows, right) + tight**2 * centre
    return np.linalg.solve(normal, vector[..., None])[..., 0]
