"""Exact motion of a small chain with plain lumps: the exponential of its assembled matrices."""

import numpy as np
import scipy.linalg as la


class Dense:
    """The matrices of a chain over its free coordinates; those without inertia are condensed."""

    def __init__(self, model):
        self.model = model
        self.K = model.stiffness_matrix().toarray()
        self.size = len(self.K)
        mass = model.mass_matrix().toarray()
        self.M = np.diag(np.diag(mass))
        # damping in proportion to mass goes with the plain lumps
        alpha = sum(d.term().rate.get(3, 0.0) for d in model.scene.dampings)
        self.C = model.damping_matrix().toarray() + alpha * (self.M - mass)
        held = model.node_terms.held[model.node_terms.term]
        self.number = np.where(held == 0, np.cumsum(held == 0).reshape(held.shape) - 1, -1)
        self.moves = np.diag(self.M) > 0
        assert not self.C[~self.moves].any()

    def at(self, coordinate, x):
        """Return the number of a coordinate at a node."""
        node = int(np.argmin(np.abs(self.model.x - x)))
        return self.number[node, self.model.coordinates.index(coordinate)]

    def load(self, point, value=1.0):
        """Return a force at a node."""
        p = np.zeros(self.size)
        p[self.at(*point)] = value
        return p

    def rest(self, load):
        """Return the static deflection."""
        return la.solve(self.K, load)

    def motion(self, time, *, u=None, v=None, load=None, omega=0.0, phase=np.pi / 2):
        """Return motion and velocity from u, v under load sin(omega t + phase), (t, size)."""
        r, m = np.flatnonzero(self.moves), np.flatnonzero(~self.moves)
        p = np.zeros(self.size) if load is None else load
        follow = -la.solve(self.K[np.ix_(m, m)], self.K[np.ix_(m, r)]) if len(m) else None
        K, force = self.K[np.ix_(r, r)], p[r]
        at_once = np.zeros(self.size)
        if len(m):
            K = K + self.K[np.ix_(r, m)] @ follow
            at_once[m] = la.solve(self.K[np.ix_(m, m)], p[m])
            force = force - self.K[np.ix_(r, m)] @ at_once[m]
        n = len(r)
        M = np.diag(self.M)[r]
        A = np.zeros((2 * n + 2, 2 * n + 2))
        A[:n, n : 2 * n] = np.eye(n)
        A[n : 2 * n, :n] = -K / M[:, None]
        A[n : 2 * n, n : 2 * n] = -self.C[np.ix_(r, r)] / M[:, None]
        A[n : 2 * n, 2 * n] = force / M
        A[2 * n, 2 * n + 1], A[2 * n + 1, 2 * n] = omega, -omega
        y = np.zeros(2 * n + 2)
        y[:n] = 0.0 if u is None else u[r]
        y[n : 2 * n] = 0.0 if v is None else v[r]
        y[2 * n :] = np.sin(omega * time[0] + phase), np.cos(omega * time[0] + phase)
        states, last = [y], 0.0
        for step in np.diff(time):
            if abs(step - last) > 1e-12 * step:
                last, forward = step, la.expm(A * step)
            states.append(forward @ states[-1])
        states = np.array(states)
        motion, velocity = np.zeros((len(time), self.size)), np.zeros((len(time), self.size))
        motion[:, r], velocity[:, r] = states[:, :n], states[:, n : 2 * n]
        if len(m):
            motion[:, m] = states[:, :n] @ follow.T
            velocity[:, m] = states[:, n : 2 * n] @ follow.T
            motion += states[:, 2 * n, None] * at_once
            velocity += omega * states[:, 2 * n + 1, None] * at_once
        return motion, velocity
