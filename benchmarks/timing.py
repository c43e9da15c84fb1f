"""Times of calls that take turns, on one core; import before numpy, which reads OPENBLAS_*."""

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import statistics
import time
from collections.abc import Callable, Mapping
from typing import Any

LONG = 2.0
"""Calls longer than this [s] need no warm-up and are made three times."""


def medians(
    calls: Mapping[str, Callable[[], Any]], *, budget: float = 1.0, least: float = 0.0
) -> dict[str, float]:
    """Return the median time of each call [s]: warmed up, then in turn, 3 to 25 times.

    All calls that are not long share the budget [s], which decides how often. A measurement of a
    call that is shorter than `least` [s] is of several in a row.
    """
    first = {name: seconds(call) for name, call in calls.items()}
    times = {name: [value] if value > LONG else [] for name, value in first.items()}
    row = {name: _in_a_row(calls[name], least) for name in calls} if least else {}
    short = sum(value for value in first.values() if value <= LONG) + least * len(row)
    rounds = int(min(max(budget / max(short, 1e-9), 3), 25))
    for k in range(rounds):
        for name, call in calls.items():
            if first[name] <= LONG or k < 2:
                times[name].append(seconds(call, row.get(name, 1)))
    return {name: statistics.median(values) for name, values in times.items()}


def quartiles(
    calls: Mapping[str, Callable[[], Any]], *, repeat: int
) -> dict[str, tuple[float, float, float]]:
    """Return lower quartile, median and upper quartile of the time of each call [s].

    Calls take turns, and are made so often, after one that warms up in each turn.
    """
    times: dict[str, list[float]] = {name: [] for name in calls}
    for _ in range(repeat):
        for name, call in calls.items():
            call()
            times[name].append(seconds(call))
    cut = {name: statistics.quantiles(each, n=4) for name, each in times.items()}
    return {name: (lower, middle, upper) for name, (lower, middle, upper) in cut.items()}


def seconds(call: Callable[[], Any], row: int = 1) -> float:
    """Return the processor time of a call, the mean of so many in a row.

    Other work on the machine does not count in.
    """
    start = time.process_time()
    for _ in range(row):
        call()
    return (time.process_time() - start) / row


def _in_a_row(call: Callable[[], Any], least: float) -> int:
    """Return how often a warm call fits in a time [s], at least once."""
    return max(1, round(least / max(seconds(call), 1e-9)))
