"""A broken wire that is still wound, alone and as a part of a rope."""

import dataclasses
import math

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.space.spectrum import counts_at

STRAIGHT = rd.BrokenWire(0.4, 0.05, 3e-4, radius=2e-3, damping_ratio=2e-3)
WOUND = dataclasses.replace(STRAIGHT, lay_length=0.03, angle=0.7)
LONG = 1e4  # [m] A lay of that length bends a wire of 50 mm by 1e-12 rad.
ROPE = rd.Rope(
    1.0,
    0.5,
    bending_stiffness=5.0,
    torsional_stiffness=1.0,
    axial_stiffness=1e5,
    polar_inertia=1e-5,
)


def changed(wire, **how):
    return dataclasses.replace(wire, **how)


def scene_of(*parts, **how):
    return rd.Scene(ROPE, **{"tension": 1000.0, "planes": "both", "parts": parts} | how)


def frequencies(wire, number=4):
    return rd.wound_wire(wire).compile().modes(number).frequency


def test_a_long_lay_leaves_a_straight_cantilever():
    straight = frequencies(changed(STRAIGHT, lay_length=100.0))
    assert straight[1] == pytest.approx(straight[0], rel=1e-8)
    # what rotary inertia takes of a first mode, 2.3 (d/4 l)^2 in lambda: 5e-6
    assert straight[0] == pytest.approx(STRAIGHT.frequency, rel=1e-5)


def test_a_short_lay_splits_and_moves_the_modes_of_a_straight_wire():
    wound = frequencies(WOUND)
    assert wound[0] / STRAIGHT.frequency == pytest.approx(1.0646, abs=1e-4)
    assert wound[1] / wound[0] - 1 > 3e-3
    assert wound[2] / frequencies(changed(WOUND, lay_length=100.0))[2] < 0.95


def test_the_wire_is_as_long_as_it_was_and_turns_as_it_is_laid():
    axes = [rd.wound_wire(changed(WOUND, sense=s)).rope.axis for s in ("Z", "S")]
    for axis, sign in zip(axes, (1, -1)):
        assert axis.length == pytest.approx(WOUND.length, rel=1e-14)
        tau, kz, _ = axis.rates(0.0)
        p = math.atan2(0.03, 2 * math.pi * 2e-3)
        assert [tau, kz] == pytest.approx(
            [sign * math.sin(p) * math.cos(p) / 2e-3, math.cos(p) ** 2 / 2e-3], rel=1e-13
        )
    # a mirror image has the same frequencies
    left = frequencies(changed(WOUND, sense="S"))
    assert np.abs(left / frequencies(WOUND) - 1).max() < 1e-12


def test_a_wire_keeps_its_damping_ratio():
    modes = rd.wound_wire(WOUND).compile().modes(3)
    assert modes.damping_ratio == pytest.approx(np.full(3, 2e-3), rel=1e-9)


def test_a_wire_of_a_long_lay_is_the_straight_one_on_the_rope():
    straight = scene_of(STRAIGHT).compile()
    wound = scene_of(changed(STRAIGHT, lay_length=LONG)).compile()
    a, b = straight.modes(20), wound.modes(20)
    # the wire's rotary inertia: 5.2e-6 of its first mode, 5e-5 of its second
    assert b.frequency == pytest.approx(a.frequency, rel=1e-4)
    for name in ("broken wire", "broken wire mass"):
        # pairs of both planes are mixed otherwise, but not their sum
        assert b.energy[name].sum() == pytest.approx(a.energy[name].sum(), rel=1e-3)
    assert b.damping_ratio[:6].sum() == pytest.approx(a.damping_ratio[:6].sum(), rel=1e-5)
    f = np.linspace(80.0, 100.0, 5)
    tips = [
        m.frf(f, drive=("z", 0.3), response=[("wire", 0), ("z", 0.6)]) for m in (straight, wound)
    ]
    assert tips[1].value == pytest.approx(tips[0].value, rel=1e-3)
    for limit in np.linspace(7.0, 700.0, 60):
        assert wound.count(below=limit) == straight.count(below=limit)


def root_of(wire):
    """Return motion of the root in the frame of the helix per motion of the rope, (6, 6).

    By vectors: u + theta x r, with beta = -theta_y.
    """
    sign = np.diag([1.0, 1.0, 1.0, 1.0, -1.0, 1.0])
    r = wire.radius * np.array([0.0, math.cos(wire.angle), math.sin(wire.angle)])
    hand = 1 if wire.sense == "Z" else -1
    around = np.cross([1.0, 0.0, 0.0], r)
    t = np.array([wire.lay_length, 0.0, 0.0]) + 2 * math.pi * hand * around
    t /= np.linalg.norm(t)
    z = -r / np.linalg.norm(r)
    own = np.stack([t, np.cross(z, t), z])
    moved = np.eye(6)
    moved[:3, 3:] = np.cross(np.eye(3), r).T  # columns are e_k x r
    return sign @ np.kron(np.eye(2), own) @ moved @ sign, own


