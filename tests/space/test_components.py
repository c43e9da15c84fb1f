"""Planes that nothing ties are solved by themselves, and only those that are asked for."""

import math

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.space import spectrum
from ropedyn.space.rope import ALL
from ropedyn.space.spectrum import Counter, count_below, lowest

SAME = 1e-13
"""Relative: 2e-14 was the most; coordinates that are alone add zeros to sums."""

ARC = rd.Axis.arc(1.0, 2.0)
ROUND = {"bending_stiffness": 50.0, "torsional_stiffness": 30.0}
INSIDE, ACROSS = ("x", "z", "beta"), ("y", "alpha", "gamma")


def model(axis=ARC, tension=0.0, torque=0.0, ends=("clamped", "clamped"), **more):
    rope = rd.Rope(axis, 0.5, **ROUND | more)
    return rd.Scene(rope, planes="both", tension=tension, torque=torque, ends=ends).compile()


def tied(model):
    """The same, all six coordinates together."""
    rope = model.scene.compile().rope
    vars(rope)["own"] = ALL
    return rope


PLANE = {
    "arc": model,
    "tensed arc": lambda: model(tension=40.0, natural="straight"),
    "arms": lambda: model(rd.Axis.points([[0, 0, 0], [1, 0, 0], [1, 0, 1]])),
    "a plane that lies askew": lambda: model(
        rd.Axis.points([[0, 0, 0], [1, 2, 0.5], [2, 1, 3]], fillet=0.1)
    ),
    "unlike planes": lambda: model(bending_stiffness=(50.0, 20.0), shear_stiffness=1e4),
}
TIED = {
    "helix": lambda: model(rd.Axis.helix(0.5, 0.3, 1.0)),
    "torque": lambda: model(torque=5.0),
    "a lay": lambda: model(axial_stiffness=1e4, lay_coupling=100.0),
    "turned principal axes": lambda: model(bending_stiffness=(50.0, 20.0), principal_angle=0.3),
    "arms in space": lambda: model(rd.Axis.points([[0, 0, 0], [1, 0, 0], [1, 0, 1], [1, 1, 1.2]])),
}


@pytest.mark.parametrize("name", PLANE)
def test_a_plane_axis_is_three_coordinates_and_three(name):
    one = PLANE[name]()
    assert one.components == (INSIDE, ACROSS)
    rope = tied(one)
    modes, whole = one.modes(12), lowest(rope, 12, math.inf).eigenvalue
    assert modes.eigenvalue == pytest.approx(whole, rel=SAME)
    assert modes.certified
    for value in whole[:-1] * 1.003:
        assert count_below(one.rope, value) == count_below(rope, value)


@pytest.mark.parametrize("name", TIED)
def test_what_ties_the_planes_is_solved_in_six(name):
    assert TIED[name]().components == ((*"xyz", "alpha", "beta", "gamma"),)


def test_a_string_in_a_plane_is_two_coordinates_and_one():
    rope = rd.Rope(ARC, 0.5, axial_stiffness=1e6)
    one = rd.Scene(rope, planes="both", tension=300.0).compile()
    assert one.components == (("x", "z"), ("y",))


def test_only_the_modes_that_are_asked_for_are_found(monkeypatch):
    one = model()
    sought = []
    take = spectrum.Pursuit.__init__

    def begins(self, bracket, bends):
        sought.append(bracket)
        take(self, bracket, bends)

    monkeypatch.setattr(spectrum.Pursuit, "__init__", begins)
    planes = one.modes(10).plane
    assert len(sought) == len(set(sought)) == 10
    assert [b.component for b in sought].count(1) == (planes == "y").sum()
    sought.clear()
    # the first moves across the plane: nothing is assembled in it
    assert one.modes(1).plane == ["y"]
    assert [b.component for b in sought] == [1]


def test_a_response_is_that_of_the_plane_it_is_driven_in():
    one, f = model(ends=("clamped", "free")), np.linspace(0.5, 90.0, 40)
    inside = one.frf(f, drive=("z", 1.0))
    assert inside.cost.factorisations == 40
    points = [("y", 1.0), ("z", 1.0), ("gamma", 0.4), ("beta", 2.0)]
    every = one.frf(f, drive=points)
    assert every.cost.factorisations == 80
    assert every.value[1, 1] == pytest.approx(inside.value[0], rel=1e-12)
    assert (every.value[:2, [1, 0]][[0, 1], [0, 1]] == 0).all()
    none = one.frf(f, drive=("z", 1.0), response=("y", 1.0))
    assert none.cost.factorisations == 0
    assert (none.value == 0).all() and (none.rounding_error == 0).all()


def test_a_response_is_that_of_six_coordinates():
    one, f = model(tension=30.0), np.linspace(0.5, 90.0, 41)
    other = one.scene.compile()
    vars(other.rope)["own"] = ALL
    points = [("y", 0.9), ("z", 1.0), ("gamma", 0.4), ("x", 0.3)]
    found, wanted = (m.frf(f, drive=points) for m in (one, other))
    assert (
        np.abs(found.value - wanted.value) <= found.rounding_limit + wanted.rounding_limit
    ).all()


def test_a_load_bends_the_plane_it_lies_in():
    one = model()
    assert one.static({("z", 1.0): 2.0}, points=4).cost.factorisations == 1
    both = one.static({("z", 1.0): 2.0, ("y", 0.5): 1.0}, points=4)
    alone = [one.static({p: a}, points=4) for p, a in both.load]
    assert both.cost.factorisations == 2
    for k, c in enumerate(both.coordinates):
        own = alone[0] if c in INSIDE else alone[1]
        there = np.isin(both.x, own.x)
        assert both.displacement[there, k] == pytest.approx(own.displacement[:, k], rel=1e-9)


def test_counts_of_both_planes_are_asked_at_once():
    counter = Counter(model().rope)
    assert counter.total([1e4]) == [sum(counter.each([1e4])[0])]
    assert counter.asked == 2
