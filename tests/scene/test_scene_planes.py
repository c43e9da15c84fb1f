"""Scenes in both planes: what they have, what is refused by name, what is left without."""

import dataclasses

import pytest

import ropedyn as rd
from ropedyn.scene.path import unit_of, value_at, with_values

ROPE = rd.Rope(1.2, 0.1, bending_stiffness=(1.5, 0.9), rotary_inertia=(1e-6, 0.0))
PLAIN = rd.Rope(1.2, 0.1, bending_stiffness=1.5)


def in_both(**changes):
    return rd.Scene(**({"rope": ROPE, "tension": 250.0, "planes": "both"} | changes))


def test_coordinates_stand_in_their_fixed_order():
    rope = ROPE.replace(axial_stiffness=1e5, torsional_stiffness=0.1)
    assert in_both(rope=rope).coordinates == ("x", "y", "z", "alpha", "beta", "gamma")
    assert in_both(rope=rd.Rope(1.2, 0.1)).coordinates == ("y", "z")
    twist = in_both(rope=rd.Rope(1.0, 0.1, torsional_stiffness=1.0), tension=0.0)
    assert twist.coordinates == ("alpha",)


def test_planes_stay_apart():
    rope = ROPE.replace(axial_stiffness=1e5, torsional_stiffness=0.1, lay_coupling=20.0)
    model = in_both(rope=rope.replace(lay_slope=0.2)).compile()
    assert model.components == (("x", "z", "alpha", "beta"), ("y", "gamma"))


def test_a_scene_in_one_plane_has_no_second_one():
    scene = rd.Scene(PLAIN, tension=250.0)
    assert scene.planes == "z"
    assert "second plane" not in scene.effects
    assert scene.without("second plane") == scene
    assert scene.compile().chain.flexibility.shape[1:] == (3, 3)


def test_without_the_second_plane_nothing_of_it_is_left():
    kept = [rd.Spring(0.5, 10.0), rd.PointMass(0.4, 0.1), rd.Hinge(0.6)]
    gone = [
        rd.Spring(0.5, 10.0, coordinate="y"),
        rd.Support(0.3, coordinate="gamma"),
        rd.Hinge(0.6, plane="y"),
        rd.Resonator(0.7, 0.1, 20.0, plane="y"),
    ]
    ends = (rd.End(beta="free", gamma="free", spring={"beta": 1.0, "gamma": 2.0}), "clamped")
    change = rd.LocalChange(0.1, 0.2, bending=(0.5, 0.7))
    both = in_both(parts=[*kept, *gone, change], ends=ends)
    assert "second plane" in both.effects
    left = both.without("second plane")
    assert left.parts == (*kept, rd.LocalChange(0.1, 0.2, bending=0.5))
    assert left.rope == PLAIN.replace(rotary_inertia=1e-6)
    assert left.ends[0].spring == {"beta": 1.0}
    assert left.planes == "z"


ACROSS = {
    "spring": lambda: rd.Scene(PLAIN, parts=[rd.Spring(0.5, 1.0, coordinate="y")]),
    "support": lambda: rd.Scene(PLAIN, parts=[rd.Support(0.5, coordinate="gamma")]),
    "hinge": lambda: rd.Scene(PLAIN, parts=[rd.Hinge(0.5, plane="y")]),
    "resonator": lambda: rd.Scene(PLAIN, parts=[rd.Resonator(0.5, 1.0, 9.0, plane="y")]),
    "end": lambda: rd.Scene(PLAIN, ends=(rd.End(y="free", spring={"y": 1.0}), "clamped")),
    "pair": lambda: rd.Scene(ROPE),
    "change": lambda: rd.Scene(PLAIN, parts=[rd.LocalChange(0.1, 0.2, bending=(1.0, 2.0))]),
    "drive": lambda: rd.Scene(PLAIN).compile().frf([1.0], drive=("y", 0.5)),
    "end drive": lambda: (
        rd.Scene(PLAIN).compile().frf([1.0], drive=("end", 0, "y"), response=("z", 0.5))
    ),
    "response": lambda: (
        rd.Scene(PLAIN).compile().frf([1.0], drive=("z", 0.5), response=("M_gamma", 0.5))
    ),
    "load": lambda: rd.Scene(PLAIN).compile().static({("gamma", 0.5): 1.0}),
    "start": lambda: (
        rd.Scene(PLAIN).compile().transient([0.0, 0.1], start={"y": abs}, response=("z", 0.5))
    ),
    "path": lambda: rd.Scene(PLAIN).family(["ends[0].spring.gamma"]),
}


@pytest.mark.parametrize("case", ACROSS)
def test_what_needs_the_second_plane_says_so(case):
    with pytest.raises(rd.SceneError, match="planes"):
        ACROSS[case]()


