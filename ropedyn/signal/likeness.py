"""Shapes of modes that responses show, and how alike shapes and responses are: MAC and FRAC."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..base.array import Complex, Real
from ..base.unit import QUANTITIES

BROAD = 3.0
"""Half widths of a peak, damping ratio times frequency, on each side that a mode is fitted to."""
FEWEST = 3  # So many lines at least are fitted: a mode and what all others add are two numbers.


def residues(
    frequency: Real,
    value: Complex,
    quantity: str,
    peak: Real,
    damping_ratio: Real,
    *,
    decay: float = 0.0,
) -> Complex:
    """Return what each response shows of the mode of each peak: its shape there."""
    # around a peak receptances are A/(w0^2 + s^2 + 2 zeta w0 s) + R, s = i w + decay, with the same
    # pole for all responses, and A in proportion to the shape; R is what other modes add. Both
    # follow by least squares from the lines within three half widths, and not beyond the middle to
    # another peak
    s = 2j * np.pi * frequency + decay
    receptance = value / s ** QUANTITIES[quantity]
    found = np.empty((len(peak), len(value)), dtype=np.complex128)
    for k, (f0, ratio) in enumerate(zip(peak.tolist(), damping_ratio.tolist())):
        lines = _around(frequency, f0, BROAD * abs(ratio) * f0, np.delete(peak, k))
        p, w0 = s[lines], 2 * np.pi * f0
        one = w0 * w0 / (w0 * w0 + p * p + 2 * ratio * w0 * p)
        parts = np.stack([one, np.ones_like(one)], axis=1)
        size = np.abs(parts).max(axis=0)
        solved = np.linalg.lstsq(parts / size, receptance[:, lines].T, rcond=None)[0]
        found[k] = solved[0] / size[0]
    return found


def _around(frequency: Real, peak: float, width: float, others: Real) -> Any:
    """Return the lines around a peak."""
    distance = np.abs(frequency - peak)
    nearest = np.abs(others - peak).min(initial=np.inf)
    reach = min(width, nearest / 2)
    # the nearest lines at least
    reach = max(reach, float(np.sort(distance)[: min(FEWEST, len(distance))][-1]))
    return np.flatnonzero(distance <= reach)


def mac(first: NDArray[Any], second: NDArray[Any]) -> Real:
    """Return the modal assurance criterion of each two shapes."""
    # |a^H b|^2/(a^H a b^H b): 1 where one shape is a multiple of the other, 0 where they are
    # orthogonal (Allemang and Brown, A correlation coefficient for modal vector analysis, 1st
    # International Modal Analysis Conference, 1982)
    a, b = _unit(first), _unit(second)
    return np.asarray(np.abs(a.conj() @ b.T) ** 2)


def frac(measured: Complex, calculated: Complex) -> Real:
    """Return the frequency response assurance criterion of each response."""
    # |sum Hm^* Hc|^2/(sum |Hm|^2 sum |Hc|^2) over all lines: 1 where one is a multiple of the other
    # (Heylen and Lammens, FRAC: a consistent way of comparing frequency response functions,
    # Conference on Identification in Engineering Systems, Swansea, 1996)
    a, b = _unit(measured), _unit(calculated)
    return np.asarray(np.abs((a.conj() * b).sum(axis=1)) ** 2)


def frac_over(measured: Complex, calculated: Complex, frequency: Real, band: float) -> Real:
    """Return `frac` of the lines in a band around each line."""
    first = np.searchsorted(frequency, frequency - band / 2)
    last = np.searchsorted(frequency, frequency + band / 2, side="right")
    edge = np.stack([first, last], axis=1).ravel()
    a, b = _unit(measured), _unit(calculated)

    def over(product: NDArray[Any]) -> NDArray[Any]:
        """Sum each band by itself: differences of running sums would lose small ones."""
        closed = np.append(product, np.zeros((len(product), 1)), axis=1)
        return np.asarray(np.add.reduceat(closed, edge, axis=1)[:, ::2])

    with np.errstate(invalid="ignore", divide="ignore"):
        size = over(np.abs(a) ** 2) * over(np.abs(b) ** 2)
        return np.asarray(np.abs(over(a.conj() * b)) ** 2 / size)


def _unit(rows: NDArray[Any]) -> NDArray[Any]:
    """Return each row divided by its length, without overflow; NaN where it is 0."""
    with np.errstate(invalid="ignore", divide="ignore"):
        scaled = rows / np.abs(rows).max(axis=-1, keepdims=True, initial=0.0)
        return np.asarray(scaled / np.linalg.norm(scaled, axis=-1, keepdims=True))
