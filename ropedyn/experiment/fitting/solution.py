"""What an identification found of many ropes, with all that further questions about it need."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...base.array import Flags, Index, Real
from ...base.computed import computed
from ...base.errors import RopedynError, SceneError
from .minimum import FARTHEST, Directions, Minimum, NotConverged, Point, minimise
from .misfit import JointMisfit, Misfit, PriorMisfit
from .profile_interval import Profile
from .unknown import Unknowns

NOMINAL = 1e-3  # Where nothing tells the noise this relative one is thought of.
LEAST_NOISE = float(np.finfo(float).eps)  # Relative residuals below it are rounding.
ROUNDING = 1e-12  # Frequencies themselves may have this relative noise, which does not settle.
NARROW = 1e-8  # Below this standard deviation a variable's profile is a parabola, but for rounding.
UNFELT = 100.0  # A number whose logarithm has a larger standard deviation is gone to 0 or infinity.
BACK = 0.1  # Such a number is tried again where it has this share of what the residuals feel most.
OTHER = 7.0  # And where it is on the other side of its start by so much, a factor of 1000.
FAR = 2.0  # Such a number has gone at least so far from its start, as a logarithm.
APART = 1e-6  # A number with more than this share in directions that nothing tells is not told.
ONE_STD = 0.6827  # Level of one standard deviation to either side.
TURNS = 50  # Noise and fit take turns so often at most.
LEAST_FREEDOM = 0.5  # Of fewer degrees of freedom nothing tells the noise.
UNLIKELY = 1e-3  # Residuals that chance makes as large with less probability are no noise.


def freedom_of(slope: Real, peaks: int) -> Real:
    """Return degrees of freedom, (n,), of the first rows, the peaks: 1 less its leverage each."""
    told, used = Directions.of(slope), np.abs(slope[:, :peaks]).any(axis=2)
    leverage = np.where(told.size[:, None, :] > 0, told.of_rows[:, :peaks] ** 2, 0.0).sum(axis=2)
    return np.where(used, 1 - leverage, 0.0).sum(axis=1)


def quantile(level: float, freedom: Real) -> Real:
    """Return how many standard deviations an interval reaches, normal or of Student's t."""
    from scipy.special import ndtri, stdtrit

    upper = (1 + level) / 2
    given = np.isnan(freedom)
    return np.where(given, ndtri(upper), stdtrit(np.where(given, 1.0, freedom), upper))


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """Linear statistics of the variables u of many ropes."""

    slope: Real  # (n, m, p) of residuals; 0 of numbers that are at a bound
    noise: Real  # (n,) standard deviation of residuals; infinite where nothing tells it

    @computed
    def told(self) -> Directions:
        """What is told."""
        return Directions.of(self.slope)

    @computed
    def basis(self) -> Real:
        """Directions that are told, as columns, shape (n, p, p); the others are 0."""
        return self.told.basis()

    @computed
    def blind(self) -> Flags:
        """Numbers that are not told, shape (n, p)."""
        return 1 - np.sum(self.basis**2, axis=2) > APART

    @computed
    def unit(self) -> Real:
        """Covariances of u for a noise of 1, of least norm where some are not told, (n, p, p)."""
        half = self.told.direction * self.told.inverse[:, :, None]
        return half.swapaxes(1, 2) @ half

    @computed
    def std(self) -> Real:
        """Standard deviation of u, shape (n, p)."""
        size = np.sqrt(np.diagonal(self.unit, axis1=1, axis2=2))
        std = np.where(np.isfinite(self.noise), self.noise, 0.0)[:, None] * size
        return np.where(self.blind | np.isinf(self.noise)[:, None], np.inf, std)

    @property
    def correlation(self) -> Real:
        """Between numbers, NaN where one of them is not told, shape (n, p, p)."""
        size = np.sqrt(np.diagonal(self.unit, axis1=1, axis2=2))
        size = np.where(self.blind, np.nan, size)
        correlation = self.unit / (size[:, :, None] * size[:, None, :])
        correlation[:, np.arange(size.shape[1]), np.arange(size.shape[1])] = 1.0
        return correlation


