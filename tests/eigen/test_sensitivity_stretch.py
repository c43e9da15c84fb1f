"""Derivatives where the rope changes over stretches, and what dashpots and ends have."""

import functools
import re

import mpmath
import numpy as np
import pytest
from conftest import LAID
from test_sensitivity import (
    DENSITY,
    LENGTH,
    MODELS,
    TENSION,
    error,
    implicit,
    is_limit_of_differences,
    near,
)

import ropedyn as rd

ROPE = LAID.replace(length=LENGTH)
WORN = rd.Scene(
    ROPE,
    tension=TENSION,
    ends=("clamped", rd.End(z="free", spring={"z": 2e3}, mass={"z": 0.03}, dashpot={"z": 3.0})),
    parts=[
        rd.LocalChange(0.2, 0.6, bending=0.4, torsion=1.5, axial=1.2, lay=0.7, density=0.8),
        rd.AddedMass(0.5, 0.9, 0.04, polar_inertia=2e-6),
        rd.Dashpot(0.3, 5.0),
        rd.LocalChange(0.45, 0.8, bending=1.7, torsion=0.6, density=1.3),
        rd.PointMass(1.0, 0.02, rotary_inertia=1e-5),
    ],
)
"""Stretches that overlap, parts within them."""

SMOOTH = (
    "bending_stiffness",
    "torsional_stiffness",
    "axial_stiffness",
    "lay_coupling",
    "lay_slope",
    "linear_density",
    "rotary_inertia",
    "polar_inertia",
    "tension",
    "parts[0].bending",
    "parts[0].torsion",
    "parts[0].axial",
    "parts[0].lay",
    "parts[0].density",
    "parts[1].linear_density",
    "parts[1].polar_inertia",
    "parts[3].bending",
    "parts[3].density",
    "parts[4].mass",
    "ends[1].spring.z",
    "ends[1].mass.z",
)
PLACES = (
    "length",
    "parts[0].start",
    "parts[0].stop",
    "parts[1].start",
    "parts[3].stop",
    "parts[2].x",
    "parts[4].x",
)


@functools.cache
def worn(kind):
    """The model of WORN and its modes."""
    model = WORN.compile(**MODELS[kind])
    return model, model.modes(4)


@pytest.mark.parametrize("kind", MODELS)
@pytest.mark.parametrize("path", SMOOTH + PLACES)
def test_derivative_of_a_changed_rope_is_what_differences_tend_to(kind, path):
    model, modes = worn(kind)
    # shorter than for a uniform rope: modes 4 and 5 repel each other, 6 % apart
    is_limit_of_differences(model, modes, path, 1e-3 if path in PLACES else 1.5e-3)


def mass_of_an_end(omega, T, mu, L, m):
    """T k cos(k L) = m omega^2 sin(k L)."""
    k = omega * mpmath.sqrt(mu / T)
    return T * k * mpmath.cos(k * L) - m * omega**2 * mpmath.sin(k * L)


def test_mass_at_an_end_acts_as_its_characteristic_equation_says():
    end = rd.End(z="free", mass={"z": 0.03})
    rope = rd.Rope(LENGTH, DENSITY)
    modes = rd.Scene(rope, tension=TENSION, ends=("clamped", end)).compile().modes(4)
    given = {"T": TENSION, "mu": DENSITY, "L": LENGTH, "m": 0.03}
    expected = [implicit(mass_of_an_end, 2 * np.pi * f, given, "m") for f in modes.frequency]
    near(modes.derivative("ends[1].mass.z"), np.array(expected) / (2 * np.pi))


def two_part_string(omega, T, mu, a, L, factor, added):
    """k1 cot(k1 a) + k2 cot(k2 (L - a)) = 0 of mu and factor mu + added, cleared of poles."""
    k1, k2 = omega * mpmath.sqrt(mu / T), omega * mpmath.sqrt((factor * mu + added) / T)
    left, right = k1 * a, k2 * (L - a)
    return k1 * mpmath.cos(left) * mpmath.sin(right) + k2 * mpmath.cos(right) * mpmath.sin(left)


@pytest.mark.claim(
    "df/dp of a string of two parts, p densities, factor, added mass, where it changes, length",
    reference="characteristic equation differentiated in 50 digits",
    accepted=1e-13,
)
def test_string_of_two_parts_changes_as_its_characteristic_equation(claim):
    given = {"T": TENSION, "mu": DENSITY, "a": 0.4, "L": LENGTH, "factor": 1.6, "added": 0.07}
    parts = [rd.LocalChange(0.4, LENGTH, density=1.6), rd.AddedMass(0.4, LENGTH, 0.07)]
    paths = {
        "T": "tension",
        "mu": "linear_density",
        "L": "length",
        "factor": "parts[0].density",
        "added": "parts[1].linear_density",
    }
    both = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION, parts=parts)
    one = both.replace(parts=parts[:1])
    for scene, numbers, of in (
        (both, given, paths),
        (one, given | {"added": 0.0}, {"a": "parts[0].start"}),
    ):
        modes = scene.compile().modes(4)
        for name, path in of.items():
            expected = [
                implicit(two_part_string, 2 * np.pi * f, numbers, name) / (2 * np.pi)
                for f in modes.frequency
            ]
            claim(error(modes.derivative(path), np.array(expected)))


