"""A straight scene beside another build of the library: the same bits, and the times.

python benchmarks/straight.py FOLDER

FOLDER holds the package of the other build, as pip install --no-deps --target FOLDER makes it.
"""

# isort: off
import timing  # noqa: F401 - before numpy: one thread

# isort: on
import hashlib
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from statistics import median
from typing import Any

import report

ROUNDS, REPEATS = 9, 7  # Turns of both builds, and of each question within one.


def questions() -> dict[str, Callable[[], Any]]:
    """Return what is asked of straight ropes: arrays."""
    import numpy as np

    import ropedyn as rd

    rope = rd.Rope(
        1.35,
        0.1017,
        bending_stiffness=1.54,
        torsional_stiffness=0.1485,
        lay_slope=0.01,
        polar_inertia=1.4e-7,
    )
    parts = (rd.PointMass(0.5, 0.02), rd.Spring(0.9, 500.0))
    damping = rd.StiffnessDamping(1e-4)
    scene = rd.Scene(rope, tension=2830.0, parts=parts, damping=damping)
    spans, chain = scene.compile(), scene.compile(elements=256)
    planes = scene.replace(
        rope=rope.replace(lay_slope=None, bending_stiffness=(1.54, 1.2)), planes="both"
    ).compile()
    f = np.linspace(1.0, 450.0, 1000)
    return {
        "compile": lambda: scene.compile().x,
        "10 modes of spans": lambda: spans.modes(10).eigenvalue,
        "their shapes": lambda: spans.modes(10).shape,
        "10 modes of 256 elements": lambda: chain.modes(10).eigenvalue,
        "10 modes in both planes": lambda: planes.modes(10).eigenvalue,
        "10 damped modes of spans": lambda: spans.modes(10, damped=True).eigenvalue,
        "1000 lines of spans": lambda: spans.frf(f, drive=("z", 0.3)).value,
        "1000 lines of 256 elements": lambda: chain.frf(f, drive=("z", 0.3)).value,
        "static deflection": lambda: spans.static({("z", 0.3): 1.0}).displacement,
    }


def asked() -> dict[str, tuple[str, float]]:
    """Return a hash of each answer and the median of its processor times [s]."""
    found = {}
    for name, ask in questions().items():
        times = []
        for _ in range(REPEATS):
            begin = time.process_time()
            answer = ask()
            times.append(time.process_time() - begin)
        found[name] = (hashlib.sha256(answer.tobytes()).hexdigest(), median(times))
    return found


def child(folder: Path) -> dict[str, tuple[str, float]]:
    """Ask the build in a folder, in a process of its own."""
    env = os.environ | {"PYTHONPATH": str(folder)}
    run = [sys.executable, __file__, "--child"]
    done = subprocess.run(run, env=env, check=True, capture_output=True, text=True)
    found: dict[str, tuple[str, float]] = json.loads(done.stdout)
    return found


def main(other: Path) -> None:
    """Ask both in turn, and print the table."""
    here = Path(__file__).parent.parent
    pairs = [(child(other), child(here)) for _ in range(ROUNDS)]
    rows = []
    for name in pairs[0][0]:
        before, now = (median(pair[i][name][1] for pair in pairs) for i in (0, 1))
        ratio = median(pair[1][name][1] / pair[0][name][1] for pair in pairs)
        same = all(pair[0][name][0] == pair[1][name][0] for pair in pairs)
        times = [f"{1e3 * t:.3f}" for t in (before, now)]
        rows.append([name, *times, f"{ratio:.3f}", "the same" if same else "others"])
    head = ["question", "other [ms]", "here [ms]", "ratio", "bits"]
    print(f"{report.machine()}\n\n{report.table(head, rows)}")


if __name__ == "__main__":
    if "--child" in sys.argv:
        sys.path.insert(0, os.environ["PYTHONPATH"])
        print(json.dumps(asked()))
    else:
        main(Path(sys.argv[1]))
