"""How alike shapes and responses are: MAC and FRAC."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..base.array import Complex, Real


def mac(first: NDArray[Any], second: NDArray[Any]) -> Real:
    """Return the modal assurance criterion of each two shapes.

    |a^H b|^2/(a^H a b^H b): 1 where one shape is a multiple of the other, 0 where they are
    orthogonal (Allemang and Brown, A correlation coefficient for modal vector analysis, 1st
    International Modal Analysis Conference, 1982).
    """
    a, b = _unit(first), _unit(second)
    return np.asarray(np.abs(a.conj() @ b.T) ** 2)


def frac(measured: Complex, calculated: Complex) -> Real:
    """Return the frequency response assurance criterion of each response.

    |sum Hm^* Hc|^2/(sum |Hm|^2 sum |Hc|^2) over all lines: 1 where one is a multiple of the other
    (Heylen and Lammens, FRAC: a consistent way of comparing frequency response functions,
    Conference on Identification in Engineering Systems, Swansea, 1996).
    """
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
