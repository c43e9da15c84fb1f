"""Motion over time of ropes on an axis: against straight ropes, sums over modes, and refusals."""

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.cli.command import main
from ropedyn.space import motion
from ropedyn.space.model import compile_space

TIME = np.linspace(0.0, 0.3, 401)
LINE = rd.Scene(
    rd.Rope(1.3, 0.1, bending_stiffness=0.5, torsional_stiffness=0.3),
    tension=100.0,
    damping=rd.StiffnessDamping(1e-4),
    parts=[rd.PointMass(0.5, 0.02), rd.Dashpot(0.9, 0.3)],
    ends=("clamped", rd.End(beta="free", spring={"beta": 2.0})),
    planes="both",
)
STRAIGHT, SAME = LINE.compile(), compile_space(LINE)
DENSITY, DRAG = 0.5, 4.0
ARC = rd.Rope(rd.Axis.arc(1.0, 2.0), DENSITY, bending_stiffness=50.0, torsional_stiffness=30.0)
ARCH = rd.Scene(
    ARC, ends=("pinned", "pinned"), planes="both", damping=rd.ViscousDamping(DRAG), tension=20.0
)
MODEL = ARCH.compile()
AT, SEEN = ("z", 0.5), ("z", 1.25)


def covered(one, value, error=0.0):
    """Hold a history against values: no error is above its bound, which is a bound of use."""
    assert (np.abs(one.value - value) <= one.total_error + error).all()
    assert (one.error.max(axis=1) <= 1e-3 * np.abs(value).max(axis=1)).all()


@pytest.mark.parametrize("quantity", ["displacement", "velocity"])
@pytest.mark.parametrize(
    "force",
    [rd.Sine(1.0, 30.0), rd.Impulse(1e-3, duration=5e-3), rd.Chirp(1.0, 10.0, 90.0, duration=0.2)],
    ids=["sine", "impulse", "chirp"],
)
def test_motion_on_a_line_is_that_of_a_straight_rope(force, quantity):
    asked = {"drive": ("z", 0.4), "force": force, "response": [("z", 0.65), ("beta", 0.3)]}
    one, two = (model.transient(TIME, **asked, quantity=quantity) for model in (STRAIGHT, SAME))
    assert one.cost.method == two.cost.method == "line"
    # the same rates by other sweeps: their roundings, grown by e^(a t), were 3e-9
    apart = np.abs(one.value - two.value).max(axis=1)
    assert (apart <= 1e-7 * np.abs(one.value).max(axis=1)).all()
    covered(two, one.value, one.error)


def test_release_and_blows_on_a_line_are_those_of_a_straight_rope():
    for begun in (
        {"start": {("z", 0.4): 3.0, ("y", 0.7): 1.0}},
        {"start": "static"},
        {"velocity": {("z", 0.4): 0.1}},
    ):
        histories = []
        for model in (STRAIGHT, SAME):
            asked = dict(begun)
            if asked.get("start") == "static":
                asked["start"] = model.static({("z", 0.4): 2.0})
            histories.append(model.transient(TIME, **asked, response=("z", 0.65)))
        one, two = histories
        covered(two, one.value, one.error)


def modal(force, response, count=80):
    """Sum modes of an arch with drag, each forced by a sine from rest: exact but for the others."""
    modes = MODEL.modes(count, points=400)
    at = [int(np.abs(modes.x - place).argmin()) for place in (AT[1], response[1])]
    assert np.abs(modes.x[at] - [AT[1], response[1]]).max() < 1e-12
    own = [modes.coordinates.index(c) for c in (AT[0], response[0])]
    residue = modes.shape[:, at[0], own[0]] * modes.shape[:, at[1], own[1]] / modes.modal_mass
    turn = 2 * np.pi * force.frequency
    sigma, square = DRAG / DENSITY / 2, modes.eigenvalue
    steady = force.amplitude / (square - turn**2 + 2j * sigma * turn)
    free = np.sqrt(square - sigma**2 + 0j)
    # Im(steady e^(i w t)) and what cancels it and its slope at 0
    start, slope = -steady.imag, -turn * steady.real
    decay = np.exp(-sigma * TIME)
    moving = start[:, None] * np.cos(np.outer(free, TIME))
    moving = moving + ((slope + sigma * start) / free)[:, None] * np.sin(np.outer(free, TIME))
    return residue @ ((steady[:, None] * np.exp(1j * turn * TIME)).imag + (decay * moving).real)


