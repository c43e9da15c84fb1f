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


def both_planes(time, force, kick, drag, n=7):
    """Kirchhoff's string in both planes, mass by mass, by an independent integration."""
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
    return found.y[[5, n + 5]]


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


@pytest.mark.parametrize("frequency", [[29.0, 30.0], *long(np.linspace(27.0, 31.0, 9))])
def test_planar_motion_that_is_stable_alone_gives_way_to_the_other_plane(frequency):
    asked = {"drive": ("z", 0.5), "amplitude": 20.0, "response": [("z", 0.5)]}
    damping = rd.ViscousDamping(1.0)
    both = string(4, damping=damping).stepped_sine(frequency, **asked)
    alone = string(4, damping=damping, planes="z").stepped_sine(frequency, **asked)
    near = np.isclose(both.value, alone.value, rtol=1e-6, atol=0)
    assert near.all()
    assert not both.stable[~alone.stable].any()
    assert (alone.stable & ~both.stable).any()


def test_internal_forces_are_not_told_where_the_tension_stretches():
    rope = rd.Rope(LENGTH, DENSITY, axial_stiffness=AXIAL, bending_stiffness=1.0)
    model = string(4, rope=rope)
    asked = {"drive": ("z", 0.5), "force": rd.Step(1.0), "response": ("M_beta", 0.5)}
    with pytest.raises(rd.SceneError, match="response must be the motion of a point"):
        model.transient(np.linspace(0, 0.1, 11), **asked)
