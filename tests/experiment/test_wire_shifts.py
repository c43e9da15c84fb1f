"""Shifts by broken wires: what the figure draws, against first order and against its own model."""

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.cli.command import main

LENGTH, TENSION = 1.35, 2000.0
ROPE = rd.Rope.from_construction(LENGTH, rd.Construction.standard("7x7", diameter=4e-3))
SCENE = rd.Scene(ROPE, tension=TENSION)
PLACES = [0.0, 0.3, 0.5, LENGTH - 0.3, LENGTH]


@pytest.fixture(scope="module")
def shifts():
    return rd.broken_wire_shifts(SCENE, friction=0.2, places=PLACES, std=0.02)


def test_shifts_are_those_of_the_rope_with_the_change(shifts):
    change = rd.LocalChange.of_broken_wires(ROPE, 0.5, 2, friction=0.2)
    after = SCENE.replace(parts=[change]).compile().modes(5)
    assert shifts.n.tolist() == [1, 2, 4]
    assert shifts.frequency == pytest.approx(SCENE.compile().modes(5).frequency, rel=1e-14)
    error = shifts.shift[1, :, 2] - (after.frequency - shifts.frequency)
    # another number of modes is refined from other starts, to the rounding of both
    assert (np.abs(error) <= 2 * after.rounding_bound).all()


def test_a_break_is_felt_alike_from_both_ends(shifts):
    # rounding of two frequencies of some 300 Hz
    assert shifts.shift[..., :2] == pytest.approx(shifts.shift[..., :2:-1], abs=1e-9)


def test_torsion_feels_a_break_as_its_wave_does(shifts):
    """First order: the lost part of the coupled section in the wave's own strain, cos^2 along."""
    section, broken = ROPE.section, ROPE.section.without(1)

    def K(one):
        EA, D, C = one.axial_stiffness, one.lay_coupling, one.torsional_stiffness
        return np.array([[EA, D], [D, C]])

    M = np.diag([section.mass, section.polar_inertia])
    speed2, waves = np.linalg.eig(np.linalg.solve(M, K(section)))
    wave = waves[:, speed2.argmin()]
    lost = wave @ (K(section) - K(broken)) @ wave / (wave @ K(section) @ wave)
    k = shifts.family.tolist().index("torsional")
    half = section.recovery(friction=0.2)
    for p, x in ((1, 0.3), (2, 0.5)):
        s, e = x - half, x + half
        k1 = 2 * np.pi / LENGTH
        felt = (e - s + (np.sin(k1 * e) - np.sin(k1 * s)) / k1) / LENGTH
        # what is of second order in a loss of 2 % over 6 % of the rope
        expected = -0.5 * lost * felt * shifts.frequency[k]
        assert shifts.shift[0, k, p] == pytest.approx(expected, rel=0.05)


def test_more_wires_shift_more_and_none_raises_a_frequency(shifts):
    assert (np.diff(shifts.shift, axis=0) < 0).all()
    assert (shifts.shift < 0).all()


def test_fallen_wires_raise_transverse_frequencies():
    gone = rd.broken_wire_shifts(SCENE, 4, friction=0.2, places=[LENGTH / 2], modes=1, fallen=True)
    assert gone.shift[0, 0, 0] > 0


def test_what_is_told_is_two_measurements_apart(shifts):
    assert shifts.least == pytest.approx([1.96 * np.sqrt(2) * 0.02] * 5, rel=1e-14)
    table = shifts.table()
    told = (np.abs(shifts.shift[2]) >= shifts.least[:, None]).mean(axis=1)
    assert table.column("4, told at [%]") == tuple(np.round(100 * told))
    assert table.column("1 broken [Hz]") == tuple(np.abs(shifts.shift[0]).max(axis=1))


