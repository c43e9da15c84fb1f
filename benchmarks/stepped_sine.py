"""The study's amplitude-frequency characteristic: over time by three ways, and directly.

python benchmarks/stepped_sine.py

At each of a few frequencies the study's model of eight elements is led to the steady state. SciPy's
`solve_ivp` integrates for as long as free motion takes to decay to the tolerance.
"""

# isort: off
import timing  # before numpy

# isort: on
from collections.abc import Callable
from functools import partial

import numpy as np
import report
from scipy.integrate import solve_ivp

import ropedyn as rd

MODEL = rd.study2015.scene().compile(elements=rd.study2015.ELEMENTS, element="difference")
DRIVE = rd.study2015.DRIVE
LINES = np.linspace(40.0, 240.0, 101)
PEAKS = MODEL.modes(3).frequency
FEW = np.sort(np.append(PEAKS, [50.0, 100.0, 165.0]))
"""Frequencies that every way is timed at: the peaks and between."""
DECAY = float((2 * np.pi * PEAKS * MODEL.modes(3).damping_ratio).min())
TOLERANCES = {"RK45": (1e-3, 1e-6), "DOP853": (1e-6,), "LSODA": (1e-6,)}
SAMPLES = 64


def first_order() -> tuple[np.ndarray, np.ndarray, int]:
    """Return A, b of y' = A y + b cos(omega t) and the unknown that is watched."""
    M, C, K = (m.toarray() for m in (MODEL.mass(), MODEL.damping(), MODEL.stiffness()))
    n, width = len(M), len(MODEL.coordinates)
    at = width * (round(DRIVE[1] / rd.study2015.ELEMENT_LENGTH) - 1) + MODEL.coordinates.index("z")
    inverse = np.linalg.inv(M)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ K, -inverse @ C]])
    return A, np.concatenate([np.zeros(n), inverse[:, at]]), at


def integrated(method: str, tolerance: float) -> np.ndarray:
    """Integrate from rest until free motion has decayed to the tolerance, and one period more."""
    A, b, at = first_order()
    found = []
    for f in FEW:
        omega = 2 * np.pi * f
        periods = np.ceil(-np.log(tolerance) / DECAY * f)
        looks = (periods + np.arange(SAMPLES) / SAMPLES) / f
        jacobian = {"jac": lambda t, y: A} if method == "LSODA" else {}
        y = solve_ivp(
            lambda t, y, omega=omega: A @ y + b * np.cos(omega * t),
            (0.0, (periods + 1) / f),
            np.zeros(len(b)),
            method=method,
            rtol=tolerance,
            atol=1e-3 * tolerance * 1e-4,  # of motions of 0.1 mm
            t_eval=looks,
            **jacobian,
        ).y[at]
        found.append(2 / SAMPLES * (y * np.exp(-1j * omega * looks)).sum())
    return np.array(found)


def stepped(method: str, tolerance: float) -> np.ndarray:
    options = {"amplitude": 1.0, "method": method, "tolerance": tolerance}
    return MODEL.stepped_sine(FEW, drive=DRIVE, **options).value[0]


def directly(lines: np.ndarray) -> np.ndarray:
    return MODEL.frf(lines, drive=DRIVE).value[0]


def main() -> None:
    ways: dict[str, Callable[[], np.ndarray]] = {
        f"solve_ivp, {method}, {tolerance:g}": partial(integrated, method, tolerance)
        for method, tolerances in TOLERANCES.items()
        for tolerance in tolerances
    }
    ways |= {
        f"stepped_sine, {method}, {tolerance:g}": partial(stepped, method, tolerance)
        for method, tolerance in (
            ("direct", 1e-3),
            ("direct", 1e-5),
            ("modal", 1e-6),
            ("modal", 1e-9),
        )
    }
    ways["frf"] = partial(directly, FEW)
    true = directly(FEW)
    is_peak = np.isin(FEW, PEAKS)
    rows = []
    times = timing.medians({**ways, "all": partial(directly, LINES)}, budget=2.0)
    quickest = min(time for name, time in times.items() if "solve_ivp" in name)
    for name, way in ways.items():
        error = np.abs(way() / true - 1)
        each = times[name] / len(FEW)
        rows.append(
            [
                name,
                f"{1e3 * each:.3g}",
                f"{error[is_peak].max():.1e}",
                f"{error[~is_peak].max():.1e}",
                f"{quickest / times[name]:.3g}",
            ]
        )
    head = ["", "time of a frequency [ms]", "error at peaks", "between", "solve_ivp's best / this"]
    text = (
        f"{report.machine()}.\n\nThe study's chain of {rd.study2015.ELEMENTS} elements, "
        f"{MODEL.size} unknowns, at its three peaks and three frequencies between: processor time "
        "and largest relative error against the response that the sweep solves for. All "
        f"{len(LINES)} frequencies of a curve take `frf` {1e3 * times['all']:.2g} ms.\n\n"
        + report.table(head, rows)
    )
    report.write("stepped_sine.md", text)


if __name__ == "__main__":
    main()