def test_a_wire_beside_the_axis_ties_twist_to_both_planes():
    twists = ROPE.replace(torsional_stiffness=1.0, polar_inertia=1e-6)
    wire = rd.BrokenWire(0.5, 0.05, 3e-4, radius=2e-3, angle=0.3)
    with pytest.raises(rd.SceneError, match=r"parts\[0\].angle must be 0 .* got 0.3"):
        in_both(rope=twists, parts=[wire])
    assert "broken wire" in in_both(parts=[wire]).effects
    assert (
        "broken wire" in in_both(rope=twists, parts=[dataclasses.replace(wire, angle=0.0)]).effects
    )


@pytest.mark.parametrize("planes", ["y", "Z", "", "all"])
def test_other_planes_are_refused(planes):
    with pytest.raises(rd.SceneError, match='planes must be one of "z", "both"'):
        in_both(planes=planes)


def test_pairs_are_checked_number_by_number():
    with pytest.raises(rd.SceneError, match=r"bending_stiffness\[1\] must be a finite number > 0"):
        rd.Rope(1.0, 0.1, bending_stiffness=(1.0, 0.0))
    with pytest.raises(TypeError, match="bending_stiffness must be a number or a pair"):
        rd.Rope(1.0, 0.1, bending_stiffness=(1.0, 2.0, 3.0))
    with pytest.raises(TypeError, match=r"rotary_inertia\[0\] must be a finite number"):
        rd.Rope(1.0, 0.1, rotary_inertia=("1", 2.0))


def test_ends_are_given_by_name():
    with pytest.raises(TypeError, match="positional"):
        rd.End("free")


@pytest.mark.parametrize("word", ["clamped", "pinned", "free"])
def test_words_mean_the_same_in_both_planes(word):
    held = set(rd.Scene(PLAIN, ends=(word, "clamped")).compile().chain.held[0].tolist())
    model = in_both(ends=(word, "clamped")).compile()
    row = dict(zip(model.coordinates, model.chain.held[0].tolist()))
    assert (row["y"], row["gamma"]) == (row["z"], row["beta"])
    assert {row["z"], row["beta"]} == held


def test_a_point_mass_acts_in_both_planes():
    model = in_both(parts=[rd.PointMass(0.5, 0.2, rotary_inertia=0.01)]).compile()
    diagonal = model.chain.mass[1].diagonal()
    assert dict(zip(model.coordinates, diagonal.tolist())) == {
        "y": 0.2,
        "z": 0.2,
        "beta": 0.01,
        "gamma": 0.01,
    }


PATHS = {
    "bending_stiffness[0]": 1.5,
    "bending_stiffness[1]": 0.9,
    "rotary_inertia[1]": 0.0,
    "parts[0].bending[1]": 0.7,
    "ends[0].spring.gamma": 2.0,
}


def with_paths():
    ends = (rd.End(gamma="free", spring={"gamma": 2.0}), "clamped")
    return in_both(parts=[rd.LocalChange(0.1, 0.2, bending=(0.5, 0.7))], ends=ends)


@pytest.mark.parametrize("path", PATHS)
def test_a_number_of_a_pair_has_a_path(path):
    scene = with_paths()
    assert value_at(scene, path) == PATHS[path]
    changed = with_values(scene, {path: 3.0})
    assert value_at(changed, path) == 3.0
    for other in PATHS.keys() - {path}:
        assert value_at(changed, other) == PATHS[other]


def test_both_numbers_of_a_pair_are_changed_together():
    changed = with_values(with_paths(), {"bending_stiffness[1]": 4.0, "bending_stiffness[0]": 3.0})
    assert changed.rope.bending_stiffness == (3.0, 4.0)
    assert unit_of("bending_stiffness[1]") == "N m^2"


def test_paths_say_whether_there_is_a_pair():
    with pytest.raises(rd.SceneError, match=r"there is one number, 1\.5"):
        value_at(rd.Scene(PLAIN), "bending_stiffness[0]")
    with pytest.raises(rd.SceneError, match=r"there is \(1\.5, 0\.9\)"):
        value_at(with_paths(), "bending_stiffness")


def test_a_scene_in_both_planes_survives_the_file(tmp_path):
    scene = with_paths()
    scene.save(tmp_path / "rope.toml")
    assert rd.Scene.load(tmp_path / "rope.toml") == scene
    assert 'planes = "both"' in (tmp_path / "rope.toml").read_text()


def test_peaks_do_not_say_their_plane():
    scene = in_both()
    peaks = rd.Peaks(scene.compile().modes(4).frequency)
    with pytest.raises(rd.SceneError, match='planes must be "z" of peaks'):
        rd.identify(scene, peaks, ["tension"])