def kind_of_solution(m: int, p: int) -> np.dtype[np.void]:
    """Return what there is of the solution for p numbers by m residuals."""
    return np.dtype(
        [
            ("u", float, (p,)),  # where the sum of squares is least
            ("residual", float, (m,)),
            ("slope", float, (m, p)),
            ("evaluations", np.int64),
            ("noise", float),  # standard deviation of residuals; infinite where nothing tells it
            (
                "freedom",
                float,
            ),  # degrees of freedom it was estimated with; NaN where it is as given
            ("side", np.int64, (p,)),  # -1 of numbers that went to 0, 1 to infinity, else 0
            ("weight", float),  # of what was known beforehand
        ]
    )


@dataclass(frozen=True, eq=False)
class Solution:
    """The best numbers of many ropes and what is known of them."""

    task: Task  # what was asked
    rows: Index  # (n,) of its misfit
    record: NDArray[np.void]  # (n,) with the fields of `kind_of_solution`

    def take(self, some: Index) -> Solution:
        """Return that of some of the ropes."""
        return replace(self, rows=self.rows[some], record=self.record[some])

    @property
    def u(self) -> Real:
        """The best variables, shape (n, p)."""
        return self.record["u"]

    @property
    def noise(self) -> Real:
        """Standard deviation of residuals, infinite where nothing tells it, shape (n,)."""
        return self.record["noise"]

    @property
    def nominal(self) -> Real:
        """The same as it was given, where it was, shape (n,)."""
        given = self.task.noise[self.rows]
        return np.where(np.isnan(given), self.noise, given)

    @property
    def refuted(self) -> Flags:
        """Where residuals are larger than the noise that was given, and told another, (n,)."""
        return ~np.isnan(self.task.noise[self.rows]) & ~np.isnan(self.record["freedom"])

    @property
    def side(self) -> NDArray[np.int64]:
        """Where numbers went: -1 to 0, 1 to infinity, else 0, shape (n, p)."""
        return self.record["side"]

    @property
    def unknowns(self) -> Unknowns:
        """What was sought."""
        return self.task.unknowns

    @property
    def peaks(self) -> int:
        """Of the residuals, those that were measured."""
        return self.task.peaks

    @property
    def off(self) -> Real:
        """Sum of squares of what was measured, shape (n,)."""
        return np.sum(self.record["residual"][:, : self.peaks] ** 2, axis=1)

    @computed
    def value(self) -> Real:
        """The best numbers, shape (n, p)."""
        value = self.unknowns.value(self.u)
        return np.where(self.side < 0, 0.0, np.where(self.side > 0, np.inf, value))

    @computed
    def uncertainty(self) -> Uncertainty:
        """Of the variables."""
        slope = self.record["slope"]
        if self.side.any():
            slope = np.where(self.side[:, None, :] == 0, slope, 0.0)
        return Uncertainty(slope, self.noise)

    @computed
    def std(self) -> Real:
        """Standard deviations of the numbers, NaN of those that have one bound, shape (n, p)."""
        std = self.uncertainty.std * np.abs(self.unknowns.slope(self.u))
        at = np.flatnonzero(self.side.any(axis=1))
        if len(at):
            # beside a number at its bound, which could be off it, straight lines know too much
            some = self.take(at)
            half = np.ptp(some.interval(ONE_STD), axis=2) / 2
            std[at] = half / quantile(ONE_STD, some.record["freedom"])[:, None]
        return np.where(self.side == 0, std, np.nan)

    def interval(self, level: float) -> Real:
        """Return profile likelihood bounds of the numbers in increasing order, shape (n, p, 2)."""
        uncertainty, u = self.uncertainty, self.u
        free = self.side == 0
        silent = np.isinf(self.noise)[:, None] | (free & uncertainty.blind)
        root = quantile(level, self.record["freedom"])
        step = np.where(free, root[:, None] * uncertainty.std, 1.0)
        # a profile would be that of rounding, which takes long to follow
        narrow = (uncertainty.blind | (uncertainty.std < NARROW)).all(axis=1) & free.all(axis=1)
        step[silent] = 0.0
        bound = u[:, :, None] + step[:, :, None] * np.array([-1.0, 1.0])
        lane = ~(silent | narrow[:, None])[:, :, None] & (self.side[:, :, None] != [-1, 1])
        bound[self.side < 0, 0], bound[self.side > 0, 1] = -np.inf, np.inf
        row, i, way = np.nonzero(lane)
        if len(row):
            unit, along = uncertainty.unit[row, :, i], free[row, i]
            unit[~along] = np.eye(u.shape[1])[i[~along]]
            weight = np.full(len(self.task.noise), NOMINAL)
            weight[self.rows] = self.record["weight"]
            profile = Profile(
                misfit=self.task.misfit(weight),
                rows=self.rows[row],
                best=u[row],
                least=np.sum(self.record["residual"][row] ** 2, axis=1),
                i=i,
                path=unit / unit[np.arange(len(i)), i][:, None],
                by_factor=self.unknowns.by_factor,
                limit=np.where(along, FARTHEST, 3 * FARTHEST),
            )
            root = (root * self.noise)[row]
            bound[row, i, way] = profile.bounds(2 * way - 1, root, step[row, i])
        found = np.sort(self.unknowns.bound(bound), axis=2)
        return np.where(silent[:, :, None], self.unknowns.widest, found)

    def linear_interval(self, level: float) -> Real:
        """Return bounds by the standard deviations alone, shape (n, p, 2)."""
        reach = (quantile(level, self.record["freedom"])[:, None] * self.std)[:, :, None]
        with np.errstate(invalid="ignore"):
            linear = self.value[:, :, None] + reach * np.array([-1.0, 1.0])
        return np.where(np.isfinite(reach), linear, self.unknowns.widest)


