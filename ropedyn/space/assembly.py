"""Parts of a rope in space, each below its own resonances, joined by one band matrix.

With motion u at the nodes and force f at the right end of each part

    f_i-1 - F^T f_i + (Q + N) u_i = p_i,   u_i+1 - F u_i - G f_i = d_i

which exists where G is singular, and is symmetric.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.array import Complex, Flags, Index, Real
from ..base.chebyshev import weights
from ..base.computed import computed
from ..base.errors import SolveError
from .rope import Carried, Factors, SpaceRope, halvings, scaled_rates, size_of
from .samples import coefficients, series_of

Band = tuple[Complex, Complex, Complex, Complex, NDArray[np.uint8], bool]
"""D, G, Q, N, which rows stand for nothing, shape (n, size), and whether its ends are one node."""

ONE = np.zeros(1, dtype=np.intp)  # All six coordinates, of what is wound.
GENTLE = 0.9  # A joint's inverse is so far from 1; by 1 and more where a part has resonated.
MOST_PARTS = 100_000


@dataclass(frozen=True, eq=False)
class Assembly:
    """A rope at several lines, each scaled by its z.

    Attributes
    ----------
    D, G, Q : ndarray of complex, shape (n, parts, width, width)
        F = 1 + D.
    N : ndarray of complex, shape (n, parts + 1, width, width)
        Of the nodes.
    held : ndarray of bool, shape (n, parts + 1, width)
    absent : ndarray of bool, shape (n, width)
    node : ndarray of int, shape (pieces + 1,)
        Where the nodes of the rope are.
    z : ndarray, shape (n, width)
    known : ndarray, shape (3, n, parts)
        The least numbers whose roundings D, G and Q may be off by.
    doubt : ndarray, shape (n, parts + 1)
        What rounding may have done to N, where wires are carried.
    feet : tuple of Foot
        Of the wires.
    closed : bool
        Whether the last node is the first: nothing stands there.
    """

    D: Complex
    G: Complex
    Q: Complex
    N: Complex
    held: Flags
    absent: Flags
    node: Index
    z: Real
    known: Real
    doubt: Real
    feet: tuple[Foot, ...] = ()
    closed: bool = False

    @property
    def width(self) -> int:
        """How many coordinates move together."""
        return self.D.shape[2]

    @property
    def size(self) -> int:
        """How many rows the band has."""
        return (2 * self.parts + 1) * self.width

    @property
    def parts(self) -> int:
        """How many there are."""
        return self.D.shape[1]

    @computed
    def largest(self) -> tuple[Real, Real, Real, Real]:
        """The largest entries of D, G, Q and N of each part, with all they are off in roundings."""
        rounding = ROUNDINGS * np.finfo(float).eps
        D, G, Q, N = (np.abs(one).max((2, 3)) for one in (self.D, self.G, self.Q, self.N))
        D, G, Q = np.maximum((D, G, Q), self.known)
        return D, G, Q, N + self.doubt / rounding

    def shown(self, equal: int) -> Index:
        """Return the nodes at the ends of so many equal parts of each piece."""
        within = np.diff(self.node)[:, None] // equal * np.arange(equal)
        return np.append((self.node[:-1, None] + within).ravel(), self.node[-1])

    def together(self, u: Any, f: Any) -> Any:
        """Return rows in the order of the band, of (n, parts + 1 and parts, width, c)."""
        both = np.zeros((len(u), 2 * self.parts + 1, *u.shape[2:]), dtype=np.result_type(u, f))
        both[:, ::2], both[:, 1::2] = u, f
        return both.reshape(len(u), -1, u.shape[-1])

    def apart(self, x: Any) -> tuple[Any, Any]:
        """Return motion and force."""
        both = x.reshape(len(x), 2 * self.parts + 1, self.width, -1)
        return both[:, ::2], both[:, 1::2]

    @computed
    def band(self) -> Band:
        """What the core takes."""
        both = np.zeros((len(self.D), 2 * self.parts + 1, self.width), dtype=np.uint8)
        both[:, ::2], both[:, 1::2] = self.held, self.absent[:, None]
        both[:, -1] |= self.closed
        return self.D, self.G, self.Q, self.N, both.reshape(len(both), -1), self.closed

    def factored(self) -> Factored:
        """Return the real parts of all lines factored."""
        lu, pivot, failed = _core.space_factor(*self.band)
        if failed < len(lu):
            raise SolveError("singular")
        return Factored(self.band, lu, pivot)

    def respond(self, right: Any) -> Complex:
        """Return the solutions of columns (n, rows, columns), not finite where singular."""
        return _core.space_respond(*self.band, right.swapaxes(1, 2)).swapaxes(1, 2)

    def apply(self, x: Any) -> Complex:
        """Return A x of columns (n, rows, columns)."""
        return _core.space_apply(*self.band, x.swapaxes(1, 2)).swapaxes(1, 2)


@dataclass(frozen=True, eq=False)
class Factored:
    """Band matrices, factored."""

    band: Band
    lu: Any
    pivot: Any

    def solve(self, right: Any) -> Any:
        """Return the solutions of columns (n, rows, columns)."""
        x: Any = _core.space_solve(self.lu, self.pivot, right.swapaxes(1, 2))
        return x.swapaxes(1, 2)

    def iterated(self, x: Real, times: int) -> tuple[Real, Real, Real]:
        """Return columns (n, rows, columns) x <- Re(A)^-1 Im(A) x, x^T Re(A) x and x^T Im(A) x."""
        found, forms = _core.space_iterate(*self.band, self.lu, self.pivot, x.swapaxes(1, 2), times)
        return found.swapaxes(1, 2), forms[:, 0], forms[:, 1]


class SpaceParts(NamedTuple):
    """The parts of a component at each line, before anything stands between them."""

    matrices: Complex  # (3, n, distinct, width, width) D, G and Q
    alike: Index  # (distinct,) how many of each lie one after another
    node: Index  # (pieces + 1,) where pieces begin among all
    known: Real  # (3, n or 1, distinct) the least numbers whose roundings they are off by

    @property
    def every(self) -> tuple[Complex, Real]:
        """D, G and Q of all, and the least numbers whose roundings they are off by."""
        if (self.alike == 1).all():
            return self.matrices, self.known
        return self.matrices.repeat(self.alike, axis=2), self.known.repeat(self.alike, axis=2)


def parts_at(
    rope: SpaceRope, which: Index, factors: Factors, z: Real, equal: int = 1
) -> SpaceParts:
    """Return so many equal parts of each piece, or more, all below their resonances."""
    rates = scaled_rates(rope.rates(which, factors), z)
    size = size_of(rates).max(axis=(0, 2))
    triples, counts, alike = [], [], []
    for p, length in enumerate(rope.length.tolist()):
        one = np.ascontiguousarray(coefficients(rates[:, p]))
        halved = int(halvings(max(size[p] * length, rope.least_radians[p]) / equal))
        triple, count = parts_of(one, length, equal, halved)
        triples.append(triple)
        counts.append(count)
        alike.append([count] if triple.shape[1] == 1 else [1] * count)
        if sum(counts) > MOST_PARTS:
            raise SolveError("the waves are too short for the rope: more than 100000 parts")
    node = np.concatenate([[0], np.cumsum(counts)])
    matrices = np.empty((3, len(rates), sum(map(len, alike)), *rates.shape[-2:]), np.complex128)
    first = 0
    for triple, own in zip(triples, alike):
        last = first + len(own)
        matrices[:, :, first:last] = np.moveaxis(_spread(triple, len(own)), 2, 0)
        first = last
    return SpaceParts(matrices, np.concatenate(alike), node, np.zeros((3, 1, last)))


def assemble(
    rope: SpaceRope, which: Index, factors: Factors, z: Real, parts: SpaceParts | None = None
) -> Assembly:
    """Return a component at each line, of parts that are known or of as few as there may be.

    which : (n,) or (1,) where it is the same at all n lines.
    """
    parts = parts or parts_at(rope, which, factors, z)
    (D, G, Q), known = parts.every
    node = parts.node
    width, blocks = z.shape[1], rope.blocks
    for p in rope.kinks:
        # F R and R^T Q R of what begins with a kink
        first = node[p]
        turn = blocks.turn[which, p] * (z[:, None, :] / z[:, :, None]) - np.eye(width)
        back, own = turn.swapaxes(1, 2), Q[:, first]
        D[:, first] = turn + D[:, first] + D[:, first] @ turn
        Q[:, first] = own + back @ own + own @ turn + back @ own @ turn
    N = np.zeros((len(z), node[-1] + 1, width, width), dtype=np.complex128)
    N[:, node] = rope.nodes(which, factors) * (z[:, None, :, None] * z[:, None, None, :])
    doubt = np.zeros(N.shape[:2])
    feet = tuple(foot_of(wire, factors) for wire in rope.carried)
    for wire, foot in zip(rope.carried, feet):
        at = node[wire.node]
        N[:, at] += foot.stiffness * (z[:, :, None] * z[:, None, :])
        doubt[:, at] += SAFE * (foot.doubt * (z[:, :, None] * z[:, None, :])).max((1, 2))
    absent = np.broadcast_to(blocks.absent[which], z.shape)
    held = np.tile(absent[:, None], (1, node[-1] + 1, 1))
    held[:, node] |= blocks.held[which]
    return Assembly(D, G, Q, N, held, absent, node, z, known, doubt, feet, rope.closed)


class Foot(NamedTuple):
    """What a wire does to the node that carries it, and what rounding does to that."""

    stiffness: Complex  # (n, 6, 6) of the node's motion
    doubt: Real
    seen: Complex  # (n, 6) motion of its right end along its aim per motion of the node
    seen_doubt: Real


def foot_of(carried: Carried, factors: Factors) -> Foot:
    """Solve a wire whose left end moves by each coordinate, its right end free."""
    one = np.ones_like(factors.inertia)
    own = Factors(one + 1j * carried.loss * factors.loss, one, one, factors.inertia, 0 * one, one)
    z = carried.rope.scale(ONE, np.abs(factors.inertia))
    system = assemble(carried.rope, ONE, own, z)
    count, D, Q = len(z), system.D[:, 0], system.Q[:, 0]
    p = np.zeros((count, system.parts + 1, 6, 7), dtype=np.complex128)
    d = np.zeros((count, system.parts, 6, 7), dtype=np.complex128)
    # u_1 - G f_0 = F u_0 of the left end's motion, and a load along the aim
    d[:, 0, :, :6] = np.eye(6) + D
    p[:, -1, :, 6] = carried.aim * z
    u, f = system.apart(system.respond(system.together(p, d)))
    u[:, 0, :, :6] = np.eye(6)
    # f_-1 is what the left end asks for
    force = Q @ u[:, 0] - f[:, 0] - D.swapaxes(1, 2) @ f[:, 0]
    field = LoadedFields(u, f, p)
    off = bound(system, field, field)
    by = carried.arm / z[:, :, None]
    size = np.abs(by)
    return Foot(
        by.swapaxes(1, 2) @ force[:, :, :6] @ by,
        size.swapaxes(1, 2) @ off[:, :6, :6] @ size,
        ((carried.aim * z)[:, None] @ u[:, -1, :, :6] @ by)[:, 0],
        (off[:, 6:, :6] @ size)[:, 0],
    )


SAFE = 2.0  # Times what is told by numbers that are rounded themselves.
FAR = 1e8  # Times the loads: below that digits are left.
ROUNDINGS = 4.0  # Of entries of a part's matrices, in units of the largest one, scaled.


class LoadedFields(NamedTuple):
    """Motion and force of loads, columns (n, nodes or parts, width, columns)."""

    u: Any
    f: Any
    load: Any  # on nodes
    slip: Any = 0.0  # of the motion between parts

    def left(self, system: Assembly) -> tuple[Any, Any]:
        """Return what the matrix takes of the loads that is not there."""
        p, d = system.apart(system.apply(system.together(self.u, self.f)))
        return p - self.load, d - self.slip

    def lost(self, system: Assembly, right: Any) -> Flags:
        """Say at which lines (n,) some column has no right digit, of rows of loads (n, rows, c).

        That is where A is singular to rounding, and a load pushes what it does not hold.
        """
        x = system.together(self.u, self.f)
        with np.errstate(all="ignore"):
            far = ~(_largest(x) <= FAR * _largest(right))
            if far.any():
                # the work of the loads, and what rounding does to it
                off = np.diagonal(bound(system, self, self), axis1=1, axis2=2)
                far &= ~(off < np.abs((x * right).sum(1)))
        return np.asarray(far.any(1))


def _largest(x: Complex) -> Real:
    """Return the largest real or imaginary parts of columns (n, rows, columns)."""
    columns = np.ascontiguousarray(x.swapaxes(1, 2))
    return np.asarray(np.abs(columns.view(np.float64)).max(2))


def bound(system: Assembly, one: LoadedFields, other: LoadedFields) -> Real:
    """Bound x^T dA y and what solving left, shape (n, columns of one, of other)."""
    u, f, v, g = (np.linalg.norm(w, axis=2) for w in (one.u, one.f, other.u, other.f))
    D, G, Q, N = system.largest
    left, right = u[:, :-1], v[:, :-1]
    form = "lnd,ln,lnr->ldr"
    size = np.einsum(form, u, N, v) + np.einsum(form, left, Q, right) + np.einsum(form, f, G, g)
    size += np.einsum(form, f, 1 + D, right) + np.einsum(form, left, 1 + D, g)
    # the exchange of rows may fill what is as small as a rigid motion's inertia with roundings of 1
    p, d = (np.linalg.norm(w, axis=2) for w in one.left(system))
    missed = np.einsum("lnd,lnr->ldr", p, v) + np.einsum("lnd,lnr->ldr", d, g)
    limit: Real = ROUNDINGS * np.finfo(float).eps * size + SAFE * missed
    return limit


def parts_of(rates: Complex, length: float, equal: int, halved: int) -> tuple[Complex, int]:
    """Return triples (n, nodes, 3, width, width) of a piece, and how many parts they tell.

    They are so many equal ones, or halves and quarters of these where those are not below their own
    resonances.
    """
    series, reached, whole = series_of(length, halved, rates.shape[1], equal), halved, False
    while not whole:
        triple, reached, whole = _core.space_triples(
            rates, series, length, equal, halved, int(reached), GENTLE
        )
    return triple, equal << (halved - reached)


def _spread(triple: Complex, count: int) -> Complex:
    """Return so many parts, one or those that triples tell: the only one, these, or about nodes."""
    nodes = triple.shape[1]
    if nodes == 1 or count <= nodes:
        return triple[:, :count]
    # from the last node on, which is the left one
    places = weights(nodes, np.linspace(0.0, 1.0, count))[:, ::-1]
    found = places @ triple.reshape(len(triple), nodes, -1).view(np.float64)
    return np.asarray(found).view(np.complex128).reshape(len(triple), count, *triple.shape[2:])
