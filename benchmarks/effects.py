"""What each effect of a scene changes and costs: modes and a response of a short rope.

python benchmarks/effects.py
"""

# isort: off
import timing  # noqa: F401  before numpy

# isort: on
from pathlib import Path

import numpy as np
import report

import ropedyn as rd

FIGURE = Path(__file__).parent.parent / "docs" / "effects.png"

SCENE = rd.Scene(
    rd.Rope(
        1.35,
        0.1017,
        bending_stiffness=1.54,
        torsional_stiffness=0.1485,
        lay_slope=0.01,
        rotary_inertia=1.0e-7,
        polar_inertia=2.0e-7,
    ),
    tension=2830.0,
    ends=("clamped", rd.End(beta="free", spring={"beta": 20.0})),
    damping=rd.StiffnessDamping(1e-5),
    parts=[rd.PointMass(0.4, 0.005), rd.Hinge(0.9, stiffness=40.0)],
)
"""The study's rope as its measured peaks have it, with the study's torsion and lay, inertias of a
round rope of 4 mm, an accelerometer of 5 g, an elastic clamp and a bend made soft by broken wires;
these are made up."""

QUESTIONS = (rd.ask.modes(10), rd.ask.frf(np.linspace(1.0, 700.0, 400), drive=("z", 0.5)))


def main() -> None:
    costs = [rd.effect_cost(SCENE, question, repeat=101) for question in QUESTIONS]
    report.write("effects.md", page(costs))
    draw(costs)


# --- what is written --------------------------------------------------------------------------


def page(costs: list[rd.EffectCost]) -> str:
    tables = "\n\n".join(
        f"## {cost.question[0].upper()}{cost.question[1:]}\n\n{rows(cost)}" for cost in costs
    )
    return f"""# What each effect changes and costs

{report.machine()}.
Times are medians of the processor from the scene to the answer, in ms, with quartiles; changes are
those that leaving the effect out makes. The scene is that of `benchmarks/effects.py`.

{tables}"""


def rows(cost: rd.EffectCost) -> str:
    head = ["left out", "ms", "quartiles", "effect costs", *cost.change, "beyond error bars"]
    found = cost.table().to_records()
    lines = []
    for row in found:
        times = [row[f"{name} [s]"] for name in ("time", "lower quartile", "upper quartile")]
        milliseconds, *quartiles = (report.digits(t and 1e3 * t) for t in times)
        lines.append(
            [
                row["left out"],
                milliseconds,
                " to ".join(quartiles),
                row["effect costs"] or "",
                *(report.digits(row[name]) for name in cost.change),
                note(row),
            ]
        )
    return report.table(head, lines)


def note(row: dict[str, object]) -> str:
    lost = row["only with it"]
    return f"{row['changes the answer'] or ''}{f', {lost} only with it' if lost else ''}"


def draw(costs: list[rd.EffectCost]) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(14, 6), layout="constrained")
    for cost, ax in zip(costs, figure.subplots(1, 2)):
        cost.plot(ax).set_title(cost.question, fontsize="medium")
    figure.savefig(FIGURE, dpi=100)


if __name__ == "__main__":
    main()
