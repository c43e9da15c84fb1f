"""Derivatives of modes of ropes on an axis, and families of them."""

from dataclasses import replace

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.space.model import compile_space

LINE = rd.Scene(
    rd.Rope(
        1.3,
        0.1,
        bending_stiffness=(0.5, 0.4),
        torsional_stiffness=0.3,
        axial_stiffness=1e5,
        polar_inertia=1e-4,
        rotary_inertia=1e-5,
    ),
    tension=100.0,
    parts=[rd.PointMass(0.5, 0.02), rd.Spring(0.8, 50.0)],
    ends=("clamped", rd.End(beta="free", spring={"beta": 2.0})),
    planes="both",
)
STRAIGHT, SAME = LINE.compile().modes(12), compile_space(LINE).modes(12)
ARC = rd.Rope(rd.Axis.arc(1.0, 2.0), 0.5, bending_stiffness=50.0, torsional_stiffness=30.0)
ARCH = rd.Scene(ARC, ends=("pinned", "pinned"), planes="both", tension=120.0)
PATHS = (
    *("tension", "bending_stiffness[0]", "bending_stiffness[1]", "linear_density"),
    *("torsional_stiffness", "polar_inertia", "rotary_inertia", "parts[0].mass"),
    *("parts[1].stiffness", "ends[1].spring.beta", "parts[0].x"),
)


@pytest.mark.claim(
    "Derivatives of 12 frequencies on an axis by 11 numbers, relative to the largest of each",
    reference="those of the straight rope, by the slopes of its chain",
    accepted=1e-12,
)
def test_derivatives_on_a_line_are_those_of_a_straight_rope(claim):
    """Measured: 3e-14."""
    worst = 0.0
    for path in PATHS:
        one, two = STRAIGHT.derivative(path), SAME.derivative(path)
        limit = STRAIGHT.derivative_error(path) + SAME.derivative_error(path)
        assert (np.abs(one - two) <= limit).all()
        assert (SAME.derivative_error(path) <= 1e-11 * np.abs(one).max()).all()
        worst = max(worst, np.abs(one - two).max() / np.abs(one).max())
    claim(worst)


@pytest.mark.parametrize(
    "scene",
    [
        ARCH,
        rd.Scene(
            rd.Rope(
                rd.Axis.helix(0.5, 0.4, 0.9),
                0.8,
                bending_stiffness=40.0,
                torsional_stiffness=25.0,
                axial_stiffness=1e5,
                polar_inertia=3e-3,
            ),
            planes="both",
            tension=100.0,
            torque=1.0,
        ),
    ],
    ids=["arc", "helix"],
)
def test_stiffness_and_inertia_are_of_degree_one(scene):
    """lambda is of degree 1 in all stiffness and loads, of degree -1 in all inertia (Euler)."""
    modes, rope = scene.compile().modes(8), scene.rope
    loads = {"tension": scene.mean_tension}
    names = ("bending_stiffness", "torsional_stiffness", "axial_stiffness")
    loads |= {name: getattr(rope, name) for name in names if getattr(rope, name)}
    inertia = {name: getattr(rope, name) for name in ("linear_density", "polar_inertia")}
    if scene.torque:
        # no path leads to the torque: by differences of the fourth order of frequencies
        h = 1e-2
        steps = np.array([-2, -1, 1, 2]) * h
        by = [scene.replace(torque=1.0 + s).compile().modes(8).eigenvalue for s in steps]
        rest = (by[0] - 8 * by[1] + 8 * by[2] - by[3]) / (12 * h) * scene.torque
    else:
        rest = 0.0
    total = sum(p * modes.derivative(name, of="eigenvalue") for name, p in loads.items()) + rest
    moved = sum(p * modes.derivative(k, of="eigenvalue") for k, p in inertia.items() if p)
    # of differences 1e-9 is left
    assert total == pytest.approx(modes.eigenvalue, rel=1e-8 if scene.torque else 1e-12)
    assert moved == pytest.approx(-modes.eigenvalue, rel=1e-12)


def test_derivatives_where_something_changes_along_the_axis():
    rope = rd.Rope(
        rd.Axis.catenary(10.0, parameter=9.0),
        0.8,
        bending_stiffness=2.0,
        torsional_stiffness=1.0,
    )
    scene = rd.Scene(rope, planes="both", gravity=rd.Gravity())
    modes = scene.compile().modes(4)
    h = 2e-3
    ropes = [rope.replace(bending_stiffness=2.0 + s * h) for s in (-2, -1, 1, 2)]
    by = [scene.replace(rope=one).compile().modes(4).frequency for one in ropes]
    differences = (by[0] - 8 * by[1] + 8 * by[2] - by[3]) / (12 * h)
    found = modes.derivative("bending_stiffness")
    # frequencies are right to 1e-13 of themselves, which differences divide by h
    assert found == pytest.approx(differences, abs=1e-9 * modes.frequency.max())
    with pytest.raises(rd.SceneError, match="tension must be left out"):
        modes.derivative("tension")


