"""A random walk that is seen with noise, and with an error that all its values share.

What is seen on day i, with a standard deviation tau_i of which sigma_i is surely its own, is

    y_i = x_i + a theta_i + c_i z + e_i,    x_{i+1} - x_i ~ N(0, s^2 (t_{i+1} - t_i)),
    e_i ~ N(0, (k sigma_i)^2),  c_i^2 = tau_i^2 - (k sigma_i)^2 >= 0,  z ~ N(0, 1) on all days,

x_0 and a unknown altogether: the local level model (Durbin, Koopman, Time Series Analysis by State
Space Methods, 2nd ed., chapter 2) with regressors, which the filter takes as further columns beside
y (de Jong, Annals of Statistics 19 (1991) 1073-1083). The step s and the factor k of the noise are
integrated out on a grid: the likeliest step alone covers .86 to .90 where 95 % are claimed. k is
what the days tell by their scatter of how much of tau is anew on each; z is never estimated: c goes
through the smoother as y does, and what becomes of it is an error.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.array import Flags, Real

STEPS = 41  # Of each of two grids, the second where the first found weight.
FACTOR = 1.4  # About that lies between factors k of the noise, whose prior is flat in ln k.
MOST_SCATTER = 4.5  # At least up to this factor, else until no error is left that days share.
SMALL, LARGE = 0.02, 3.0  # Of steps: nothing over the whole time, and more than any that is seen.
LEAST_WEIGHT = 1e-4  # Of a step, beside the likeliest: less is not on the second grid.
KEPT = 1e-6  # Of a pair of step and factor, beside the likeliest: less is left out.
ROUNDING = 1e-6  # Less of the noise that is left on a day is rounding: the day alone tells it.
DATA = 2  # Columns before the regressors: y and c.


class Walk(NamedTuple):
    """What is known of a walk; every array has shape (n,)."""

    mean: Real  # x + a theta
    std: Real  # of it, with the error that all days share
    own_std: Real  # of it, without
    level: Real  # x + a times the mean theta
    level_std: Real  # of it, with the error that all days share
    coefficient: tuple[float, float]  # a and its standard deviation; NaN without a covariate
    step: tuple[float, float, float]  # s: median and 95 % interval
    scatter: float  # k: mean
    off: Real  # e over its standard deviation: how far a day is from what all say


class Seen(NamedTuple):
    """What is seen of a walk: columns are y, c, 1 and theta, shape (n, 3 or 4)."""

    gap: Real  # since the day before
    columns: Real  # c is filled in by k
    own: Real  # sigma
    whole: Real  # tau
    there: Flags  # which days are seen


class Pairs(NamedTuple):
    """Steps and factors of the noise (g,) with their weights, and what they make of regressors."""

    step: Real
    scatter: Real
    weight: Real
    found: Real  # x_0 and a by y and by c, shape (g, 1 or 2, 2)
    covariance: Real  # shape (g, 1 or 2, 1 or 2)

    def take(self, at: Flags) -> Pairs:
        """Return some of them, with weights that sum to 1."""
        kept = Pairs(*(field[at] for field in self))
        return kept._replace(weight=kept.weight / kept.weight.sum())


def walk(
    time: Real,
    y: Real,
    own_std: Real,
    whole_std: Real | None = None,
    covariate: Real | None = None,
) -> Walk:
    """Smooth y (n,), NaN where it was not seen; time does not decrease, two differ."""
    there, n = np.isfinite(y), len(y)
    base, unit = float(y[there].mean()), 1.0
    columns = [np.where(there, y - base, 0.0), np.zeros(n), np.ones(n)]
    if covariate is not None:
        unit = float(covariate[there].std())
        columns.append((covariate - covariate[there].mean()) / unit)
    whole = own_std if whole_std is None else whole_std
    seen = Seen(np.diff(time, prepend=time[0]), np.column_stack(columns), own_std, whole, there)
    pairs = _pairs(seen, np.geomspace(*_range_of_steps(time, y, own_std, there), STEPS))
    pairs = _pairs(seen, _finer(pairs))
    return _smooth(seen, pairs, base, unit)


# --- steps and factors of the noise -------------------------------------------------------------


def _range_of_steps(time: Real, y: Real, own_std: Real, there: Flags) -> tuple[float, float]:
    """Return the least and the largest step that matter."""
    t, var = time[there], own_std[there] ** 2
    gap = np.diff(t)
    moved = np.diff(y[there]) ** 2 + var[1:] + var[:-1]
    most = LARGE * np.sqrt(np.max(moved[gap > 0] / gap[gap > 0]))
    return SMALL * np.sqrt(var.min() / len(t) / (t[-1] - t[0])), float(most)


def _factors(seen: Seen) -> Real:
    """Return factors of the noise, up to where it is all that a day leaves open."""
    most = max(MOST_SCATTER, float(np.max((seen.whole / seen.own)[seen.there])))
    return np.geomspace(1.0, most, 1 + int(np.ceil(np.log(most) / np.log(FACTOR))))


def _pairs(seen: Seen, steps: Real) -> Pairs:
    """Weigh each step with each factor of the noise: the prior is flat in the step."""
    step, scatter = (one.ravel() for one in np.meshgrid(steps, _factors(seen), indexing="ij"))
    ln_f, products, _, _ = _filter(seen, step, scatter)
    precision, right = products[:, DATA:, DATA:], products[:, DATA:, :DATA]
    covariance = np.linalg.inv(precision).astype(np.float64, copy=False)
    found = covariance @ right
    rest = products[:, 0, 0] - np.einsum("gk,gk->g", found[..., 0], right[..., 0])
    ln_l = -0.5 * (ln_f + np.linalg.slogdet(precision)[1] + rest)
    # steps lie a constant factor apart, so that d s is proportional to s
    ln_w = ln_l + np.log(step)
    weight = np.exp(ln_w - ln_w.max())
    return Pairs(step, scatter, weight / weight.sum(), found, covariance)


def _filter(seen: Seen, step: Real, scatter: Real) -> tuple[Real, Real, Real, Real]:
    """Run Kalman's filter from x_0 = 0 for all columns: ln|F|, V^T F^-1 V, states, variances."""
    n, columns = seen.columns.shape
    state, variance = np.zeros((n, len(step), columns)), np.zeros((n, len(step)))
    m, p = np.zeros((len(step), columns)), np.zeros(len(step))
    ln_f, products = np.zeros(len(step)), np.zeros((len(step), columns, columns))
    for i in range(n):
        p = p + step**2 * seen.gap[i]
        if seen.there[i]:
            r = (scatter * seen.own[i]) ** 2
            f, v = p + r, seen.columns[i] - m
            v[:, 1] += np.sqrt(np.maximum(seen.whole[i] ** 2 - r, 0.0))
            scaled = v / f[:, None]
            m, p = m + p[:, None] * scaled, p * r / f
            ln_f, products = ln_f + np.log(f), products + v[:, :, None] * scaled[:, None, :]
        state[i], variance[i] = m, p
    return ln_f, products, state, variance


