"""Processor times of calls that take turns."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np

from .array import Real

LONG, FEW = 0.01, 3
"""Calls longer than this [s] are not warmed up again, and made so many times at most."""
LONGEST = 0.3  # Calls longer than this [s] are made once.


def in_turns(
    calls: Sequence[Callable[[], Any]],
    repeat: int,
    report: Callable[[float], Any] = lambda fraction: None,
) -> list[Real]:
    """Return how long each call took, each time it was made [s].

    In turns, so that what disturbs the machine for a while disturbs all of them alike; of the
    processor, so that other work does not count in. Calls have run before; those that are not
    long run twice in a row and the second is timed, for what others drove out of the caches.
    """
    times: list[list[float]] = [[] for _ in calls]
    for turn in range(repeat):
        for k, call in enumerate(calls):
            last = times[k][-1] if turn else 0.0
            if last <= LONG or (turn < FEW and last <= LONGEST):
                first = _seconds(call)
                times[k].append(_seconds(call) if first <= LONG else first)
            report((turn * len(calls) + k + 1) / (repeat * len(calls)))
    return [np.array(each) for each in times]


class Times(NamedTuple):
    """Processor times of ways to an answer, each shape (ways,) [s]; NaN where there is none."""

    compile_seconds: Real  # median of what compiles
    lower_quartile: Real  # of what asks
    seconds: Real  # median of the same
    upper_quartile: Real  # of the same
    seconds_with_bound: Real  # median of what asks and reads the error bar, if that is a third call


def timed(
    ways: Sequence[Sequence[Callable[[], Any]]],
    repeat: int,
    report: Callable[[float], Any] = lambda fraction: None,
) -> Times:
    """Time ways to an answer in turns."""
    times = iter(in_turns([call for calls in ways for call in calls], repeat, report))
    kept = [[next(times) for _ in calls] + [_NEVER] * (3 - len(calls)) for calls in ways]
    compiled, asked, bound = zip(*kept)
    lower, median, upper = np.array([np.quantile(each, [0.25, 0.5, 0.75]) for each in asked]).T
    middle, bounded = (np.array([np.median(each) for each in of]) for of in (compiled, bound))
    return Times(middle, lower, median, upper, bounded)


_NEVER = np.array([np.nan])  # What is not called has these times.


def _seconds(call: Callable[[], Any]) -> float:
    start = time.process_time()
    call()
    return time.process_time() - start
