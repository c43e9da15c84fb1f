"""Dashpots on the rope and at its ends, and masses at the ends, against closed forms."""

import math

import mpmath
import numpy as np
import pytest
from conftest import EPS
from exact_chain import omega_of, relative
from mpmath import mpf

import ropedyn as rd

T, MU, L = 100.0, 0.1, 1.0
Z = math.sqrt(T * MU)
"""Wave impedance of the string [N s/m]."""
ROPE = rd.Rope(L, MU)
FREE = {"x": "free", "z": "free", "alpha": "free", "beta": "free"}
FREQUENCY = np.array([0.3, 15.0, 15.9, 47.3, 333.3])
KNOWN = 32 * EPS
"""Error over the condition of the answer: a few roundings along the walk; measured 3 eps."""


def wavenumber(omega):
    return omega * mpmath.sqrt(mpf(MU) / mpf(T))


def errors(model, drive, response, exact):
    """Errors over 1 + |d ln h/d ln omega|, each within its bound; `exact` of omega."""
    frf = model.frf(FREQUENCY, drive=drive, response=response)
    found = []
    with mpmath.workdps(50):
        for k, f in enumerate(FREQUENCY):
            omega, step = omega_of(f), mpf(10) ** -20
            h = exact(omega)
            error = relative(frf.value[0, k], h)
            condition = float(1 + abs(exact(omega * (1 + step)) / h - 1) / step)
            # places of a chain are tenths here and doubles there
            assert error <= frf.rounding_error[0, k] + EPS / 4 * condition
            found.append(error / condition)
    return found


@pytest.mark.parametrize("ratio", [0.01, 0.1, 0.5, 1.0, 2.0, 10.0, 100.0, 1e6, 1e12])
@pytest.mark.parametrize("elements", [None, 10, 1000])
@pytest.mark.claim(
    "FRF of a string with a dashpot, c/Z from 0.01 to 1e12, continuous spans and chains: error / "
    "condition",
    reference="closed form, mpmath 50 digits: tests/response/test_dashpot.py",
    accepted=KNOWN,
)
def test_string_with_a_dashpot_responds_as_its_closed_form(elements, ratio, claim):
    # 1/h = T k (cot k a + cot k b) + i omega c at the dashpot, u falls off as sin k x to the end
    a, x, c = 0.3, 0.1, ratio * Z
    scene = rd.Scene(ROPE, tension=T, parts=[rd.Dashpot(a, c)])

    def exact(omega):
        # a chain of masses m: 2 sin(theta/2) = omega sqrt(m l/T), and T k becomes T sin(theta)/l
        k, pull = wavenumber(omega), mpf(T) * wavenumber(omega)
        if elements:
            part = mpf(L) / elements
            theta = 2 * mpmath.asin(wavenumber(omega) * part / 2)
            k, pull = theta / part, mpf(T) * mpmath.sin(theta) / part
        left, first = (mpf(3) / 10, mpf(1) / 10) if elements else (mpf(a), mpf(x))
        stiffness = pull * (mpmath.cot(k * left) + mpmath.cot(k * (1 - left)))
        stiffness += 1j * omega * mpf(c)
        return mpmath.sin(k * first) / mpmath.sin(k * left) / stiffness

    claim(max(errors(scene.compile(elements=elements), ("z", a), ("z", x), exact)))


@pytest.mark.parametrize("elements", [None, 10])
def test_a_dashpot_without_end_is_a_support(elements):
    drive, response = ("z", 0.6), ("z", 0.9)
    held = rd.Scene(ROPE, tension=T, parts=[rd.Support(0.3)]).compile(elements=elements)
    h = held.frf(FREQUENCY, drive=drive, response=response).value
    for c in (1e6, 1e9, 1e12):
        scene = rd.Scene(ROPE, tension=T, parts=[rd.Dashpot(0.3, c)])
        frf = scene.compile(elements=elements).frf(FREQUENCY, drive=drive, response=response)
        # h (1 + O(pull/omega c)); T k |cot| < 1e5 N/m at these frequencies
        allowed = 1e5 / (2 * np.pi * FREQUENCY * c)
        assert (np.abs(frf.value / h - 1) <= allowed[None] + 1e-12).all()


