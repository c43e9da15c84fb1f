"""Steady motion in what moves over time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import check
from ..base.array import Complex
from ..base.errors import SceneError

if TYPE_CHECKING:
    from ..motion.history import History


def amplitude(history: History, frequency: Any, last: float | None) -> Complex:
    """Fit steady motion; see `History.amplitude`."""
    given = check.frequencies(frequency)
    time = history.time
    if last is not None:
        first = time[-1] - check.number(last, "last", "s", sign="positive")
        time = time[time >= first]
    if len(np.unique(given)) < len(given) or (given == 0).any():
        raise SceneError(f"frequency must be different numbers > 0, got {check.shown(frequency)}")
    n, unknowns = len(time), 2 * len(given) + 2
    if n < unknowns:
        raise SceneError(f"last must hold {unknowns} times at least, got {n}")
    rate = (n - 1) / (time[-1] - time[0])
    if given.max() >= rate / 2:
        raise SceneError(
            f"frequency must be below half the rate of the times, {rate / 2:g} Hz, got "
            f"{float(given.max())!r}"
        )
    turn = np.exp(2j * np.pi * np.outer(time, given))
    # Re(value turn) = value' turn' - value'' turn''; what stands still, what drifts
    drift = np.linspace(-1, 1, n) if n == 1 else 2 * (time - time[0]) / (time[-1] - time[0]) - 1
    basis = np.column_stack([turn.real, -turn.imag, np.ones(n), drift])
    found, _, rank, _ = np.linalg.lstsq(basis, history.value[:, -n:].T, rcond=1e-9)
    if rank < unknowns:
        raise SceneError(
            f"last must be long enough to tell {check.shown(frequency)} Hz from what stands still "
            f"or drifts, got {float(time[-1] - time[0]):g} s"
        )
    k = len(given)
    value = (found[:k] + 1j * found[k : 2 * k]).T
    return value if np.ndim(frequency) else value[:, 0]
