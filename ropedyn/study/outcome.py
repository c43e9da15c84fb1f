"""What becomes of scenes that a function is called with, here or in another process."""

from __future__ import annotations

import pickle
import time
import traceback
import uuid
from collections.abc import Callable, Sequence
from typing import Any, Generic, NamedTuple, TypeVar

from ..base.errors import RopedynError

One = TypeVar("One")

SLICE = 0.5  # Scenes that have taken longer together [s] leave the rest to another call.


class Failure:
    """An exception that can travel: one that cannot be unpickled would break the whole pool."""

    def __init__(self, error: BaseException) -> None:
        self.error = error

    def __reduce__(self) -> tuple[Any, ...]:
        text = "".join(traceback.format_exception(self.error))
        try:
            data = pickle.dumps(self.error)
            pickle.loads(data)
        except Exception:
            data = b""
        return _arrived, (data, f"{type(self.error).__name__}: {self.error}", text)


def _arrived(data: bytes, words: str, text: str) -> Failure:
    """Return the failure of another process, by its words where the exception cannot be had."""
    try:
        error = pickle.loads(data)
    except Exception:
        error = RopedynError(words)
    error.add_note(text)
    return Failure(error)


class Outcome(NamedTuple):
    """What became of a scene."""

    result: Any
    failure: Failure | None
    seconds: float


def outcome_of(function: Callable[[One], Any], scene: One) -> Outcome:
    """Call the function."""
    start = time.perf_counter()
    result, failure = None, None
    try:
        result = function(scene)
    except Exception as error:
        failure = Failure(error)
    return Outcome(result, failure, time.perf_counter() - start)


class Errand(Generic[One]):
    """What an executor is sent: scenes, and the function to call with each."""

    def __init__(self, function: Callable[[One], Any], scenes: Sequence[One]) -> None:
        self.function = function
        self.scenes = scenes

    def __call__(self) -> list[Outcome]:
        """Return the outcomes of the first scenes, at least of one, until time is up."""
        stop = time.perf_counter() + SLICE
        found: list[Outcome] = []
        for scene in self.scenes:
            found.append(outcome_of(self.function, scene))
            if time.perf_counter() > stop:
                break
        return found

    def __dask_tokenize__(self) -> str:
        """No two are the same: Dask would run equal ones once, and spend long on comparing them."""
        return uuid.uuid4().hex