@pytest.mark.claim(
    "Motion of an arch under a sine from rest, relative to the largest value, not beyond its error",
    reference="closed forms of 80 modes of the arch",
    accepted=1e-5,
)
def test_motion_of_an_arch_is_the_sum_over_its_modes(claim):
    """What modes beyond 80 do was 1.4e-6 of it."""
    force, worst = rd.Sine(2.0, 9.0), 0.0
    history = MODEL.transient(
        TIME, drive=AT, force=force, response=[SEEN, ("x", 1.25)], tolerance=1e-7
    )
    for k, point in enumerate(history.response):
        reference = modal(force, point)
        off = np.abs(history.value[k] - reference)
        beyond = np.abs(reference - modal(force, point, 40)).max()
        assert (off <= history.error[k] + beyond).all()
        worst = max(worst, off.max() / np.abs(reference).max())
    claim(worst)


def test_planes_that_nothing_ties_do_not_move_each_other():
    history = MODEL.transient(TIME, drive=AT, force=rd.Sine(1.0, 9.0), response=[SEEN, ("y", 1.0)])
    assert history.value[0].any() and not history.value[1].any()


def test_snapshots_are_the_motion_at_those_times():
    asked = {"drive": AT, "force": rd.Sine(1.0, 9.0), "response": SEEN}
    history = MODEL.transient(TIME, **asked, snapshots=[TIME[200]])
    at = int(np.abs(history.x - SEEN[1]).argmin())
    seen = MODEL.transient(TIME, **asked | {"response": ("z", float(history.x[at]))})
    of_all = history.snapshot[0, at, history.coordinates.index("z")]
    assert of_all == pytest.approx(seen.value[0, 200], abs=2e-3 * np.abs(seen.value).max())


def test_mesh_error_covers_shorter_pieces():
    axis = rd.Axis.catenary(10.0, parameter=9.0)
    rope = rd.Rope(axis, 0.8, bending_stiffness=2.0, torsional_stiffness=1.0)
    model = rd.Scene(rope, planes="both", gravity=rd.Gravity()).compile()
    time = np.linspace(0.0, 0.5, 101)
    history = model.transient(time, drive=("y", 3.0), force=rd.Sine(1.0, 4.0))
    assert 0 < history.mesh_error.max() <= 2e-3 * np.abs(history.value).max()


def test_modes_are_heard_in_the_decay():
    """A ring-down of the record tells frequencies and damping of the lowest mode."""
    time = np.linspace(0.0, 2.0, 401)
    history = MODEL.transient(time, start={("y", 0.8): 1.0}, response=("y", 0.8))
    found, modes = history.ring_down(), MODEL.modes(1)
    assert modes.plane[0] == "y"
    natural = modes.frequency[0]
    assert found.frequency[0] == pytest.approx(natural, rel=1e-3)
    assert found.damping_ratio[0] == pytest.approx(modes.damping_ratio[0], rel=1e-2)


PUSH = {"drive": AT, "force": rd.Sine(1.0, 9.0)}


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        (PUSH | {"method": "modal"}, 'method must be "line" or "auto" for a rope on an axis'),
        (PUSH | {"modes": 4}, "modes must be left out for a rope on an axis"),
        (PUSH | {"partial": True}, "partial must be left out"),
        (PUSH | {"start": lambda x: x}, "start must be loads at points for a rope on an axis"),
        (PUSH | {"velocity": {"z": abs}}, "velocity must be loads at points"),
        ({"drive": ("z", 0.0), "force": rd.Step(1.0)}, r"drive must be free to move, got \('z', 0"),
        ({"drive": AT}, "give both drive and force, or neither"),
        ({"start": {AT: 1.0}}, "response must be given where nothing is driven"),
    ],
)
def test_what_is_not_carried_is_refused_by_name(asked, message):
    with pytest.raises(rd.SceneError, match=message):
        MODEL.transient(TIME[:41], **asked)


def test_acceleration_where_a_force_jumps_is_infinite(monkeypatch):
    monkeypatch.setattr(motion, "WORK", 1 << 15)
    with pytest.raises(rd.SceneError, match="which is infinite when what acts at"):
        MODEL.transient(TIME, drive=AT, force=rd.Step(1.0), quantity="acceleration")


