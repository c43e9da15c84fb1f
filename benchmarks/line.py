"""Linear motion by the line and by modes beside scipy.signal.lsim: medians of ratios in one run.

python benchmarks/line.py

Both solve the equations of rigid elements. lsim is told what an array of the force says; its state
matrices are made beforehand.
"""

# isort: off
import timing  # before numpy

# isort: on
from typing import Any

import numpy as np
from scipy.signal import lsim

import ropedyn as rd

RUNS = 7
ROPE = rd.Rope(1.0, 0.4, bending_stiffness=1.54, rotary_inertia=1e-5)
DAMPINGS = {
    "proportional": (rd.RayleighDamping(1.0, 1e-5), ()),
    "stiffness damping, dashpot": (rd.StiffnessDamping(1e-3), (rd.Dashpot(0.375, 30.0),)),
}
SIZES = ((16, 2000, 4000.0), (64, 20_000, 10_000.0))
"""Elements, samples and their rate [Hz]."""


def beside(model: rd.Model, count: int, rate: float) -> tuple[float, float, float]:
    """Return medians of the seconds of lsim over ours, of ours, and the difference."""
    t = np.arange(count) / rate
    force = np.sin(2 * np.pi * 37.0 * t)
    M, C, K = (
        one().toarray() for one in (model.mass_matrix, model.damping_matrix, model.stiffness_matrix)
    )
    n, at = len(M), 2 * (round(0.25 * (len(model.x) - 1)) - 1)
    solved = np.linalg.solve(M, np.hstack([K, C, np.eye(n)[:, [at]]]))
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-solved[:, : 2 * n]]])
    B = np.concatenate([np.zeros((n, 1)), solved[:, 2 * n :]])
    system = A, B, np.eye(2 * n)[[at]], np.zeros((1, 1))

    def ours() -> Any:
        return model.transient(t, drive=("z", 0.25), force=force).value[0]

    def theirs() -> Any:
        return lsim(system, force, t)[1]

    apart = np.abs(ours() - theirs()).max() / np.abs(theirs()).max()
    pairs = [(timing.seconds(ours), timing.seconds(theirs)) for _ in range(RUNS)]
    ratio = np.median([other / own for own, other in pairs])
    return float(ratio), float(np.median([own for own, _ in pairs])), float(apart)


def main() -> None:
    """Print a row for each damping and size."""
    print(f"{'damping':28} elements samples    ms   lsim/ours  apart")
    for name, (damping, parts) in DAMPINGS.items():
        scene = rd.Scene(ROPE, tension=2830.0, damping=damping, parts=parts)
        for elements, count, rate in SIZES:
            model = scene.compile(elements=elements, element="rigid")
            ratio, own, apart = beside(model, count, rate)
            row = f"{elements:8d} {count:7d} {1e3 * own:6.1f} {ratio:10.1f} {apart:8.0e}"
            print(f"{name:28} {row}")


if __name__ == "__main__":
    main()
