"""Parts of a rope in space, each below its own resonances, joined by one band matrix.

With motion u at the nodes and force f at the right end of each part

    f_i-1 - F^T f_i + (Q + N) u_i = p_i,   u_i+1 - F u_i - G f_i = d_i

which exists where G is singular, and is symmetric.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .. import _core
from ..base.array import Complex, Flags, Index, Real
from ..base.errors import SolveError
from .rope import Factors, SpaceRope, halvings, scaled_rates, size_of

BAND = 11  # Entries on either side of the diagonal.
GENTLE = 1.5  # The largest entry of a joint's inverse within a part.
MOST_PARTS = 100_000


@dataclass(frozen=True, eq=False)
class Assembly:
    """A rope at several lines; scaled by z, which is of all of them.

    Attributes
    ----------
    D, G, Q : ndarray of complex, shape (n, parts, 6, 6)
        F = 1 + D.
    N : ndarray of complex, shape (n, parts + 1, 6, 6)
        Of the nodes.
    held : ndarray of bool, shape (parts + 1, 6)
    node : ndarray of int, shape (pieces + 1,)
        Where the nodes of the rope are.
    z : ndarray, shape (6,)
    """

    D: Complex
    G: Complex
    Q: Complex
    N: Complex
    held: Flags
    node: Index
    z: Real

    @property
    def parts(self) -> int:
        """How many there are."""
        return self.D.shape[1]

    def shown(self, equal: int) -> Index:
        """Return the nodes at the ends of so many equal parts of each piece."""
        within = np.diff(self.node)[:, None] // equal * np.arange(equal)
        return np.append((self.node[:-1, None] + within).ravel(), self.node[-1])

    def apply(self, u: Any, f: Any) -> tuple[Any, Any]:
        """Return p and d of motion (n, parts + 1, 6, columns) and force (n, parts, 6, columns)."""
        d = u[:, 1:] - u[:, :-1] - self.D @ u[:, :-1] - self.G @ f
        p = self.N @ u
        p[:, 1:] += f
        p[:, :-1] += self.Q @ u[:, :-1] - f - self.D.swapaxes(2, 3) @ f
        return np.where(self.held[:, :, None], 0, p), d

    def band(self, k: int, real: bool) -> Any:
        """Return the band matrix of line k as LAPACK takes it, rows and columns of held ones 1."""
        rows, columns, fixed = _pattern(self.parts, self.held)
        F = np.eye(6) + self.D[k]
        diagonal = self.N[k].copy()
        diagonal[:-1] += self.Q[k]
        one = np.broadcast_to(np.eye(6), F.shape)
        blocks = [diagonal, -F, -F.swapaxes(1, 2), -self.G[k], one, one]
        values = np.concatenate([block.ravel() for block in blocks])
        size = (2 * self.parts + 1) * 6
        band = np.zeros((3 * BAND + 1, size), dtype=np.float64 if real else np.complex128)
        free = ~(fixed[rows] | fixed[columns])
        rows, columns = rows[free], columns[free]
        band[2 * BAND + rows - columns, columns] = (values.real if real else values)[free]
        band[2 * BAND, fixed] = 1.0
        return band

    def together(self, u: Any, f: Any) -> Any:
        """Return rows in the order of the band, from (parts + 1, 6, c) and (parts, 6, c)."""
        both = np.zeros((2 * self.parts + 1, 6, u.shape[-1]), dtype=np.result_type(u, f))
        both[::2], both[1::2] = u, f
        return both.reshape(-1, u.shape[-1])

    def apart(self, x: Any) -> tuple[Any, Any]:
        """Return motion and force."""
        both = x.reshape(2 * self.parts + 1, 6, -1)
        return both[::2], both[1::2]

    def factored(self, k: int, *, real: bool = False) -> Factored:
        """Return line k factored."""
        from scipy.linalg import lapack

        factor = lapack.dgbtrf if real else lapack.zgbtrf
        lu, pivot, info = factor(self.band(k, real), BAND, BAND)
        if info > 0:
            raise SolveError("singular")
        return Factored(lu, pivot, real)


@dataclass(frozen=True, eq=False)
class Factored:
    """A band matrix, factored."""

    lu: Any
    pivot: Any
    real: bool

    def solve(self, right: Any) -> Any:
        """Return the solutions of columns."""
        from scipy.linalg import lapack

        solve = lapack.dgbtrs if self.real else lapack.zgbtrs
        return solve(self.lu, BAND, BAND, right, self.pivot)[0]


def _pattern(parts: int, held: Flags) -> tuple[Index, Index, Flags]:
    """Return rows and columns of the blocks' entries, and which unknowns are held."""
    i, j = np.divmod(np.arange(36), 6)
    u, f = 12 * np.arange(parts + 1)[:, None], 12 * np.arange(parts)[:, None] + 6
    places = [(u, u), (f, u[:-1]), (u[:-1], f), (f, f), (f, u[1:]), (u[1:], f)]
    rows = np.concatenate([(row + i).ravel() for row, _ in places])
    columns = np.concatenate([(column + j).ravel() for _, column in places])
    fixed = np.zeros((2 * parts + 1, 6), dtype=bool)
    fixed[::2] = held
    return rows, columns, fixed.ravel()


def assemble(rope: SpaceRope, factors: Factors, z: Real, *, equal: int = 1) -> Assembly:
    """Return the parts at each line: so many equal ones of each piece, or more within them."""
    rates = scaled_rates(rope.rates(factors), z)
    size = size_of(*rates.transpose(2, 0, 1, 3, 4)).max(axis=0)
    turn = rope.turn * np.outer(1 / z, z) - np.eye(6)
    triples, counts = [], []
    for p, length in enumerate(rope.length / equal):
        one = np.ascontiguousarray(rates[:, p])
        triple, left = _equal(one, float(length), int(halvings(size[p] * length)))
        counts.append(equal << left)
        if sum(counts) > MOST_PARTS:
            raise SolveError("the waves are too short for the rope: more than 100000 parts")
        many = np.repeat(triple[:, :, None], counts[-1], axis=2)
        # F R and R^T Q R of what begins with a kink
        D, Q, by = many[:, 0, 0], many[:, 2, 0], turn[p]
        many[:, 0, 0] = by + D + D @ by
        many[:, 2, 0] = Q + by.T @ Q + Q @ by + by.T @ Q @ by
        triples.append(many)
    node = np.concatenate([[0], np.cumsum(counts)])
    N = np.zeros((len(rates), node[-1] + 1, 6, 6), dtype=np.complex128)
    N[:, node] = rope.nodes(factors) * np.outer(z, z)
    held = np.zeros((node[-1] + 1, 6), dtype=bool)
    held[node] = rope.held
    D, G, Q = np.concatenate(triples, axis=2).transpose(1, 0, 2, 3, 4)
    return Assembly(D, G, Q, N, held, node, z)


def _equal(rates: Complex, length: float, halved: int) -> tuple[Complex, int]:
    """Return triples (n, 3, 6, 6) of equal parts of a length, and how often it is halved."""
    most = halved
    while True:
        triple, reached = _core.space_triples(rates, length, halved, most, GENTLE)
        if reached.min() == most:
            return triple, halved - most
        most = int(reached.min())
