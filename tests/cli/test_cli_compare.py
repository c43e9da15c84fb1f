"""The command that compares a scene with a measurement."""

import csv
import json

import numpy as np
import pytest
from dataset58 import function

import ropedyn as rd
from ropedyn.cli.command import main

SCENE = rd.Scene(
    rd.Rope(1.0, 0.1, bending_stiffness=0.02), tension=100.0, damping=rd.RayleighDamping(2.0, 0.0)
)
POINTS = (("z", 0.1), ("z", 0.35))
LINES = np.arange(5.0, 60.0, 0.1)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Hold the scene, and what was measured on one with another density."""
    folder = tmp_path_factory.mktemp("measured")
    SCENE.save(folder / "rope.toml")
    heavier = SCENE.replace(rope=SCENE.rope.replace(linear_density=0.11))
    frf = heavier.compile().frf(LINES, drive=POINTS[0], response=list(POINTS))
    measured = rd.Measured(LINES, frf.value, drive=POINTS[0], response=POINTS)
    measured.write(folder / "run.csv")
    measured.write(folder / "run.uff", binary=True)
    rows = np.column_stack([LINES, frf.value[0].real, frf.value[0].imag])
    np.savetxt(folder / "bare.csv", rows, delimiter=",", fmt="%.17g")
    return folder


def run(folder, *arguments):
    return main(["compare", str(folder / "rope.toml"), *map(str, arguments)])


def expected(folder, **given):
    model = rd.Scene.load(folder / "rope.toml").compile()
    return rd.compare(model, rd.Measured.read(folder / "run.csv"), **given)


@pytest.mark.parametrize("name", ["run.csv", "run.uff"])
def test_a_file_is_compared_as_a_whole(folder, capsys, name):
    assert run(folder, "--measured", folder / name, "--band", 5, "--json") == 0
    printed = json.loads(capsys.readouterr().out)
    comparison = expected(folder, band=5.0)
    assert printed == json.loads(comparison.to_json())
    assert comparison.order.tolist() == [1, 2, 3]


def test_text_says_the_pairs_and_the_likeness(folder, capsys):
    assert run(folder, "--measured", folder / "run.csv") == 0
    out = capsys.readouterr().out
    assert out == expected(folder).report() + "\n"
    assert "\nFRAC of z at 0.100 m [m/N]: 0." in out


def test_text_says_the_cause_that_is_proved(folder, capsys):
    heavier = SCENE.replace(rope=SCENE.rope.replace(linear_density=0.11))
    peaks = ",".join(map(repr, heavier.compile().modes(5).frequency.tolist()))
    assert run(folder, "--peaks", peaks, "--std", "0.001") == 0
    last = capsys.readouterr().out.splitlines()[-1]
    assert last.startswith("All shifts are alike within their uncertainty")
    assert "linear_density 1.1 times the scene's" in last


def test_a_bare_table_of_numbers_is_told_what_it_is(folder, capsys):
    options = ["--column", "frequency=0", "--column", "real=1", "--column", "imag=2"]
    options += ["--drive", "z@0.1", "--response", "z@0.1", "--unit", "m/N", "--csv"]
    assert run(folder, "--measured", folder / "bare.csv", *options) == 0
    rows = list(csv.DictReader(capsys.readouterr().out.splitlines()))
    measured = rd.Measured.read(
        folder / "bare.csv",
        columns={"frequency": 0, "real": 1, "imag": 2},
        drive=("z", 0.1),
        response=("z", 0.1),
        unit="m/N",
    )
    comparison = rd.compare(SCENE.compile(), measured)
    assert [float(row["measured"]) for row in rows] == comparison.measured.tolist()
    assert [row["mode"] for row in rows] == ["1", "2", "3"]


def test_nodes_and_directions_of_another_program_are_told_where_they_are(folder, tmp_path, capsys):
    measured = rd.Measured.read(folder / "run.csv")
    # a hammer at nodes 7 and 9, the motion of node 7
    texts = [
        function(row, response=(7, 3), drive=(node, 3), kinds=(8, 13), uneven=measured.frequency)
        for node, row in zip((7, 9), measured.value)
    ]
    (tmp_path / "hammer.uff").write_text("".join(texts))
    options = ["--position", "7=0.1", "--position", "9=0.35", "--coordinate", "Z=z"]
    options += ["--reciprocal", "--unit", "m/N", "--json"]
    assert run(folder, "--measured", tmp_path / "hammer.uff", *options) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    # the file has 12 digits of values and 6 of frequencies
    found = [row["measured"] for row in rows]
    assert found == pytest.approx(expected(folder).measured.tolist(), rel=1e-6)


def test_peaks_have_uncertainties_and_orders(folder, capsys):
    options = ["--peaks", "15,30", "--std", "0.1,0.2", "--order", "2,1", "--json"]
    assert run(folder, *options) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert [row["mode"] for row in rows] == [2, 1]
    assert [row["std"] for row in rows] == [0.1, 0.2]


def test_pairs_are_no_farther_apart_than_is_said(folder, capsys):
    f = SCENE.compile().modes(2).frequency * [1.01, 1.1]
    options = ["--peaks", f"{f[0]},{f[1]}", "--within", "0.05", "--json"]
    assert run(folder, *options) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert [row["mode"] for row in rows] == [1, None]


def test_so_many_modes_are_compared(folder, capsys):
    assert run(folder, "--peaks", "16,32,49", "--modes", "2", "--json") == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert [row["mode"] for row in rows] == [1, 2, None]


def test_a_file_is_drawn(folder, tmp_path, capsys):
    figure = tmp_path / "overlay.png"
    assert run(folder, "--measured", folder / "run.csv", "--plot", figure) == 0
    assert figure.read_bytes().startswith(b"\x89PNG")
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--peaks", "a"], "--peaks must be a comma list of numbers"),
        (["--peaks", "16", "--std", "b"], "--std must be a comma list of numbers"),
        (["--peaks", "16", "--std", "1,2"], "std must be one number or 1"),
        (["--peaks", "16", "--order", "1.5"], "--order must be a comma list of whole numbers"),
        (["--peaks", "16", "--band", "5"], "--measured must be given with --band"),
        (["--peaks", "16", "--reciprocal"], "--measured must be given with --reciprocal"),
        (["--peaks", "16", "--within", "0"], "within must be"),
        (["--measured", "nowhere.csv"], "nowhere.csv"),
        (["--measured", "run.csv", "--std", "1"], "--peaks must be given with --std"),
        (["--measured", "run.csv", "--order", "1"], "--peaks must be given with --order"),
        (["--measured", "run.csv", "--drive", "z"], "--drive must be"),
        (["--measured", "run.csv", "--response", "0.5"], "--response must be"),
        (["--measured", "run.uff", "--position", "1"], "--position must be two words with ="),
        (["--measured", "run.uff", "--position", "a=1"], "--position must be NODE=X"),
        (["--measured", "run.uff", "--coordinate", "=z"], "--coordinate must be two words"),
        (["--measured", "run.csv", "--column", "real"], "--column must be two words with ="),
        (["--measured", "run.csv", "--band", "-1"], "band must be"),
    ],
)
def test_bad_input_is_named(folder, capsys, monkeypatch, arguments, words):
    monkeypatch.chdir(folder)
    assert run(folder, *arguments) == 2
    assert words in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments", [[], ["--peaks", "1", "--measured", "run.csv"], ["--measured", "a", "--unit"]]
)
def test_peaks_or_a_file_must_be_given(folder, capsys, arguments):
    with pytest.raises(SystemExit) as stopped:
        run(folder, *arguments)
    assert stopped.value.code == 2
