"""The study's amplitude-frequency characteristic: over time, directly, and with stops.

python benchmarks/stepped_sine.py

At each of a few frequencies the study's model of eight elements is led to the steady state. SciPy's
`solve_ivp` integrates for as long as free motion takes to decay to the tolerance. Beside it
stand the same rope between two stops, and a span whose spring hardens, by harmonic balance.
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
    M, C, K = (
        m.toarray() for m in (MODEL.mass_matrix(), MODEL.damping_matrix(), MODEL.stiffness_matrix())
    )
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


def stopped(amplitude: float, tolerance: float) -> rd.FRF:
    """Step the study's chain, between two stops, through all frequencies."""
    gap = 2e-5
    stops = [rd.Stop(DRIVE[1], 2e5, gap=gap, side=side) for side in (1, -1)]
    scene = rd.study2015.scene().replace(parts=stops)
    model = scene.compile(elements=rd.study2015.ELEMENTS, element="difference")
    return model.stepped_sine(LINES, drive=DRIVE, amplitude=amplitude, tolerance=tolerance)


def hardening() -> rd.Branches:
    """Follow the branches of a continuous span with a spring that hardens."""
    spring = rd.NodeForce(0.5, lambda t, u, v: -1e9 * u**3)
    scene = rd.Scene(
        rd.Rope(1.0, 0.4, bending_stiffness=1.54),
        tension=2830.0,
        damping=rd.RayleighDamping(8.0, 1e-6),
        parts=[spring],
    )
    options = {"drive": ("z", 0.5), "amplitude": 20.0, "branches": True}
    return scene.compile().stepped_sine([40.0, 90.0], **options)


def directly(lines: np.ndarray) -> np.ndarray:
    return MODEL.frf(lines, drive=DRIVE).value[0]


def nonlinear() -> str:
    """Tell what stops and hardening springs cost."""
    ways = {
        f"two stops, {amplitude:g} N, tolerance {tolerance:g}": partial(
            stopped, amplitude, tolerance
        )
        for amplitude in (0.2, 1.0)
        for tolerance in (1e-3, 1e-5)
    }
    times = timing.medians({**ways, "hardening spring": hardening}, budget=2.0)
    rows = []
    for name, way in ways.items():
        found = way()
        each = times[name] / len(LINES)
        rows.append([name, f"{1e3 * each:.3g}", f"{found.rounding_error.max():.1e}"])
    branches = hardening()
    each = times["hardening spring"] / len(branches.frequency)
    rows.append(["hardening spring, all branches", f"{1e3 * each:.3g}", ""])
    folds = ", ".join(f"{f:.6g}" for f in branches.folds)
    head = ["harmonic balance", "time of a frequency or point [ms]", "largest estimated error"]
    return report.table(head, rows) + f"\nThe hardening spring's folds are at {folds} Hz.\n"


def main() -> None:
    ways: dict[str, Callable[[], np.ndarray]] = {
        f"solve_ivp, {method}, {tolerance:g}": partial(integrated, method, tolerance)
        for method, tolerances in TOLERANCES.items()
        for tolerance in tolerances
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
    report.write("stepped_sine.md", text + "\n\n" + nonlinear())


if __name__ == "__main__":
    main()
