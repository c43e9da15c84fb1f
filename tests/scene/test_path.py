"""Numbers of a scene by their paths."""

import pytest

import ropedyn as rd
from ropedyn.scene.path import value_at, with_values

SCENE = rd.Scene(
    rd.Rope(1.35, 0.1, bending_stiffness=1.5, axial_stiffness=9e5),
    tension=2830.0,
    ends=(rd.End(beta="free", spring={"beta": 12.0}), "clamped"),
    damping=(rd.StiffnessDamping(1e-4), rd.ViscousDamping(0.2)),
    parts=(rd.PointMass(0.5, 0.02), rd.LocalChange(0.2, 0.3, bending=0.9)),
    gravity=rd.Gravity(),
)
VALUES = {
    "tension": 2830.0,
    "bending_stiffness": 1.5,
    "length": 1.35,
    "rope.linear_density": 0.1,
    "parts[0].mass": 0.02,
    "parts[0].x": 0.5,
    "parts[1].bending": 0.9,
    "ends[0].spring.beta": 12.0,
    "damping[0].gamma": 1e-4,
    "damping[1].coefficient": 0.2,
    "gravity.g": 9.81,
}


@pytest.mark.parametrize(("path", "value"), VALUES.items())
def test_number_is_read_where_its_path_leads(path, value):
    assert value_at(SCENE, path) == value


@pytest.mark.parametrize("path", VALUES)
def test_changed_number_is_read_again_and_no_other_changes(path):
    changed = with_values(SCENE, {path: 1.1 * VALUES[path]})
    expected = {**VALUES, path: 1.1 * VALUES[path]}
    assert {p: value_at(changed, p) for p in VALUES} == expected


def test_numbers_of_a_pulsating_tension_change_one_by_one():
    pulsating = SCENE.replace(gravity=None, tension=rd.Tension(10.0, amplitude=5.0, frequency=3.0))
    changed = with_values(pulsating, {"tension": 20.0, "tension.amplitude": 4.0})
    assert changed.tension == rd.Tension(20.0, amplitude=4.0, frequency=3.0)


def test_one_damping_needs_no_number():
    scene = SCENE.replace(damping=rd.StiffnessDamping(1e-4))
    assert value_at(with_values(scene, {"damping.gamma": 2e-4}), "damping[0].gamma") == 2e-4


@pytest.mark.parametrize(
    "path",
    [
        "",
        "wind",
        "rotary_inertia",
        "parts[7].mass",
        "parts[0].wind",
        "parts[-1].mass",
        "parts[0]",
        "ends[1].spring.beta",
        "ends[0].spring.z",
        "damping.gamma",
        "damping[0].eta",
        "parts[1].replace",
        "tension.wind",
    ],
)
def test_path_that_leads_nowhere_is_refused_by_name(path):
    for ask in (lambda: value_at(SCENE, path), lambda: with_values(SCENE, {path: 1.0})):
        with pytest.raises(rd.SceneError, match=r"path must be that of a number of the scene"):
            ask()


def test_path_of_another_type_is_refused():
    with pytest.raises(TypeError, match="path must be a string"):
        value_at(SCENE, 3)


def test_number_that_a_scene_cannot_have_is_refused_by_the_scene():
    with pytest.raises(rd.SceneError, match=r"mass must be a finite number >= 0"):
        with_values(SCENE, {"parts[0].mass": -1.0})
