"""Where to start the fit of peaks, by Rayleigh's quotient: many ropes side by side."""

from __future__ import annotations

import numpy as np

from ...base.array import Flags, Index, Integer, Real
from .minimum import BLIND, Directions, Point
from .misfit import PeakMisfit

LEAST = 0.1  # A number falls to no less than this part of itself in a step.
NEAR = 0.1  # Smaller relative changes need no further step.
STEPS = 8  # At most so many steps are taken.
SETTLED = 0.9  # A step that leaves more than this share of the sum of squares goes too far.
# What fell until frequencies hardly feel it goes back to where they do, at most to its guess.
UNFELT, BACK = 1e-4, 1e-2


def start_of_peaks(misfit: PeakMisfit, rows: Index, guess: Real) -> tuple[Point, Integer]:
    """Return where frequencies are near the measured ones, and how often they were computed.

    NaN of rows that have no frequencies at their guess.
    """
    unknowns, share = misfit.calculated.unknowns, misfit.weight / misfit.measured
    best = Point.of(misfit, rows, guess)
    evaluations = np.ones(len(rows), dtype=np.int64)
    here, u, least = best, guess.copy(), np.full(len(rows), np.inf)
    going = np.arange(len(rows))
    for step in range(STEPS):
        ratio, relative = _compared(here, share[rows[going]])
        off = np.einsum("nk,nk->n", np.log(ratio), np.log(ratio))
        better = (off < least[going]) & np.isfinite(relative.sum(axis=(1, 2)))
        more = better & ~(off > SETTLED * least[going])
        at = going[better]
        least[at] = off[better]
        if step:
            best.put(at, here.take(better))
        else:
            best = here.copy()
            best.residual[~better] = np.nan
        going, ratio, relative = going[more], ratio[more], relative[more]
        change = _frozen_step(ratio, 2 * relative, unknowns.start, unknowns.by_factor)
        far = ~(np.abs(change).max(axis=1, initial=0.0) < NEAR)
        going = going[far]
        if not len(going) or step == STEPS - 1:
            break
        u[going] += np.log1p(change[far])
        here = Point.of(misfit, rows[going], u[going])
        evaluations[going] += 1
    there = np.flatnonzero(np.isfinite(least))
    best, lost = best if len(there) == len(rows) else best.take(there), best
    moved = _moved(best, _compared(best, share[rows[there]])[1], guess[there])
    at = np.flatnonzero((moved != best.u).any(axis=1))
    if len(at):
        best = best.copy()
        best.put(at, Point.of(misfit, rows[there[at]], moved[at]))
        evaluations[there[at]] += 1
    if len(there) < len(rows):
        lost.put(there, best)
        best = lost
    return best, evaluations


def _compared(point: Point, share: Real) -> tuple[Real, Real]:
    """Return squares of calculated over measured frequencies, and d ln(frequency)/du."""
    over = 1 + point.residual * share
    with np.errstate(invalid="ignore"):
        return over**2, point.slope * (share / over)[:, :, None]


def _frozen_step(ratio: Real, relative: Real, start: Real, movable: Flags) -> Real:
    """Return the relative changes that peaks ask for while shapes stay, shape (n, p)."""
    # with frozen shapes, exact for pinned ropes, u^T K u = lambda u^T M u is linear in p:
    # sum dp dlambda/dp (lambda*/lambda of inertia) = lambda* - lambda, lambda* measured
    inertia = relative.sum(axis=1) * start < 0
    matrix = np.where(inertia[:, None, :], relative, relative * ratio[:, :, None])
    free = np.tile(movable, (len(ratio), 1))
    change, going = np.zeros(free.shape), np.arange(len(ratio))
    while len(going):
        # by least squares, none below its least, some not at all
        some, held = matrix[going], np.where(free[going], 0.0, change[going])
        told = Directions.of(some * free[going][:, None, :])
        along = told.along(1 - ratio[going] - np.einsum("nkp,np->nk", some, held))
        best = np.einsum("nqp,nq->np", told.direction, along * told.inverse)
        change[going] = np.where(free[going], best, held)
        low = free & (change < LEAST - 1)
        change[low], free[low] = LEAST - 1, False
        going = np.flatnonzero(low.any(axis=1))
    return change


def _moved(best: Point, felt: Real, guess: Real) -> Real:
    """Return variables that differ from the guess in what is told, and that peaks feel."""
    told, u = best.told.above(BLIND), best.u
    basis, count = told.basis(), (told.size > 0).sum(axis=1)
    held = guess + np.einsum("npq,nrq,nr->np", basis, basis, u - guess)
    share = np.maximum(np.linalg.norm(felt, axis=1), np.finfo(float).tiny)
    back = np.clip(np.log(BACK / share), 0.0, np.maximum(guess - u, 0.0))
    partly = (count > 0) & (count < u.shape[1])
    return np.where(partly[:, None], held, np.where(share < UNFELT, u + back, u))
