"""What forks and Ctrl-C ask for while other threads are at work.

A fork waits for imports in other threads, which its child would wait for without end. CPython keeps
a lock for each module while it is imported. A child has the locks of all threads and of the threads
only the one that forked, and what is half imported stays so. Answers import SciPy and others when
they are read, so a thread may be in such an import at any time.

Ctrl-C is heard between two waits for threads, never inside a lock of theirs. The locks of
`threading` are written in Python. A KeyboardInterrupt that is raised in the middle of one leaves it
held, or released twice: its threads hang, or a RuntimeError takes the place of Ctrl-C.
"""

from __future__ import annotations

# these act at forks too: imported while a fork waits they would act after it and not before
import concurrent.futures.thread  # noqa: F401
import os
import signal
import sys
import threading
from collections.abc import Callable
from concurrent.futures import Executor, Future
from contextlib import suppress
from importlib import _bootstrap, import_module
from queue import Empty, SimpleQueue
from types import FrameType, TracebackType
from typing import Any, Generic, Self, TypeVar

Key = TypeVar("Key")
Got = TypeVar("Got")
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

PATIENCE = 0.05  # What waits for threads looks for Ctrl-C so often [s].


class Errands(Generic[Key, Got]):
    """Calls that an executor makes; within a `with` Ctrl-C waits until one is sent or asked for."""

    def __init__(self, executor: Executor) -> None:
        self.executor = executor
        self._done: SimpleQueue[Future[Got]] = SimpleQueue()
        self._key: dict[Future[Got], Key] = {}
        self._handler: Any = None
        self._came: tuple[int, FrameType | None] | None = None

    def __enter__(self) -> Self:
        # other threads never hear signals, and what is no function needs no lock
        if threading.current_thread() is threading.main_thread():
            handler = signal.getsignal(signal.SIGINT)
            if callable(handler):
                signal.signal(signal.SIGINT, self._note)
                self._handler = handler
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for future in self._key:
            future.cancel()
        del self.executor  # nobody else's tells its threads that it goes, which takes locks
        if self._handler is not None:
            signal.signal(signal.SIGINT, self._handler)
            self._let_in()

    def __len__(self) -> int:
        return len(self._key)

    def send(self, key: Key, call: Callable[..., Got], *given: Any) -> None:
        """Have a call made; what refuses it at once, as a broken pool does, comes back as well."""
        self._let_in()
        try:
            future = self.executor.submit(call, *given)
        except Exception as error:
            future = Future()
            future.set_exception(error)
        self._key[future] = key
        future.add_done_callback(self._done.put)

    def receive(self) -> tuple[Key, Future[Got]]:
        """Wait for one of those that were sent, and for Ctrl-C."""
        while True:
            self._let_in()
            with suppress(Empty):
                future = self._done.get(timeout=PATIENCE)
                return self._key.pop(future), future

    def _note(self, number: int, frame: FrameType | None) -> None:
        self._came = number, frame

    def _let_in(self) -> None:
        """Give the handler what has come, which may raise."""
        came, self._came = self._came, None
        if came is not None:
            self._handler(*came)
