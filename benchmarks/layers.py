"""What Python costs around the core: from a scene to ten modes and to a response, step by step.

python benchmarks/layers.py
"""

# isort: off
import timing  # before numpy

# isort: on
import statistics
import time
from collections.abc import Callable
from functools import partial
from typing import Any
from unittest.mock import patch

import numpy as np
import report

import ropedyn as rd
from ropedyn import _core

LINES = np.linspace(1.0, 700.0, 1000)
ENTRIES = ("section", "divide", "count", "certify", "steps", "sweep")
REPEAT, LEAST = 51, 2e-3  # How often the core's share is taken; a measurement takes so long [s].


def string() -> rd.Scene:
    damping = rd.ViscousDamping(0.3)
    return rd.Scene(rd.Rope(1.35, 0.1017), tension=2830.0, damping=damping)


def tensed() -> rd.Scene:
    soft, stiff = (rd.End(beta="free", spring={"beta": k}) for k in (20.0, 30.0))
    return rd.Scene(
        rd.Rope(1.35, 0.1017, bending_stiffness=1.54),
        tension=2830.0,
        ends=(soft, stiff),
        damping=rd.StiffnessDamping(1e-4),
        parts=[rd.PointMass(0.5, 0.05)],
    )


def laid() -> rd.Scene:
    rope = rd.Rope(
        1.35,
        0.1017,
        bending_stiffness=1.54,
        torsional_stiffness=0.1485,
        axial_stiffness=9e5,
        lay_slope=0.01,
        polar_inertia=1.4e-7,
    )
    return rd.Scene(
        rope,
        tension=2830.0,
        damping=rd.StiffnessDamping(1e-4),
        parts=[
            rd.LocalChange(0.3, 0.5, bending=0.7),
            rd.PointMass(0.6, 0.05),
            rd.Spring(0.9, 1e3),
            rd.Resonator(0.7, 0.01, 40.0, damping_ratio=0.01),
        ],
        gravity=rd.Gravity(),
    )


SCENES = {
    "string": string,
    "tensed, two end springs, a mass": tensed,
    "the study's": rd.study2015.scene,
    "laid, with sag, wear, a mass, a spring, a resonator": laid,
}


def ten_modes(model: rd.Model) -> tuple[Any, ...]:
    modes = model.modes(10)
    return modes.frequency, modes.rounding_error, modes.certified


def response(model: rd.Model) -> rd.FRF:
    return model.frf(LINES, drive=("z", 0.5), threads=1)


def in_core(call: Callable[[], Any]) -> float:
    """Return the median time of a call that the core's entry points take [s]."""
    spent = 0.0

    def timed(entry: Callable[..., Any], *arguments: Any) -> Any:
        nonlocal spent
        start = time.process_time()
        try:
            return entry(*arguments)
        finally:
            spent += time.process_time() - start

    times = []
    with patch.multiple(_core, **{n: partial(timed, getattr(_core, n)) for n in ENTRIES}):
        for _ in range(REPEAT):
            spent = 0.0
            call()
            times.append(spent)
    return statistics.median(times)


def measure(make: Callable[[], rd.Scene]) -> list[float]:
    """Return times: of each step, the core's in two of them, and of all to ten modes [s]."""
    scene = make()
    model = scene.compile()
    steps = {
        "scene": make,
        "compile": scene.compile,
        "modes": partial(ten_modes, model),
        "frf": partial(response, model),
        "all": lambda: ten_modes(make().compile()),
    }
    times = timing.medians(steps, budget=2.0, least=LEAST)
    modes, frf = in_core(steps["modes"]), in_core(steps["frf"])
    own = [times["modes"], modes, times["frf"], frf]
    return [times["scene"], times["compile"], *own, times["all"]]


def page(rows: list[list[str]]) -> str:
    head = ["rope", "scene", "compile", "10 modes", "core", "1000 lines", "core", "scene to modes"]
    return f"""# Layers

{report.machine()}.
Medians of processor time in ms, of several calls in a row that take turns: making the description,
compiling it to continuous spans, asking the compiled model for ten certified modes and for the
receptance at {len(LINES)} frequencies, with the core's own time of each; and the whole way from a
new scene to ten modes. Shapes are not among them: what is read first pays for what it needs. The
scenes are those of `benchmarks/layers.py`.

{report.table(head, rows)}
"""


def main() -> None:
    rows = []
    for name, make in SCENES.items():
        rows.append([name, *(f"{1e3 * t:.3f}" for t in measure(make))])
        print(".", end="", flush=True)
    print()
    report.write("layers.md", page(rows))


if __name__ == "__main__":
    main()
