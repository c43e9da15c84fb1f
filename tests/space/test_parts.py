"""Masses, springs, dashpots and supports on a rope whose six coordinates are solved at once."""

import numpy as np
import pytest

import ropedyn as rd

TORQUE = 1e-12  # [N m] Changes 1e-20 of anything, and has the rope solved in space.
ROPE = rd.Rope(
    2.0,
    0.5,
    bending_stiffness=(5.0, 4.0),
    torsional_stiffness=1.0,
    axial_stiffness=1e5,
    polar_inertia=1e-3,
)
PARTS = (
    rd.PointMass(0.6, 0.2, rotary_inertia=1e-3, polar_inertia=2e-3),
    rd.Spring(0.6, 3e3),
    rd.Spring(1.3, 2.0, coordinate="gamma"),
    rd.Support(1.3, coordinate="y"),
    rd.Dashpot(0.9, 0.7, coordinate="z"),
)


def scene_of(rope=ROPE, **how):
    return rd.Scene(rope, **{"tension": 800.0, "planes": "both", "parts": PARTS} | how)


def test_parts_of_a_straight_rope_are_those_of_a_chain():
    chain, space = scene_of().compile(), scene_of(torque=TORQUE).compile()
    assert isinstance(space, rd.SpaceModel)
    a, b = chain.modes(12), space.modes(12)
    assert np.abs(b.frequency / a.frequency - 1).max() < 1e-12
    assert b.damping_ratio == pytest.approx(a.damping_ratio, rel=1e-9)
    for name in ("spring", "bending", "y", "alpha"):
        assert b.energy[name] == pytest.approx(a.energy[name], abs=1e-9)
    f, ask = np.linspace(3.0, 60.0, 9), {"drive": ("z", 0.3), "response": [("z", 1.7), ("z", 0.6)]}
    one, other = (m.frf(f, **ask).value for m in (chain, space))
    assert np.abs(other / one - 1).max() < 1e-10
    load = {("y", 0.9): 3.0, ("alpha", 0.6): 0.1}
    here = chain.static(load)
    there = space.static(load, points=1)
    at = [int(np.abs(here.x - x).argmin()) for x in there.x]
    size = np.abs(here.displacement).max(axis=0)
    near = np.abs(there.displacement - here.displacement[at])
    assert (near <= 1e-11 * size.max()).all()


def test_half_a_mass_on_either_side_of_a_cut_is_the_whole():
    rope = rd.Rope(rd.Axis.arc(1.0, 2.0), 0.5, bending_stiffness=5.0, torsional_stiffness=3.0)
    halves = [rd.PointMass(0.8, 0.1), rd.PointMass(0.8, 0.1)]
    one, two = (
        rd.Scene(rope, parts=parts, planes="both").compile().modes(8).frequency
        for parts in ([rd.PointMass(0.8, 0.2)], halves)
    )
    assert np.abs(two / one - 1).max() < 1e-13
    bare = rd.Scene(rope, planes="both").compile().modes(8).frequency
    assert (one <= bare * (1 + 1e-12)).all() and (one[:4] < 0.99 * bare[:4]).any()


def test_a_mass_on_an_arch_does_to_first_order_what_its_motion_says():
    rope = rd.Rope(rd.Axis.arc(1.0, 2.0), 0.5, bending_stiffness=5.0, torsional_stiffness=3.0)
    scene = rd.Scene(rope, planes="both")
    modes = scene.compile().modes(4, points=2)
    small = 1e-6
    heavy = scene.replace(parts=[rd.PointMass(1.0, small)]).compile().modes(4)
    moved = (modes.shape[:, 1, :3] ** 2).sum(axis=1) / modes.modal_mass
    # one of them does not move there: a rounding over the mass is what is left
    rounded = 4 * np.finfo(float).eps / small
    change = (1 - heavy.eigenvalue / modes.eigenvalue) / small
    assert change == pytest.approx(moved, rel=1e-4, abs=rounded)
