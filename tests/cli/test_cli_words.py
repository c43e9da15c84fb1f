"""What the command line says where something is wrong, and of how far it is."""

import io
import json
import re
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from dataset58 import function

import ropedyn as rd
from ropedyn.base import progress
from ropedyn.cli.command import main


@pytest.fixture
def scene_file(tmp_path):
    path = tmp_path / "rope.toml"
    rd.Scene(rd.Rope(2.0, 0.1, bending_stiffness=1.0), tension=1000.0).save(path)
    return path


WRONG = {
    "--modes must be a whole number from 1": ["modes", "--modes", "0"],
    "--elements must be": ["modes", "--elements", "0"],
    "--drive must lie on the rope": ["frf", "--frequency", "1:9:3", "--drive", "z@99"],
    "--frequency must be a finite number >= 0": ["frf", "--frequency=-1,2", "--drive", "z@1"],
    "--std must be": ["compare", "--peaks", "20,40", "--std=-1"],
    "leave --std out": ["tension", "--peaks", "20,40", "--std", "0"],
    "--peaks must have at least": ["tension", "--peaks", "20"],
    "--unknown: path must be": ["tension", "--peaks", "20,40", "--unknown", "foo"],
    "--model-std must be": ["tension", "--peaks", "20,40", "--model-std=-1"],
    "tension = { mean = 1000.0, amplitude = 100.0, frequency = 50.0 }": ["floquet"],
    "--plot must be a file that ends in one of .": ["modes", "--plot", "figure.xyz"],
}


@pytest.mark.parametrize("words", WRONG)
def test_errors_speak_of_options(words, scene_file, capsys):
    command, *arguments = WRONG[words]
    assert main([command, str(scene_file), *arguments]) == 2
    assert words in capsys.readouterr().err


def test_a_scene_file_that_is_wrong_is_named_by_its_keys(tmp_path, capsys):
    (tmp_path / "rope.toml").write_text("tension = 1.0\nends = 3\n[rope]\nlength = 1.0\n")
    assert main(["tension", str(tmp_path / "rope.toml"), "--peaks", "1,2"]) == 2
    assert "key rope.linear_density is missing" in capsys.readouterr().err


def test_a_file_that_is_not_there_is_named(capsys):
    assert main(["modes", "nothing.toml"]) == 2
    assert capsys.readouterr().err == "ropedyn: nothing.toml: No such file or directory\n"


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_long_work_says_how_far_it_is_on_a_terminal_alone(monkeypatch):
    assert progress.on_terminal() is None
    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    say = progress.on_terminal()
    say(0.2)
    say(1.0)
    assert terminal.getvalue() == ""
    began = time.monotonic()
    monkeypatch.setattr(time, "monotonic", lambda: began + 2 * progress.PATIENCE)
    say(0.5)
    say(1.0)
    assert terminal.getvalue() == "\r 50%\r100%\n"


PEAKS = {
    "a line each": "24.1\n48.6\n73.6\n",
    "with std": "# Hz\n24.1 0.1\n48.6 0.1\n\n73.6 0.1\n",
    "named": "std,frequency,kind\n0.1,24.1,mode\n0.1,48.6,mode\n0.1,73.6,mode\n",
    "a comma list": "24.1, 48.6, 73.6\n",
}


@pytest.mark.parametrize("way", ["file", "standard input"])
@pytest.mark.parametrize("text", PEAKS)
def test_peaks_come_from_a_file_or_the_standard_input(text, way, tmp_path, monkeypatch, capsys):
    file = tmp_path / "peaks.txt"
    file.write_text(PEAKS[text], encoding="utf-8")
    monkeypatch.setattr(sys, "stdin", io.StringIO(PEAKS[text]))
    rd.Scene(rd.Rope(2.0, 0.1), tension=900.0).save(tmp_path / "rope.toml")
    given = "-" if way == "standard input" else str(file)
    assert main(["compare", str(tmp_path / "rope.toml"), "--peaks", given, "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert [row["measured"] for row in rows] == [24.1, 48.6, 73.6]
    has_std = text in ("with std", "named")
    assert [row.get("std") for row in rows] == [0.1 if has_std else None] * 3


@pytest.mark.parametrize(
    "text", ["", "1 2 3\n4 5 6\n", "24.1 0.1\n48.6\n", "a b\n1 2\n", "24.1\nx\n"]
)
def test_a_file_that_has_no_peaks_is_refused(text, tmp_path, capsys):
    file = tmp_path / "peaks.txt"
    file.write_text(text, encoding="utf-8")
    rd.Scene(rd.Rope(2.0, 0.1), tension=900.0).save(tmp_path / "rope.toml")
    assert main(["tension", str(tmp_path / "rope.toml"), "--peaks", str(file)]) == 2
    assert capsys.readouterr().err.startswith("ropedyn: --peaks must be a file ")


def test_all_questions_of_a_universal_file_are_asked_at_once(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    rd.Scene(rd.Rope(2.0, 0.1), tension=900.0).save("rope.toml")
    lines = np.linspace(1.0, 9.0, 5)
    text = function(np.ones(5, complex), kinds=(8, 13), response=(7, 3), drive=(9, 3), uneven=lines)
    Path("run.uff").write_text(text, encoding="ascii")
    assert main(["compare", "rope.toml", "--measured", "run.uff"]) == 2
    said = capsys.readouterr().err
    asked = ["--position must be .* such as 7=0.5, got none", "--coordinate must .* Z=z, got none"]
    assert re.search("\nropedyn: ".join([*asked, "--unit must be stated, such as"]), said)
    assert "{" not in said


ASKED = {
    "compare --measured run.csv": ["column", "drive", "response", "unit"],
    "identify --measured run.csv --unit m/N": ["column", "drive", "response"],
    "compare --measured run.csv --column frequency=f --unit m/N": ["column", "drive", "response"],
    "tension run.csv": ["time", "channel or --sensors"],
    "tension run.csv --rate 100": ["channel or --sensors"],
}


@pytest.mark.parametrize("line", ASKED)
def test_all_questions_of_all_files_are_asked_at_once(line, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    Path("rope.toml").write_text("height = 1\n[rope]\nlength = 2.0\n[[parts]]\nx = 1.0\n")
    Path("run.csv").write_text("f,re,im\n1,2,3\n2,3,4\n3,4,5\n4,5,6\n")
    command, *rest = line.split()
    assert main([command, "rope.toml", *rest]) == 2
    scene = ["unknown key 'height'", "key rope.linear_density is missing", "key parts[0].kind is"]
    expected = [
        *(f"rope.toml: {said}" for said in scene),
        *(f"--{said} must" for said in ASKED[line]),
    ]
    said = capsys.readouterr().err.splitlines()
    assert [one.startswith(f"ropedyn: {words}") for one, words in zip(said, expected)] == [
        True
    ] * len(expected)
    assert len(said) == len(expected)
    assert not re.search(r"[{}]|\('", "".join(said[len(scene) :]).replace("('f', 're', 'im')", ""))
