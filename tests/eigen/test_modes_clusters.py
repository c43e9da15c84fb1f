"""Modes that lie together: certified, and right by counts in 80 digits."""

import math

import numpy as np
import pytest
from conftest import BENDING, LENGTH, MASS, beam
from exact_counts import ExactChain, certified_modes, exact_chain, is_bounded

import ropedyn as rd

ELEMENTS = pytest.mark.parametrize("element", ["rigid", "tensed"])
EULER = (math.pi / LENGTH) ** 2 * BENDING
"""Critical load of the pinned beam [N]."""


@ELEMENTS
@pytest.mark.parametrize("tension", [0.0, 2830.0])
@pytest.mark.parametrize("ends", ["clamped", "pinned"])
@pytest.mark.parametrize("mass", [1e3, 1e6, 1e9, 1e12])
def test_two_equal_spans_about_a_heavy_mass(mass, ends, tension, element):
    # a mass of so many kg on 0.14 kg of rope hardly moves: each span has the other's frequencies
    heavy = rd.PointMass(LENGTH / 2, mass, rotary_inertia=mass)
    scene = beam(16, tension=tension, ends=(ends, ends), rotary=False, parts=[heavy])
    modes = certified_modes(scene.compile(elements=16, element=element), 8)
    first, second = modes.eigenvalue[2:8:2], modes.eigenvalue[3:8:2]
    # they differ by a share of rope over mass
    np.testing.assert_allclose(first, second, rtol=1e2 * MASS / mass)
    assert modes.frequency[1] < 1e-2 * modes.frequency[2]


@ELEMENTS
@pytest.mark.parametrize("mass", [1e3, 1e6, 1e9, 1e12])
def test_two_equal_strings_about_a_heavy_mass(mass, element):
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=300.0, parts=[rd.PointMass(0.5, mass)])
    certified_modes(scene.compile(elements=32, element=element), 9)


@ELEMENTS
@pytest.mark.parametrize("slope", [0.0, 1e-9, 1e-6, 1e-3])
def test_bending_that_meets_torsion(slope, element):
    # polar inertia that puts the first torsional frequency on the first transverse one
    n, C, p = 16, 0.15, 1e-6
    bending = beam(n, tension=300.0, rotary=False).compile(elements=n, element=element)
    shaft = rd.Rope(LENGTH, MASS / LENGTH, torsional_stiffness=C, polar_inertia=p)
    twist = rd.Scene(shaft).compile(elements=n, element=element)
    f, g = (m.modes(1, solver="sweep").frequency[0] for m in (bending, twist))
    rope = shaft.replace(bending_stiffness=BENDING, polar_inertia=p * (g / f) ** 2, lay_slope=slope)
    model = rd.Scene(rope, tension=300.0).compile(elements=n, element=element)
    modes = certified_modes(model, 6)
    # the two veer apart by the share H of the coupling
    assert modes.frequency[0] == pytest.approx(modes.frequency[1], rel=max(10 * slope, 1e-14))


@pytest.mark.parametrize("n", [8, 32, 64])
def test_double_eigenvalue_of_a_clamped_beam_under_ten_euler_loads(n):
    # T = -10 pi^2 B/L^2: lambda = -9 pi^4 B/(mu L^4) twice in the continuum; the chain of fourth
    # order splits it by (2 pi/n)^4/720 and a few times
    scene = beam(n, tension=-10 * EULER, rotary=False)
    modes = certified_modes(scene.compile(elements=n, element="tensed"), 4)
    exact = -9 * math.pi**4 * BENDING / (MASS / LENGTH * LENGTH**4)
    split = 50 * (2 * math.pi / n) ** 4 / 720
    np.testing.assert_allclose(modes.eigenvalue[:2], exact, rtol=split)
    assert (modes.growth[:2] > 0).all()
    assert (modes.frequency[:2] == 0).all()


def test_ten_equal_string_spans_have_a_tenfold_frequency():
    supports = [rd.Support(k / 10) for k in range(1, 10)]
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, parts=supports)
    modes = certified_modes(scene.compile(elements=100), 20)
    a = 0.01
    exact = [
        math.sqrt(4 * 100.0 / (0.1 * a**2)) * math.sin(k * math.pi / 20) / (2 * math.pi)
        for k in (1, 2)
    ]
    # spans of a tenth are spans of a tenth to a few eps
    np.testing.assert_allclose(modes.frequency, np.repeat(exact, 10), rtol=1e-14)