def receptance(model, at):
    points = [(c, at) for c in ("x", "y", "z", "alpha", "beta", "gamma")]
    return model.frf([FREQUENCY], drive=points).value[:, :, 0].T


FREQUENCY = 117.3  # [Hz]
FIRST = np.zeros(1, dtype=np.intp)  # Of the components: all six coordinates.


@pytest.mark.claim(
    "A wound wire on a rope: receptances of all six coordinates, of the size of each",
    reference="bare rope and free wire joined by their receptances at the root",
    accepted=1e-13,
)
def test_the_part_is_the_rope_and_the_wire_joined_by_their_receptances(claim):
    ways = [(sense, angle) for sense in ("Z", "S") for angle in (0.0, 0.7, -2.0)]
    claim(max(joined_and_found(*way) for way in ways))  # 8e-15


def joined_and_found(sense, angle):
    wire = changed(WOUND, sense=sense, angle=angle, diameter=2e-3)
    # the same path of code with a torque that changes 1e-20 of anything
    rope = receptance(scene_of(torque=1e-12).compile(), wire.x)
    free = rd.wound_wire(wire).replace(ends=("free", "free")).compile()
    arm, own = root_of(wire)
    stiffness = arm.T @ np.linalg.inv(receptance(free, 0.0)) @ arm
    whole = scene_of(wire).compile()
    joined = np.linalg.inv(np.linalg.inv(rope) + stiffness)
    size = np.sqrt(np.abs(np.diag(joined)))
    found = receptance(whole, wire.x)
    # what the wire changes
    assert np.abs((found - rope) / np.outer(size, size)).max() > 1e-3
    # the tip is the free end of the wire, seen along z of the rope
    axis = free.scene.rope.axis
    ends = [(c, 0.0) for c in free.coordinates], [(c, axis.length) for c in ("x", "y", "z")]
    across = free.frf([FREQUENCY], drive=ends[0], response=ends[1]).value[:, :, 0].T
    root = np.linalg.inv(receptance(free, 0.0)) @ arm @ joined
    up = (own.T @ axis.frame(axis.length))[2] @ across @ root
    tips = [(c, wire.x) for c in free.coordinates]
    seen = whole.frf([FREQUENCY], drive=tips, response=("wire", 0)).value[:, 0, 0]
    assert np.abs(seen - up).max() / np.abs(up).max() < 1e-12
    return np.abs((found - joined) / np.outer(size, size)).max()


def test_modes_are_counted_and_lie_where_responses_are_largest():
    model = scene_of(changed(WOUND, damping_ratio=0.0)).compile()
    modes = model.modes(below=700.0)
    for limit in np.linspace(10.0, 700.0, 40):
        assert model.count(below=limit) == (modes.frequency < limit).sum()
    # to both sides of a mode that is the wire's the response of its tip changes sign
    k = int(modes.energy["broken wire mass"].argmax())
    assert modes.energy["broken wire mass"][k] > 0.9
    near = modes.frequency[k] * (1 + np.array([-1e-9, 1e-9]))
    tip = model.frf(near, drive=("z", 0.3), response=("wire", 0)).value[0].real
    assert tip[0] * tip[1] < 0 and np.abs(tip).min() > 1.0


def by_counts(model, k, eigenvalue):
    """Return an eigenvalue by counts alone."""
    low, high = eigenvalue * (1 - 1e-6), eigenvalue * (1 + 1e-6)
    assert (
        counts_at(model.rope, FIRST, np.array([low]))[0]
        <= k
        < counts_at(model.rope, FIRST, np.array([high]))
    )
    while high - low > 2e-14 * high:
        middle = (low + high) / 2
        if counts_at(model.rope, FIRST, np.array([middle]))[0] > k:
            high = middle
        else:
            low = middle
    return (low + high) / 2


@pytest.mark.parametrize("diameter", [2e-5, 3e-4, 3e-3])
def test_modes_beside_poles_of_feet_are_as_right_as_others(diameter):
    # a wire of 0.02 mm has 1e-7 of the rope's mass, and its modes lie so close to its own
    model = scene_of(changed(WOUND, damping_ratio=0.0, diameter=diameter)).compile()
    modes = model.modes(8)
    for k, eigenvalue in enumerate(modes.eigenvalue):
        # 5e-14 of brackets of counts
        assert eigenvalue == pytest.approx(by_counts(model, k, eigenvalue), rel=3e-13)


