"""Continuous spans: beside closed forms by hand and finite elements.

python benchmarks/continuous.py
"""

# isort: off
import timing  # before numpy

# isort: on
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import closed_form
import exact_spans
import finite_elements
import frf
import modes
import numpy as np
import report
import scene

import ropedyn as rd
from ropedyn import _core
from ropedyn.chain.port import ports
from ropedyn.response.question import Question

FREQUENCY = frf.FREQUENCY
EXACT, FEW = slice(None, None, 10), slice(None, None, 50)
"""Frequencies that errors are measured at, and that finite elements are timed with."""
NUMBER = modes.NUMBER
DRIVE = ("z", 3 * scene.LENGTH / 8)
ROPES = {
    "uniform": scene.scene(),
    "three parts": scene.scene(
        [
            rd.PointMass(scene.LENGTH / 4, 0.02),
            rd.Spring(scene.LENGTH / 2, 1e4),
            rd.PointMass(3 * scene.LENGTH / 4, 0.03),
        ]
    ),
}
ELEMENTS = (32, 64, 128, 160, 192, 256, 448, 512, 640, 768, 1024, 1536, 2048)
"""A node at the drive and at every part: multiples of eight."""
ENOUGH = 1e-6
"""Error that finite elements are asked for at the least cost."""
LINES, MODES = f"{len(FREQUENCY)} frequencies", f"{NUMBER} modes"
GOALS = {
    ("uniform", LINES, "ropedyn"): 0.3e-3,
    ("uniform", MODES, "ropedyn"): 0.2e-3,
    ("uniform", MODES, "ropedyn's core"): 0.1e-3,
    ("three parts", LINES, "ropedyn"): 1e-3,
    ("three parts", MODES, "ropedyn"): 0.5e-3,
}
"""[s]."""


@dataclass(frozen=True)
class Solver:
    """A way to the answer: the call that is timed, for a share of the answer, and its error."""

    name: str
    call: Callable[[], Any]
    error: float | None
    bound: float | None = None
    elements: int | None = None
    share: float = 1.0

    @property
    def key(self) -> str:
        return f"{self.name} {self.elements}"


@dataclass(frozen=True)
class Row:
    """What a solver takes for a question [s], and its largest relative error."""

    rope: str
    question: str
    solver: Solver
    time: float


# --- the frequency response -------------------------------------------------------------------


def of_lines(rope: rd.Scene) -> list[Solver]:
    right = np.array([exact_spans.receptance(rope, DRIVE[1], f) for f in FREQUENCY[EXACT].tolist()])

    def error(value: np.ndarray) -> float:
        return float(np.max(np.abs(value / right - 1)))

    model = rope.compile()
    own = partial(model.frf, FREQUENCY, drive=DRIVE, threads=1)
    answer = own()
    bound = float(np.max(answer.rounding_error[0, EXACT]))
    solvers = [
        Solver("ropedyn", own, error(answer.value[0, EXACT]), bound),
        Solver("ropedyn's core", core_sweep(model), None),
    ]
    parts = [by_hand(part) for part in rope.parts]
    closed = partial(span().receptance, DRIVE[1], parts=parts)
    solvers.append(
        Solver("closed form", partial(closed, FREQUENCY), error(closed(FREQUENCY[EXACT])))
    )
    share = len(FREQUENCY[FEW]) / len(FREQUENCY)
    for n in ELEMENTS:
        at = finite_elements.unknown(DRIVE[1], scene.LENGTH / n)
        solve = frf.Assembled(*finite_elements.matrices(rope, n), at).solve_banded
        call = partial(solve, FREQUENCY[FEW])
        value = solve(FREQUENCY[EXACT])
        solvers.append(Solver("solve_banded", call, error(value), elements=n, share=share))
    return solvers


