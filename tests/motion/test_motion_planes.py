"""Motion in both planes is that of each plane alone, under laws and pulsating tension too."""

import dataclasses

import numpy as np
import pytest
from conftest import long
from two_planes import plane, turned

import ropedyn as rd

ROPE = rd.Rope(1.35, 0.1, bending_stiffness=(1.54, 0.9), axial_stiffness=1e6)
ENDS = (rd.End(gamma="free"), "clamped")
TIME = np.linspace(0.0, 0.05, 41)
BOTH = rd.Scene(
    ROPE, tension=2830.0, ends=ENDS, damping=rd.RayleighDamping(1.0, 1e-6), planes="both"
)


def hardens(t, u, v):
    return -1e9 * u**3


ASKED = {
    "force": {"drive": ("y", 0.5), "force": rd.Sine(1.0, 70.0)},
    "blow": {"drive": ("y", 0.5), "force": rd.Impulse(1.0), "method": "line"},
    "moved end": {"drive": ("end", 1, "y"), "force": rd.Sine(1e-3, 40.0)},
    "released": {"start": {("y", 0.5): 1.0}},
}
LAWS = {
    "stop": rd.Stop(0.6, 1e4, gap=1e-5, coordinate="y"),
    "friction": rd.Dashpot(0.6, 0.1, exponent=0, coordinate="y"),
    "law": rd.NodeForce(0.6, hardens, coordinate="y"),
}


def in_z(asked):
    """The same question to the plane of y alone."""
    changed = dict(asked)
    if "drive" in asked:
        changed["drive"] = turned(asked["drive"])
    if "start" in asked:
        changed["start"] = {turned(at): load for at, load in asked["start"].items()}
    return changed


@pytest.mark.parametrize("elements", [{}, {"elements": 12}])
@pytest.mark.parametrize("case", ASKED)
def test_motion_in_the_plane_of_y_is_that_of_it_alone(case, elements):
    found = BOTH.compile(**elements).transient(
        TIME, **ASKED[case], response=[("y", 0.3), ("z", 0.3)]
    )
    alone = plane(BOTH, "y").compile(**elements)
    right = alone.transient(TIME, **in_z(ASKED[case]), response=("z", 0.3))
    np.testing.assert_array_equal(found.value[0], right.value[0])
    assert np.abs(found.value[0]).max() > 0
    assert not found.value[1].any()


@pytest.mark.parametrize("begins", ["start", "velocity"])
def test_shapes_of_y_begin_motion_as_shapes_of_z_do(begins):
    def bump(x):
        return 1e-3 * np.sin(np.pi * x / 1.35) ** 3

    model, alone = (scene.compile(elements=12) for scene in (BOTH, plane(BOTH, "y")))
    found = model.transient(TIME, **{begins: {"y": bump}}, response=("y", 0.3))
    right = alone.transient(TIME, **{begins: {"z": bump}}, response=("z", 0.3))
    np.testing.assert_array_equal(found.value, right.value)


@pytest.mark.parametrize("law", LAWS)
def test_laws_act_in_the_plane_of_y_as_in_that_of_z(law):
    scene = BOTH.replace(parts=[LAWS[law]])
    alone = plane(BOTH, "y").replace(parts=[dataclasses.replace(LAWS[law], coordinate="z")])
    asked = {"force": rd.Sine(1.0, 70.0)}
    time = TIME[:13]
    found = scene.compile().transient(time, drive=("y", 0.5), response=("y", 0.3), **asked)
    right = alone.compile().transient(time, drive=("z", 0.5), response=("z", 0.3), **asked)
    np.testing.assert_array_equal(found.value, right.value)


def test_a_law_in_a_plane_that_nothing_watches_changes_nothing():
    scene = BOTH.replace(parts=[rd.NodeForce(0.6, hardens)])
    asked = {"drive": [("y", 0.5), ("z", 0.5)], "force": [rd.Sine(1.0, 70.0)] * 2}
    found = scene.compile().transient(TIME, **asked, response=("y", 0.3))
    right = BOTH.compile().transient(TIME, **asked, response=("y", 0.3))
    np.testing.assert_array_equal(found.value, right.value)


def test_harmonic_balance_takes_a_law_in_the_plane_of_y():
    lines = [50.0, 65.0]
    scene = BOTH.replace(parts=[LAWS["law"]])
    alone = plane(BOTH, "y").replace(parts=[rd.NodeForce(0.6, hardens)])
    found = scene.compile().stepped_sine(lines, drive=("y", 0.5), amplitude=2.0)
    right = alone.compile().stepped_sine(lines, drive=("z", 0.5), amplitude=2.0)
    np.testing.assert_array_equal(found.value, right.value)


PULSATING = BOTH.replace(tension=rd.Tension(2830.0, amplitude=300.0, frequency=130.0))


@pytest.mark.parametrize("name", ["y", *long("z")])
def test_a_tension_that_pulsates_acts_in_each_plane_alone(name):
    model = PULSATING.compile(elements=4)
    alone = plane(PULSATING, name).compile(elements=4)
    push = rd.Sine(1.0, 70.0)
    # a node: between nodes rotations without inertia follow a force at once
    found = model.transient(TIME, drive=(name, 0.675), force=push, response=(name, 0.3))
    right = alone.transient(TIME, drive=("z", 0.675), force=push, response=("z", 0.3))
    np.testing.assert_array_equal(found.value, right.value)
    steady = model.stepped_sine([30.0], drive=(name, 0.5), amplitude=1.0)
    own = alone.stepped_sine([30.0], drive=("z", 0.5), amplitude=1.0)
    # Newton's steps stop at 1e-9 of the motion
    np.testing.assert_allclose(steady.value, own.value, rtol=1e-9)


@pytest.mark.parametrize("elements", [{}, {"elements": 12}])
def test_hill_s_problem_has_the_multipliers_of_both_planes(elements):
    found = PULSATING.compile(**elements).floquet(modes=6)
    each = [plane(PULSATING, name).compile(**elements).floquet(modes=3) for name in ("z", "y")]
    right = np.concatenate([one.growth for one in each])
    np.testing.assert_allclose(np.sort(found.growth), np.sort(right), atol=1e-9)
    assert found.stable == all(one.stable for one in each)


def test_hill_s_problem_says_how_many_modes_both_planes_have():
    model = PULSATING.compile(elements=3)
    each = [plane(PULSATING, name).compile(elements=3) for name in ("z", "y")]
    have = [one.floquet(modes=None).multiplier.size for one in each]
    assert model.floquet(modes=None).multiplier.size == sum(have)
    with pytest.raises(rd.SolveError, match="modes must be at most"):
        model.floquet(modes=40)
