"""Planning: places against closed forms, and what a planned and a bad measurement show."""

import itertools
import math
import pickle

import numpy as np
import pytest
from conftest import long

import ropedyn as rd
from ropedyn.experiment.plan.placement import CandidatePlaces, best_placement
from ropedyn.experiment.plan.target_modes import GRID

STRING = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0, damping=rd.ModalDamping(0.01))
"""Frequencies 50 k Hz, shapes sin(k pi x)."""
LAID = rd.Rope(
    1.35,
    0.1017,
    bending_stiffness=1.54,
    torsional_stiffness=0.15,
    lay_slope=0.01,
    polar_inertia=2e-6,
)
ROPE = rd.Scene(LAID, tension=300.0, damping=rd.StiffnessDamping(1e-4))
STRAIGHT = ROPE.replace(rope=LAID.replace(lay_slope=None))


def measured(scene, plan, **changes):
    """The planned response: what an analyser shows of a rope like the scene."""
    asked = {"drive": plan.drive, "response": list(plan.response)} | changes
    return scene.compile().frf(plan.lines, **asked)


def shown(frf, plan):
    """Which wanted modes are peaks, within their half-power bandwidths."""
    found = np.concatenate([peaks.frequency for peaks in frf.peaks()])
    near = np.abs(found[:, None] - plan.frequency) <= plan.bandwidth
    return near.any(axis=0)


# places


def test_two_modes_of_a_string_are_seen_best_at_a_third():
    # with a = cos(pi x_d), b = cos(pi x_r) both are seen alike where a b = 1/4, by
    # sqrt((1 - a^2)(1 - b^2)) <= 1 - a b = 3/4, equal where a = b = 1/2
    plan = rd.plan_measurement(STRING, modes=2)
    h = 1.0 / GRID
    for _, x in (plan.drive, *plan.response):
        assert min(abs(x - 1 / 3), abs(x - 2 / 3)) <= h
    # (sin 2 pi x)^2 falls by 2 pi h times sqrt(3)/2 at most
    np.testing.assert_allclose(plan.seen, 0.75, atol=2 * math.pi * h)
    assert plan.seen.min() <= 0.75


def test_visibility_is_the_product_of_shapes_over_its_largest():
    plan = rd.plan_measurement(STRING, [1, 3, 4], drive=("z", 0.3), response=[("z", 0.11)])
    k = np.array([1, 3, 4]) * math.pi
    expected = np.abs(np.sin(k * 0.3) * np.sin(k * 0.11))
    # a straight line between places misses (4 pi h)^2/8
    np.testing.assert_allclose(plan.visibility, [expected], atol=2 * (4 * math.pi / GRID) ** 2)
    # m = mu L/2
    peak = expected / (2 * 0.01 * 0.05 * (2 * math.pi * plan.frequency) ** 2)
    np.testing.assert_allclose(plan.amplitude, [peak], rtol=1e-3)


@pytest.mark.parametrize("scene", [STRING, ROPE], ids=["string", "rope"])
@pytest.mark.parametrize("modes", [3, *long(5, 8)])
def test_a_planned_measurement_shows_every_mode_as_a_peak(scene, modes):
    plan = rd.plan_measurement(scene, modes)
    assert shown(measured(scene, plan), plan).all()


@pytest.mark.parametrize("mode", [2, 3, 5])
def test_a_drive_at_a_node_does_not_show_its_mode(mode):
    plan = rd.plan_measurement(STRING, modes=5)
    seen = shown(measured(STRING, plan, drive=("z", 1 / mode)), plan)
    expected = np.arange(1, 6) % mode != 0
    assert seen.tolist() == expected.tolist()


def test_peaks_are_as_high_as_planned():
    plan = rd.plan_measurement(STRING, modes=4)
    exact = STRING.compile().frf(plan.frequency, drive=plan.drive, response=plan.response[0])
    # the other modes give about zeta of it
    np.testing.assert_allclose(np.abs(exact.value[0]), plan.amplitude[0], rtol=0.05)


