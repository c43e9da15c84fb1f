"""Shapes and energies of modes of continuous spans: closed forms and the exact reference."""

import functools
import itertools
import math

import exact_roots
import numpy as np
import pytest
from conftest import EPS
from exact_roots import continuum
from exact_scene import places
from exact_shapes import Mode
from spans import SCENES
from test_continuous_modes import SPANS

import ropedyn as rd

L, MU, B, T = 1.2, 0.09, 2.0, 60.0
BEAM = rd.Rope(L, MU, bending_stiffness=B)
SHAPE = 1e-11
"""Of the largest of a coordinate: a mode mixes with the next by RELATIVE = 1e-13 lambda/gap, a gap
of some per cent."""
ENERGY = 4 * SHAPE
"""Squares of shapes, over sums of them."""


def drawn(scene, number, points=64):
    modes = scene.compile().modes(number, points=points)
    # as many equal intervals on every span, ends included
    stations = sorted({0.0, scene.rope.length, *places(scene)})
    spans = [np.linspace(a, b, points + 1) for a, b in itertools.pairwise(stations)]
    x = np.concatenate([spans[0], *(span[1:] for span in spans[1:])])
    np.testing.assert_allclose(modes.x, x, rtol=2 * EPS)
    assert modes.shape.shape == (number, len(x), len(scene.coordinates))
    return modes


def apart(shape, exact):
    """Largest difference of each coordinate over its largest, whatever the common sign."""
    sign = np.sign((shape * exact).sum())
    size = np.abs(exact).max(axis=0)
    # a coordinate that does not move at all must not move
    return (np.abs(sign * shape - exact).max(axis=0) / np.where(size > 0, size, 1)).max()


# closed forms ------------------------------------------------------------------------------------


@pytest.mark.parametrize("tension", [0.0, T, 1e8 * B / L**2, -2.0])
def test_pinned_beam_swings_in_sines(tension):
    modes = drawn(rd.Scene(BEAM, tension=tension, ends=("pinned", "pinned")), 4)
    for k in range(4):
        q = (k + 1) * math.pi / L
        x = np.stack([np.sin(q * modes.x), q * np.cos(q * modes.x)], axis=1)
        # the largest of 65 places is 1
        assert apart(modes.shape[k], x / np.abs(x[:, 0]).max()) <= SHAPE
        bending = B * q**2 / (B * q**2 + tension)
        # a fraction of one sum, which is rounded as a whole
        np.testing.assert_allclose(modes.energy["bending"][k], bending, rtol=ENERGY, atol=4 * EPS)
        if tension:
            np.testing.assert_allclose(modes.energy["tension"][k], 1 - bending, rtol=ENERGY)
        np.testing.assert_allclose(modes.energy["z"][k], 1, rtol=ENERGY)
        # mu L/2 over the square of the largest drawn
        mass = MU * L / 2 / np.abs(x[:, 0]).max() ** 2
        np.testing.assert_allclose(modes.modal_mass[k], mass, rtol=ENERGY)


def test_rotary_inertia_takes_its_share_of_the_kinetic_energy():
    # z = sin q x: j q^2/(mu + j q^2)
    j = 2e-4
    scene = rd.Scene(BEAM.replace(rotary_inertia=j), tension=T, ends=("pinned", "pinned"))
    modes = drawn(scene, 4, points=8)
    q = np.arange(1, 5) * math.pi / L
    np.testing.assert_allclose(modes.energy["beta"], j * q**2 / (MU + j * q**2), rtol=ENERGY)


def test_rod_held_at_one_end_swings_in_quarter_waves():
    rope = rd.Rope(L, MU, torsional_stiffness=0.7, polar_inertia=2e-6)
    modes = drawn(rd.Scene(rope, ends=("clamped", "free")), 5)
    for k in range(5):
        wave = np.sin((k + 0.5) * math.pi * modes.x / L)[:, None]
        assert apart(modes.shape[k], wave) <= SHAPE
    np.testing.assert_allclose(modes.energy["twist"], 1, rtol=ENERGY)
    np.testing.assert_allclose(modes.energy["alpha"], 1, rtol=ENERGY)
    assert set(modes.family) == {"torsional"}


def test_rigid_motion_of_a_free_beam_is_straight():
    modes = drawn(rd.Scene(BEAM, ends=("free", "free")), 3)
    for shape in modes.shape[:2]:
        z, beta = shape.T
        # a plane of two motions: any straight line, largest 1
        slope = (z[-1] - z[0]) / L
        np.testing.assert_allclose(z, z[0] + slope * modes.x, atol=SHAPE)
        np.testing.assert_allclose(beta, slope, atol=SHAPE)
        assert np.abs(z).max() == 1
    # orthogonal to each other and to the first that bends, by Simpson's rule over 64 intervals:
    # straight lines exactly, the third's cubic part to (pi/64)^4
    weight = np.array([1.0, *([4.0, 2.0] * 32)[:-1], 1.0])
    product = (modes.shape[:, :, 0] * weight) @ modes.shape[:, :, 0].T / weight.sum()
    assert abs(product[0, 1]) <= SHAPE
    assert np.abs(product[2, :2]).max() <= 1e-5


