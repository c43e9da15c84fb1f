"""Edges of instability under a pulsating tension: counted, scanned, and integrated.

python benchmarks/tongues.py

A stiff rope whose modes are all coupled by its tension. The scan looks at 20 000 frequencies with
the multipliers of one period; SciPy's `solve_ivp` finds those of a few, and its time is scaled up.
"""

# isort: off
import timing  # before numpy

# isort: on
from functools import partial

import numpy as np
import report
from scipy.integrate import solve_ivp

import ropedyn as rd
from ropedyn.motion.modal_system import ModalSystem
from ropedyn.parametric.monodromy import exponent
from ropedyn.parametric.tongues import threshold

SCENE = rd.Scene(
    rd.Rope(1.0, 0.1, bending_stiffness=2.0), tension=1000.0, ends=("pinned", "clamped")
)
DAMPED = SCENE.replace(damping=rd.RayleighDamping(1.0, 0.0))
BETWEEN = (60.0, 240.0)  # frequencies of the tension [Hz]
AMPLITUDE = 150.0  # of the tension [N]
SCAN = np.linspace(*BETWEEN, 20_000)
FEW = np.linspace(*BETWEEN, 5)


def scanned(system: ModalSystem) -> int:
    """Count the changes of stability that a scan sees."""
    given = np.full((len(SCAN), 1), AMPLITUDE)
    grows = exponent(system, SCAN, given)[:, 0] > threshold(system, SCAN)
    return int((grows[1:] != grows[:-1]).sum())


def integrated(system: ModalSystem) -> None:
    """Find the multipliers at a few frequencies with DOP853 at 1e-10."""
    k = len(system.eigenvalue)
    stiffness, more = np.diag(system.eigenvalue), AMPLITUDE * system.geometric
    for f in FEW:

        def rate(t: float, state: np.ndarray, f: float = f) -> np.ndarray:
            q, v = state.reshape(2, k, 2 * k)
            pull = (stiffness + np.cos(2 * np.pi * f * t) * more) @ q
            return np.concatenate([v, -pull - system.damping @ v]).ravel()

        start = np.eye(2 * k).ravel()
        end = solve_ivp(rate, (0.0, 1 / f), start, method="DOP853", rtol=1e-10, atol=1e-10).y
        np.linalg.eigvals(end[:, -1].reshape(2 * k, 2 * k))


def main() -> None:
    rows = []
    for name, scene in (("none", SCENE), ("c = 1/s", DAMPED)):
        for modes in (1, 3, 4):
            stability = scene.compile().stability_map(BETWEEN, [0.0], modes=modes)
            ways = {
                "boundary": partial(stability.boundary, AMPLITUDE),
                "scan": partial(scanned, stability.system),
                "solve_ivp": partial(integrated, stability.system),
            }
            times = timing.medians(ways, budget=2.0)
            found = stability.boundary(AMPLITUDE)
            rows.append(
                [
                    f"{name}, {modes} modes",
                    f"{len(found.frequency)}",
                    f"{scanned(stability.system)}",
                    str(found.proved),
                    f"{times['boundary']:.2g}",
                    f"{times['scan']:.2g}",
                    f"{times['solve_ivp'] * len(SCAN) / len(FEW):.2g}",
                ]
            )
    head = ["damping", "edges", "a scan's", "proved", "boundary [s]", "scan [s]", "solve_ivp [s]"]
    text = (
        f"{report.machine()}.\n\nFrequencies of the tension from {BETWEEN[0]:g} to "
        f"{BETWEEN[1]:g} Hz at {AMPLITUDE:g} N of 1000 N: edges of instability by `boundary`, and "
        f"those that {len(SCAN)} multipliers show; processor time of both, and of as many by "
        f"`solve_ivp` (DOP853 at 1e-10, from {len(FEW)}).\n\n" + report.table(head, rows)
    )
    report.write("tongues.md", text)


if __name__ == "__main__":
    main()
