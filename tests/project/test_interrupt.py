"""Ctrl-C ends every call within a second, whatever it is in."""

import os
import select
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from conftest import long
from long_calls import CALLS

FEW = list(CALLS)[::5]
PROGRAM = Path(__file__).parent.parent / "support" / "long_calls.py"
TICKS = os.sysconf("SC_CLK_TCK")
INSIDE = 0.2
"""So much of the processor a call has used when it is ended [s]: it is well under way."""
OF_MATPLOTLIB = ("Invalid bounding box", "Invalid affine transformation matrix")
"""What its C++ says of a Ctrl-C, once in sixty."""
PATIENCE = 120.0
"""What takes longer hangs [s]."""


class Child:
    """A process that makes long calls."""

    def __init__(self):
        self.process = subprocess.Popen(
            [sys.executable, "-u", "-W", "ignore", PROGRAM],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env={**os.environ, "MPLBACKEND": "Agg"},
        )

    def used(self):
        """Return the time of the processor that it has used [s]."""
        stat = Path(f"/proc/{self.process.pid}/stat").read_text(encoding="ascii")
        return sum(map(int, stat.rpartition(")")[2].split()[11:13])) / TICKS

    def told(self):
        """Return the line that it says next, an empty one of what hangs."""
        watch = threading.Timer(PATIENCE, self.process.kill)
        watch.start()
        said = self.process.stdout.readline().strip()
        watch.cancel()
        return said

    def interrupt(self, name):
        """Begin a call, end it when it is under way, and return what the child says of it."""
        self.process.stdin.write(f"{name}\n")
        self.process.stdin.flush()
        said = self.told()
        if said != "begin":
            return said, 0.0
        before, end = self.used(), time.monotonic() + PATIENCE
        while (used := self.used()) < before + INSIDE and time.monotonic() < end:
            if select.select([self.process.stdout], [], [], 0.005)[0]:
                return self.told(), used  # it has ended before
        self.process.send_signal(signal.SIGINT)
        return self.told(), used


@pytest.fixture(scope="module")
def child():
    one = Child()
    yield one
    one.process.kill()
    one.process.communicate()


# time of the processor, not of the clock: other work on the machine is none of the library's
@pytest.mark.skipif(sys.platform != "linux", reason="asks /proc")
@pytest.mark.parametrize("name", [*FEW, *long(*(name for name in CALLS if name not in FEW))])
def test_ctrl_c_ends_a_call_within_a_second(name, child):
    said, before = child.interrupt(name)
    if any(text in said for text in OF_MATPLOTLIB):
        said, before = child.interrupt(name)
    assert said and not said.startswith(("raised", "ended")), said
    used, left = map(float, said.split())
    assert used - before < 1.0
    assert left == 0  # no thread goes on alone
