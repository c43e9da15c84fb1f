"""Responses exactly at an undamped frequency whose mode stands still where the force acts.

In the middle of a rope that is its own mirror image a force moves what is even alone, and modes
that are odd stand still there. What is even is written without a pole at their frequencies.
"""

import math

import mpmath
import numpy as np
import pytest
from conftest import LENGTH, beam
from mpmath import mpf
from scipy.linalg import eigh

import ropedyn as rd

DIGITS = 50
STRING = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0)
MIDDLE = ("z", 0.5)
NAMED = r"frequency 100\.0 Hz has no correct digit in \(z\): it lies on an undamped resonance"


def wavenumber(f):
    """Of the string [1/m]."""
    return 2 * mpmath.pi * mpf(f) * mpmath.sqrt(mpf(0.1) / 1000)


def even_string(f, x, length=1):
    """z at x per force in the middle, to the left of it: sin(k x)/(2 T k cos(k L/2))."""
    k = wavenumber(f)
    return mpmath.sin(k * mpf(x)) / (2000 * k * mpmath.cos(k * mpf(length) / 2))


def hold(frf, exact, most):
    """Hold a single answer to its bound, and that to what is accepted."""
    error = abs(mpmath.mpmathify(complex(frf.value[0, 0])) - exact)
    assert error <= frf.rounding_limit[0, 0] <= most


@pytest.mark.parametrize("mode", [2, 4, 10, 200])
@pytest.mark.parametrize("x", [0.5, 0.3, 0.125])
def test_strings_are_answered(mode, x):
    f = 50.0 * mode
    with mpmath.workdps(DIGITS):
        frf = STRING.compile().frf(f, drive=MIDDLE, response=("z", x))
        # beside the largest on the rope, 1/(2 T k)
        hold(frf, even_string(f, x), 1e-11 / (2000 * mode * math.pi))


@pytest.mark.parametrize("mode", [2, 4, 8])
@pytest.mark.parametrize("tension", [0.0, 300.0])
def test_beams_are_answered(mode, tension):
    # B z'''' - T z'' - mu omega^2 z = B (D^2 + a^2) (D^2 - b^2) z
    with mpmath.workdps(DIGITS):
        L, mu, B, T = (mpf(value) for value in (1.35, 0.1017, 1.54, tension))
        k = mode * mpmath.pi / L
        f = float(k * mpmath.sqrt((B * k**2 + T) / mu) / (2 * mpmath.pi))
        half = T / (2 * B)
        root = mpmath.sqrt(half**2 + mu * (2 * mpmath.pi * mpf(f)) ** 2 / B)
        a, b, x = mpmath.sqrt(root - half), mpmath.sqrt(root + half), mpf(0.3)
        exact = mpmath.sin(a * x) / (a * mpmath.cos(a * L / 2))
        exact -= mpmath.sinh(b * x) / (b * mpmath.cosh(b * L / 2))
        exact /= 2 * B * (a**2 + b**2)
        rope = rd.Rope(1.35, 0.1017, bending_stiffness=1.54)
        scene = rd.Scene(rope, tension=tension, ends=("pinned", "pinned"))
        frf = scene.compile().frf(f, drive=("z", 0.675), response=("z", 0.3))
        hold(frf, exact, 1e-11 * float(abs(exact)))


@pytest.mark.parametrize("solver", ["sweep", "band", "lapack"])
@pytest.mark.parametrize("mode", [2, 6])
def test_chains_of_strings_are_answered(solver, mode):
    # of eight elements, m omega^2 = K (2 - 2 cos p): z_j = sin(p j)/(2 K sin(p) cos(4 p))
    with mpmath.workdps(DIGITS):
        m, K = mpf(0.1) / 8, mpf(8000)
        f = float(mpmath.sqrt(K / m) * mpmath.sin(mode * mpmath.pi / 16) / mpmath.pi)
        p = 2 * mpmath.asin(mpmath.pi * mpf(f) * mpmath.sqrt(m / K))
        exact = mpmath.sin(3 * p) / (2 * K * mpmath.sin(p) * mpmath.cos(4 * p))
        model = STRING.compile(elements=8, element="rigid")
        frf = model.frf(f, drive=MIDDLE, response=("z", 0.375), solver=solver)
        # at the double beside it an assembled matrix is not refused, and loses its digits along the
        # mode: that is in the bound
        hold(frf, exact, 1e-11 * float(abs(exact)) if solver == "sweep" else math.inf)


