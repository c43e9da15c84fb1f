"""One boundary for files: whatever damage makes a library raise, the user gets one error."""

from __future__ import annotations

import os
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from .errors import SceneError


@contextmanager
def reading(path: str | os.PathLike[str], what: str) -> Iterator[None]:
    """Make of whatever the block raises or warns a `SceneError` that names the file.

    ``path must be {what}, got 'file': reason``. A missing library and Ctrl-C stay what
    they are.
    """
    before, file = sys.exception(), os.fspath(path)
    try:
        # numbers that overflow are infinite, and found by the checks of what was read
        with warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.simplefilter("ignore")
            yield
    except (SceneError, ImportError) as error:
        if isinstance(error, ImportError) or str(file) in str(error):
            raise
        said = "\n".join(f"{file}: {line}" for line in str(error).split("\n"))
        raise SceneError(said) from error
    except Exception as error:
        _raise_hidden(error, before)
        raise SceneError(f"path must be {what}, got {str(file)!r}: {_said(error)}") from error


def _said(error: Exception) -> str:
    """Return what an error says, on one line; its kind where that is little."""
    text = " ".join(str(error).split())
    return text if len(text) > len("8 letters") else f"{type(error).__name__} {text}".strip()


def _raise_hidden(error: BaseException, before: BaseException | None) -> None:
    """Raise Ctrl-C that a library has caught with a bare ``except``, as pyuff does."""
    hidden = error.__context__
    while hidden is not None and hidden is not before:
        if not isinstance(hidden, Exception):
            raise hidden
        hidden = hidden.__context__