@pytest.mark.parametrize("kind", MODELS)
def test_change_of_the_whole_rope_is_another_rope(kind):
    """By the chain rule: factors times the derivatives of that rope."""
    change = rd.LocalChange(0.0, LENGTH, bending=0.4, torsion=1.5, density=0.8)
    scene = rd.Scene(ROPE, tension=TENSION)
    changed = ROPE.replace(
        bending_stiffness=0.4 * ROPE.bending_stiffness,
        torsional_stiffness=1.5 * ROPE.torsional_stiffness,
        linear_density=0.8 * ROPE.linear_density,
        rotary_inertia=0.8 * ROPE.rotary_inertia,
        polar_inertia=0.8 * ROPE.polar_inertia,
    )
    one = scene.replace(parts=[change]).compile(**MODELS[kind]).modes(4)
    other = scene.replace(rope=changed).compile(**MODELS[kind]).modes(4)
    for name, factor in (
        ("bending_stiffness", 0.4),
        ("torsional_stiffness", 1.5),
        ("linear_density", 0.8),
        ("polar_inertia", 0.8),
        ("lay_slope", 1.0),
        ("axial_stiffness", 1.0),
        ("length", 1.0),
    ):
        near(one.derivative(name), factor * other.derivative(name))
    by_bending = ROPE.bending_stiffness * other.derivative("bending_stiffness")
    near(one.derivative("parts[0].bending"), by_bending)
    by_density = sum(
        getattr(ROPE, name) * other.derivative(name)
        for name in ("linear_density", "rotary_inertia", "polar_inertia")
    )
    near(one.derivative("parts[0].density"), by_density)


def test_added_inertia_acts_on_a_rope_without_any():
    """All of it is added: f ~ p^-1/2."""
    rope = rd.Rope(LENGTH, DENSITY, torsional_stiffness=0.4)
    added = rd.AddedMass(0.0, LENGTH, 0.0, polar_inertia=3e-6)
    modes = rd.Scene(rope, tension=TENSION, parts=[added]).compile().modes(12)
    turns = modes.family == "torsional"
    assert 0 < turns.sum() < 12
    slope = modes.derivative("parts[0].polar_inertia")
    near(slope, np.where(turns, -modes.frequency / 6e-6, 0.0))


def test_undamped_modes_do_not_feel_dashpots():
    _, modes = worn("continuous")
    assert (modes.derivative("parts[2].damping") == 0).all()
    assert (modes.derivative("ends[1].dashpot.z") == 0).all()


def lost_by_factor(modes, factor):
    """-factor df/dfactor/f of the first part."""
    value = getattr(modes.sensitivity.shapes.model.scene.parts[0], factor)
    return -value * modes.derivative(f"parts[0].{factor}") / modes.frequency


@pytest.mark.parametrize("kind", MODELS)
@pytest.mark.parametrize(
    ("factor", "losses"),
    [
        ("bending", ["bending_stiffness"]),
        ("torsion", ["torsional_stiffness"]),
        ("density", ["linear_density", "rotary_inertia", "polar_inertia"]),
    ],
)
def test_loss_over_a_stretch_is_that_of_its_factor(kind, factor, losses):
    """Where nothing is added a relative loss is one of the factor."""
    scene = WORN.replace(parts=[part for part in WORN.parts if not isinstance(part, rd.AddedMass)])
    modes = scene.compile(**MODELS[kind]).modes(4)
    part = scene.parts[0]
    lost = modes.damage().frequency_change(part.start, part.stop, **dict.fromkeys(losses, 1.0))
    # as parts add up to all of the rope
    np.testing.assert_allclose(lost, lost_by_factor(modes, factor), rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    ("parts", "path"),
    [
        ([rd.LocalChange(0.0, 0.5, density=2.0)], "parts[0].start"),
        ([rd.AddedMass(0.5, LENGTH, 0.1)], "parts[0].stop"),
        ([rd.AddedMass(0.2, 0.5, 0.1), rd.PointMass(0.5, 0.1)], "parts[0].stop"),
        ([rd.AddedMass(0.2, 0.5, 0.1), rd.PointMass(0.5, 0.1)], "parts[1].x"),
        ([rd.AddedMass(0.2, 0.5, 0.1), rd.LocalChange(0.5, 0.7, density=2.0)], "parts[1].start"),
    ],
)
def test_end_of_a_stretch_that_stands_with_another_has_no_derivative(parts, path):
    modes = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION, parts=parts).compile().modes(1)
    with pytest.raises(rd.SceneError, match=re.escape(path) + " must be a place of its own"):
        modes.derivative(path)


@pytest.mark.parametrize(
    "path", ["parts[0].bending", "parts[0].torsion", "parts[0].x", "parts[1].polar_inertia"]
)
def test_factor_that_does_not_act_is_refused(path):
    parts = [rd.LocalChange(0.2, 0.5, density=0.5), rd.AddedMass(0.3, 0.6, 0.1)]
    modes = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION, parts=parts).compile().modes(1)
    with pytest.raises(rd.SceneError, match=r'"parts\[0\].density", "parts\[0\].start"'):
        modes.derivative(path)
