"""Modes of uniform chains, certified, against their own waves: 1 to 10^6 elements."""

import math

import mpmath
import numpy as np
import pytest
from conftest import BENDING, LENGTH, MASS, beam, reference, slow
from exact_counts import ExactChain
from exact_waves import RigidChain, pinned_rigid_chain, pinned_tensed_chain

import ropedyn as rd

RELATIVE = 1e-12
"""Of a frequency; of its square twice as much."""
STORED = reference("rigid_chain")["cases"]
SHORT, LONG = tuple(range(1, 17)), (64, 512, 10_000, 100_000, 1_000_000)
FEW = (2, 3, 5, 8, 16, *slow(4, 6, 7, *range(9, 16)))
"""Short chains of which a few stand for all."""
TENSIONS = pytest.mark.parametrize("tension", [0.0, 300.0])


def lowest(scene, n, element="rigid", number=10):
    """Return the model and as many as exist of its ten lowest modes."""
    model = scene.compile(elements=n, element=element)
    existing = model.size
    if existing == 0:
        return model, None
    return model, model.modes(min(existing, number), solver="sweep")


def elastic(modes):
    return modes.eigenvalue[modes.eigenvalue != 0].tolist()


@TENSIONS
@pytest.mark.parametrize("ends", ["clamped", "pinned", "free"])
@pytest.mark.parametrize("n", SHORT)
def test_all_modes_of_short_rigid_chains_are_exact(n, ends, tension):
    model, modes = lowest(beam(n, tension=tension, ends=(ends, ends)), n)
    if modes is None:
        # one element between clamps cannot move
        assert (n, ends) == (1, "clamped")
        return
    assert modes.certified
    exact = ExactChain(model.chain)
    for k, value in enumerate(modes.eigenvalue.tolist()):
        wide = 2 * RELATIVE * value or 1e-20
        assert exact.holds(k, value - wide, value + wide)


@TENSIONS
@pytest.mark.parametrize("ends", ["clamped", "free"])
@pytest.mark.parametrize("n", [*FEW, *LONG])
def test_rigid_chain_obeys_its_dispersion_equation(n, ends, tension):
    model, modes = lowest(beam(n, tension=tension, ends=(ends, ends)), n)
    assert modes.certified
    with mpmath.workdps(90):
        waves = RigidChain(model.chain, ends)
        values = elastic(modes)
        below = values[0] / 10
        for value in values:
            low, high = value * (1 - 2 * RELATIVE), value * (1 + 2 * RELATIVE)
            # one, and none between it and the one before
            assert waves.crossings([*np.linspace(below, low, 8).tolist(), high]) == [0] * 7 + [1]
            below = high
    rigid = {"clamped": 0, "free": 2 if tension == 0 else 1}[ends]
    assert (modes.frequency[:rigid] == 0).all()
    assert len(values) == len(modes.eigenvalue) - rigid


@TENSIONS
@pytest.mark.parametrize("n", [*SHORT, *LONG])
def test_pinned_rigid_chain_obeys_its_dispersion_equation(n, tension):
    model, modes = lowest(beam(n, tension=tension, ends=("pinned", "pinned")), n)
    assert modes.certified
    with mpmath.workdps(60):
        exact = [float(x) for x in pinned_rigid_chain(model.chain, len(modes.eigenvalue))]
    np.testing.assert_allclose(modes.eigenvalue, exact, rtol=2 * RELATIVE, atol=0)


@pytest.mark.parametrize("tension", [0.0, 300.0, -200.0])
@pytest.mark.parametrize("n", [*SHORT[1:], *LONG])
def test_pinned_tensed_chain_has_the_frequencies_of_its_waves(n, tension):
    rope = rd.Rope(LENGTH, MASS / LENGTH, bending_stiffness=BENDING)
    scene = rd.Scene(rope, tension=tension, ends=("pinned", "pinned"))
    model = scene.compile(elements=n, element="tensed")
    modes = model.modes(min(n - 1, 10), solver="sweep")
    assert modes.certified
    with mpmath.workdps(60):
        exact = [
            float(pinned_tensed_chain(rope, tension, n, k + 1)) for k in range(len(modes.frequency))
        ]
    np.testing.assert_allclose(modes.eigenvalue, exact, rtol=2 * RELATIVE, atol=0)


@pytest.mark.parametrize("n", [2, 16, 512, 100_000, 1_000_000])
def test_string_has_the_frequencies_of_lagrange(n):
    T, mu = 300.0, 0.1
    model = rd.Scene(rd.Rope(1.0, mu), tension=T).compile(elements=n)
    modes = model.modes(min(n - 1, 10), solver="sweep")
    assert modes.certified
    k = np.arange(1, len(modes.frequency) + 1)
    exact = n / math.pi * math.sqrt(T / mu) * np.sin(k * math.pi / (2 * n))
    np.testing.assert_allclose(modes.frequency, exact, rtol=RELATIVE)


