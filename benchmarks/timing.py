"""Medians of calls that take turns, on one core; import before numpy, which reads OPENBLAS_*."""

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import statistics
import time
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

RESULTS = Path(__file__).parent / "results"

LONG = 2.0
"""Calls longer than this [s] need no warm-up and are made three times."""


def medians(calls: Mapping[str, Callable[[], Any]], *, budget: float = 1.0) -> dict[str, float]:
    """Return the median time of each call [s]: warmed up, then in turn, 3 to 25 times.

    All calls that are not long share the budget [s], which decides how often.
    """
    first = {name: seconds(call) for name, call in calls.items()}
    times = {name: [value] if value > LONG else [] for name, value in first.items()}
    short = sum(value for value in first.values() if value <= LONG)
    rounds = int(min(max(budget / max(short, 1e-9), 3), 25))
    for k in range(rounds):
        for name, call in calls.items():
            if first[name] <= LONG or k < 2:
                times[name].append(seconds(call))
    return {name: statistics.median(values) for name, values in times.items()}


def seconds(call: Callable[[], Any]) -> float:
    """Return the processor time of a call, which other work on the machine does not count in."""
    start = time.process_time()
    call()
    return time.process_time() - start


def machine() -> str:
    """Name the processor and the vector instructions that matter here."""
    info = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    fields = dict(
        [part.strip() for part in line.split(":", 1)] for line in info.splitlines() if ":" in line
    )
    flags = fields.get("flags", "").split()
    vectors = next((name for name in ("avx512f", "avx2") if name in flags), "no AVX2")
    return f"{fields.get('model name', 'unknown processor')} ({vectors}), one thread"


def write(name: str, text: str) -> None:
    """Print a result and keep it in benchmarks/results."""
    print(text)
    RESULTS.mkdir(exist_ok=True)
    (RESULTS / name).write_text(text + "\n", encoding="utf-8")


def table(head: list[str], rows: list[list[str]]) -> str:
    """Lay out a Markdown table with columns of one width, text left and numbers right."""
    widths = [max(map(len, column)) for column in zip(head, *rows)]
    line = ["-" * (w - 1) + (":" if k else "-") for k, w in enumerate(widths)]
    laid = [
        [c.rjust(w) if k else c.ljust(w) for k, (c, w) in enumerate(zip(row, widths))]
        for row in (head, line, *rows)
    ]
    return "\n".join("| " + " | ".join(row) + " |" for row in laid)


def digits(value: float | None) -> str:
    """Write a number with two digits, nothing as a dash."""
    if value is None:
        return "-"
    return f"{value:.2g}" if value < 99.5 else f"{value:.0f}"