def core_sweep(model: rd.Model) -> Callable[[], Any]:
    """Return what `Model.frf` asks of the core."""
    question = Question(model, model.components[0], FREQUENCY, [DRIVE], [DRIVE], 1)
    chain, x = question.cut
    points = ports(chain, x, question.component, [DRIVE])
    return partial(_core.sweep, chain, question.factor, points, points)


def by_hand(part: rd.PointMass | rd.Spring) -> closed_form.Part:
    if isinstance(part, rd.PointMass):
        return closed_form.Part(part.x, mass=part.mass)
    return closed_form.Part(part.x, stiffness=part.stiffness)


def span() -> closed_form.Span:
    return closed_form.Span(
        scene.LENGTH, scene.DENSITY, scene.BENDING, scene.TENSION, gamma=scene.GAMMA
    )


# --- modes ------------------------------------------------------------------------------------


def of_modes(rope: rd.Scene) -> list[Solver]:
    finest = _eigsh(rope, 1024)()
    right = np.array([exact_spans.frequency_near(rope, f) for f in finest.tolist()])

    def error(frequency: np.ndarray) -> float:
        return float(np.max(np.abs(frequency / right - 1)))

    model = rope.compile()
    own = partial(model.modes, NUMBER)
    answer = own()
    bound = float(np.max(answer.rounding_error / answer.frequency))
    solvers = [
        Solver("ropedyn", own, error(answer.frequency), bound),
        Solver("ropedyn's core", core_certify(model), None),
    ]
    if not rope.parts:
        for name, find in (("brentq", span().brentq), ("Newton", span().newton)):
            solvers.append(Solver(name, partial(find, NUMBER), error(find(NUMBER))))
    for n in ELEMENTS:
        call = _eigsh(rope, n)
        solvers.append(Solver("eigsh", call, error(call()), elements=n))
    return solvers


def _eigsh(rope: rd.Scene, elements: int) -> Callable[[], np.ndarray]:
    stiffness, _, mass = finite_elements.matrices(rope, elements)
    return modes.Assembled(stiffness, mass).eigsh


def core_certify(model: rd.Model) -> Callable[[], Any]:
    """Return what `Model.modes` asks of the core."""
    chain = model.chain.only(model.components[0])
    chains = [chain.between(first, last) for first, last in chain.spans]

    def certify() -> None:
        for one in chains:
            _core.certify(
                one, NUMBER if one.finite is None else min(NUMBER, one.finite), math.inf, False
            )

    return certify


def measure(rope: str, question: str) -> list[Row]:
    solvers = {LINES: of_lines, MODES: of_modes}[question](ROPES[rope])
    # least: the clock's own time and cold caches are less than a per cent of it
    times = timing.medians({s.key: s.call for s in solvers}, budget=10.0, least=5e-3)
    return [Row(rope, question, s, times[s.key] / s.share) for s in solvers]


# --- what is written --------------------------------------------------------------------------


def page(rows: list[Row], compiling: dict[str, float]) -> str:
    added = " and ".join(f"{1e3 * t:.2g} ms ({name})" for name, t in compiling.items())
    return f"""# Continuous spans

{report.machine()}. T = 2830 N, B = 1.54 N m^2, 1.35 m, 0.1017 kg/m, clamped,
StiffnessDamping(1e-4) in the response, driven and watched at 3/8 of the length, 10 to 400 Hz.
Three parts are 0.02 kg at 1/4, 10 kN/m at 1/2 and 0.03 kg at 3/4.

- ropedyn: `scene.compile()` and from it `model.frf(...)` and `model.modes({NUMBER})`, with bounds
  of errors and the certificate that no mode is missing; its core is the same without Python.
- closed form: the reflections of waves from clamps and parts, in NumPy over all frequencies.
- brentq: the scaled characteristic equation of the uniform rope, a mode at a time; Newton: the
  same, all modes at once in NumPy.
- solve_banded, eigsh: Hermite elements with consistent mass and geometric stiffness, for the least
  n whose error is at most {ENOUGH:.0e}, if there is one, and for the n of least error. SciPy is
  given {len(FREQUENCY[FEW])} frequencies, filling the dynamic stiffness included.

Medians of processor times of calls in turn, without assembling and compiling, which takes
{added} more. Errors are the largest relative ones against transfer
matrices in {exact_spans.DIGITS} digits, of responses at every tenth frequency.

## {LINES}

{_table(rows, LINES)}

## {MODES.capitalize()}

{_table(rows, MODES)}

## Goals

{_goals(rows)}
"""


