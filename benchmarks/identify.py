"""Time and error of identifying tension and bending stiffness from ten peaks.

python benchmarks/identify.py
"""

# isort: off
import timing  # before numpy

# isort: on
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import report

import ropedyn as rd

LENGTH, DENSITY, TENSION = 1.35, 0.1017, 2830.0
NUMBER = 10
UNKNOWN = ["tension", "bending_stiffness"]
RATIOS = (1e1, 1e2, 1e3, 1e4, 1e5)
"""T L^2/B."""
ENDS = ("pinned", "clamped")
GUESS = (2.0, 1 / 3)
"""How far off tension and stiffness start."""
NOISE = 1e-3


@dataclass(frozen=True)
class Row:
    """One rope: evaluations and times [s] with exact and with noisy peaks, relative errors."""

    ends: str
    ratio: float
    evaluations: dict[str, int]
    time: dict[str, float]
    error: tuple[float, float]


def scene(ratio: float, ends: str, tension: float = 1.0, bending: float = 1.0) -> rd.Scene:
    stiffness = bending * TENSION * LENGTH**2 / ratio
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=stiffness)
    return rd.Scene(rope, tension=tension * TENSION, ends=(ends, ends))


def measure(ends: str, ratio: float) -> Row:
    exact = scene(ratio, ends).compile().modes(NUMBER).frequency
    noisy = exact * (1 + NOISE * np.random.default_rng(0).normal(size=NUMBER))
    start, order = scene(ratio, ends, *GUESS), list(range(1, NUMBER + 1))
    given = {"exact": rd.Peaks(exact, order=order), "noisy": rd.Peaks(noisy, order=order)}
    calls: dict[str, Callable[[], Any]] = {
        name: partial(rd.identify, start, peaks, UNKNOWN) for name, peaks in given.items()
    }
    fits = {name: call() for name, call in calls.items()}
    calls["interval"] = lambda: calls["noisy"]().interval()
    true = np.array([TENSION, TENSION * LENGTH**2 / ratio])
    return Row(
        ends,
        ratio,
        {name: fit.cost.factorisations for name, fit in fits.items()},
        timing.medians(calls, budget=2.0),
        tuple(np.abs(fits["exact"].value / true - 1).tolist()),
    )


def searched(ends: str) -> float:
    """Return the time of a search of orders, one mode missing and one peak stray [s]."""
    exact = np.delete(scene(1e3, ends).compile().modes(NUMBER).frequency, 3)
    noisy = np.sort(np.append(exact, exact[4] * 1.08))
    noisy *= 1 + NOISE * np.random.default_rng(0).normal(size=NUMBER)
    call = partial(rd.identify, scene(1e3, ends, *GUESS), noisy, UNKNOWN)
    return timing.medians({"search": call})["search"]


# --- what is written --------------------------------------------------------------------------


def page(rows: list[Row]) -> str:
    head = ["ends", "T L^2/B", *(f"{n} peaks [ms]" for n in rows[0].evaluations), "of solutions"]
    head += ["and intervals [ms]", "error of T", "error of B"]
    lines = [
        [
            row.ends,
            f"{row.ratio:.0e}",
            *(report.digits(1e3 * row.time[name]) for name in row.evaluations),
            " and ".join(map(str, row.evaluations.values())),
            report.digits(1e3 * row.time["interval"]),
            *(f"{error:.0e}" for error in row.error),
        ]
        for row in rows
    ]
    search = ", ".join(f"{1e3 * searched(ends):.0f} ms with {ends} ends" for ends in ENDS)
    return f"""# Tension and bending stiffness from ten peaks

{report.machine()}. One rope of {LENGTH} m, {DENSITY} kg/m and {TENSION:g} N whose ten lowest peaks
are given with their orders, exactly or with {100 * NOISE:g} % noise. The guess is
{GUESS[0]:g} times the tension and {GUESS[1]:.2g} of the stiffness. Times are medians of processor
times of `rd.identify(scene, peaks, ["tension", "bending_stiffness"])`, with noisy peaks also
together with `fit.interval()` by profile likelihood. Solutions are those with all derivatives that
the trust region took, after one or two for its start. Errors are relative ones with exact peaks.

{report.table(head, lines)}

Without orders, one mode missing and one peak that is none, the search takes {search}.
"""


def main() -> None:
    rows = []
    for ends in ENDS:
        for ratio in RATIOS:
            rows.append(measure(ends, ratio))
            print(".", end="", flush=True)
    print()
    report.write("identify.md", page(rows))


if __name__ == "__main__":
    main()
