"""Derivatives of modes of ropes that carry resonators and broken wires."""

import dataclasses
import functools

import numpy as np
import pytest
from conftest import LAID
from mpmath import mp
from parabolas import parabola
from test_sensitivity import (
    DENSITY,
    EXACT,
    LENGTH,
    MODELS,
    QUOTIENT,
    TENSION,
    difference,
    error,
    implicit,
    is_limit_of_differences,
    near,
)

import ropedyn as rd

STRING = rd.Rope(LENGTH, DENSITY)

# --- characteristic equations -----------------------------------------------------------------


def string_with(structure, omega, T, mu, L, a, **given):
    """T k sin(k L) + D sin(k a) sin(k (L - a)) = 0, D of a structure at a; over its poles."""
    k = omega * mp.sqrt(mu / T)
    above, below = structure(omega, **given)
    return below * T * k * mp.sin(k * L) + above * mp.sin(k * a) * mp.sin(k * (L - a))


def resonator(omega, m, f):
    """D = -lambda m k/(k - lambda m)."""
    own = (2 * mp.pi * f) ** 2
    return -(omega**2) * m * own, own - omega**2


def wire(omega, l, d, E, rho):  # noqa: E741 - its name on paper
    """R. E. D. Bishop, D. C. Johnson, The Mechanics of Vibration (1960), table 7.1."""
    EI, area = E * mp.pi * d**4 / 64, mp.pi * d**2 / 4
    k = mp.sqrt(mp.sqrt(omega**2 * rho * area / EI))
    c, s, C, S = mp.cos(k * l), mp.sin(k * l), mp.cosh(k * l), mp.sinh(k * l)
    return -EI * k**3 * (c * S + s * C) / (c * C), 1 / (c * C) + 1


ROPE_PATHS = {"T": "tension", "mu": "linear_density", "L": "length", "a": "parts[0].x"}
STRUCTURES = {
    "resonator": (
        resonator,
        rd.Resonator(0.4, 0.02, 20.0),
        {"m": "mass", "f": "frequency"},
    ),
    "heavy resonator": (
        resonator,
        rd.Resonator(0.4, 5.0, 40.0),
        {"m": "mass", "f": "frequency"},
    ),
    "light resonator": (
        resonator,
        rd.Resonator(0.4, 1e-4, 60.0),
        {"m": "mass", "f": "frequency"},
    ),
    "wire": (
        wire,
        rd.BrokenWire(0.4, 0.2, 2e-3, radius=0.0),
        {"l": "length", "d": "diameter", "E": "youngs_modulus", "rho": "density"},
    ),
    "long wire": (
        wire,
        rd.BrokenWire(0.4, 0.5, 1e-3, radius=0.0),
        {"l": "length", "d": "diameter", "E": "youngs_modulus", "rho": "density"},
    ),
}


@pytest.mark.claim(
    "df/dp of a string with a resonator or a broken wire, p its numbers, place, tension, density "
    "and length",
    reference="characteristic equation differentiated in 50 digits",
    accepted=EXACT,
)
@pytest.mark.parametrize("what", STRUCTURES)
def test_string_that_carries_changes_as_its_characteristic_equation(what, claim):
    equation, part, names = STRUCTURES[what]
    modes = rd.Scene(STRING, tension=TENSION, parts=[part]).compile().modes(6)
    given = {"T": TENSION, "mu": DENSITY, "L": LENGTH, "a": part.x}
    given |= {name: getattr(part, path) for name, path in names.items()}
    paths = ROPE_PATHS | {name: f"parts[0].{path}" for name, path in names.items()}
    for name, path in paths.items():
        expected = [
            implicit(functools.partial(string_with, equation), 2 * np.pi * f, given, name)
            for f in modes.frequency
        ]
        claim(error(modes.derivative(path), np.array(expected) / (2 * np.pi)))
    assert (modes.derivative("parts[0].damping_ratio") == 0).all()


# --- differences ------------------------------------------------------------------------------

CARRYING = rd.Scene(
    LAID.replace(length=LENGTH),
    tension=100.0,
    ends=("pinned", rd.End(z="free", spring={"z": 2e3})),
    parts=[
        rd.Resonator(0.4, 0.02, 20.0),
        rd.BrokenWire(0.7, 0.05, 3e-4, radius=2e-3),
        rd.BrokenWire(0.3, 0.1, 1e-3, radius=-3e-3),
        rd.PointMass(1.0, 0.02),
        rd.Resonator(0.4, 0.01, 37.0),
    ],
)
"""Two structures at one place, others on its left and right, feet that twist and turn."""