def test_wires_alike_at_one_place_have_modes_of_which_the_rope_knows_nothing():
    wire = changed(WOUND, damping_ratio=0.0)
    own, modes = frequencies(wire, 2), scene_of(wire, wire).compile().modes(8)
    for f in own:
        assert np.abs(modes.frequency / f - 1).min() < 2e-13
    with pytest.raises(rd.SolveError, match="is that of a broken wire whose root stands still"):
        modes.shape.sum()


def test_energies_sum_to_one_and_strain_is_kinetic():
    modes = scene_of(WOUND).compile().modes(12)
    strain = ("bending", "twist", "stretch", "tension", "broken wire")
    moving = ("x", "y", "z", "alpha", "beta", "gamma", "broken wire mass")
    for names in (strain, moving):
        assert sum(modes.energy[n] for n in names) == pytest.approx(np.ones(12), abs=1e-12)
    # d lambda/lambda by its modulus is the share of its strain energy
    k, step = int(modes.energy["broken wire"].argmax()), 1e-6
    stiffer = changed(WOUND, youngs_modulus=WOUND.youngs_modulus * (1 + step))
    more = scene_of(stiffer).compile().modes(12).eigenvalue[k] / modes.eigenvalue[k] - 1
    assert more / step == pytest.approx(modes.energy["broken wire"][k], rel=1e-4)
    # and its damping ratio times that
    assert modes.damping_ratio[k] == pytest.approx(2e-3 * modes.energy["broken wire"][k], rel=1e-9)


def test_two_wires_of_one_place_and_a_curved_rope():
    wires = WOUND, changed(WOUND, length=0.04, sense="S", angle=2.0)
    rope = rd.Rope(rd.Axis.arc(0.5, 2.0), 0.5, bending_stiffness=5.0, torsional_stiffness=4.0)
    scene = rd.Scene(rope, parts=wires, planes="both")
    modes = scene.compile().modes(12)
    own = [frequencies(wire, 2)[0] for wire in wires]
    for f in own:
        assert np.abs(modes.frequency / f - 1).min() < 2e-3
    tips = scene.compile().frf([50.0], drive=("y", 0.6), response=[("wire", 0), ("wire", 1)])
    assert np.isfinite(tips.value).all() and (tips.value != 0).all()


def test_what_a_straight_wire_misses():
    straight, wound = (scene_of(wire).compile() for wire in (STRAIGHT, WOUND))
    f = np.linspace(80.0, 92.5, 251)
    peaks = [
        f[np.abs(m.frf(f, drive=("z", 0.3), response=("wire", 0)).value[0]).argmax()]
        for m in (straight, wound)
    ]
    # the tip resonates 6.4 % higher
    assert peaks == pytest.approx([86.0, 91.5], abs=0.06)
    # and motion along the rope bends a wound wire alone
    along = [
        abs(m.frf([88.0], drive=("x", 0.3), response=("wire", 0)).value[0, 0])
        for m in (straight, wound)
    ]
    assert along[0] == 0 < along[1]


def test_a_wound_wire_goes_through_a_file(tmp_path):
    scene = scene_of(WOUND)
    scene.save(tmp_path / "rope.toml")
    assert rd.Scene.load(tmp_path / "rope.toml") == scene


def test_one_plane_leaves_a_straight_wire():
    left = scene_of(WOUND).without("second plane")
    assert left.parts == (changed(WOUND, lay_length=None),)
    assert left.compile().modes(1).frequency[0] > 0


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: changed(WOUND, lay_length=0.0), "lay_length must be a finite number > 0"),
        (lambda: changed(WOUND, lay_length=2e-4), "lay_length must be at least the diameter"),
        (lambda: changed(WOUND, poissons_ratio=0.6), "poissons_ratio must be from -1 to 1/2"),
        (lambda: changed(WOUND, sense="right"), "sense must be one of"),
        (lambda: changed(WOUND, radius=0.0), "radius must not be 0"),
        (lambda: rd.wound_wire(STRAIGHT), "lay_length must be given of a wire that is wound"),
        (lambda: WOUND.frequency, "frequency is that of a straight wire"),
        (lambda: scene_of(WOUND, planes="z"), 'planes must be "both" for a rope with torque'),
        (lambda: scene_of(WOUND, STRAIGHT), "parts.1..lay_length must be given"),
        (lambda: rd.plan_measurement(scene_of(WOUND)), "wound wires must be left out"),
        (lambda: scene_of(WOUND).compile(elements=8), "elements must be left out"),
        (lambda: scene_of(changed(WOUND, x=0.0)).compile(), "root of a broken wire must be able"),
    ],
)
def test_what_is_no_wound_wire_is_refused(ask, message):
    with pytest.raises(rd.SceneError, match=message):
        ask()
