"""The command line about time: motion, stability, what is refused and how."""

import csv
import json

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.cli.command import main

TIME = np.linspace(0.0, 0.1, 21)
OPTIONS = ["--time", "0:0.1:21"]


@pytest.fixture
def scene_file(tmp_path):
    path = tmp_path / "rope.toml"
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0, torsional_stiffness=0.2, polar_inertia=1e-6)
    rd.Scene(rope, tension=100.0, damping=rd.RayleighDamping(1.0, 1e-6)).save(path)
    return path


@pytest.fixture
def pulsating_file(tmp_path):
    path = tmp_path / "pulsating.toml"
    tension = rd.Tension(100.0, amplitude=30.0, frequency=32.0)
    rd.Scene(rd.Rope(1.0, 0.1), tension=tension).save(path)
    return path


def printed(capsys):
    return json.loads(capsys.readouterr().out)


def model(path, **how):
    return rd.Scene.load(path).compile(**how)


FORCES = {
    "sine:3:20": rd.Sine(3.0, 20.0),
    "sine:3:20:0.5": rd.Sine(3.0, 20.0, phase=0.5),
    "step:3": rd.Step(3.0),
    "step:3:0.02": rd.Step(3.0, time=0.02),
    "impulse:0.01": rd.Impulse(0.01),
    "impulse:0.01:0.002": rd.Impulse(0.01, duration=0.002),
    "impulse:0.01:0.002:0.03": rd.Impulse(0.01, duration=0.002, time=0.03),
    "chirp:3:10:50:0.05": rd.Chirp(3.0, 10.0, 50.0, 0.05),
}


@pytest.mark.parametrize("text", FORCES)
def test_transient_prints_the_motion_of_the_model(scene_file, capsys, text):
    options = [*OPTIONS, "--elements", "8", "--drive", "z@0.5", "--force", text, "--json"]
    assert main(["transient", str(scene_file), *options]) == 0
    table = printed(capsys)
    history = model(scene_file, elements=8).transient(TIME, drive=("z", 0.5), force=FORCES[text])
    assert [row["time"] for row in table["rows"]] == TIME.tolist()
    assert [row["z_at_0_500_m"] for row in table["rows"]] == history.value[0].tolist()


def test_transient_sums_drives_and_watches_several_points(scene_file, capsys):
    options = ["--elements", "8", "--drive", "z@0.5", "--force", "step:3", "--drive", "end:0:z"]
    options += ["--force", "sine:1e-3:20", "--response", "beta@0.3", "--response", "z@0.7"]
    options += ["--quantity", "velocity", "--csv"]
    assert main(["transient", str(scene_file), *OPTIONS, *options]) == 0
    head, *rows = csv.reader(capsys.readouterr().out.splitlines())
    assert head == ["time", "beta_at_0_300_m", "z_at_0_700_m"]
    history = model(scene_file, elements=8).transient(
        TIME,
        drive=[("z", 0.5), ("end", 0, "z")],
        force=[rd.Step(3.0), rd.Sine(1e-3, 20.0)],
        response=[("beta", 0.3), ("z", 0.7)],
        quantity="velocity",
    )
    assert [[float(cell) for cell in row[1:]] for row in rows] == history.value.T.tolist()


def test_transient_lets_go_of_loads(scene_file, capsys):
    options = ["--elements", "8", "--start", "z@0.5=10", "--start", "alpha@0.3=-1e-3"]
    options += ["--response", "z@0.5", "--response", "alpha@0.3", "--json"]
    assert main(["transient", str(scene_file), *OPTIONS, *options]) == 0
    first = printed(capsys)["rows"][0]
    load = {("z", 0.5): 10.0, ("alpha", 0.3): -1e-3}
    history = model(scene_file, elements=8).transient(
        TIME, start=load, response=[("z", 0.5), ("alpha", 0.3)]
    )
    assert list(first.values())[1:] == history.value[:, 0].tolist()


@pytest.mark.parametrize("head", ["", "time [s],force [N]\n"])
def test_transient_takes_a_force_from_a_file(scene_file, tmp_path, capsys, head):
    force = np.sin(50 * TIME)
    lines = [f"{t!r},{f!r}\n" for t, f in zip(TIME.tolist(), force.tolist(), strict=True)]
    (tmp_path / "force.csv").write_text(head + "".join(lines))
    options = ["--elements", "8", "--drive", "z@0.5", "--force", str(tmp_path / "force.csv")]
    assert main(["transient", str(scene_file), *OPTIONS, *options, "--json"]) == 0
    found = [row["z_at_0_500_m"] for row in printed(capsys)["rows"]]
    history = model(scene_file, elements=8).transient(TIME, drive=("z", 0.5), force=force)
    assert found == history.value[0].tolist()


def test_transient_draws_and_says_how_far_it_is(scene_file, tmp_path, capsys):
    figure = tmp_path / "figure.png"
    options = ["--elements", "8", "--start", "z@0.5=10", "--response", "z@0.5"]
    options += ["--plot", str(figure), "--progress"]
    assert main(["transient", str(scene_file), *OPTIONS, *options]) == 0
    assert figure.read_bytes().startswith(b"\x89PNG")
    assert "100%" in capsys.readouterr().err


DRIVEN = [*OPTIONS, "--drive", "z@0.5", "--force"]


