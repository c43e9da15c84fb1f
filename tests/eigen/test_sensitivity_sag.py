"""Derivatives of modes under gravity: what sag changes with each number of the scene."""

import functools

import mpmath
import numpy as np
import pytest
from mpmath import mpf
from parabolas import parabola
from test_sensitivity import (
    DENSITY,
    EXACT,
    LENGTH,
    MODELS,
    TENSION,
    error,
    implicit,
    is_limit_of_differences,
    near,
    value_of,
)

import ropedyn as rd

# --- characteristic equations -----------------------------------------------------------------


def symmetric(omega, T, mu, L, EA, g, i):
    """tan y = y - 4 y^3/lambda^2 with y = omega L/2 sqrt(mu/T), without its poles.

    H. M. Irvine, T. K. Caughey (1974).
    """
    slope = mu * g * mpmath.cos(i) * L / T
    y = omega * L / 2 * mpmath.sqrt(mu / T)
    stiff = slope**2 * EA / (T * (1 + slope**2 / 8))
    return stiff * (mpmath.sin(y) - y * mpmath.cos(y)) + 4 * y**3 * mpmath.cos(y)


PATHS = {
    "T": "tension",
    "mu": "linear_density",
    "L": "length",
    "EA": "axial_stiffness",
    "g": "gravity.g",
    "i": "gravity.inclination",
}


@pytest.mark.claim(
    "df/dp of the symmetric modes of a hanging string, p its tension, density, length, axial "
    "stiffness, gravity and inclination",
    reference="Irvine and Caughey 1974, differentiated in 50 digits",
    accepted=5e-13,
)
@pytest.mark.parametrize("axial", [1e4, 1e6])
def test_hanging_string_changes_as_its_characteristic_equation(axial, claim):
    given = {"T": TENSION, "mu": DENSITY, "L": LENGTH, "EA": axial, "g": 800.0, "i": 0.4}
    rope = rd.Rope(LENGTH, DENSITY, axial_stiffness=axial)
    gravity = rd.Gravity(given["g"], inclination=given["i"], own_weight=False)
    modes = parabola(rd.Scene(rope, tension=TENSION, gravity=gravity)).modes(5)
    residual = [
        abs(symmetric(2 * mpmath.pi * mpf(f), **{k: mpf(v) for k, v in given.items()}))
        for f in modes.frequency
    ]
    kept = [k for k, left in enumerate(residual) if left < 1e-6]
    assert len(kept) == 3  # of five modes two are antisymmetric
    for name, path in PATHS.items():
        omega = 2 * np.pi * modes.frequency[kept]
        expected = [implicit(symmetric, w, given, name) / (2 * np.pi) for w in omega]
        claim(error(modes.derivative(path)[kept], np.array(expected)))


def test_antisymmetric_modes_do_not_feel_the_sag():
    rope = rd.Rope(LENGTH, DENSITY, axial_stiffness=1e4)
    scene = rd.Scene(
        rope, tension=TENSION, gravity=rd.Gravity(300.0, inclination=0.4, own_weight=False)
    )
    modes = parabola(scene).modes(4)
    twice = 2 * np.sqrt(TENSION / DENSITY) / (2 * LENGTH)
    second = int(np.abs(modes.frequency - twice).argmin())
    for path in ("gravity.g", "gravity.inclination", "axial_stiffness"):
        slope = modes.derivative(path)
        assert abs(slope[second]) <= EXACT * np.abs(slope).max()
    near(modes.derivative("tension")[[second]], np.array([twice / (2 * TENSION)]))


# --- differences ------------------------------------------------------------------------------

HANGING = rd.Scene(
    rd.Rope(
        LENGTH,
        DENSITY,
        axial_stiffness=2e5,
        bending_stiffness=2.0,
        torsional_stiffness=0.4,
        polar_inertia=3e-6,
        rotary_inertia=1e-5,
        lay_coupling=60.0,
        lay_slope=0.05,
    ),
    tension=100.0,
    gravity=rd.Gravity(60.0, inclination=0.3, own_weight=False),
    parts=[
        rd.LocalChange(0.2, 0.6, bending=0.7, torsion=1.3, density=1.4),
        rd.AddedMass(0.5, 0.9, 0.03, polar_inertia=1e-6),
        rd.PointMass(1.0, 0.02),
    ],
)
"""Every coupling, and an axial spring of its own under each density."""

