"""How far rounding moved eigenvalues: the same roots in wider numbers; see docs/theory/errors.md.

Near eigenvalues lambda_k the motion H = C^T D^-1 C that loads C cause at themselves has the poles
C^T x x^T C/(lambda_k - lambda), so that of as many loads as there are eigenvalues near each other
H^-1 is linear there, and its zeros are the eigenvalues.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..base.array import Index, Real
from ..chain.chain import Chain
from ..chain.compiled import EXACT, Compiled
from ..chain.port import cut, stops
from ..chain.wide import (
    FINE,
    SEEDS,
    SPARE,
    SURE,
    Number,
    as_real,
    moved,
    narrow,
    of_steep,
    rescaled,
    wide_of,
)
from ..chain.wide_parts import inverse
from ..chain.witness import Loads, respond
from .spectrum import error_in_hertz, in_hertz, spectrum

Array = Any

EPS = float(np.finfo(float).eps)
HERTZ = 1.25 * EPS  # Rounding of sqrt(lambda)/2 pi: half of eps each, and 0.18 eps of 2 pi itself.
BESIDE = 2.0**-34  # So far beside an eigenvalue H is looked at, of its size,
WIDER = 64.0  # or so many times as far as it may be wrong.
NEARER = 2.0**-44  # The second time, of their size.
SETTLED = (
    0.25  # Both times say the same but for this part of how near it is looked the second time.
)
APART = 256.0  # Eigenvalues nearer than so many times that are found together,
MOST = 4  # as many as these.
FRACTIONS = (0.2361, 0.5698, 0.8541)  # Where elements are cut to be pushed within.
PUSHED = 3  # Nodes within a run of equal elements that are pushed.


class SoughtRoots(NamedTuple):
    """Eigenvalues of one component, and what they are to be found with."""

    value: Array  # (k,) lambda, or s of damped motion
    error: Real  # (k,) bound of their error
    factors: Callable[[Array], Array]  # of (n,) values, in wide numbers, (5, n)


Motion = Callable[[Array], Array | None]  # H at some values.


def measured(model: Compiled, component: tuple[str, ...], asked: SoughtRoots) -> Real:
    """Return how far eigenvalues are from those in wider numbers, NaN where these do not tell."""
    found = np.full(len(asked.value), np.nan)
    wide = wide_of(model) if len(found) else None
    if wide is None:
        return found
    chain, x = wide.chain.only(component), wide.x
    chain = chain.undamped if not np.iscomplexobj(asked.value) else chain
    if model.element in EXACT:
        fractions = FRACTIONS if model.element == "continuous" else ()
        inside = [float(at) for part in fractions for at in x[:-1] + part * np.diff(x)]
        chain, x = cut(chain, x, [*inside, *stops(narrow(chain), x.astype(float))])
    size = np.abs(asked.value)
    beside = np.maximum(BESIDE * size, WIDER * asked.error)
    sure = (size > 0) & (beside < size / APART)
    groups = [g for g in _groups(asked.value, beside) if sure[g].all() and len(g) <= MOST]
    if not groups:
        return found
    roots = []
    for seed in (None, *SEEDS):
        own = chain if seed is None else wide.moved(chain, seed)
        factors, loads = _moved(asked.factors, seed), _loads(chain, MOST + 1)
        motion = partial(_motion, own, _units(chain, seed), loads, factors)
        with np.errstate(all="ignore"):
            one = _roots(motion, asked.value, beside, groups)
        if one is None:
            return found
        roots.append(one)
    at = np.concatenate(groups)
    noise = np.max([np.abs(other[at] - roots[0][at]) for other in roots[1:]], axis=0)
    off = np.abs(roots[0][at])
    error = ((1 + SPARE) * off + SURE * noise).astype(float) + EPS / 2 * size[at]
    # what is not near is another root, and what wide numbers do not know is better bounded
    with np.errstate(invalid="ignore"):
        told = (SURE * noise < np.maximum(asked.error[at], EPS * size[at])) & (off <= beside[at])
    found[at] = np.where(told, error, np.nan)
    return found


def _groups(value: Array, beside: Real) -> list[Index]:
    """Return which values are near each other."""
    left, groups = set(range(len(value))), []
    while left:
        group, more = [], [left.pop()]
        while more:
            k = more.pop()
            group.append(k)
            near = [m for m in left if abs(value[m] - value[k]) < APART * max(beside[m], beside[k])]
            left.difference_update(near)
            more += near
        groups.append(np.array(sorted(group)))
    return groups


def _moved(factors: Callable[[Array], Array], seed: int | None) -> Callable[[Array], Array]:
    """Return factors that are a little off, the same at all values."""
    if seed is None:
        return factors
    # what is off of all factors alike moves no eigenvalue, of lambda that of itself
    random = np.random.default_rng(seed)
    off = moved(np.ones((5, 1), dtype=Number), FINE, random)
    return lambda value: factors(value) * off


def _units(chain: Chain, seed: int | None) -> Array:
    """Return by how much units are moved."""
    width = chain.held.shape[1]
    if seed is None:
        return np.ones((width, 1), dtype=Number)
    return rescaled(np.random.default_rng(seed), width)


def _roots(motion: Motion, value: Array, beside: Real, groups: list[Index]) -> Array | None:
    """Return eigenvalues less what they were said to be, NaN elsewhere."""
    is_real = not np.iscomplexobj(value)
    wide = value.astype(Number if is_real else np.result_type(Number, np.complex64))
    found = np.full(len(value), np.nan, dtype=wide.dtype)
    # all of a group at once, then each alone, and nearer
    centre = np.array([wide[g].mean() for g in groups])
    spread = [np.abs(value[g] - value[g[0]]).max() for g in groups]
    step = np.array([max(beside[g].max(), 4 * s) for g, s in zip(groups, spread)])
    pairs = _between(motion, centre, step)
    if pairs is None:
        return None
    for k, group in enumerate(groups):
        zeros = _zeros(*pairs[k], len(group))
        zeros = zeros[np.argsort(zeros.real, kind="stable")] * step[k] + centre[k]
        found[group[np.argsort(wide[group].real, kind="stable")]] = zeros.real if is_real else zeros
    at, own = np.concatenate(groups), [group for group in groups for _ in group]
    lost = ~np.isfinite(found[at])
    centre = np.where(lost, wide[at], found[at])
    step = NEARER * np.abs(centre).astype(float)
    pairs = _between(motion, centre, step)
    if pairs is None:
        return None
    told = np.full_like(found, np.nan)
    for k, m in enumerate(at):
        near = np.abs(found[own[k]] - centre[k]) < APART * step[k]
        zeros = _zeros(*pairs[k], max(1, int(near.sum())))
        nearest = zeros[np.abs(zeros).argmin()]
        # else two that are one, as at critical damping, or one that was not asked for is near
        if np.abs(nearest) <= SETTLED and not lost[k]:
            nearest = (nearest.real if is_real else nearest) * step[k]
            told[m] = centre[k] - wide[m] + nearest
    return told


def _between(motion: Motion, centre: Array, step: Real) -> list[tuple[Array, Array]] | None:
    """Return H a step below and a step above some values."""
    H = motion(np.concatenate([centre - step, centre + step]))
    if H is None:
        return None
    return list(zip(H[: len(centre)], H[len(centre) :]))


def _zeros(low: Array, high: Array, count: int) -> Array:
    """Return the zeros of so many rows of the inverse of H, where -1 and 1 are the ends."""
    # what the loads have of the eigenvalues between both ends is what changes most
    scale = 1 / np.sqrt(np.abs(np.diagonal(low)))
    weight = scale[:, None] * scale
    change = ((low - high) * weight).astype(complex)
    if not np.isfinite(change).all():
        return np.full(count, np.nan)
    U, _, V = np.linalg.svd(change)
    left, right = U[:, :count].conj().T, V[:count].conj().T
    # (A + B)/2 + t (B - A)/2, of inverses: in doubles, since what they tell is a small distance
    A, B = (inverse((left @ (one * weight) @ right)[None])[0] for one in (low, high))
    if count == 1:
        return np.array([(A + B) / (A - B)]).ravel()
    one, two = (A - B).astype(complex), (A + B).astype(complex)
    if not (np.isfinite(one).all() and np.isfinite(two).all()):
        return np.full(count, np.nan)
    try:
        found = np.linalg.eigvals(np.linalg.solve(one, two))
    except np.linalg.LinAlgError:  # of a double root both ends tell the same
        return np.full(count, np.nan)
    return found.astype(np.result_type(Number, 1j))


def _loads(chain: Chain, count: int) -> Loads:
    """Return forces on all sorts of nodes, in all coordinates."""
    nodes = {int(node) for node in chain.first}
    for begin, end in zip(chain.first[:-1].tolist(), chain.first[1:].tolist()):
        nodes |= set(np.linspace(begin, end, PUSHED + 2).astype(int).tolist())
    node = np.array(sorted(nodes))
    random = np.random.default_rng(len(node))
    row = random.uniform(0.5, 1.5, (len(node), chain.held.shape[1], count))
    row *= random.choice([-1.0, 1.0], row.shape)
    return Loads(node, row.astype(Number))


def _motion(
    chain: Chain, units: Array, loads: Loads, factors: Callable[[Array], Array], value: Array
) -> Array | None:
    """Return what loads move at themselves, (lines, loads, loads)."""
    factor, plain = factors(value), narrow(chain)
    scales = _core.scales(plain, np.ascontiguousarray(factor.astype(np.complex128)))
    z = 2.0 ** np.round(np.log2(scales)).astype(Number) * units
    # forces in the units of the middle line, in which all coordinates count alike
    unit = z[:, z.shape[1] // 2]
    own = loads._replace(row=loads.row / unit[:, None])
    with np.errstate(all="ignore"):
        found = respond(chain, as_real(factor), z, own, loads.node)
    if found is None:
        return None
    return np.einsum("niL,fnil->fLl", own.row, found.u)


def undamped_factors(value: Array) -> Array:
    """Return the factors at eigenvalues lambda."""
    one, none = np.ones_like(value), np.zeros_like(value)
    return np.stack([one, one, one, -value, none])


def _lowest(model: Compiled, component: tuple[str, ...], number: int) -> Real:
    """Return so many eigenvalues of a component."""
    return spectrum(model, component, number)[0]


def rounding_of(model: Compiled, which: Index, eigenvalue: Real, bound: Real) -> Real:
    """Return errors of undamped frequencies of components [Hz], by the bound where that is all."""
    error = bound.copy()
    for k, component in enumerate(model.components):
        mine = which == k
        sought = SoughtRoots(eigenvalue[mine], bound[mine], undamped_factors)
        told, limit = measured(model, component, sought), bound[mine]
        if np.isnan(told).any():
            lowest = partial(_lowest, component=component, number=int(mine.sum()))
            limit = limit + of_steep(model, eigenvalue[mine], lowest)
        error[mine] = np.where(np.isnan(told), limit, told)
    return error_in_hertz(eigenvalue, error) + HERTZ * np.abs(in_hertz(eigenvalue))
