"""Responses of the sweep against the exact discrete system, eliminated in 60 digits and more."""

import itertools
import re

import mpmath
import numpy as np
import pytest
from exact_chain import error_over_condition, omega_of, relative
from mpmath import mpf

import ropedyn as rd


def check(model, f, drive, node, *, response=None, bound=1e-13):
    """Hold a response to a force at a node against the exact one: bound times its condition."""
    error, _ = error_over_condition(model, f, (drive, node), response)
    assert error <= bound


# every length, pair of ends, tension and frequency ------------------------------------------------

ENDS = list(itertools.product(("clamped", "pinned", "free"), repeat=2))
XI_SQUARED = (0.0, 10.0, 1e4, 1e8)
LENGTH, BENDING, DENSITY = 1.35, 1.54, 0.1017
BOUND = 1e-13
"""Of the error over the condition of the answer: issue 4."""


def scene(ends=("clamped", "clamped"), xi2=0.0, **more):
    more.setdefault("rope", rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING))
    return rd.Scene(tension=xi2 * BENDING / LENGTH**2, ends=ends, **more)


def driven(n, ends):
    """Coordinate and node of a force that can move something, or None: two clamps, no node."""
    if n > 1:
        return "z", (n + 1) // 2
    for node in (1, 0):
        if ends[node] != "clamped":
            return ("z" if ends[node] == "free" else "beta"), node
    return None


@pytest.mark.parametrize("xi2", XI_SQUARED)
@pytest.mark.parametrize("ends", ENDS, ids="-".join)
@pytest.mark.parametrize("n", [1, 2, 3, 8, 64])
@pytest.mark.parametrize("element", ["rigid", "tensed"])
@pytest.mark.claim(
    "FRF of chains of 1 to 64 elements, every pair of ends, T L^2/B from 0 to 1e8, 0.01 (free-free "
    "and pinned too) to 1111 Hz: error / condition",
    reference="mpmath, 60 digits: tests/support/exact_chain.py",
    accepted=5e-14,
)
def test_chain_responds_as_the_exact_discrete_one(element, n, ends, xi2, claim):
    drive = driven(n, ends)
    if drive is None:
        # one element between clamps: nothing moves, not even a rounding error
        frf = (
            scene(ends, xi2)
            .compile(elements=n, element=element)
            .frf(1.0, drive=("z", 0.0), solver="sweep")
        )
        assert (frf.value == 0).all()
        return
    model = scene(ends, xi2).compile(elements=n, element=element)
    # the long ones cost the reference most
    for f in (0.01, 111.0, 1111.0) if n == 64 else (0.01, 1.0, 111.0, 1111.0):
        error, _ = error_over_condition(model, f, drive)
        claim(error)


# what the element carries besides --------------------------------------------------------------

WIDE = rd.Rope(
    1.35,
    0.1,
    bending_stiffness=5.0,
    torsional_stiffness=1.0,
    axial_stiffness=9e4,
    rotary_inertia=1e-6,
    polar_inertia=1e-6,
)
DAMPINGS = {
    "undamped": None,
    "stiffness": rd.StiffnessDamping(1e-4),
    "sum": (rd.RayleighDamping(2.0, 1e-5), rd.StiffnessDamping(1e-5)),
}


