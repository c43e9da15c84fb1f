"""Natural frequencies of a tensed beam between rotational springs, from its boundary conditions."""

import numpy as np
from scipy.optimize import brentq


def frequencies(orders, *, tension, bending_stiffness, length, linear_density, springs):
    """Return natural frequencies [Hz] of modes from 1; springs [N m] may be 0 or infinite.

    In units of the length w = A sin kx + B cos kx + C exp(-qx) + D exp(-q(1 - x)) with
    q^2 = k^2 + xi^2 is 0 at both ends and has B w'' = kappa w' at the first and -kappa w' at the
    last: the determinant of these four is 0 for one k of mode n between n pi, both ends pinned, and
    (n + 1) pi.
    """
    xi = length * np.sqrt(tension / bending_stiffness)
    stiff = np.asarray(springs, dtype=float) * length / bending_stiffness
    found = []
    for n in np.asarray(orders).tolist():
        k = n * np.pi
        if stiff.any():
            edge = 1e-13 * k
            k = brentq(
                _determinant, k + edge, k + np.pi - edge, (xi, *stiff), xtol=1e-14, rtol=1e-15
            )
        wave = k * np.sqrt(k**2 + xi**2) / (2 * np.pi * length**2)
        found.append(wave * np.sqrt(bending_stiffness / linear_density))
    return np.array(found)


def _determinant(k, xi, first, last):
    q = np.sqrt(k**2 + xi**2)
    e, s, c = np.exp(-q), np.sin(k), np.cos(k)
    slope = np.array([[k, 0.0, -q, q * e], [k * c, -k * s, -q * e, q]])
    bend = np.array([[0.0, -k * k, q * q, q * q * e], [-k * k * s, -k * k * c, q * q * e, q * q]])
    held = np.array([[0.0, 1.0, 1.0, e], [s, c, e, 1.0]])
    ends = [_end(bend[0], slope[0], first, q), _end(bend[1], -slope[1], last, q)]
    return np.linalg.det(np.array([*held, *ends]))


def _end(bend, slope, stiffness, q):
    """Return bend - stiffness slope, of order 1."""
    if np.isinf(stiffness):
        return -slope / q
    return (bend - stiffness * slope) / (q * q + stiffness * q)
