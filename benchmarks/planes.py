"""What the second plane costs: ten certified modes of scenes alike in both planes, and in one.

python benchmarks/planes.py
"""

# isort: off
import timing  # before numpy

# isort: on
from functools import partial

import report

import ropedyn as rd

LEAST = 2e-3  # A measurement takes so long [s].
SPRUNG = rd.End(beta="free", gamma="free", spring={"beta": 20.0, "gamma": 20.0})
BEAM = rd.Rope(1.35, 0.1017, bending_stiffness=1.54)
SCENES = {
    "string": rd.Scene(rd.Rope(1.35, 0.1017), tension=2830.0, planes="both"),
    "clamped": rd.Scene(BEAM, tension=2830.0, planes="both"),
    "springs, a mass": rd.Scene(
        BEAM,
        tension=2830.0,
        ends=(SPRUNG, SPRUNG),
        parts=[rd.PointMass(0.5, 0.05, rotary_inertia=1e-5)],
        planes="both",
    ),
}
KINDS = {"spans": {}, "64 elements": {"elements": 64}}


def row(name: str, kind: str) -> list[str]:
    """Times of ten modes and of their shapes, in one plane and in both [us], and the ratios."""
    both = SCENES[name]
    models = [s.compile(**KINDS[kind]) for s in (both.without("second plane"), both)]
    assert all(model.modes(10).certified for model in models)
    calls = {
        f"{what} {k}": partial(ask, model)
        for what, ask in (("modes", lambda m: m.modes(10)), ("shapes", lambda m: m.modes(10).shape))
        for k, model in enumerate(models)
    }
    times = timing.medians(calls, budget=2.0, least=LEAST)
    found = [name, kind]
    for what in ("modes", "shapes"):
        one, two = (times[f"{what} {k}"] for k in range(2))
        found += [f"{1e6 * one:.0f}", f"{1e6 * two:.0f}", f"{two / one:.2f}"]
    return found


def page(rows: list[list[str]]) -> str:
    head = ["rope", "model", "one plane", "both", "ratio", "one, shapes", "both, shapes", "ratio"]
    return f"""# Two planes

{report.machine()}.
Medians of processor time in us of calls in turn: the ten lowest modes, certified, of scenes that
are alike in both planes, so that every frequency is double, and of one plane of them; then the same
with shapes.

{report.table(head, rows)}
"""


def main() -> None:
    report.write("planes.md", page([row(name, kind) for name in SCENES for kind in KINDS]))


if __name__ == "__main__":
    main()
