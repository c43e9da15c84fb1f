"""The core without Python: its C tests, with warnings as errors and asserts on, and its walls."""

import os
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

RUN = Path(__file__).parent.parent / "c" / "run"
WALLS = RUN.parent / "walls.py"


@pytest.mark.long
@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
def test_c_tests_pass():
    environment = os.environ | {"PYTHON": sys.executable}
    run = subprocess.run([str(RUN)], env=environment, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    assert " 0 failed" in run.stdout


def test_includes_of_the_core_keep_to_its_floors():
    run = subprocess.run([sys.executable, str(WALLS)], capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr


def test_include_of_a_higher_floor_and_a_circle_are_complained_of(tmp_path):
    walls = runpy.run_path(str(WALLS))
    made = {
        "base/dense.h": "",
        "base/dense.c": '#include "base/dense.h"\n#include "sweep/plan.h"\n',
        "sweep/plan.h": '#include "base/dense.h"\n#include "plan.h"\n',
        "volterra/plan.h": "",
        "volterra/plan.c": '#include "volterra/plan.h"\n#include "volterra/run.h"\n',
        "volterra/run.h": '#include "volterra/plan.h"\n',
        "elsewhere/new.c": "",
    }
    for name, text in made.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    assert walls["complaints"](tmp_path) == [
        'base/dense.c: "sweep/plan.h" lies above it, in sweep',
        "elsewhere/new.c: its folder is missing in FLOORS of tests/c/walls.py",
        'sweep/plan.h: "plan.h" is no file of csrc; includes name their folder',
        "a circle of includes: base/dense -> sweep/plan -> base/dense",
        "a circle of includes: volterra/plan -> volterra/run -> volterra/plan",
    ]