@dataclass(frozen=True, eq=False)
class Task:
    """What was measured of many ropes and what was known of them beforehand."""

    unknowns: Unknowns  # what is sought
    measured: Misfit
    peaks: int  # residuals of each
    known: PriorMisfit | None
    noise: Real  # (n,) standard deviation of residuals, of each row of the misfit; NaN: to estimate
    alike: float = 1.0  # so many of the residuals count as one

    def misfit(self, weight: Real) -> Misfit:
        """Return what is made small, with what was known in units of a noise of each row."""
        if self.known is None:
            return self.measured
        return JointMisfit(self.measured, self.known, weight)

    def solve(self, rows: Index, start: Point) -> tuple[Solution, dict[int, RopedynError]]:
        """Make what was measured fit best; return also why some of the rows have no solution."""
        best, failed = self._best(rows, start, start.u, self.noise[rows])
        # where residuals refute the noise that was given they tell it, and an interval is as wide
        wide = np.setdiff1d(_refuted(best), list(failed))
        if len(wide):
            there = Point(*(best.record[name][wide] for name in ("u", "residual", "slope")))
            unknown = np.full(len(wide), np.nan)
            found, refused = self._best(rows[wide], there, start.u[wide], unknown)
            told = np.delete(np.arange(len(wide)), list(refused))
            best.record[wide[told]] = found.record[told]
        return best, failed

    def _best(
        self, rows: Index, start: Point, origin: Real, noise: Real
    ) -> tuple[Solution, dict[int, RopedynError]]:
        """Solve from a start, and again from elsewhere where numbers went to 0 or infinity."""
        best, failed = self._attempt(rows, start, origin, noise)
        gone = np.setdiff1d(np.flatnonzero(best.side.any(axis=1)), list(failed))
        if not len(gone):
            return best, failed
        first = best.take(gone)
        # again from where something hangs on it, and from the other side of its start
        for u in (_back(first), np.where(first.side, origin[gone] - OTHER * first.side, first.u)):
            again = Point.of(self.measured, rows[gone], u)
            there = np.isfinite(again.residual.sum(axis=1) + again.slope.sum(axis=(1, 2)))
            at, again = gone[there], again.take(there)
            if not len(at):
                continue
            found, refused = self._attempt(rows[at], again, again.u, noise[at])
            better = found.off < best.off[at]
            better[list(refused)] = False
            best.record[at[better]] = found.record[better]
        return best, failed

    def _attempt(
        self, rows: Index, start: Point, origin: Real, given: Real
    ) -> tuple[Solution, dict[int, RopedynError]]:
        """Solve from a start; where the noise has to be known too both take turns."""
        sought = np.isnan(given)
        weight = np.full(len(self.noise), NOMINAL)
        weight[rows] = np.where(sought, NOMINAL, given)
        misfit = self.misfit(weight)
        minimum = minimise(misfit, rows, self._from(misfit, rows, start))
        noise, freedom = self._noise(minimum, given)
        failed: dict[int, RopedynError] = {}
        if self.known is not None:
            going = np.flatnonzero(sought)
            for _ in range(TURNS):
                told = np.isfinite(noise[going])
                failed |= {int(k): self._untold() for k in going[~told]}
                going = going[told]
                change = np.abs(noise[going] / weight[rows[going]] - 1)
                going = going[(change >= 1e-3) & (noise[going] >= ROUNDING)]
                if not len(going):
                    break
                weight[rows[going]] = noise[going]
                before = minimum.take(going)
                point = self._from(misfit, rows[going], before.point)
                again = minimise(misfit, rows[going], point)
                again = replace(again, evaluations=again.evaluations + before.evaluations)
                minimum.put(going, again)
                noise[going], freedom[going] = self._noise(again, given[going])
            for k in going.tolist():
                failed[k] = NotConverged(
                    f"the noise of the peaks must settle, it was {noise[k]:.3g} after {TURNS} fits"
                )
        failed |= {k: minimum.refusal(k) for k in np.flatnonzero(~minimum.reached).tolist()}
        felt = np.where(np.isinf(noise), NOMINAL, noise)
        record = np.zeros(len(rows), kind_of_solution(*minimum.slope.shape[1:]))
        for name in ("u", "residual", "slope", "evaluations"):
            record[name] = getattr(minimum, name)
        record["side"] = _gone(minimum, origin, self.unknowns, felt)
        record["noise"], record["freedom"], record["weight"] = noise, freedom, weight[rows]
        return Solution(self, rows, record), failed

    def _from(self, misfit: Misfit, rows: Index, start: Point) -> Point:
        """Return a start with what was known beforehand."""
        if not isinstance(misfit, JointMisfit):
            return start
        m = self.peaks
        joined = misfit.joined(rows, start.u, start.residual[:, :m], start.slope[:, :m])
        return Point(start.u, *joined)

    def _noise(self, minimum: Minimum, given: Real) -> tuple[Real, Real]:
        """Return standard deviations of residuals, and degrees of freedom or NaN where given."""
        sought = np.flatnonzero(np.isnan(given))
        noise, freedom = given.copy(), np.full(len(given), np.nan)
        if len(sought):
            free = freedom_of(minimum.slope[sought], self.peaks) / self.alike
            size = np.linalg.norm(minimum.residual[sought, : self.peaks], axis=1)
            told = free >= LEAST_FREEDOM
            each = np.maximum(size / np.sqrt(np.where(told, free, 1.0)), LEAST_NOISE)
            noise[sought] = np.where(told, each, np.inf)
            freedom[sought] = np.where(told, free, 0.0)
        return noise, freedom

    def _untold(self) -> SceneError:
        return SceneError(
            "measured must have a std where what is known beforehand is needed to tell the "
            f"unknown, got {self.peaks} peaks without: nothing is left to estimate it from"
        )


