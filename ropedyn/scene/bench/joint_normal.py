"""Joint normal distribution of numbers, of some by their logarithms."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ...base import check
from ...base.array import Flags, Real
from ...base.errors import SceneError
from .laid import Laid, laid_numbers, plain_numbers, told_of_laid

STRAIGHT = 1e-8  # Below this relative std a logarithm is a straight line.
EPS = 1e-14  # Eigenvalues of correlations that are no larger are rounding of 0.


class JointNormal(NamedTuple):
    """Of g, the logarithms of some numbers and the others themselves."""

    by_log: Flags  # (p,)
    centre: Real  # (p,) of g
    spread: Real  # (p, p) g = centre + spread z with z independent and of variance 1
    whiten: Real  # (p, p) z = whiten (g - centre)
    laid: Laid | None = None  # where EA, D and C are; then g has ln EA, D/EA and ln(C - D^2/EA)

    @classmethod
    def of(
        cls,
        mean: Real,
        std: Real,
        by_log: Flags,
        correlation: Real | None,
        laid: Laid | None = None,
    ) -> JointNormal:
        """Match what is given of the numbers; None: they are independent."""
        if laid is not None:
            known = np.diag(std**2) if correlation is None else correlation * np.outer(std, std)
            centre, S = told_of_laid(mean, known, by_log, laid)
            root: Any = np.linalg.cholesky(S)
            return cls(by_log, centre, root, np.asarray(np.linalg.inv(root)), laid)
        size = np.where(by_log, mean, 1.0)
        share = std / size
        # sqrt(ln(1 + share^2)) without overflow, and share itself where that is rounding
        curved = np.sqrt(np.logaddexp(0.0, 2 * np.log(share)))
        s = np.where(by_log & (share > STRAIGHT), curved, share)
        centre = np.where(by_log, np.log(size) - s**2 / 2, mean)
        of_g = (
            np.eye(len(s)) if correlation is None else _correlation(correlation, by_log, share, s)
        )
        factor = np.linalg.cholesky(of_g)
        return cls(by_log, centre, s[:, None] * factor, np.linalg.inv(factor) / s)

    @property
    def apart(self) -> JointNormal:
        """The same where each number, or its logarithm, is a variable: of laid ones to first order.

        d D = EA dw + D d ln EA, d C = (C - D^2/EA) d ln(C - D^2/EA) + 2 D dw + w D d ln EA
        """
        if self.laid is None:
            return self
        i, j, k = self.laid
        EA, w, free = np.exp(self.centre[i]), self.centre[j], np.exp(self.centre[k])
        D, C = w * EA, free + w * w * EA
        turn, centre = np.eye(len(self.centre)), self.centre.copy()
        turn[j, [i, j]] = D, EA
        turn[k, [i, j, k]] = w * D / C, 2 * D / C, free / C
        centre[j], centre[k] = D, np.log(C)
        half: Any = turn @ self.spread
        root: Any = np.linalg.cholesky(half @ half.T)
        return JointNormal(self.by_log, centre, root, np.asarray(np.linalg.inv(root)))

    def colour(self, z: Real) -> Real:
        """Return numbers of independent normal z, (n, p)."""
        g = self.centre + z @ self.spread.T
        rows = np.where(self.by_log, np.exp(np.where(self.by_log, g, 0.0)), g)
        return rows if self.laid is None else laid_numbers(rows, self.laid)

    def residual(self, rows: Real) -> tuple[Real, Real]:
        """Return z of numbers, (n, p), and its slopes (n, p, p); not finite where there is none."""
        with np.errstate(invalid="ignore", divide="ignore"):
            plain, by_plain = self._plain(rows)
            by_number = np.where(self.by_log, 1 / np.where(self.by_log, plain, 1.0), 1.0)
            z = (self._logarithms(plain) - self.centre) @ self.whiten.T
            slope = self.whiten * by_number[:, None, :]
        return z, slope if by_plain is None else slope @ by_plain

    def log_density(self, rows: Real) -> Real:
        """Return the logarithm of the density of numbers, (n,)."""
        with np.errstate(invalid="ignore", divide="ignore"):
            plain, by_plain = self._plain(rows)
        there = np.asarray((~self.by_log | (plain > 0)).all(axis=1))
        g = self._logarithms(np.where(there[:, None], plain, 1.0))
        z = (g - self.centre) @ self.whiten.T
        size = np.log(np.diagonal(self.whiten)).sum() - len(self.centre) * math.log(math.tau) / 2
        density = size - (z * z).sum(axis=1) / 2 - g[:, self.by_log].sum(axis=1)
        if by_plain is not None:
            # of D/EA by D
            density -= np.log(np.where(there, rows[:, self.laid[0]], 1.0))  # type: ignore[index]
        return np.where(there, density, -np.inf)

    def _plain(self, rows: Real) -> tuple[Real, Real | None]:
        """Return numbers each of which g has alone, and their slopes by numbers."""
        return (rows, None) if self.laid is None else plain_numbers(rows, self.laid)

    def _logarithms(self, rows: Real) -> Real:
        return np.where(self.by_log, np.log(np.where(self.by_log, rows, 1.0)), rows)


def _correlation(correlation: Real, by_log: Flags, share: Real, s: Real) -> Real:
    """Return that of g, whose standard deviations are s, of that of the numbers, (p, p)."""
    # of g_i = ln p_i: cov(p_i, p_j) = m_i m_j (exp S_ij - 1), with a normal p_j m_i S_ij
    both, covariance = np.outer(by_log, by_log), correlation * np.outer(share, share)
    with np.errstate(invalid="ignore", divide="ignore"):
        logarithm = np.log1p(np.where(both, covariance, 0.0))
    of_g: Real = np.where(both, logarithm, covariance) / np.outer(s, s)
    np.fill_diagonal(of_g, 1.0)
    if not (np.isfinite(of_g).all() and np.linalg.eigvalsh(of_g)[0] > EPS):
        raise SceneError(
            "covariance must be one that log-normal numbers can have, whose logarithms are "
            f"correlated by less than 1, got {check.shown(of_g.round(3).tolist())}: say "
            'distribution="normal"'
        )
    return of_g