def test_an_end_dashpot_of_the_wave_impedance_absorbs_every_wave():
    # the string clamped at 0 that never ends: h(x, y) = sin(k x) exp(-i k y)/(T k), x <= y
    ends = ("clamped", rd.End(**FREE, dashpot={"z": Z}))
    model = rd.Scene(ROPE, tension=T, ends=ends).compile()
    x, y = 0.25, 0.75

    def exact(omega):
        # the damping is the double next to Z, not Z: reflection r = (Z - c)/(Z + c)
        c, impedance = mpf(Z), mpmath.sqrt(mpf(T) * mpf(MU))
        k, r = wavenumber(omega), (impedance - c) / (impedance + c)
        outward, back = mpmath.expj(-k * mpf(y)), mpmath.expj(k * (mpf(y) - 2 * mpf(L)))
        return (
            mpmath.sin(k * mpf(x))
            * (outward + r * back)
            / (mpf(T) * k * (1 + r * mpmath.expj(-2 * k * mpf(L))))
        )

    assert max(errors(model, ("z", y), ("z", x), exact)) <= KNOWN


def test_a_string_between_two_such_ends_has_no_resonance():
    # the endless string: h = 1/(2 i omega Z), wherever it is driven, 1/f in size
    end = rd.End(**FREE, dashpot={"z": Z})
    model = rd.Scene(ROPE, tension=T, ends=(end, end)).compile()
    frf = model.frf(FREQUENCY, drive=[("z", 0.2), ("z", 0.7)])
    exact = 1 / (2j * 2 * np.pi * FREQUENCY * Z)
    for k in range(2):
        # argument k L of a few hundred radians, each with its eps
        np.testing.assert_allclose(frf.value[k, k], exact, rtol=1e-12)


@pytest.mark.parametrize("elements", [None, 7])
def test_a_dashpot_at_the_very_end_is_that_of_the_end(elements):
    given = rd.Scene(ROPE, tension=T, ends=("free", "clamped"), parts=[rd.Dashpot(0.0, 2.0)])
    ends = (rd.End(**FREE, dashpot={"z": 2.0}), "clamped")
    f = [3.0, 40.0]
    one, other = (
        scene.compile(elements=elements).frf(f, drive=("z", 0.4))
        for scene in (given, rd.Scene(ROPE, tension=T, ends=ends))
    )
    np.testing.assert_array_equal(one.value, other.value)


@pytest.mark.parametrize("elements", [None, 7])
@pytest.mark.parametrize("side", [0, 1])
def test_masses_of_an_end_are_point_masses_there(side, elements):
    rope = rd.Rope(L, MU, bending_stiffness=2.0, torsional_stiffness=0.4, axial_stiffness=1e4)
    rope = rope.replace(polar_inertia=1e-6)
    body = rd.PointMass(side * L, 0.2, rotary_inertia=1e-3, polar_inertia=2e-4)
    mass = {"x": 0.2, "z": 0.2, "alpha": 2e-4, "beta": 1e-3}
    ends = ["clamped", "clamped"]
    ends[side] = rd.End(**FREE, mass=mass)
    bare = ["clamped", "clamped"]
    bare[side] = "free"
    models = [
        rd.Scene(rope, tension=T, ends=ends).compile(elements=elements),
        rd.Scene(rope, tension=T, ends=bare, parts=[body]).compile(elements=elements),
    ]
    np.testing.assert_array_equal(*(model.chain.mass for model in models))
    np.testing.assert_array_equal(*(model.modes(5).frequency for model in models))


def test_damping_ratio_of_a_dashpot_is_what_it_takes_per_radian():
    # z = sin(k x), omega = k sqrt(T/mu): zeta = c z^2/(2 omega m), m = mu L/2
    x, c = 0.2, 1e-3
    modes = rd.Scene(ROPE, tension=T, parts=[rd.Dashpot(x, c)]).compile().modes(4)
    k = np.pi * np.arange(1, 5) / L
    exact = c * np.sin(k * x) ** 2 / (2 * k * math.sqrt(T / MU) * MU * L / 2)
    # the shape squared: a few eps
    np.testing.assert_allclose(modes.damping_ratio, exact, rtol=64 * EPS)


def test_damping_matrix_has_the_dashpots_on_its_diagonal():
    rope = rd.Rope(L, MU, bending_stiffness=2.0)
    parts = [rd.Dashpot(0.5, 3.0), rd.Dashpot(0.5, 0.2, coordinate="beta"), rd.Dashpot(0.25, 7.0)]
    model = rd.Scene(rope, tension=T, parts=parts).compile(elements=4)
    # free coordinates: (z, beta) of three nodes
    expected = np.diag([7.0, 0.0, 3.0, 0.2, 0.0, 0.0])
    np.testing.assert_array_equal(model.damping_matrix().toarray(), expected)
