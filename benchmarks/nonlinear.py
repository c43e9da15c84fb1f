"""A mass on a hardening spring over 5 s: collocation beside SciPy's explicit and implicit steps.

python benchmarks/nonlinear.py
"""

# isort: off
import timing  # before numpy

# isort: on
from collections.abc import Callable
from functools import partial

import numpy as np
import report
from scipy.integrate import solve_ivp
from scipy.special import ellipj

import ropedyn as rd

STIFFNESS, MASS, CUBIC, AMPLITUDE = 400.0, 0.05, 1.6e7, 0.01
"""A string of two elements, and a spring that is five times as stiff at the amplitude."""
TIME = np.linspace(0.0, 5.0, 5001)
TOLERANCES = (1e-5, 1e-7, 1e-9)
RELATIVE = (1e-6, 1e-8, 1e-10)


def law(t: float, u: float, v: float) -> float:
    return -CUBIC * u**3


MODEL = rd.Scene(
    rd.Rope(1.0, 2 * MASS), tension=STIFFNESS / 4, parts=[rd.NodeForce(0.5, law)]
).compile(elements=2)


def exact() -> np.ndarray:
    """Return the solution by Jacobi's cn (Nayfeh and Mook 1979, 2.2)."""
    stiff = STIFFNESS + CUBIC * AMPLITUDE**2
    modulus = CUBIC * AMPLITUDE**2 / (2 * stiff)
    return AMPLITUDE * ellipj(np.sqrt(stiff / MASS) * TIME, modulus)[1]


def collocation(tolerance: float) -> np.ndarray:
    start = {("z", 0.5): STIFFNESS * AMPLITUDE}
    return MODEL.transient(TIME, start=start, response=("z", 0.5), tolerance=tolerance).value[0]


def explicit(method: str, relative: float) -> np.ndarray:
    def rhs(t: float, y: np.ndarray) -> list[float]:
        return [y[1], (-STIFFNESS * y[0] + law(t, y[0], y[1])) / MASS]

    ends, begin = (0.0, TIME[-1]), [AMPLITUDE, 0.0]
    return solve_ivp(rhs, ends, begin, method, TIME, rtol=relative, atol=1e-5 * relative).y[0]


def calls() -> dict[str, Callable[[], np.ndarray]]:
    own = {f"ropedyn, tolerance {t:g}": partial(collocation, t) for t in TOLERANCES}
    peers = {
        f"solve_ivp {method}, rtol {r:g}": partial(explicit, method, r)
        for method in ("DOP853", "LSODA")
        for r in RELATIVE
    }
    return own | peers


def main() -> None:
    true, solvers = exact(), calls()
    wrong = {name: np.abs(call() - true).max() / AMPLITUDE for name, call in solvers.items()}
    time = timing.medians(solvers, budget=10.0)
    first = f"ropedyn, tolerance {TOLERANCES[0]:g}"
    rows = [
        [name, f"{1e3 * time[name]:.3g}", f"{wrong[name]:.1e}", f"{time[name] / time[first]:.3g}"]
        for name in solvers
    ]
    head = ["", "time [ms]", "error", "time / first"]
    text = (
        f"{report.machine()}.\n\nDuffing's equation over {TIME[-1]:g} s, a law in Python, "
        f"{len(TIME)} times: processor time and largest error over the amplitude.\n\n"
        + report.table(head, rows)
    )
    report.write("nonlinear.md", text)


if __name__ == "__main__":
    main()