SMOOTH = (
    "gravity.g",
    "gravity.inclination",
    "tension",
    "axial_stiffness",
    "torsional_stiffness",
    "bending_stiffness",
    "lay_coupling",
    "lay_slope",
    "linear_density",
    "polar_inertia",
    "rotary_inertia",
    "parts[0].bending",
    "parts[0].torsion",
    "parts[0].density",
    "parts[1].linear_density",
    "parts[2].mass",
)
PLACES = ("length", "parts[0].start", "parts[1].stop", "parts[2].x")


@functools.cache
def hanging(kind):
    """The model of HANGING and its modes."""
    model = parabola(HANGING, **MODELS[kind])
    return model, model.modes(4)


@pytest.mark.parametrize("kind", MODELS)
@pytest.mark.parametrize("path", SMOOTH + PLACES)
def test_derivative_under_gravity_is_what_differences_tend_to(kind, path):
    model, modes = hanging(kind)
    is_limit_of_differences(model, modes, path, 1e-3 if path in PLACES else 3e-3)


# --- limits, scaling, damage ------------------------------------------------------------------


@pytest.mark.parametrize("kind", MODELS)
def test_sag_grows_with_the_square_of_gravity(kind):
    """Lambda is even in g: no slope without any, and a slope in proportion to a small one.

    But where lay couples tension and bending, which tell up from down.
    """
    slopes = []
    rope = HANGING.rope.replace(lay_coupling=None)
    for g in (0.0, 1e-3, 2e-3):
        scene = HANGING.replace(rope=rope, gravity=rd.Gravity(g))
        slopes.append(parabola(scene, **MODELS[kind]).modes(2).derivative("gravity.g"))
    assert (np.abs(slopes[0]) <= EXACT * np.abs(slopes[1])).all()
    # (w L/H)^2 EA/T is 1e-9 there
    np.testing.assert_allclose(slopes[2], 2 * slopes[1], rtol=1e-7)


def test_without_gravity_the_rope_has_no_sag_to_change():
    model = HANGING.replace(gravity=None, parts=[]).compile(elements=4)
    with pytest.raises(rd.SceneError, match=r"one of \"tension\".*got 'gravity\.g'"):
        model.modes(1).derivative("gravity.g")


@pytest.mark.parametrize("kind", MODELS)
def test_numbers_of_one_kind_balance_under_gravity(kind):
    """Lambda goes with all forces and w = mu g, and with 1/mu, 1/p, 1/j if w stays what it is."""
    _, modes = hanging(kind)
    stiff = ("axial", "torsional", "bending")
    force = ["tension", "lay_coupling", *(f"{name}_stiffness" for name in stiff)]
    inertia = [
        "linear_density",
        "polar_inertia",
        "rotary_inertia",
        "parts[1].linear_density",
        "parts[1].polar_inertia",
        "parts[2].mass",
    ]
    for paths, sign in ((force, 1), (inertia, -1)):
        each = [
            value_of(HANGING, p) * modes.derivative(p, of="eigenvalue")
            for p in (*paths, "gravity.g")
        ]
        total = sum(each[:-1]) + sign * each[-1]
        np.testing.assert_allclose(total, sign * modes.eigenvalue, rtol=EXACT)


@pytest.mark.parametrize("kind", MODELS)
def test_damage_everywhere_is_a_loss_of_the_whole_rope_under_gravity(kind):
    """All but the length of the curve, which a local loss leaves alone."""
    whole = rd.LocalChange(0.0, LENGTH, density=1.0)
    scene = HANGING.replace(parts=[whole])
    modes = parabola(scene, **MODELS[kind]).modes(4)
    damage = modes.damage()
    for name in ("bending_stiffness", "axial_stiffness", "torsional_stiffness", "polar_inertia"):
        total = damage.frequency_change(0.0, LENGTH, **{name: 1.0})
        expected = -value_of(scene, name) * modes.derivative(name) / modes.frequency
        np.testing.assert_allclose(total, expected, rtol=1e-9, atol=1e-12)
    losses = dict.fromkeys(("linear_density", "polar_inertia", "rotary_inertia"), 1.0)
    total = damage.frequency_change(0.0, LENGTH, **losses)
    expected = -modes.derivative("parts[0].density") / modes.frequency
    np.testing.assert_allclose(total, expected, rtol=1e-9)
