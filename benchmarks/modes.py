"""The ten lowest modes of a chain: by sweep, beside the eigensolvers of SciPy.

python benchmarks/modes.py
"""

# isort: off
import timing  # before numpy

# isort: on
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import exact
import numpy as np
import report
import scene
from scipy.linalg import eig_banded, eigh
from scipy.sparse.linalg import eigsh

import ropedyn as rd

NUMBER = 10
ELEMENTS = (16, 64, 256, 1024, 4096, 16_384, 100_000)
LONGEST = {"uniform": (*ELEMENTS, 1_000_000), "different": ELEMENTS}
KINDS = {
    "uniform": "equal elements and nodes",
    "different": "every element of another length, every node of another mass",
}
MOST = {"sweep": 1_000_000, "eigh": 1024, "eig_banded": 4096, "eigsh": 100_000}
"""Elements up to which each is asked, of its time and memory."""
IN_DIGITS = 16
"""Elements up to which chains of different elements are solved in 40 digits."""


@dataclass(frozen=True)
class Row:
    """One chain: times [s], errors of frequencies relative to the exact ones."""

    kind: str
    elements: int
    time: dict[str, float]
    error: dict[str, float]
    bound: float
    certified: bool
    true: str
    """What errors are measured against."""


class Assembled:
    """Stiffness and mass for SciPy; frequencies [Hz] by each of its eigensolvers."""

    def __init__(self, stiffness: Any, mass: Any) -> None:
        self.stiffness, self.mass = stiffness.tocsc(), mass.tocsc()

    def eigh(self) -> np.ndarray:
        lowest = [0, NUMBER - 1]
        return _hertz(
            eigh(
                self.stiffness.toarray(),
                self.mass.toarray(),
                eigvals_only=True,
                subset_by_index=lowest,
            )
        )

    def eig_banded(self) -> np.ndarray:
        # M is diagonal: M^-1/2 K M^-1/2, in bands
        scale = 1 / np.sqrt(self.mass.diagonal())
        part = self.stiffness.tocoo()
        below = part.row >= part.col
        i, j = part.row[below], part.col[below]
        bands = np.zeros((int((i - j).max()) + 1, len(scale)))
        bands[i - j, j] = part.data[below] * scale[i] * scale[j]
        lowest = (0, NUMBER - 1)
        return _hertz(
            eig_banded(bands, lower=True, eigvals_only=True, select="i", select_range=lowest)
        )

    def eigsh(self) -> np.ndarray:
        return _hertz(
            np.sort(eigsh(self.stiffness, NUMBER, self.mass, sigma=0, return_eigenvectors=False))
        )


def _hertz(eigenvalue: np.ndarray) -> np.ndarray:
    return np.sqrt(np.maximum(eigenvalue, 0.0)) / (2 * np.pi)


def sweep(model: rd.Model) -> rd.Modes:
    return model.modes(NUMBER, solver="sweep")


def model_of(kind: str, elements: int) -> rd.Model:
    if kind == "uniform":
        return scene.model(kind, elements, twist=False, rotary=True)
    return scene.chain_of_different(elements, rotary=True)


def measure(kind: str, elements: int) -> Row:
    model = model_of(kind, elements)
    calls: dict[str, Callable[[], Any]] = {"sweep": partial(sweep, model)}
    others = [name for name in MOST if name != "sweep" and elements <= MOST[name]]
    if others:
        assembled = Assembled(model.stiffness_matrix(), model.mass_matrix())
        calls |= {name: getattr(assembled, name) for name in others}
    modes = sweep(model)
    found = {"sweep": modes.frequency} | {name: calls[name]() for name in others}
    right, true = _exact(kind, model, modes.frequency)
    if true == "the sweep":
        del found["sweep"]
    return Row(
        kind,
        elements,
        timing.medians(calls),
        {name: float(np.max(np.abs(f / right - 1))) for name, f in found.items()},
        float(np.max(modes.rounding_error / modes.frequency)),
        modes.certified,
        true,
    )


