"""A broken wire that is still wound, beside the straight cantilever of a scene."""

import math

import numpy as np
import pytest

import ropedyn as rd

WIRE = rd.BrokenWire(0.5, 0.05, 3e-4, radius=2e-3)


def frequencies(lay, number=4, **how):
    return rd.wound_wire(WIRE, lay_length=lay, **how).compile().modes(number).frequency


def test_a_long_lay_leaves_a_straight_cantilever():
    straight = frequencies(100.0)
    assert straight[1] == pytest.approx(straight[0], rel=1e-8)
    # what rotary inertia takes of a first mode, 2.3 (d/4 l)^2 in lambda: 5e-6
    assert straight[0] == pytest.approx(WIRE.frequency, rel=1e-5)


def test_a_short_lay_splits_and_moves_the_modes_of_a_straight_wire():
    wound = frequencies(0.03)
    assert wound[0] / WIRE.frequency == pytest.approx(1.0646, abs=1e-4)
    assert wound[1] / wound[0] - 1 > 3e-3
    assert wound[2] / frequencies(100.0)[2] < 0.95


def test_the_wire_is_as_long_as_it_was_and_turns_as_it_is_laid():
    axes = [rd.wound_wire(WIRE, lay_length=0.03, sense=s).rope.axis for s in ("right", "left")]
    for axis, sign in zip(axes, (1, -1)):
        assert axis.length == pytest.approx(WIRE.length, rel=1e-14)
        tau, kz, _ = axis.rates(0.0)
        p = math.atan2(0.03, 2 * math.pi * 2e-3)
        assert [tau, kz] == pytest.approx(
            [sign * math.sin(p) * math.cos(p) / 2e-3, math.cos(p) ** 2 / 2e-3], rel=1e-13
        )
    # a mirror image has the same frequencies
    left = frequencies(0.03, sense="left")
    assert np.abs(left / frequencies(0.03) - 1).max() < 1e-12


def test_a_wire_keeps_its_damping_ratio():
    wire = rd.BrokenWire(0.5, 0.05, 3e-4, radius=2e-3, damping_ratio=0.01)
    modes = rd.wound_wire(wire, lay_length=0.03).compile().modes(3)
    assert modes.damping_ratio == pytest.approx(np.full(3, 0.01), rel=1e-9)


@pytest.mark.parametrize(
    ("wire", "how", "message"),
    [
        (WIRE, {"lay_length": 0.0}, "lay_length must be a finite number > 0"),
        (WIRE, {"lay_length": 0.1, "poisson": 0.6}, "poisson must be from -1 to 1/2"),
        (WIRE, {"lay_length": 0.1, "sense": "up"}, "sense must be one of"),
        (
            rd.BrokenWire(0.5, 0.05, 3e-4, radius=0.0),
            {"lay_length": 0.1},
            "wire must lie beside the axis",
        ),
    ],
)
def test_what_is_no_wound_wire_is_refused(wire, how, message):
    with pytest.raises(rd.SceneError, match=message):
        rd.wound_wire(wire, **how)
