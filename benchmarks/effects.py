"""What each effect of a scene changes and costs: modes and a response of a short rope.

And what each costs alone, on a rope that has nothing but tension and bending.

python benchmarks/effects.py
"""

# isort: off
import timing  # before numpy

# isort: on
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import report

import ropedyn as rd

os.environ["ROPEDYN_THREADS"] = "1"

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

BASE = rd.Scene(rd.Rope(1.35, 0.1017, bending_stiffness=1.54), tension=2830.0)
TWISTED = BASE.rope.replace(torsional_stiffness=0.1485, polar_inertia=2.0e-7)
STRETCHED = BASE.rope.replace(axial_stiffness=9e5)
BENT = TWISTED.replace(length=rd.Axis.arc(20.0, 1.35 / 20.0), axial_stiffness=9e5)
LINES = np.linspace(1.0, 700.0, 1000)


def with_part(part: Any) -> rd.Scene:
    return BASE.replace(parts=[part])


def with_damping(damping: Any) -> rd.Scene:
    return BASE.replace(damping=damping)


ALONE = {
    "nothing": BASE,
    "no bending": BASE.without("bending"),
    "twist": BASE.replace(rope=TWISTED),
    "twist and lay": BASE.replace(rope=TWISTED.replace(lay_slope=0.01)),
    "stretch": BASE.replace(rope=STRETCHED),
    "stretch and sag": BASE.replace(rope=STRETCHED, gravity=rd.Gravity()),
    "rotary inertia": BASE.replace(rope=BASE.rope.replace(rotary_inertia=1e-7)),
    "point mass": with_part(rd.PointMass(0.4, 0.005)),
    "spring": with_part(rd.Spring(0.4, 1e3)),
    "dashpot": with_part(rd.Dashpot(0.4, 1.0)),
    "hinge": with_part(rd.Hinge(0.4, stiffness=40.0)),
    "resonator": with_part(rd.Resonator(0.4, 0.007, 58.0, damping_ratio=0.1)),
    "broken wire": with_part(rd.BrokenWire(0.4, 0.03, 3e-4, radius=1.85e-3)),
    "added mass": with_part(rd.AddedMass(0.4, 0.5, 0.02)),
    "local change": with_part(rd.LocalChange(0.4, 0.5, bending=0.8)),
    "stiffness damping": with_damping(rd.StiffnessDamping(1e-5)),
    "rayleigh damping": with_damping(rd.RayleighDamping(1.0, 1e-6)),
    "loss factor": with_damping(rd.LossFactor(1e-3)),
    "viscous damping": with_damping(rd.ViscousDamping(0.1)),
    "modal damping": with_damping(rd.ModalDamping(0.01)),
    "support": with_part(rd.Support(0.4)),
    "own weight": BASE.replace(gravity=rd.Gravity(inclination=0.5)),
    "second plane": BASE.replace(planes="both"),
    "axis, with all it needs": BASE.replace(rope=BENT, planes="both"),
}
"""Scenes with one effect more than the first."""


def main() -> None:
    costs = [rd.effect_cost(SCENE, question, repeat=101) for question in QUESTIONS]
    report.write("effects.md", f"{page(costs)}\n\n{alone()}")
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


def alone() -> str:
    """Time every scene of `ALONE` from the scene to the answer."""

    def modes(scene: rd.Scene) -> Callable[[], Any]:
        return lambda: scene.compile().modes(10)

    def response(scene: rd.Scene) -> Callable[[], Any]:
        return lambda: scene.compile().frf(LINES, drive=("z", 0.5))

    times = [
        timing.quartiles({name: ask(scene) for name, scene in ALONE.items()}, repeat=51)
        for ask in (modes, response)
    ]
    columns = ("ms", "quartiles", "ratio")
    head = ["with", *(f"{k}: {c}" for k in ("modes", "response") for c in columns)]
    lines = []
    for name in ALONE:
        line = [name]
        for of in times:
            lower, median, upper = (report.digits(1e3 * t) for t in of[name])
            ratio = of[name][1] / of["nothing"][1]
            line += [median, f"{lower} to {upper}", f"{ratio:.2f}"]
        lines.append(line)
    return f"""## What one effect costs alone

The same rope with nothing but tension and bending, and with one thing more (or less): 10 modes and
a response of {len(LINES)} lines, ratios to the first row. What a scene does not have is not
computed, so an effect that is not used costs nothing. Undamped modes know no damping; parts cut the
rope into two or three spans.

{report.table(head, lines)}"""


def draw(costs: list[rd.EffectCost]) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(14, 6), layout="constrained")
    for cost, ax in zip(costs, figure.subplots(1, 2)):
        cost.plot(ax).set_title(cost.question, fontsize="medium")
    figure.savefig(FIGURE, dpi=100)


if __name__ == "__main__":
    main()