def _refuted(solution: Solution) -> Index:
    """Return the ropes whose peaks are off by more than the noise that was given lets them."""
    from scipy.special import chdtrc

    def unlikely(freedom: Real, off: Real) -> Flags:
        # of very few degrees of freedom nothing is said
        return chdtrc(np.maximum(freedom, LEAST_FREEDOM), off) <= UNLIKELY

    slope, off = solution.record["slope"], solution.off / solution.nominal**2
    # there are at least as many as peaks less unknowns
    least = slope[:, : solution.peaks].any(axis=2).sum(axis=1) - slope.shape[2]
    at = np.flatnonzero(np.isnan(solution.record["freedom"]) & unlikely(least, off))
    if not len(at):
        return at
    freedom = freedom_of(slope[at], solution.peaks)
    return at[(freedom >= LEAST_FREEDOM) & unlikely(freedom, off[at])]


def _back(solution: Solution) -> Real:
    """Return variables with numbers that went to 0 or infinity where a tenth hangs on each."""
    felt = np.linalg.norm(solution.record["slope"], axis=1)
    # where none is felt any more, as with the lowest peak spurious and far down, all go back as far
    largest = felt.max(axis=1, keepdims=True)
    share = np.maximum(felt / np.where(largest > 0, largest, 1.0), np.exp(-FARTHEST))
    back = np.maximum(np.log(BACK / share), 0.0)
    return solution.u - solution.side * back


def _gone(minimum: Minimum, start: Real, unknowns: Unknowns, noise: Real) -> NDArray[np.int_]:
    """Say which numbers went to 0 (-1) or infinity (1)."""
    felt = np.linalg.norm(minimum.slope, axis=1)
    way = minimum.u - start
    unfelt = (felt * UNFELT < noise[:, None]) & (np.abs(way) > FAR)
    gone = unknowns.by_factor & (unfelt | (np.abs(way) >= FARTHEST))
    return np.where(gone, np.sign(way), 0).astype(int)
