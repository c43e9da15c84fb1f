"""What forces at the stages of a step do to modes, against their integrals to 60 digits."""

import mpmath as mp
import numpy as np
import pytest

from ropedyn.motion.smooth import collocation
from ropedyn.motion.smooth.collocation import STAGES, TURNS, Oscillating, nodes

NOTHING = np.zeros((1, 1))


def exact(sigma, omega, h, theta):
    """q and q' under (s/h)^m, of modes of complex rates."""
    with mp.workdps(60):
        p, t, scaled = mp.mpc(-sigma, omega), mp.mpf(theta) * mp.mpf(h), mp.mpf(theta)
        value = (mp.exp(p * t) - 1) / p
        found = [value]
        for m in range(1, STAGES):
            value = (m / mp.mpf(h) * value - scaled**m) / p
            found.append(value)
        return np.array([[float(mp.im(one)), float(mp.im(p * one))] for one in found]) / omega


@pytest.mark.parametrize("theta", [*nodes(STAGES), 0.01, 0.5])
@pytest.mark.parametrize("ratio", [0.0, 1e-3, 0.5])
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
    sigma = ratio * omega
    one = np.ones((1, len(omega)))
    modes = Oscillating(sigma, sigma**2 + omega**2, one.T, one, 0 * one)
    pushed = modes.reached(h, theta).pushed
    for k in range(len(omega)):
        found = np.vander(nodes(STAGES), increasing=True).T @ pushed[:, :, k]
        integral = exact(sigma[k], omega[k], h, theta)
        size = np.array([min(turns[k], 1.0), 1.0]) * theta * h / np.array([omega[k], 1.0])
        size /= max(turns[k], 1.0)
        # measured: 2e-14, and the rounding of the phase
        assert (np.abs(found - integral) <= (2e-13 + 1e-15 * turns[k]) * size).all()
    assert max(counts) <= 32
