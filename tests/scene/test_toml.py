"""Scenes as TOML files: nothing is lost on the way, bad files are refused by the key."""

import math
import os
import stat
import tomllib
import warnings

import pytest
import tomli_w
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import ropedyn as rd
from ropedyn.scene.parts import part
from ropedyn.scene.scene import EFFECTS

PARTS = [kind.__name__ for kind in part.KINDS]
LENGTH = 1.5
DOCUMENT = {
    "tension": 300.0,
    "ends": ["clamped", {"x": "free", "beta": "free", "spring": {"beta": 12.0}}],
    "damping": [{"kind": "StiffnessDamping", "gamma": 1e-4}],
    "rope": {"length": LENGTH, "linear_density": 0.1, "bending_stiffness": 1.5},
    "parts": [
        {"kind": "PointMass", "x": 0.5, "mass": 0.1},
        {"kind": "Spring", "x": 0.7, "stiffness": 1e4, "coordinate": "z"},
        {"kind": "Support", "x": 0.9},
    ],
}
SCENE = rd.Scene(
    rd.Rope(LENGTH, 0.1, bending_stiffness=1.5),
    tension=300.0,
    ends=("clamped", rd.End(x="free", beta="free", spring={"beta": 12.0})),
    damping=(rd.StiffnessDamping(1e-4),),
    parts=(rd.PointMass(0.5, 0.1), rd.Spring(0.7, 1e4), rd.Support(0.9)),
)

anything = st.floats(allow_nan=False, allow_infinity=False)
positive = st.floats(min_value=0, exclude_min=True, allow_infinity=False)
at_least_zero = st.floats(min_value=0, allow_infinity=False)
other_than_zero = anything.filter(bool)
places = st.floats(min_value=0, max_value=LENGTH)
words = st.sampled_from(["held", "free"])


@st.composite
def ropes(draw):
    """Draw a rope with every stiffness, so that every coordinate is there, and any lay."""
    stiff = st.floats(min_value=1e-3, max_value=1e9)
    return rd.Rope(
        LENGTH,
        draw(positive),
        bending_stiffness=draw(positive),
        torsional_stiffness=draw(stiff),
        axial_stiffness=draw(stiff),
        lay_coupling=draw(st.none() | st.floats(min_value=-1e-3, max_value=1e-3, exclude_max=True)),
        lay_slope=draw(st.none() | anything),
        rotary_inertia=draw(st.none() | at_least_zero),
        polar_inertia=draw(st.none() | at_least_zero),
    )


@st.composite
def ends(draw):
    if draw(st.booleans()):
        return draw(st.sampled_from(["clamped", "pinned", "free"]))
    words_of = {c: draw(words) for c in ("x", "z", "alpha", "beta")}
    free = [c for c, word in words_of.items() if word == "free"]
    values = {"spring": other_than_zero, "dashpot": positive, "mass": at_least_zero}
    standing = {
        name: {c: draw(value) for c in free if draw(st.booleans())}
        for name, value in values.items()
    }
    return rd.End(**words_of, **standing)


tensions = st.builds(
    rd.Tension, anything, amplitude=at_least_zero, frequency=positive, phase=anything
)
coordinates = st.sampled_from(["x", "z", "alpha", "beta"])
parts = st.one_of(
    st.builds(
        rd.PointMass,
        places,
        at_least_zero,
        rotary_inertia=at_least_zero,
        polar_inertia=at_least_zero,
    ),
    st.builds(rd.Spring, places, other_than_zero, coordinate=coordinates),
    st.builds(rd.Dashpot, places, positive, coordinate=coordinates, exponent=positive),
    st.builds(rd.Support, places, coordinate=coordinates),
    st.builds(rd.AddedMass, st.just(0.0), st.just(LENGTH), st.floats(0.0, 1e50)),
    st.builds(rd.LocalChange, st.just(0.0), st.just(LENGTH), torsion=st.just(2.0)),
)
dampings = st.one_of(
    st.builds(rd.StiffnessDamping, at_least_zero),
    st.builds(rd.RayleighDamping, at_least_zero, at_least_zero),
    st.builds(rd.LossFactor, at_least_zero),
    st.builds(rd.ViscousDamping, at_least_zero),
    st.builds(rd.ModalDamping, at_least_zero | st.lists(at_least_zero, min_size=1, max_size=4)),
)
RUBBING = rd.WireFriction([0.3, 0.2], [0.1, 0.0])


