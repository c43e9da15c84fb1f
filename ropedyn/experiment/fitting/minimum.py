"""Least squares with exact derivatives, in the directions that what was measured tells."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ...base.array import Real
from ...base.errors import SceneError, SolveError
from .misfit import Misfit

BLIND = 1e-8  # Singular values below this share of the largest are the rounding of derivatives.
FARTHEST = 23.0  # A variable leaves its start by at most so much, a logarithm of ten decades.
# ftol is the square of 1e-4 standard deviations, gtol the rounding of relative residuals.
DIGITS = {"ftol": 1e-8, "gtol": 1e-14, "xtol": 1e-13}
# The trust region measures first by factors e, then, for narrow valleys, by what residuals feel.
SCALES: tuple[float | str, ...] = (1.0, "jac")
EVALUATIONS = 50  # With each of the scales residuals are computed so often at most.


@dataclass(frozen=True, eq=False)
class Minimum:
    """Where the sum of squares is least."""

    u: Real  # (p,)
    residual: Real  # (m,)
    slope: Real  # (m, p)
    evaluations: int  # of the residuals and their slopes

    @property
    def cost(self) -> float:
        """Sum of squares."""
        return float(self.residual @ self.residual)


@dataclass(eq=False)
class Memory:
    """A misfit within ten decades of a start that remembers where it was last asked."""

    misfit: Misfit
    centre: Real
    evaluations: int = 0
    _last: Real | None = field(default=None, init=False)
    _answer: tuple[Real, Real] = field(init=False)

    def __call__(self, u: Real) -> tuple[Real, Real]:
        """Return the residuals and their slopes."""
        if self._last is None or not np.array_equal(u, self._last):
            held = np.clip(u, self.centre - FARTHEST, self.centre + FARTHEST)
            residual, slope = self.misfit(held)
            self.evaluations += 1
            self._last, self._answer = u.copy(), (residual, np.where(held == u, slope, 0.0))
        return self._answer


def told_directions(slope: Real) -> Real:
    """Return an orthonormal basis of the directions that change the residuals, shape (p, r)."""
    _, size, rows = np.linalg.svd(slope, full_matrices=False)
    felt = size > BLIND * max(size.max(initial=0.0), np.finfo(float).tiny)
    if felt.sum() == slope.shape[1]:
        return np.eye(slope.shape[1])
    return np.asarray(rows[felt].T)


def minimise(
    misfit: Misfit,
    start: Real,
    directions: Real | None = None,
    *,
    digits: Mapping[str, float] = DIGITS,
) -> Minimum:
    """Find the least sum of squares along directions that change residuals at the start."""
    remembered = Memory(misfit, start)
    residual, slope = remembered(start)
    free = np.eye(len(start)) if directions is None else directions
    basis = free @ told_directions(slope @ free)
    if not basis.shape[1]:
        return Minimum(start, residual, slope, remembered.evaluations)
    size = float(np.linalg.norm(slope @ basis, axis=0).max())
    y = _Descent(remembered, start, basis, size, digits).end()
    u = np.clip(start + basis @ y, start - FARTHEST, start + FARTHEST)
    residual, slope = remembered(start + basis @ y)
    return Minimum(u, residual, slope, remembered.evaluations)


class _LastStep(Exception):
    """Of all that a solver of SciPy calls, what can end it."""


@dataclass(eq=False)
class _Descent:
    """Steps along a basis from a start, y = 0; residuals in units of the largest slope there."""

    remembered: Memory
    start: Real
    basis: Real
    size: float
    digits: Mapping[str, float]
    at: Real = field(init=False)

    def end(self) -> Real:
        """Return y at the least sum of squares."""
        from scipy.optimize import least_squares

        self.at = np.zeros(self.basis.shape[1])
        for scale in SCALES:
            try:
                found = least_squares(
                    self.residual,
                    self.at,
                    jac=self.slope,
                    x_scale=scale,
                    max_nfev=EVALUATIONS,
                    **self.digits,
                )
            except _LastStep:
                return self.at
            self.at = found.x
            if found.success:
                return self.at
        raise SolveError(
            f"identification must converge within {len(SCALES) * EVALUATIONS} steps, the last "
            f"ended at a sum of squares of {2 * float(found.cost) * self.size**2:.3g}: give the "
            "scene better guesses"
        )

    def residual(self, y: Real) -> Real:
        """Return the residuals; infinite where there is no scene, so that a step is taken back."""
        try:
            return self.remembered(self.start + self.basis @ y)[0] / self.size
        except (SceneError, SolveError):
            return np.full(len(self.remembered(self.start)[0]), np.inf)

    def slope(self, y: Real) -> Real:
        """Return the slopes at the end of a step; end where a linear step would gain too little."""
        residual, slope = self.remembered(self.start + self.basis @ y)
        residual, slope = residual / self.size, slope @ self.basis / self.size
        gain = slope @ np.linalg.lstsq(slope, residual, rcond=BLIND)[0]
        enough = self.digits["ftol"] * (residual @ residual) + self.digits["gtol"] ** 2
        if gain @ gain <= enough:
            self.at = y
            raise _LastStep
        return slope
