"""Shapes of damped modes, from what the response has on circles around their rates."""

from __future__ import annotations

import numpy as np

from ... import _core
from ...base.array import Complex, Index, Integer, Real
from ...base.errors import SolveError
from ...chain.chain import Chain
from ...chain.port import Ports
from ...signal.contour import clusters
from .damped_roots import Damped
from .rates import Rates

SAMPLES = 8  # The circle around a rate has so many points.
CIRCLE = 0.02
"""Radius of a circle in distances to the next rate: what lies outside shows as CIRCLE^SAMPLES."""
ALIKE = 1e3
"""Rates nearer to each other than so many times their errors have their residues together."""
MOST_NUMBERS = 1 << 20  # So many numbers of the response are computed at a time.
PLACES = 16  # The rope is pushed at so many places, to find where a mode moves.
GOLDEN = 0.6180339887498949
"""Multiples of the golden ratio, without whole turns, are spread evenly."""


def motions(chain: Chain, damped: Damped, wanted: Index) -> Complex:
    """Return motions phi with phi^T D'(s) phi = 1, or twice that where s = 0 twice."""
    # the dynamic stiffness D has D(s)^-1 = phi phi^T/(s - s_k) + .., so the mean of D^-1 t over a
    # circle s_k + t is phi phi^T, of all rates in it together
    value, error, rates = damped.value, damped.error, damped.rates
    motion = np.zeros((len(value), chain.nodes, chain.held.shape[1]), dtype=np.complex128)
    groups = [g for g in _groups(value, error) if np.isin(g, wanted).any()]
    if not groups:
        return motion[wanted]
    radius = np.array([_room(value, group, damped) for group in groups]) * CIRCLE
    offset = radius[:, None] * np.exp(2j * np.pi * np.arange(SAMPLES) / SAMPLES)
    circle = np.array([value[group].mean() for group in groups])[:, None] + offset
    probes = _ports(chain, _probes(chain))
    tried = _response(chain, rates, circle, probes, probes)
    driven: dict[tuple[int, ...], list[int]] = {}
    inverse: list[Complex] = []
    for k, group in enumerate(groups):
        offset[k] **= 1 + (value[group] == 0).any()  # s^2 M of rigid motion
        seen = tried[:, :, k] * offset[k]
        residue, largest = seen.mean(axis=2), np.abs(seen).max(axis=2).diagonal()
        pushed = _pivots(residue, largest, len(group))
        root = np.linalg.inv(_root(residue[np.ix_(pushed, pushed)]))
        inverse.append(np.asarray(root[: len(group)], dtype=np.complex128))
        driven.setdefault(pushed, []).append(k)
    for pushed, members in driven.items():
        drives = Ports(probes.node[list(pushed)], probes.row[list(pushed)], None)
        step = max(1, MOST_NUMBERS // (len(pushed) * len(members) * SAMPLES * motion.shape[2]))
        for first in range(0, chain.nodes, step):
            nodes = np.arange(first, min(first + step, chain.nodes))
            far = _response(chain, rates, circle[members], drives, _ports(chain, nodes))
            for i, k in enumerate(members):
                phi = inverse[k] @ (far[:, :, i] * offset[k]).mean(axis=2)
                motion[np.ix_(groups[k], nodes)] = phi.reshape(len(phi), len(nodes), -1)
    return motion[wanted]


def _groups(value: Complex, error: Real) -> list[Index]:
    """Gather rates that are not told apart."""
    near = np.abs(value[:, None] - value[None, :]) <= ALIKE * (error[:, None] + error[None, :])
    return clusters(near)


def _room(value: Complex, group: Index, damped: Damped) -> float:
    """Return the distance of a group to all other rates and to what was not searched."""
    others = np.concatenate([np.delete(value, group), damped.nearby])
    center = value[group].mean()
    others = others[np.abs(others - center) > damped.error[group].max()]
    nearest = float(np.abs(others - center).min(initial=np.inf))
    middle, radius = damped.circle
    return min(nearest, radius - abs(center - middle))


def _probes(chain: Chain) -> Integer:
    """Return the ends of a chain, some nodes spread along it and those that carry structures."""
    last = chain.nodes - 1
    inside = np.rint(spread(PLACES) * last).astype(np.int64)
    return np.unique(np.concatenate([[0, last], inside, chain.feet[chain.feet >= 0]]))


def spread(count: int) -> Real:
    """Return so many places that are spread evenly, over the length."""
    return np.asarray(np.arange(1, count + 1) * GOLDEN % 1.0)


def _ports(chain: Chain, nodes: Integer) -> Ports:
    """Return every coordinate of these nodes, one after another."""
    width = chain.held.shape[1]
    left = np.minimum(nodes, chain.nodes - 2)
    row = np.zeros((len(nodes), width, 2, width))
    for k in range(width):
        row[np.arange(len(nodes)), k, nodes - left, k] = 1.0
    return Ports(
        np.repeat(left, width).astype(np.int32), row.reshape(len(nodes) * width, 2, width), None
    )


def _response(chain: Chain, rates: Rates, s: Complex, drives: Ports, responses: Ports) -> Complex:
    """Return D(s)^-1, shape (drives, responses, *s.shape)."""
    factor = np.ascontiguousarray(rates.at(s.ravel()))
    value, _, solved = _core.sweep(chain, factor, drives, responses)
    if solved < s.size:
        raise SolveError(f"the damped mode near s = {s.ravel()[solved]:.6g} rad/s has no shape")
    return value.reshape(*value.shape[:2], *s.shape)


def _pivots(residue: Complex, largest: Real, count: int) -> tuple[int, ...]:
    """Return the drives that show so many modes best."""
    # those with the largest pivots in the elimination of the residues, each compared with all that
    # the response has on the circle, because drives have different units
    rest, chosen = residue.copy(), []
    for _ in range(count):
        pivot = np.abs(rest.diagonal())
        at = int(np.divide(pivot, largest, out=np.zeros_like(pivot), where=largest > 0).argmax())
        if pivot[at] == 0:
            break
        chosen.append(at)
        rest = rest - np.multiply.outer(rest[:, at], rest[at, :]) / rest[at, at]
        rest[at, :] = rest[:, at] = 0.0
    return tuple(chosen)


def _root(square: Complex) -> Complex:
    """Return C with C C^T = square, by Cholesky's steps without conjugates."""
    C = np.zeros_like(square)
    rest = square.copy()
    for k in range(len(square)):
        C[k:, k] = rest[k:, k] / np.sqrt(rest[k, k])
        rest -= np.multiply.outer(C[:, k], C[:, k])
    return C