@st.composite
def scenes(draw):
    # where lay_coupling is 1e-3 and both stiffnesses too, the section is singular
    try:
        rope = draw(ropes())
    except rd.SceneError:
        rope = rd.Rope(LENGTH, 1.0, bending_stiffness=1.0, torsional_stiffness=1.0)
        rope = rope.replace(axial_stiffness=1.0)
    return rd.Scene(
        rope,
        tension=draw(anything | tensions),
        ends=(draw(ends()), draw(ends())),
        damping=draw(st.none() | dampings | st.lists(dampings, max_size=3)),
        parts=draw(st.lists(parts, max_size=4)),
    )


@settings(
    max_examples=80, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(scene=scenes())
def test_scene_survives_its_file_exactly(scene, tmp_path):
    path = tmp_path / "rope.toml"
    scene.save(path)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", rd.UnitWarning)  # of numbers as they are drawn
        loaded = rd.Scene.load(path)
    assert loaded == scene
    assert hash(loaded) == hash(scene)


@pytest.mark.parametrize("count", [0, 1, 2, 3])
def test_a_sum_of_dampings_survives_its_file(count, tmp_path):
    dampings = tuple(rd.StiffnessDamping(k * 1e-4) for k in range(count))
    scene = SCENE.replace(damping=dampings)
    scene.save(tmp_path / "rope.toml")
    assert rd.Scene.load(tmp_path / "rope.toml") == scene


def every_effect_but_a_law():
    """Return the scenes that together have every effect which a file can hold."""
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0, torsional_stiffness=2.0, axial_stiffness=3.0)
    rope = rope.replace(lay_slope=0.1, lay_coupling=0.1, rotary_inertia=1e-5, polar_inertia=1e-6)
    sagging = rd.Scene(
        rope,
        tension=rd.Tension(1.0, amplitude=0.5, frequency=20.0, phase=0.3),
        damping=(
            rd.StiffnessDamping(1e-4),
            rd.RayleighDamping(0.1, 1e-5),
            rd.LossFactor(0.02),
            rd.ViscousDamping(0.4),
            rd.ModalDamping([0.01, 0.02]),
        ),
        parts=[
            rd.PointMass(0.2, 0.1),
            rd.Spring(0.3, 5.0),
            rd.Dashpot(0.7, 2.0),
            rd.Support(0.4),
            rd.Hinge(0.6),
            rd.Resonator(0.7, 0.01, 20.0, damping_ratio=0.02),
            rd.BrokenWire(0.8, 0.05, 3e-4, radius=2e-3),
            rd.Stop(0.9, 1e5, gap=1e-3, side=-1),
            rd.AddedMass(0.1, 0.7, 0.02, polar_inertia=1e-6),
            rd.LocalChange(0.5, 0.9, bending=0.5, torsion=0.7, density=0.9),
        ],
        gravity=rd.Gravity(1.62, inclination=-0.2, own_weight=False),
    )
    # a rope that sags cannot stretch with the amplitude
    stretching = rd.Scene(rope, tension=rd.Tension(1.0, stretching=True))
    upright = rd.Scene(
        rd.Rope(1.0, 0.1),
        tension=rd.Tension(7.0, at="end"),
        gravity=rd.Gravity(inclination=-math.pi / 2),
    )
    plain = {"rope": rope.replace(bending_stiffness=(1.0, 2.0)), "parts": (), "planes": "both"}
    spring = rd.Rope(
        rd.Axis.helix(0.5, 0.3, 2.0, hand="left").reversed(),
        0.1,
        bending_stiffness=1.0,
        torsional_stiffness=2.0,
        shear_stiffness=1e4,
        natural="straight",
    )
    curved = rd.Scene(spring, planes="both")
    rubbing = rd.Scene(rd.Rope(1.0, 0.1, bending_stiffness=1.0), tension=9.0, damping=RUBBING)
    strip = rd.Rope(1.0, 0.1, bending_stiffness=(1.0, 2.0), principal_angle=0.3)
    twisted = rd.Scene(strip, planes="both", torque=0.1)
    return sagging, stretching, upright, sagging.replace(**plain), curved, rubbing, twisted


