"""Ctrl-C at every line that the threads' own locks run through ends the call, and hangs nothing."""

import subprocess
import sys

import pytest

PROGRAM = '''
import faulthandler, signal, sys, threading
from concurrent.futures import ThreadPoolExecutor
import numpy as np
import ropedyn as rd
from ropedyn.family.rows import Filled, Means, Shared
from ropedyn.response.solvers import in_slices

faulthandler.dump_traceback_later(60, exit=True)


def slices():
    in_slices(lambda part: (np.arange(part.start, part.stop),), 64, 1, 16, 2)


def rows():
    def solve(rows):
        return Filled(np.arange(len(rows)), (rows,), {})

    shared = Shared(np.arange(8.0), 2, None, None)
    shared.fill([np.empty(8)], [Means(solve, 2)])


def sweep():
    pool = pools.pop()
    rd.sweep(abs, [1, 2, 3], executor=pool)


def traced(call, at):
    """Ctrl-C at line `at` of the locks, of how many; whether it ended the call."""
    lines = 0

    def trace(frame, event, _):
        nonlocal lines
        if not frame.f_code.co_filename.endswith(("threading.py", "thread.py", "_base.py")):
            return None
        lines += event == "line"
        if event == "line" and lines == at:
            signal.raise_signal(signal.SIGINT)
        return trace

    try:
        sys.settrace(trace)
        call()
        return False, lines
    except KeyboardInterrupt:
        return True, lines
    finally:
        sys.settrace(None)


pools = [ThreadPoolExecutor(2) for _ in range(1000)]  # made and ended where nobody interrupts
kept = list(pools)
call = {"slices": slices, "rows": rows, "sweep": sweep}[sys.argv[1]]
signal.signal(signal.SIGINT, signal.default_int_handler)
_, most = traced(call, 0)
found = [(k, *traced(call, k)) for k in range(1, most + 1)]
# the threads' own pace decides how many lines there are
asked = [ended for k, ended, lines in found if k <= lines]
for pool in kept:
    pool.shutdown()
for thread in threading.enumerate()[1:]:
    thread.join(10.0)
print(most, len(asked), sum(asked), threading.active_count())
'''


@pytest.mark.parametrize("name", ["slices", "rows", "sweep"])
def test_ctrl_c_is_heard_outside_locks(name):
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM, name],
        check=False,
        capture_output=True,
        text=True,
        timeout=100,
    )
    assert run.returncode == 0, run.stderr
    most, asked, ended, left = map(int, run.stdout.split())
    assert most > 100 and asked > most / 2
    assert ended == asked
    assert left == 1