@pytest.mark.parametrize("damping", DAMPINGS)
@pytest.mark.parametrize("f", [1.0, 111.0, 1111.0])
@pytest.mark.parametrize("n", [1, 8])
@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_damped_chain_responds_as_the_exact_discrete_one(element, n, f, damping):
    model = scene(("clamped", "free"), 1e4, damping=DAMPINGS[damping]).compile(
        elements=n, element=element
    )
    check(model, f, "z", (n + 1) // 2, bound=BOUND)


@pytest.mark.parametrize("f", [1.0, 111.0, 1111.0])
@pytest.mark.parametrize("damping", DAMPINGS)
@pytest.mark.parametrize("slope", [0.01, 1.0])
@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_bending_that_twists_responds_as_the_exact_discrete_one(element, slope, damping, f):
    rope = WIDE.replace(axial_stiffness=None, lay_slope=slope)
    laid = rd.Scene(rope, tension=40.0, damping=DAMPINGS[damping], ends=("clamped", "pinned"))
    model = laid.compile(elements=8, element=element)
    assert model.component_of("z") == ("z", "alpha", "beta")
    for drive in ("z", "alpha"):
        check(model, f, drive, 3, bound=BOUND)


@pytest.mark.parametrize("f", [1.0, 111.0, 1111.0])
@pytest.mark.parametrize("ends", [("clamped", "clamped"), ("clamped", "free")], ids="-".join)
@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_stretch_that_twists_responds_as_the_exact_discrete_one(element, ends, f):
    model = rd.Scene(WIDE.replace(lay_coupling=-200.0), tension=40.0, ends=ends).compile(
        elements=8, element=element
    )
    assert model.component_of("x") == ("x", "alpha")
    for drive in ("x", "alpha"):
        check(model, f, drive, 3, bound=BOUND)
    # of the order of the direct ones, since D^2 is 0.44 of EA C
    check(model, f, "x", 3, response=("alpha", 6), bound=BOUND)


@pytest.mark.parametrize("f", [1.0, 111.0, 1111.0])
@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_everything_coupled_responds_as_the_exact_discrete_one(element, f):
    rope = WIDE.replace(lay_coupling=-200.0, lay_slope=0.3)
    model = rd.Scene(rope, tension=40.0).compile(elements=5, element=element)
    assert len(model.component_of("z")) == 4
    for drive in model.coordinates:
        check(model, f, drive, 2, bound=BOUND)


# what stands on the rope -----------------------------------------------------------------------

STANDING = {
    "masses of ratio 1e12": [rd.PointMass(0.3, 1e6), rd.PointMass(0.8, 1e-6)],
    "rotary inertia": [rd.PointMass(0.3, 0.0, rotary_inertia=10.0), rd.PointMass(0.8, 1e3)],
    "supports": [rd.Support(0.3), rd.Support(0.8), rd.Support(1.0, coordinate="beta")],
    "springs": [rd.Spring(0.3, 1e9), rd.Spring(0.8, 1e-3), rd.Spring(1.1, 50.0, coordinate="beta")],
    "springs of both signs": [rd.Spring(0.3, 400.0), rd.Spring(0.8, -30.0)],
    "negative rotational spring": [rd.Spring(0.8, -2.0, coordinate="beta")],
}


@pytest.mark.parametrize("f", [0.01, 1.0, 111.0, 1111.0])
@pytest.mark.parametrize("parts", STANDING)
@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_chain_with_parts_responds_as_the_exact_discrete_one(element, parts, f):
    standing = rd.Scene(
        rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING),
        tension=30.0,
        ends=("clamped", "pinned"),
        parts=STANDING[parts],
    )
    model = standing.compile(elements=11, element=element)
    check(model, f, "z", int(np.abs(model.x - 0.5).argmin()), bound=BOUND)
    check(model, f, "beta", int(np.abs(model.x - 0.8).argmin()), bound=BOUND)


HANGING = {
    "light and heavy": [rd.PointMass(0.31, 1e4, polar_inertia=20.0), rd.PointMass(0.8, 1e-5)],
    "of every kind": [
        rd.PointMass(0.2, 0.05, rotary_inertia=1e-4, polar_inertia=1e-5),
        rd.Spring(0.55, 300.0),
        rd.Spring(0.71, -0.2, coordinate="alpha"),
        rd.Support(0.9, coordinate="alpha"),
        rd.PointMass(1.13, 0.2, rotary_inertia=1e-3),
    ],
}


@pytest.mark.parametrize("f", [1.0, 111.0, 1111.0])
@pytest.mark.parametrize("damping", DAMPINGS)
@pytest.mark.parametrize("parts", HANGING)
@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_laid_rope_of_different_elements_responds_as_the_exact_discrete_one(
    element, parts, damping, f
):
    rope = WIDE.replace(axial_stiffness=None, lay_slope=0.3)
    laid = rd.Scene(rope, tension=40.0, damping=DAMPINGS[damping], parts=HANGING[parts])
    model = laid.compile(elements=9, element=element)
    for drive in ("z", "alpha"):
        check(model, f, drive, 4, bound=BOUND)


# long chains -----------------------------------------------------------------------------------