@pytest.mark.parametrize("effect", [e for e in EFFECTS if e != rd.NodeForce.kind])
def test_every_effect_survives_the_file(effect, tmp_path):
    whole = next(scene for scene in every_effect_but_a_law() if effect in scene.effects)
    path = tmp_path / "rope.toml"
    for scene in (whole, whole.without(effect)):
        scene.save(path)
        assert rd.Scene.load(path) == scene
    assert whole.without(effect) != whole


def test_a_law_cannot_be_written(tmp_path):
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=1.0, parts=[rd.NodeForce(0.5, min)])
    with pytest.raises(rd.SceneError, match=r"parts\[0\].law cannot be written to a file"):
        scene.save(tmp_path / "rope.toml")
    assert list(tmp_path.iterdir()) == []


def write(path, document):
    path.write_text(tomli_w.dumps(document), encoding="utf-8")
    return path


def changed(*keys, value=None, drop=False):
    """Return the document with one entry put, replaced or dropped."""
    document = tomllib.loads(tomli_w.dumps(DOCUMENT))
    place = document
    for key in keys[:-1]:
        place = place[key]
    if drop:
        del place[keys[-1]]
    else:
        place[keys[-1]] = value
    return document


def test_written_by_hand_is_the_scene(tmp_path):
    assert rd.Scene.load(write(tmp_path / "rope.toml", DOCUMENT)) == SCENE


def test_a_single_damping_may_be_a_table(tmp_path):
    document = changed("damping", value=DOCUMENT["damping"][0])
    scene = SCENE.replace(damping=rd.StiffnessDamping(1e-4))
    assert rd.Scene.load(write(tmp_path / "rope.toml", document)) == scene


def test_a_table_of_a_steady_tension_is_its_mean(tmp_path):
    document = changed("tension", value={"mean": 300.0})
    assert rd.Scene.load(write(tmp_path / "rope.toml", document)) == SCENE


def test_a_rope_alone_is_a_file(tmp_path):
    path = write(tmp_path / "rope.toml", {"rope": DOCUMENT["rope"]})
    assert rd.Scene.load(path) == rd.Scene(rd.Rope(**DOCUMENT["rope"]))


@pytest.mark.parametrize("path", ["rope.toml", "with space.toml", "Drähte.toml", "no_suffix"])
@pytest.mark.parametrize("kind", [str, lambda path: path], ids=["text", "path"])
def test_paths_may_be_text_or_path(path, kind, tmp_path):
    SCENE.save(kind(tmp_path / path))
    assert rd.Scene.load(kind(tmp_path / path)) == SCENE
    assert os.listdir(tmp_path) == [path]


