"""Stretching ties both planes of a string: circles, whirling, and planar motion that gives way."""

import math

import numpy as np
import pytest
from conftest import long
from scipy.integrate import solve_ivp

import ropedyn as rd

LENGTH, DENSITY, TENSION, AXIAL = 1.0, 0.1, 250.0, 2e6


def string(elements, **scene):
    """Return a chain of lumps that moves in both planes."""
    rope = rd.Rope(LENGTH, DENSITY, axial_stiffness=AXIAL)
    tension = rd.Tension(TENSION, stretching=True)
    asked = {"rope": rope, "tension": tension, "planes": "both"} | scene
    return rd.Scene(**asked).compile(elements=elements)


def test_one_mass_goes_round_in_a_circle_under_a_constant_tension():
    radius, mass = 5e-3, DENSITY * LENGTH / 2
    stiffness = 4 / LENGTH * (TENSION + 2 * AXIAL * radius**2 / LENGTH**2)
    omega = math.sqrt(stiffness / mass)
    time = np.linspace(0.0, 0.3, 301)
    history = string(2).transient(
        time,
        start={("z", 0.5): radius * 4 * TENSION / LENGTH},
        drive=("y", 0.5),
        force=rd.Impulse(mass * radius * omega),
        response=[("z", 0.5), ("y", 0.5)],
        tolerance=1e-7,
    )
    exact = radius * np.stack([np.cos(omega * time), np.sin(omega * time)])
    wrong = np.abs(history.value - exact)
    assert (wrong <= history.error).all()
    assert history.error.max() <= 1e-7 * radius
    # without what stretching adds it goes round a third more slowly
    assert omega > 1.15 * math.sqrt(4 * TENSION / LENGTH / mass)


def both_planes(time, force, kick, drag):
    """Return both motions of the sixth mass of `moving_string`."""
    _, z, y = moving_string(time, force, kick, drag)
    return np.stack([z[5], y[5]])


def moving_string(time, force, kick, drag, n=7):
    """Kirchhoff's string, mass by mass, by an independent integration: tension, z and y."""
    h = LENGTH / (n + 1)
    second = (2 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)) / h

    def rhs(t, state):
        z, y, dz, dy = state.reshape(4, n)
        tension = TENSION + AXIAL / (2 * LENGTH) * (z @ second @ z + y @ second @ y)
        fz, fy = (-tension * (second @ u) - drag * h * du for u, du in ((z, dz), (y, dy)))
        fz[1] += force.value(np.array(t))
        return np.concatenate([dz, dy, fz / (DENSITY * h), fy / (DENSITY * h)])

    begin = np.zeros(4 * n)
    begin[3 * n + 1] = kick / (DENSITY * h)
    kept = {"rtol": 1e-11, "atol": 1e-17}
    found = solve_ivp(rhs, (0, time[-1]), begin, "DOP853", time, **kept)
    z, y = found.y[:n], found.y[n : 2 * n]
    bent = (z * (second @ z) + y * (second @ y)).sum(axis=0)
    return TENSION + AXIAL / (2 * LENGTH) * bent, z, y


def test_a_string_driven_in_one_plane_whirls():
    time, force, kick = np.linspace(0.0, 0.9, 361), rd.Sine(40.0, 30.0), 1e-6
    model = string(8, damping=rd.ViscousDamping(1.0))
    history = model.transient(
        time,
        drive=[("z", 0.25), ("y", 0.25)],
        force=[force, rd.Impulse(kick)],
        response=[("z", 0.75), ("y", 0.75)],
        tolerance=1e-4,
    )
    assert history.cost.method == "collocation"
    exact = both_planes(time, force, kick, 1.0)
    assert (np.abs(history.value - exact) <= history.error).all()
    early, late = (np.abs(history.value[1, part]).max() for part in (slice(30), slice(-30, None)))
    assert late > 100 * early


@pytest.mark.parametrize("frequency", [[29.0, 30.0], *long(np.linspace(27.0, 31.0, 5))])
def test_planar_motion_that_is_stable_alone_gives_way_to_the_other_plane(frequency):
    asked = {"drive": ("z", 0.5), "amplitude": 20.0, "response": [("z", 0.5)]}
    damping = rd.ViscousDamping(1.0)
    both = string(4, damping=damping).stepped_sine(frequency, **asked)
    alone = string(4, damping=damping, planes="z").stepped_sine(frequency, **asked)
    near = np.isclose(both.value, alone.value, rtol=1e-6, atol=0)
    assert near.all()
    assert not both.stable[~alone.stable].any()
    assert (alone.stable & ~both.stable).any()