@pytest.mark.parametrize("n", [3, 5, 10, 16, 50])
def test_any_number_of_modes_of_any_uniform_string(n):
    # each call takes another path of isolation and refinement
    random = np.random.default_rng(n)
    for tension in random.uniform(1.0, 1000.0, 40).tolist():
        model = rd.Scene(rd.Rope(1.0, 0.1), tension=tension).compile(elements=n)
        top = n / math.pi * math.sqrt(tension / 0.1)
        for number in range(1, min(n, 9)):
            modes = model.modes(number, solver="sweep")
            assert modes.certified
            exact = top * np.sin(np.arange(1, number + 1) * math.pi / (2 * n))
            np.testing.assert_allclose(modes.frequency, exact, rtol=RELATIVE)


@pytest.mark.parametrize(
    "case", STORED, ids=lambda case: f"{case['ends']} T={case['tension']:g} n={case['n']}"
)
def test_rigid_chain_has_its_stored_frequencies(case):
    scene = beam(case["n"], tension=case["tension"], ends=(case["ends"],) * 2)
    modes = scene.compile(elements=case["n"], element="rigid").modes(5, solver="sweep")
    np.testing.assert_allclose(modes.frequency, case["f"], rtol=RELATIVE)


# shapes -----------------------------------------------------------------------------------------


def residual(model, modes):
    """max |K u - lambda M u| over |K| |u| for each mode, from the assembled matrices."""
    K, M = model.stiffness_matrix(), model.mass_matrix()
    free = (model.chain.held[model.chain.term_of] == 0).ravel()
    u = modes.shape.reshape(len(modes.frequency), -1)[:, free].T
    left = np.abs(K @ u - (M @ u) * modes.eigenvalue).max(axis=0)
    return left / (abs(K) @ np.abs(u)).max(axis=0)


SCENES = {
    "clamped": beam(64, tension=300.0),
    "free": beam(64, ends=("free", "free")),
    "mass": beam(64, tension=300.0, parts=[rd.PointMass(LENGTH / 3, 0.05)]),
    "spring": beam(64, ends=("pinned", "free"), parts=[rd.Spring(LENGTH, 1e4)]),
    "string": rd.Scene(rd.Rope(1.0, 0.1), tension=300.0),
    "lay": rd.Scene(
        rd.Rope(
            1.0,
            0.1,
            bending_stiffness=5.0,
            torsional_stiffness=1.0,
            polar_inertia=1e-6,
            lay_slope=0.3,
        ),
        tension=60.0,
    ),
}


@pytest.mark.parametrize("element", ["rigid", "tensed"])
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_shapes_satisfy_the_equations_of_motion(scene, element):
    model = scene.compile(elements=60, element=element)
    modes = model.modes(10, solver="sweep")
    # |K u| is formed with some 10 eps; inside pieces of 2^5 elements shapes are found from their
    # ends, each halving a solution of a small system of condition up to 10
    assert (residual(model, modes) < 32 * 10 * 10 * np.finfo(float).eps).all()


@pytest.mark.parametrize("element", ["rigid", "tensed"])
@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
def test_shapes_are_orthogonal_and_their_energies_whole(scene, element):
    model = scene.compile(elements=60, element=element)
    modes = model.modes(10, solver="sweep")
    free = (model.chain.held[model.chain.term_of] == 0).ravel()
    u = modes.shape.reshape(10, -1)[:, free]
    product = u @ (model.mass_matrix() @ u.T)
    size = np.sqrt(np.diag(product))
    # vectors err by eps lambda/gap and what they are carried along; squares of both are not seen
    np.testing.assert_allclose(product / np.outer(size, size), np.eye(10), atol=1e-10)
    np.testing.assert_allclose(np.diag(product), modes.modal_mass, rtol=1e-13)
    moves = modes.frequency > 0
    strain = sum(modes.energy[k] for k in modes.energy if k not in modes.coordinates)
    kinetic = sum(modes.energy[k] for k in modes.coordinates)
    np.testing.assert_allclose(strain[moves], 1, rtol=1e-13)
    assert (strain[~moves] == 0).all()
    np.testing.assert_allclose(kinetic, 1, rtol=1e-13)


@pytest.mark.parametrize("k", [1, 2, 10])
@pytest.mark.parametrize("n", [100, 100_000])
def test_pinned_tensed_chain_of_any_length_swings_in_sines(n, k):
    # no rotary inertia: z is a sine at the nodes exactly
    rope = rd.Rope(LENGTH, MASS / LENGTH, bending_stiffness=BENDING)
    scene = rd.Scene(rope, tension=300.0, ends=("pinned", "pinned"))
    modes = scene.compile(elements=n, element="tensed").modes(k, solver="sweep")
    z = modes.shape[k - 1, :, 0]
    sine = np.sin(k * math.pi * np.arange(n + 1) / n)
    np.testing.assert_allclose(z * (sine @ sine) / (z @ sine), sine, atol=1e-10)


def test_shape_of_a_mode_whose_eigenvalue_is_met_exactly():
    """T/m l, where K - lambda M is singular to the last bit: the spring stands at a node of it."""
    tension = 29.09146460022309
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=tension, parts=[rd.Spring(0.25, 8700.648546878794)])
    modes = scene.compile(elements=12).modes(5)
    sine = np.sin(np.pi * np.arange(13) / 3)
    assert modes.eigenvalue[3] == pytest.approx(12 * tension / (0.1 / 12), rel=1e-14)
    z = modes.shape[3, :, 0]
    np.testing.assert_allclose(np.sign(z[1]) * z * sine[1], sine, atol=1e-13)
