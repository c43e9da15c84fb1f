"""Write tests/long.txt: ``python tests/long_tests.py`` runs all but the large samples.

What takes more than 0.02 s of the processor is left to ``pytest -m long``, which CI runs too, so
that the others are through while one waits.
"""

import resource
import sys
from collections import Counter
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "tests" / "long.txt"
SOON = 0.02  # [s]


def used():
    """Time of the processor that this process and its children have used [s]."""
    each = map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return sum(one.ru_utime + one.ru_stime for one in each)


class Clock:
    """Adds to each report what has been used since the one before, or what is shared has."""

    def __init__(self):
        self.before = used()
        self.shared = {}  # by name and place of a fixture that other tests would have to make too

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef):
        begin = used()
        made = yield
        if fixturedef.scope != "function":
            self.shared[fixturedef.argname, fixturedef.baseid] = used() - begin
        return made

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item, call):
        report = yield
        now = used()
        report.used, self.before = now - self.before, now
        if call.when == "setup":
            named = getattr(item, "fixturenames", ())
            own = [key for key in self.shared if key[0] in named and item.nodeid.startswith(key[1])]
            report.used = max(report.used, sum(self.shared[key] for key in own))
        return report


class Recorder:
    """Adds up what tests take, fixtures that they need included."""

    def __init__(self):
        self.taken = Counter()

    def pytest_runtest_logreport(self, report):
        self.taken[report.nodeid] += report.used


def pytest_configure(config):
    config.pluginmanager.register(Clock())


def write(taken):
    """Write the names of tests that take long."""
    names = sorted(name for name, seconds in taken.items() if seconds > SOON)
    PAGE.write_text("".join(f"{name}\n" for name in names), encoding="utf-8")


def main():
    recorder = Recorder()
    # by its name it acts in each worker
    places = [str(ROOT / name) for name in ("tests", "ropedyn")]
    arguments = ["-p", Path(__file__).stem, "-m", "not slow", "-q", *places]
    status = pytest.main(arguments, plugins=[recorder])
    if status in (pytest.ExitCode.OK, pytest.ExitCode.TESTS_FAILED):
        write(recorder.taken)
    return status


if __name__ == "__main__":
    sys.exit(main())
