"""How long work says how far it is."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

Progress = None | bool | Callable[[float], Any]
"""What users give: nothing, True for a line on stderr, or what takes the fraction that is done."""


def reporter(progress: Progress) -> Callable[[float], Any]:
    """Return what takes the fraction that is done."""
    if progress is None or progress is False:
        return silent
    if progress is True:
        return _print
    if not callable(progress):
        raise TypeError(f"progress must be None, True or callable, got {progress!r}")
    return progress


def silent(fraction: float) -> None:
    """Take it and say nothing."""


def _print(fraction: float) -> None:
    print(f"\r{fraction:4.0%}", end="\n" if fraction >= 1 else "", file=sys.stderr, flush=True)
