"""What an identification found, with all that further questions about it need."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...base.array import Flags, Real
from ...base.computed import computed
from ...base.errors import SceneError, SolveError
from ...scene.scene import Scene
from ..fitting.minimum import FARTHEST, Minimum, minimise, told_directions
from ..fitting.misfit import JointMisfit, Misfit, PriorMisfit
from ..fitting.unknown import Unknowns
from .profile_interval import Profile

NOMINAL = 1e-3  # Where nothing tells the noise this relative one is thought of.
LEAST_NOISE = float(np.finfo(float).eps)  # Relative residuals below it are rounding.
ROUNDING = 1e-12  # Frequencies themselves may have this relative noise, which does not settle.
NARROW = 1e-8  # Below this standard deviation a variable's profile is a parabola, but for rounding.
UNFELT = 100.0  # A number whose logarithm has a larger standard deviation is gone to 0 or infinity.
BACK = 0.1  # Such a number is tried again where it has this share of what the residuals feel most.
FAR = 2.0  # Such a number has gone at least so far from its start, as a logarithm.
APART = 1e-6  # A number with more than this share in directions that nothing tells is not told.


def freedom_of(minimum: Minimum, peaks: int) -> float:
    """Return the degrees of freedom of the first rows, the peaks: 1 less its leverage for each."""
    basis = told_directions(minimum.slope)
    directions, _ = np.linalg.qr(minimum.slope @ basis)
    used = np.abs(minimum.slope[:peaks]).any(axis=1)
    return float(used.sum() - np.sum(directions[:peaks][used] ** 2))


def quantile(level: float, freedom: float | None) -> float:
    """Return how many standard deviations an interval reaches, normal or of Student's t."""
    from scipy.special import ndtri, stdtrit

    upper = (1 + level) / 2
    return float(ndtri(upper) if freedom is None else stdtrit(freedom, upper))


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Linear statistics of the variables u."""

    slope: Real  # (m, p) of residuals; 0 of numbers that are at a bound
    noise: float  # standard deviation of residuals; infinite where nothing tells it

    @computed
    def basis(self) -> Real:
        """Directions that are told, shape (p, r)."""
        return told_directions(self.slope)

    @property
    def blind(self) -> Flags:
        """Numbers that are not told, shape (p,)."""
        return 1 - np.sum(self.basis**2, axis=1) > APART

    @computed
    def unit(self) -> Real:
        """Covariance of u for a noise of 1, of least norm where some are not told, (p, p)."""
        half = self.basis @ np.linalg.pinv(self.slope @ self.basis)
        return half @ half.T

    @property
    def std(self) -> Real:
        """Standard deviation of u, shape (p,)."""
        told_ones = ~self.blind
        std = np.full(len(self.unit), np.inf)
        if np.isfinite(self.noise):
            std[told_ones] = self.noise * np.sqrt(np.diag(self.unit)[told_ones])
        return std

    @property
    def correlation(self) -> Real:
        """Between numbers, NaN where one of them is not told, shape (p, p)."""
        size = np.sqrt(np.diag(self.unit))
        size[self.blind] = np.nan
        correlation = self.unit / np.outer(size, size)
        np.fill_diagonal(correlation, 1.0)
        return correlation


@dataclass(frozen=True, eq=False)
class Solution:
    """The best numbers and what is known of them."""

    unknowns: Unknowns  # what was sought
    misfit: Misfit  # what was made small, with what was known beforehand
    minimum: Minimum  # where it is least
    rows: int  # of the residuals, those that were measured
    noise: float  # standard deviation of residuals; infinite where nothing tells it
    freedom: float | None  # degrees of freedom it was estimated with; None where it was given
    side: NDArray[np.int_]  # (p,) -1 of numbers that went to 0, 1 to infinity, else 0

    @property
    def off(self) -> float:
        """Sum of squares of what was measured."""
        return float(np.sum(self.minimum.residual[: self.rows] ** 2))

    @property
    def scene(self) -> Scene:
        """The scene with the best numbers."""
        return self.unknowns.at(self.minimum.u)

    @property
    def value(self) -> Real:
        """The best numbers, shape (p,)."""
        value = self.unknowns.value(self.minimum.u)
        return np.where(self.side < 0, 0.0, np.where(self.side > 0, np.inf, value))

    @computed
    def uncertainty(self) -> Uncertainty:
        """Of the variables."""
        return Uncertainty(np.where(self.side == 0, self.minimum.slope, 0.0), self.noise)

    @property
    def std(self) -> Real:
        """Standard deviations of the numbers, shape (p,)."""
        return self.uncertainty.std * np.abs(self.unknowns.slope(self.minimum.u))

    def interval(self, level: float) -> Real:
        """Return profile likelihood bounds of the numbers, shape (p, 2)."""
        if not np.isfinite(self.noise):
            return self._nothing()
        root = quantile(level, self.freedom)
        return np.array([self._bounds(i, root) for i in range(len(self.unknowns))])

    def linear_interval(self, level: float) -> Real:
        """Return bounds by the standard deviations alone, shape (p, 2)."""
        reach = quantile(level, self.freedom) * self.std
        return np.where(
            np.isfinite(reach)[:, None],
            np.column_stack([self.value - reach, self.value + reach]),
            self._nothing(),
        )

    def _nothing(self) -> Real:
        least = np.where(self.unknowns.by_factor & (self.unknowns.start > 0), 0.0, -np.inf)
        most = np.where(self.unknowns.by_factor & (self.unknowns.start < 0), 0.0, np.inf)
        return np.column_stack([least, most])

    def _bounds(self, i: int, root: float) -> Real:
        """Return both bounds of a number in increasing order."""
        side, uncertainty = self.side[i], self.uncertainty
        if side == 0 and uncertainty.blind[i]:
            return self._nothing()[i]
        path, step, limit = np.zeros(len(self.unknowns)), 1.0, 3 * FARTHEST
        path[i] = 1.0
        if side == 0:
            path = uncertainty.unit[:, i] / uncertainty.unit[i, i]
            step, limit = root * float(uncertainty.std[i]), FARTHEST
            if not self.side.any() and (uncertainty.std[~uncertainty.blind] < NARROW).all():
                # a profile would be that of rounding, which takes long to follow
                return np.sort([self._number(self.minimum.u[i] + way * step, i) for way in (-1, 1)])
        profile = Profile(self.misfit, self.minimum, i, path, self.unknowns.by_factor, limit)
        u = [
            way * np.inf if way == side else profile.bound(way, root * self.noise, step)
            for way in (-1, 1)
        ]
        return np.sort([self._number(one, i) for one in u])

    def _number(self, u: float, i: int) -> float:
        if np.isinf(u):
            at_infinity = 0.0 if u < 0 else np.inf
            return float(np.sign(self.unknowns.start[i]) * at_infinity)
        variables = np.array(self.minimum.u)
        variables[i] = u
        return float(self.unknowns.value(variables)[i])


def solve(
    unknowns: Unknowns,
    measured: Misfit,
    start: Real,
    *,
    rows: int,
    known: PriorMisfit | None,
    noise: float | None,
    guess: Real | None = None,
) -> Solution:
    """Make what was measured fit best, together with what was known beforehand."""

    def attempt(start: Real) -> Solution:
        misfit = measured
        if known is not None and noise is None:
            misfit, minimum = _weighed(measured, known, start, rows)
        else:
            misfit = misfit if known is None else JointMisfit(measured, known, noise or NOMINAL)
            minimum = minimise(misfit, start)
        found, freedom = _noise_of(minimum, rows) if noise is None else (noise, None)
        origin = start if guess is None else guess
        side = _gone(minimum, origin, unknowns, found if np.isfinite(found) else NOMINAL)
        return Solution(unknowns, misfit, minimum, rows, found, freedom, side)

    first = attempt(start)
    if not first.side.any():
        return first
    second = attempt(_back(first))
    return min(first, second, key=lambda one: one.off)


def _back(solution: Solution) -> Real:
    """Return variables with numbers that went to 0 or infinity where a tenth hangs on each."""
    felt = np.linalg.norm(solution.minimum.slope, axis=0)
    # where none is felt any more, as with the lowest peak spurious and far down, all go back as far
    largest = felt.max() or 1.0
    share = np.maximum(felt / largest, np.exp(-FARTHEST))
    back = np.maximum(np.log(BACK / share), 0.0)
    return solution.minimum.u - solution.side * back


def _noise_of(minimum: Minimum, rows: int) -> tuple[float, float]:
    """Return the standard deviation of residuals and its degrees of freedom."""
    freedom = freedom_of(minimum, rows)
    if freedom < 0.5:
        return np.inf, 0.0
    noise = float(np.linalg.norm(minimum.residual[:rows]) / np.sqrt(freedom))
    return max(noise, LEAST_NOISE), freedom


def _weighed(
    measured: Misfit, known: PriorMisfit, start: Real, rows: int
) -> tuple[JointMisfit, Minimum]:
    """Estimate the noise and weigh what is known beforehand by it, in turn."""
    noise, evaluations = NOMINAL, 0
    for _ in range(50):
        misfit = JointMisfit(measured, known, noise)
        minimum = minimise(misfit, start)
        evaluations += minimum.evaluations
        start, before = minimum.u, noise
        noise = _noise_of(minimum, rows)[0]
        if np.isinf(noise):
            raise SceneError(
                "measured must have a std where what is known beforehand is needed to tell the "
                f"unknown, got {rows} peaks without: nothing is left to estimate it from"
            )
        if abs(noise / before - 1) < 1e-3 or noise < ROUNDING:
            return misfit, replace(minimum, evaluations=evaluations)
    raise SolveError(f"the noise of the peaks must settle, it was {noise:.3g} after 50 fits")


def _gone(minimum: Minimum, start: Real, unknowns: Unknowns, noise: float) -> NDArray[np.int_]:
    """Say which numbers went to 0 (-1) or infinity (1)."""
    felt = np.linalg.norm(minimum.slope, axis=0)
    way = minimum.u - start
    unfelt = (felt * UNFELT < noise) & (np.abs(way) > FAR)
    gone = unknowns.by_factor & (unfelt | (np.abs(way) >= FARTHEST))
    return np.where(gone, np.sign(way), 0).astype(int)
