"""What the command line says where something is wrong, and of how far it is."""

import io
import sys
import time

import pytest

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
