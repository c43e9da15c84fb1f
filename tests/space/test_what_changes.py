"""What changes along a rope: tension and curvature of catenaries, turned sections; and torque."""

import math

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.space.compile import rope_of_scene
from ropedyn.space.spectrum import count_below, lowest

REFERENCE = 1e-13
"""Relative: 4e-14 was measured, and the references have 17 digits at least."""

H, WEIGHT = 20000.0, 5 * 9.81
FROM, TO = -60.0, 240.0  # behind the lowest point


def hung(**more):
    """A rope of no bending between held ends, its chord inclined."""
    c = H / WEIGHT
    span = c * (math.asinh(TO / c) - math.asinh(FROM / c))
    axis = rd.Axis.catenary(span, math.hypot(c, TO) - math.hypot(c, FROM), parameter=c)
    rope = rd.Rope(axis, 5.0, axial_stiffness=2e7)
    return rd.Scene(rope, gravity=rd.Gravity(), planes="both", **more)


def test_a_family_of_hanging_ropes_is_each_of_them():
    found = hung().family(["linear_density"]).modes([[4.0], [5.1]], 3)
    for density, frequency in zip((4.0, 5.1), found.frequency):
        one = hung()
        alone = one.replace(rope=one.rope.replace(linear_density=density)).compile().modes(3)
        assert (np.abs(frequency - alone.frequency) <= 2 * alone.rounding_error).all()


def test_a_catenary_in_its_plane_and_out_of_it():
    modes = hung().compile().modes(9)
    inside = ["0.20916067570710418489", "0.30394661710384065205", "0.42760080962127135264"]
    across = [
        "0.10829797125928337197",
        "0.21563228494493322075",
        "0.32318849084815783796",
        "0.43079736635367000145",
        "0.53842706610100373179",
    ]
    for plane, wanted in (("z", inside), ("y", across)):
        found = modes.frequency[modes.plane == plane][: len(wanted)]
        assert found == pytest.approx(np.array(wanted, dtype=float), rel=REFERENCE)
    assert modes.certified and modes.coordinates == ("x", "y", "z")
    off = np.abs(modes.frequency[0] - float(across[0]))
    assert off <= modes.mesh_error[0] + modes.rounding_error[0] + 1e-17
    assert (modes.mesh_error < 1e-12 * modes.frequency).all()


def test_tension_along_a_catenary():
    scene = hung()
    ends = scene.tension_at([0.0, scene.rope.length])
    assert ends == pytest.approx([math.hypot(H, WEIGHT * s) for s in (FROM, TO)], rel=1e-14)
    s = np.linspace(0, scene.rope.length, 4001)
    assert scene.mean_tension == pytest.approx(
        np.trapezoid(scene.tension_at(s), s) / s[-1], rel=1e-8
    )
    assert "own weight" in scene.effects and "tension" in scene.effects
    same = hung(tension=rd.Tension(float(ends[1]), at="end"))
    assert same.compile().modes(1).frequency == scene.compile().modes(1).frequency


@pytest.mark.parametrize(
    ("change", "loads"), [({"bending_stiffness": (1.0, 1.2)}, []), ({}, [(0.5, 1.0)])]
)
def test_a_catenary_that_cannot_be_bent_from_straight_is_as_its_axis(change, loads, tmp_path):
    axis = rd.Axis.catenary(10.0, parameter=10.0, loads=loads)
    options = {"bending_stiffness": 1.0, "torsional_stiffness": 1.0} | change
    rope = rd.Rope(axis, 1.0, **options)
    assert rope.natural == "axis"
    assert rope.replace(linear_density=2.0).natural == "axis"
    with pytest.raises(rd.SceneError, match='natural must be "axis" where'):
        rope.replace(natural="straight")
    scene = rd.Scene(rope, planes="both", parts=[rd.PointMass(*one) for one in _hung(axis, loads)])
    scene.save(tmp_path / "scene.toml")
    assert rd.Scene.load(tmp_path / "scene.toml") == scene


def _hung(axis, loads):
    """Places and masses."""
    return [(axis.length * share, mass) for share, mass in loads]


def test_what_grows_without_bound_is_refused():
    rope = rd.Rope(rd.Axis.arc(1.0, 2.0), 1.0, bending_stiffness=1.0, torsional_stiffness=1.0)
    turned = [rd.Spring(0.5, -20.0, coordinate="alpha")]
    for one in (rope, rope.replace(shear_stiffness=50.0)):
        with pytest.raises(rd.SolveError, match="no lower bound: what is loaded has no mass"):
            rd.Scene(one, planes="both", parts=turned).compile().modes(4)
    heavy = rope.replace(polar_inertia=1e-3)
    assert rd.Scene(heavy, planes="both", parts=turned).compile().modes(1).eigenvalue[0] < 0
    with pytest.raises(rd.SolveError, match=r"below must be at most 1e\+150 Hz"):
        rd.Scene(rope, planes="both").compile().count(below=1e200)


