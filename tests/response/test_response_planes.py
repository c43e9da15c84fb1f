"""Responses in both planes are those of each plane alone."""

import numpy as np
import pytest
from two_planes import pairs, plane, turned

import ropedyn as rd

LINES = np.linspace(5.0, 300.0, 23)
ROPE = rd.Rope(1.35, 0.1, bending_stiffness=(1.54, 0.9))


def seen(length):
    """Points of the plane of y: motion, an end's force, forces inside."""
    return [("y", 0.3 * length), ("gamma", 0.81 * length), ("F_y", 0.5 * length), ("M_gamma", 0.0)]


def test_responses_in_the_plane_of_y_are_those_of_it_alone():
    checked = 0
    for both, own in pairs(31, 12, bends=True):
        length = both.rope.length
        points = seen(length)
        model, alone = both.compile(), own["y"].compile()
        for drive in (("y", 0.63 * length), ("gamma", 0.2 * length)):
            found = model.frf(LINES, drive=drive, response=points)
            right = alone.frf(LINES, drive=turned(drive), response=[turned(p) for p in points])
            wrong = found.rounding_limit + right.rounding_limit
            assert (np.abs(found.value - right.value) <= wrong).all()
            checked += 1
        crossed = model.frf(LINES, drive=("y", 0.63 * length), response=("z", 0.3 * length))
        assert not crossed.value.any()
    assert checked == 24


@pytest.mark.parametrize("solver", ["sweep", "band", "lapack"])
def test_every_solver_takes_both_planes(solver):
    scene = rd.Scene(ROPE, tension=2830.0, damping=rd.StiffnessDamping(1e-5), planes="both")
    drives, responses = [("y", 0.5), ("z", 0.3)], [("y", 0.3), ("z", 0.9), ("gamma", 0.5)]
    found = scene.compile(elements=12).frf(LINES, drive=drives, response=responses, solver=solver)
    assert found.value.shape == (2, 3, len(LINES))
    for k, name in enumerate(("y", "z")):
        own = [r for r in range(3) if (responses[r][0] == "z") == (name == "z")]
        alone = plane(scene, name).compile(elements=12)
        right = alone.frf(
            LINES,
            drive=turned(drives[k]),
            response=[turned(responses[r]) for r in own],
            solver=solver,
        )
        np.testing.assert_array_equal(found.value[k, own], right.value)
        assert not np.delete(found.value[k], own, axis=0).any()


def test_a_moved_end_moves_its_own_plane():
    scene = rd.Scene(ROPE, tension=2830.0, planes="both")
    found = scene.compile().frf(LINES, drive=("end", 0, "y"), response=[("y", 0.4), ("z", 0.4)])
    right = plane(scene, "y").compile().frf(LINES, drive=("end", 0, "z"), response=("z", 0.4))
    np.testing.assert_array_equal(found.value[0], right.value[0])
    assert not found.value[1].any()


def test_derivatives_of_responses_in_the_plane_of_y_are_those_of_it_alone():
    parts = [rd.Resonator(0.3, 0.01, 50.0, plane="y"), rd.PointMass(0.7, 0.01)]
    rope = ROPE.replace(rotary_inertia=(1e-6, 2e-6))
    damping = rd.StiffnessDamping(1e-5)
    scene = rd.Scene(rope, tension=2830.0, parts=parts, damping=damping, planes="both")
    found = scene.compile().frf(LINES, drive=("y", 0.5), response=[("y", 0.3), ("M_gamma", 0.0)])
    alone = plane(scene, "y").compile()
    right = alone.frf(LINES, drive=("z", 0.5), response=[("z", 0.3), ("M_beta", 0.0)])
    for path in ("tension", "linear_density", "parts[0].mass", "parts[1].mass", "damping.gamma"):
        np.testing.assert_allclose(found.derivative(path), right.derivative(path), rtol=1e-12)
    for name in ("bending_stiffness", "rotary_inertia"):
        np.testing.assert_allclose(
            found.derivative(f"{name}[1]"), right.derivative(name), rtol=1e-12
        )
        assert not found.derivative(f"{name}[0]").any()


