"""Ropes whose tension grows by their own weight, in both planes and beside twist and stretch."""

import math

import numpy as np
import pytest

import ropedyn as rd

GRAVITY = rd.Gravity(9.81, inclination=1.1, sag=False)
ROPE = rd.Rope(30.0, 5.0, bending_stiffness=(400.0, 90.0), rotary_inertia=(2e-3, 5e-4))
TENSION = rd.Tension(1400.0, at="start")
MASS = rd.PointMass(11.0, 40.0)


def scene(planes="both", rope=ROPE, **changes):
    return rd.Scene(
        rope, tension=TENSION, gravity=GRAVITY, planes=planes, **{"parts": (MASS,), **changes}
    )


def alone(index):
    """The scene in one plane, with the stiffness of z or of y."""
    pair = ("bending_stiffness", "rotary_inertia")
    return scene("z", ROPE.replace(**{name: getattr(ROPE, name)[index] for name in pair}))


def test_each_plane_has_the_frequencies_of_a_rope_that_moves_in_it_alone():
    modes = scene().compile().modes(10)
    for plane, index in (("z", 0), ("y", 1)):
        own = modes.plane == plane
        other = alone(index).compile().modes(int(own.sum()))
        limit = modes.rounding_error[own] + other.rounding_error
        assert own.sum() == 5
        assert (np.abs(modes.frequency[own] - other.frequency) <= limit).all()
        for path in ("gravity.g", "tension", "parts[0].mass"):
            np.testing.assert_allclose(
                modes.derivative(path)[own], other.derivative(path), rtol=1e-9, atol=1e-12
            )


@pytest.mark.parametrize(("plane", "index"), [("z", 0), ("y", 1)])
def test_each_plane_answers_a_force_as_a_rope_that_moves_in_it_alone(plane, index):
    lines = np.array([0.0, 0.31, 0.7, 2.9])
    both = scene().compile().frf(lines, drive=(plane, 9.0), response=(plane, 21.0))
    one = alone(index).compile().frf(lines, drive=("z", 9.0), response=("z", 21.0))
    assert (np.abs(both.value - one.value) <= both.rounding_limit + one.rounding_limit).all()


def test_a_rope_in_both_planes_is_the_same_cut_elsewhere():
    whole, cut = scene().compile(), scene().compile(elements=7, element="continuous")
    one, other = whole.modes(8), cut.modes(8)
    limit = one.rounding_error + other.rounding_error
    assert (np.abs(one.frequency - other.frequency) <= limit).all()
    middle = (one.frequency[:-1] + one.frequency[1:]) / 2
    assert [cut.count(below=f) for f in middle] == list(range(1, 8))


@pytest.mark.parametrize("planes", ["z", "both"])
def test_resonator_shares_the_energy_where_the_rope_twists_beside_a_growing_tension(planes):
    rope = ROPE.replace(
        bending_stiffness=400.0, rotary_inertia=None, torsional_stiffness=50.0, polar_inertia=1e-3
    )
    resonator = rd.Resonator(12.0, 9.0, 0.45)
    modes = scene(planes, rope, parts=(resonator,)).compile().modes(6)
    kinds = [kind for kind in modes.energy if kind not in ("bending", "tension", "twist", "spring")]
    moving = [kind for kind in kinds if kind != "resonator"]
    assert "resonator" in kinds
    assert np.isfinite([modes.energy[kind] for kind in moving]).all()
    assert math.isclose(
        modes.frequency[0],
        scene(planes, rope, parts=(resonator,))
        .compile(elements=9, element="continuous")
        .modes(1)
        .frequency[0],
        rel_tol=1e-12,
    )


@pytest.mark.parametrize("elements", [40, 60, 120])
def test_lumps_of_negative_mass_are_told_from_zeros_of_all_units(elements):
    rope = rd.Rope(
        2.5992806540756925,
        8.41294919816472,
        bending_stiffness=167.92693070469534,
        torsional_stiffness=863.4641928903494,
        rotary_inertia=(2.175181333971964e-06, 5.853646721391733e-06),
        polar_inertia=3.5053403540766014e-05,
    )
    springs = {"y": 13.0, "z": 48.0, "beta": 1.4, "gamma": 4900.0}
    loose = rd.End(**dict.fromkeys(springs, "free"), spring=springs)
    model = rd.Scene(rope, tension=11e3, ends=("pinned", loose), planes="both").compile(
        elements=elements
    )
    assert model.chain.spurious == (np.linalg.eigvalsh(model.mass_matrix().toarray()) < 0).sum()