# (what is wrong, the document, what the message says)
REFUSED = {
    "unknown key": (changed("wind", value=9.81), "unknown key 'wind' in the file"),
    "unknown key of the rope": (
        changed("rope", "diameter", value=4e-3),
        "unknown key 'diameter' in rope: expected one of axial_stiffness, axis, bending_stiffness",
    ),
    "unknown key of an end": (changed("ends", 1, "w", value="held"), "unknown key 'w' in ends[1]"),
    "unknown key of a damping": (
        changed("damping", 0, "eta", value=0.1),
        "unknown key 'eta' in damping[0]",
    ),
    "unknown key of a part": (changed("parts", 0, "m", value=1.0), "unknown key 'm' in parts[0]"),
    "private key": (changed("rope", "_", value=1), "unknown key '_' in rope"),
    "missing rope": (changed("rope", drop=True), "key rope is missing"),
    "missing length": (changed("rope", "length", drop=True), "key rope.length is missing"),
    "missing density": (
        changed("rope", "linear_density", drop=True),
        "key rope.linear_density is missing",
    ),
    "missing gamma": (changed("damping", 0, "gamma", drop=True), "key damping[0].gamma is missing"),
    "missing kind of damping": (
        changed("damping", 0, "kind", drop=True),
        "key damping[0].kind is missing: one of StiffnessDamping, RayleighDamping",
    ),
    "missing kind of part": (
        changed("parts", 2, "kind", drop=True),
        f"key parts[2].kind is missing: one of {', '.join(PARTS)}",
    ),
    "missing mass": (changed("parts", 0, "mass", drop=True), "key parts[0].mass is missing"),
    "missing x": (changed("parts", 2, "x", drop=True), "key parts[2].x is missing"),
    "rope of text": (changed("rope", value="steel"), "rope must be a table, got 'steel'"),
    "rope of tables": (changed("rope", value=[{}]), "rope must be a table, got [{}]"),
    "length of text": (
        changed("rope", "length", value="1.5"),
        "rope.length must be a finite number > 0 [m], got '1.5'",
    ),
    "length of truth": (changed("rope", "length", value=True), "rope.length must be a finite"),
    "length of nan": (changed("rope", "length", value=math.nan), "rope.length must be a finite"),
    "negative length": (changed("rope", "length", value=-1.0), "rope.length must be a finite"),
    "stiffness of zero": (
        changed("rope", "bending_stiffness", value=0),
        "rope.bending_stiffness must be a finite number > 0 [N m^2], got 0",
    ),
    "tension of text": (changed("tension", value="high"), "tension must be a finite"),
    "tension without a mean": (
        changed("tension", value={"amplitude": 1.0}),
        "key tension.mean is missing",
    ),
    "unknown key of the tension": (
        changed("tension", value={"mean": 1.0, "period": 2.0}),
        "unknown key 'period' in tension",
    ),
    "pulsation of no frequency": (
        changed("tension", value={"mean": 1.0, "amplitude": 0.5}),
        "tension.frequency must be > 0 where the tension pulsates",
    ),
    "mean of text": (
        changed("tension", value={"mean": "high"}),
        "tension.mean must be a finite number [N], got 'high'",
    ),
    "tension of infinity": (changed("tension", value=math.inf), "got inf"),
    "tension too large": (changed("tension", value=10**400), "tension must be a finite"),
    "ends of a word": (changed("ends", value="clamped"), "ends must be a pair of"),
    "one end": (changed("ends", value=["clamped"]), "ends must be a pair of"),
    "unknown end": (changed("ends", 0, value="glued"), "ends[0] must be one of"),
    "number as end": (changed("ends", 0, value=1), "ends[0] must be a word or an End, got 1"),
    "unknown word": (changed("ends", 1, "beta", value="loose"), "ends[1].beta must be one of"),
    "spring of a number": (changed("ends", 1, "spring", value=3.0), "ends[1].spring must be"),
    "spring at unknown": (changed("ends", 1, "spring", value={"w": 1.0}), "ends[1].key of spring"),
    "damping of a number": (changed("damping", value=0.1), "damping[0] must be a table, got 0.1"),
    "unknown damping": (
        changed("damping", 0, "kind", value="NoDamping"),
        'damping[0].kind must be one of "StiffnessDamping", "RayleighDamping", "LossFactor",',
    ),
    "negative gamma": (changed("damping", 0, "gamma", value=-1.0), "damping[0].gamma must be"),
    "parts of a table": (
        changed("parts", value={"x": 0.5}),
        "parts must be an array of tables [[parts]], got {'x': 0.5}",
    ),
    "parts of numbers": (changed("parts", value=[1, 2]), "parts[0] must be a table, got 1"),
    "unknown part": (
        changed("parts", 1, "kind", value="Damper"),
        "parts[1].kind must be one of " + ", ".join(f'"{name}"' for name in PARTS) + ", got",
    ),
    "kind of a number": (changed("parts", 1, "kind", value=1), "parts[1].kind must be one of"),
    "mass of text": (changed("parts", 0, "mass", value="heavy"), "parts[0].mass must be"),
    "place off the rope": (
        changed("parts", 2, "x", value=2.0),
        "parts[2].x must lie on the rope, between 0 and 1.5 m, got 2.0",
    ),
    "coordinate of nothing": (
        changed("parts", 2, "coordinate", value="alpha"),
        "parts[2].coordinate must be one the scene has (z, beta), got 'alpha'",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_a_scene_without_meaning_is_refused_by_file_and_key(what, tmp_path):
    document, message = REFUSED[what]
    path = write(tmp_path / "rope.toml", document)
    with pytest.raises(rd.SceneError) as caught:
        rd.Scene.load(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert message in str(caught.value)


NOT_TOML = {
    "empty value": b"tension =",
    "prose": b"a rope of 8 m",
    "twice the same key": b"tension = 1\ntension = 2\n",
    "bytes": b"\x89HDF\r\n\x1a\n\xff\xfe",
    "latin": "name = 'Drähte'".encode("latin-1"),
    "null": b"tension = 1\x00",
    "a number of 5000 digits": b"tension = 1" + 5000 * b"0",
}


@pytest.mark.parametrize("what", NOT_TOML)
def test_what_is_not_toml_is_refused_by_file(what, tmp_path):
    path = tmp_path / "rope.toml"
    path.write_bytes(NOT_TOML[what])
    with pytest.raises(rd.SceneError, match="path must be a TOML file, got") as caught:
        rd.Scene.load(path)
    assert str(path) in str(caught.value)


def test_an_empty_file_lacks_a_rope(tmp_path):
    path = tmp_path / "rope.toml"
    path.write_bytes(b"")
    with pytest.raises(rd.SceneError, match=r"key rope is missing: a scene needs a table \[rope\]"):
        rd.Scene.load(path)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"nowhere\.toml"):
        rd.Scene.load(tmp_path / "nowhere.toml")


def test_a_folder_is_not_a_file(tmp_path):
    with pytest.raises(IsADirectoryError, match=str(tmp_path)):
        rd.Scene.load(tmp_path)
    with pytest.raises(OSError):
        SCENE.save(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_missing_folder_is_an_error_and_is_not_made(tmp_path):
    with pytest.raises(FileNotFoundError, match="nowhere"):
        SCENE.save(tmp_path / "nowhere" / "rope.toml")
    assert list(tmp_path.iterdir()) == []


def test_saving_replaces_the_file_and_leaves_nothing_else(tmp_path):
    path = tmp_path / "rope.toml"
    path.write_text("old")
    SCENE.save(path)
    assert rd.Scene.load(path) == SCENE
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("old", [None, "old"], ids=["no_file", "old_file"])
@pytest.mark.parametrize("step", ["write_bytes", "chmod", "replace"])
def test_a_failing_write_leaves_the_old_file_and_no_other(step, old, tmp_path, monkeypatch):
    path = tmp_path / "rope.toml"
    if old is not None:
        path.write_text(old)

    def full(self, *arguments):
        if step == "write_bytes":  # half of it, then the disk is full
            with self.open("wb") as file:
                file.write(arguments[0][:10])
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(f"pathlib.Path.{step}", full)
    with pytest.raises(OSError, match="No space left"):
        SCENE.save(path)
    monkeypatch.undo()
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == (
        [] if old is None else [("rope.toml", old)]
    )


def test_an_interrupted_write_leaves_the_old_file_and_no_other(tmp_path, monkeypatch):
    path = tmp_path / "rope.toml"
    path.write_text("old")

    def interrupted(self, content):
        raise KeyboardInterrupt

    monkeypatch.setattr("pathlib.Path.write_bytes", interrupted)
    with pytest.raises(KeyboardInterrupt):
        SCENE.save(path)
    monkeypatch.undo()
    assert [(p.name, p.read_text()) for p in tmp_path.iterdir()] == [("rope.toml", "old")]


@pytest.mark.parametrize("mask", [0o022, 0o027, 0o077])
def test_a_new_file_has_the_permissions_of_any_other(mask, tmp_path):
    before = os.umask(mask)
    try:
        SCENE.save(tmp_path / "rope.toml")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "rope.toml").stat().st_mode) == 0o666 & ~mask


def test_a_replaced_file_keeps_its_permissions(tmp_path):
    path = tmp_path / "rope.toml"
    path.write_text("old")
    path.chmod(0o640)
    SCENE.save(path)
    assert stat.S_IMODE(path.stat().st_mode) == 0o640


def test_saving_through_a_link_writes_the_file_it_points_to(tmp_path):
    target, link = tmp_path / "target.toml", tmp_path / "link.toml"
    target.write_text("old")
    link.symlink_to(target)
    SCENE.save(link)
    assert link.is_symlink()
    assert rd.Scene.load(target) == SCENE
