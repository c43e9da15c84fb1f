"""What accuracy costs in time: thirteen questions to typical scenes, and others' answers to some.

python benchmarks/accuracy.py measures, keeps the numbers with machine and date in
results/accuracy.json, and writes page and figure; with --draw it writes these from the file.
"""

# isort: off
import timing  # before numpy

# isort: on
import argparse
import dataclasses
import datetime
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import peers
import report
import scene as rope

import ropedyn as rd
from ropedyn.plot.figure import PURPLE

BEAM = rope.scene()
STAY = rd.Scene(
    rd.Rope(300.0, 90.0, bending_stiffness=1e6),
    tension=6e6,
    damping=rd.RayleighDamping(0.02, 0.0),
)
"""Made up, in the size of 73 strands of 150 mm^2; B between loose strands and a solid bar, damping
0.4 % of critical in the first mode."""
LOADED = rope.scene([rd.PointMass(rope.LENGTH * k / 20, 0.01) for k in range(1, 20)])
SAGGING = rd.Scene(
    rd.Rope(100.0, 5.0, bending_stiffness=1e3, axial_stiffness=5e7),
    tension=2e4,
    gravity=rd.Gravity(),
)
STRING = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=rd.RayleighDamping(6.0, 0.0))
STOPPED = STRING.replace(parts=[rd.Stop(0.5, 1e3, gap=2e-3)])
PULSATING = BEAM.replace(tension=rd.Tension(rope.TENSION, amplitude=300.0, frequency=128.0))
TIME = np.linspace(0.0, 0.2, 401)
DRIVE = ("z", 3 * rope.LENGTH / 8)
LINES = np.linspace(1.0, 300.0, 200)
MANY = (16, 64, 256, 1024, 4096, 10**6)
ROWS = np.linspace([2000.0, 1.0], [3600.0, 2.0], 100)
SMALLEST = 1.1e-16
"""Error that a price list gives to what is right to the last digit."""
ELEMENTS = (16, 32, 64, 128, 256, 512)
"""Of what others solve: nodes at drives and parts."""


@dataclasses.dataclass(frozen=True)
class Case:
    """A question to a scene, and how others answer it: their name, from so many elements."""

    name: str
    scene: rd.Scene
    question: rd.ask.AnyQuestion
    how: dict[str, Any] = dataclasses.field(default_factory=dict)
    peer: str = ""
    solve: Callable[[int], np.ndarray] | None = None
    elements: tuple[int, ...] = ELEMENTS


SINES = rd.Sine(1.0, 60.0), rd.Sine(1.0, 14.0)
PEAKS = rd.Peaks([25.1, 49.9, 75.0], std=0.1)
MEASURED = rd.Scene(rd.Rope(2.0, 0.1), tension=900.0)
DASHED = BEAM.replace(parts=[rd.Dashpot(rope.LENGTH / 8, 20.0)])