def _exact(kind: str, model: rd.Model, near: np.ndarray) -> tuple[np.ndarray, str]:
    if kind == "uniform":
        found = exact.clamped_frequencies(model.chain, NUMBER)
        return np.array([float(f) for f in found]), "the dispersion equation"
    if len(model.x) - 1 <= IN_DIGITS:
        return np.array([float(exact.frequency_near(model, f)) for f in near]), "40 digits"
    return near, "the sweep"


# --- what is written --------------------------------------------------------------------------


def page(rows: list[Row]) -> str:
    kinds = "\n".join(f"- {name}: {text}." for name, text in KINDS.items())
    return f"""# Ten lowest modes

{report.machine()}. T = 2830 N, B = 1.54 N m^2, 1.35 m, 0.1017 kg/m, clamped,
rigid elements with their own rotary inertia, width 2 (z and beta).

{kinds}

`model.modes(10)` by sweep finds frequencies, bounds of their errors and the certificate that none
is missing. SciPy is given the assembled matrices and asked for ten eigenvalues without vectors:
`eigh(K, M)` dense, `eig_banded` of M^-1/2 K M^-1/2, `eigsh(K, M, sigma=0)` sparse. Medians of
processor times of calls in turn; compiling the model and assembling are left out.

## Time

{_times(rows)}

## Error

Largest relative error of the ten frequencies: of uniform chains against the exact discrete
dispersion equation in 60 digits, of different ones against inverse iteration in 40 digits at
n = {IN_DIGITS} and against the sweep beyond. The sweep's bound is its own `rounding_error`.

{_errors(rows)}
"""


def _times(rows: list[Row]) -> str:
    others = [name for name in MOST if name != "sweep"]
    head = ["chain", "n", *(f"{name} [ms]" for name in MOST), *(f"{n} / sweep" for n in others)]
    lines = [
        [
            row.kind,
            str(row.elements),
            *(_milliseconds(row.time.get(name)) for name in MOST),
            *(_ratio(row.time.get(name), row.time["sweep"]) for name in others),
        ]
        for row in rows
    ]
    return report.table(head, lines)


def _milliseconds(seconds: float | None) -> str:
    return report.digits(None if seconds is None else 1e3 * seconds)


def _ratio(seconds: float | None, own: float) -> str:
    return report.digits(None if seconds is None else seconds / own)


def _errors(rows: list[Row]) -> str:
    head = ["chain", "n", "against", "certified", "sweep's bound", *MOST]
    lines = [
        [
            row.kind,
            str(row.elements),
            row.true,
            "yes" if row.certified else "no",
            f"{row.bound:.0e}",
            *(f"{row.error[name]:.0e}" if name in row.error else "-" for name in MOST),
        ]
        for row in rows
    ]
    return report.table(head, lines)


def plot(rows: list[Row]) -> None:
    figure, axes = report.panels()
    for (time, error), kind in zip(axes.T, KINDS):
        of_kind = [row for row in rows if row.kind == kind]
        for k, name in enumerate(MOST):
            label, style = (name, "s--") if k else ("ropedyn", "o-")
            timed = [row for row in of_kind if name in row.time]
            time.loglog(
                [row.elements for row in timed],
                [1e3 * row.time[name] for row in timed],
                style,
                color=f"C{k}",
                label=label,
            )
            known = [row for row in of_kind if name in row.error]
            error.loglog(
                [row.elements for row in known],
                # what has no correct digit is wrong by as much as it is
                [max(row.error[name], np.finfo(float).eps / 2) for row in known],
                style,
                color=f"C{k}",
                label=label,
            )
        error.loglog(
            [row.elements for row in of_kind],
            [row.bound for row in of_kind],
            ":",
            color="C0",
            label="ropedyn's bound",
        )
        time.set_title(kind)
        error.set_xlabel("elements")
    labels = ("time [ms]", "largest relative error [1]")
    report.save(figure, axes, "modes.png", "Ten lowest modes, one core", labels)


def main() -> None:
    rows = []
    for kind in KINDS:
        for n in LONGEST[kind]:
            rows.append(measure(kind, n))
            print(".", end="", flush=True)
    print()
    report.write("modes.md", page(rows))
    plot(rows)


if __name__ == "__main__":
    main()
