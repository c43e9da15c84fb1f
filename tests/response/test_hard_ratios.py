"""Responses where inertias and stiffnesses differ by 10^12, and where parts stand together."""

import pytest
from exact_chain import error_over_condition

import ropedyn as rd

LENGTH = 1.0
ROPE = rd.Rope(LENGTH, 0.1, bending_stiffness=2.0)
EXACT = "mpmath, 60 digits: tests/support/exact_chain.py"
ACCEPTED = 1e-13
KINDS = pytest.mark.parametrize("element", ["rigid", "tensed"])
FREQUENCIES = (0.01, 1.0, 111.0, 1111.0)

STIFF = 2.0 / LENGTH**3
"""The scale of a spring, B/L^3 [N/m]."""

RATIOS = {
    "masses of 1e6 and 1e-6 of the rope": [rd.PointMass(0.3, 1e5), rd.PointMass(0.7, 1e-7)],
    "a mass of 1e12": [rd.PointMass(0.3, 1e11)],
    "an inertia of 1e12": [rd.PointMass(0.3, 0.0, rotary_inertia=1e11)],
    "springs of 1e12 and 1e-12": [rd.Spring(0.3, 1e12 * STIFF), rd.Spring(0.7, 1e-12 * STIFF)],
    "turning springs of 1e12 and 1e-12": [
        rd.Spring(0.3, 2e12, coordinate="beta"),
        rd.Spring(0.7, 2e-12, coordinate="beta"),
    ],
    "a spring against a mass": [rd.Spring(0.3, 1e12 * STIFF), rd.PointMass(0.3, 1e5)],
}


def worst(model, nodes, coordinates=("z", "beta"), frequencies=FREQUENCIES):
    """Largest error / condition of drive points."""
    return max(
        error_over_condition(model, f, (c, node))[0]
        for f in frequencies
        for node in nodes
        for c in coordinates
    )


@KINDS
@pytest.mark.parametrize("ends", [("clamped", "pinned"), ("free", "free")], ids="-".join)
@pytest.mark.parametrize("tension", [0.0, 50.0])
@pytest.mark.parametrize("parts", RATIOS)
@pytest.mark.claim(
    "FRF with inertias and springs 1e12 and 1e-12 times the rope's: error / condition",
    reference=EXACT,
    accepted=4e-14,
)
def test_ratios_of_1e12_cost_no_digit(parts, tension, ends, element, claim):
    scene = rd.Scene(ROPE, tension=tension, ends=ends, parts=RATIOS[parts])
    claim(worst(scene.compile(elements=10, element=element), [3, 5]))


@KINDS
@pytest.mark.parametrize("ends", [("clamped", "clamped"), ("free", "free")], ids="-".join)
@pytest.mark.claim(
    "FRF of a rope with inertia on some coordinates only: error / condition",
    reference=EXACT,
    accepted=4e-14,
)
def test_coordinates_without_mass_cost_no_digit(ends, element, claim):
    rope = ROPE.replace(torsional_stiffness=1.0, lay_slope=0.3, polar_inertia=1e-6)
    disc = [rd.PointMass(0.5, 0.0, rotary_inertia=1e-3)]
    model = rd.Scene(rope, tension=50.0, ends=ends, parts=disc).compile(elements=8, element=element)
    claim(worst(model, [2, 4], ("z", "alpha", "beta")))


@KINDS
@pytest.mark.parametrize("ends", [("free", "pinned"), ("pinned", "free")], ids="-".join)
@pytest.mark.claim(
    "FRF of a laid rope that turns as a body and is held against twist, 0.001 to 1 Hz: "
    "error / condition",
    reference=EXACT,
    accepted=3e-14,
)
def test_body_that_turns_and_cannot_twist_costs_no_digit(ends, element, claim):
    rope = ROPE.replace(torsional_stiffness=0.1, lay_slope=-0.9, polar_inertia=1e-5)
    model = rd.Scene(rope, tension=0.0, ends=ends).compile(elements=4, element=element)
    claim(worst(model, [1, 3], ("z", "alpha", "beta"), (0.001, 0.1, 1.0)))


TOGETHER = [
    rd.PointMass(0.3, 0.02),
    rd.Spring(0.3, 100.0),
    rd.Spring(0.3, -40.0),
    rd.Spring(0.3, 3.0, coordinate="beta"),
    rd.PointMass(0.3, 0.01, rotary_inertia=1e-5),
    rd.PointMass(0.0, 1.0),
    rd.Spring(0.0, 5e3),
    rd.PointMass(LENGTH, 0.5),
    rd.Spring(LENGTH, -0.5, coordinate="beta"),
]


@KINDS
@pytest.mark.parametrize("ends", [("free", "free"), ("pinned", "free")], ids="-".join)
@pytest.mark.claim(
    "FRF with parts at the same place and at both ends: error / condition",
    reference=EXACT,
    accepted=3e-14,
)
def test_parts_at_one_place_and_at_the_ends_add(ends, element, claim):
    model = rd.Scene(ROPE, tension=50.0, ends=ends, parts=TOGETHER).compile(
        elements=8, element=element
    )
    claim(max(worst(model, [0], ("beta",)), worst(model, [2, 8])))