STORED = report.RESULTS / "accuracy.json"
CASES = (
    Case(
        "a clamped rope",
        BEAM,
        rd.ask.modes(10),
        {},
        "eigsh",
        lambda n: peers.modes_by_eigsh(BEAM, n, 10),
    ),
    Case(
        "a clamped rope",
        BEAM,
        rd.ask.frf(LINES, drive=DRIVE),
        {},
        "solve_banded",
        lambda n: peers.lines_by_solve_banded(BEAM, n, DRIVE[1], LINES),
    ),
    Case(
        "a clamped rope",
        BEAM,
        rd.ask.static({DRIVE: 10.0}),
        {},
        "spsolve",
        lambda n: peers.deflection_by_spsolve(BEAM, n, DRIVE[1], 10.0),
    ),
    Case(
        "a stay cable",
        STAY,
        rd.ask.modes(10),
        {"elements": MANY, "solver": "sweep"},
        "eigsh",
        lambda n: peers.modes_by_eigsh(STAY, n, 10),
    ),
    Case(
        "a rope with 19 masses",
        LOADED,
        rd.ask.count(below=1000.0),
        {},
        "eigvals_banded",
        lambda n: peers.count_by_eigvals_banded(LOADED, n, 1000.0),
        (20, 40, 80, 160),
    ),
    Case(
        "a rope with a dashpot",
        DASHED,
        rd.ask.modes(5, damped=True),
        {},
        "eigs",
        lambda n: peers.rates_by_eigs(DASHED, n, 5),
    ),
    Case(
        "a rope that sags",
        SAGGING,
        rd.ask.modes(5),
        {},
        "eigsh",
        lambda n: peers.sagging_modes_by_eigsh(SAGGING, n, 5),
    ),
    Case(
        "a driven rope",
        STRING,
        rd.ask.motion(TIME, drive=("z", 0.5), force=SINES[0]),
        {},
        "solve_ivp",
        lambda n: peers.motion_by_solve_ivp(STRING, n, TIME, SINES[0], 0.5),
        (16, 32, 64, 128, 256),
    ),
    Case(
        "a rope against a stop",
        STOPPED,
        rd.ask.motion(TIME, drive=("z", 0.5), force=SINES[1]),
        {},
        "solve_ivp",
        lambda n: peers.motion_by_solve_ivp(STOPPED, n, TIME, SINES[1], 0.5),
        (16, 32, 64, 128, 256),
    ),
    Case(
        "a rope against a stop",
        STOPPED,
        rd.ask.stepped_sine([12.0], drive=("z", 0.5), amplitude=1.0),
        {"elements": (8, 16, 32)},
        "solve_ivp",
        lambda n: peers.steady_by_solve_ivp(STOPPED, n, 12.0, 0.5),
        (8, 16, 32, 64),
    ),
    Case(
        "a pulsating tension",
        PULSATING,
        rd.ask.floquet(2),
        {},
        f"solve_ivp of {peers.MODES} modes",
        lambda n: peers.multipliers_by_solve_ivp(PULSATING, n),
        (8, 16, 32, 64, 128),
    ),
    Case(
        "peaks of a string",
        MEASURED,
        rd.ask.identify(PEAKS, "tension"),
        {},
        "curve_fit",
        lambda n: peers.tension_by_curve_fit(MEASURED, n, PEAKS),
    ),
    Case(
        "100 ropes",
        BEAM,
        rd.ask.family(["tension", "bending_stiffness"], ROWS, 5),
        {},
        "eigsh, one by one",
        lambda n: peers.ropes_by_eigsh(BEAM, n, ROWS, 5),
        (16, 32, 64, 128),
    ),
)


# --- what is measured -------------------------------------------------------------------------


def measured(case: Case) -> dict[str, Any]:
    """Return the price list of a case, and what others take for it, as JSON keeps them."""
    cost = rd.accuracy_cost(case.scene, case.question, **case.how)
    print(f"{case.name}: {cost.question}\n{cost.verdict}\n", flush=True)
    fields = {f.name: getattr(cost, f.name) for f in dataclasses.fields(cost)}
    kept = {k: v.tolist() if isinstance(v, np.ndarray) else v for k, v in fields.items()}
    kept["cost"] = vars(cost.cost)
    return {"name": case.name, "cost": kept, "peer": case.peer, "others": others(case)}


def others(case: Case) -> list[tuple[int, float, float]]:
    """Return elements, time from the scene to the answer [s] and largest relative error."""
    if case.solve is None:
        return []
    right = case.question.values(case.question.of(_placed(case).compile()))
    calls = {str(n): (lambda n=n: case.solve(n)) for n in case.elements}
    times = timing.medians(calls, budget=2.0)
    error = {n: float(np.max(case.question.apart(case.solve(n), right))) for n in case.elements}
    return [(n, times[str(n)], max(error[n], SMALLEST)) for n in case.elements]


def _placed(case: Case) -> rd.Scene:
    return case.question.placed(case.scene)


def rebuilt(kept: dict[str, Any]) -> rd.AccuracyCost:
    """Return a price list as it was measured."""
    arrays = {k: np.array(v) if isinstance(v, list) else v for k, v in kept.items()}
    return rd.AccuracyCost(**arrays | {"cost": rd.Cost(**kept["cost"])})


