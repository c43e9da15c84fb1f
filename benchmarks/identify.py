"""Time and error of identifying tension and bending stiffness from ten peaks, of one rope or many.

python benchmarks/identify.py
"""

# isort: off
import timing  # before numpy

# isort: on
import warnings
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import report
from family import by_hand
from scipy.optimize import least_squares

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
ROPES, ALONE = 10_000, 30
"""Ropes that are identified side by side, and those that are one by one."""
STATES = ("trusted", "refused")


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
        name: partial(rd.identify, start, peaks, UNKNOWN, ends="given")
        for name, peaks in given.items()
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


def numbered(ends: str) -> float:
    """Return the time of finding orders, one mode missing and one peak stray, ends given [s]."""
    exact = np.delete(scene(1e3, ends).compile().modes(NUMBER).frequency, 3)
    noisy = np.sort(np.append(exact, exact[4] * 1.08))
    noisy *= 1 + NOISE * np.random.default_rng(0).normal(size=NUMBER)
    call = partial(rd.identify, scene(1e3, ends, *GUESS), noisy, UNKNOWN, ends="given")
    return timing.medians({"orders": call})["orders"]


def unheld() -> float:
    """Return the time of a posterior over unknown ends, orders given [s]."""
    exact = scene(1e3, "clamped").compile().modes(NUMBER).frequency
    noisy = exact * (1 + NOISE * np.random.default_rng(0).normal(size=NUMBER))
    peaks = rd.Peaks(noisy, std=NOISE * exact, order=list(range(1, NUMBER + 1)))
    call = partial(rd.identify, scene(1e3, "clamped", *GUESS), peaks, UNKNOWN)
    return timing.medians({"ends": call})["ends"]


# --- many ropes -------------------------------------------------------------------------------


def ropes(count: int, ratio: tuple[float, float], noise: float) -> tuple[np.ndarray, np.ndarray]:
    """Return tensions and stiffnesses of clamped ropes, T L^2/B in a range, and peaks [Hz]."""
    rng = np.random.default_rng(17)
    bending = 10 ** rng.uniform(0, 2, count)
    tension = 10 ** rng.uniform(*np.log10(ratio), count) * bending / LENGTH**2
    values = np.stack([tension, bending], axis=1)
    exact = scene(1e3, "clamped").family(UNKNOWN).modes(values, NUMBER).frequency
    return values, exact * (1 + noise * rng.normal(size=exact.shape))


def given(peaks: np.ndarray, noise: float) -> list[rd.Peaks]:
    orders = list(range(1, NUMBER + 1))
    return [rd.Peaks(f, std=noise * f, order=orders) for f in peaks]