@pytest.mark.parametrize(
    ("options", "status", "words"),
    [
        (["--time", "0:1"], 2, "--time must be start:stop:count [s], got '0:1'"),
        (["--time", "0,x"], 2, "--time must be a comma list of numbers"),
        (["--time", "0,0.2,0.1", "--response", "z@0.5"], 2, "time must increase"),
        (OPTIONS, 2, "response must be given where nothing drives"),
        ([*OPTIONS, "--drive", "z@0.5"], 2, "--force must be given once for each of 1 --drive"),
        ([*OPTIONS, "--force", "step:1"], 2, "--force must be given once for each of 0 --drive"),
        ([*DRIVEN, "step:1", "--drive", "end:0"], 2, "got 1"),
        ([*OPTIONS, "--drive", "end:0", "--force", "step:1"], 2, "such as end:0:z, got 'end:0'"),
        ([*OPTIONS, "--drive", "end:2:z", "--force", "step:1"], 2, "whole number from 0 to 1"),
        ([*OPTIONS, "--drive", "z", "--force", "step:1"], 2, "--drive must be coordinate@position"),
        ([*DRIVEN, "sine:1"], 2, "--force must be sine:AMPLITUDE:FREQUENCY[:PHASE], got 'sine:1'"),
        ([*DRIVEN, "sine:1:2:3:4"], 2, "--force must be sine:AMPLITUDE:FREQUENCY[:PHASE]"),
        ([*DRIVEN, "sine:a:2"], 2, "--force must be sine:AMPLITUDE:FREQUENCY[:PHASE]"),
        ([*DRIVEN, "sine:1:-2"], 2, "frequency must be a finite number >= 0"),
        ([*DRIVEN, "hum:1"], 2, "--force must be one of sine, step, impulse, chirp with its"),
        ([*DRIVEN, "{}"], 2, "--force must be a file of"),
        ([*OPTIONS, "--start", "z@0.5"], 2, "--start must be point=load"),
        ([*OPTIONS, "--start", "z@0.5=heavy"], 2, "--start must be point=load"),
        ([*OPTIONS, "--start", "z=1"], 2, "--start must be coordinate@position"),
        ([*DRIVEN, "step:1", "--tolerance", "0"], 2, "tolerance must be a finite number > 0"),
    ],
)
def test_bad_motion_ends_with_a_message_and_a_status(scene_file, capsys, options, status, words):
    given = [option.format(scene_file) for option in options]
    assert main(["transient", str(scene_file), *given]) == status
    assert words in capsys.readouterr().err


def test_a_force_of_other_times_is_refused(scene_file, tmp_path, capsys):
    (tmp_path / "force.csv").write_text("1\n2\n3\n")
    options = [*DRIVEN, str(tmp_path / "force.csv")]
    assert main(["transient", str(scene_file), *options]) == 2
    assert "a line for each of 21 times, got 3" in capsys.readouterr().err


@pytest.mark.parametrize(
    "options",
    [
        [],
        ["--time", "0:1:3", "--method", "guess"],
        ["--time", "0:1:3", "--quantity", "mobility"],
        ["--time", "0:1:3", "--tolerance", "short"],
    ],
    ids=" ".join,
)
def test_motion_that_cannot_be_parsed_ends_with_status_2(scene_file, options, capsys):
    with pytest.raises(SystemExit) as stopped:
        main(["transient", str(scene_file), *options])
    assert stopped.value.code == 2


def test_modes_of_a_pulsating_tension_are_those_of_its_mean(pulsating_file, capsys):
    assert main(["modes", str(pulsating_file), "--modes", "2", "--json"]) == 0
    frequency = [row["frequency"] for row in printed(capsys)["rows"]]
    steady = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0)
    assert frequency == steady.compile().modes(2).frequency.tolist()


def test_frf_moves_an_end(scene_file, capsys):
    options = ["--frequency", "5,10", "--drive", "end:0:z", "--response", "z@0.5", "--json"]
    assert main(["frf", str(scene_file), *options]) == 0
    found = [row["amplitude_of_z_at_0_500_m"] for row in printed(capsys)["rows"]]
    frf = model(scene_file).frf([5.0, 10.0], drive=("end", 0, "z"), response=("z", 0.5))
    assert found == np.abs(frf.value[0]).tolist()


def test_floquet_prints_the_growth_of_the_model(pulsating_file, capsys):
    assert main(["floquet", str(pulsating_file), "--modes", "2", "--json"]) == 0
    floquet = model(pulsating_file).floquet(modes=2)
    assert printed(capsys) == json.loads(floquet.to_json())


def test_stability_prints_and_draws_where_motion_grows(pulsating_file, tmp_path, capsys):
    figure = tmp_path / "figure.png"
    options = ["--frequency", "20:40:9", "--amplitude", "0:40:3", "--modes", "2"]
    assert main(["stability", str(pulsating_file), *options, "--json", "--plot", str(figure)]) == 0
    chart = model(pulsating_file).stability_map(
        np.linspace(20, 40, 9), np.linspace(0, 40, 3), modes=2
    )
    assert printed(capsys) == json.loads(chart.to_json())
    assert figure.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["floquet", "{steady}"], "pulsat"),
        (["floquet", "{pulsating}", "--modes", "0"], "modes must be"),
        (["stability", "{pulsating}", "--frequency", "1:2", "--amplitude", "3"], "--frequency"),
        (["stability", "{pulsating}", "--frequency", "1,2", "--amplitude", "x"], "--amplitude"),
        (["stability", "{pulsating}", "--frequency", "2,1", "--amplitude", "3"], "frequency"),
    ],
)
def test_stability_without_meaning_is_refused(scene_file, pulsating_file, arguments, words, capsys):
    given = [a.format(steady=scene_file, pulsating=pulsating_file) for a in arguments]
    assert main(given) == 2
    assert words in capsys.readouterr().err
