"""Chains in many digits: eigenvalue counts and errors, with nothing of the core.

The triple of each distinct element is written out from csrc/triple.h's formulas in mpmath, the
assembled K - lambda M is reduced node by node, and the signs of its pivots are counted (Sylvester).
Numbers of the compiled chain are taken as exact.
"""

from functools import lru_cache

import mpmath
import numpy as np
from mpmath import mpf

DIFFERENCE, RIGID, TENSED = range(3)
CHANNEL = {0: 0, 1: 2, 2: 1, 3: 2}
X, Z, ALPHA, BETA = range(4)


def shape_functions(kind, theta):
    """Return tau, P0, P1, P2 of csrc/triple.h."""
    if kind == DIFFERENCE or theta == 0:
        tau = mpf(0) if kind == DIFFERENCE else mpf(1)
        return tau, mpf(1), mpf(1) / 2, mpf(1) / 3
    if kind == RIGID:
        p = 1 + theta / 3
        return 1 / p, (1 + theta / 12) / p, 1 / (2 * p), 1 / (3 * p)
    t = mpmath.sqrt(theta)
    tau = mpmath.re(mpmath.tanh(t) / t)
    return tau, tau, mpmath.re((1 - 1 / mpmath.cosh(t)) / theta), (1 - tau) / theta


def triple(chain, e):
    """Return F, G, Q of distinct element e."""
    w = len(chain.coordinate)
    l, T = mpf(float(chain.length[e])), mpf(float(chain.tension[e]))
    S = [[mpf(float(s)) for s in row] for row in chain.flexibility[e]]
    F, G, Q = mpmath.eye(w), mpmath.zeros(w), mpmath.zeros(w)
    coordinate = list(chain.coordinate)
    channel = [CHANNEL[int(c)] for c in coordinate]
    bends = BETA in coordinate
    Sb = S[2][2]
    if bends:
        tau, *P = shape_functions(chain.kind, T * Sb * l * l)
    for i, a in enumerate(coordinate):
        for j, b in enumerate(coordinate):
            c, d = channel[i], channel[j]
            if c != 2 and d != 2:
                G[i, j] = l * S[c][d]
                if bends:
                    G[i, j] += l * S[c][2] * S[d][2] / Sb * (P[0] - 1)
            elif not bends:
                G[i, j] = l / T if i == j else mpf(0)
            else:
                k = int(a == Z) + int(b == Z)
                ri = mpf(1) if c == 2 else S[c][2] / Sb
                rj = mpf(1) if d == 2 else S[d][2] / Sb
                G[i, j] = ri * rj * Sb * l ** (1 + k) * P[k]
        if bends:
            theta = T * Sb * l * l
            ri = mpf(1) if channel[i] == 2 else S[channel[i]][2] / Sb
            if chain.kind == DIFFERENCE:
                theta = mpf(0)
            F[i, w - 1] = l * tau if a == Z else int(a == BETA) - ri * theta * P[1]
    if bends:
        Q[w - 1, w - 1] = T * l * tau
    return F, G, Q


def element_matrix(chain, e):
    """Return K_e (2 width, 2 width)."""
    w = len(chain.coordinate)
    F, G, Q = triple(chain, e)
    inverse = G**-1
    blocks = ((Q + F.T * inverse * F, -(F.T) * inverse), (-inverse * F, inverse))
    K = mpmath.zeros(2 * w)
    for a in range(2):
        for b in range(2):
            for i in range(w):
                for j in range(w):
                    K[a * w + i, b * w + j] = blocks[a][b][i, j]
    return K


class ExactChain:
    """A compiled chain in many digits."""

    def __init__(self, chain, digits=60):
        self.chain = chain
        self.digits = digits
        self.width = len(chain.coordinate)
        with mpmath.workdps(digits):
            self.element = lru_cache(None)(lambda e: self._rows(element_matrix(chain, e)))
            self.term = lru_cache(None)(self._term)

    @staticmethod
    def _rows(matrix):
        return [[matrix[i, j] for j in range(matrix.cols)] for i in range(matrix.rows)]

    def _term(self, t):
        mass = [[mpf(float(m)) for m in row] for row in self.chain.mass[t]]
        stiffness = [[mpf(float(k)) for k in row] for row in self.chain.stiffness[t]]
        free = [i for i in range(self.width) if not self.chain.held[t][i]]
        return mass, stiffness, free

    def count(self, eigenvalue):
        """Return the negative eigenvalues of K - lambda M."""
        with mpmath.workdps(self.digits):
            return self._count(mpf(eigenvalue))

    def _count(self, lam):
        w, chain = self.width, self.chain
        left = [[mpf(0)] * w for _ in range(w)]
        count, last = 0, len(chain.term_of) - 1
        for n, t in enumerate(chain.term_of):
            mass, stiffness, free = self.term(int(t))
            size = w if n == last else 2 * w
            A = [[mpf(0)] * size for _ in range(size)]
            if n < last:
                A = [row[:] for row in self.element(int(chain.element_of[n]))]
            for i in range(w):
                for j in range(w):
                    A[i][j] += left[i][j] + stiffness[i][j] - lam * mass[i][j]
            rest = list(free)
            while rest:
                p = max(rest, key=lambda i: abs(A[i][i]))
                rest.remove(p)
                pivot = A[p][p]
                if pivot == 0:
                    raise ZeroDivisionError("an exactly singular leading part")
                count += pivot < 0
                others = rest + list(range(w, size))
                for i in others:
                    if A[i][p] == 0:
                        continue
                    share = A[i][p] / pivot
                    for j in others:
                        A[i][j] -= share * A[p][j]
            if n < last:
                left = [row[w:] for row in A[w:]]
        return count

    def error(self, index, value):
        """Return how far eigenvalue number `index`, from 0, is from `value`, to one per cent.

        Valid above the spurious eigenvalues of an indefinite mass matrix, which lie far below zero.
        """
        with mpmath.workdps(self.digits):
            value = mpf(float(value))
            step = abs(value) * mpf(2) ** -60 + mpf(10) ** -30
            while not self._count(value - step) <= index < self._count(value + step):
                step *= 16
                if step > mpf(10) ** 30:
                    raise ValueError(f"there is no eigenvalue number {index}")
            side = 1 if self._count(value) <= index else -1
            near, far = mpf(0), step
            while far - near > far / 100 and far > abs(value) * mpf(2) ** -60:
                middle = (near + far) / 2
                beyond = self._count(value + side * middle) > index
                if beyond == (side > 0):
                    far = middle
                else:
                    near = middle
            return float(far)


def eigenvalue_errors(model, modes, digits=60):
    """Return the errors of the eigenvalues of a model of one component [rad^2/s^2]."""
    exact = ExactChain(model.chain, digits)
    return np.array([exact.error(k, v) for k, v in enumerate(modes.eigenvalue)])
