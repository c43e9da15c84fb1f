"""Starts for identification by Rayleigh's quotient: stiffness and inertia of frozen shapes."""

from __future__ import annotations

import numpy as np

from ...base.array import Flags, Real
from ...base.errors import SceneError, SolveError
from ..fitting.minimum import BLIND, told_directions
from ..fitting.misfit import PeakMisfit

LEAST = 0.1  # A number falls to no less than this part of itself in a step.
NEAR = 0.1  # Smaller relative changes need no further step.
STEPS = 8  # At most so many steps are taken.
SETTLED = 0.9  # Of the sum of squares before: what falls on without changing it much goes too far.
# What fell until frequencies hardly feel it goes back to where they do, at most to its guess.
UNFELT, BACK = 1e-4, 1e-2


def start_of_peaks(misfit: PeakMisfit, u: Real) -> Real:
    """Return variables at which frequencies are near the measured ones.

    With frozen shapes u^T K u = lambda u^T M u is linear in what stiffness and inertia are made of:
    sum dp dlambda/dp (lambda*/lambda of inertia) = lambda* - lambda, lambda* measured. Where shapes
    do not depend on p, as those of pinned ropes, one step is exact however far off the start is.
    """
    best, least, felt = u, np.inf, np.zeros((1, len(u)))
    for _ in range(STEPS):
        try:
            frequency, slope = misfit.of_peaks(u)
        except (SceneError, SolveError):
            if np.isinf(least):
                raise
            break
        used = misfit.orders > 0
        ratio = (frequency / misfit.measured)[used] ** 2
        off = float(np.sum(np.log(ratio) ** 2))
        if off >= least:
            break
        best, settled, least = u, off > SETTLED * least, off
        felt = slope / frequency[:, None]
        if settled:
            break
        unknowns = misfit.calculated.unknowns
        relative = 2 * (slope / frequency[:, None])[used]
        inertia = relative.sum(axis=0) * unknowns.start < 0
        matrix = np.where(inertia, relative, relative * ratio[:, None])
        change = _step(matrix, 1 - ratio, unknowns.by_factor)
        if np.abs(change).max() < NEAR:
            break
        u = u + np.log1p(change)
    directions = told_directions(felt)
    if 0 < directions.shape[1] < len(u):
        return directions @ (directions.T @ best)
    share = np.maximum(np.linalg.norm(felt, axis=0), np.finfo(float).tiny)
    back = np.clip(np.log(BACK / share), 0.0, np.maximum(-best, 0.0))
    return best + np.where(share < UNFELT, back, 0.0)


def _step(matrix: Real, target: Real, movable: Flags) -> Real:
    """Solve matrix change = target by least squares, none below its least, some not at all."""
    change = np.zeros(len(movable))
    free = movable.copy()
    while free.any():
        rest = target - matrix[:, ~free] @ change[~free]
        change[free] = np.linalg.lstsq(matrix[:, free], rest, rcond=BLIND)[0]
        low = free & (change < LEAST - 1)
        if not low.any():
            break
        change[low] = LEAST - 1
        free &= ~low
    return change
