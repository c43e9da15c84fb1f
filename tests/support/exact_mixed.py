"""The exact discrete system of a compiled chain: its mixed form eliminated in many digits."""

import mpmath
import numpy as np
from mpmath import mpc, mpf

from ropedyn.chain.wide import wide_of

CHANNEL = {0: 0, 1: 2, 2: 1, 3: 2}
"""Section channel of the coordinates x, z, alpha, beta."""


def triple(chain, e, section, tension):
    """(F, G, Q) by the formulas of csrc/element/triple.h."""
    c = [int(k) for k in chain.coordinate]
    w, h = len(c), mpf(chain.length[e])
    S = [[mpf(s) / section for s in row] for row in chain.flexibility[e].tolist()]
    T = mpf(chain.tension[e]) * tension
    F, G, Q = mpmath.eye(w), mpmath.zeros(w), mpmath.zeros(w)
    if 3 not in c:
        for i, a in enumerate(c):
            for j, b in enumerate(c):
                if 1 not in (a, b):
                    G[i, j] = h * S[CHANNEL[a]][CHANNEL[b]]
                elif a == b:
                    G[i, j] = h / T
        return F, G, Q
    bb = S[2][2]
    theta = T * bb * h**2
    if chain.kind == 0:
        tau, P = mpf(0), (mpf(1), mpf(1) / 2, mpf(1) / 3)
    elif chain.kind == 1:
        p = 1 + theta / 3
        tau, P = 1 / p, ((1 + theta / 12) / p, 1 / (2 * p), 1 / (3 * p))
    elif theta == 0:
        tau, P = mpf(1), (mpf(1), mpf(1) / 2, mpf(1) / 3)
    else:
        t = mpmath.sqrt(theta)
        tau = mpmath.tanh(t) / t
        P = (tau, (1 - mpmath.sech(t)) / theta, (1 - tau) / theta)
    beta = c.index(3)
    for i, a in enumerate(c):
        ri = S[CHANNEL[a]][2] / bb
        for j, b in enumerate(c):
            rj = S[CHANNEL[b]][2] / bb
            if CHANNEL[a] != 2 and CHANNEL[b] != 2:
                G[i, j] = h * S[CHANNEL[a]][CHANNEL[b]] + ri * rj * bb * h * (P[0] - 1)
            else:
                k = (a == 1) + (b == 1)
                G[i, j] = ri * rj * bb * h ** (1 + k) * P[k]
        F[i, beta] = h * tau if a == 1 else (i == beta) - ri * theta * P[1]
    Q[beta, beta] = T * h * tau
    return F, G, Q


def wide_numbers(model):
    """The chain of a model as its scene says it, in wider numbers taken as exact."""
    chain = wide_of(model).chain
    names = ("length", "tension", "flexibility", "mass", "stiffness", "hinge")
    given = {name: getattr(chain, name) for name in names}
    exact = np.vectorize(mpmath.mpmathify, otypes=[object])
    return chain._replace(**{k: exact(array) for k, array in given.items() if array is not None})


class Exact:
    """Solutions of one component of a model at one frequency.

    Blocks of unknowns: u of a node, where a hinge stands its force and the u on its right, the
    force f_b of the element, u of the next node. A hinge's compliance is that of a spring.
    """

    def __init__(self, model, component, omega, damping=(1, 1, 1)):
        chain = self.chain = wide_numbers(model).only(component)
        self.component, self.w = component, len(component)
        section, tension, spring = damping
        self.node, blocks = [], 0
        hinge = getattr(chain, "hinge", None)
        hinged = [hinge is not None and hinge[t].any() for t in chain.term_of]
        for open_here in hinged:
            self.node.append(blocks)
            blocks += 4 if open_here else 2
        w, n = self.w, (blocks - 1) * self.w
        A = self.A = mpmath.matrix(n, n)
        identity = mpmath.eye(w)
        for i, term in enumerate(chain.term_of):
            N = mpmath.matrix(chain.stiffness[term].tolist()) * spring
            N -= mpmath.matrix(chain.mass[term].tolist()) * omega**2
            self._add(self.node[i], self.node[i], N)
        for i, e in enumerate(chain.element_of):
            F, G, Q = triple(chain, int(e), section, tension)
            a, b = self.node[i], self.node[i + 1]
            if hinged[i]:
                self._hinge(a, hinge[chain.term_of[i]].tolist(), spring)
                a += 2
            self._add(a, a, Q)
            self._add(a, b - 1, -F.T)
            self._add(b - 1, a, -F)
            self._add(b - 1, b - 1, -G)
            self._add(b - 1, b, identity)
            self._add(b, b - 1, identity)
        for i, term in enumerate(chain.term_of):
            for k in np.flatnonzero(chain.held[term]):
                at = self.node[i] * w + int(k)
                for j in range(n):
                    A[at, j] = mpf(j == at)

    def _add(self, p, q, block):
        for i in range(self.w):
            for j in range(self.w):
                self.A[p * self.w + i, q * self.w + j] += block[i, j]

    def _hinge(self, p, compliance, spring):
        for k, c in enumerate(compliance):
            left, force, right = ((p + j) * self.w + k for j in range(3))
            self.A[left, force] -= 1
            self.A[right, force] += 1
            if c == mpmath.inf:
                self.A[force, force] = 1
            else:
                self.A[force, left], self.A[force, right] = mpf(-1), mpf(1)
                self.A[force, force] = -mpf(c) / spring

    def solve(self, node, coordinate):
        """Solution for a unit force on a coordinate of a node."""
        b = mpmath.matrix(self.A.rows, 1)
        term = self.chain.term_of[node]
        k = self.component.index(coordinate)
        if not self.chain.held[term, k]:
            b[self.node[node] * self.w + k] = mpf(1)
        self.x = mpmath.lu_solve(self.A, b)
        return self

    def motion(self, node, coordinate):
        return mpc(self.x[self.node[node] * self.w + self.component.index(coordinate)])

    def force(self, node, coordinate):
        """On the right end of the element left of the node."""
        return mpc(self.x[(self.node[node] - 1) * self.w + self.component.index(coordinate)])
