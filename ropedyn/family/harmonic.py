"""Responses of rows of spans, swept without a scene or a model for each."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from .. import _core
from ..base.array import Complex, Flags, Index, Real
from ..base.check import COORDINATES, NEAR
from ..base.unit import QUANTITIES
from ..chain.chain import CHANNELS, CONTINUOUS, Chain
from ..chain.compiled import Compiled
from ..chain.port import Point, Ports
from ..response.closed import closed_response
from ..response.question import damped_lines
from ..response.rounding import EPS, bound_of, relative
from ..response.solvers import SWEEP_SLICE
from ..scene import damping
from .closed import Component
from .rows import Filled


class Cut(NamedTuple):
    """Where points lie among the stations of some rows: new nodes stand at those between."""

    span: Index  # (spans,) of the component that each span of the cut one is part of
    whole: Flags  # (spans,) whether it is all of it
    station: Index  # (nodes,) of the component, -1 where a point is
    node: Index  # (points,)


@dataclass(frozen=True, eq=False)
class Asked:
    """A response, as all rows are asked for it."""

    frequency: Real  # (f,) [Hz]
    factor: Complex  # (5, f) as `damping.factors` gives them
    drives: tuple[Point, ...]
    responses: tuple[Point, ...]
    quantity: str
    several: bool  # whether a list of drives was asked for


def asked_of_rows(
    model: Compiled,
    frequency: Real,
    drives: tuple[Point, ...],
    responses: tuple[Point, ...],
    quantity: str,
    *,
    several: bool,
) -> Asked | None:
    """Return what rows of spans are asked for, None where that is more than motion by forces."""
    dampings = model.scene.dampings
    if damping.having(dampings, "ratio"):
        return None
    if any(p[0] not in COORDINATES for p in (*drives, *responses)):
        return None
    factor = np.ascontiguousarray(damping.factors(dampings, 2 * np.pi * frequency).T)
    return Asked(frequency, factor, drives, responses, quantity, several)


def closed_frf(components: Sequence[Component], asked: Asked, rows: Real) -> Filled:
    """Compute the responses of the rows of which every line is sure."""
    shape = (len(rows), len(asked.drives), len(asked.responses), len(asked.frequency))
    value, error = np.zeros(shape, dtype=np.complex128), np.zeros(shape)
    solved = np.ones(len(rows), dtype=np.bool_)
    for component in components:
        drives = [k for k, p in enumerate(asked.drives) if p[0] in component.coordinates]
        responses = [k for k, p in enumerate(asked.responses) if p[0] in component.coordinates]
        if drives and responses:
            block = np.ix_(drives, responses)
            for k, row in enumerate(_answers(component, asked, drives, responses, rows)):
                solved[k] &= row is not None
                if row is not None:
                    value[k][block], error[k][block] = row
    value *= (2j * np.pi * asked.frequency) ** QUANTITIES[asked.quantity]
    solved &= np.isfinite(value).all(axis=(1, 2, 3)) & ~np.isnan(error).any(axis=(1, 2, 3))
    kept = np.flatnonzero(solved)
    one = kept if asked.several else (kept, 0)
    return Filled(kept, (value[one], error[one]), {})


def _answers(
    component: Component, asked: Asked, drives: Sequence[int], responses: Sequence[int], rows: Real
) -> list[tuple[Complex, Real] | None]:
    """Return value and relative error of each row, None where another way has to be gone."""
    pushing, heard = [asked.drives[k] for k in drives], [asked.responses[k] for k in responses]
    number, factor = component.numbers(rows), asked.factor
    points = pushing, heard
    closed = closed_response(component.form, component.chain, number, factor, points)
    found: list[tuple[Complex, Real] | None] = [None] * len(rows)
    left: Flags = np.ones((len(rows), factor.shape[1]), dtype=np.bool_)
    if closed is not None:
        left = ~closed.certain
        found = list(zip(closed.value, closed.error))
    rest, at = np.flatnonzero(left.any(axis=1)), pushing + heard
    for which, cut, chains in _chains(component, np.array([p[1] for p in at]), number[rest]):
        ports = _ports(component, cut, at)
        parts = slice(None, len(drives)), slice(len(drives), None)
        pushed, watched = (Ports(ports.node[s], ports.row[s], None) for s in parts)
        column = [component.coordinates.index(p[0]) for p in at]
        for k, chain in zip(rest[which].tolist(), chains):
            lines = np.ascontiguousarray(factor[:, left[k]])
            held = chain.held[cut.node, column] != 0
            answer = _response(chain, lines, pushed, watched)
            if answer is not None:
                for array in answer:
                    array[held[: len(drives)]] = array[:, held[len(drives) :]] = 0
                left[k], found[k] = _joined(found[k], left[k], answer)
    return [None if some.any() else one for one, some in zip(found, left)]


def _joined(
    known: tuple[Complex, Real] | None, lines: Flags, answer: tuple[Complex, Real]
) -> tuple[bool, tuple[Complex, Real]]:
    """Put the answers of some lines among those that are known; nothing is left."""
    if known is None:
        return False, answer
    for whole, part in zip(known, answer):
        whole[..., lines] = part
    return False, known


def _ports(component: Component, cut: Cut, at: Sequence[Point]) -> Ports:
    """Return points at nodes as the core takes them: the last node is the right one of two."""
    last = cut.node == len(cut.station) - 1
    row = np.zeros((len(at), 2, len(component.coordinates)))
    for k, point in enumerate(at):
        row[k, int(last[k]), component.coordinates.index(point[0])] = 1.0
    return Ports((cut.node - last).astype(np.int32), row, None)


def _response(
    chain: Chain, factor: Complex, pushed: Ports, watched: Ports
) -> tuple[Complex, Real] | None:
    """Sweep over one row; None where a line has no answer or the waves are many."""
    count = factor.shape[1]
    if count == 0:
        return None
    highest = np.abs(factor[damping.INERTIA]).argmax()
    steps = _core.steps(chain, np.ascontiguousarray(factor[:, [highest]]))
    if steps * count > SWEEP_SLICE:
        return None
    value, _, solved = _core.sweep(chain, factor, pushed, watched)
    if solved < count:
        return None
    value.imag[..., ~damped_lines(chain, factor)] = 0.0  # only rounding is there
    error = bound_of(chain, factor, pushed, watched) + 2 * EPS * np.abs(value)
    return value, relative(value, error)


def _chains(
    component: Component, points: Real, number: Real
) -> Generator[tuple[Index, Cut, Generator[Chain]]]:
    """Return rows whose points lie alike among their stations, and the chains of these."""
    spans, stations = component.parted(number)
    length = spans[:, :, 0]
    x = np.hstack([np.zeros((len(number), 1)), np.cumsum(length, axis=1)])
    near = np.abs(x[:, None, :] - points[:, None]) <= NEAR * x[:, -1, None, None]
    left = (x[:, None, :] < points[:, None]).sum(axis=2)
    place = np.where(near.any(axis=2), near.argmax(axis=2), -left)
    sound = (length > 0).all(axis=1) & np.isfinite(spans).all(axis=(1, 2))
    sound &= (place > -x.shape[1]).all(axis=1) & (spans[:, :, 1:] > 0).all(axis=(1, 2))
    sound &= ~np.isneginf(stations).any(axis=(1, 2))
    patterns, which = np.unique(place, axis=0, return_inverse=True)
    for k, pattern in enumerate(patterns):
        these = np.flatnonzero((which.ravel() == k) & sound)
        if len(these):
            cut = _cut(pattern, points, x.shape[1] - 1)
            nodes = np.sort(np.hstack([x[these], np.tile(_new(pattern, points), (len(these), 1))]))
            yield these, cut, _stacked(component, cut, nodes, spans[these], stations[these])


def _new(pattern: Index, points: Real) -> Real:
    """Return where new nodes stand."""
    return np.unique(points[pattern < 0])


def _cut(pattern: Index, points: Real, spans: int) -> Cut:
    """Put nodes where points lie between stations."""
    new = _new(pattern, points)
    left = np.array([-pattern[points == at][0] for at in new], dtype=np.intp)
    station = np.insert(np.arange(spans + 1), left, -1)
    begins = np.insert(np.arange(spans + 1), left, left - 1)[:-1]
    node = np.where(
        pattern < 0,
        np.flatnonzero(station < 0)[np.searchsorted(new, points).clip(max=max(len(new) - 1, 0))]
        if len(new)
        else 0,
        np.flatnonzero(station >= 0)[np.maximum(pattern, 0)],
    )
    return Cut(begins, np.bincount(begins)[begins] == 1, station, node)


def _stacked(
    component: Component, cut: Cut, x: Real, spans: Real, stations: Real
) -> Generator[Chain]:
    """Return the chain of each row."""
    base, width, rows = component.chain, len(component.coordinates), len(x)
    own = spans[:, cut.span]
    length = np.where(cut.whole, own[:, :, 0], np.diff(x, axis=1))
    own_roles = component.spans.coordinates
    channel = CHANNELS[own_roles[-1]]
    flexibility = np.zeros((rows, len(cut.span), 3, 3))
    tension = own[:, :, 2] if "z" in own_roles else np.zeros_like(length)
    if own_roles != ("z",):
        flexibility[:, :, channel, channel] = 1 / own[:, :, -1]
    inertia = np.zeros((rows, len(cut.span), width))
    inertia[:, :, 0] = own[:, :, 1]
    there = np.where(cut.station >= 0, cut.station, 0)
    at = np.where((cut.station >= 0)[:, None], stations[:, there], 0.0)
    held = np.isinf(at[:, :, width:])
    mass, stiffness = (np.zeros((rows, len(there), width, width)) for _ in range(2))
    for k in range(width):
        mass[:, :, k, k] = at[:, :, k]
        stiffness[:, :, k, k] = np.where(held[:, :, k], 0.0, at[:, :, width + k])
    nodes = np.arange(len(there), dtype=np.int32)
    dashpots = None if base.damping is None else base.damping[base.term][there]
    if dashpots is not None:
        dashpots[cut.station < 0] = 0.0
    hinge = None if base.hinge is None else base.hinge[base.term][there]
    if hinge is not None:
        hinge[cut.station < 0] = 0.0
    drag = None if base.drag is None else base.drag[base.element][cut.span]
    common = base._replace(
        kind=CONTINUOUS, first=nodes, element=nodes[:-1], term=nodes, hinge=hinge, drag=drag
    )._replace(damping=dashpots)
    stacks = tension, flexibility, mass, stiffness, held.astype(np.uint8), inertia
    names = ("tension", "flexibility", "mass", "stiffness", "held", "inertia")
    for k in range(rows):
        yield common._replace(length=length[k], **dict(zip(names, [one[k] for one in stacks])))
