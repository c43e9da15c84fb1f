"""Modes under compression, up to the chain's own critical load and beyond it."""

import math

import numpy as np
import pytest
from conftest import BENDING, EPS, LENGTH, beam
from exact_counts import ExactChain, eigenvalue_bound, exact_chain, is_bounded

import ropedyn as rd

ENDS = pytest.mark.parametrize("ends", ["clamped", "pinned"])
KINDS = pytest.mark.parametrize("element", ["rigid", "tensed"])
CHAINS = pytest.mark.parametrize("n", [2, 3, 4, 8])
NEAR = [10.0**-k for k in (2, 4, 6, 8, 10, 12)]


def critical_load(n, ends, element):
    """Of the chain itself [N].

    One half wave between pins, 1 - cos between clamps: c = cos(pi/n) or cos(2 pi/n) satisfies
    tau = T a^2/B = -6 (1 - c)/(2 + c) on rigid elements (det of the static waves); tensed ones
    are the exact beam's.
    """
    wave = (1 if ends == "pinned" else 2) * math.pi
    if element == "tensed":
        return wave**2 * BENDING / LENGTH**2
    c = math.cos(wave / n)
    return 6 * (1 - c) / (2 + c) * BENDING / (LENGTH / n) ** 2


def pushed(n, ends, element, load):
    scene = beam(n, tension=-load, ends=(ends, ends), rotary=False)
    return scene.compile(elements=n, element=element)


def checked(model, number):
    """Return certified modes that are as near the exact ones as they say."""
    modes = model.modes(number, solver="sweep")
    assert modes.certified
    exact = exact_chain(model, 80)
    assert is_bounded(exact, modes).all()
    return exact, modes


@CHAINS
@ENDS
@KINDS
@pytest.mark.parametrize("away", NEAR)
def test_first_frequency_keeps_what_the_critical_load_leaves(away, element, ends, n):
    model = pushed(n, ends, element, critical_load(n, ends, element) * (1 - away))
    exact, modes = checked(model, 1)
    assert modes.growth[0] == 0
    # lambda falls with 1 - T/Tc: a change of eps of the load is one of eps/(1 - T/Tc)
    allowed = 1e2 * EPS / away * modes.eigenvalue[0]
    assert exact.error(0, modes.eigenvalue[0]) <= allowed
    assert modes.frequency[0] > 0 or away < 1e3 * EPS


@CHAINS
@ENDS
@KINDS
@pytest.mark.parametrize("away", NEAR)
def test_growth_just_beyond_the_critical_load(away, element, ends, n):
    model = pushed(n, ends, element, critical_load(n, ends, element) * (1 + away))
    exact, modes = checked(model, 1)
    assert exact.error(0, modes.eigenvalue[0]) <= 1e2 * EPS / away * abs(modes.eigenvalue[0])
    assert modes.frequency[0] == 0
    assert modes.growth[0] == math.sqrt(-modes.eigenvalue[0]) > 0


@KINDS
@ENDS
@pytest.mark.parametrize("load", [1.5, 3.7, 30.0])
@pytest.mark.parametrize("n", [2, 3, 4, 8, 64])
def test_all_modes_far_beyond_the_critical_load(n, load, ends, element):
    # rotations have inertia: without it nothing holds them where single elements buckle
    scene = beam(n, tension=-load * critical_load(n, ends, element), ends=(ends, ends))
    model = scene.compile(elements=n, element=element)
    _, modes = checked(model, min(model.size, 8))
    assert modes.growth[0] > 0
    # the stiffness is a difference of two that are as large as the fastest growth squared
    assert (eigenvalue_bound(modes) <= 1e-11 * np.abs(modes.eigenvalue).max()).all()


@CHAINS
def test_massless_rotations_that_buckle_are_refused(n):
    # beyond Euler's load of one element between pins, (n pi)^2 B/L^2: no motion is the fastest
    load = 1.01 * (n * math.pi) ** 2 * BENDING / LENGTH**2
    model = pushed(n, "pinned", "tensed", load)
    assert ExactChain(model.chain).count(-1e30) > 0
    with pytest.raises(rd.SolveError, match="without mass"):
        model.modes(1, solver="sweep")


@KINDS
def test_load_of_a_long_chain_is_eulers(element):
    n = 1000
    euler = 4 * math.pi**2 * BENDING / LENGTH**2
    # rigid: 1 + (2 pi/n)^2/12 and higher
    ratio = critical_load(n, "clamped", element) / euler
    assert ratio == pytest.approx(1, abs=(2 * math.pi / n) ** 2)
    before, beyond = (
        pushed(n, "clamped", element, critical_load(n, "clamped", element) * (1 + side))
        for side in (-1e-9, 1e-9)
    )
    assert before.modes(1, solver="sweep").frequency[0] > 0
    assert beyond.modes(1, solver="sweep").growth[0] > 0