def test_a_stiff_catenary_by_its_responses_and_statics():
    axis = rd.Axis.catenary(30.0, 4.0, parameter=40.0)
    rope = rd.Rope(
        axis, 5.0, axial_stiffness=2e7, bending_stiffness=100.0, torsional_stiffness=80.0
    )
    scene = rd.Scene(rope, gravity=rd.Gravity(), planes="both")
    model, point = scene.compile(), ("z", 10.0)
    assert rope.natural == "straight" and "initial moment" in scene.effects
    modes = model.modes(4)
    frf = model.frf([0.0, 0.4], drive=point)
    static = model.static({point: 1.0}, points=4)
    k = int(np.abs(static.x - 10.0).argmin())
    assert static.displacement[k, 2] == pytest.approx(frf.value[0, 0].real, rel=1e-12)
    assert (frf.mesh_error < 1e-12).all() and static.mesh_error.max() < 1e-12
    middles = (modes.frequency[1:] + modes.frequency[:-1]) / 2
    assert [model.count(below=f) for f in middles] == [1, 2, 3]
    # with so little bending nearly those of a rope without
    limp = rd.Scene(rd.Rope(axis, 5.0, axial_stiffness=2e7), gravity=rd.Gravity(), planes="both")
    assert modes.frequency == pytest.approx(limp.compile().modes(4).frequency, rel=0.05)


def test_reversing_and_cutting_a_catenary_change_nothing():
    axis = rd.Axis.catenary(30.0, 12.0, parameter=15.0)
    rope = rd.Rope(axis, 5.0, axial_stiffness=2e6)
    scene = rd.Scene(rope, gravity=rd.Gravity(), planes="both")
    whole = rope_of_scene(scene)
    wanted = lowest(whole, 6, math.inf).eigenvalue
    back = scene.replace(rope=rd.Rope(axis.reversed(), 5.0, axial_stiffness=2e6))
    # 5e-14 and 2e-14
    assert lowest(rope_of_scene(back), 6, math.inf).eigenvalue == pytest.approx(wanted, rel=1e-12)
    cut, _ = whole.cut(axis.length * np.array([0.1, 0.1234, 0.7]), 1e-9)
    assert len(cut.length) == len(whole.length) + 3
    assert lowest(cut, 6, math.inf).eigenvalue == pytest.approx(wanted, rel=1e-12)
    for value in np.geomspace(1.0, 1e6, 7):
        assert count_below(cut, value) == count_below(whole, value)


def test_a_string_on_an_arc_is_a_straight_one_across_its_plane():
    rope = rd.Rope(rd.Axis.arc(2.0, 1.5), 0.5, axial_stiffness=1e6)
    modes = rd.Scene(rope, tension=300.0, planes="both").compile().modes(6)
    across = modes.frequency[modes.plane == "y"]
    wanted = np.arange(1, len(across) + 1) / (2 * rope.length) * math.sqrt(300.0 / 0.5)
    assert across == pytest.approx(wanted, rel=REFERENCE)


STRIP = rd.Rope(
    1.0, 0.4, bending_stiffness=(200.0, 2.0), principal_angle=([0.0, 1.0], [0.0, 2 * math.pi])
)


def test_a_twisted_strip():
    modes = rd.Scene(STRIP, tension=1000.0, planes="both").compile().modes(4)
    wanted = ["28.762190315609129086", "45.237142872757956197"]
    wanted += ["85.791656999478351307", "106.07801669575184099"]
    assert modes.frequency == pytest.approx(np.array(wanted, dtype=float), rel=REFERENCE)
    assert modes.coordinates == ("y", "z", "beta", "gamma")
    assert (modes.plane == "space").all()


def test_a_section_that_is_turned_everywhere_turns_the_planes():
    pair = rd.Rope(1.0, 0.4, bending_stiffness=(200.0, 2.0))
    wanted = rd.Scene(pair, tension=100.0, planes="both").compile().modes(6).frequency
    turned = pair.replace(principal_angle=0.7)
    found = rd.Scene(turned, tension=100.0, planes="both").compile().modes(6)
    assert found.frequency == pytest.approx(wanted, rel=REFERENCE)
    # the softer plane is that of y, turned from y towards z by the angle
    middle = found.shape[0][np.abs(found.x - 0.5).argmin()]
    assert middle[1] / middle[0] == pytest.approx(math.tan(0.7), rel=1e-9)


