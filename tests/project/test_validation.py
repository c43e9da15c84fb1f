"""VALIDATION.md says what the tests claim; that they hold is for the tests themselves."""

import subprocess
import sys
from pathlib import Path


def test_validation_page_is_up_to_date():
    script = Path(__file__).parent.parent / "validation.py"
    run = subprocess.run(
        [sys.executable, script, "--check"], capture_output=True, text=True, check=False
    )
    assert run.returncode == 0, run.stderr