def test_parted_spans_swing_alone():
    parts = [rd.Hinge(1.0), rd.Support(1.0)]
    modes = drawn(rd.Scene(SPANS, ends=("pinned", "pinned"), parts=parts), 4)
    wave = np.sin(math.pi * modes.x)
    for shape in modes.shape[:2, :, 0]:
        # some mixture of left and right span, each a half wave
        for half in (slice(0, 65), slice(64, None)):
            most = shape[half][np.abs(shape[half]).argmax()]
            np.testing.assert_allclose(shape[half], most * np.abs(wave[half]), atol=SHAPE)
    first, second = modes.shape[:2, :, 0]
    assert abs(first @ second) <= 65 * SHAPE


# against the reference ---------------------------------------------------------------------------


@functools.cache
def second(name):
    """Second mode of the reference."""
    scene = SCENES[name]
    near = float(scene.compile().modes(2).eigenvalue[1])
    exact = continuum(scene, scene.coordinates[-1])
    return Mode(exact, exact_roots.eigenvalue(exact, near, 1e-3))


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.claim(
    "Shapes of modes of continuous ropes with lay coupling, lay slope, masses, springs, supports, "
    "hinges: error over the largest of each coordinate",
    reference="responses next to exact roots, 80 digits: tests/support/exact_shapes.py",
    accepted=3e-13,
)
def test_shapes_are_those_of_the_continuum(name, claim):
    scene, mode = SCENES[name], second(name)
    modes = drawn(scene, 2, points=8)
    assert set(scene.coordinates) == set(mode.exact.coordinates)
    claim(apart(modes.shape[1], mode.shape(8)))
    np.testing.assert_allclose(modes.modal_mass[1], mode.modal_mass(8), rtol=ENERGY)


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.claim(
    "Fractions of strain and kinetic energy of modes of continuous ropes: absolute error",
    reference="Romberg's rule over 256 intervals a span of exact shapes: exact_shapes.py",
    accepted=2e-12,
)
def test_energies_are_integrals_over_the_shapes_of_the_continuum(name, claim):
    modes, fractions = SCENES[name].compile().modes(2), second(name).energy()
    claim(max(abs(value[1] - fractions.get(c, 0.0)) for c, value in modes.energy.items()))
    # nothing is stored where the modes say nothing
    assert all(abs(fractions[s]) < ENERGY for s in fractions if s not in modes.energy)


def test_shapes_that_nobody_sized_show_the_highest_mode():
    model = SCENES["mass and springs"].compile()
    some, many = model.modes(12), model.modes(12, points=128)
    np.testing.assert_array_equal(some.frequency, many.frequency)
    assert set(model.x) <= set(some.x)
    # a half wave between two zeros of z
    z = some.shape[-1, :, 0]
    zeros = np.flatnonzero(z[1:] * z[:-1] < 0)
    assert np.diff(zeros).min() >= 8


def test_many_parts_do_not_make_each_span_longer():
    """Shapes are given at as many points as the waves in a span ask for, not those in the rope."""
    x = np.linspace(0.0, L, 402)[1:-1]
    scene = rd.Scene(
        rd.Rope(L, 0.1), tension=100.0, parts=[rd.PointMass(float(at), 1e-3) for at in x]
    )
    modes = scene.compile().modes(3)
    assert len(modes.x) == 401 * 32 + 1


@pytest.mark.parametrize("points", [1, 2, 3])
def test_a_mode_with_nodes_at_all_points_keeps_a_finite_size(points):
    """Of a pinned string-like beam sin(k pi x/L) vanishes at the points where k is a multiple."""
    scene = rd.Scene(BEAM, tension=T, ends=("pinned", "pinned"))
    modes = scene.compile().modes(4, points=points)
    unseen = [(k + 1) % points == 0 for k in range(4)]
    largest = np.abs(modes.shape[:, :, 0]).max(axis=1)
    # nodes are exact to rounding: a few EPS of 1, times the wave number
    assert (largest[unseen] < 100 * EPS).all()
    assert (largest[~np.array(unseen)] == 1.0).all()
    # 1 is at one of 8 points to a half wave: the largest of sin is within cos(pi/16) of it
    within = 1 / math.cos(math.pi / 16) ** 2 - 1
    np.testing.assert_allclose(modes.modal_mass[unseen], MU * L / 2, rtol=within)