@pytest.mark.parametrize("modes", [2, 4, 6])
@pytest.mark.parametrize("sensors", [1, 2, 3])
def test_no_other_places_see_the_worst_mode_better(modes, sensors):
    x = np.linspace(0.04, 0.96, 14) ** 1.1
    k = np.arange(1, modes + 1)[:, None] * math.pi
    seen = np.abs(np.sin(k * x))
    candidates = CandidatePlaces(x, seen)
    found = best_placement(candidates, [candidates] * sensors, 0.05)
    best = max(
        (seen[:, d] * seen[:, s].max(axis=1)).min()
        for d in range(len(x))
        for s in map(list, itertools.combinations(range(len(x)), sensors))
        if np.diff(np.sort(x[[d, *s]])).min() >= 0.05
    )
    here = seen[:, found.drive] * seen[:, list(found.sensors)].max(axis=1)
    # of nearly equal ones the mean decides
    assert here.min() >= best - 1e-6


def test_places_keep_within_what_is_allowed():
    plan = rd.plan_measurement(STRING, 4, between=(0.6, 0.8), sensors=2, apart=0.05)
    x = np.array([plan.drive[1], *(x for _, x in plan.response)])
    assert x.min() >= 0.6
    assert x.max() <= 0.8
    assert np.diff(np.sort(x)).min() >= 0.05
    listed = rd.plan_measurement(STRING, 4, places=[0.5, 0.33, 0.13, 0.71], between=(0.2, 1.0))
    assert {listed.drive[1], listed.response[0][1]} <= {0.33, 0.71}
    fixed = rd.plan_measurement(STRING, 4, drive=("z", 0.21), sensors=2)
    assert fixed.drive == ("z", 0.21)
    assert len(fixed.response) == 2


def test_modes_are_those_that_drive_and_response_can_see():
    modes = STRAIGHT.compile().modes(8)
    transverse = np.flatnonzero(modes.family == "transverse")[:3] + 1
    torsional = np.flatnonzero(modes.family == "torsional")[:1] + 1
    assert rd.plan_measurement(STRAIGHT, 3).mode.tolist() == transverse.tolist()
    twist = rd.plan_measurement(STRAIGHT, 1, drive="alpha")
    assert twist.mode.tolist() == torsional.tolist()
    assert twist.response[0][0] == "alpha"
    with pytest.raises(rd.SceneError, match=f"mode {torsional[0]}: torsional"):
        rd.plan_measurement(STRAIGHT, torsional)
    with pytest.raises(rd.SceneError, match="moves with z"):
        rd.plan_measurement(STRAIGHT, response="alpha")
    laid = rd.plan_measurement(ROPE, 3, drive="z", response="alpha")
    assert (laid.drive[0], laid.response[0][0]) == ("z", "alpha")


def test_motion_across_is_planned_where_nothing_is_said():
    rope = rd.Rope(1.0, 0.1, axial_stiffness=1e5)
    scene = rd.Scene(rope, tension=1000.0, damping=rd.ModalDamping(0.01))
    assert scene.coordinates[0] == "x"
    assert rd.plan_measurement(scene, 2).drive[0] == "z"


def test_rigid_motion_has_no_peak():
    free = STRING.replace(ends=("free", "free"))
    plan = rd.plan_measurement(free, 2)
    np.testing.assert_allclose(plan.frequency, [50.0, 100.0], rtol=1e-12)
    with pytest.raises(rd.SceneError, match="mode 1: transverse, 0 Hz"):
        rd.plan_measurement(free, [1, 2])


# record


def test_the_narrowest_peak_keeps_its_height_between_lines():
    plan = rd.plan_measurement(STRING, 5, std=10.0)
    assert plan.line_spacing == pytest.approx(2 * 0.01 * 50.0 / 4, rel=1e-12)
    assert "half-power bandwidth of mode 1" in plan.reason
    frf = measured(STRING, plan)
    for f, b in zip(plan.frequency, plan.bandwidth):
        line = np.abs(frf.value[0][np.abs(frf.frequency - f) <= b]).max()
        top = np.abs(STRING.compile().frf(f, drive=plan.drive, response=plan.response[0]).value)
        # half a line off: 1/sqrt(1 + (1/4)^2) of the top
        assert line >= 0.97 * top.max()


