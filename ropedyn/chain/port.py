"""Where a rope is pushed and watched, as rows over a compiled chain."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.array import Real
from ..base.check import NEAR
from ..base.errors import SolveError
from ..base.unit import END, OF_FORCE
from .chain import CHANNELS, PLANE, Chain

MOST_PIECES = 1000  # That a compressed element is cut into.

Point = tuple[str, float]


class Ports(NamedTuple):
    """Points as the core takes them; see csrc/chain/ports.h."""

    node: NDArray[np.int32]  # (points,) left node
    row: Real  # (points, 2, width) displacement per displacement of the nodes
    force: Real | None
    """(points, width) share of the internal force at the right end of the element, or None."""

    def part(self, rows: slice) -> Ports:
        """Return some of the points."""
        force = None if self.force is None else self.force[rows]
        return Ports(self.node[rows], self.row[rows], force)


def is_force(point: Point) -> bool:
    """Whether the point asks for an internal force such as ("F_z", 0.3)."""
    return point[0] in OF_FORCE


def moving(point: tuple[Any, ...]) -> str:
    """Return the coordinate of a point or an end, of an internal force the one it belongs to."""
    name = str(point[2] if point[0] == END else point[0])
    return OF_FORCE.get(name, name)


def locate(x: Real, at: float) -> tuple[int, float | None]:
    """Return the node at a position and None, or the node left of it and the distance [m]."""
    right = int(x.searchsorted(at))
    margin = NEAR * float(x[-1])
    for node in (right, right - 1):
        if 0 <= node < len(x) and abs(x[node] - at) <= margin:
            return node, None
    return right - 1, float(at - x[right - 1])


def is_held(chain: Chain, x: Real, coordinates: Sequence[str], point: Point) -> bool:
    """Whether a point cannot move."""
    node, inside = locate(x, point[1])
    at = list(coordinates).index(moving(point))
    return inside is None and bool(chain.held[chain.term[chain.stretch(node)], at])


def ports(chain: Chain, x: Real, coordinates: Sequence[str], points: Iterable[Point]) -> Ports:
    """Return the rows of points."""
    points = list(points)
    node = np.zeros(len(points), dtype=np.int32)
    row = np.zeros((len(points), 2, len(coordinates)))
    force = np.zeros((len(points), len(coordinates)))
    for k, point in enumerate(points):
        at = list(coordinates).index(moving(point))
        left, s = locate(x, point[1])
        if is_force(point):
            node[k], force[k, at] = left - 1, 1.0
        elif s is None:
            last = left == len(x) - 1
            node[k] = left - last
            row[k, int(last), at] = 1.0
        else:
            node[k] = left
            row[k] = chain.shape(left, s, at)
    return Ports(node, row, force if force.any() else None)


def local(
    chain: Chain,
    x: Real,
    coordinates: Sequence[str],
    pushed: Point,
    watched: Point,
) -> float:
    """Return the flexibility inside one element between two points in it, 0 for all others."""
    (left, p), (other, s) = locate(x, pushed[1]), locate(x, watched[1])
    if p is None or s is None or left != other or is_force(watched):
        return 0.0
    inside = _core.local(chain, left, s, p)
    return float(inside[coordinates.index(watched[0]), coordinates.index(pushed[0])])


def stops(chain: Chain, x: Real) -> list[float]:
    """Return where tensed elements are cut so that none is near its own critical load.

    Under compression an element of kappa l = pi/2, kappa^2 = |T| S_bb, buckles as a cantilever
    though the rope may not: F, G and Q have no digits around it. Pieces have kappa l <= 1.
    """
    if PLANE.index("beta") not in chain.coordinate:
        return []
    with np.errstate(over="ignore"):
        soft = np.einsum("eii->ei", chain.flexibility)[:, CHANNELS["beta"] :].max(axis=1)
        kappa = np.sqrt(np.maximum(-chain.tension * soft, 0.0))
        each = np.ceil(kappa * chain.length)
    if not each.max() <= MOST_PIECES:
        raise SolveError(
            f"the compression bends an element in {each.max() / np.pi:.3g} half waves, more than "
            f"{MOST_PIECES}: use more elements"
        )
    pieces = each.astype(np.intp)[chain.element_of]
    return [
        float(at)
        for e in np.flatnonzero(pieces > 1)
        for at in np.linspace(x[e], x[e + 1], pieces[e] + 1)[1:-1]
    ]


def cut(chain: Chain, x: Real, positions: Iterable[float]) -> tuple[Chain, Real]:
    """Put nodes without mass at positions inside elements.

    Two tensed or continuous elements joined there are the one they came from: no other answer
    changes.
    """
    inside = sorted(at for at in set(positions) if locate(x, at)[1] is not None)
    if not inside:
        return chain, x
    left = x.searchsorted(inside) - 1
    nodes = np.concatenate([x, inside])
    nodes.sort()
    # stretches begin where they did, at both ends of an element that is cut, and at new nodes
    old = np.concatenate([chain.first, left, left + 1])
    old.sort()
    old = old[np.concatenate([[True], old[1:] != old[:-1]])]
    stretch = chain.first.searchsorted(old, side="right") - 1
    start = np.concatenate([old + left.searchsorted(old), left + 1 + np.arange(len(left))])
    order = start.argsort()
    new_term = np.full(len(left), len(chain.mass))
    around = chain.first.searchsorted(left, side="right") - 1
    term = np.concatenate([chain.term[stretch], new_term])[order]
    element = np.concatenate([chain.element, [0]])[np.concatenate([stretch, around])][order]
    is_cut = np.zeros(len(old) + len(left), dtype=np.bool_)
    is_cut[old.searchsorted(left)] = is_cut[len(old) :] = True
    pieces = is_cut[order].nonzero()[0]
    first, source = start[order], element[pieces]
    element[pieces] = len(chain.length) + np.arange(len(pieces))
    width = chain.mass.shape[1]
    none = np.zeros((1, width, width))
    closed = np.zeros((1, width))
    start, stop = nodes[first[pieces]], nodes[first[pieces] + 1]
    tension, rise = chain.tension[source], None
    if chain.rise is not None:
        begin = x[np.searchsorted(x, start, side="right") - 1]
        tension, rise = parted(chain, source, start - begin, stop - begin)
    return chain._replace(
        length=np.concatenate([chain.length, stop - start]),
        tension=np.concatenate([chain.tension, tension]),
        flexibility=np.concatenate([chain.flexibility, chain.flexibility[source]]),
        first=first.astype(np.int32),
        element=element[:-1].astype(np.int32),
        mass=np.concatenate([chain.mass, none]),
        stiffness=np.concatenate([chain.stiffness, none]),
        held=np.concatenate([chain.held, np.zeros((1, width), dtype=np.uint8)]),
        term=term.astype(np.int32),
        hinge=None if chain.hinge is None else np.concatenate([chain.hinge, closed]),
        inertia=_repeated(chain.inertia, source),
        damping=None if chain.damping is None else np.concatenate([chain.damping, none]),
        drag=_repeated(chain.drag, source),
        sag=_repeated(chain.sag, source),
        rise=rise if chain.rise is None else np.concatenate([chain.rise, rise]),
    ), nodes


def parted(chain: Chain, source: NDArray[np.int32], start: Real, stop: Real) -> tuple[Real, Real]:
    """Return the mean tension, and how it grows, of parts of elements from start to stop."""
    assert chain.rise is not None
    length, own = chain.length[source], chain.rise[source]
    left = chain.tension[source] - own / 2 + own * (start / length)
    right = chain.tension[source] + own / 2 - own * ((length - stop) / length)
    return (left + right) / 2, right - left


def _repeated(array: Real | None, source: NDArray[np.int32]) -> Real | None:
    """Append those rows of an array of the distinct elements again."""
    return None if array is None else np.concatenate([array, array[source]])