@pytest.mark.parametrize("elements", [{}, {"elements": 8}])
def test_static_loads_bend_each_plane_alone(elements):
    scene = rd.Scene(ROPE, tension=200.0, ends=(rd.End(gamma="free"), "clamped"), planes="both")
    model = scene.compile(**elements)
    found = model.static({("y", 0.5): 10.0, ("z", 0.5): 3.0})
    for name, load in (("y", {("z", 0.5): 10.0}), ("z", {("z", 0.5): 3.0})):
        right = plane(scene, name).compile(**elements).static(load)
        own = [model.coordinates.index(c) for c in {"y": ("y", "gamma"), "z": ("z", "beta")}[name]]
        np.testing.assert_allclose(found.displacement[:, own], right.displacement, rtol=1e-12)
        np.testing.assert_allclose(found.force[:, own], right.force, rtol=1e-12, atol=1e-12)


def test_matrices_have_the_modes_of_both_planes():
    from scipy.linalg import eigh

    rope = ROPE.replace(rotary_inertia=(1e-6, 2e-6))
    model = rd.Scene(rope, tension=2830.0, planes="both").compile(elements=6)
    value = eigh(
        model.stiffness_matrix().toarray(), model.mass_matrix().toarray(), eigvals_only=True
    )[:6]
    assert np.sqrt(value) / (2 * np.pi) == pytest.approx(model.modes(6).frequency, rel=1e-12)
    assert model.triples.F.shape[1:] == (4, 4)


def test_twist_at_twice_the_frequency_comes_from_either_plane():
    rope = ROPE.replace(
        axial_stiffness=6e5, torsional_stiffness=0.15, lay_coupling=120.0, polar_inertia=1e-7
    )
    ends = ("clamped", rd.End(alpha="free", gamma="free"))
    damping = rd.StiffnessDamping(1e-4)
    scene = rd.Scene(rope, tension=2830.0, ends=ends, damping=damping, planes="both")
    twist = [("alpha", 1.35), ("F_x", 0.0)]
    lines = [20.0, 50.0, 60.0]
    in_y = rope.replace(bending_stiffness=0.9)
    end = rd.End(alpha="free", beta="free")
    turned_scene = scene.without("second plane").replace(rope=in_y, ends=("clamped", end))
    for drive, alone in (("z", scene.without("second plane")), ("y", turned_scene)):
        found = scene.compile().frf(lines, drive=(drive, 0.5), response=twist, harmonic=2)
        right = alone.compile().frf(lines, drive=("z", 0.5), response=twist, harmonic=2)
        wrong = found.rounding_limit + right.rounding_limit
        assert (np.abs(found.value - right.value) <= wrong).all()


def test_families_in_both_planes_are_rows_of_each():
    scene = rd.Scene(ROPE, tension=2830.0, planes="both")
    paths = ["tension", "bending_stiffness[0]", "bending_stiffness[1]", "ends[0].spring.gamma"]
    rows = np.array([[2830.0, 1.5, 0.9, np.inf], [2500.0, 1.0, 2.0, 3.0], [3000.0, 1.0, 1.0, 0.0]])
    family = scene.family(paths)
    modes = family.modes(rows, 6, derivative=True)
    assert modes.certified.all()
    drive, points = ("y", 0.5), [("y", 0.3), ("z", 0.3), ("gamma", 0.9)]
    responses = family.frf(rows, LINES, drive=drive, response=points).value
    for k, (tension, in_z, in_y, spring) in enumerate(rows):
        free = {"gamma": "held" if np.isinf(spring) else "free"}
        springs = {"gamma": spring} if 0 < spring < np.inf else {}
        model = scene.replace(
            tension=tension,
            rope=ROPE.replace(bending_stiffness=(in_z, in_y)),
            ends=(rd.End(**free, spring=springs), "clamped"),
        ).compile()
        right = model.modes(6)
        assert modes.frequency[k] == pytest.approx(right.frequency, rel=1e-13)
        for p in (1, 2):
            change = right.derivative(paths[p])
            np.testing.assert_allclose(modes.derivative[k, :, p], change, rtol=1e-9, atol=1e-12)
        value = model.frf(LINES, drive=drive, response=points).value
        np.testing.assert_allclose(responses[k], value, rtol=1e-10)
