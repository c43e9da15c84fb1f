"""What coordinates that move together cost: ten modes and 1000 lines of ropes of one to six.

python benchmarks/widths.py
"""

# isort: off
import timing  # before numpy

# isort: on
from functools import partial

import numpy as np
import report

import ropedyn as rd

LEAST = 2e-3  # A measurement takes so long [s].
LINES = np.linspace(1.0, 450.0, 1000)
BEAM = rd.Rope(1.35, 0.1017, bending_stiffness=1.54)
TWISTED = BEAM.replace(torsional_stiffness=0.1485, polar_inertia=1.4e-7)
LAID = TWISTED.replace(lay_slope=0.01)
TURNED = {"bending_stiffness": (1.54, 1.2), "principal_angle": 0.3}
LEVEL = rd.Gravity()


def scene(rope: rd.Rope, **more: object) -> rd.Scene:
    """Return the rope under the tension of all of them."""
    return rd.Scene(rope, tension=2830.0, **more)


SCENES = {
    "string": ("z", scene(rd.Rope(1.35, 0.1017))),
    "rope": ("z, beta", scene(BEAM)),
    "laid rope": ("z, alpha, beta", scene(LAID)),
    "hanging rope": ("x, z, beta", scene(BEAM.replace(axial_stiffness=1e6), gravity=LEVEL)),
    "laid rope that hangs": (
        "x, z, alpha, beta",
        scene(LAID.replace(axial_stiffness=1e6), gravity=LEVEL),
    ),
    "turned axes": ("y, z, beta, gamma", scene(TWISTED.replace(**TURNED), planes="both")),
    "laid, turned axes": (
        "y, z, alpha, beta, gamma",
        scene(LAID.replace(**TURNED), planes="both"),
    ),
    "laid and coupled, turned axes": (
        "all",
        scene(
            LAID.replace(**TURNED, axial_stiffness=1e6, lay_coupling=20.0),
            planes="both",
        ),
    ),
}
KINDS = {"spans": {}, "64 elements": {"elements": 64}}


def rows(kind: str) -> list[list[str]]:
    """Times of lines and modes [ms], and over those of two coordinates."""
    models = {
        name: one.compile(**KINDS[kind])
        for name, (_, one) in SCENES.items()
        if kind == "spans" or not one.is_spatial
    }
    assert all(np.all(model.modes(10).certified) for model in models.values())
    calls = {}
    for name, model in models.items():
        calls[name, "lines"] = partial(model.frf, LINES, drive=("z", 0.3))
        calls[name, "modes"] = partial(lambda m: m.modes(10).eigenvalue, model)
    times = timing.medians(calls, budget=3.0, least=LEAST)
    found = []
    for name, model in models.items():
        row = [name, SCENES[name][0], type(model).__name__]
        for what in ("lines", "modes"):
            time, two = times[name, what], times["rope", what]
            row += [f"{1e3 * time:.2f}", f"{time / two:.1f}"]
        found.append(row)
    return found


def page() -> str:
    head = ["rope", "together", "solved as", "1000 lines", "over two", "ten modes", "over two"]
    tables = "\n\n".join(f"## {kind}\n\n{report.table(head, rows(kind))}" for kind in KINDS)
    return f"""# Coordinates that move together

{report.machine()}.
Medians of processor time in ms of calls in turn, Python included: the response of z where it is
driven at 1000 frequencies up to 450 Hz, and the ten lowest modes, certified; and both over those of
z with beta.

{tables}
"""


def main() -> None:
    report.write("widths.md", page())


if __name__ == "__main__":
    main()