def by_scipy(f: np.ndarray, noise: float, guess: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return what least squares of SciPy find with the closed form of `family`, and linear std."""

    def off(u: np.ndarray) -> np.ndarray:
        return (by_hand(np.exp(u)[None])[0] / f - 1) / noise

    found = least_squares(off, np.log(guess))
    covariance = np.linalg.inv(found.jac.T @ found.jac)
    value = np.exp(found.x)
    return value, value * np.sqrt(np.diag(covariance))


def compared() -> str:
    """Return the table of ways to numbers and linear intervals of many ropes, a rope each."""
    noise = 1e-4
    _, f = ropes(ROPES, (1e1, 1e5), noise)
    peaks, start = given(f, noise), scene(1e3, "clamped")
    guess = np.array([start.tension, start.rope.bending_stiffness])
    linear = partial(rd.Fits.interval, method="linear")
    calls: dict[str, Callable[[], Any]] = {
        "side by side": lambda: linear(rd.identify(start, peaks, UNKNOWN, ends="given", threads=1)),
        "rope by rope": lambda: [
            rd.identify(start, one, UNKNOWN, ends="given").interval(method="linear")
            for one in peaks[:ALONE]
        ],
        "by hand, least_squares of SciPy": lambda: [
            by_scipy(one, noise, guess) for one in f[:ALONE]
        ],
    }
    times = timing.medians(calls, budget=6.0)
    fits = rd.identify(start, peaks, UNKNOWN, ends="given", threads=1)
    hand = np.array([by_scipy(one, noise, guess)[0] for one in f[:ALONE]])
    apart = np.abs(hand / fits.value[:ALONE] - 1).max(axis=1)
    each = {name: times[name] / (ROPES if name == "side by side" else ALONE) for name in calls}
    rows = [
        [name, report.digits(1e6 * time), report.digits(time / each["side by side"])]
        for name, time in each.items()
    ]
    text = report.table(["way", "us a rope", "times side by side"], rows)
    alike, most = int((apart < 1e-6).sum()), f"{np.median(apart):.0e}"
    return f"""{text}

All {ROPES} take {times["side by side"]:.2f} s of one core, {fits.status.count("trusted")}
have a solution. SciPy finds the same to 1e-6 for {alike} of {ALONE} ropes, half of them to {most};
it does not count modes."""


def hard() -> str:
    """Return the table of what becomes of ropes whose peaks tell less."""
    ends = (rd.End(beta="free", spring={"beta": 10.0}), "clamped")
    plain = scene(1e3, "clamped")
    far = scene(1e3, "clamped", 1e4, 1e-4)
    third = [*UNKNOWN, "ends[0].spring.beta"]
    cases = [
        ("noise 1e-4", (1e1, 1e5), 1e-4, plain, UNKNOWN),
        ("guess off by 1e4", (1e1, 1e5), 1e-3, far, UNKNOWN),
        ("B hardly shows, noise 5e-3", (1e3, 1e6), 5e-3, plain, UNKNOWN),
        ("a spring that is clamped", (1e1, 1e4), 1e-3, plain.replace(ends=ends), third),
    ]
    rows = []
    for name, ratio, noise, start, unknown in cases:
        true, f = ropes(1000, ratio, noise)
        fits = rd.identify(start, given(f, noise), unknown, ends="given", threads=1)
        counted = Counter(fits.status)
        bound = int(((fits.value == 0) | np.isinf(fits.value)).any(axis=1).sum())
        bounds = fits.interval()[:, :2]
        inside = (bounds[..., 0] <= true) & (true <= bounds[..., 1])
        share = 100 * inside[np.isfinite(fits.value[:, 0])].mean(axis=0)
        work = fits.cost.factorisations / len(fits)
        rows.append([name, *(f"{counted[one]}" for one in STATES), f"{bound}", f"{work:.1f}"])
        rows[-1] += [f"{one:.1f}" for one in share]
    head = [
        "ropes",
        *STATES,
        "with a number at a bound",
        "solutions of each",
        "T in 95 % [%]",
        "B in 95 % [%]",
    ]
    return report.table(head, rows)


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
    orders = ", ".join(f"{1e3 * numbered(ends):.0f} ms with {ends} ends" for ends in ENDS)
    return f"""# Tension and bending stiffness from ten peaks

{report.machine()}. One rope of {LENGTH} m, {DENSITY} kg/m and {TENSION:g} N whose ten lowest peaks
are given with their orders, exactly or with {100 * NOISE:g} % noise. The guess is
{GUESS[0]:g} times the tension and {GUESS[1]:.2g} of the stiffness. Times are medians of processor
times of `rd.identify(scene, peaks, ["tension", "bending_stiffness"], ends="given")`, with noisy
peaks also together with `fit.interval()` by profile likelihood. Solutions are those with all
derivatives, of the start and of the trust region. Errors are relative ones with exact peaks.

{report.table(head, lines)}

Without orders, one mode missing and one peak that is none, a fit takes {orders}.
With orders but unknown ends, T L^2/B = 1000, it takes {1e3 * unheld():.0f} ms.

## Many ropes

Clamped ropes whose ten peaks come with their orders and a noise of 1e-4, T L^2/B from 10 to 1e5,
with linear intervals. By hand the frequencies are those of five Newton steps, the derivatives
differences.

{compared()}

## Peaks that tell less

1000 ropes each, and how often profile intervals of 95 % hold the truth. The spring of one end
starts at 10 N m/rad where the ropes are clamped.

{hard()}
"""


def main() -> None:
    # a stiffness or a spring that does not show is what is looked at
    warnings.simplefilter("ignore", rd.IdentifyWarning)
    rows = []
    for ends in ENDS:
        for ratio in RATIOS:
            rows.append(measure(ends, ratio))
            print(".", end="", flush=True)
    print()
    report.write("identify.md", page(rows))


if __name__ == "__main__":
    main()
