"""Search for the modes that measured peaks are, with parameters unknown."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations, product

import numpy as np
from numpy.typing import NDArray

from .errors import SolveError
from .numbering import Likelihood
from .order_fit import OrderFits
from .parameter_grid import COARSE, STEP, Calculated, Grid

Real = NDArray[np.float64]
Whole = NDArray[np.int64]

OVERLOOKED = 0.1
"""Probability that a mode of the band is not among the peaks, unless told."""

STRAY = 0.5
"""Peaks that are no mode, on average, unless told."""

FINEST = 1e-6
"""Relative standard uncertainty that measured frequencies have at least."""

CANDIDATES = 8
"""Numberings of the grid that are fitted to the calculation itself."""

ROUNDS = 3
"""Times that peaks are numbered on the grid, each after a fit."""


@dataclass(frozen=True, eq=False)
class Assignment:
    """One way to see measured peaks as modes.

    Attributes
    ----------
    orders : ndarray of int, shape (k,)
        Of each peak from 1; 0 where it is no mode.
    parameters : ndarray, shape (p,)
        The likeliest with these orders.
    cost : float
        -2 ln of the likelihood, up to a constant all assignments share: differences of two are
        differences of chi-square, `ropedyn.numbering.Likelihood` has the terms.
    misfit : float
        The part that peaks alone say, sum of ((calculated - measured)/std)^2: where two
        assignments do not differ in it, only how likely modes are missed decides.
    """

    orders: Whole
    parameters: Real
    cost: float
    misfit: float


def search(
    measured: Real,
    std: Real,
    calculated: Calculated,
    start: Real,
    *,
    missing: int | None = None,
    spurious: int = 1,
    reach: float | Real = 30.0,
    band: tuple[float, float] | None = None,
    overlooked: float = OVERLOOKED,
    stray: float = STRAY,
    keep: int = 5,
) -> list[Assignment]:
    """Find which mode each peak is, and the parameters with it.

    On a grid of parameters around `start` the frequencies are calculated once; Rayleigh's quotients
    of the shapes there give them everywhere between. Every two peaks, taken as every two modes they
    may be, determine parameters, with which all peaks are numbered and the parameters fitted to all
    of them. What comes out likeliest is fitted to the calculation itself.

    Parameters
    ----------
    measured : ndarray, shape (k,)
        Frequencies of the peaks in any order [Hz], positive.
    std : ndarray, shape (k,)
        Their standard uncertainties [Hz], positive.
    calculated : callable
        ``calculated(parameters, count)`` returns the lowest `count` frequencies, shape (count,) or
        fewer where there are no more, positive [Hz], and their derivatives, shape (count, p).
    start : ndarray, shape (p,)
        Parameters to start from, positive.
    missing, spurious : int
        At most so many modes below the highest one seen are missing, as many as there are peaks
        where left out, and at most so many peaks are no modes.
    reach : float or ndarray of shape (p,)
        How many times larger or smaller than `start` each may be; 1 where it is known.
    band : tuple of float, optional
        Where modes would have been seen [Hz]; from 0 to the highest peak where left out.
    overlooked : float
        Probability that a mode of the band is not among the peaks.
    stray : float
        Expected number of peaks that are no mode.
    keep : int
        How many assignments to return at most.

    Returns
    -------
    list of Assignment
        The likeliest first; at least one.

    Raises
    ------
    SolveError
        If nothing could be calculated, or no assignment is within the limits.

    Examples
    --------
    Peaks of a string of unknown tension, f = n sqrt(T); the third mode is missing:

    >>> import numpy as np
    >>> from ropedyn.order_search import search
    >>> def string(p, count):
    ...     n = np.arange(1, count + 1)
    ...     return n * np.sqrt(p[0]), (n / (2 * np.sqrt(p[0])))[:, None]
    >>> peaks = np.array([10.01, 19.99, 40.0, 50.02])
    >>> best, *others = search(peaks, 0.002 * peaks, string, np.array([30.0]))
    >>> best.orders, best.parameters.round(1)
    (array([1, 2, 4, 5]), array([100.]))
    """
    order = np.argsort(measured, kind="stable")
    missing = len(measured) if missing is None else missing
    likelihood = Likelihood(
        frequency=measured[order],
        sigma=np.maximum(std, FINEST * measured)[order],
        band=band or (0.0, float(measured.max())),
        overlooked=overlooked,
        stray=stray,
        missing=missing,
        spurious=min(spurious, len(measured) - 1),
    )
    reach = np.broadcast_to(reach, start.shape)
    limits = start / reach, start * reach
    grid = Grid.of(calculated, start, reach, len(measured) + missing)
    fits = OrderFits(likelihood, calculated, limits)
    for orders, parameters in _candidates(grid, likelihood, limits):
        fits.settle(orders, parameters)
    fits.look_around()
    ranked = fits.ranked()[:keep]
    if not ranked:
        raise SolveError(
            f"no orders of the {len(measured)} peaks fit with at most {missing} modes missing and "
            f"{spurious} peaks that are none"
        )
    back = np.argsort(order, kind="stable")
    return [Assignment(one.orders[back], one.parameters, one.cost, one.misfit) for one in ranked]


def _candidates(
    grid: Grid, likelihood: Likelihood, limits: tuple[Real, Real]
) -> list[tuple[Whole, Real]]:
    """Return the likeliest different orders over the grid, with parameters."""
    guesses = _guesses(likelihood, grid.quotients.frequency.shape[1], grid.parameters.shape[1])
    at = np.repeat(np.arange(len(grid.parameters)), len(guesses))
    orders = np.tile(guesses, (len(grid.parameters), 1))
    sigma = likelihood.coarser(COARSE)
    for _ in range(ROUNDS):
        at, orders = _once_each(at, orders)
        parameters = _fitted(grid, likelihood, limits, at, orders)
        frequency = grid.quotients.take(at).at(parameters / grid.parameters[at])
        orders, cost = likelihood.numbered(frequency, sigma)
    chosen: dict[bytes, tuple[Whole, Real]] = {}
    ranked = np.argsort(cost, kind="stable")
    for h in ranked[np.isfinite(cost[ranked])]:
        chosen.setdefault(orders[h].tobytes(), (orders[h], parameters[h]))
        if len(chosen) == CANDIDATES:
            break
    return list(chosen.values())


def _guesses(likelihood: Likelihood, modes: int, parameters: int) -> Whole:
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
    return nested if len(nested) > spurious else list(combinations(range(peaks), size))


def _once_each(at: NDArray[np.intp], orders: Whole) -> tuple[NDArray[np.intp], Whole]:
    both = np.unique(np.column_stack([at, orders]), axis=0)
    return both[:, 0], both[:, 1:]


def _fitted(
    grid: Grid,
    likelihood: Likelihood,
    limits: tuple[Real, Real],
    at: NDArray[np.intp],
    orders: Whole,
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
