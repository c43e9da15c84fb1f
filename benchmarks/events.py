"""Stops and friction from event to event, on a chain and on continuous spans.

python benchmarks/events.py
"""

# isort: off
import timing  # before numpy

# isort: on
import numpy as np
import report

import ropedyn as rd

ROPE = rd.Rope(1.0, 0.4, bending_stiffness=1.54)
SCENE = rd.Scene(ROPE, tension=2830.0, damping=rd.ViscousDamping(1.0))
PUSH = {"drive": ("z", 0.25), "force": rd.Sine(50.0, 63.0), "response": ("z", 0.4)}
TIME = np.linspace(0.0, 0.1, 1001)
CASES = {
    "friction that holds": rd.Dashpot(0.5, 100.0, exponent=0.0),
    "friction that slips": rd.Dashpot(0.5, 10.0, exponent=0.0),
    "stop 1e4 N/m": rd.Stop(0.5, 1e4, gap=1e-3),
    "stop 1e6 N/m": rd.Stop(0.5, 1e6, gap=1e-3),
    "stop 1e8 N/m": rd.Stop(0.5, 1e8, gap=1e-3),
}


def rows() -> list[list[str]]:
    """Time each case on a chain and on continuous spans."""
    found = []
    for name, part in CASES.items():
        for label, how in (("64 rigid", {"elements": 64, "element": "rigid"}), ("spans", {})):
            model = SCENE.replace(parts=(part,)).compile(**how)
            history = model.transient(TIME, **PUSH, partial=True)
            seconds = timing.seconds(lambda m=model: m.transient(TIME, **PUSH, partial=True), 3)
            size = np.abs(history.value).max()
            error = f"{history.error.max() / size:.0e}" if size else "0"
            found.append([name, label, f"{1e3 * seconds:.0f}", error, f"{history.sure_until:g}"])
    return found


if __name__ == "__main__":
    head = ["case", "model", "ms", "error", "sure until [s]"]
    report.write("events.md", f"{report.machine()}\n\n{report.table(head, rows())}")
