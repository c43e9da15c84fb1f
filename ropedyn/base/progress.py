"""How long work says how far it is."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

Progress = None | bool | Callable[[float], Any]
"""What users give: nothing, True for a line on stderr, or what takes the fraction that is done."""

PATIENCE = 2.0  # Seconds in which nobody asks.


def reporter(progress: Progress) -> Callable[[float], Any]:
    """Return what takes the fraction that is done."""
    if progress is None or progress is False:
        return silent
    if progress is True:
        return _print
    if not callable(progress):
        raise TypeError(f"progress must be None, True or callable, got {progress!r}")
    return progress


def on_terminal() -> Progress:
    """Return what says so on a terminal, of work that takes longer than `PATIENCE`."""
    if not sys.stderr.isatty():
        return None
    began = time.monotonic()
    said = False

    def say(fraction: float) -> None:
        nonlocal said
        if said or (time.monotonic() - began > PATIENCE and fraction < 1):
            said = True
            _print(fraction)

    return say


def silent(fraction: float) -> None:
    """Take it and say nothing."""


def _print(fraction: float) -> None:
    print(f"\r{fraction:4.0%}", end="\n" if fraction >= 1 else "", file=sys.stderr, flush=True)
