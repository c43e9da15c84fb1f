"""EA, D and C of a laid rope as numbers that a joint normal distribution may have.

Normal are ln EA, w = D/EA and ln(C - D^2/EA), so that no draw has EA C <= D^2. Of a normal y, and
x normal beside it, E[e^x y] = E[e^x] (E y + cov(x, y)): so all means and covariances of EA, D and C
are known of those, and the other way round, step by step.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.array import Flags, Real
from ...base.errors import SceneError

PATHS = ("axial_stiffness", "lay_coupling", "torsional_stiffness")
"""EA, D, C."""

LEAST = 1e-12  # Eigenvalues of correlations that are no larger are rounding of 0.


class Laid(NamedTuple):
    """Where EA, D and C are among numbers."""

    EA: int
    D: int
    C: int


def laid_numbers(plain: Real, at: Laid) -> Real:
    """Return EA, D, C of EA, D/EA, C - D^2/EA, in rows (n, p)."""
    rows = plain.copy()
    rows[:, at.D] = plain[:, at.D] * plain[:, at.EA]
    rows[:, at.C] = plain[:, at.C] + plain[:, at.D] * rows[:, at.D]
    return rows


def plain_numbers(rows: Real, at: Laid) -> tuple[Real, Real]:
    """Return EA, D/EA, C - D^2/EA of EA, D, C, (n, p), and their slopes (n, p, p)."""
    EA, D = rows[:, at.EA], rows[:, at.D]
    plain, w = rows.copy(), D / EA
    plain[:, at.D] = w
    plain[:, at.C] = rows[:, at.C] - w * D
    slope = np.tile(np.eye(rows.shape[1]), (len(rows), 1, 1))
    slope[:, at.D, at.EA], slope[:, at.D, at.D] = -w / EA, 1 / EA
    slope[:, at.C, at.EA], slope[:, at.C, at.D] = w * w, -2 * w
    return plain, slope


def moments_of_laid(centre: Real, S: Real, by_log: Flags, at: Laid) -> tuple[Real, Real]:
    """Return mean and covariance of numbers by those of their normal variables.

    A number is a sum of e^(logs g) w^power, and so is a product of two.
    """
    unit = np.eye(len(centre)) * by_log
    sums = [[(unit[i], 0)] for i in range(len(centre))]
    sums[at.D] = [(unit[at.EA], 1)]
    sums[at.C] = [(unit[at.C], 0), (unit[at.EA], 2)]

    def expected(one: list[tuple[Real, int]], other: list[tuple[Real, int]]) -> float:
        total = 0.0
        for logs, power in [(a + b, m + n) for a, m in one for b, n in other]:
            mean = centre + S @ logs
            size = np.exp(logs @ (centre + mean) / 2)
            total += float(size * _power(mean[at.D], S[at.D, at.D], power))
        return total

    one = [(np.zeros(len(centre)), 0)]
    first = np.array([expected(a, one) for a in sums])
    second = np.array([[expected(a, b) for b in sums] for a in sums])
    return first, second - np.outer(first, first)


def _power(m: float, v: float, power: int) -> float:
    """Return the mean of a power of a normal number."""
    return (1.0, m, m * m + v, m**3 + 3 * m * v, m**4 + 6 * m * m * v + 3 * v * v)[power]


def told_of_laid(mean: Real, covariance: Real, by_log: Flags, at: Laid) -> tuple[Real, Real]:
    """Return mean and covariance of the normal variables by those of numbers."""
    others = np.array([i for i in range(len(mean)) if i not in (at.D, at.C)])
    if not by_log[others].all():
        raise SceneError(
            'distribution must be "log-normal" of what stands beside laid numbers, got "normal"'
        )
    R, S, centre = covariance + np.outer(mean, mean), np.zeros_like(covariance), np.zeros_like(mean)
    m = mean.copy()
    with np.errstate(invalid="ignore", divide="ignore"):
        S[np.ix_(others, others)] = np.log((R / np.outer(m, m))[np.ix_(others, others)])
        # w = D/EA, weighed by EA once and twice
        w1, w2 = m[at.D] / m[at.EA], R[at.EA, at.D] / R[at.EA, at.EA]
        S[at.D, at.D] = v = R[at.D, at.D] / R[at.EA, at.EA] - w2**2
        S[at.D, others] = R[at.D, others] / R[at.EA, others] - w1
        tilted = 2 * w1 - w2 + S[at.D, at.EA] + S[at.D, others]
        # c = C - D^2/EA
        m[at.C] -= m[at.EA] * _power(w1, v, 2)
        both = R[at.C, others] - R[at.EA, others] * (tilted**2 + v)
        S[at.C, others] = np.log(both / (m[at.C] * m[others]))
        size = float(both[others == at.EA][0])
        w_c = (R[at.C, at.D] - R[at.EA, at.EA] * _power(w2, v, 3)) / size
        S[at.C, at.D] = w_c - w1
        square = R[at.C, at.C] - 2 * size * _power(w_c, v, 2) - R[at.EA, at.EA] * _power(w2, v, 4)
        S[at.C, at.C] = np.log(square / m[at.C] ** 2)
        S[others, at.D], S[others, at.C] = S[at.D, others], S[at.C, others]
        S[at.D, at.C] = S[at.C, at.D]
        centre = np.log(m) - np.diagonal(S) / 2
        centre[at.D] = 2 * w1 - w2
    with np.errstate(invalid="ignore"):
        share = S / np.sqrt(np.outer(np.diagonal(S), np.diagonal(S)))
    if not (np.isfinite(share).all() and np.linalg.eigvalsh(share)[0] > LEAST):
        raise SceneError(
            "covariance must be one of which ln EA, D/EA and ln(C - D^2/EA) have one too, got that "
            f"of EA, D, C and others with the means {mean.tolist()}"
        )
    return centre, S
