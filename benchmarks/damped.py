"""The five lowest damped modes of one rope: by search or in closed form, beside SciPy.

python benchmarks/damped.py
"""

# isort: off
import timing  # before numpy

# isort: on
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
import report
import scipy.linalg
import scipy.sparse as sp
from scene import BENDING, DENSITY, GAMMA, LENGTH, TENSION
from scipy.sparse.linalg import eigs

import ropedyn as rd

NUMBER, ELEMENTS = 5, 200
IMPEDANCE = math.sqrt(TENSION * DENSITY)
"""Of the rope without bending [N s/m]."""
TUNED = 60.0
"""Of the resonator, near the first mode [Hz]."""

Parts = tuple[rd.Dashpot | rd.Resonator, ...]


def scene(damping: Any = None, parts: Parts = (), right: Any = "clamped", **rope: Any) -> rd.Scene:
    rope = {"bending_stiffness": BENDING} | rope
    return rd.Scene(
        rd.Rope(LENGTH, DENSITY, **rope),
        tension=TENSION,
        ends=("clamped", right),
        damping=damping,
        parts=parts,
    )


SCENES = {
    "viscous medium": scene(rd.ViscousDamping(1.0)),
    "Rayleigh damping of a string": scene(rd.RayleighDamping(1.0, GAMMA), bending_stiffness=None),
    "stiffness damping": scene(rd.StiffnessDamping(GAMMA)),
    "loss factor": scene(rd.LossFactor(0.02)),
    "dashpot at an end": scene(right=rd.End(z="free", beta="free", dashpot={"z": 0.4 * IMPEDANCE})),
    "dashpot inside": scene(parts=(rd.Dashpot(0.03 * LENGTH, 1.5 * IMPEDANCE),)),
    "two dashpots": scene(
        parts=(rd.Dashpot(0.3 * LENGTH, IMPEDANCE), rd.Dashpot(0.7 * LENGTH, 0.1 * IMPEDANCE))
    ),
    "resonator": scene(parts=(rd.Resonator(0.3 * LENGTH, 0.01, TUNED, damping_ratio=0.1),)),
    "string, dashpot inside": scene(
        parts=(rd.Dashpot(0.03 * LENGTH, 1.5 * IMPEDANCE),), bending_stiffness=None
    ),
}
MATRICES = ("dashpot at an end", "dashpot inside", "two dashpots", "stiffness damping")
"""Scenes whose chains are M s^2 + C s + K."""


@dataclass(frozen=True)
class Row:
    """One scene: times [s] and the largest relative distance of rates."""

    name: str
    time: dict[str, float]
    error: dict[str, float]
    certified: bool


class Assembled:
    """The companion pencil of M s^2 + C s + K in units of 1/omega; rates by each of SciPy's."""

    def __init__(self, model: rd.Model) -> None:
        M, C, K = (
            part.tocsc()
            for part in (model.mass_matrix(), model.damping_matrix(), model.stiffness_matrix())
        )
        scale = sp.diags(1 / np.sqrt(K.diagonal()))
        M, C, K = (scale @ part @ scale for part in (M, C, K))
        self.omega = 1 / math.sqrt(abs(M).max())
        one, none = sp.eye(K.shape[0]), sp.csc_matrix(K.shape)
        self.A = sp.bmat([[none, one], [-K, -self.omega * C]], format="csc")
        self.B = sp.bmat([[one, none], [none, self.omega**2 * M]], format="csc")

    def eig(self) -> np.ndarray:
        return self._lowest(scipy.linalg.eigvals(self.A.toarray(), self.B.toarray()))

    def eigs(self) -> np.ndarray:
        wanted = 2 * NUMBER + 2
        return self._lowest(eigs(self.A, wanted, self.B, sigma=0.0, return_eigenvectors=False))

    def _lowest(self, found: np.ndarray) -> np.ndarray:
        s = self.omega * found[np.isfinite(found)]
        s = s[s.imag >= -1e-9 * np.abs(s)]
        return s[np.argsort(np.abs(s))][:NUMBER]


def search(model: rd.Model) -> np.ndarray:
    return model.modes(NUMBER, damped=True).eigenvalue


def measure(name: str) -> Row:
    spans = SCENES[name].compile()
    chain = SCENES[name].compile(elements=ELEMENTS, element="rigid")
    calls: dict[str, Callable[[], Any]] = {
        "spans": partial(search, spans),
        "chain": partial(search, chain),
    }
    if name in MATRICES:
        assembled = Assembled(chain)
        calls |= {"eigs": assembled.eigs, "eig": assembled.eig}
    right = search(chain)
    found = {one: calls[one]() for one in ("eigs", "eig") if one in calls}
    return Row(
        name,
        timing.medians(calls, budget=2.0),
        {one: float(np.max(np.abs(s - right) / np.abs(right))) for one, s in found.items()},
        all(model.modes(NUMBER, damped=True).certified for model in (spans, chain)),
    )


def page(rows: list[Row]) -> str:
    names = ("spans", "chain", "eigs", "eig")
    head = ["scene", *(f"{n} [ms]" for n in names), "eigs off", "eig off", "certified"]
    lines = [
        [
            row.name,
            *(report.digits(None if n not in row.time else 1e3 * row.time[n]) for n in names),
            *(f"{row.error[n]:.0e}" if n in row.error else "-" for n in ("eigs", "eig")),
            "yes" if row.certified else "no",
        ]
        for row in rows
    ]
    return f"""# Five lowest damped modes

{report.machine()}. T = {TENSION:g} N, B = {BENDING:g} N m^2, {LENGTH:g} m, {DENSITY:g} kg/m,
clamped unless it says so; continuous spans, and a chain of {ELEMENTS} rigid elements.

`model.modes({NUMBER}, damped=True)` finds rates, bounds of their errors and the certificate that
none is missing; the first two scenes are in closed form, the others are searched in the plane.
SciPy is given the companion pencil of the chain's M s^2 + C s + K: `eigs` sparse about 0 for twelve
eigenvalues, `eig` dense for all of them; they know neither loss factors nor what is condensed to
its foot. Medians of processor times of calls in turn; compiling and assembling are left out. "off"
is the largest relative distance to the rates of the search.

{report.table(head, lines)}
"""


def main() -> None:
    report.write("damped.md", page([measure(name) for name in SCENES]))


if __name__ == "__main__":
    main()
