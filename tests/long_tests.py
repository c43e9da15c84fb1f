"""Write tests/long.txt: ``python tests/long_tests.py`` runs all but the large samples.

What takes more than half a second there is left to ``pytest -m long``, which CI runs too, so that
the others are through while one waits. The machine should have nothing else to do meanwhile.
"""

import sys
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "tests" / "long.txt"
SOON = 0.5  # [s]


class Recorder:
    """Adds up what tests take, fixtures that they make included."""

    def __init__(self):
        self.taken = Counter()

    def pytest_runtest_logreport(self, report):
        self.taken[report.nodeid] += report.duration


def write(taken):
    """Write the names of tests that take long."""
    names = sorted(name for name, seconds in taken.items() if seconds > SOON)
    PAGE.write_text("".join(f"{name}\n" for name in names), encoding="utf-8")


def main():
    recorder = Recorder()
    if pytest.main(["-m", "not slow", "-q", str(ROOT)], plugins=[recorder]) == 0:
        write(recorder.taken)
        return 0
    return 1


if __name__ == "__main__":
    sys.exit(main())
