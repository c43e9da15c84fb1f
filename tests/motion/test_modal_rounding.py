"""Phases of modes over many periods, against chains of equal masses in closed form."""

from functools import partial

import mpmath as mp
import numpy as np
import pytest

import ropedyn as rd


@pytest.fixture(autouse=True)
def digits():
    with mp.workdps(40):
        yield


class LumpedString:
    """A chain of equal masses on a string, in closed form with 40 digits."""

    def __init__(self, elements, tension, damping=(0.0, 0.0)):
        rope = rd.Rope(1.0, 0.4)
        given = rd.RayleighDamping(*damping) if any(damping) else None
        scene = rd.Scene(rope, tension=tension, damping=given)
        self.model = scene.compile(elements=elements, element="rigid")
        self.elements, self.damping = elements, damping
        self.mass = mp.mpf("0.4") / elements
        self.pull = 4 * mp.mpf(tension) * elements / self.mass

    @property
    def period(self):
        return float(2 * mp.pi / mp.sqrt(self.pull) / mp.sin(mp.pi / (2 * self.elements)))

    def moved(self, drive, seen, by):
        """Return the sum over modes of what `by` says of both rates of each, in the Laplace plane.

        `by(p, q)` is the motion of 1/((s - p)(s - q)) under the force.
        """
        total = mp.mpf(0)
        for k in range(1, self.elements):
            square = self.pull * mp.sin(k * mp.pi / (2 * self.elements)) ** 2
            sigma = (self.damping[0] + self.damping[1] * square) / 2
            split = mp.sqrt(mp.mpc(sigma**2 - square))
            shape = (mp.sin(node * k * mp.pi / self.elements) for node in (drive, seen))
            weight = 2 / (self.elements * self.mass) * mp.fprod(shape)
            total += weight * mp.re(by(-sigma + split, -sigma - split))
        return float(total)


def let_go(p, q, time, order):
    return (q * p**order * mp.exp(p * time) - p * q**order * mp.exp(q * time)) / (q - p) / (p * q)


def under_a_sine(p, q, time, order, frequency):
    turn = 2j * mp.pi * frequency
    rates = [turn, -turn, p, q]
    apart = [mp.fprod(one - other for other in rates if other is not one) for one in rates]
    each = [one**order * mp.exp(one * time) / by for one, by in zip(rates, apart)]
    return 2 * mp.pi * frequency * mp.fsum(each)


@pytest.mark.parametrize("seed", range(6))
def test_phases_are_known_after_many_periods(seed):
    random = np.random.default_rng(seed)
    elements, drive = int(random.integers(4, 65)), 1
    damping = [(0.0, 0.0), (0.01, 1e-9)][seed % 2]
    string = LumpedString(elements, float(random.uniform(50, 3000)), damping)
    seen, order = int(random.integers(1, elements)), int(random.integers(3))
    time = np.linspace(0.0, 10 ** random.uniform(1, 5) * string.period, 1000)
    x, frequency = string.model.x, 3.37 / string.period
    quantity = ("displacement", "velocity", "acceleration")[order]
    asked = {"response": ("z", x[seen]), "quantity": quantity, "tolerance": 1e-7}
    for acts, by in (
        ({"start": {("z", x[drive]): 1.0}}, partial(let_go, order=order)),
        (
            {"drive": ("z", x[drive]), "force": rd.Sine(1.0, frequency)},
            partial(under_a_sine, order=order, frequency=mp.mpf(frequency)),
        ),
    ):
        history = string.model.transient(time, **acts, **asked)
        for at in (3, 500, 999):
            exact = string.moved(drive, seen, partial(by, time=mp.mpf(time[at])))
            assert abs(history.value[0, at] - exact) <= history.error[0, at]  # measured: 0.03 of it


def test_samples_are_followed_to_1e_9():
    string = LumpedString(64, 2830.0, (1.0, 1e-5))
    time = np.arange(20_000) / 1e4
    force, x = np.sin(2 * np.pi * 37.0 * time), string.model.x
    asked = {"drive": ("z", x[16]), "response": ("z", x[40]), "tolerance": 1e-9}
    history = string.model.transient(time, force=force, **asked)
    assert history.cost.method == "modal"
    assert history.error.max() <= 1e-9 * np.abs(history.value).max()  # measured: 1e-10
    corner = np.diff(np.diff(force[:80]) / np.diff(time[:80]), prepend=0.0)
    since = [mp.mpf(one) for one in time[79] - time[:79]]

    def by(p, q):
        # 1/(s^2 (s - p)(s - q))
        each = [(one**-2 / (one - other), one) for one, other in ((p, q), (q, p))]
        still = (p + q) / (p * q) ** 2
        return mp.fsum(
            bend * (mp.fsum(size * mp.exp(rate * t) for size, rate in each) + still + t / (p * q))
            for bend, t in zip(corner, since)
        )

    assert abs(history.value[0, 79] - string.moved(16, 40, by)) <= history.error[0, 79]
