"""What a scene does not call for, beside the same without it: ratios of one run.

python benchmarks/absent.py
"""

# isort: off
import timing  # before numpy

# isort: on
from collections.abc import Callable
from typing import Any

import numpy as np
import report

import ropedyn as rd

LINES = np.linspace(1.0, 200.0, 10_000)
ROPE = rd.Rope(30.0, 1.0, bending_stiffness=50.0)
UNCOUPLED = {"axial_stiffness": 1e6, "torsional_stiffness": 10.0, "polar_inertia": 1e-6}
AT = [30.0 * (k + 1) / 301 * (1 + 3e-4 * (7 * k % 5)) for k in range(300)]
SHORT = rd.Rope(2.0, 0.1, bending_stiffness=0.8)
EIGHT = rd.Scene(
    SHORT,
    tension=1000.0,
    parts=[rd.PointMass(0.25 * k + 0.01 * k * (k % 3), 0.02) for k in range(1, 8)],
)
"""Eight spans between seven masses."""
DAMPED = rd.StiffnessDamping(1e-5)


def masses(rope: rd.Rope, mass: float) -> rd.Model:
    """A beam with 300 masses, no two spans alike."""
    return rd.Scene(rope, tension=2000.0, parts=[rd.PointMass(x, mass) for x in AT]).compile()


def modes(model: rd.Model) -> Callable[[], Any]:
    return lambda: model.modes(8)


def count(model: rd.Model) -> Callable[[], Any]:
    return lambda: model.count(below=20.0)


def response(scene: rd.Scene, **how: Any) -> Callable[[], Any]:
    model = scene.compile(**how)
    return lambda: model.frf(LINES, drive=("z", 0.5), threads=1)


def pairs() -> dict[str, tuple[Callable[[], Any], Callable[[], Any]]]:
    """What is asked with something absent or idle, and of what it is compared with."""
    bare, idle = masses(ROPE, 0.01), masses(ROPE, 0.0)
    both = masses(ROPE.replace(**UNCOUPLED), 0.01)
    stretching = masses(ROPE.replace(axial_stiffness=1e6), 0.01)
    none = rd.Scene(ROPE, tension=2000.0).compile()
    assert set(both.modes(8).family) == {"transverse"}
    hows: dict[str, dict[str, Any]] = {
        "eight spans": {},
        "a chain of 64 tensed elements": {"elements": 64},
        "a chain of 64 rigid elements": {"elements": 64, "element": "rigid"},
        "a chain of 301 tensed elements": {"elements": 301},
    }
    return {
        "8 modes, 300 masses: with uncoupled stretch over without": (
            modes(stretching),
            modes(bare),
        ),
        "8 modes, 300 masses: with uncoupled stretch and twist over without": (
            modes(both),
            modes(bare),
        ),
        "8 modes: 300 masses of 0 over none": (modes(idle), modes(none)),
        "count: 300 masses of 0 over none": (count(idle), count(none)),
        **{
            f"10^4 lines of {name}: undamped over damped": (
                response(EIGHT, **how),
                response(EIGHT.replace(damping=DAMPED), **how),
            )
            for name, how in hows.items()
        },
    }


def main() -> None:
    rows = []
    for name, (one, other) in pairs().items():
        found = timing.quartiles({"one": one, "other": other}, repeat=41)
        first, second = found["one"][1], found["other"][1]
        rows.append(
            [name, *(report.digits(1e3 * t) for t in (first, second)), f"{first / second:.2f}"]
        )
    report.write(
        "absent.md",
        f"""# What a scene does not call for

{report.machine()}. Medians of 41 calls in turns, of models that are compiled, in ms.

{report.table(["what", "ms", "ms", "ratio"], rows)}""",
    )


if __name__ == "__main__":
    main()
