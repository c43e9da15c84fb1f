"""A fork while other threads import: the child imports the same, and nothing is said."""

import subprocess
import sys

import pytest

FORK = """
import os, sys, threading, time
sys.path.insert(0, {folder!r})
import ropedyn

started = threading.Event()

def read():
    started.set()
    import {name}

thread = threading.Thread(target=read)
thread.start()
started.wait()
time.sleep({after})
child = os.fork()
if child == 0:
    import {name}
    os._exit({name}.answer)
print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))
thread.join()
"""
SLOW = "import time, {others}\ntime.sleep(0.3)\nanswer = 42\n"


# Python 3.12 warns of what is tested here
@pytest.mark.parametrize("after", [0.0, 0.1, 0.5])
@pytest.mark.parametrize("others", ["inner", "inner, logging, multiprocessing"])
def test_a_child_imports_what_a_thread_imports_at_the_fork(others, after, tmp_path):
    (tmp_path / "outer.py").write_text(SLOW.format(others=others), encoding="utf-8")
    (tmp_path / "inner.py").write_text(SLOW.format(others="os"), encoding="utf-8")
    code = FORK.format(folder=str(tmp_path), name="outer", after=after)
    command = [sys.executable, "-W", "ignore", "-c", code]
    # a child that hangs is killed with its parent
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True)
    assert (done.stdout, done.stderr) == ("42\n", "")


def test_threads_that_wait_for_each_other_do_not_hold_up_a_fork(tmp_path):
    # the module that forks is imported itself, and the other thread waits for it
    (tmp_path / "forks.py").write_text(
        "import os, threading, time\n"
        "thread = threading.Thread(target=__import__, args=['waits'])\n"
        "thread.start()\n"
        "time.sleep(0.3)\n"
        "child = os.fork()\n"
        "if child == 0:\n"
        "    os._exit(42)\n"
        "print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))\n",
        encoding="utf-8",
    )
    (tmp_path / "waits.py").write_text("import forks\n", encoding="utf-8")
    code = f"import sys; sys.path.insert(0, {str(tmp_path)!r}); import ropedyn, forks"
    command = [sys.executable, "-W", "ignore", "-c", code]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=True)
    assert (done.stdout, done.stderr) == ("42\n", "")
