"""Search for the modes that measured peaks are, with parameters unknown."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from itertools import combinations, product

import numpy as np

from ...base.array import Index, Integer, Real
from ...base.errors import SolveError
from .order_fit import Likelihood, OrderFit, OrderFits
from .order_grid import COARSE, STEP, Calculated, Grid

OVERLOOKED = 0.1  # A mode of the band is not among the peaks with this probability.
STRAY = 0.5  # On average so many peaks are no mode.
REACH = 30.0  # Each parameter may be so many times larger or smaller than its start.
KEPT = 5  # At most so many assignments are returned.
# Relative standard uncertainties that are tried where none is given: of good peaks of a rope the
# model describes, to those of one it describes by a per cent.
NOISES = (0.0005, 0.002, 0.008)
FINEST = 1e-6  # Measured frequencies have at least this relative standard uncertainty.
CANDIDATES = 8  # So many numberings of the grid are fitted to the calculation itself.
MISSING = 32  # So many modes may be missing, unless told: what a search costs grows squared.
SUBSETS = 4  # So many pairs of peaks are taken for any two modes, more if more are spurious.
ROUNDS = 3  # Peaks are numbered on the grid so often, each time after a fit.


@dataclass(frozen=True, eq=False)
class Assignment:
    """One way to see measured peaks as modes."""

    orders: Integer  # (k,) of each peak from 1; 0 where it is no mode
    parameters: Real  # (p,) the likeliest with these orders
    cost: float  # -2 ln of the likelihood, up to a constant all share, see `Likelihood`
    misfit: float  # the part of it that peaks alone say
    noise: float | None  # relative one that makes the peaks likeliest, where none was given


def search(
    measured: Real,
    std: Real | None,
    calculated: Calculated,
    start: Real,
    *,
    missing: int | None = None,
    spurious: int = 1,
) -> list[Assignment]:
    """Find which mode each peak is, and the parameters with it; the likeliest first.

    Every two peaks, taken as every two modes they may be, determine parameters on a grid, with
    which all are numbered and fitted. What is likeliest is fitted to the calculation itself.
    """
    order = np.argsort(measured, kind="stable")
    frequency = measured[order]
    known = NOISES[-1] * frequency if std is None else np.maximum(std[order], FINEST * frequency)
    likelihood = Likelihood(
        frequency=frequency,
        sigma=known,
        band=(0.0, float(measured.max())),
        overlooked=OVERLOOKED,
        stray=STRAY,
        missing=min(len(measured), MISSING) if missing is None else missing,
        spurious=min(spurious, len(measured) - 1),
    )
    reach = np.full(start.shape, REACH)
    limits = start / reach, start * reach
    grid = Grid.of(calculated, start, reach, len(measured) + likelihood.missing)
    candidates = _candidates(grid, likelihood, limits)
    back = np.argsort(order, kind="stable")
    found: dict[bytes, Assignment] = {}
    for noise in (None,) if std is not None else NOISES:
        if noise is not None:
            likelihood = dataclasses.replace(likelihood, sigma=noise * likelihood.frequency)
        fits = OrderFits(likelihood, calculated, limits)
        for orders, parameters in candidates:
            fits.settle(orders, parameters)
        fits.look_around()
        for one in fits.ranked():
            _keep(found, one, back, noise)
    if not found:
        raise SolveError(
            f"no orders of the {len(measured)} peaks fit with at most {likelihood.missing} modes "
            f"missing and {spurious} peaks that are none"
        )
    return sorted(found.values(), key=lambda one: one.cost)[:KEPT]


def _keep(found: dict[bytes, Assignment], fit: OrderFit, back: Index, noise: float | None) -> None:
    """Keep an assignment with the noise that makes it likeliest."""
    orders, cost = fit.orders[back], fit.cost
    if noise is not None:
        # each peak that no parameter was fitted to has a density of 1/noise
        cost += 2 * max(0, len(orders) - len(fit.parameters)) * float(np.log(noise))
    key = orders.tobytes()
    if key not in found or cost < found[key].cost:
        found[key] = Assignment(orders, fit.parameters, cost, fit.misfit, noise)


def _candidates(
    grid: Grid, likelihood: Likelihood, limits: tuple[Real, Real]
) -> list[tuple[Integer, Real]]:
    """Return the likeliest different orders over the grid, with parameters."""
    guesses = _guesses(likelihood, grid.quotients.frequency.shape[1], grid.parameters.shape[1])
    at = np.repeat(np.arange(len(grid.parameters)), len(guesses))
    orders = np.tile(guesses, (len(grid.parameters), 1))
    sigma = likelihood.coarser(COARSE)
    for _ in range(ROUNDS):
        both = np.unique(np.column_stack([at, orders]), axis=0)
        at, orders = both[:, 0], both[:, 1:]
        parameters = _fitted(grid, likelihood, limits, at, orders)
        frequency = grid.quotients.take(at).at(parameters / grid.parameters[at])
        orders, cost = likelihood.numbered(frequency, sigma)
    chosen: dict[bytes, tuple[Integer, Real]] = {}
    ranked = np.argsort(cost, kind="stable")
    for h in ranked[np.isfinite(cost[ranked])]:
        chosen.setdefault(orders[h].tobytes(), (orders[h], parameters[h]))
        if len(chosen) == CANDIDATES:
            break
    return list(chosen.values())


def _guesses(likelihood: Likelihood, modes: int, parameters: int) -> Integer:
    """Return orders of two peaks, or of one where there is one parameter, shape (g, k)."""
    k, missing, spurious = len(likelihood.frequency), likelihood.missing, likelihood.spurious
    guesses = []
    for some in _subsets(k, min(2, k, parameters), spurious):
        ranges = [range(max(1, i + 1 - spurious), min(modes, i + 1 + missing) + 1) for i in some]
        for orders in product(*ranges):
            rise = np.diff(orders)
            if (rise > 0).all() and (np.diff(some) - rise <= spurious).all():
                guess = np.zeros(k, dtype=np.int64)
                guess[list(some)] = orders
                guesses.append(guess)
    return np.array(guesses, dtype=np.int64).reshape(-1, k)


def _subsets(peaks: int, size: int, spurious: int) -> list[tuple[int, ...]]:
    """Return sets of peaks, far apart, of which one has no spurious peak."""
    nested = [(i, peaks - 1 - i)[:size] for i in range(peaks // 2)]
    if len(nested) > spurious:
        return nested[: max(spurious + 1, SUBSETS)]
    return list(combinations(range(peaks), size))


def _fitted(
    grid: Grid, likelihood: Likelihood, limits: tuple[Real, Real], at: Index, orders: Integer
) -> Real:
    """Return parameters near points of the grid that fit peaks of these orders, shape (h, p)."""
    peaks, point = likelihood.frequency, grid.parameters[at]
    centre = grid.centre(at, peaks, orders)
    bounds = (
        np.maximum(limits[0] / point, centre / STEP),
        np.minimum(limits[1] / point, centre * STEP),
    )
    weight = np.broadcast_to(peaks / likelihood.coarser(COARSE), orders.shape)
    return point * grid.quotients.take(at).fit(peaks, weight, orders, (centre, STEP), bounds)