def test_near_modes_are_told_apart_by_the_record():
    # a resonator tuned to the first mode splits it in two
    split = STRING.replace(parts=[rd.Resonator(0.5, 1e-4, 50.0)], damping=None)
    plan = rd.plan_measurement(split, 2, places=[0.31])
    assert "lines between mode" in plan.reason
    assert plan.line_spacing == pytest.approx(np.diff(plan.frequency)[0] / 4, rel=0.02)


def test_a_wanted_uncertainty_decides_the_line_spacing():
    plan = rd.plan_measurement(STRING, 3, std=0.01)
    assert plan.line_spacing == pytest.approx(0.01 * math.sqrt(12), rel=1e-12)
    assert plan.record_length == 1 / plan.line_spacing
    random = np.random.default_rng(3)
    true = random.uniform(50.0, 60.0, 20_000)
    read = np.round(true / plan.line_spacing) * plan.line_spacing
    # a standard deviation of 20000 is known to 0.4 % of a rectangular distribution
    assert np.std(read - true) == pytest.approx(0.01, rel=0.02)


def test_the_band_holds_every_mode_and_the_rate_the_band():
    plan = rd.plan_measurement(STRING, 4)
    assert plan.lines[-1] <= plan.highest <= plan.lines[-1] + plan.line_spacing
    assert plan.highest == pytest.approx(220.0, rel=1e-12)
    assert plan.rate == pytest.approx(2.56 * 220.0, rel=1e-12)


def test_without_damping_only_distances_tell_the_record():
    plan = rd.plan_measurement(STRING.replace(damping=None), 3)
    assert plan.line_spacing == pytest.approx(50.0 / 4, rel=1e-9)
    assert np.isinf(plan.amplitude).all()
    assert "Record 0.08 s" in plan.report()


def test_what_is_not_seen_has_no_peak_without_damping_either():
    undamped = STRING.replace(damping=None)
    plan = rd.plan_measurement(undamped, 2, drive=("z", 0.3), response=[("z", 0.0), ("z", 0.3)])
    assert plan.amplitude[0].tolist() == [0.0, 0.0]
    assert np.isinf(plan.amplitude[1]).all()


def test_modes_within_their_bandwidth_are_said():
    damped = STRING.replace(damping=rd.ModalDamping(0.3))
    report = rd.plan_measurement(damped, 3).report()
    assert report.endswith("no record shows two peaks there: mode 2, mode 3.")


# damage


@pytest.mark.parametrize("damage", [0.5, (0.3, 0.45)])
def test_a_small_loss_moves_frequencies_as_first_order_says(damage):
    plan = rd.plan_measurement(ROPE, 5, damage=damage, loss=1e-4)
    x = damage if isinstance(damage, tuple) else (0.5 - 0.005 * 1.35, 0.5 + 0.005 * 1.35)
    change = ROPE.compile().modes(5).damage(points=400)
    loss = dict.fromkeys(("bending_stiffness", "torsional_stiffness"), 1e-4)
    expected = change.frequency_change(*x, **loss) * plan.frequency
    # second order in the loss; the mean over a part of which the damage has only some
    np.testing.assert_allclose(plan.shift, expected, rtol=1e-3, atol=1e-9)


def test_a_part_that_a_damaged_rope_has_moves_frequencies_as_computed():
    worn = rd.LocalChange(0.2, 0.5, bending=0.3, density=0.9)
    plan = rd.plan_measurement(STRAIGHT, [2, 1], damage=worn)
    whole, damaged = (
        s.compile().modes(2).frequency for s in (STRAIGHT, STRAIGHT.replace(parts=[worn]))
    )
    np.testing.assert_allclose(plan.shift, damaged - whole, rtol=1e-9)
    assert plan.damage == "LocalChange(start=0.2, stop=0.5, bending=0.3, density=0.9)"
    np.testing.assert_allclose(plan.shift_in_lines, np.abs(plan.shift) * plan.record_length)


def test_the_report_says_whether_damage_is_seen():
    seen = rd.plan_measurement(ROPE, 5, damage=(0.3, 0.4), loss=0.5).report()
    assert " lines." in seen
    small = rd.plan_measurement(ROPE, 5, damage=0.5, loss=0.001)
    most = int(np.abs(small.shift).argmax())
    assert f"a record of {1 / abs(small.shift[most]):.4g} s" in small.report()
    hinge = rd.plan_measurement(STRING, 2, damage=rd.PointMass(0.5, 0.0)).report()
    assert hinge.endswith("PointMass(x=0.5, mass=0) changes no wanted frequency.")