def test_internal_forces_feel_the_tension_that_stretching_adds():
    """The transverse share of a string's tension, by an independent integration."""
    time, force, kick = np.linspace(0.0, 0.2, 201), rd.Sine(40.0, 30.0), 1e-6
    model = string(8, damping=rd.ViscousDamping(1.0))
    history = model.transient(
        time,
        drive=[("z", 0.25), ("y", 0.25)],
        force=[force, rd.Impulse(kick)],
        response=[("F_z", 0.5), ("F_z", 0.0), ("F_y", 1.0)],
        tolerance=1e-4,
    )
    tension, z, y = moving_string(time, force, kick, 1.0)
    h = LENGTH / 8
    exact = tension / h * np.stack([z[3] - z[2], z[0], -y[6]])
    assert (np.abs(history.value - exact) <= history.error + 1e-9 * np.abs(exact)).all()
    assert np.ptp(tension) > 0.1 * TENSION


class BentChain:
    """A chain of rigid elements with a dashpot or without, while the tension is T + a cos(w t)."""

    def __init__(self, dashpot):
        self.rope = rd.Rope(1.3, 0.1, bending_stiffness=0.5, rotary_inertia=1e-6)
        self.gamma, self.amplitude, self.frequency = 2e-4, 30.0, 37.0
        self.damping = rd.RayleighDamping(2.0, self.gamma)
        self.parts = [rd.PointMass(0.65, 0.02)] + [rd.Dashpot(0.65, 1.5)] * dashpot
        varies = rd.Tension(100.0, amplitude=self.amplitude, frequency=self.frequency)
        self.model = self.under(varies)

    def under(self, tension):
        """Return the model under a tension."""
        kept = {"ends": ("clamped", "clamped"), "damping": self.damping, "parts": self.parts}
        return rd.Scene(self.rope, tension=tension, **kept).compile(elements=8, element="rigid")

    def motion(self, time, force):
        """Integrate z and beta of nodes 3 and 4, and their rates, driven in z at node 2."""
        one, two = (self.under(T) for T in (100.0, 101.0))
        M, C, K, more = (
            of().toarray()
            for of in (
                one.mass_matrix,
                one.damping_matrix,
                one.stiffness_matrix,
                two.stiffness_matrix,
            )
        )
        G, n = more - K, len(K)
        push = np.zeros(n)
        push[2] = 1.0

        def rhs(t, state):
            u, v = np.split(state, 2)
            tension = self.amplitude * math.cos(2 * math.pi * self.frequency * t)
            acts = push * force.value(np.array(t)) - C @ v - K @ u - tension * (G @ u)
            return np.concatenate([v, np.linalg.solve(M, acts)])

        kept = {"rtol": 1e-10, "atol": 1e-15}
        found = solve_ivp(rhs, (0, time[-1]), np.zeros(2 * n), "DOP853", time, **kept).y
        return found[4:8], found[n + 4 : n + 8]

    def left(self, tension):
        """Return what the element left of node 4 takes, per z and beta of its nodes."""
        triples = self.under(tension).triples
        F, G = triples.F[triples.element[3]], triples.G[triples.element[3]]
        return np.linalg.solve(G, np.hstack([-F, np.eye(2)]))


@pytest.mark.parametrize("dashpot", [False, True], ids=["modes", "coupled modes"])
def test_internal_forces_feel_a_tension_that_pulsates(dashpot):
    chain, time = BentChain(dashpot), np.linspace(0.0, 0.05, 101)
    force = rd.Sine(30.0, 21.0)
    asked = {"drive": ("z", 1.3 / 4), "force": force, "response": [("F_z", 0.65), ("M_beta", 0.65)]}
    history = chain.model.transient(time, **asked, tolerance=1e-4)
    assert history.cost.method == ("steps" if dashpot else "collocation")
    u, v = chain.motion(time, force)
    at_rest = chain.left(100.0)
    added = chain.amplitude * np.cos(2 * np.pi * chain.frequency * time)
    exact = at_rest @ (u + chain.gamma * v) + added * ((chain.left(101.0) - at_rest) @ u)
    wrong = np.abs(history.value - exact)
    assert (wrong <= history.error + 1e-9 * np.abs(exact).max(axis=1, keepdims=True)).all()
    assert (history.error.max(axis=1) <= 1e-4 * np.abs(exact).max(axis=1)).all()


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"response": ("F_z", 0.45)}, "must be an internal force at a node"),
        ({"response": ("F_z", 0.5), "quantity": "velocity"}, 'quantity must be "displacement" of'),
    ],
)
def test_internal_forces_that_modes_do_not_tell_are_refused(asked, message):
    given = {"drive": ("z", 0.5), "force": rd.Step(1.0)}
    with pytest.raises(rd.SceneError, match=message):
        string(4).transient(np.linspace(0, 0.1, 11), **given, **asked)
