"""The frequency response of a chain: the sweep beside SciPy's band and sparse solvers.

python benchmarks/frf.py
"""

# isort: off
import timing  # before numpy

# isort: on
import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from pathlib import Path
from typing import Any

import exact
import numpy as np
import report
import scene
from scipy.linalg import solve_banded
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

import ropedyn as rd

FREQUENCY = np.linspace(10.0, 400.0, 1000)
ELEMENTS = (8, 64, 1000, 10_000, 100_000)
NUMBERS = (1, 10, 100, 1000, 10_000)
LARGEST = 1_000_000
SOLVERS = ("sweep", "solve_banded", "splu")


@dataclass(frozen=True)
class Row:
    """One scene: time per node and frequency [s], error and bound relative to the response."""

    kind: str
    twist: bool
    elements: int
    time: dict[str, float]
    error: dict[str, float]
    bound: float
    element: str = "rigid"


class Assembled:
    """The dynamic stiffness K + i omega C - omega^2 M for SciPy, filled anew per frequency.

    Unknown `at` is driven and watched.
    """

    def __init__(self, stiffness: Any, damping: Any, mass: Any, at: int) -> None:
        parts = [part.tocoo() for part in (stiffness, damping, mass)]
        size = parts[0].shape[0]
        self.width = int(abs(parts[0].row - parts[0].col).max())
        self.bands = [np.zeros((2 * self.width + 1, size)) for _ in parts]
        for band, part in zip(self.bands, parts):
            band[self.width + part.row - part.col, part.col] = part.data
        self.sparse = stiffness.tocsc()
        self.sparse.sort_indices()
        columns = np.repeat(np.arange(size), np.diff(self.sparse.indptr))
        place = (self.width + self.sparse.indices - columns, columns)
        self.data = [band[place] for band in self.bands]
        self.at = at
        self.force = np.zeros(size, dtype=complex)
        self.force[at] = 1.0

    def solve_banded(self, frequency: np.ndarray) -> np.ndarray:
        ends = (self.width, self.width)
        return np.array(
            [
                solve_banded(
                    ends, _dynamic(self.bands, f), self.force, overwrite_ab=True, check_finite=False
                )[self.at]
                for f in frequency
            ]
        )

    def splu(self, frequency: np.ndarray) -> np.ndarray:
        pattern = (self.sparse.indices, self.sparse.indptr)
        return np.array(
            [
                splu(csc_array((_dynamic(self.data, f), *pattern))).solve(self.force)[self.at]
                for f in frequency
            ]
        )


def _dynamic(parts: list[np.ndarray], frequency: float) -> np.ndarray:
    omega = 2 * np.pi * frequency
    stiffness, damping, mass = parts
    return stiffness + 1j * omega * damping - omega**2 * mass


