"""A newcomer's first hour: each step by what is typed, from nothing but the installed package.

`python tests/project/test_first_hour.py` walks through it and prints the lines typed.
"""

import contextlib
import io
import os
import re
import shlex
import tempfile
import warnings
from pathlib import Path

import pytest

from ropedyn.cli.command import main

INSTALLED = 1  # The first command of the README.
TENSION = """
ropedyn scene --example > rope.toml
ropedyn scene rope.toml
ropedyn tension rope.toml --peaks 2.110,4.226,6.349,8.484,10.651,12.836 --std .003 --save found.toml
"""
MADE = """
import numpy as np
import ropedyn as rd
scene = rd.Scene.load("found.toml").replace(tension=5.1e6)
lines = np.linspace(1.0, 15.0, 1500)
frf = scene.compile().frf(lines, drive=("z", 2.2), response=("z", 9.0))
noise = np.random.default_rng(1).normal(0.0, 0.02, (2, 1500))
value = frf.value * (1.0 + noise[0] + 1j * noise[1])
rd.Measured(lines, value, drive=("z", 2.2), response=("z", 9.0)).write("run.uff")
"""
"""Stands in for a measurement, which a newcomer has: made with another tension and noise."""
OVERLAY = """
ropedyn inspect run.uff
ropedyn compare found.toml --measured run.uff --position 1=2.2 --position 2=9 --coordinate Z=z \
--plot overlay.png
"""
STUDY = """
import ropedyn as rd
scene = rd.study2015.scene()
heavy = scene.replace(parts=[*scene.parts, rd.PointMass(0.5 * scene.rope.length, 0.005)])
before, after = (one.compile().modes(3).frequency for one in (scene, heavy))
print((after / before - 1) * 100)
"""


def typed(text):
    """Return how many lines are typed."""
    return len(text.strip().splitlines())


def call(line):
    """Run a command as a shell would, and return its status and what it prints."""
    command, _, file = line.partition(" > ")
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        status = main(shlex.split(command)[1:])
    if file:
        Path(file).write_text(said.getvalue(), encoding="utf-8")
    return status, said.getvalue()


def python(text):
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        exec(compile(text, "typed", "exec"), {})
    return said.getvalue()


def walk():
    """Walk through the hour; return of each step the lines typed and what came out."""
    found = {"installed": (INSTALLED, "")}
    said = [call(line) for line in TENSION.strip().splitlines()]
    assert [status for status, _ in said] == [0, 0, 0]
    found["a tension with its interval"] = typed(TENSION), said[-1][1]
    python(MADE)
    said = [call(line) for line in OVERLAY.strip().splitlines()]
    assert [status for status, _ in said] == [0, 0]
    found["a measured response overlaid"] = typed(OVERLAY), said[-1][1]
    found["a changed study"] = typed(STUDY), python(STUDY)
    return found


@pytest.fixture(scope="module")
def hour(tmp_path_factory):
    with contextlib.chdir(tmp_path_factory.mktemp("hour")):
        yield walk()


def test_a_tension_takes_three_lines(hour):
    lines, said = hour["a tension with its interval"]
    value, low, high = re.match(r"tension +(\S+) MN   95 %: (\S+) to (\S+) MN", said).groups()
    assert lines == 3
    assert float(low) < 5.0 < float(high)
    assert float(low) < float(value) < float(high)


def test_an_overlay_takes_two_lines(hour):
    lines, said = hour["a measured response overlaid"]
    assert lines == 2
    assert Path("overlay.png").stat().st_size > 10_000
    assert "FRAC of z at 9.000 m" in said
    assert "tension" in said  # as the one factor that all peaks have in common


def test_a_changed_study_takes_five_lines(hour):
    lines, said = hour["a changed study"]
    first, *_ = (float(one) for one in re.findall(r"-?\d+\.?\d*", said))
    assert lines == 5
    assert -20 < first < 0  # a mass lowers the first frequency


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings():
        os.chdir(folder)
        for step, (count, text) in walk().items():
            print(f"== {step}: {count} lines typed\n{text}")
        os.chdir("/")
