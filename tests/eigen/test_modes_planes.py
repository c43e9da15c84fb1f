"""Modes in both planes: a clevis against many digits, scenes against their planes one by one."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from two_planes import pairs, plane

import ropedyn as rd

REFERENCE = Path(__file__).parent.parent / "reference" / "clevis.json"
CLEVIS = json.loads(REFERENCE.read_text())["clevis"]
ROPE = rd.Rope(1.35, 0.13725 / 1.35, bending_stiffness=(1.54, 0.9))
PINNED_IN_Y = rd.End(gamma="free")
ENDS = {
    "y_clamped_pinned_Hz": (PINNED_IN_Y, "clamped"),
    "y_pinned_pinned_Hz": (PINNED_IN_Y, PINNED_IN_Y),
}


def clevis(ends):
    return rd.Scene(ROPE, tension=2830.0, ends=ends, planes="both")


def exact(name):
    return np.array([float(f) for f in CLEVIS[name]])


@pytest.mark.parametrize("name", ENDS)
@pytest.mark.claim(
    "a stay in its clevis, clamped in one plane and pinned in the other: relative error of ten "
    "frequencies",
    reference="roots of the characteristic determinants in 24 digits: tests/reference/clevis.json",
    accepted=1e-14,
)
def test_a_clevis_has_the_frequencies_of_each_of_its_planes(name, claim):
    modes = clevis(ENDS[name]).compile().modes(10)
    assert modes.certified
    wrong = [
        np.abs(modes.frequency[modes.plane == of] / exact(reference) - 1).max()
        for of, reference in (("z", "z_clamped_clamped_Hz"), ("y", name))
    ]
    claim(max(wrong))


def check_scene(both, own, number=10, **elements):
    """Modes in both planes are those of the planes, each within both bounds; counts agree."""
    modes = both.compile(**elements).modes(number)
    assert modes.certified
    assert set(modes.plane.tolist()) <= {"z", "y"}
    for name, scene in own.items():
        mine = modes.plane == name
        if not mine.any():
            continue
        alone = scene.compile(**elements).modes(int(mine.sum()))
        apart = np.abs(modes.frequency[mine] - alone.frequency)
        assert (apart <= modes.rounding_error[mine] + alone.rounding_error).all()
    limit = float(modes.frequency[-1]) * 1.001
    if limit > 0:
        counts = [scene.compile(**elements).count(below=limit) for scene in own.values()]
        assert both.compile(**elements).count(below=limit) == sum(counts)


@pytest.mark.parametrize("elements", [{}, {"elements": 12}])
def test_both_planes_have_the_modes_of_each_alone(elements):
    for both, own in pairs(2, 8):
        if elements:  # the same mesh in both: nothing stands in one plane alone
            bare = both.replace(parts=[])
            check_scene(bare, {name: plane(bare, name) for name in own}, **elements)
        else:
            check_scene(both, own)


@pytest.mark.slow
@pytest.mark.claim(
    "2000 random scenes in both planes against two scenes in one: frequencies outside both bounds, "
    "counts that differ, modes without a certificate",
    reference="the planes one by one",
    accepted=0.0,
)
def test_very_many_random_scenes_have_the_modes_of_their_planes(claim):
    wrong = 0
    for both, own in pairs(20_000, 2000):
        try:
            check_scene(both, own)
        except AssertionError:
            wrong += 1
    claim(wrong)


@pytest.mark.parametrize("apart", [0.0, 1e-14, 1e-9])
@pytest.mark.parametrize("elements", [{}, {"elements": 16}])
def test_double_frequencies_of_a_round_rope_are_both_found_and_certified(apart, elements):
    rope = rd.Rope(2.0, 0.3, bending_stiffness=(2.0, 2.0 * (1 + apart)))
    parts = [rd.PointMass(0.7, 0.05, rotary_inertia=1e-5)]
    scene = rd.Scene(rope, tension=900.0, parts=parts, planes="both")
    modes = scene.compile(**elements).modes(10)
    alone = scene.without("second plane").compile(**elements).modes(5)
    assert modes.certified
    for name in ("z", "y"):
        mine = modes.frequency[modes.plane == name]
        # f grows by at most half of what B does
        assert mine == pytest.approx(alone.frequency, rel=apart / 2 + 1e-14)
    np.testing.assert_array_equal(np.sort(modes.plane[:2]), ["y", "z"])
    # each moves in its own plane alone
    y, z = (modes.coordinates.index(c) for c in ("y", "z"))
    across = np.where(modes.plane == "z", y, z)
    assert not modes.shape[np.arange(10), :, across].any()


def test_a_string_in_both_planes_has_each_frequency_twice():
    scene = rd.Scene(rd.Rope(2.0, 0.1), tension=1000.0, planes="both")
    modes = scene.compile().modes(6)
    assert modes.frequency == pytest.approx(np.repeat([25.0, 50.0, 75.0], 2), rel=1e-15)
    assert modes.family.tolist() == ["transverse"] * 6
    assert modes.certified
    assert scene.compile().count(below=76.0) == 6


def test_modes_say_their_plane():
    rope = ROPE.replace(torsional_stiffness=0.15, polar_inertia=1e-7, axial_stiffness=1e6)
    modes = rd.Scene(rope, tension=2830.0, planes="both").compile().modes(40)
    assert set(zip(modes.family.tolist(), modes.plane.tolist())) == {
        ("transverse", "z"),
        ("transverse", "y"),
        ("torsional", ""),
        ("axial", ""),
    }
    one = rd.Scene(rope.replace(bending_stiffness=1.54), tension=2830.0).compile().modes(20)
    assert set(one.plane.tolist()) == {"z", ""}


def every_part():
    """A scene with something of each kind in the plane of y, damped."""
    parts = [
        rd.Resonator(0.4, 1e-3, 70.0, damping_ratio=0.02, plane="y"),
        rd.Resonator(0.5, 1e-3, 90.0),
        rd.Spring(0.6, 1e3, coordinate="y"),
        rd.Dashpot(0.7, 2.0, coordinate="y"),
        rd.PointMass(0.2, 0.01, rotary_inertia=1e-6),
        rd.LocalChange(0.1, 0.25, bending=(0.5, 0.8), density=1.1),
        rd.Hinge(0.9, stiffness=3.0, plane="y"),
        rd.AddedMass(0.3, 0.5, 0.01),
    ]
    rope = ROPE.replace(rotary_inertia=(1e-6, 3e-6))
    ends = (PINNED_IN_Y, rd.End(gamma="free", spring={"gamma": 4.0}))
    damping = (rd.StiffnessDamping(1e-5), rd.ViscousDamping(0.4))
    return rd.Scene(rope, tension=2830.0, ends=ends, parts=parts, damping=damping, planes="both")


# the parts of the plane of y have other numbers where it stands alone
PATHS = {
    "tension": "tension",
    "length": "length",
    "linear_density": "linear_density",
    "bending_stiffness[1]": "bending_stiffness",
    "rotary_inertia[1]": "rotary_inertia",
    "parts[0].mass": "parts[0].mass",
    "parts[2].stiffness": "parts[1].stiffness",
    "parts[4].rotary_inertia": "parts[3].rotary_inertia",
    "parts[5].bending[1]": "parts[4].bending",
    "parts[5].density": "parts[4].density",
    "parts[6].stiffness": "parts[5].stiffness",
    "ends[1].spring.gamma": "ends[1].spring.beta",
}


@pytest.fixture(scope="module")
def across():
    """Ten modes in the plane of y, of both planes and of that alone."""
    both = every_part()
    modes = both.compile().modes(20)
    return modes, plane(both, "y").compile().modes(10), np.flatnonzero(modes.plane == "y")[:9]


@pytest.mark.parametrize("path", PATHS)
def test_derivatives_in_the_plane_of_y_are_those_of_it_alone(path, across):
    modes, alone, mine = across
    found, right = modes.derivative(path)[mine], alone.derivative(PATHS[path])[: len(mine)]
    wrong = modes.derivative_error(path)[mine] + alone.derivative_error(PATHS[path])[: len(mine)]
    assert (np.abs(found - right) <= wrong).all()
    assert np.abs(found - right).max() <= 1e-10 * np.abs(right).max()


def test_a_number_of_one_plane_changes_no_mode_of_the_other(across):
    modes, _, _ = across
    for path, other in (("bending_stiffness[0]", "y"), ("bending_stiffness[1]", "z")):
        change = modes.derivative(path)
        assert not change[modes.plane == other].any()
        assert (change[modes.plane != other] > 0).all()


@pytest.mark.parametrize("elements", [{}, {"elements": 16}])
def test_double_modes_have_the_derivatives_of_their_planes(elements):
    scene = clevis(("clamped", "clamped")).replace(rope=ROPE.replace(bending_stiffness=(1.2, 1.2)))
    modes = scene.compile(**elements).modes(6)
    alone = scene.without("second plane").compile(**elements).modes(3)
    right = alone.derivative("bending_stiffness")
    for k, name in enumerate(("z", "y")):
        change = modes.derivative(f"bending_stiffness[{k}]")
        assert change[modes.plane == name] == pytest.approx(right, rel=1e-11)
        assert not change[modes.plane != name].any()


def test_a_stiffness_of_both_planes_changes_both():
    scene = rd.Scene(ROPE.replace(bending_stiffness=1.2), tension=2830.0, planes="both")
    modes = scene.compile().modes(6)
    alone = scene.without("second plane").compile().modes(3).derivative("bending_stiffness")
    assert modes.derivative("bending_stiffness") == pytest.approx(np.repeat(alone, 2), rel=1e-12)


def test_shapes_energies_and_losses_in_the_plane_of_y_are_those_of_it_alone(across):
    modes, alone, mine = across
    few = slice(len(mine))
    # of the sums that energies are: a few hundred times eps, as one plane has between two meshes
    assert modes.modal_mass[mine] == pytest.approx(alone.modal_mass[few], rel=1e-11)
    assert modes.damping_ratio[mine] == pytest.approx(alone.damping_ratio[few], rel=1e-11)
    names = {"y": "z", "gamma": "beta"}
    for name in ("bending", "tension", "spring", "y", "gamma", "resonator", "resonator mass"):
        right = alone.energy[names.get(name, name)][few]
        np.testing.assert_allclose(modes.energy[name][mine], right, atol=1e-11)
    assert not any(modes.energy[name][mine].any() for name in ("z", "beta"))


def test_damage_in_the_plane_of_y_is_that_of_it_alone(across):
    modes, alone, mine = across
    own, right = modes.damage(points=8), alone.damage(points=8)
    both = every_part()
    stations = {x for part in both.parts for x in (getattr(part, "x", None),) if x is not None}
    assert stations  # parts in z alone cut spans of both planes: compared over the whole rope
    for name in ("bending_stiffness", "linear_density", "rotary_inertia"):
        whole = [
            np.einsum("kp,p->k", d.change[name][k], np.diff(d.edge))
            for d, k in ((own, mine), (right, slice(len(mine))))
        ]
        assert whole[0] == pytest.approx(whole[1], rel=1e-9)


def test_damped_modes_in_both_planes_are_those_of_each_alone():
    both = every_part()
    modes = both.compile().modes(8, damped=True)
    assert modes.certified
    for name in ("z", "y"):
        mine = modes.plane == name
        alone = plane(both, name).compile().modes(int(mine.sum()), damped=True)
        wrong = 2 * math.pi * (modes.rounding_error[mine] + alone.rounding_error)
        assert (np.abs(modes.eigenvalue[mine] - alone.eigenvalue) <= wrong).all()


def test_the_assembled_solver_takes_both_planes():
    model = clevis(ENDS["y_clamped_pinned_Hz"]).compile(elements=24)
    swept, assembled = model.modes(8), model.modes(8, solver="lapack")
    apart = np.abs(swept.frequency - assembled.frequency)
    assert (apart <= swept.rounding_error + assembled.rounding_error).all()


def test_chains_in_both_planes_have_the_mesh_errors_of_each_alone():
    scene = clevis(ENDS["y_clamped_pinned_Hz"])
    modes = scene.compile(elements=8).modes(8)
    for name in ("z", "y"):
        alone = plane(scene, name).compile(elements=8).modes(4)
        assert modes.mesh_error[modes.plane == name] == pytest.approx(alone.mesh_error, rel=1e-6)
    chosen = scene.compile(tolerance=1e-4, below=300.0)
    own = chosen.modes(below=300.0)
    assert (own.mesh_error <= 1e-4 * own.frequency).all()


@pytest.mark.parametrize("element", ["rigid", "difference"])
def test_elements_of_one_plane_say_so(element):
    scene = clevis(("clamped", "clamped")).replace(tension=0.0)
    with pytest.raises(rd.SceneError, match=r'element must be "continuous" or "tensed" .* planes'):
        scene.compile(elements=4, element=element)


def test_sag_acts_in_the_plane_of_z_alone():
    rope = rd.Rope(50.0, 2.0, bending_stiffness=5.0, axial_stiffness=1e6)
    scene = rd.Scene(rope, tension=2e4, gravity=rd.Gravity(), planes="both")
    modes = scene.compile().modes(6)
    sagging = scene.without("second plane").compile().modes(3).frequency
    straight = scene.without("second plane", "sag").compile().modes(3).frequency
    assert modes.frequency[modes.plane == "z"] == pytest.approx(sagging, rel=1e-14)
    assert modes.frequency[modes.plane == "y"] == pytest.approx(straight, rel=1e-14)
    assert modes.frequency[modes.plane == "z"][0] > modes.frequency[modes.plane == "y"][0]


def test_modes_in_both_planes_are_read_from_a_file(tmp_path):
    modes = clevis(ENDS["y_clamped_pinned_Hz"]).compile().modes(4)
    modes.save(tmp_path / "modes.nc")
    assert rd.load(tmp_path / "modes.nc").plane.tolist() == modes.plane.tolist()