def middle_of(model: rd.Model) -> int:
    """Return which unknown is z of the node in the middle."""
    free = np.flatnonzero((model.chain.held[model.chain.term_of] == 0).ravel())
    middle = (len(model.x) // 2) * len(model.coordinates) + model.coordinates.index("z")
    return int(np.searchsorted(free, middle))


def sweep(model: rd.Model, frequency: np.ndarray) -> Any:
    middle = ("z", float(model.x[len(model.x) // 2]))
    return model.frf(frequency, drive=middle, solver="sweep", threads=1)


def measure(kind: str, twist: bool, elements: int) -> Row:
    model = scene.model(kind, elements, twist=twist)
    assembled = Assembled(
        model.stiffness_matrix(), model.damping_matrix(), model.mass_matrix(), middle_of(model)
    )
    few = FREQUENCY[:: 1000 // fewer(elements)]
    calls: dict[str, Callable[[], Any]] = {
        "sweep": partial(sweep, model, FREQUENCY),
        "solve_banded": partial(assembled.solve_banded, few),
        "splu": partial(assembled.splu, few),
    }
    times = timing.medians(calls)
    count = {"sweep": len(FREQUENCY), "solve_banded": len(few), "splu": len(few)}
    result = sweep(model, few)
    value = {"sweep": result.value[0]} | {name: calls[name]() for name in SOLVERS[1:]}
    if elements == ELEMENTS[0]:
        value = {name: v[::10] for name, v in value.items()}
        right = [exact.receptance(model, f, scene.GAMMA, assembled.at) for f in few[::10]]
    else:
        right = value.pop("sweep")
    return Row(
        kind,
        twist,
        elements,
        {name: t / count[name] / elements for name, t in times.items()},
        {name: float(np.max(abs(v / right - 1))) for name, v in value.items()},
        float(result.rounding_error.max()),
    )


def measure_own(kind: str, twist: bool, elements: int, element: str) -> Row:
    """Time the sweep where SciPy has no matrix to solve or too large a one."""
    model = scene.model(kind, elements, twist=twist, element=element)
    call = partial(sweep, model, FREQUENCY)
    time = timing.medians({"sweep": call})["sweep"]
    bound = float(call().rounding_error.max())
    each = {"sweep": time / len(FREQUENCY) / elements}
    return Row(kind, twist, elements, each, {}, bound, element)


def fewer(elements: int) -> int:
    """How many frequencies SciPy is given."""
    return int(np.clip(200_000 // elements, 4, 200))


# --- growth and memory ------------------------------------------------------------------------


def over_frequencies() -> str:
    rows = []
    for kind, elements in (("uniform", 1000), ("masses", 1000), ("different", 1000)):
        model = scene.model(kind, elements, twist=False)
        calls = {str(n): partial(sweep, model, np.linspace(10.0, 400.0, n)) for n in NUMBERS}
        times = timing.medians(calls, budget=0.5)
        rows.append([f"{kind}, n = {elements}", *(report.digits(1e3 * t) for t in times.values())])
    return report.table(["time [ms] for so many frequencies", *map(str, NUMBERS)], rows)


def memory() -> dict[str, float]:
    """Peak memory and time of 10^6 different elements x 1000 frequencies, in a fresh process."""
    done = subprocess.run(
        [sys.executable, __file__, "--memory"], check=True, capture_output=True, text=True
    )
    return json.loads(done.stdout)


def memory_here() -> None:
    bare = resident("VmRSS")
    model = scene.chain_of_different(LARGEST)
    own = resident("VmRSS")
    # the peak starts anew: building the model is not what is measured
    Path("/proc/self/clear_refs").write_text("5", encoding="utf-8")
    seconds = timing.seconds(lambda: sweep(model, FREQUENCY))
    print(json.dumps({"bare": bare, "model": own, "peak": resident("VmHWM"), "seconds": seconds}))


def resident(name: str) -> float:
    """Return a line of /proc/self/status [MB]."""
    lines = Path("/proc/self/status").read_text(encoding="utf-8").splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith(name)) / 1024


# --- what is written --------------------------------------------------------------------------


def page(rows: list[Row], numbers: str, peak: dict[str, float]) -> str:
    kinds = "\n".join(f"- {name}: {text}." for name, text in scene.KINDS.items())
    count = ", ".join(f"{fewer(n)} at n = {n}" for n in ELEMENTS)
    bare = peak["bare"]
    return f"""# Frequency response

{report.machine()}. T = 2830 N, B = 1.54 N m^2, 1.35 m, 0.1017 kg/m, clamped,
StiffnessDamping(1e-4), driven and watched in the middle, 10 to 400 Hz. Elements are rigid where
nothing else is said; tensed ones with this damping have no damping matrix to give SciPy.
Width 2 is z and beta; width 3 has twist and lay too.

{kinds}

The sweep answers {len(FREQUENCY)} frequencies; SciPy is given fewer, filling the dynamic stiffness
included:
{count}.
Medians of the thread's time of calls in turn, assembly of the model left out. Errors are the
largest relative ones over SciPy's frequencies: at n = 8 against 40 digits at every tenth of them,
beyond against the sweep, whose own bound (`rounding_error`) stands beside them.

## Time per node and frequency

{_times(rows)}

## Error

{_errors(rows)}

## Growth with the number of frequencies

{numbers}

## Growth with n

Exponent p of time ~ n^p between n = {ELEMENTS[-2]} and {ELEMENTS[-1]}:
{_exponents(rows)}.

## Memory

{LARGEST} different elements x {len(FREQUENCY)} frequencies, width 2, in a fresh process: resident
memory peaks {peak["peak"] - bare:.0f} MB above the {bare:.0f} MB of Python and its imports;
{peak["model"] - bare:.0f} MB are the model, {peak["peak"] - peak["model"]:.0f} MB the call, which
takes {peak["seconds"]:.1f} s.
"""


def _name(row: Row) -> str:
    tensed = ", tensed" if row.element == "tensed" else ""
    return f"{row.kind}{tensed}, width {3 if row.twist else 2}"


def _times(rows: list[Row]) -> str:
    head = ["scene", "n", "sweep 1000 f [ms]", "sweep [ns]", "solve_banded [ns]", "splu [ns]"]
    lines = []
    for row in rows:
        own, *others = (row.time.get(name) for name in SOLVERS)
        lines.append(
            [
                _name(row),
                str(row.elements),
                report.digits(1e6 * own * row.elements),
                *(report.digits(t and 1e9 * t) for t in (own, *others)),
                *(report.digits(t and t / own) for t in others),
            ]
        )
    return report.table([*head, "solve_banded / sweep", "splu / sweep"], lines)


def _errors(rows: list[Row]) -> str:
    head = ["scene", "n", "sweep's bound", *SOLVERS]
    lines = [
        [
            _name(row),
            str(row.elements),
            f"{row.bound:.0e}",
            *(f"{row.error[name]:.0e}" if name in row.error else "-" for name in SOLVERS),
        ]
        for row in rows
        if row.error
    ]
    return report.table(head, lines)


def _exponents(rows: list[Row]) -> str:
    def exponent(one: Row, ten: Row, name: str) -> float:
        return 1 + float(np.log10(ten.time[name] / one.time[name]))

    pairs = [(a, b) for a, b in pairwise(rows) if b.elements == ELEMENTS[-1] and b.error]
    own = [f"{_name(a)} {exponent(a, b, 'sweep'):.2f}" for a, b in pairs]
    others = [f"{name} {exponent(*pairs[0], name):.2f}" for name in SOLVERS[1:]]
    return ",\n".join([*own, *others])


def plot(rows: list[Row]) -> None:
    figure, axes = report.panels()
    for column, twist in enumerate((False, True)):
        time, error = axes[:, column]
        chosen = {
            kind: [r for r in rows if r.kind == kind and r.twist == twist and r.error]
            for kind in scene.KINDS
        }
        for k, (kind, of_kind) in enumerate(chosen.items()):
            n = [r.elements for r in of_kind]
            color = f"C{k}"
            time.loglog(
                n,
                [1e6 * r.time["sweep"] * r.elements for r in of_kind],
                "o-",
                color=color,
                label=f"ropedyn, {kind}",
            )
            error.loglog(
                n, [r.bound for r in of_kind], "o-", color=color, label=f"ropedyn's bound, {kind}"
            )
        of_kind = chosen["different"]
        for k, name in enumerate(SOLVERS[1:], start=3):
            n = [r.elements for r in of_kind]
            spent = [1e6 * r.time[name] * r.elements for r in of_kind]
            time.loglog(n, spent, "s--", color=f"C{k}", label=f"SciPy {name}")
            error.loglog(
                n,
                [r.error[name] for r in of_kind],
                "s--",
                color=f"C{k}",
                label=f"SciPy {name}, different",
            )
        known = [r for r in rows if r.twist == twist and "sweep" in r.error]
        error.loglog(
            [r.elements for r in known],
            [r.error["sweep"] for r in known],
            "kx",
            label="ropedyn, against 40 digits",
        )
        time.set_title("with twist and lay (width 3)" if twist else "bending (width 2)")
        error.set_xlabel("elements")
    labels = ("time of 1000 frequencies [ms]", "largest relative error or bound [1]")
    report.save(figure, axes, "frf.png", "Frequency response 10 to 400 Hz, one core", labels)


def main() -> None:
    if sys.argv[1:] == ["--memory"]:
        memory_here()
        return
    rows = []
    for twist in (False, True):
        for kind in scene.KINDS:
            for n in ELEMENTS:
                rows.append(measure(kind, twist, n))
                print(".", end="", flush=True)
    rows.append(measure_own("uniform", False, LARGEST, "rigid"))
    for twist in (False, True):
        for kind in ("masses", "different"):
            rows += [measure_own(kind, twist, n, "tensed") for n in (1000, 10_000)]
    print()
    report.write("frf.md", page(rows, over_frequencies(), memory()))
    plot(rows)


if __name__ == "__main__":
    main()
