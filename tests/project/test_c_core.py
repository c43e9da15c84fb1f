"""The core without Python: its C tests, built with warnings as errors and asserts on."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

RUN = Path(__file__).parent.parent / "c" / "run"


@pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
def test_c_tests_pass():
    environment = os.environ | {"PYTHON": sys.executable}
    run = subprocess.run([str(RUN)], env=environment, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    assert " 0 failed" in run.stdout