def test_a_place_beside_which_a_node_lies_by_rounding_has_its_derivative():
    # 1.8 m is a node, which the lengths of pieces add up to but for rounding
    rope = rd.Rope(rd.Axis.arc(1.0, 2.0), 1.0, bending_stiffness=1.0, torsional_stiffness=1.0)
    masses = [rd.PointMass(x, 0.3) for x in (0.56, 0.65, 1.8)]

    def frequencies(off):
        moved = [*masses[:2], rd.PointMass(1.8 + off, 0.3)]
        return rd.Scene(rope, planes="both", parts=moved).compile().modes(3).frequency

    by = [frequencies(k * 2e-3) for k in (-2, -1, 1, 2)]
    differences = (by[0] - 8 * by[1] + 8 * by[2] - by[3]) / (12 * 2e-3)
    found = rd.Scene(rope, planes="both", parts=masses).compile().modes(3).derivative("parts[2].x")
    assert found == pytest.approx(differences, rel=1e-7)


def test_rigid_motions_do_not_change_with_a_stiffness():
    rope = rd.Rope(rd.Axis.arc(1.0, 2.0), 1.0, bending_stiffness=1.0, torsional_stiffness=1.0)
    model = rd.Scene(rope, planes="both", ends=("free", "free")).compile()
    modes = model.modes(8)
    found = modes.derivative("bending_stiffness") + modes.derivative("torsional_stiffness")
    assert (found[:6] == 0).all()
    # all stiffness is in these two, and frequencies go with its root
    assert found[6:] == pytest.approx(modes.frequency[6:] / 2, rel=1e-11)


def test_modes_that_coincide_part_as_the_straight_rope_has_them():
    rope = rd.Rope(1.0, 0.5, bending_stiffness=(50.0, 50.0), torsional_stiffness=30.0)
    scene = rd.Scene(rope, planes="both", tension=10.0)
    one, two = scene.compile().modes(4), compile_space(scene).modes(4)
    for path in ("tension", "bending_stiffness[0]"):
        # which of a pair comes first is open: nothing ties the planes
        pairs = [np.sort(modes.derivative(path).reshape(2, 2), axis=1) for modes in (one, two)]
        assert pairs[1] == pytest.approx(pairs[0], rel=1e-11, abs=1e-12)


def test_a_carried_wire_has_derivatives_too():
    wire = rd.BrokenWire(0.6, 0.05, 3e-4, radius=2e-3, lay_length=0.03)
    rope = rd.Rope(1.0, 0.3, bending_stiffness=5.0, torsional_stiffness=2.0, polar_inertia=1e-5)
    scene = rd.Scene(rope, tension=500.0, planes="both", parts=[wire])
    modes = scene.compile().modes(3)
    h = 1e-3
    by = [
        scene.replace(parts=[replace(wire, density=wire.density * (1 + s * h))]).compile().modes(3)
        for s in (-2, -1, 1, 2)
    ]
    first, second, third, fourth = (one.eigenvalue for one in by)
    differences = (first - 8 * second + 8 * third - fourth) / (12 * h)
    found = modes.derivative("parts[0].density", of="eigenvalue") * wire.density
    # eigenvalues beside poles of the wire are right to 5e-14 of themselves
    assert found == pytest.approx(differences, abs=1e-9 * modes.eigenvalue.max())


def test_families_on_an_axis_are_their_scenes_one_by_one():
    family = ARCH.family(["tension", "bending_stiffness"])
    rows = [[120.0, 50.0], [300.0, 20.0], [1.0, -1.0]]
    found = family.modes(rows, 4, derivative=True)
    assert list(found.failed) == [2] and not family.closed
    for k, row in enumerate(rows[:2]):
        modes = family.scene_of(row).compile().modes(4)
        assert found.frequency[k] == pytest.approx(modes.frequency, rel=1e-13)
        for j, path in enumerate(family.paths):
            assert found.derivative[k, :, j] == pytest.approx(modes.derivative(path), rel=1e-11)
    assert family.count(rows[:2], below=30.0).tolist() == [
        family.scene_of(row).compile().count(below=30.0) for row in rows[:2]
    ]
    frf = family.frf(rows[:1], [3.0, 9.0], drive=("z", 0.5), response=[("x", 0.7)])
    alone = ARCH.compile().frf([3.0, 9.0], drive=("z", 0.5), response=[("x", 0.7)])
    np.testing.assert_array_equal(frf.value[0], alone.value)


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("length", "length must be that of the axis"),
        ("nonsense", "path must be that of a number of the scene"),
    ],
)
def test_numbers_that_have_no_derivative_are_refused_by_name(path, message):
    with pytest.raises(rd.SceneError, match=message):
        ARCH.compile().modes(2).derivative(path)
    with pytest.raises(rd.SceneError, match="elements must be left out"):
        ARCH.family(["tension"], elements=8)