def test_shapes_of_a_tenfold_frequency_are_independent():
    supports = [rd.Support(k / 10) for k in range(1, 10)]
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, parts=supports).compile(elements=100)
    shape = model.modes(10, solver="sweep").shape[:, :, 0]
    # each of unit amplitude in one span: the Gram matrix is diagonal
    gram = shape @ shape.T
    np.testing.assert_allclose(gram, np.diag(np.diag(gram)), atol=1e-12)
    assert (np.diag(gram) > 1).all()


@ELEMENTS
def test_continuous_beam_on_many_supports_has_a_band(element):
    supports = [rd.Support(LENGTH * k / 10) for k in range(1, 10)]
    scene = beam(100, tension=300.0, ends=("pinned", "pinned"), rotary=False, parts=supports)
    modes = certified_modes(scene.compile(elements=100, element=element), 12)
    # the lowest is that of one span between pins: half a wave each, in turn up and down
    span = beam(10, tension=300.0, ends=("pinned", "pinned"), rotary=False)
    rope = span.rope.replace(length=LENGTH / 10)
    own = rd.Scene(rope, tension=300.0, ends=("pinned", "pinned"))
    alone = own.compile(elements=10, element=element).modes(1, solver="sweep")
    assert modes.frequency[0] == pytest.approx(alone.frequency[0], rel=1e-13)
    assert (np.diff(modes.frequency[:10]) > 0).all()


@ELEMENTS
@pytest.mark.parametrize("masses", [8, 12])
def test_many_modes_in_a_cluster_are_right(masses, element):
    # heavy masses between equal spans: as many more equal frequencies, 1e-11 apart and nearer
    parts = [rd.PointMass(k / (masses + 1), 1e9, rotary_inertia=1e9) for k in range(1, masses + 1)]
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0)
    scene = rd.Scene(rope, tension=100.0, parts=parts)
    model = scene.compile(elements=4 * (masses + 1), element=element)
    modes = model.modes(3 * masses + 1, solver="sweep")
    assert modes.certified
    # counts, which widen the bound where they do not agree, know these to 1e-9
    exact = exact_chain(model, 80)
    assert is_bounded(exact, modes).all()
    # the quotients themselves: 1e3 eps of frequencies 2 pi times lower than stiff waves
    error = [exact.error(k, modes.eigenvalue[k]) for k in range(2 * masses, 3 * masses + 1)]
    assert max(error) <= 1e-14 * modes.eigenvalue[-1]


@pytest.mark.parametrize(("number", "elements"), [(9, None), (9, 40), (30, 62)])
def test_light_resonators_of_one_frequency_are_told_apart(number, elements):
    # (lambda_0 - lambda)/lambda_0 is an eigenvalue of m lambda_0 H, H the receptances of their feet
    x, mass, frequency = np.arange(1, number + 1) / (number + 1), 1e-11, 30.0
    bare = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
    scene = bare.replace(parts=[rd.Resonator(one, mass, frequency) for one in x])
    modes = scene.compile(elements=elements).modes(number + 2)
    near = np.flatnonzero(np.abs(modes.frequency / frequency - 1) < 1e-6)
    feet = [("z", one) for one in x]
    bare = bare.compile(elements=elements)
    H = bare.frf([frequency], drive=feet, response=feet).value[:, :, 0].real
    size = (2 * np.pi * frequency) ** 2
    shift = np.sort(-np.linalg.eigvalsh(mass * size * (H + H.T) / 2))
    assert modes.certified
    assert len(near) == number
    # in units of lambda_0: products of the shift with itself and 8 eps of the eigenvalues
    np.testing.assert_allclose(modes.eigenvalue[near] / size - 1, shift, rtol=1e-6, atol=2e-15)
    weight = modes.modal_mass[near]
    assert (weight > 0).all()


@pytest.mark.parametrize("masses", [2, 4, 6])
def test_several_spans_between_heavy_masses(masses):
    parts = [rd.PointMass(k / (masses + 1), 1e9) for k in range(1, masses + 1)]
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, parts=parts)
    modes = certified_modes(scene.compile(elements=4 * (masses + 1)), 2 * masses + 1)
    # all spans swing alike, between masses that stand
    inner = modes.eigenvalue[masses:]
    np.testing.assert_allclose(inner, inner[0], rtol=1e-9)


def test_counts_tell_the_modes_of_a_cluster_apart_as_far_as_there_are_numbers():
    heavy = rd.PointMass(0.5, 1e3)
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=300.0, parts=[heavy]).compile(elements=16)
    modes = model.modes(3, solver="sweep")
    exact = ExactChain(model.chain)
    gap = modes.eigenvalue[2] - modes.eigenvalue[1]
    # rope over mass is 1e-4
    assert 1e-5 < gap / modes.eigenvalue[1] < 1e-3
    assert exact.holds(1, modes.eigenvalue[1] - gap / 1e6, modes.eigenvalue[1] + gap / 1e6)
