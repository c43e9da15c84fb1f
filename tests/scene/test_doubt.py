"""Numbers that no steel rope could have: said where a scene is read or shown, never changed."""

import re
import warnings

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.scene.card import doubts


def scene(length=1.35, density=0.1017, bending=1.54, tension=2830.0):
    return rd.Scene(rd.Rope(length, density, bending_stiffness=bending), tension=tension)


RIGHT = [
    scene(),
    scene(60.0, 80.0, 1e6, 3e6),  # a stay cable
    scene(300.0, 90.0, 1e6, 6e6),
    scene(1.08, 2.197e-3, 1e-4, 1.97),  # a cord
    scene(1.168, 0.29e-3, 1e-4, 0.99),  # a tube of film
    scene(0.65, 6.0e-3, 5e-4, 70.0),  # a string of a guitar
    scene(500.0, 8.0, 900.0, 2e5),  # a hoist rope
]
SLIPS = {
    "bending in N mm^2": (scene(bending=1.54e6), "bending_stiffness is .* that of a solid rod"),
    "bending in MN m^2": (scene(60.0, 80.0, 1e-6, 3e6), "bending_stiffness is .* of loose wires"),
    "density in g/m": (scene(density=101.7), "some 166 mm thick and 1.35 m long"),
    "density in t/m": (scene(60.0, 0.08, 1e6, 3e6), "bending_stiffness is .* of a solid rod"),
    "tension in mN": (scene(tension=2.83e6), "tension would stress steel by"),
}


@pytest.mark.parametrize("one", RIGHT, ids=lambda one: f"{one.rope.length:g} m")
def test_ropes_that_there_are_raise_no_doubt(one):
    assert doubts(one) == ()


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_is_said_where_a_scene_is_shown_and_read(slip, tmp_path):
    slipped, words = SLIPS[slip]
    path = tmp_path / "rope.toml"
    slipped.save(path)
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        assert rd.Scene.load(path) == slipped
    assert {(one.filename, one.category) for one in told} == {(__file__, rd.UnitWarning)}
    assert any(re.search(words, str(one.message)) for one in told)
    assert "doubt" in str(slipped)


def test_the_plane_of_z_of_a_pair_and_a_string_are_weighed():
    both = rd.Rope(1.35, 0.1017, bending_stiffness=(1.54e6, 1.54e6))
    assert doubts(rd.Scene(both, tension=2830.0, planes="both"))
    assert doubts(rd.Scene(rd.Rope(1.35, 0.1017), tension=2830.0)) == ()


def test_a_bending_test_that_no_rope_could_give_is_said():
    force = np.array([0.0, 2.0, 4.0])
    with pytest.warns(rd.UnitWarning, match=r"up to 10 m on a span of 0\.7 m") as told:
        rd.BendingTest(0.7, force, [0.0, 5.0, 10.0])
    assert told[0].filename == __file__


@pytest.mark.parametrize("size", [5e-324, 1e-300, 1e300])
def test_no_magnitude_is_too_absurd_to_be_doubted(size):
    assert doubts(scene(density=size))
    assert doubts(scene(bending=size))
