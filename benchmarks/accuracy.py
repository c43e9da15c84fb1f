"""What accuracy costs in time: modes and responses of a short rope and of a long stay cable.

python benchmarks/accuracy.py
"""

# isort: off
import timing  # noqa: F401  before numpy

# isort: on
import numpy as np
import report

import ropedyn as rd

STAY = rd.Scene(
    rd.Rope(300.0, 90.0, bending_stiffness=1e6),
    tension=6e6,
    damping=rd.RayleighDamping(0.02, 0.0),
)
"""Made up, in the size of 73 strands of 150 mm^2; B between loose strands and a solid bar, damping
0.4 % of critical in the first mode."""

ROPES = {
    "the study's rope": (rd.study2015.scene(), np.linspace(1.0, 300.0, 200)),
    "a stay cable": (STAY, np.linspace(0.1, 5.0, 200)),
}


def questions(scene: rd.Scene, frequency: np.ndarray) -> list[rd.ask.AnyQuestion]:
    return [rd.ask.modes(10), rd.ask.frf(frequency, drive=("z", 3 * scene.rope.length / 8))]


def main() -> None:
    costs = {
        name: [rd.accuracy_cost(scene, q) for q in questions(scene, frequency)]
        for name, (scene, frequency) in ROPES.items()
    }
    report.write("accuracy.md", page(costs))
    draw(costs)


# --- what is written --------------------------------------------------------------------------


def page(costs: dict[str, list[rd.AccuracyCost]]) -> str:
    tables = "\n\n".join(
        f"## {name[0].upper()}{name[1:]}: {cost.question}\n\n{rows(cost)}"
        for name, asked in costs.items()
        for cost in asked
    )
    stay = STAY.rope
    return f"""# What accuracy costs in time

{report.machine()}.
Times are medians of the processor from the scene to the answer, compile and question, in ms, with
the quartiles of the question; errors are relative, the largest of all modes or lines, against
continuous spans, of these against other cuts of the same spans. "Lost" are the digits that rounding
took. The stay cable is made up: {stay.length:g} m, {stay.linear_density:g} kg/m,
{STAY.tension / 1e6:g} MN, {(stay.bending_stiffness or 0.0) / 1e6:g} MN m^2.

{tables}"""


def rows(cost: rd.AccuracyCost) -> str:
    head = ["way", "ms", "quartiles", "error", "estimated", "lost", "cheapest for"]
    found = cost.table().column("cheapest for")
    lines = []
    for k in range(len(cost.element)):
        if cost.refusal[k]:
            lines.append([cost.way(k), "refused", *["-"] * 5])
            continue
        quartiles = (cost.lower_quartile[k], cost.upper_quartile[k])
        lines.append(
            [
                cost.way(k),
                report.digits(1e3 * cost.total_seconds[k]),
                " to ".join(report.digits(1e3 * q) for q in quartiles),
                report.digits(cost.error[k]),
                report.digits(cost.estimated_error[k]),
                f"{cost.digits_lost[k]:.1f}",
                found[k] or "",
            ]
        )
    return report.table(head, lines)


def draw(costs: dict[str, list[rd.AccuracyCost]]) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(14, 11), layout="constrained")
    axes = figure.subplots(2, 2, sharex="row")
    for (name, asked), column in zip(costs.items(), axes.T):
        for cost, ax in zip(asked, column):
            cost.plot(ax).set_title(f"{name}: {cost.question}", fontsize="medium")
    figure.suptitle("What accuracy costs in time: processor time from the scene to the answer")
    figure.savefig(report.RESULTS / "accuracy.png", dpi=100)


if __name__ == "__main__":
    main()