# as an answer


def test_a_plan_can_be_shown_kept_and_read_again(tmp_path):
    plan = rd.plan_measurement(ROPE, 4, sensors=2, damage=0.4)
    plan.save(tmp_path / "plan.nc")
    for again in (rd.load(tmp_path / "plan.nc"), pickle.loads(pickle.dumps(plan))):
        assert again.report() == plan.report()
        assert again.table() == plan.table()
    assert plan.table().column("mode") == (1, 2, 3, 4)
    assert plan.table().column("seen [%]") == tuple((100 * plan.seen).tolist())
    ax = plan.plot()
    assert len(ax.lines) == 4 + 1 + 2
    two = rd.plan_measurement(ROPE, 2, response="alpha").plot()
    assert len(two.lines) == 2 * 2 + 1 + 1


REFUSED = {
    "modes must": lambda: rd.plan_measurement(STRING, 0),
    "modes[1] must": lambda: rd.plan_measurement(STRING, [1, -1]),
    "modes must be different": lambda: rd.plan_measurement(STRING, [1, 1]),
    "drive must be one of": lambda: rd.plan_measurement(STRING, drive="x"),
    "drive must be one coordinate": lambda: rd.plan_measurement(
        STRING, drive=[("z", 0.1), ("z", 0.2)]
    ),
    "drive[1] must": lambda: rd.plan_measurement(STRING, drive=("z", 1.2)),
    "response must be a coordinate or points": lambda: rd.plan_measurement(
        ROPE, response=[("z", 0.1), ("alpha", 0.2)]
    ),
    "sensors must": lambda: rd.plan_measurement(STRING, sensors=0),
    "sensors must be left out": lambda: rd.plan_measurement(
        STRING, sensors=3, response=[("z", 0.1), ("z", 0.2)]
    ),
    "between must": lambda: rd.plan_measurement(STRING, between=(0.5, 0.2)),
    "between[1] must": lambda: rd.plan_measurement(STRING, between=(0.5, 2.0)),
    "places must": lambda: rd.plan_measurement(STRING, places=[0.1], between=(0.2, 0.5)),
    "places[0] must": lambda: rd.plan_measurement(STRING, places=[1.5]),
    "apart must": lambda: rd.plan_measurement(STRING, apart=2.0),
    "apart must leave": lambda: rd.plan_measurement(STRING, apart=0.6, sensors=2),
    "damage must lie": lambda: rd.plan_measurement(ROPE, damage=3.0),
    "damage must be two": lambda: rd.plan_measurement(ROPE, damage=(0.1, 0.2, 0.3)),
    "damage must be a LocalChange": lambda: rd.plan_measurement(STRING, damage=0.5),
    "loss must": lambda: rd.plan_measurement(ROPE, damage=0.5, loss=1.0),
    "std must": lambda: rd.plan_measurement(STRING, std=0.0),
    "must be able to see mode 2": lambda: rd.plan_measurement(STRING, 2, drive=("z", 0.5)),
    "must be able to see mode 3": lambda: rd.plan_measurement(STRING, 3, drive=("z", 1 / 3)),
}


@pytest.mark.parametrize("what", REFUSED)
def test_what_cannot_be_planned_is_said(what):
    with pytest.raises(rd.SceneError) as caught:
        REFUSED[what]()
    assert what in str(caught.value)


@pytest.mark.parametrize(
    ("argument", "value"),
    [
        ("scene", None),
        ("modes", 2.0),
        ("drive", 3),
        ("response", {"z": 1}),
        ("sensors", 1.5),
        ("between", 0.5),
        ("places", "all"),
        ("apart", None),
        ("damage", "here"),
        ("loss", None),
        ("std", "small"),
    ],
)
def test_wrong_types_are_said(argument, value):
    with pytest.raises(TypeError, match=argument):
        rd.plan_measurement(**{"scene": ROPE, "damage": 0.5} | {argument: value})