def pinned_middle(n, tension, f):
    """Receptance in the middle of a pinned rigid chain, j = 0: closed form of two waves.

    z_i = A sin(phi i) + C sinh(psi i), a beta_i = A b1 cos(phi i) + C b2 cosh(psi i) with
    cos phi, cosh psi the roots c of ((24 + 2 tau)(1 - c) - lambda)(8 + 4 c) = 144 (1 - c^2),
    b = 12 s/(8 + 4 c); in the middle beta = 0 and
    (24 + 2 tau - lambda) z_m - (24 + 2 tau) z_m-1 - 12 a beta_m-1 = a^3/B.
    """
    a = mpf(LENGTH) / n
    tau = mpf(tension) * a**2 / mpf(BENDING)
    unit = a**3 / mpf(BENDING)
    lam = omega_of(f) ** 2 * mpf(DENSITY) * a * unit
    p = 24 + 2 * tau
    # (144 - 4 p) c^2 + (4 (p - lam) - 8 p) c + 8 (p - lam) - 144 = 0
    e2, e1, e0 = 144 - 4 * p, 4 * (p - lam) - 8 * p, 8 * (p - lam) - 144
    root = mpmath.sqrt(e1**2 - 4 * e2 * e0)
    c1, c2 = sorted([(-e1 - root) / (2 * e2), (-e1 + root) / (2 * e2)])
    phi, psi = mpmath.acos(c1), mpmath.acosh(c2)
    b1, b2 = 12 * mpmath.sin(phi) / (8 + 4 * c1), 12 * mpmath.sinh(psi) / (8 + 4 * c2)
    m = n // 2
    # beta_m = 0 with A = 1
    C = -b1 * mpmath.cos(phi * m) / (b2 * mpmath.cosh(psi * m))

    def z(i):
        return mpmath.sin(phi * i) + C * mpmath.sinh(psi * i)

    beta = b1 * mpmath.cos(phi * (m - 1)) + C * b2 * mpmath.cosh(psi * (m - 1))
    return unit * z(m) / ((p - lam) * z(m) - p * z(m - 1) - 12 * beta)


@pytest.mark.parametrize("f", [0.01, 1.0, 111.0, 1111.0])
@pytest.mark.parametrize("tension", [0.0, 30.0, 2830.0])
@pytest.mark.parametrize("n", [8, 10**4, 10**6])
@pytest.mark.claim(
    "FRF of uniform chains of 8 to 10^6 elements, 0.01 to 1111 Hz: error / condition",
    reference="closed form of the pinned rigid chain (two waves), mpmath 90 digits",
    accepted=4e-14,
)
def test_long_pinned_chain_responds_as_its_two_waves(n, tension, f, claim):
    long = rd.Scene(
        rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING),
        tension=tension,
        ends=("pinned", "pinned"),
    )
    frf = long.compile(elements=n, element="rigid").frf(f, drive=("z", LENGTH / 2), solver="sweep")
    with mpmath.workdps(90):
        h = pinned_middle(n, tension, f)
        step = mpf(10) ** -20
        slope = abs(pinned_middle(n, tension, mpf(f) * (1 + step)) / h - 1) / step
        error = relative(frf.value[0, 0], h)
        claim(error / float(1 + slope))
        assert error <= frf.rounding_error[0, 0]
    assert frf.value[0, 0].imag == 0


@pytest.mark.parametrize(
    "resonant",
    [
        rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=2.0), ends=("free", "free")),
        rd.Scene(rd.Rope(1.0, 0.1), tension=8.0, ends=("free", "free")),
        # a string of two elements, T/l = 16 each, against a spring of -32
        rd.Scene(rd.Rope(1.0, 0.1), tension=8.0, parts=[rd.Spring(0.5, -32.0)]),
    ],
    ids=["free beam", "free string", "negative spring"],
)
@pytest.mark.parametrize("element", ["rigid", "tensed"])
@pytest.mark.parametrize("solver", ["sweep", "band"])
def test_undamped_resonance_is_an_error_that_names_the_frequency(resonant, element, solver):
    # at 0 Hz the resonance is exact in doubles
    model = resonant.compile(elements=2, element=element)
    with pytest.raises(rd.SolveError, match=re.escape("frequency 0.0 Hz")):
        model.frf([5.0, 0.0, 7.0], drive=("z", 0.5), solver=solver)
    with pytest.raises(rd.SolveError, match="singular"):
        model.static({("z", 0.5): 1.0}, solver=solver, unstable=True)