def test_a_difference_of_two_measurements_is_called_told_one_time_in_twenty():
    """By chance: frequencies that have not changed, seed 3."""
    found = rd.broken_wire_shifts(SCENE, 1, friction=0.2, places=[0.5], modes=1, std=0.02)
    before, after = np.random.default_rng(3).normal(0.0, 0.02, (2, 100_000))
    share = (np.abs(after - before) > found.least[0]).mean()
    # three standard deviations of a share of 5 % in 10^5
    assert share == pytest.approx(0.05, abs=3 * np.sqrt(0.05 * 0.95 / 1e5))


def test_a_plan_and_peaks_say_how_well_frequencies_are_read():
    damped = SCENE.replace(damping=rd.ModalDamping(0.002))
    plan = rd.plan_measurement(damped, 2)
    given = {"friction": 0.2, "places": [0.5], "modes": 2}
    by_plan = rd.broken_wire_shifts(damped, 1, std=plan, **given)
    assert by_plan.std == pytest.approx([plan.line_spacing / np.sqrt(12)] * 2, rel=1e-15)
    peaks = rd.Peaks([68.0, 137.0], std=[0.1, 0.2], order=[1, 2])
    assert rd.broken_wire_shifts(SCENE, 1, std=peaks.std, **given).std.tolist() == [0.1, 0.2]
    unknown = rd.broken_wire_shifts(SCENE, 1, **given)
    assert np.isnan(unknown.least).all()
    assert unknown.table().column("1, told at [%]") == (0.0, 0.0)


def test_the_figure_draws_every_mode_and_count_and_what_is_told(shifts, tmp_path):
    lines = shifts.plot().lines
    assert len(lines) == 5 * (3 + 1)
    drawn = lines[1]
    expected = 100 * np.abs(shifts.shift[1, 0]) / shifts.frequency[0]
    assert np.asarray(drawn.get_ydata()) == pytest.approx(expected, rel=1e-15)
    assert lines[3].get_ydata()[0] == pytest.approx(100 * shifts.least[0] / shifts.frequency[0])
    shifts.save(tmp_path / "shifts.nc")
    assert (rd.load(tmp_path / "shifts.nc").shift == shifts.shift).all()


@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        ({"n": 0}, rd.SceneError, r"n\[0\] must be"),
        ({"n": 1.5}, TypeError, "n must be whole numbers"),
        ({"n": 9}, rd.SceneError, "n must be"),
        ({"modes": 0}, rd.SceneError, "modes must be"),
        ({"places": [2.0]}, rd.SceneError, r"places\[0\] must lie"),
        ({"std": 0.0}, rd.SceneError, r"std\[0\] must be"),
        ({"std": [0.1, 0.1]}, rd.SceneError, "std must be one number or 1, got"),
        ({"friction": 0.0}, rd.SceneError, "friction must be"),
        ({"scene": rd.Scene(rd.Rope(1.0, 0.1), tension=1.0)}, rd.SceneError, "construction"),
        ({"scene": ROPE}, TypeError, "scene must be a Scene"),
    ],
)
def test_what_has_no_meaning_is_refused(change, error, message):
    given = {"scene": SCENE, "n": 1, "friction": 0.2, "places": [0.5], "modes": 1} | change
    with pytest.raises(error, match=message):
        rd.broken_wire_shifts(given.pop("scene"), given.pop("n"), **given)


LINE = ["section", "7x7", "--diameter", "4e-3"]


def test_the_command_prints_and_draws_shifts(tmp_path, capsys):
    rig = ["--length", "1.35", "--tension", "2000", "--modes", "1", "--std", "0.02"]
    figure = ["--plot", str(tmp_path / "shifts.png")]
    assert main([*LINE, "--broken", "1,4", *rig, *figure]) == 0
    found = rd.broken_wire_shifts(SCENE, [1, 4], friction=0.2, modes=1, std=0.02)
    assert capsys.readouterr().out.strip() == found.table().to_text()
    assert (tmp_path / "shifts.png").stat().st_size > 10_000


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--broken", "1"], "--length must be given with --broken"),
        (["--tension", "10"], "--broken must be given with --tension"),
    ],
)
def test_the_command_refuses_half_a_question(options, message, capsys):
    assert main([*LINE, *options]) == 2
    assert message in capsys.readouterr().err