def test_rates_go_no_further_than_their_parts_let(monkeypatch):
    """However many the times resolve: each takes as long as its parts."""
    monkeypatch.setattr(motion, "WORK", 0)
    noise = np.random.default_rng(2).normal(size=len(TIME))
    with pytest.raises(rd.SolveError, match=r"by the line at 2[56]\d rates"):
        MODEL.transient(TIME, drive=AT, force=noise, response=SEEN, quantity="acceleration")


def test_energy_and_losses_are_refused_by_name():
    history = MODEL.transient(TIME[:41], **PUSH)
    with pytest.raises(rd.SceneError, match="energy is not carried for a rope on an axis"):
        _ = history.energy
    lossy = ARCH.replace(damping=rd.LossFactor(0.01)).compile()
    with pytest.raises(rd.SceneError, match="to have a meaning in time, got loss factor"):
        lossy.transient(TIME[:41], **PUSH)


def test_compression_beyond_critical_does_not_rest():
    buckled = rd.Scene(ARC, ends=("pinned", "pinned"), planes="both", tension=-900.0).compile()
    with pytest.raises(rd.SolveError, match="the rope does not stay at rest"):
        buckled.transient(TIME[:11], start={AT: 1.0}, response=AT)


def test_stepped_sine_is_the_frequency_response():
    asked = {"drive": AT, "response": [SEEN], "quantity": "mobility"}
    stepped = MODEL.stepped_sine([12.0, 3.0], amplitude=2.0, **asked)
    np.testing.assert_array_equal(stepped.value, MODEL.frf([12.0, 3.0], **asked).value)
    assert stepped.stable.all()


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"branches": True}, "branches must be False for a rope on an axis"),
        ({"drive": [AT, SEEN]}, "drive must be one point, got 2"),
        ({"drive": ("z", 0.0)}, r"drive must be free to move, got \('z', 0"),
        ({"frequency": [0.0]}, r"frequency\[0\] must be a finite number > 0"),
        ({"amplitude": 0.0}, "amplitude must be a finite number > 0"),
    ],
)
def test_what_has_no_stepped_sine_is_refused_by_name(asked, message):
    given = {"frequency": [12.0], "drive": AT, "amplitude": 1.0} | asked
    with pytest.raises(rd.SceneError, match=message):
        MODEL.stepped_sine(given.pop("frequency"), **given)


def test_response_that_decays_is_that_at_a_complex_rate():
    """Motion e^(s t) of an arch with drag c is that without it at a shifted inertia."""
    value = MODEL.frf([3.0], drive=AT, response=[SEEN], decay=2.0).value
    s = 2j * np.pi * 3.0 + 2.0
    modes = MODEL.modes(80, points=400)
    at = [int(np.abs(modes.x - place).argmin()) for place in (AT[1], SEEN[1])]
    z = modes.coordinates.index("z")
    residue = modes.shape[:, at[0], z] * modes.shape[:, at[1], z] / modes.modal_mass
    summed = (residue / (s * s + s * DRAG / DENSITY + modes.eigenvalue)).sum()
    # modes beyond 80 were 3e-7 of it
    assert value[0, 0] == pytest.approx(summed, rel=1e-5)


def test_axis_is_priced_by_motion():
    question = rd.ask.motion(TIME[:81], drive=AT, force=rd.Sine(1.0, 9.0))
    table = rd.effect_cost(ARCH, question, repeat=1).table()
    straight = ARCH.without("axis").compile().transient(TIME[:81], **PUSH).value
    curved = MODEL.transient(TIME[:81], **PUSH).value
    change = 100 * np.abs(straight - curved).max() / np.abs(curved).max()
    largest = table.column("largest [%]")[table.column("left out").index("axis")]
    assert largest == pytest.approx(change, rel=1e-2)


def test_history_is_saved_and_a_scene_moves_from_the_command_line(tmp_path, capsys):
    history = MODEL.transient(TIME[:81], **PUSH)
    history.save(tmp_path / "motion.npz")
    np.testing.assert_array_equal(rd.load(tmp_path / "motion.npz").value, history.value)
    ARCH.save(tmp_path / "arch.toml")
    asked = ["--time", "0:0.06:81", "--drive", "z@0.5", "--force", "sine:1:9", "--csv"]
    assert main(["transient", str(tmp_path / "arch.toml"), *asked]) == 0
    rows = capsys.readouterr().out.splitlines()
    assert rows[0] == "time,z_at_0_500_m"
    found = np.array([float(row.split(",")[1]) for row in rows[1:]])
    assert found == pytest.approx(history.value[0], abs=1e-6 * np.abs(found).max())
