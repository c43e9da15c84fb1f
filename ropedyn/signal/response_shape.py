"""Shapes of modes that measured or calculated responses show."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..base.array import Complex, Real
from ..base.unit import QUANTITIES

BROAD = 3.0
"""Half widths of a peak, damping ratio times frequency, on each side that a mode is fitted to."""

FEWEST = 3
"""Lines at least: a mode and what all others add are two numbers."""


def residues(
    frequency: Real, value: Complex, quantity: str, peak: Real, damping_ratio: Real
) -> Complex:
    """Return what each response shows of the mode of each peak: its shape there.

    Around a peak receptances are A/(w0^2 - w^2 + 2 i zeta w0 w) + R with the same pole for all
    responses, and A in proportion to the shape; R is what other modes add. Both follow by least
    squares from the lines within three half widths, and not beyond the middle to another peak.
    """
    omega = 2 * np.pi * frequency
    receptance = value / (1j * omega) ** QUANTITIES[quantity]
    found = np.empty((len(peak), len(value)), dtype=np.complex128)
    for k, (f0, ratio) in enumerate(zip(peak.tolist(), damping_ratio.tolist())):
        lines = _around(frequency, f0, BROAD * abs(ratio) * f0, np.delete(peak, k))
        w, w0 = omega[lines], 2 * np.pi * f0
        one = w0 * w0 / (w0 * w0 - w * w + 2j * ratio * w0 * w)
        parts = np.stack([one, np.ones_like(one)], axis=1)
        size = np.abs(parts).max(axis=0)
        found[k] = np.linalg.lstsq(parts / size, receptance[:, lines].T)[0][0] / size[0]
    return found


def _around(frequency: Real, peak: float, width: float, others: Real) -> Any:
    """Return the lines around a peak."""
    distance = np.abs(frequency - peak)
    nearest = np.abs(others - peak).min(initial=np.inf)
    reach = min(width, nearest / 2)
    # the nearest lines at least
    reach = max(reach, float(np.sort(distance)[: min(FEWEST, len(distance))][-1]))
    return np.flatnonzero(distance <= reach)