def _table(rows: list[Row], question: str) -> str:
    head = ["rope", "solver", "n", "time [ms]", "/ ropedyn", "error", "bound"]
    lines = []
    for rope in ROPES:
        asked = [r for r in rows if (r.rope, r.question) == (rope, question)]
        lines += [
            [
                rope,
                row.solver.name,
                str(row.solver.elements or "-"),
                report.digits(1e3 * row.time),
                report.digits(row.time / asked[0].time),
                *(_power(e) for e in (row.solver.error, row.solver.bound)),
            ]
            for row in _chosen(asked)
        ]
    return report.table(head, lines)


def _power(error: float | None) -> str:
    return "-" if error is None else f"{error:.0e}"


def _chosen(rows: list[Row]) -> list[Row]:
    """Return all but the finite elements that are neither the first good ones nor the best."""
    meshed = [row for row in rows if row.solver.elements]
    best = min(meshed, key=lambda row: row.solver.error)
    enough = next((row for row in meshed if row.solver.error <= ENOUGH), best)
    return [row for row in rows if not row.solver.elements or row in (enough, best)]


def _goals(rows: list[Row]) -> str:
    time = {(row.rope, row.question, row.solver.name): row.time for row in rows}
    lines = [
        [
            ", ".join(asked),
            report.digits(1e3 * goal),
            report.digits(1e3 * time[asked]),
            "yes" if time[asked] <= goal else "no",
        ]
        for asked, goal in GOALS.items()
    ]
    return report.table(["question", "goal [ms]", "measured [ms]", "reached"], lines)


def plot(rows: list[Row]) -> None:
    figure, axes = report.panels()
    for line, question in zip(axes, (LINES, MODES)):
        for ax, rope in zip(line, ROPES):
            asked = [r for r in rows if (r.rope, r.question) == (rope, question)]
            # in the order of the uniform rope, whose names the legend tells
            for name, style in _styles(rows, question).items():
                known = [r for r in asked if r.solver.name == name and r.solver.error is not None]
                ax.loglog(
                    [1e3 * r.time for r in known],
                    # what has no wrong digit is known to half of the last one
                    [max(r.solver.error, np.finfo(float).eps / 2) for r in known],
                    style,
                    label=name,
                )
            ax.set_title(f"{rope}, {question}")
    for ax in axes[-1]:
        ax.set_xlabel("time [ms]")
    labels = (f"largest relative error of {LINES} [1]", f"largest relative error of {MODES} [1]")
    report.save(figure, axes, "continuous.png", "Continuous spans, one core", labels)


def _styles(rows: list[Row], question: str) -> dict[str, str]:
    """Return the style of each solver that has an error: a line where there are meshes."""
    styles = {}
    for row in rows:
        if row.question == question and row.solver.error is not None:
            mark = "s--" if row.solver.elements else "o" if row.solver.name == "ropedyn" else "^"
            styles.setdefault(row.solver.name, f"C{len(styles)}{mark}")
    return styles


def main() -> None:
    rows = []
    for rope in ROPES:
        for question in (LINES, MODES):
            rows += measure(rope, question)
            print(".", end="", flush=True)
    print()
    compiling = {name: rope.compile for name, rope in ROPES.items()}
    report.write("continuous.md", page(rows, timing.medians(compiling, least=5e-3)))
    plot(rows)


if __name__ == "__main__":
    main()
