"""What a rope on an axis does not know: where it lies, which end is first, where it is cut."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import ropedyn as rd
from ropedyn.space.compile import rope_of_scene, section_of
from ropedyn.space.pieces import Rest, SpaceSection, rope_of
from ropedyn.space.spectrum import count_below, lowest

SAME = 1e-12
"""Relative; 2e-14 was the most over 364 random polylines, turned and reversed."""

SECTION = {
    "bending_stiffness": 40.0,
    "torsional_stiffness": 25.0,
    "axial_stiffness": 1e6,
    "rotary_inertia": 1e-4,
    "polar_inertia": 2e-4,
}


def frequencies(axis, number=6, ends=("clamped", "clamped"), tension=0.0, **more):
    rope = rd.Rope(axis, 0.8, **SECTION | more)
    scene = rd.Scene(rope, ends=ends, planes="both", tension=tension)
    return scene.compile().modes(number).frequency


def polyline(rng):
    """A few points in space, every other time with rounded corners."""
    points = np.cumsum(rng.normal(size=(rng.integers(3, 6), 3)), axis=0)
    try:
        return points, rd.Axis.points(points, fillet=0.1 if rng.random() < 0.5 else None)
    except rd.SceneError:
        return polyline(rng)


def turned_and_reversed(rng):
    points, axis = polyline(rng)
    fillet = next((1 / p.curvature for p in axis.pieces if p.curvature > 0), None)
    turn = Rotation.random(random_state=int(rng.integers(2**31))).as_matrix()
    return axis, rd.Axis.points(points @ turn.T + rng.normal(size=3), fillet), axis.reversed()


@pytest.mark.parametrize(
    "seed", [*range(8), 1484]
)  # of 1484 the first guesses of a mode are far off
def test_turning_and_reversing_space_polylines_change_nothing(seed):
    axis, turned, back = turned_and_reversed(np.random.default_rng(seed))
    wanted = frequencies(axis)
    assert frequencies(turned) == pytest.approx(wanted, rel=SAME)
    assert frequencies(back) == pytest.approx(wanted, rel=SAME)


@pytest.mark.slow
@pytest.mark.claim(
    "1000 random polylines in space, half with rounded corners: six frequencies as each lies, "
    "turned and seen from its other end, largest relative difference; counts in between right",
    reference="each of them by itself, with pieces, frames and kinks of its own",
    accepted=1e-12,
)
def test_turning_and_reversing_many_space_polylines_change_nothing(claim):
    worst = 0.0
    for seed in range(1000, 2000):
        axis, turned, back = turned_and_reversed(np.random.default_rng(seed))
        wanted = frequencies(axis)
        for other in turned, back:
            worst = max(worst, np.abs(frequencies(other) / wanted - 1).max())
        rope = rd.Rope(back, 0.8, **SECTION)
        model = rd.Scene(rope, planes="both").compile()
        apart = np.flatnonzero(wanted[1:] > wanted[:-1] * (1 + 1e-9))
        for k in apart:
            assert model.count(below=(wanted[k] + wanted[k + 1]) / 2) == k + 1, seed
    claim(worst)


def test_a_corner_of_a_tiny_radius_is_a_sharp_one():
    how = {"bending_stiffness": 40.0, "torsional_stiffness": 25.0, "axial_stiffness": 1e5}
    corner = [[0, 0, 0], [1, 0, 0], [1, 0, 1], [1, 1, 1.5]]
    found = [
        rd.Scene(rd.Rope(rd.Axis.points(corner, fillet=r), 0.8, **how), planes="both")
        .compile()
        .modes(8)
        .frequency
        for r in (None, 1e-7, 1e-9, 1e-11)
    ]
    # the way around a corner is shorter by 0.43 r, of 3 m
    for rounded, least in zip(found[1:], (1e-6, 1e-8, 1e-10)):
        assert rounded == pytest.approx(found[0], rel=least)


@pytest.mark.parametrize("below", [0.0, 1e-12, 1e-8])
def test_a_helix_of_ninety_degrees_is_the_straight_rope(below):
    how = {
        "bending_stiffness": (40.0, 30.0),
        "torsional_stiffness": 25.0,
        "axial_stiffness": 1e5,
        "polar_inertia": 3e-3,
    }
    axis = rd.Axis.helix(0.5, math.pi / 2 - below, length=2.0)
    rest = {"tension": 100.0, "planes": "both"}
    wanted = rd.Scene(rd.Rope(2.0, 0.8, **how), **rest).compile().modes(8).frequency
    found = rd.Scene(rd.Rope(axis, 0.8, **how), **rest).compile().modes(8).frequency
    assert found == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize("tension", [0.0, 300.0, -20.0])
def test_reversing_a_rope_with_a_lay_and_unlike_ends_changes_nothing(tension):
    helix = rd.Axis.helix(0.5, 0.4, 0.7)
    how = {"lay_coupling": 300.0, "tension": tension, "shear_stiffness": 1e5}
    one, other = rd.End(alpha="free", spring={"alpha": 7.0}), rd.End(beta="free", gamma="free")
    assert frequencies(helix, ends=(one, other), **how) == pytest.approx(
        frequencies(helix.reversed(), ends=(other, one), **how), rel=SAME
    )


@pytest.mark.parametrize("natural", ["axis", "straight"])
def test_cutting_an_arc_or_a_helix_changes_nothing(natural):
    # a rope cut where nothing stands
    for axis in rd.Axis.arc(1.0, 2.0), rd.Axis.helix(0.5, 0.4, 1.5, hand="left"):
        rope = rd.Rope(axis, 0.8, natural=natural, **SECTION)
        scene = rd.Scene(rope, planes="both", tension=50.0)
        whole = rope_of_scene(scene)
        cut, _ = whole.cut(axis.length * np.array([0.1, 0.1234, 0.7]), 1e-9)
        assert len(cut.length) == 4
        wanted = lowest(whole, 6, math.inf).eigenvalue
        assert lowest(cut, 6, math.inf).eigenvalue == pytest.approx(wanted, rel=SAME)


def test_cutting_a_polyline_changes_no_count():
    # other pieces are doubled and joined, whose resonances lie elsewhere
    for seed in range(8):
        rng = np.random.default_rng(seed)
        _, axis = polyline(rng)
        whole = rope_of_scene(rd.Scene(rd.Rope(axis, 0.8, **SECTION), planes="both"))
        cut, _ = whole.cut(axis.length * rng.uniform(0, 1, 3), 1e-9)
        for value in np.exp(rng.uniform(np.log(1e2), np.log(1e8), 10)):
            assert count_below(cut, value) == count_below(whole, value)


def test_a_polyline_with_a_point_on_an_arm_is_the_same():
    points = np.array([[0, 0, 0], [1, 0, 0], [1.2, 0.9, 0.4], [0.3, 1.5, 1.0]])
    more = np.insert(points, 2, 0.3 * points[1] + 0.7 * points[2], axis=0)
    wanted = frequencies(rd.Axis.points(points))
    assert frequencies(rd.Axis.points(more)) == pytest.approx(wanted, rel=SAME)


def test_two_kinks_out_of_one_plane_tell_a_rotation_from_its_inverse():
    # a right angle alone does not; mirror images have the same frequencies, others do not
    right = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, 1]]
    mirrored = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [1, 1, -1]]
    flat = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [2, 1, 0]]
    found = [frequencies(rd.Axis.points(points)) for points in (right, mirrored, flat)]
    assert found[1] == pytest.approx(found[0], rel=SAME)
    assert abs(found[2][0] / found[0][0] - 1) > 1e-3


def straight(section, tension=0.0, length=1.35):
    """A straight rope by the pieces of a curved one."""
    rope = rope_of(rd.Axis.line(length), section, Rest(tension))
    rope.held[[0, -1]] = True
    return rope


def test_a_straight_axis_is_the_straight_rope_bit_for_bit():
    scenes = [
        rd.Scene(rd.Rope(length, 0.1017, bending_stiffness=1.54), tension=2830.0, planes=planes)
        for length in (1.35, rd.Axis.line(1.35), rd.Axis.points([[0, 0, 0], [0, 1.35, 0]]))
        for planes in ("z", "both")
    ]
    for scene in scenes:
        assert type(scene.compile()) is rd.Model
        wanted = scenes[0 if scene.planes == "z" else 1]
        assert scene == wanted
        assert (scene.compile().modes(4).frequency == wanted.compile().modes(4).frequency).all()


def test_a_straight_rope_by_six_coordinates_is_that_of_each_by_itself():
    rope = rd.Rope(
        1.35,
        0.1017,
        bending_stiffness=(1.54, 0.9),
        torsional_stiffness=0.1485,
        axial_stiffness=6e5,
        lay_coupling=120.0,
        polar_inertia=1.4e-7,
        rotary_inertia=4.6e-4,
    )
    scene = rd.Scene(rope, tension=2830.0, planes="both")
    wanted = scene.compile().modes(12)
    found = lowest(straight(section_of(scene), 2830.0), 12, math.inf)
    assert np.sqrt(found.eigenvalue) / (2 * math.pi) == pytest.approx(wanted.frequency, rel=1e-12)


def round_section(**more):
    return SpaceSection((1.54, 1.54), 0.1485, 0.1, axial=6e5, polar=1e-7, **more)


def test_double_modes_are_all_found():
    section = round_section()
    found = lowest(straight(section, 2830.0), 12, math.inf)
    pairs = found.eigenvalue.reshape(-1, 2)
    across = np.abs(pairs[:, 1] / pairs[:, 0] - 1) < 1e-13
    assert across.sum() >= 4
    rope = straight(section, 2830.0)
    for value in pairs[across][:, 0]:
        # counts have as many digits as joints near resonances leave them
        below, above = (count_below(rope, value * (1 + side)) for side in (-1e-10, 1e-10))
        assert above - below == 2


@pytest.mark.parametrize("apart", [1e-6, 1e-9, 1e-12])
def test_nearly_double_modes_are_told_apart(apart):
    section = round_section()._replace(bending=(1.54, 1.54 * (1 + apart)))
    found = lowest(straight(section), 4, math.inf).eigenvalue
    # without tension bending is all: lambda as the stiffness
    assert found[1] / found[0] - 1 == pytest.approx(apart, abs=2e-14)


def test_an_arc_of_no_curvature_is_straight():
    length = 1.0
    wanted = lowest(straight(round_section(), length=length), 5, math.inf).eigenvalue
    rope = rope_of(rd.Axis.arc(1e9, length / 1e9), round_section(), Rest())
    rope.held[[0, -1]] = True
    assert lowest(rope, 5, math.inf).eigenvalue == pytest.approx(wanted, rel=1e-9)
    steep = rd.Axis.helix(1.0, math.pi / 2 - 1e-6, length / (2 * math.pi) * 1e-6)
    rope = rope_of(steep, round_section(), Rest())
    rope.held[[0, -1]] = True
    assert lowest(rope, 5, math.inf).eigenvalue == pytest.approx(wanted, rel=1e-5)


def test_counts_and_modes_agree():
    model = rd.Scene(
        rd.Rope(rd.Axis.helix(0.5, 0.4, 1.5), 0.8, **SECTION), planes="both", tension=20.0
    ).compile()
    modes = model.modes(20)
    middles = (modes.frequency[1:] + modes.frequency[:-1]) / 2
    assert [model.count(below=f) for f in middles] == list(range(1, 20))
    assert len(model.modes(below=middles[8]).frequency) == 9
