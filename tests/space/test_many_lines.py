"""Many lines on an axis, between a few that are solved, and shapes at equal parts of its pieces."""

import numpy as np
import pytest

import ropedyn as rd


def hanging(sag, bending=None, **how):
    """Return a level rope of some sag, in chords."""
    tension = 2.0 * 9.81 * 100.0 / (8 * sag)
    rope = rd.Rope(100.0, 2.0, axial_stiffness=1e6, bending_stiffness=bending)
    return rd.Scene(rope, tension=tension, gravity=rd.Gravity(9.81), **how)


SPRING = rd.Rope(rd.Axis.helix(0.05, 0.2, 3), 0.3, bending_stiffness=20.0, torsional_stiffness=15.0)
SCENES = {
    "string": hanging(0.06),
    "beam": hanging(0.2, bending=50.0),
    "damped": hanging(0.2, bending=50.0, damping=[rd.LossFactor(0.01), rd.ViscousDamping(0.1)]),
    "parts": hanging(0.1, bending=50.0, parts=[rd.Spring(30.0, 200.0), rd.Dashpot(60.0, 3.0)]),
    "helix": rd.Scene(SPRING, planes="both"),
}


@pytest.mark.parametrize("name", SCENES)
def test_many_lines_are_those_that_are_asked_a_few_at_a_time(name):
    model = SCENES[name].compile()
    length = SCENES[name].rope.length
    f = np.linspace(0.0037, 1.00123, 240) * model.modes(8).frequency[-1]
    ask = {"drive": ("z", 0.25 * length), "response": [("z", 0.7 * length), ("x", 0.4 * length)]}
    many = model.frf(f, **ask)
    few = np.concatenate([model.frf(part, **ask).value for part in np.split(f, 6)], axis=-1)
    off = np.abs(many.value - few)
    # at most 0.13 of both bounds was measured
    assert (off <= 2 * many.rounding_error * np.abs(few)).all()
    assert np.median(off / np.abs(few)) < 1e-12


@pytest.mark.parametrize("name", ["string", "beam", "helix"])
def test_shapes_do_not_depend_on_how_many_points_they_are_shown_at(name):
    model = SCENES[name].compile()
    coarse, fine = model.modes(6, points=8), model.modes(6, points=24)
    at = np.searchsorted(fine.x, coarse.x * (1 - 1e-12) - 1e-9)
    np.testing.assert_allclose(fine.x[at], coarse.x, atol=1e-9)
    mine, theirs = coarse.shape, fine.shape[:, at]
    turned = np.einsum("kxc,kxc->k", mine, theirs) / np.einsum("kxc,kxc->k", mine, mine)
    np.testing.assert_allclose(theirs, turned[:, None, None] * mine, atol=1e-9)
    # modal masses are of shapes whose largest value is 1 at the points
    np.testing.assert_allclose(fine.modal_mass / coarse.modal_mass, turned**2, rtol=1e-9)


RING = rd.Axis.ring(1.0)
WIRE = {"bending_stiffness": 1.0, "torsional_stiffness": 0.8, "axial_stiffness": 1e5}
LOW = {
    "ring": (rd.Scene(rd.Rope(RING, 1.0, **WIRE), planes="both"), [1e-6, *np.linspace(5, 10, 99)]),
    "spring": (SCENES["helix"], np.linspace(0, 1, 150)[1:] ** 3 * 5003),
    "free arc": (
        rd.Scene(
            rd.Rope(rd.Axis.arc(1.0, 2.0), 1.0, **WIRE),
            planes="both",
            ends=("free", "free"),
            damping=rd.LossFactor(1e-3),
        ),
        np.linspace(0.1, 2000.0, 160),
    ),
}


@pytest.mark.parametrize("name", LOW)
def test_low_lines_beside_many_high_ones_are_within_their_bounds(name):
    scene, f = LOW[name]
    f, model, length = np.array(f), scene.compile(), scene.rope.length
    ask = {"drive": ("z", 0.3 * length), "response": ("z", 0.7 * length)}
    many = model.frf(f, **ask)
    few = [model.frf(part, **ask) for part in np.array_split(f, 8)]
    value, limit = (
        np.concatenate([getattr(one, what) for one in few], axis=-1)
        for what in ("value", "rounding_limit")
    )
    # at most 0.08 of both bounds was measured; 5e-9 to 7e-4 off where low lines were interpolated
    assert (np.abs(many.value - value) <= 0.5 * (many.rounding_limit + limit)).all()
    # 2.2 times was measured
    assert np.median(many.rounding_error) < 4 * np.median(limit / np.abs(value))
