"""Linear motion where damping couples modes, chains beside scipy.signal.lsim, and spans.

python benchmarks/line.py

Both solve the equations of rigid elements under an array of the force; lsim's state matrices are
made beforehand. Of continuous spans lsim has none.
"""

# isort: off
import timing  # before numpy

# isort: on
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import report
from scipy.signal import lsim

import ropedyn as rd

ROPE = rd.Rope(1.0, 0.4, bending_stiffness=1.54, rotary_inertia=1e-5)
STRING = rd.Rope(1.0, 0.4)
DASHPOT = (rd.Dashpot(0.375, 30.0),)
SCENES = {
    "beam, Rayleigh": (ROPE, rd.RayleighDamping(1.0, 1e-5), ()),
    "beam, stiffness damping, dashpot": (ROPE, rd.StiffnessDamping(1e-3), DASHPOT),
    "beam, viscous, dashpot": (ROPE, rd.ViscousDamping(1.0), DASHPOT),
    "string, viscous, dashpot": (STRING, rd.ViscousDamping(2.0), DASHPOT),
}
ASKED = (
    (16, 2000, 4000.0, 1e-3),
    (64, 20_000, 10_000.0, 1e-3),
    (None, 2000, 4000.0, 1e-3),
    (None, 20_000, 10_000.0, 1e-3),
    (None, 20_000, 10_000.0, 1e-6),
)
"""Elements, samples, their rate [Hz], and the tolerance."""


def by_states(model: rd.Model, force: np.ndarray, t: np.ndarray) -> Callable[[], Any]:
    """Return what lsim takes to follow the assembled chain."""
    M, C, K = (
        one().toarray() for one in (model.mass_matrix, model.damping_matrix, model.stiffness_matrix)
    )
    n, at = len(M), 2 * (round(0.25 * (len(model.x) - 1)) - 1)
    solved = np.linalg.solve(M, np.hstack([K, C, np.eye(n)[:, [at]]]))
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-solved[:, : 2 * n]]])
    B = np.concatenate([np.zeros((n, 1)), solved[:, 2 * n :]])
    system = A, B, np.eye(2 * n)[[at]], np.zeros((1, 1))
    return lambda: lsim(system, force, t)[1]


def row(scene: rd.Scene, elements: int | None, count: int, rate: float, to: float) -> list[str]:
    """Return the time of one question, what its error is said to be, and lsim's."""
    t = np.arange(count) / rate
    force = np.sin(2 * np.pi * 37.0 * t)
    how = {} if elements is None else {"elements": elements, "element": "rigid"}
    model = scene.compile(**how)
    ours = partial(model.transient, t, drive=("z", 0.25), force=force, tolerance=to)
    history = ours()
    calls = {"ours": ours}
    most = np.abs(history.value).max()
    apart = None
    if elements is not None:
        calls["lsim"] = by_states(model, force, t)
        apart = np.abs(history.value[0] - calls["lsim"]()).max() / most
    times = timing.medians(calls)
    own, other = times["ours"], times.get("lsim")
    return [
        "spans" if elements is None else f"{elements} rigid",
        str(count),
        f"{to:g}",
        str(history.cost.method),
        report.digits(1e3 * own),
        f"{history.error.max() / most:.1e}",
        report.digits(other and other / own),
        "-" if apart is None else f"{apart:.0e}",
    ]


def main() -> None:
    """Write a row for each scene and question."""
    head = ["scene", "model", "samples", "tolerance", "method", "ms", "error", "lsim/this", "apart"]
    rows = []
    for name, (rope, damping, parts) in SCENES.items():
        scene = rd.Scene(rope, tension=2830.0, damping=damping, parts=parts)
        asked = ASKED if rope is ROPE else [one for one in ASKED if one[0] is None]
        rows += [[name, *row(scene, *one)] for one in asked]
    about = (
        "A sine of 37 Hz given as an array of samples: processor time of a call, the largest error "
        "that it says, and how far lsim is, both over the largest displacement."
    )
    report.write("line.md", f"{report.machine()}.\n\n{about}\n\n{report.table(head, rows)}")


if __name__ == "__main__":
    main()