# --- what is written --------------------------------------------------------------------------


def page(stored: dict[str, Any]) -> str:
    cases = "\n\n".join(section(case) for case in stored["cases"])
    return f"""# What accuracy costs in time

{stored["machine"]}, {stored["date"]}: `python benchmarks/accuracy.py`.
Times are medians of the processor from the scene to the answer, compile and question; "with error
bar" also reads the errors of mesh and rounding, where answers tell them. Errors are relative, the
largest of all values, against continuous spans, of these against other cuts of the same spans. Of
each price list the rows are shown that no other one beats in time and in error, the same rows that
the figure joins by steps, and chains of 10^6; what others take (SciPy on cubic finite elements, of
strings on lumped masses) was measured in the same run, and their answers compared with continuous
spans. The stay cable is made up: 300 m, 90 kg/m, 6 MN, 1 MN m^2.

{cases}"""


def section(case: dict[str, Any]) -> str:
    cost = rebuilt(case["cost"])
    marks: dict[int, list[str]] = {}
    for tolerance, row in cost.cheapest.items():
        if row is not None:
            marks.setdefault(row, []).append(f"{tolerance:.0e}".replace("e-0", "e-"))
    head = ["way", "ms", "with error bar", "error", "lost", "MB", "cheapest for"]
    longest = np.flatnonzero((cost.elements == cost.elements.max()) & (cost.elements > 5000))
    shown = sorted(
        {*cost.front.tolist(), *marks, *longest.tolist()}, key=lambda k: cost.total_seconds[k]
    )
    rows = [
        [
            cost.way(k),
            report.digits(1e3 * cost.total_seconds[k]),
            milliseconds(cost.compile_seconds[k] + cost.seconds_with_bound[k]),
            report.digits(cost.error[k]),
            f"{cost.digits_lost[k]:.1f}".replace("nan", "-"),
            report.digits(cost.memory[k] / 1e6),
            ", ".join(marks.get(k, [])),
        ]
        for k in shown
    ]
    rows += [
        [f"{case['peer']}, {n}", report.digits(1e3 * time), "-", report.digits(error), "-", "-", ""]
        for n, time, error in case["others"]
    ]
    title = f"{case['name'][0].upper()}{case['name'][1:]}: {cost.question}"
    return f"## {title}\n\n{cost.verdict}\n\n{report.table(head, rows)}"


def milliseconds(seconds: float) -> str:
    return "-" if np.isnan(seconds) else report.digits(1e3 * seconds)


def draw(stored: dict[str, Any], path: Path) -> None:
    from matplotlib.figure import Figure

    count = len(stored["cases"])
    figure = Figure(figsize=(19, 6.2 * -(-count // 3)), layout="constrained")
    axes = figure.subplots(-(-count // 3), 3).ravel()
    for case, ax in zip(stored["cases"], axes):
        cost = rebuilt(case["cost"])
        cost.plot(ax)
        ax.set_title(f"{case['name']}: {ax.get_title()}", fontsize="small")
        if case["others"]:
            _, time, error = zip(*case["others"])
            ax.plot(time, error, "x--", color=PURPLE, label=f"{case['peer']}, finite elements")
            ax.legend(fontsize="small")
    for ax in axes[count:]:
        ax.remove()
    figure.suptitle(
        "What accuracy costs: largest relative error over processor time from the scene to the "
        f"answer, ropedyn's ways and others'.\n{stored['machine']}, {stored['date']}"
    )
    figure.savefig(path, dpi=65)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--draw", action="store_true", help="write from the stored numbers")
    file = STORED
    if not parser.parse_args().draw:
        stored = {
            "machine": report.machine(),
            "date": datetime.date.today().isoformat(),
            "cases": [measured(case) for case in CASES],
        }
        file.write_text(json.dumps(stored, indent=1) + "\n", encoding="utf-8")
    stored = json.loads(file.read_text(encoding="utf-8"))
    report.write("accuracy.md", page(stored))
    draw(stored, report.RESULTS / "accuracy.png")


if __name__ == "__main__":
    main()