def _of_steps(pairs: Pairs) -> tuple[Real, Real]:
    """Return the steps of a grid with their weights, whatever the factor of the noise."""
    shape = (STEPS, -1)
    return pairs.step.reshape(shape)[:, 0], pairs.weight.reshape(shape).sum(axis=1)


def _finer(pairs: Pairs) -> Real:
    """Return steps between those that have weight, one more to either side."""
    steps, weight = _of_steps(pairs)
    at = np.flatnonzero(weight > LEAST_WEIGHT * weight.max())
    low, high = max(at[0] - 1, 0), min(at[-1] + 1, len(steps) - 1)
    return np.geomspace(steps[low], steps[high], STEPS)


def _quantiles(steps: Real, weight: Real) -> tuple[float, float, float]:
    """Return the median and the 95 % interval of the step."""
    middle = np.cumsum(weight) - 0.5 * weight
    low, median, high = np.interp([0.025, 0.5, 0.975], middle, steps)
    return float(median), float(low), float(high)


# --- what all days say of each ------------------------------------------------------------------


def _smooth(seen: Seen, pairs: Pairs, base: float, unit: float) -> Walk:
    """Return the walk, mixed of those by each pair."""
    step = _quantiles(*_of_steps(pairs))
    pairs = pairs.take(pairs.weight > KEPT * pairs.weight.max())
    state, variance = _back(seen, pairs)
    regressors = seen.columns[:, DATA:]
    mean, own, common = _mixed(regressors, state, variance, pairs)
    level, level_own, level_common = _mixed(_at_mean(regressors), state, variance, pairs)
    return Walk(
        mean=mean + base,
        std=np.hypot(own, common),
        own_std=own,
        level=level + base,
        level_std=np.hypot(level_own, level_common),
        coefficient=_coefficient(pairs, unit),
        step=step,
        scatter=float(pairs.weight @ pairs.scatter),
        off=_off(seen, state, variance, pairs),
    )


