"""What SciPy keeps of a hard case: sparse and banded solvers on assembled matrices."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from ...base.array import Complex, Real
from ...base.errors import RopedynError
from ...chain.port import ports
from ...model import Model
from .case import HardCase

SPARSE, DENSE = (16, 64, 256), (16, 64)
"""Elements of the chains that stand in for continuous spans: the best of them is told."""


def peer_of(case: HardCase) -> tuple[str, float]:
    """Return which function of SciPy answers a case, and how many digits it keeps at best."""
    solver = SOLVERS.get(case.ask["kind"]) if case.peer else None
    if solver is None:
        return "", np.nan
    name, solve, meshes = solver
    chains = [case.compile] if case.compile else [{"elements": n} for n in meshes]
    return name, max(_kept(case, solve, how) for how in chains)


def _kept(case: HardCase, solve: Callable[..., Real | Complex], how: Mapping[str, Any]) -> float:
    """Return the digits of an answer, 0 where there is none."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            return case.kept(solve(case.scene.compile(**how), case))
        except (ArithmeticError, RuntimeError, ValueError, np.linalg.LinAlgError, RopedynError):
            return 0.0


def _eigsh(model: Model, case: HardCase) -> Real:
    """Return the lowest frequencies: shifted to just below the first, which is told to it."""
    from scipy.sparse.linalg import eigsh

    number = case.ask["number"]
    if model.size <= number:
        raise ArithmeticError("as many modes as unknowns")
    known = [2 * np.pi * float(str(v)) for v in case.value]
    square = np.copysign(np.square(known), known)
    shift = square[0] - 1e-3 * (abs(square[0]) or abs(square).max())
    start = np.random.default_rng(1).standard_normal(model.size)
    values = eigsh(
        model.stiffness_matrix().tocsc(),
        number,
        model.mass_matrix().tocsc(),
        sigma=shift,
        v0=start,
        return_eigenvectors=False,
    )
    values = np.sort(values)
    return np.copysign(np.sqrt(np.abs(values)), values) / (2 * np.pi)


def _eig(model: Model, case: HardCase) -> Complex:
    """Return the rates nearest to the known ones: the linearised problem, dense."""
    from scipy.linalg import eigvals

    K, C, M = (
        of().toarray() for of in (model.stiffness_matrix, model.damping_matrix, model.mass_matrix)
    )
    unit, none = np.eye(len(K)), np.zeros_like(K)
    rates = eigvals(np.block([[none, unit], [-K, -C]]), np.block([[unit, none], [none, M]]))
    rates = rates[np.isfinite(rates)]
    known = [complex(*map(float, [v] if isinstance(v, str) else v)) for v in case.value]
    return np.array([rates[np.abs(rates - rate).argmin()] for rate in known])


def _solve_banded(model: Model, case: HardCase) -> Complex:
    """Return the undamped response at each frequency, or at rest."""
    from scipy.linalg import solve_banded

    ask = case.ask
    drive, response = (ask.get(name, ask.get("load")) for name in ("drive", "response"))
    b, c = (_vector(model, tuple(point)) for point in (drive, response))
    K, M = model.stiffness_matrix(), model.mass_matrix()
    found = []
    for f in ask.get("frequency", [0.0]):
        diagonals = (K - (2 * np.pi * f) ** 2 * M).todia()
        reach = int(np.abs(diagonals.offsets).max())
        band = np.zeros((2 * reach + 1, model.size))
        band[reach - diagonals.offsets] = diagonals.data
        found.append(c @ solve_banded((reach, reach), band, b))
    return np.array(found, dtype=np.complex128)


def _vector(model: Model, point: tuple[str, float]) -> Real:
    """Return the share of each unknown in the motion of a point: the element's own shape."""
    left, row, _ = ports(model.chain, model.x, model.coordinates, [point])
    force = np.zeros((len(model.x), len(model.coordinates)))
    force[left[0] : left[0] + 2] = row[0]
    return force[model.chain.held[model.chain.term_of] == 0]


SOLVERS: dict[str, tuple[str, Callable[..., Real | Complex], tuple[int, ...]]] = {
    "modes": ("eigsh", _eigsh, SPARSE),
    "rates": ("eigvals", _eig, DENSE),
    "frf": ("solve_banded", _solve_banded, SPARSE),
    "static": ("solve_banded", _solve_banded, SPARSE),
}
"""What answers each kind of question: its name, the call, and the meshes that it is given."""
