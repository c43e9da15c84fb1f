"""What has no effect costs nothing: a mass of 0, a factor of 1."""

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.chain.compiled import part_of
from ropedyn.chain.lean import lean

EPS = np.finfo(float).eps
ROPE = rd.Rope(
    2.0, 0.1, bending_stiffness=0.8, torsional_stiffness=0.3, polar_inertia=1e-6, lay_slope=0.1
)
IDLE = (
    rd.PointMass(0.31, 0.0),
    rd.PointMass(0.4, 0.0),
    rd.LocalChange(1.2, 1.3),
)
WITH = {
    "nothing": {},
    "a mass": {"parts": [rd.PointMass(0.7, 0.02)]},
    "a support": {"parts": [rd.Support(0.7)]},
    "a hinge": {"parts": [rd.Hinge(0.7, stiffness=2.0)]},
    "a change": {"parts": [rd.LocalChange(0.6, 0.75, bending=0.5)]},
    "a resonator": {"parts": [rd.Resonator(0.7, 0.01, 30.0, damping_ratio=0.1)]},
    "a dashpot": {"parts": [rd.Dashpot(0.7, 1.0)]},
    "drag": {"damping": rd.ViscousDamping(0.3)},
}


def pair(name):
    """A scene, and the same one with parts that do nothing."""
    scene = rd.Scene(ROPE, tension=300.0, **WITH[name])
    return scene, scene.replace(parts=[*scene.parts, *IDLE])


def with_idle():
    return pytest.mark.parametrize("name", WITH)


@with_idle()
def test_the_chain_that_is_solved_is_that_without_them(name):
    scene, idle = (one.compile() for one in pair(name))
    assert len(idle.x) > len(scene.x)
    for component in scene.components:
        mine, other = (part_of(model, component) for model in (idle, scene))
        assert (mine.nodes, len(mine.length)) == (other.nodes, len(other.length))
        for name in ("length", "tension", "flexibility", "inertia", "mass", "stiffness", "held"):
            own = [getattr(c, name)[c.term if name in {"mass", "stiffness", "held"} else c.element]
                   for c in (mine, other)]  # fmt: skip
            np.testing.assert_allclose(*own, rtol=4 * EPS)


@with_idle()
def test_answers_are_those_without_them(name):
    scene, idle = (one.compile() for one in pair(name))
    asked = {"drive": ("z", 0.4), "response": [("z", 1.1), ("F_z", 1.2), ("alpha", 0.31)]}
    mine, other = (model.frf([3.0, 40.0, 90.0], **asked) for model in (idle, scene))
    bars = mine.rounding_limit + other.rounding_limit
    assert (np.abs(mine.value - other.value) <= bars).all()
    mine, other = (model.modes(6) for model in (idle, scene))
    bars = mine.rounding_error + other.rounding_error
    assert (np.abs(mine.frequency - other.frequency) <= bars).all()
    assert mine.family.tolist() == other.family.tolist()
    mine, other = (model.modes(4, damped=True) for model in (idle, scene))
    np.testing.assert_allclose(mine.eigenvalue, other.eigenvalue, rtol=1e-10, atol=1e-9)
    assert idle.count(below=90.0) == scene.count(below=90.0)


@with_idle()
def test_stations_stay(name):
    idle = pair(name)[1]
    model = idle.compile()
    for part in IDLE:
        for at in (getattr(part, "x", None), getattr(part, "start", None)):
            assert at is None or at in model.x


def test_nodes_that_are_left_are_where_they_were():
    model = pair("a mass")[1].compile()
    chain, kept = lean(model.chain)
    assert model.x[kept].tolist() == [0.0, 0.7, 2.0]
    length = chain.length[chain.element] * np.diff(chain.first)
    np.testing.assert_allclose(np.diff(model.x[kept]), length, rtol=4 * EPS)


def test_what_names_the_path_of_a_mass_of_zero_sees_it():
    scene = rd.Scene(ROPE, tension=300.0, parts=[rd.PointMass(0.31, 0.0)])
    model, by = scene.compile(), "parts[0].mass"
    step = 1e-6
    heavier = scene.replace(parts=[rd.PointMass(0.31, step)]).compile()
    slope = (heavier.modes(3).frequency - model.modes(3).frequency) / step
    # of a difference the curvature is left, some 2 mass/(mu L) of it
    np.testing.assert_allclose(model.modes(3).derivative(by), slope, rtol=1e-4)
    frf, other = (one.frf([20.0], drive=("z", 1.0)) for one in (model, heavier))
    slope = (other.value - frf.value) / step
    np.testing.assert_allclose(frf.derivative(by), slope, rtol=1e-4)
    family = scene.family([by]).modes([[0.0], [step]], 3)
    np.testing.assert_allclose(family.frequency[1], heavier.modes(3).frequency, rtol=1e-13)