@pytest.mark.parametrize("solver", ["sweep", "band", "lapack"])
@pytest.mark.parametrize("mode", [2, 4])
def test_chains_of_beams_are_answered_among_other_lines(solver, mode):
    model = beam(16, tension=300.0).compile(elements=16, element="rigid")
    f = float(model.modes(mode).frequency[mode - 1])
    square, shape = eigh(model.stiffness_matrix().toarray(), model.mass_matrix().toarray())
    middle, other = shape[len(shape) // 2 - 1], np.arange(len(square)) != mode - 1
    exact = (middle**2 / (square - (2 * np.pi * f) ** 2))[other].sum()
    frf = model.frf([0.9 * f, f, f, 1.1 * f], drive=("z", LENGTH / 2), solver=solver)
    assert frf.value[0, 1] == frf.value[0, 2]
    # the eigenvalues of the check keep 13 digits beside the largest, 10 beside these
    assert abs(frf.value[0, 1] / exact - 1) <= 1e-10
    assert frf.rounding_error[0, 1] <= 1e-9


def test_two_equal_modes_may_both_stand_still():
    # on both sides of a support a string has the same frequencies
    model = STRING.replace(parts=[rd.Support(0.5)]).compile()
    with mpmath.workdps(DIGITS):
        for x in (0.25, 0.125):
            frf = model.frf(200.0, drive=("z", 0.25), response=("z", x))
            hold(frf, even_string(200.0, x, length=0.5), 1e-15)
    with pytest.raises(rd.SolveError, match=NAMED):
        model.frf(100.0, drive=("z", 0.25))


@pytest.mark.parametrize("apart", [1e-2, 1e-3, 1e-4, 1e-5])
def test_another_mode_may_be_near(apart):
    # beside a stiff spring half way what is odd about it has the frequencies of one side, and what
    # is even those of one side on half the spring
    spring = rd.Spring(1.0, 1e3 / apart)
    model = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0, parts=[spring]).compile()
    with mpmath.workdps(DIGITS):
        k = wavenumber(100.0)
        pull, half = 1000 * k, mpf(spring.stiffness) / 2
        even = mpmath.sin(k * mpf(0.3)) * (pull * mpmath.cos(k / 2) + half * mpmath.sin(k / 2))
        even /= pull * (pull * mpmath.cos(k) + half * mpmath.sin(k))
        frf = model.frf(100.0, drive=MIDDLE, response=("z", 0.3))
        hold(frf, (even_string(100.0, 0.3) + even) / 2, 1e-17 / apart)


def test_a_dashpot_may_stand_at_the_node_of_the_mode():
    # the mode is undamped, and what answers is little damped by 1 + i omega c h there
    model = STRING.replace(parts=[rd.Dashpot(0.5, 1.0)]).compile()
    with mpmath.workdps(DIGITS):
        own = 2 * mpmath.pi * 100j * even_string(100.0, 0.5)
        exact = even_string(100.0, 0.3) / (1 + own)
        hold(model.frf(100.0, drive=MIDDLE, response=("z", 0.3)), exact, 1e-16)
    with pytest.raises(rd.SolveError, match=NAMED):
        model.frf(100.0, drive=("z", 0.3))


@pytest.mark.parametrize("x", [0.0, 0.3])
def test_a_line_alone_is_answered_by_its_internal_force(x):
    # T z'
    with mpmath.workdps(DIGITS):
        k = wavenumber(100.0)
        exact = mpmath.cos(k * mpf(x)) / (2 * mpmath.cos(k / 2))
        hold(STRING.compile().frf(100.0, drive=MIDDLE, response=("F_z", x)), exact, 1e-12)


def test_the_middle_answers_an_end_that_is_moved_and_no_other_place_does():
    # sin(k (L - x))/sin(k L) = 1/(2 cos(k L/2)) half way
    model = STRING.compile()
    frf = model.frf([99.0, 100.0], drive=("end", 0, "z"), response=MIDDLE)
    with mpmath.workdps(DIGITS):
        exact = [1 / (2 * mpmath.cos(wavenumber(f) / 2)) for f in (99.0, 100.0)]
    assert (np.abs(frf.value[0] - np.array(exact, float)) <= frf.rounding_limit[0]).all()
    assert (frf.rounding_limit[0] <= 1e-12).all()
    with pytest.raises(rd.SolveError, match=NAMED):
        model.frf([99.0, 100.0], drive=("end", 0, "z"), response=("z", 0.3))


def test_structures_may_stand_at_the_node():
    resonator = rd.Resonator(0.5, 0.01, 40.0)
    model = STRING.replace(parts=[resonator]).compile()
    # the second mode of the rope alone, in which the resonator stands still
    frf = model.frf([100.0], drive=MIDDLE, response=("z", 0.3))
    with mpmath.workdps(DIGITS):
        # its dynamic stiffness k m lambda/(m lambda - k), seen beside that of the rope
        lam = (2 * mpmath.pi * 100) ** 2
        beside = -40 * mpf(0.01) * lam / (40 - mpf(0.01) * lam)
        exact = even_string(100.0, 0.3) / (1 + beside * even_string(100.0, 0.5))
        hold(frf, exact, 1e-15)
