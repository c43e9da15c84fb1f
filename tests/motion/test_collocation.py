"""What forces at the stages of a step do to modes, against their integrals to 60 digits."""

import mpmath as mp
import numpy as np
import pytest

from ropedyn.motion.smooth import collocation
from ropedyn.motion.smooth.collocation import STAGES, TURNS, Oscillating, nodes


def exact(sigma, square, h, theta):
    """q and q' under (s/h)^m, from the two rates of a mode."""
    with mp.workdps(60):
        sigma, t = mp.mpf(sigma), mp.mpf(theta) * mp.mpf(h)
        split = mp.sqrt(mp.mpc(sigma**2 - mp.mpf(square)))
        each = []
        for p in (-sigma + split, -sigma - split):
            each.append([(mp.exp(p * t) - 1) / p])
            for m in range(1, STAGES):
                each[-1].append((m / mp.mpf(h) * each[-1][-1] - mp.mpf(theta) ** m) / p)
        pairs = [
            ((a - b) / (2 * split), ((-sigma + split) * a - (-sigma - split) * b) / (2 * split))
            for a, b in zip(*each)
        ]
        return np.array([[float(mp.re(one)) for one in pair] for pair in pairs])


@pytest.mark.parametrize("theta", [*nodes(STAGES), 0.01, 0.5])
@pytest.mark.parametrize("ratio", [0.0, 1e-3, 0.5, 0.99999, 1 + 1e-9, 1.02, 1.5, 1e3])
def test_polynomials_push_modes_as_their_integrals(theta, ratio, monkeypatch):
    """By panels and by parts; of modes that turn 1e5 times a rule had as many nodes: minutes."""
    counts = []

    def watched(count, rule=collocation.gauss):
        counts.append(count)
        return rule(count)

    monkeypatch.setattr(collocation, "gauss", watched)
    h = 0.02
    turns = np.array([0.1, 1.0, 0.99 * TURNS, 1.01 * TURNS, 40.0, 1e3, 1e5])
    omega = turns / (theta * h)
    one = np.ones((1, len(omega)))
    modes = Oscillating(ratio * omega, omega**2, one.T, one, 0 * one)
    pushed = modes.reached(h, theta).pushed
    for k in range(len(omega)):
        found = np.vander(nodes(STAGES), increasing=True).T @ pushed[:, :, k]
        integral = exact(ratio * omega[k], omega[k] ** 2, h, theta)
        size = np.array([min(turns[k], 1.0), 1.0]) * theta * h / np.array([omega[k], 1.0])
        size /= max(turns[k], 1.0)
        # measured: 2e-14, and the rounding of the phase
        assert (np.abs(found - integral) <= (2e-13 + 1e-15 * turns[k]) * size).all(), k
    assert max(counts) <= 32


def test_a_polynomial_pushes_what_grows():
    h, square = 0.02, -np.array([1.0, 1e3, 1e6])
    one = np.ones((1, 3))
    pushed = Oscillating(0 * square, square, one.T, one, 0 * one).reached(h, 1.0).pushed
    for k in range(3):
        found = np.vander(nodes(STAGES), increasing=True).T @ pushed[:, :, k]
        integral = exact(0.0, square[k], h, 1.0)
        # measured: 3e-15
        assert (np.abs(found - integral) < 1e-13 * np.abs(integral).max(axis=0)).all()
