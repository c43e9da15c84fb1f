"""VALIDATION.md says what the tests claim; that they hold is for the tests themselves."""

import subprocess
import sys

from validation import PAGE, ROOT, differences


def test_validation_page_is_up_to_date(request):
    if str(ROOT / "tests") in (str(ROOT / each) for each in request.config.args):
        # this run has collected every claim
        claims = request.config.pluginmanager.get_plugin("claims")
        assert list(differences(claims, PAGE.read_text(encoding="utf-8"))) == []
    else:
        check = [sys.executable, ROOT / "tests" / "validation.py", "--check"]
        run = subprocess.run(check, capture_output=True, text=True, check=False)
        assert run.returncode == 0, run.stderr
