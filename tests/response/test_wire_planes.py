"""A broken wire that stands round the rope: in one plane, and in both."""

import dataclasses
import math

import numpy as np
import pytest
from conftest import EPS
from two_planes import plane

import ropedyn as rd

ROPE = rd.Rope(1.35, 0.1, bending_stiffness=(1.54, 0.9))
LINES = np.linspace(5.0, 300.0, 101)
WIRE = rd.BrokenWire(0.5, 0.05, 3e-4, radius=2e-3, angle=0.7, damping_ratio=0.01)
BOTH = rd.Scene(ROPE, tension=2830.0, parts=[WIRE], planes="both")
TWISTS = rd.Scene(
    rd.Rope(1.35, 0.1, bending_stiffness=1.54, torsional_stiffness=0.15, polar_inertia=1e-6),
    tension=2830.0,
    parts=[WIRE],
)


def wire_of(scene, **changes):
    return scene.replace(parts=[dataclasses.replace(scene.parts[0], **changes)])


@pytest.mark.parametrize("how", [{}, {"elements": 16}])
@pytest.mark.parametrize("name", ["z", "y"])
def test_each_plane_carries_the_wire_as_it_does_alone(name, how):
    asked = {"drive": (name, 0.4), "response": [(name, 0.4), (name, 0.9)]}
    found = BOTH.compile(**how).frf(LINES, **asked)
    alone = plane(BOTH, name).compile(**how)
    right = alone.frf(LINES, drive=("z", 0.4), response=[("z", 0.4), ("z", 0.9)])
    np.testing.assert_array_equal(found.value, right.value)
    modes, own = BOTH.compile(**how).modes(12), alone.modes(6)
    mine = modes.frequency[modes.plane == name][:3]
    np.testing.assert_allclose(mine, own.frequency[: len(mine)], rtol=1e-12)


def test_a_tip_is_told_along_z():
    found = BOTH.compile().frf(LINES, drive=("z", 0.4), response=("wire", 0))
    alone = plane(BOTH, "z").compile().frf(LINES, drive=("z", 0.4), response=("wire", 0))
    np.testing.assert_array_equal(found.value, alone.value)
    across = BOTH.compile().frf(LINES, drive=("y", 0.4), response=("wire", 0))
    assert not across.value.any()


def test_the_second_of_two_wires_is_told_apart_in_both_planes():
    two = BOTH.replace(parts=[dataclasses.replace(WIRE, x=0.9, length=0.04), WIRE])
    found = two.compile().frf(LINES, drive=("z", 0.4), response=[("wire", 0), ("wire", 1)])
    alone = plane(two, "z").compile()
    right = alone.frf(LINES, drive=("z", 0.4), response=[("wire", 0), ("wire", 1)])
    np.testing.assert_array_equal(found.value, right.value)


def test_twist_moves_the_root_by_its_lever():
    asked = {"drive": ("alpha", 0.4), "response": [("z", 0.5), ("wire", 0)]}
    turned = TWISTS.compile().frf(LINES, **asked)
    lever = wire_of(TWISTS, radius=2e-3 * math.cos(0.7), angle=0.0)
    np.testing.assert_array_equal(turned.value, lever.compile().frf(LINES, **asked).value)


def test_frequencies_change_with_the_angle_as_with_the_lever():
    turned = TWISTS.compile().modes(8).derivative("parts[0].angle")
    lever = wire_of(TWISTS, radius=2e-3 * math.cos(0.7), angle=0.0).compile().modes(8)
    right = -2e-3 * math.sin(0.7) * lever.derivative("parts[0].radius")
    np.testing.assert_allclose(turned, right, rtol=64 * EPS, atol=0)
    assert np.abs(turned).max() > 0


def test_a_longer_wire_moves_modes_of_both_planes():
    change = BOTH.compile().modes(8).derivative("parts[0].length")
    step = 1e-6
    shifted = [wire_of(BOTH, length=0.05 + s * step).compile().modes(8) for s in (-1, 1)]
    slope = (shifted[1].frequency - shifted[0].frequency) / (2 * step)
    # central differences: step^2 and the rounding of frequencies over it
    np.testing.assert_allclose(change, slope, rtol=1e-5, atol=1e-6 * np.abs(slope).max())