def _back(seen: Seen, pairs: Pairs) -> tuple[Real, Real]:
    """Return states (n, g, columns) and variances (n, g) that all days tell, from the last back."""
    _, _, state, variance = _filter(seen, pairs.step, pairs.scatter)
    for i in range(len(state) - 2, -1, -1):
        ahead = variance[i] + pairs.step**2 * seen.gap[i + 1]
        j = np.divide(variance[i], ahead, out=np.ones_like(ahead), where=ahead > 0)
        state[i] += j[:, None] * (state[i + 1] - state[i])
        variance[i] += j**2 * (variance[i + 1] - ahead)
    return state, variance


def _at_mean(regressors: Real) -> Real:
    """Return the regressors at the mean of the covariate."""
    at = np.zeros_like(regressors)
    at[:, 0] = 1.0
    return at


def _by_pair(regressors: Real, state: Real, variance: Real, pairs: Pairs) -> tuple[Real, Real]:
    """Return what becomes of y and c (n, g, 2), and the variance (n, g) of the first."""
    share = regressors[:, None, :] - state[..., DATA:]
    mean = state[..., :DATA] + np.einsum("igk,gkd->igd", share, pairs.found)
    return mean, variance + np.einsum("igk,gkl,igl->ig", share, pairs.covariance, share)


def _mixed(regressors: Real, state: Real, variance: Real, pairs: Pairs) -> tuple[Real, Real, Real]:
    """Return the mean over all pairs, its own and its common standard deviation (n,)."""
    by_pair, variance = _by_pair(regressors, state, variance, pairs)
    mean = by_pair[..., 0] @ pairs.weight
    spread = variance + (by_pair[..., 0] - mean[:, None]) ** 2
    return mean, np.sqrt(spread @ pairs.weight), np.sqrt(by_pair[..., 1] ** 2 @ pairs.weight)


def _off(seen: Seen, state: Real, variance: Real, pairs: Pairs) -> Real:
    """Return e over its standard deviation by the likeliest pair; NaN where e is all there is.

    It is the residual of each day against all the others (Harvey, Koopman, Journal of Business and
    Economic Statistics 10 (1992) 377-389).
    """
    best = np.arange(len(pairs.weight)) == pairs.weight.argmax()
    only, regressors = pairs.take(best), seen.columns[:, DATA:]
    mean, var = _by_pair(regressors, state[:, best], variance[:, best], only)
    noise = (only.scatter * seen.own) ** 2
    left, e = noise - var[:, 0], seen.columns[:, 0] - mean[:, 0, 0]
    told = seen.there & (left > ROUNDING * noise)
    return np.divide(e, np.sqrt(np.abs(left)), out=np.full(len(e), np.nan), where=told)


def _coefficient(pairs: Pairs, unit: float) -> tuple[float, float]:
    """Return the coefficient of the covariate with its standard deviation."""
    if pairs.found.shape[1] == 1:
        return np.nan, np.nan
    a, var = pairs.found[:, 1, 0], pairs.covariance[:, 1, 1]
    mean = pairs.weight @ a
    return float(mean / unit), float(np.sqrt(pairs.weight @ (var + (a - mean) ** 2)) / unit)
