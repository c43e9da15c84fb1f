"""Modes, shapes and many lines of ropes that stand upright, hang on a catenary, or are curved.

python benchmarks/lines.py
"""

# isort: off
import timing  # before numpy

# isort: on
import math
import time
from collections.abc import Callable

import numpy as np
import report

import ropedyn as rd

REPEAT = 7
COUNT = 1000


def upright(bending: float | None) -> rd.Scene:
    """A hoist rope of 1000 m."""
    rope = rd.Rope(1000.0, 8.4, bending_stiffness=bending)
    up = rd.Gravity(9.81, inclination=math.pi / 2)
    return rd.Scene(rope, tension=rd.Tension(196e3, at="start"), gravity=up)


def across(sag: float, parameter: float, bending: float | None) -> rd.Scene:
    """A level rope of 100 m, of some sag [spans] and lambda^2."""
    slope = 8 * sag
    tension = 2.0 * 9.81 * 100.0 / slope
    axial = parameter * tension / slope**2 * (1 + slope**2 / 8)
    rope = rd.Rope(100.0, 2.0, axial_stiffness=axial, bending_stiffness=bending)
    return rd.Scene(rope, tension=tension, gravity=rd.Gravity(9.81))


def curved(axis: rd.Axis, diameter: float) -> rd.Scene:
    """A round steel wire, clamped at both ends."""
    second = math.pi * diameter**4 / 64
    rope = rd.Rope(
        axis,
        7850.0 * math.pi * diameter**2 / 4,
        bending_stiffness=206e9 * second,
        torsional_stiffness=79.2e9 * 2 * second,
    )
    return rd.Scene(rope, planes="both")


SCENES = {
    "hoist rope, B = 2000 N m^2": upright(2000.0),
    "the same as a string": upright(None),
    "string, sag 0.06 L": across(0.06, 500.0, None),
    "rope, sag 0.06 L": across(0.06, 500.0, 50.0),
    "rope, sag 0.2 L": across(0.2, 1e4, 50.0),
    "arc of 2 rad, both planes": curved(rd.Axis.arc(1.0, 2.0), 0.01),
    "spring of ten turns": curved(rd.Axis.helix(0.005, math.radians(8.5744), 10), 0.001),
}


def least(call: Callable[[], object]) -> float:
    """Return the least time of the processor [ms]."""
    times = []
    for _ in range(REPEAT):
        start = time.process_time()
        call()
        times.append(time.process_time() - start)
    return 1e3 * min(times)


def row(name: str, scene: rd.Scene) -> list[str]:
    """Times of ten modes, of twelve shapes beside their modes, and of the lines [ms]."""
    length = scene.rope.length
    top = scene.compile().modes(10).frequency[-1]
    lines = np.linspace(0.0123, 1.00123, COUNT) * top
    ask = {"drive": ("z", 0.25 * length), "response": ("z", 0.7 * length)}
    modes = least(lambda: scene.compile().modes(10).frequency)
    twelve = least(lambda: scene.compile().modes(12).frequency)
    shapes = least(lambda: scene.compile().modes(12).shape) - twelve
    every = least(lambda: scene.compile().frf(lines, **ask))
    return [name, *(report.digits(one) for one in (modes, shapes, every))]


def main() -> None:
    assert timing
    head = ["rope", "ten modes", "shapes of twelve", f"{COUNT} lines"]
    table = report.table(head, [row(name, scene) for name, scene in SCENES.items()])
    text = f"""# Modes, shapes and lines of ropes that are graded or curved

{report.machine()}.
The least processor time of {REPEAT} calls in ms, compiling included: ten modes, the shapes of
twelve beside their frequencies, and {COUNT} lines up to the tenth mode.

{table}
"""
    report.write("lines.md", text)


if __name__ == "__main__":
    main()
