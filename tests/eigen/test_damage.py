"""Where modes feel a local loss: closed forms, and the whole rope as the sum of its parts."""

import numpy as np
import pytest
from conftest import EVERYTHING, LAID
from test_sensitivity import DOUBLE, MODELS

import ropedyn as rd

LENGTH, DENSITY, BENDING = 1.3, 0.1, 2.0
ROPE = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING)
PINNED = rd.Scene(ROPE, ends=("pinned", "pinned"))
PART = 3e-11
"""Relative error of a part: its forces are differences of the motion of its ends, 16 eps over the
third power of the pi/64 radian that it is long at least."""


def squares(k, edge):
    """Mean of sin^2(k x) over each part."""
    return 0.5 - np.diff(np.sin(2 * k * edge)) / (4 * k * np.diff(edge))


@pytest.mark.claim(
    "relative change of f per local loss of bending stiffness and of mass, pinned tensed beam",
    reference="B k^2/(B k^2 + T) sin^2(k x) and sin^2(k x), mean over each of 64 parts",
    accepted=5e-12,
)
@pytest.mark.parametrize("tension", [0.0, 40.0])
def test_pinned_beam_feels_a_loss_where_it_bends(tension, claim):
    """A share B k^2/(B k^2 + T) of the stiffness is lost with B, by sin^2(k x)."""
    modes = PINNED.replace(tension=tension).compile().modes(3)
    damage = modes.damage(points=64)
    k = np.arange(1, 4)[:, None] * np.pi / LENGTH
    share = BENDING * k**2 / (BENDING * k**2 + tension)
    expected = -share * squares(k, damage.edge) / LENGTH
    claim(np.abs(damage.change["bending_stiffness"] - expected).max() * LENGTH)
    lighter = squares(k, damage.edge) / LENGTH
    claim(np.abs(damage.change["linear_density"] - lighter).max() * LENGTH)


def test_damage_at_a_node_of_the_curvature_is_not_felt():
    """Of the second mode in the middle: of a part 2 h long (k h)^2/3 of the largest is left."""
    damage = PINNED.compile().modes(2).damage(points=101)
    middle, h = 50, LENGTH / 202
    value = damage.change["bending_stiffness"]
    largest = np.abs(value).max(axis=1)
    assert abs(value[1, middle]) < (2 * np.pi / LENGTH * h) ** 2 / 2 * largest[1]
    assert abs(value[0, middle]) == largest[0]


def test_string_feels_no_loss_of_bending():
    damage = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0).compile().modes(2).damage()
    assert list(damage.change) == ["linear_density"]


@pytest.mark.parametrize("kind", MODELS)
def test_parts_of_the_rope_add_up_to_all_of_it(kind):
    """A loss everywhere is -p df/dp/f."""
    modes = EVERYTHING.compile(**MODELS[kind]).modes(4)
    damage = modes.damage()
    everywhere = {name: getattr(LAID, name) for name in damage.change}
    assert len(everywhere) == 6
    for name, value in everywhere.items():
        total = damage.frequency_change(0.0, LENGTH, **{name: 1.0})
        expected = -value * modes.derivative(name) / modes.frequency
        np.testing.assert_allclose(total, expected, rtol=1e-9, atol=1e-12)


def test_parts_of_several_elements_are_their_means():
    modes = EVERYTHING.compile().modes(6)
    coarse, fine = modes.damage(points=1), modes.damage(points=4)
    assert len(coarse.edge) == 6
    for name, value in coarse.change.items():
        means = fine.change[name].reshape(6, 5, 4).mean(axis=2)
        np.testing.assert_allclose(value, means, rtol=1e-9, atol=1e-12)


def test_rope_that_moves_rigidly_or_grows_has_no_frequency_to_change():
    free = PINNED.replace(ends=("free", "free")).compile().modes(3).damage()
    assert (free.change["bending_stiffness"][:2] == 0).all()
    assert (free.change["bending_stiffness"][2] < 0).any()
    growing = PINNED.replace(tension=-20.0).compile().modes(1).damage()
    assert (growing.change["bending_stiffness"] == 0).all()


def test_equal_spans_feel_damage_each_for_itself():
    scene = rd.Scene(
        ROPE, parts=[rd.Support(LENGTH / 2), rd.Support(LENGTH / 2, coordinate="beta")]
    )
    value = scene.compile().modes(2).damage(points=8).change["bending_stiffness"]
    assert (value[:, :8] != 0).all(axis=1).sum() == 1
    assert (value[:, 8:] != 0).all(axis=1).sum() == 1
    assert (value != 0).sum() == 16


def test_modes_that_damage_mixes_are_refused():
    with pytest.raises(rd.SolveError, match="modes 1 and 2 have the same frequency"):
        DOUBLE.compile().modes(2).damage()


def test_change_of_several_losses_is_their_sum():
    damage = PINNED.compile().modes(2).damage(points=10)
    both = damage.frequency_change(0.2, 0.5, bending_stiffness=0.1, linear_density=-0.2)
    one = damage.frequency_change(0.2, 0.5, bending_stiffness=0.1)
    other = damage.frequency_change(0.2, 0.5, linear_density=-0.2)
    np.testing.assert_allclose(both, one + other, rtol=1e-14)
    assert (damage.frequency_change(0.3, 0.3, bending_stiffness=0.5) == 0).all()


@pytest.mark.parametrize(
    ("arguments", "losses", "error", "words"),
    [
        ((0.5, 0.2), {"bending_stiffness": 0.1}, rd.SceneError, "stop must not lie left"),
        ((0.2, 9.0), {"bending_stiffness": 0.1}, rd.SceneError, "stop must lie on the rope"),
        ((0.2, 0.5), {"torsional_stiffness": 0.1}, rd.SceneError, "loss must be one of"),
        ((0.2, 0.5), {"bending_stiffness": "much"}, TypeError, "bending_stiffness must be"),
        ((0.2, 0.5), {"bending_stiffness": np.nan}, rd.SceneError, "bending_stiffness must be"),
    ],
)
def test_losses_without_meaning_are_refused(arguments, losses, error, words):
    damage = PINNED.compile().modes(1).damage(points=4)
    with pytest.raises(error, match=words):
        damage.frequency_change(*arguments, **losses)


def test_points_within_elements_are_refused():
    with pytest.raises(rd.SceneError, match="points must be left out for chains"):
        PINNED.compile(elements=4).modes(1).damage(points=4)


def test_map_has_a_row_for_each_mode_and_a_table():
    damage = PINNED.compile().modes(3).damage(points=16)
    ax = damage.plot(of="linear_density")
    assert ax.get_xlabel() == "position along the rope [m]"
    assert ax.collections[0].get_array().shape == (3, 16)
    np.testing.assert_array_equal(ax.collections[0].get_array(), damage.change["linear_density"])
    assert "bending_stiffness at [m]" in str(damage.table())
    with pytest.raises(rd.SceneError, match='of must be one of "bending_stiffness"'):
        damage.plot(of="lay_slope")
