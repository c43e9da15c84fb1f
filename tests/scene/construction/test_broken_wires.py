"""Broken wires: what a section loses, how far from a break, and what that does to a rope."""

import numpy as np
import pytest

import ropedyn as rd

MADE = rd.Construction.standard("7x7", diameter=4e-3)
SECTION = MADE.section()
NAMES = ("axial_stiffness", "lay_coupling", "torsional_stiffness", "bending_slip")


def lost(section, whole=SECTION):
    return [1 - getattr(section, name) / getattr(whole, name) for name in NAMES]


def test_one_outer_wire_of_49_takes_its_share():
    # shares known to two digits
    assert np.round(lost(SECTION.without(1, layer=(0, 0))), 3) == pytest.approx(
        [0.020, 0.024, 0.021, 0.020], abs=0.0006
    )


def test_wires_of_one_strand_add_up():
    one, two = (SECTION.without(n, layer=(0, 0)) for n in (1, 2))
    # each wire carries by itself but for the twist of its strand
    assert lost(two) == pytest.approx(2 * np.array(lost(one)), rel=0.08)
    assert two.mass == pytest.approx(2 * one.mass - SECTION.mass, rel=1e-14)
    assert two.diameter == pytest.approx(SECTION.diameter, rel=1e-15)


@pytest.mark.parametrize("state", ["slip", "stick", "straight"])
def test_a_strand_without_wires_in_turn_loses_all(state):
    strand = rd.Construction.standard("1x7", diameter=3e-3)
    whole = strand.section(state)
    core = rd.Construction(core=strand.core).section(state)
    none = whole.without(6)
    for name in (*NAMES, "mass", "bending_stick"):
        assert getattr(none, name) == getattr(core, name)
    assert none.torsion == state


def test_where_wires_of_strands_are_all_gone_their_core_is_left():
    bare = SECTION.without(6, layer=(0, 0))
    layers = bare.construction.layers
    assert [layer.count for layer in layers] == [5, 1]
    assert layers[1].element.layers == ()


def test_a_wire_carries_again_where_friction_has_given_back_its_tension():
    # r/(mu c^2) of a wire on 4/9 mm with a lay of 12 mm
    r, around = 4e-3 / 9, 2 * np.pi * 4e-3 / 9
    c2 = around**2 / (around**2 + 0.012**2)
    assert SECTION.recovery(friction=0.2, layer=(0, 0)) == pytest.approx(r / (0.2 * c2), rel=1e-12)
    spiral = rd.Construction.standard("1x19", diameter=4e-3).section()
    assert spiral.recovery(friction=0.2) == spiral.recovery(friction=0.2, layer=1)


def test_a_break_is_a_local_change_of_what_the_rope_has():
    rope = rd.Rope.from_construction(1.35, MADE, bending="slip")
    change = rd.LocalChange.of_broken_wires(rope, 0.5, 2, friction=0.2, bending="slip")
    broken = SECTION.without(2)
    assert change.bending == broken.bending_slip / SECTION.bending_slip
    assert change.axial == broken.axial_stiffness / SECTION.axial_stiffness
    assert change.lay == broken.lay_coupling / SECTION.lay_coupling
    assert change.torsion == broken.torsional_stiffness / SECTION.torsional_stiffness
    assert change.density == 1
    length = SECTION.recovery(friction=0.2)
    assert (change.start, change.stop) == (0.5 - length, 0.5 + length)
    fallen = rd.LocalChange.of_broken_wires(rope, 0.0, 2, friction=0.2, fallen=True)
    assert (fallen.start, fallen.density) == (0.0, broken.mass / SECTION.mass)
    modes = [
        rd.Scene(rope, tension=300.0, parts=parts).compile().modes(4).frequency
        for parts in ([], [change])
    ]
    assert (modes[1] < modes[0]).all()


def test_a_rope_without_axial_stiffness_loses_none():
    rope = rd.Rope.from_construction(1.35, MADE, axial_stiffness=None, lay_coupling=None)
    change = rd.LocalChange.of_broken_wires(rope, 0.5, friction=0.2)
    assert change.axial == change.lay == 1
    rd.Scene(rope, parts=[change])


@pytest.mark.parametrize(
    ("layer", "message"),
    [
        (1, r"layer\[0\] must be a whole number from 0 to 0"),
        (0, "layer must be the number of a layer of wires, or of a layer and of one in its"),
        ((0, 0, 0), "there is none"),
        ((0, 3), r"layer\[1\] must be a whole number from 0 to 0"),
        ((), "layer must be"),
    ],
)
def test_layers_that_are_not_there_are_refused(layer, message):
    with pytest.raises(rd.SceneError, match=message):
        SECTION.without(1, layer=layer)


def test_what_cannot_break_is_refused():
    with pytest.raises(rd.SceneError, match="n must be a whole number from 1 to 6, got 7"):
        SECTION.without(7)
    with pytest.raises(rd.SceneError, match="friction must be"):
        SECTION.recovery(friction=0.0)
    with pytest.raises(rd.SceneError, match="rope must be from a construction"):
        rd.LocalChange.of_broken_wires(rd.Rope(1.0, 0.1), 0.5, friction=0.2)
    with pytest.raises(rd.SceneError, match="there is none"):
        rd.Construction(core=rd.Wire(1e-3)).section().without(1, layer=0)