SMOOTH = (
    "tension",
    "bending_stiffness",
    "lay_slope",
    "linear_density",
    "polar_inertia",
    "parts[0].mass",
    "parts[0].frequency",
    "parts[1].length",
    "parts[1].radius",
    "parts[2].length",
    "parts[2].diameter",
    "parts[2].radius",
    "parts[2].youngs_modulus",
    "parts[2].density",
    "parts[3].mass",
    "parts[4].mass",
    "parts[4].frequency",
    "ends[1].spring.z",
)
PLACES = ("length", "parts[1].x", "parts[2].x", "parts[3].x")


@functools.cache
def carrying(kind):
    """The model of CARRYING and its modes."""
    model = CARRYING.compile(**MODELS[kind])
    return model, model.modes(6)


@pytest.mark.parametrize("kind", MODELS)
@pytest.mark.parametrize("path", SMOOTH + PLACES)
def test_derivative_of_what_carries_is_what_differences_tend_to(kind, path):
    model, modes = carrying(kind)
    is_limit_of_differences(model, modes, path, 1e-3 if path in PLACES else 3e-3)


@pytest.mark.parametrize("kind", MODELS)
def test_structures_hang_on_a_rope_that_sags(kind):
    """Both at once: x and z move together, and the resonator with them."""
    rope = rd.Rope(LENGTH, DENSITY, axial_stiffness=2e5, bending_stiffness=2.0)
    gravity = rd.Gravity(60.0)
    parts = [rd.Resonator(0.4, 0.02, 20.0)]
    scene = rd.Scene(rope, tension=100.0, gravity=gravity, parts=parts)
    model = parabola(scene, **MODELS[kind])
    modes = model.modes(4)
    for path in ("gravity.g", "tension", "parts[0].mass", "parts[0].frequency"):
        expected = difference(model, path, 4, 3e-3)
        near(modes.derivative(path, of="eigenvalue"), expected, QUOTIENT)


# --- feet that stand still --------------------------------------------------------------------


def test_foot_at_rest_between_a_span_and_its_absorber():
    """The left span swings, the absorber holds its end, and the right span does not know.

    With the slope A k of sin(k x) at the foot the spring stretches by y = T A k/(m omega^2); then
    each number changes its own energy alone.
    """
    a, m = 0.3, 0.02
    speed = np.sqrt(TENSION / DENSITY)
    part = rd.Resonator(a, m, speed / (2 * a))
    modes = rd.Scene(STRING, tension=TENSION, parts=[part]).compile().modes(6)
    k = np.pi / a
    square = k**2 * TENSION / DENSITY
    y = TENSION * k / (m * square)
    mass = DENSITY * a / 2 + m * y**2
    own = int(np.abs(modes.frequency - part.frequency).argmin())
    assert modes.frequency[own] == pytest.approx(part.frequency, rel=EXACT)
    expected = {
        "tension": k**2 * a / 2 / mass,
        "linear_density": -square * a / 2 / mass,
        "parts[0].frequency": 2 / part.frequency * m * square * y**2 / mass,
        "parts[0].mass": 0.0,
        "length": 0.0,
    }
    # of the largest that the number does to any mode
    for path, slope in expected.items():
        found = modes.derivative(path, of="eigenvalue")
        assert abs(found[own] - slope) <= EXACT * np.abs(found).max()


def test_double_mode_of_a_tuned_absorber_parts():
    """In the middle, tuned to the second mode: that one, and two halves that swing against it."""
    m = 0.02
    speed = np.sqrt(TENSION / DENSITY)
    part = rd.Resonator(LENGTH / 2, m, speed / LENGTH)
    modes = rd.Scene(STRING, tension=TENSION, parts=[part]).compile().modes(4)
    cluster = next(c for c in modes.sensitivity.shapes.clusters if len(c) == 2)
    k = 2 * np.pi / LENGTH
    square = k**2 * TENSION / DENSITY
    y = 2 * TENSION * k / (m * square)
    mass = DENSITY * LENGTH / 2 + m * y**2
    stiff = k**2 * LENGTH / 2
    assert modes.frequency[cluster] == pytest.approx([part.frequency] * 2, rel=EXACT)
    expected = {
        "parts[0].frequency": [0.0, 2 / part.frequency * m * square * y**2 / mass],
        "tension": [stiff / mass, k**2 / DENSITY],
        "linear_density": [-square / DENSITY, -square * LENGTH / 2 / mass],
    }
    for path, slope in expected.items():
        near(modes.derivative(path, of="eigenvalue")[cluster], np.array(slope))