def test_greenhill_s_torque_is_critical():
    # tan x = x, M L/B = 2 x between clamped ends
    critical = 8.986818915818128350615762 * 3.0 / 2.0
    rope = rd.Rope(2.0, 0.4, bending_stiffness=3.0, torsional_stiffness=2.0)
    growing = []
    for factor in (1 - 1e-9, 1 + 1e-9):
        scene = rd.Scene(rope, planes="both", torque=factor * critical)
        growing.append((scene.compile().modes(3).growth > 0).sum())
    assert growing == [0, 2]


def test_double_frequencies_of_a_rope_under_torque():
    rope = rd.Rope(2.0, 0.4, bending_stiffness=3.0, torsional_stiffness=2.0)
    scene = rd.Scene(rope, planes="both", torque=2.0, tension=300.0)
    assert "initial moment" in scene.effects
    modes = scene.compile().modes(8)
    pairs = modes.frequency.reshape(-1, 2)
    assert pairs[:, 1] == pytest.approx(pairs[:, 0], rel=1e-13)
    # a torque softens, alike in both directions
    back = scene.replace(torque=-2.0).compile().modes(8).frequency
    assert back == pytest.approx(modes.frequency, rel=1e-13)
    level = scene.without("initial moment")
    assert type(level.compile()) is rd.Model
    assert (modes.frequency < level.compile().modes(8).frequency).all()


def test_a_torque_on_an_arc_needs_a_shear_for_balance():
    # turned about X by half a turn, or seen in a mirror, is the same with the other torque
    rope = rd.Rope(rd.Axis.arc(1.0, 2.0), 0.8, bending_stiffness=40.0, torsional_stiffness=25.0)
    one, other = (
        rd.Scene(rope, planes="both", torque=side * 10.0).compile().modes(6).frequency
        for side in (1, -1)
    )
    assert one == pytest.approx(other, rel=1e-12)
    none = rd.Scene(rope, planes="both").compile().modes(6).frequency
    assert np.abs(one / none - 1).max() > 1e-3


def test_scenes_that_change_along_the_rope_are_kept_in_files(tmp_path):
    scenes = [hung(), rd.Scene(STRIP, tension=10.0, torque=0.5, planes="both")]
    for scene in scenes:
        scene.save(tmp_path / "scene.toml")
        assert rd.Scene.load(tmp_path / "scene.toml") == scene


AXIS = rd.Axis.catenary(3.0, parameter=2.0)
BENT = rd.Rope(AXIS, 0.8, bending_stiffness=4.0, torsional_stiffness=2.0)
STRING = rd.Rope(AXIS, 0.8)
REFUSED = {
    "bending leaves": lambda: rd.Scene(BENT, planes="both", gravity=rd.Gravity()),
    "tension must be left out, or": lambda: hung(tension=1000.0),
    "gravity must have g > 0": lambda: rd.Scene(
        STRING, planes="both", gravity=rd.Gravity(inclination=0.1)
    ),
    "bending_stiffness must be given of a rope on an axis without tension": lambda: rd.Scene(
        STRING, planes="both"
    ),
    "with torsional_stiffness": lambda: rd.Rope(AXIS, 0.8, torsional_stiffness=1.0),
    "torque must be 0 without bending_stiffness": lambda: hung(torque=1.0),
    "torque must be 0 on an axis with corners": lambda: rd.Scene(
        rd.Rope(
            rd.Axis.points([[0, 0, 0], [1, 0, 0], [1, 0, 1]]),
            0.8,
            bending_stiffness=4.0,
            torsional_stiffness=2.0,
        ),
        planes="both",
        torque=1.0,
    ),
    "bending_stiffness must be a pair with a principal_angle": lambda: BENT.replace(
        principal_angle=0.1
    ),
    "principal_angle must be a number, or places": lambda: STRIP.replace(
        principal_angle=([0.0, 0.0], [0.0, 1.0])
    ),
    "principal_angle must lie on the rope": lambda: STRIP.replace(
        principal_angle=([0.0, 9.0], [0.0, 1.0])
    ),
    'planes must be "both" for a rope with torque': lambda: rd.Scene(
        rd.Rope(1.0, 0.4, bending_stiffness=2.0), torque=1.0
    ),
    "rope must be straight for planning": lambda: rd.plan_measurement(
        hung(), modes=2, places=[1.0], std=0.2
    ),
}


@pytest.mark.parametrize("message", REFUSED)
def test_what_is_not_at_rest_or_not_carried_is_refused_by_name(message):
    with pytest.raises(rd.SceneError) as error:
        REFUSED[message]()
    assert message in str(error.value)
