"""Parts of a rope in space, each below its own resonances, joined by one band matrix.

With motion u at the nodes and force f at the right end of each part

    f_i-1 - F^T f_i + (Q + N) u_i = p_i,   u_i+1 - F u_i - G f_i = d_i

which exists where G is singular, and is symmetric.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..base.array import Complex, Flags, Index, Real
from ..base.computed import computed
from ..base.errors import SolveError
from .rope import Carried, Factors, SpaceRope, halvings, scaled_rates, size_of
from .samples import coefficients, series_of

GENTLE = 1.5  # The largest entry of a joint's inverse within a part.
MOST_PARTS = 100_000


@dataclass(frozen=True, eq=False)
class Assembly:
    """A rope at several lines, each scaled by its z.

    Attributes
    ----------
    D, G, Q : ndarray of complex, shape (n, parts, 6, 6)
        F = 1 + D.
    N : ndarray of complex, shape (n, parts + 1, 6, 6)
        Of the nodes.
    held : ndarray of bool, shape (parts + 1, 6)
    absent : ndarray of bool, shape (6,)
    node : ndarray of int, shape (pieces + 1,)
        Where the nodes of the rope are.
    inner : ndarray of int, optional
        Where those of equal parts are, if the rope was divided for them.
    z : ndarray, shape (n, 6)
    doubt : ndarray, shape (n, parts + 1)
        What rounding may have done to N, where wires are carried.
    """

    D: Complex
    G: Complex
    Q: Complex
    N: Complex
    held: Flags
    absent: Flags
    node: Index
    z: Real
    doubt: Real
    inner: Index | None = None

    @property
    def parts(self) -> int:
        """How many there are."""
        return self.D.shape[1]

    @computed
    def largest(self) -> tuple[Real, Real, Real, Real]:
        """Entries of D, G, Q and N, the largest of each part; N with its doubt in roundings."""
        D, G, Q, N = (np.abs(one).max((2, 3)) for one in (self.D, self.G, self.Q, self.N))
        return D, G, Q, N + self.doubt / (ROUNDINGS * np.finfo(float).eps)

    def shown(self, equal: int) -> Index:
        """Return the nodes at the ends of so many equal parts of each piece."""
        if self.inner is not None:
            return self.inner
        within = np.diff(self.node)[:, None] // equal * np.arange(equal)
        return np.append((self.node[:-1, None] + within).ravel(), self.node[-1])

    @computed
    def real(self) -> Blocks:
        """What multiplies real vectors, the real part."""
        D, G, Q, N = (np.ascontiguousarray(a.real) for a in (self.D, self.G, self.Q, self.N))
        return Blocks(D, G, Q, N, self.held, 1.0)

    @computed
    def imag(self) -> Blocks:
        """The imaginary part."""
        D, G, Q, N = (np.ascontiguousarray(a.imag) for a in (self.D, self.G, self.Q, self.N))
        return Blocks(D, G, Q, N, self.held, 0.0)

    def together(self, u: Any, f: Any) -> Any:
        """Return rows in the order of the band, from (n, parts + 1, 6, c) and (n, parts, 6, c)."""
        both = np.zeros((len(u), 2 * self.parts + 1, *u.shape[2:]), dtype=np.result_type(u, f))
        both[:, ::2], both[:, 1::2] = u, f
        return both.reshape(len(u), -1, u.shape[-1])

    def apart(self, x: Any) -> tuple[Any, Any]:
        """Return motion and force."""
        both = x.reshape(len(x), 2 * self.parts + 1, 6, -1)
        return both[:, ::2], both[:, 1::2]

    def factored(self, *, real: bool = False) -> Factored:
        """Return all lines factored."""
        D, G, Q, N = self.real[:4] if real else (self.D, self.G, self.Q, self.N)
        fixed = np.zeros((2 * self.parts + 1, 6), dtype=np.uint8)
        fixed[::2], fixed[1::2] = self.held, self.absent
        lu, pivot, failed = _core.space_factor(D, G, Q, N, fixed.ravel())
        if failed < len(lu):
            raise Singular(failed)
        return Factored(lu, pivot)


class Blocks(NamedTuple):
    """Real matrices of the parts, and what stands beside D."""

    D: Real
    G: Real
    Q: Real
    N: Real
    held: Flags
    one: float

    def apply(self, u: Real, f: Real) -> tuple[Real, Real]:
        """Return p and d of motion (n, parts + 1, 6, columns) and force (n, parts, 6, columns)."""
        d = -(self.D @ u[:, :-1] + self.G @ f)
        p = self.N @ u
        p[:, :-1] += self.Q @ u[:, :-1] - self.D.swapaxes(2, 3) @ f
        if self.one:
            d += u[:, 1:] - u[:, :-1]
            p[:, 1:] += f
            p[:, :-1] -= f
        p[:, self.held] = 0.0
        return p, d


class Singular(SolveError):
    """A matrix that is singular.

    Attributes
    ----------
    line : int
    """

    def __init__(self, line: int) -> None:
        super().__init__("singular")
        self.line = line


@dataclass(frozen=True, eq=False)
class Factored:
    """Band matrices, factored."""

    lu: Any
    pivot: Any

    def solve(self, right: Any) -> Any:
        """Return the solutions of columns (n, rows, columns)."""
        x: Any = _core.space_solve(self.lu, self.pivot, right.swapaxes(1, 2))
        return x.swapaxes(1, 2)


def assemble(rope: SpaceRope, factors: Factors, z: Real, *, equal: int = 1) -> Assembly:
    """Return the parts at each line: so many equal ones of each piece, or more within them."""
    if equal > 1 and rope.bend.shape[1] > 1:
        divided = rope.divided(equal)
        whole = assemble(divided, factors, z)
        return replace(whole, node=whole.node[::equal], inner=whole.node)
    rates = scaled_rates(rope.rates(factors), z)
    size = size_of(rates).max(axis=(0, 2))
    by = rope.turn * (z[:, None, None, :] / z[:, None, :, None]) - np.eye(6)
    triples, counts = [], []
    for p, length in enumerate(rope.length / equal):
        one = np.ascontiguousarray(coefficients(rates[:, p]))
        halved = int(halvings(max(size[p] * length, rope.least_radians[p])))
        triple = parts_of(one, float(length), halved)
        many = equal * triple.shape[1]
        counts.append(many)
        if sum(counts) > MOST_PARTS:
            raise SolveError("the waves are too short for the rope: more than 100000 parts")
        alike = np.repeat(triple, many // triple.shape[1], axis=1)
        # F R and R^T Q R of what begins with a kink
        D, Q, turn = alike[:, 0, 0], alike[:, 0, 2], by[:, p]
        back = turn.swapaxes(1, 2)
        alike[:, 0, 0] = turn + D + D @ turn
        alike[:, 0, 2] = Q + back @ Q + Q @ turn + back @ Q @ turn
        triples.append(alike)
    node = np.concatenate([[0], np.cumsum(counts)])
    N = np.zeros((len(rates), node[-1] + 1, 6, 6), dtype=np.complex128)
    N[:, node] = rope.nodes(factors) * (z[:, None, :, None] * z[:, None, None, :])
    doubt = np.zeros(N.shape[:2])
    for wire in rope.carried:
        foot, at = foot_of(wire, factors), node[wire.node]
        N[:, at] += foot.stiffness * (z[:, :, None] * z[:, None, :])
        doubt[:, at] += (foot.doubt * (z[:, :, None] * z[:, None, :])).max((1, 2))
    held = np.zeros((node[-1] + 1, 6), dtype=bool)
    held[node] = rope.held
    held[:, rope.absent] = True
    D, G, Q = np.concatenate(triples, axis=1).transpose(2, 0, 1, 3, 4)
    return Assembly(D, G, Q, N, held, rope.absent, node, z, doubt)


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
    z = carried.rope.scale(np.abs(factors.inertia))
    system = assemble(carried.rope, own, z)
    count, D, Q = len(z), system.D[:, 0], system.Q[:, 0]
    p = np.zeros((count, system.parts + 1, 6, 7), dtype=np.complex128)
    d = np.zeros((count, system.parts, 6, 7), dtype=np.complex128)
    # u_1 - G f_0 = F u_0 of the left end's motion, and a load along the aim
    d[:, 0, :, :6] = np.eye(6) + D
    p[:, -1, :, 6] = carried.aim * z
    u, f = system.apart(system.factored().solve(system.together(p, d)))
    u[:, 0, :, :6] = np.eye(6)
    # f_-1 is what the left end asks for
    force = Q @ u[:, 0] - f[:, 0] - D.swapaxes(1, 2) @ f[:, 0]
    off = bound(system, (u, f), (u, f))
    by = carried.arm / z[:, :, None]
    size = np.abs(by)
    return Foot(
        by.swapaxes(1, 2) @ force[:, :, :6] @ by,
        size.swapaxes(1, 2) @ off[:, :6, :6] @ size,
        ((carried.aim * z)[:, None] @ u[:, -1, :, :6] @ by)[:, 0],
        (off[:, 6:, :6] @ size)[:, 0],
    )


ROUNDINGS = 4.0  # Of entries of a part's matrices, in units of the largest one, scaled.


def bound(system: Assembly, one: tuple[Any, Any], other: tuple[Any, Any]) -> Real:
    """Estimate x^T dA y, shape (n, columns of one, of other), by the parts' largest entries."""
    (u, f), (v, g) = (tuple(np.linalg.norm(w, axis=2) for w in pair) for pair in (one, other))
    D, G, Q, N = system.largest
    left, right = u[:, :-1], v[:, :-1]
    form = "lnd,ln,lnr->ldr"
    size = np.einsum(form, u, N, v) + np.einsum(form, left, Q, right) + np.einsum(form, f, G, g)
    size += np.einsum(form, f, 1 + D, right) + np.einsum(form, left, 1 + D, g)
    limit: Real = ROUNDINGS * np.finfo(float).eps * size
    return limit


def parts_of(rates: Complex, length: float, halved: int) -> Complex:
    """Return triples (n, parts, 3, 6, 6) of a piece, all below their own resonances."""
    series = series_of(length, halved, rates.shape[1])
    most = halved
    while True:
        triple, reached = _core.space_triples(rates, series, length, halved, most, GENTLE)
        if reached == most:
            alike = 1 << (halved - most) if len(series) == 1 else 1
            return np.repeat(triple, alike, axis=1)
        most = int(reached)
