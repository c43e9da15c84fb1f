"""Natural frequencies of a tensed beam between rotational springs, by its 4 x 4 determinant.

B w'''' - T w'' = m omega^2 w, w = 0 and B w'' = +-kappa w' at the ends x = 0 and L. With
w = a cos kx + b sin kx + c exp(-qx) + d exp(-q(L - x)) and q^2 = k^2 + T/B the conditions are four
linear equations, and m omega^2 = B k^2 q^2. A spring lifts the mode n from pinned, k L = n pi, to
clamped, k L < (n + 1/2) pi + 0.02 (Young and Felgar, Tables of Characteristic Functions, 1949: the
first clamped mode of a beam has k L = 4.7300 = 1.5 pi + 0.0176): each mode has one root between.
"""

import numpy as np
from scipy.optimize import brentq

ABOVE = 0.02
"""How far the largest root of a clamped beam is beyond (n + 1/2) pi."""


def frequencies(count, *, length, density, tension, bending, springs):
    """The lowest natural frequencies [Hz]; springs of both ends from 0 to inf [N m]."""
    found = []
    for n in range(1, count + 1):
        low, high = n * np.pi, (n + 0.5) * np.pi + ABOVE
        args = length**2 * tension / bending, [kappa * length / bending for kappa in springs]
        k = low if springs == (0.0, 0.0) else brentq(_determinant, low, high, args, xtol=1e-11)
        found.append(k * np.sqrt(k * k + args[0]))
    return np.sqrt(bending / density) / length**2 * np.array(found) / (2 * np.pi)


def _determinant(k, ratio, springs):
    """The determinant over length 1, rows scaled to about 1."""
    q = np.sqrt(k * k + ratio)
    small, s, c = np.exp(-q), np.sin(k), np.cos(k)
    slope = np.array([[0, k, -q, q * small], [-k * s, k * c, -q * small, q]])
    bend = np.array(
        [[-k * k, 0, q * q, q * q * small], [-k * k * c, -k * k * s, q * q * small, q * q]]
    )
    rows = [[1, 0, 1, small], [c, s, small, 1]]
    for sign, kappa, w, m in zip((-1, 1), springs, slope, bend):
        rows.append(w / q if np.isinf(kappa) else (m + sign * kappa * w) / (q * (q + kappa)))
    return np.linalg.det(np.array(rows, dtype=float))
