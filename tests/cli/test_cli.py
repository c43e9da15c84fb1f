"""The command line: output, exit status, messages."""

import csv
import json
import subprocess
import sys
from importlib import metadata

import numpy as np
import pytest

import ropedyn as rd
from ropedyn.cli.command import main
from ropedyn.eigen.free_motion import FreeMotion


@pytest.fixture
def scene_file(tmp_path):
    path = tmp_path / "rope.toml"
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0, torsional_stiffness=0.2, polar_inertia=1e-6)
    rd.Scene(rope, tension=100.0, damping=rd.StiffnessDamping(1e-4)).save(path)
    return path


def model(path, **how):
    return rd.Scene.load(path).compile(**how)


def test_modes_prints_the_frequencies_of_the_model(scene_file, capsys):
    assert main(["modes", str(scene_file), "--modes", "3", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    frequency = [row["frequency"] for row in rows]
    assert frequency == model(scene_file).modes(3).frequency.tolist()


def test_damped_modes_are_those_of_the_model(tmp_path, capsys):
    path = tmp_path / "damped.toml"
    rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, parts=[rd.Dashpot(0.2, 1.0)]).save(path)
    assert main(["modes", str(path), "--modes", "3", "--damped", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    ratio = [row["damping_ratio"] for row in rows]
    assert ratio == model(path).modes(3, damped=True).damping_ratio.tolist()


@pytest.mark.parametrize(
    ("options", "how"),
    [
        (["--elements", "12"], {"elements": 12}),
        (["--elements", "12", "--element", "rigid"], {"elements": 12, "element": "rigid"}),
        (["--element", "continuous"], {"element": "continuous"}),
    ],
)
def test_elements_are_those_of_compile(scene_file, capsys, options, how):
    assert main(["modes", str(scene_file), "--modes", "3", "--json", *options]) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    frequency = [row["frequency"] for row in rows]
    assert frequency == model(scene_file, **how).modes(3).frequency.tolist()


def test_modes_prints_a_table_by_default(scene_file, capsys):
    assert main(["modes", str(scene_file), "--modes", "2", "--elements", "8"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("natural frequencies\n")
    assert len(out.splitlines()) == 5


def test_frf_prints_every_line_as_csv(scene_file, capsys):
    arguments = ["--frequency", "1:100:5", "--drive", "z@0.3", "--response", "beta@0.6", "--csv"]
    assert main(["frf", str(scene_file), *arguments]) == 0
    rows = capsys.readouterr().out.splitlines()
    assert rows[0].startswith("frequency,amplitude_of_beta_at_0_600_m,phase")
    printed = np.array([float(row.split(",")[1]) for row in rows[1:]])
    frf = model(scene_file).frf(np.linspace(1, 100, 5), drive=("z", 0.3), response=("beta", 0.6))
    assert printed.tolist() == np.abs(frf.value[0]).tolist()


def test_frf_takes_the_second_plane(tmp_path, capsys):
    rope = rd.Rope(2.0, 0.1, bending_stiffness=(2.0, 1.0))
    scene = rd.Scene(rope, tension=1000.0, planes="both")
    scene.save(tmp_path / "both.toml")
    arguments = ["--frequency", "1:100:5", "--drive", "y@0.3", "--response", "gamma@0.6", "--csv"]
    assert main(["frf", str(tmp_path / "both.toml"), *arguments]) == 0
    rows = capsys.readouterr().out.splitlines()
    assert rows[0].startswith("frequency,amplitude_of_gamma_at_0_600_m,phase")
    printed = np.array([float(row.split(",")[1]) for row in rows[1:]])
    lines = np.linspace(1, 100, 5)
    frf = scene.compile().frf(lines, drive=("y", 0.3), response=("gamma", 0.6))
    assert printed.tolist() == np.abs(frf.value[0]).tolist()


def test_compare_pairs_the_peaks(scene_file, capsys):
    assert main(["compare", str(scene_file), "--peaks", "20,41", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert [row["mode"] for row in rows] == [1, 2]
    assert [row["measured"] for row in rows] == [20.0, 41.0]


ACCURACY = ["--elements", "16,32"]


QUESTIONS = [
    ([], rd.ask.modes(10)),
    (["--modes", "3"], rd.ask.modes(3)),
    (["--below", "100"], rd.ask.modes(below=100.0)),
    (
        ["--frequency", "10:90:5", "--drive", "z@0.3", "--response", "beta@0.6"],
        rd.ask.frf(np.linspace(10, 90, 5), drive=("z", 0.3), response=("beta", 0.6)),
    ),
]


def column_of(printed, heading):
    """Return a column of a printed table by what the text calls it."""
    headings = [
        f"{c['name']} [{c['unit']}]" if c["unit"] else c["name"] for c in printed["columns"]
    ]
    key = printed["columns"][headings.index(heading)]["key"]
    return [row[key] for row in printed["rows"]]


@pytest.mark.parametrize(("options", "question"), QUESTIONS)
def test_accuracy_prints_the_errors_of_every_way(scene_file, capsys, options, question):
    assert main(["accuracy", str(scene_file), *ACCURACY, *options, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    scene = rd.Scene.load(scene_file)
    cost = rd.accuracy_cost(scene, question, elements=[16, 32], repeat=1)
    # the verdict stands first; its times are those of another run
    verdict, about = printed["title"].split("\n\n")
    assert verdict.startswith("For a relative error of ")
    assert about == cost.table().title.split("\n\n")[1]
    for column in ("element", "elements", "solver", "true error", "estimated error"):
        assert column_of(printed, column) == list(cost.table().column(column))


def test_accuracy_of_damped_modes_begins_with_what_to_take(scene_file, capsys):
    assert main(["accuracy", str(scene_file), "--modes", "2", "--damped", "--elements", "16"]) == 0
    verdict, blank, about = capsys.readouterr().out.splitlines()[:3]
    assert verdict.startswith("For a relative error of ")
    assert (blank, about[:15]) == ("", "2 damped modes:")
    lines = ["--damped", "--frequency", "5", "--drive", "z@0.3"]
    assert main(["accuracy", str(scene_file), *lines]) == 2
    assert "--damped must be given with modes" in capsys.readouterr().err


def test_accuracy_takes_some_elements_and_solvers(scene_file, capsys):
    options = ["--elements", "16,32", "--element", "tensed,continuous", "--solver", "sweep"]
    assert main(["accuracy", str(scene_file), *options, "--modes", "2", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    ways = [(row["element"], row["elements"], row["solver"]) for row in rows]
    assert ways == [("tensed", 16, "sweep"), ("tensed", 32, "sweep"), ("continuous", 1, "sweep")]


def test_accuracy_prints_refused_rows_and_marks(scene_file, capsys):
    assert main(["accuracy", str(scene_file), "--elements", "4,64", "--csv"]) == 0
    head, *rows = csv.reader(capsys.readouterr().out.splitlines())
    assert head[-2:] == ["cheapest_for", "refused"]
    assert len(rows) == 2 * 2 * 2 + 1
    # three nodes move, in z and in twist
    assert rows[0][:-1] == ["rigid", "4", "sweep", *[""] * 9]
    assert rows[0][-1] == "number must be at most 6, the modes this model has, got 10"
    assert [row[0] for row in rows if "1e-12" in row[-2]] == ["continuous"]


@pytest.mark.parametrize(("options", "question"), QUESTIONS)
@pytest.mark.parametrize("how", [{}, {"elements": 16}, {"elements": 16, "element": "rigid"}])
def test_effects_prints_what_each_changes(scene_file, capsys, options, question, how):
    compiled = [text for name, value in how.items() for text in (f"--{name}", str(value))]
    assert main(["effects", str(scene_file), *compiled, *options, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    table = rd.effect_cost(rd.Scene.load(scene_file), question, repeat=1, **how).table()
    assert printed["title"] == table.title
    for column in ("left out", "changes the answer", "unknowns", *question.measures):
        assert column_of(printed, column) == list(table.column(column))


def test_effects_prints_refused_rows(scene_file, capsys):
    options = ["--frequency", "20", "--drive", "beta@0.3", "--csv"]
    assert main(["effects", str(scene_file), *options]) == 0
    head, *rows = csv.reader(capsys.readouterr().out.splitlines())
    refused = {row[0]: row[-1] for row in rows}
    assert head[-1] == "refused"
    assert list(refused) == ["nothing", *rd.Scene.load(scene_file).effects]
    assert [name for name, reason in refused.items() if reason] == ["bending"]


@pytest.mark.parametrize(
    "command",
    [
        ["modes", "--modes", "3"],
        ["effects", "--modes", "3"],
        ["accuracy", "--modes", "3", *ACCURACY],
        ["frf", "--frequency", "1:100:50", "--drive", "z@0.5"],
        ["compare", "--peaks", "20,41"],
    ],
)
def test_plot_writes_a_figure(scene_file, tmp_path, capsys, command):
    figure = tmp_path / "figure.png"
    name, *rest = command
    assert main([name, str(scene_file), *rest, "--plot", str(figure)]) == 0
    assert figure.read_bytes().startswith(b"\x89PNG")
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("damped", [[], ["--damped"]])
def test_animate_writes_a_mode_in_motion(scene_file, tmp_path, capsys, monkeypatch, damped):
    monkeypatch.setitem(FreeMotion.animate.__kwdefaults__, "frames", 2)
    file = tmp_path / "mode.gif"
    options = ["--modes", "2", "--elements", "8", "--animate", str(file), "--mode", "2", *damped]
    assert main(["modes", str(scene_file), *options]) == 0
    assert file.read_bytes().startswith(b"GIF89a")
    assert "frequency [Hz]" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "status", "words"),
    [
        (["modes", "nowhere.toml"], 2, "nowhere.toml"),
        (["modes", "{}", "--elements", "0"], 2, "elements must be"),
        (["modes", "{}", "--elements", "2", "--modes", "99"], 1, "--modes must be at most"),
        (["frf", "{}", "--frequency", "1:2", "--drive", "z@0.5"], 2, "--frequency"),
        (["frf", "{}", "--frequency", "5", "--drive", "z0.5"], 2, "--drive"),
        (["frf", "{}", "--frequency", "5", "--drive", "q@0.5"], 2, "--drive must be"),
        (["frf", "{}", "--frequency", "-5", "--drive", "z@0.5"], 2, "--frequency must be"),
        (["compare", "{}", "--peaks", "a"], 2, "--peaks"),
        (["modes", "{}", "--plot", "/nowhere/figure.png"], 2, "nowhere"),
        (["modes", "{}", "--animate", "mode.png"], 2, "path must end in .gif, .html, .mp4"),
        (["modes", "{}", "--mode", "2"], 2, "--animate must be given with --mode"),
        (["modes", "{}", "--mode", "0", "--animate", "mode.gif"], 2, "--mode must be"),
        (["modes", "{}", "--element", "rigid"], 2, "elements must be given"),
        (["accuracy", "nowhere.toml"], 2, "nowhere.toml"),
        (["accuracy", "{}", "--elements", "16,x"], 2, "--elements"),
        (["accuracy", "{}", "--elements", "0"], 2, "--elements must be"),
        (["accuracy", "{}", "--element", "cubic"], 2, "--element must be"),
        (["accuracy", "{}", "--solver", "sweep,"], 2, "--solver must be"),
        (["accuracy", "{}", "--modes", "0"], 2, "--modes must be"),
        (["accuracy", "{}", "--below", "0.5"], 2, "question must have an answer"),
        (["accuracy", "{}", "--below", "-1"], 2, "below must be"),
        (["accuracy", "{}", "--frequency", "5"], 2, "--drive must be given"),
        (["accuracy", "{}", "--drive", "z@0.5"], 2, "--frequency must be given"),
        (["accuracy", "{}", "--response", "z@0.5"], 2, "--frequency must be given"),
        (["accuracy", "{}", "--frequency", "5", "--drive", "q@0.5"], 2, "--drive must be"),
        (["effects", "nowhere.toml"], 2, "nowhere.toml"),
        (["effects", "{}", "--elements", "0"], 2, "elements must be"),
        (["effects", "{}", "--element", "rigid"], 2, "elements must be given"),
        (["effects", "{}", "--elements", "2"], 1, "--modes must be at most"),
        (["effects", "{}", "--below", "0.5"], 2, "question must have an answer"),
        (["effects", "{}", "--frequency", "5"], 2, "--drive must be given"),
    ],
)
def test_bad_input_ends_with_a_message_and_a_status(scene_file, capsys, arguments, status, words):
    given = [argument.format(scene_file) for argument in arguments]
    assert main(given) == status
    assert words in capsys.readouterr().err


def test_accuracy_that_continuous_spans_refuse_ends_with_status_1(tmp_path, capsys):
    path = tmp_path / "free.toml"
    rope = rd.Rope(1.0, 0.1, bending_stiffness=1.0)
    rd.Scene(rope, ends=("free", "free")).save(path)
    assert main(["accuracy", str(path), "--frequency", "0", "--drive", "z@0.5"]) == 1
    assert "resonance" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments",
    [
        ["sing"],
        ["accuracy", "rope.toml", "--modes", "3", "--below", "100"],
        ["accuracy", "rope.toml", "--modes", "3", "--frequency", "5"],
        ["modes", "rope.toml", "--element", "cubic"],
    ],
    ids=" ".join,
)
def test_what_cannot_be_parsed_ends_with_status_2(arguments, capsys):
    with pytest.raises(SystemExit) as stopped:
        main(arguments)
    assert stopped.value.code == 2


def test_study_command_prints_and_draws(tmp_path, capsys):
    assert main(["study", "--folder", str(tmp_path / "study")]) == 0
    out = capsys.readouterr().out
    assert "69.40    136.13  197.64" in out
    assert len(list((tmp_path / "study").glob("*.png"))) == 5


def test_module_is_the_command_line(tmp_path):
    run = subprocess.run(
        [sys.executable, "-m", "ropedyn", "modes", "missing.toml"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 2
    assert "missing.toml" in run.stderr


def test_version_is_that_of_the_package(capsys):
    with pytest.raises(SystemExit) as left:
        main(["--version"])
    assert left.value.code == 0
    assert capsys.readouterr().out == f"ropedyn {metadata.version('ropedyn')}\n"


def test_a_reader_that_has_seen_enough_is_left_quietly(scene_file):
    frequency = ["--frequency", "10:400:20000", "--drive", "z@0.5", "--csv"]
    command = [sys.executable, "-m", "ropedyn", "frf", str(scene_file), *frequency]
    running = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    with running:
        assert running.stdout.readline().startswith(b"frequency")
        running.stdout.close()
        complaint = running.stderr.read()
    assert (running.returncode, complaint) == (0, b"")


def test_a_spring_from_a_file(tmp_path, capsys):
    axis = rd.Axis.helix(5e-3, 0.15, 10)
    wire = rd.Rope(axis, 6.2e-3, bending_stiffness=0.0101, torsional_stiffness=0.0078)
    scene, path = rd.Scene(wire, planes="both"), tmp_path / "spring.toml"
    scene.save(path)
    assert main(["modes", str(path), "--modes", "3", "--json"]) == 0
    found = [row["frequency"] for row in json.loads(capsys.readouterr().out)["rows"]]
    assert found == scene.compile().modes(3).frequency.tolist()
    assert main(["frf", str(path), "--frequency", "10:40:3", "--drive", "y@0.1", "--json"]) == 0
    assert len(json.loads(capsys.readouterr().out)["rows"]) == 3
    figure = tmp_path / "spring.png"
    assert main(["modes", str(path), "--modes", "1", "--plot", str(figure)]) == 0
    assert figure.stat().st_size > 0
