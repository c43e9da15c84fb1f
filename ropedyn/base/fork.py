"""A fork waits for imports in other threads, which its child would wait for without end.

CPython keeps a lock for each module while it is imported. A child has the locks of all threads and
of the threads only the one that forked, and what is half imported stays so. Answers import SciPy
and others when they are read, so a thread may be in such an import at any time.
"""

from __future__ import annotations

# these act at forks too: imported while a fork waits they would act after it and not before
import concurrent.futures.thread  # noqa: F401
import os
import sys
import threading
from contextlib import suppress
from importlib import _bootstrap, import_module

MOST = 100  # Imports one after another; more are those of a thread that waits for this one's.


def _imported_elsewhere() -> list[str]:
    """Return what other threads import at this moment."""
    locks = list(getattr(_bootstrap, "_module_locks", {}).items())
    others = set(sys._current_frames()) - {threading.get_ident()}
    return [name for name, lock in locks if getattr(lock(), "owner", None) in others]


def finish_imports() -> None:
    """Wait until no other thread imports; what this thread itself imports stays as it is."""
    for _ in range(MOST):
        names = _imported_elsewhere()
        if not names:
            return
        for name in names:
            # why it cannot be imported is told to the thread that began
            with suppress(Exception):
                import_module(name)


os.register_at_fork(before=finish_imports)