def test_wire_with_its_root_at_rest():
    """As the absorber, E and density share it: lambda goes with E/density where all is the wire."""
    part = rd.BrokenWire(0.3, 0.2, 2e-3, radius=0.0)
    scene = rd.Scene(STRING, tension=TENSION, parts=[part])
    # the left span tuned to the wire
    tension = DENSITY * (2 * 0.3 * part.frequency) ** 2
    modes = scene.replace(tension=tension).compile().modes(6)
    own = int(np.abs(modes.frequency - part.frequency).argmin())
    assert modes.frequency[own] == pytest.approx(part.frequency, rel=EXACT)
    share = {
        path: value * modes.derivative(path, of="eigenvalue")[own]
        for path, value in (
            ("tension", tension),
            ("linear_density", DENSITY),
            ("parts[0].youngs_modulus", part.youngs_modulus),
            ("parts[0].density", part.density),
        )
    }
    value = modes.eigenvalue[own]
    # a span at rest at both ends and a wire at rest at its root: as much strain as motion in each
    near(share["tension"], -share["linear_density"])
    near(share["parts[0].youngs_modulus"], -share["parts[0].density"])
    near(share["tension"] + share["parts[0].youngs_modulus"], value)
    assert 0.01 * value < share["tension"] < 0.99 * value


def test_soft_and_stiff_resonators_are_their_limits():
    """Alone at its own frequency, or a mass: its spring then has (f/f_r)^2 of the slope."""
    lump = rd.Scene(STRING, tension=TENSION, parts=[rd.PointMass(0.4, 0.02)]).compile().modes(4)
    stiff = rd.Resonator(0.4, 0.02, 1e9)
    modes = rd.Scene(STRING, tension=TENSION, parts=[stiff]).compile().modes(4)
    for path in ("tension", "parts[0].mass", "parts[0].x"):
        near(modes.derivative(path), lump.derivative(path))
    # it moves by 1/(1 - f^2/f_r^2) with the foot, as m (1 + f^2/f_r^2) would
    by_mass = lump.derivative("parts[0].mass")
    expected = -by_mass * 0.02 * 2 * (lump.frequency / 1e9) ** 2 / 1e9
    near(modes.derivative("parts[0].frequency"), expected)
    soft = rd.Resonator(0.4, 0.02, 1e-6)
    modes = rd.Scene(STRING, tension=TENSION, parts=[soft]).compile().modes(3)
    assert modes.derivative("parts[0].frequency")[0] == pytest.approx(1.0, rel=EXACT)


def test_rigid_motion_of_what_is_carried_keeps_its_frequency():
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=2.0)
    parts = [rd.Resonator(0.4, 0.02, 20.0), rd.BrokenWire(0.7, 0.1, 1e-3, radius=0.0)]
    modes = rd.Scene(rope, ends=("free", "free"), parts=parts).compile().modes(4)
    assert (modes.frequency[:2] == 0).all()
    for path in ("parts[0].frequency", "parts[0].mass", "parts[1].youngs_modulus"):
        slope = modes.derivative(path)
        assert (slope[:2] == 0).all()
        assert slope[2] != 0


# --- damage, what cannot be asked -------------------------------------------------------------


@pytest.mark.parametrize("kind", MODELS)
def test_damage_of_what_carries_adds_up_to_the_whole_rope(kind):
    _, modes = carrying(kind)
    damage = modes.damage()
    for name in ("bending_stiffness", "linear_density", "polar_inertia"):
        total = damage.frequency_change(0.0, LENGTH, **{name: 1.0})
        expected = -getattr(LAID, name) * modes.derivative(name) / modes.frequency
        np.testing.assert_allclose(total, expected, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("path", ["parts[0].radius", "parts[0].youngs", "parts[0].kind"])
def test_number_of_a_structure_that_does_not_act_is_refused(path):
    """The radius of a wire on a rope without twist."""
    part = dataclasses.replace(STRUCTURES["wire"][1], radius=1e-3)
    modes = rd.Scene(STRING, tension=TENSION, parts=[part]).compile().modes(1)
    with pytest.raises(rd.SceneError, match=r'one of .*"parts\[0\]\.youngs_modulus"'):
        modes.derivative(path)
