"""How far rounding moves a response, to first order: see docs/theory/errors.md.

A response is a signed sum of energies of the fields of its drive and of a unit load on itself, and
its rounding eps times their sizes, in the scales u^ = u/z, f^ = f z of the sweep.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .. import _core
from ..base.array import Complex, Flags, Index, Real
from ..chain.chain import CHANNELS, CONTINUOUS, PLANE, Chain
from ..chain.port import Ports
from ..scene.damping import DASHPOT, INERTIA, SECTION, SPRING, TENSION

EPS, TINY = np.finfo(float).eps, np.finfo(float).tiny  # TINY: the smallest normal number.
OF_STATIONS, OF_WAVES, OF_NODES, OF_LOADS = 5.0, 2.0, 2.0, 1.0  # Roundings, by random lines.


class Stations(NamedTuple):
    """Where energies are looked at: ends of stretches, drives and responses."""

    node: Index  # (stations,)
    told: Ports  # motion of all, and the force to the left of all but the first
    load: Ports  # drives, then responses
    moved: Real  # (loads, stations, width) share of each coordinate in a load
    slipped: Real  # (loads, stations, width) the same of forces in the rope


def relative(value: Complex, error: Real) -> Real:
    """Return the relative error: 0 where both are 0, infinite where only the value is."""
    # below the smallest normal number digits vanish however small the error is
    size = np.abs(value)
    ratio = np.where(error == 0, 0.0, np.inf)
    np.divide(error + TINY, size, out=ratio, where=(size > 0) & (error > 0))
    return ratio


def stations_of(chain: Chain, load: Ports) -> Stations:
    """Find the stations of a chain for some loads."""
    width, last, one = chain.held.shape[1], chain.nodes - 1, np.arange(len(load.node))
    hits = [(load.node + k, np.abs(load.row[:, k])) for k in range(2)]
    if load.force is not None:
        hits += [(load.node + 1, np.abs(load.force))]
    met = [at[size.any(axis=1)] for at, size in hits]
    node = np.unique(np.concatenate([chain.first, *met])).astype(np.intp)
    moved, slipped = (np.zeros((len(one), len(node), width)) for _ in range(2))
    for k, (at, size) in enumerate(hits):
        share = slipped if k == 2 else moved
        share[one, np.searchsorted(node, at).clip(max=len(node) - 1)] += size
    unit, count = np.eye(width), len(node)
    row = np.zeros((2 * count - 1, width, 2, width))
    row[np.arange(count), :, (node == last).astype(int)] = unit
    force = np.zeros((2 * count - 1, width, width))
    force[count:] = unit
    left = np.concatenate([np.minimum(node, last - 1), node[1:] - 1]).astype(np.int32)
    told = Ports(left.repeat(width), row.reshape(-1, 2, width), force.reshape(-1, width))
    return Stations(node, told, load, moved, slipped)


def both(one: Ports, other: Ports) -> Ports:
    """Return the ports of both."""
    force = [np.zeros_like(p.row[:, 0]) if p.force is None else p.force for p in (one, other)]
    node, row = np.concatenate([one.node, other.node]), np.concatenate([one.row, other.row])
    return Ports(node, row, np.concatenate(force))


def bound_of(chain: Chain, factor: Complex, drives: Ports, responses: Ports) -> Real:
    """Bound what rounding does to the responses of a chain, (drives, responses, f)."""
    stations = stations_of(chain, both(drives, responses))
    d, r = slice(None, len(drives.node)), slice(len(drives.node), None)
    u, f = _fields(chain, stations, factor)
    z, size = _core.scales(chain, factor), np.abs(u)
    load, slip = stations.moved[..., None] * z, stations.slipped[..., None] / z
    node = _node_sizes(chain, stations.node, factor)
    taken = _added(node * size[:, :, None], axis=3)
    # to the right of a node the force is more by what the node takes
    moved, pulled = np.maximum(size / z, load), np.maximum((np.abs(f) + taken) * z, slip)
    here = _energies(moved, pulled, d, r)
    # coordinates that scatter together round by each other: by the mean of all, or that on top
    mean = _energies(_added(moved, axis=2), _added(pulled, axis=2), d, r) / len(z)
    wave = here + pulled[d, None] * pulled[r]
    turn = radians(chain, stations.node, factor)
    wave = np.maximum(wave[:, :, 1:], wave[:, :, :-1]) * turn
    # motion at one end times force at the other: by waves F - I is rounded, however small F is
    wave += np.minimum(turn, 1.0) * _across(moved, pulled, d, r)
    own = _added(here, axis=3)
    own = np.where(_mixes(chain, stations.node), own + mean, np.maximum(own, mean))
    energy = OF_STATIONS * np.sqrt(_added(own**2, axis=2))
    energy += OF_WAVES * _added(_added(wave, axis=3), axis=2)
    energy += OF_NODES * _added(_added(size[d, None] * taken[r], axis=3), axis=2)
    energy += OF_NODES * _of_structures(chain, stations.node, factor, u, len(drives.node))
    heavy = node.diagonal(axis1=1, axis2=2).transpose(0, 2, 1) * z**2
    heavy[np.isin(stations.node, chain.feet)] = np.inf
    lost = _added((load + slip) * (1 - 1 / (1 + heavy)), axis=2)
    around = _added(moved + pulled, axis=2)
    energy += OF_LOADS * _added(lost[d, None] * around[r] + around[d, None] * lost[r], axis=2)
    return np.where(np.isfinite(energy), EPS * chain.section_loss * energy, np.inf)


def bound_of_structures(chain: Chain, factor: Complex, drives: Ports, responses: Ports) -> Real:
    """Bound what rounding of structures alone does, near frequencies of their own much."""
    stations = stations_of(chain, both(drives, responses))
    u, _ = _fields(chain, stations, factor)
    energy = OF_NODES * _of_structures(chain, stations.node, factor, u, len(drives.node))
    return np.where(np.isfinite(energy), EPS * energy, np.inf)


def _energies(moved: Real, pulled: Real, drives: slice, responses: slice) -> Real:
    """Return sizes of what the fields of drives and responses do to each other at stations."""
    both_of = moved[responses] + pulled[responses]
    return moved[drives, None] * both_of + pulled[drives, None] * moved[responses]


def _across(moved: Real, pulled: Real, drives: slice, responses: slice) -> Real:
    """Return sizes of what fields at one end of stretches do to those at the other."""
    left, right = np.s_[:, :-1], np.s_[:, 1:]
    sizes = []
    for one, other in ((left, right), (right, left)):
        sizes.append(moved[one][drives, None] * pulled[other][responses])
        sizes.append(pulled[one][drives, None] * moved[other][responses])
    return _added(np.stack(sizes), axis=0)


def _mixes(chain: Chain, node: Index) -> Flags:
    """Say where one coordinate is made of others: in coupled sections, at hinges, (stations, 1)."""
    own = np.eye(chain.flexibility.shape[1])
    coupled = np.full((len(node), 1), (chain.flexibility * (1 - own)).any())
    if chain.hinge is None:
        return coupled
    opens = chain.hinge[chain.term_of[node]] > 0
    return np.asarray(coupled | np.logical_or.reduce(opens, axis=1, keepdims=True))


def _added(terms: Real, axis: int) -> Real:
    """Return the sum along an axis, in an order that the number of lines does not change."""
    return sum(np.moveaxis(terms, axis, 0), start=np.zeros(()))


def _fields(chain: Chain, stations: Stations, factor: Complex) -> tuple[Complex, Complex]:
    """Return motion, and forces to the left of stations, (loads, stations, width, f)."""
    value = _core.sweep(chain, factor, stations.load, stations.told)[0]
    count, width = len(stations.node), chain.held.shape[1]
    told = value.reshape(len(value), 2 * count - 1, width, -1)
    u, f = told[:, :count], np.zeros_like(told[:, :count])
    f[:, 1:] = told[:, count:]
    u[:, chain.held[chain.term_of[stations.node]].astype(np.bool_)] = 0.0
    return u, f


def _node_sizes(chain: Chain, node: Index, factor: Complex) -> Real:
    """Return sizes of the stiffness of nodes, (stations, width, width, f)."""
    size, term = np.abs(factor), chain.term_of[node]
    total = np.abs(chain.stiffness[term])[..., None] * size[SPRING]
    total += np.abs(chain.mass[term])[..., None] * size[INERTIA]
    if chain.damping is not None:
        total += np.abs(chain.damping[term])[..., None] * size[DASHPOT]
    return total


def _of_structures(chain: Chain, node: Index, factor: Complex, u: Complex, drives: int) -> Real:
    """Add up the energies in structures that nodes carry, (drives, responses, f)."""
    loads, count = len(u), factor.shape[1]
    if chain.attached_kind is None:
        return np.zeros((drives, loads - drives, count))
    pair = np.indices((drives, loads - drives)).reshape(2, -1).T + np.array([0, drives])
    told = 2 if chain.kind == CONTINUOUS else 1
    field = np.zeros((loads, chain.nodes, told, u.shape[2], count), dtype=np.complex128)
    field[:, node, 0] = u
    none = np.full((loads, 3), [-1, 0, 0], dtype=np.int32)
    number, _ = _core.carried_pair_slopes(
        chain, factor, field.reshape(loads, -1, count), pair.astype(np.int32), none
    )
    size = np.abs(number[:, :, 0] * factor[INERTIA]) + np.abs(number[:, :, 1])
    return _added(size, axis=1).reshape(drives, loads - drives, count)


def radians(chain: Chain, node: Index, factor: Complex) -> Real:
    """Bound how far waves turn or fade between nodes, (nodes - 1, width, f)."""
    # of B d^4 z - T d^2 z = q z: |k|^2 <= sqrt((T/2B)^2 + q/B) + |T/2B|
    first, size = node[:-1], np.abs(factor)
    element, apart = chain.element_of[first], np.diff(node)
    load = _loads(chain, first, apart, factor)
    names = [PLANE[k] for k in chain.coordinate]
    pull = np.abs(chain.tension[element])[:, None] * size[TENSION]
    turn = np.zeros(load.shape)
    for k, name in enumerate(names):
        own = chain.flexibility[element, CHANNELS[name], CHANNELS[name]]
        soft = own[:, None] / size[SECTION]
        if "beta" in names and name in ("z", "beta"):
            half, q = 0.5 * pull * soft, load[:, names.index("z")] if "z" in names else 0.0
            turn[:, k] = np.sqrt(np.hypot(half, np.sqrt(q * soft)) + half)
        else:
            turn[:, k] = np.sqrt(load[:, k] / pull if name == "z" else load[:, k] * soft)
    x = np.append(0.0, np.cumsum(chain.length[chain.element_of]))
    turn *= np.diff(x[node])[:, None, None]
    return turn if chain.kind == CONTINUOUS else np.minimum(turn, np.pi * apart[:, None, None])


def _loads(chain: Chain, first: Index, apart: Index, factor: Complex) -> Real:
    """Return what moves of the rope right of nodes, per length, (stations - 1, width, f)."""
    element = chain.element_of[first]
    if chain.inertia is not None:
        load = chain.inertia[element][..., None] * factor[INERTIA]
        if chain.drag is not None:
            load = load + chain.drag[element][..., None] * factor[DASHPOT]
        return np.abs(load)
    mass = np.einsum("nii->ni", chain.mass)[chain.term_of[first + 1]] * (apart > 1)[:, None]
    return (mass / chain.length[element][:, None])[..., None] * np.abs(factor[INERTIA])
