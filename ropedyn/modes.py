"""Natural frequencies and shapes."""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _core, check, damping
from .answer import Answer, Cost, axes
from .chain import CHANNELS
from .errors import SceneError, SolveError
from .model import Model
from .table import Table
from .unit import FAMILY

if TYPE_CHECKING:
    from matplotlib.axes import Axes

STRAINS = ("bending", "twist", "stretch", "lay", "tension", "spring")
"""What stores strain energy, in the core's order."""

LARGEST_DENSE = 8_000
"""Unknowns above which the dense matrix of the assembled solver, 8 n^2 bytes, is refused."""


@dataclass(frozen=True, eq=False)
class Modes(Answer):
    """Natural frequencies and shapes of an undamped model, lowest first.

    Attributes
    ----------
    coordinates : tuple of str
        Of every node.
    x : ndarray, shape (nodes,)
        [m].
    frequency : ndarray, shape (k,)
        [Hz]; 0 for rigid-body motion and where motion grows.
    eigenvalue : ndarray, shape (k,)
        omega^2 [rad^2/s^2]; negative beyond the critical compression.
    growth : ndarray, shape (k,)
        Growth rate sqrt(-omega^2) where that is negative [1/s], else 0.
    rounding_error : ndarray, shape (k,)
        Estimated absolute error of the frequency that rounding in the assembled matrices
        causes [Hz].
    damping_ratio : ndarray, shape (k,)
        Of each mode by its share of every damped part; exact where damping is proportional, the
        first-order value otherwise, 0 where the frequency is 0.
    family : ndarray of str, shape (k,)
        "transverse", "bending rotation", "torsional" or "axial": the coordinate with the most
        kinetic energy.
    modal_mass : ndarray, shape (k,)
        shape^T M shape [kg, kg m^2].
    shape : ndarray, shape (k, nodes, coordinates)
        The largest component of the family's own coordinate is 1 [m, rad].
    energy : dict of ndarray, shape (k,)
        Fractions: strain "bending", "twist", "stretch", "lay", "tension", "spring" as far as the
        scene has them, sum 1 (all 0 for rigid-body motion); kinetic "x", "z", "alpha", "beta" of
        the coordinates there are, sum 1.
    cost : Cost
        What they cost.
    """

    coordinates: tuple[str, ...]
    x: NDArray[np.float64] = field(metadata=axes("node", unit="m"))
    frequency: NDArray[np.float64] = field(metadata=axes("mode", unit="Hz"))
    eigenvalue: NDArray[np.float64] = field(metadata=axes("mode", unit="rad^2/s^2"))
    growth: NDArray[np.float64] = field(metadata=axes("mode", unit="1/s"))
    rounding_error: NDArray[np.float64] = field(metadata=axes("mode", unit="Hz"))
    damping_ratio: NDArray[np.float64] = field(metadata=axes("mode"))
    family: NDArray[np.str_] = field(metadata=axes("mode"))
    modal_mass: NDArray[np.float64] = field(metadata=axes("mode", unit="kg or kg m^2"))
    shape: NDArray[np.float64] = field(metadata=axes("mode", "node", "coordinate", unit="m or rad"))
    energy: dict[str, NDArray[np.float64]] = field(metadata=axes("mode", keyed=True))
    cost: Cost

    def table(self) -> Table:
        """Return one row for each mode."""
        columns: dict[str, Any] = {
            "mode": np.arange(1, len(self.frequency) + 1),
            "frequency [Hz]": self.frequency,
            "rounding error [Hz]": self.rounding_error,
            "damping ratio": self.damping_ratio,
            "family": self.family,
        }
        if (self.growth > 0).any():
            columns["growth [1/s]"] = self.growth
        kinds = {"kinetic": self.coordinates}
        kinds["strain"] = tuple(k for k in self.energy if k not in self.coordinates)
        for kind, names in kinds.items():
            columns |= {f"{kind} {name} [%]": 100 * self.energy[name] for name in names}
        return Table.of("natural frequencies", columns)

    def plot(self, ax: Axes | None = None, *, coordinate: str | None = None) -> Axes:
        """Plot the shapes of one coordinate along the rope, the first one by default."""
        from .plotting import plot_modes

        return plot_modes(self, ax, coordinate)


@dataclass(frozen=True)
class _Raw:
    """Modes of one component, as the core gives them, spread over all coordinates."""

    eigenvalue: NDArray[np.float64]
    error: NDArray[np.float64]
    shape: NDArray[np.float64]
    finite: int
    unknowns: int


def solve_modes(
    model: Model, number: int | None, *, below: float | None, solver: str, strict: bool = True
) -> Modes:
    """Find natural frequencies and shapes; see `Model.modes`.

    Without `strict` fewer modes than asked for are no error.
    """
    check.one_of(solver, "solver", ("lapack",))
    if (number is None) == (below is None):
        raise SceneError(f"give either number or below, got number={number!r} and below={below!r}")
    if number is not None:
        check.count(number, "number", most=np.iinfo(np.int32).max)
        limit = 0.0
    else:
        highest = min(check.number(below, "below", "Hz", sign="positive"), check.HIGHEST)
        limit = (2 * math.pi * highest) ** 2
    start = time.perf_counter()
    parts = [_solve_component(model, c, number or 0, limit) for c in model.components]
    seconds = time.perf_counter() - start
    finite = sum(part.finite for part in parts)
    if strict and number is not None and number > finite:
        raise SolveError(f"number must be at most {finite}, the modes this model has, got {number}")
    cost = Cost(seconds, "lapack", len(model.x) - 1, sum(p.unknowns for p in parts), len(parts))
    return _answer(model, parts, number, cost)


def _solve_component(model: Model, component: tuple[str, ...], number: int, limit: float) -> _Raw:
    chain = model.chain.only(component)
    if chain.free > LARGEST_DENSE:
        raise SolveError(
            f"({', '.join(component)}) has {chain.free} unknowns: solver 'lapack' needs a dense "
            f"matrix of that size and takes at most {LARGEST_DENSE}; use fewer elements"
        )
    try:
        (eigenvalue, error, part), finite = _core.modes(
            chain, number, limit, _scale(model, component)
        )
    except SolveError as refusal:
        raise SolveError(f"({', '.join(component)}): {refusal}") from refusal
    lost = ~np.isfinite(error) | ~np.isfinite(eigenvalue)
    if lost.any():
        raise SolveError(
            f"mode {int(lost.argmax()) + 1} of ({', '.join(component)}) has no correct digit: the "
            "inertias or stiffnesses differ too much for the assembled solver"
        )
    shape = np.zeros((len(part), len(model.x), len(model.coordinates)))
    shape[:, :, [model.coordinates.index(c) for c in component]] = part
    return _Raw(eigenvalue, error, shape, finite, chain.free)


def _scale(model: Model, component: tuple[str, ...]) -> float:
    """Return the order of the first elastic eigenvalue: half a wave over the uniform rope."""
    rope, chain = model.scene.rope, model.chain
    with np.errstate(over="ignore"):
        wave = float(np.square(np.pi / rope.length))
    inertia = chain.mass[chain.term_of].sum(axis=0).diagonal() / rope.length
    with np.errstate(divide="ignore", over="ignore"):
        own = np.divide(1.0, chain.flexibility[0].diagonal())
    stiffness = {c: float(own[k]) if np.isfinite(own[k]) else 0.0 for c, k in CHANNELS.items()}
    stiffness["z"] = stiffness["beta"] * wave + abs(model.scene.tension)
    orders = [
        stiffness[c] * wave / inertia[k]
        for k, c in enumerate(model.coordinates)
        if c in component and inertia[k] > 0 and stiffness[c] > 0
    ]
    return float(np.clip(min(orders, default=1.0), 1e-200, 1e200))


def _answer(model: Model, parts: list[_Raw], number: int | None, cost: Cost) -> Modes:
    eigenvalue = np.concatenate([part.eigenvalue for part in parts])
    error = np.concatenate([part.error for part in parts])
    shape = np.concatenate([part.shape for part in parts])
    # what rounding cannot tell from 0 is rigid-body motion
    eigenvalue = np.where(np.abs(eigenvalue) <= error, 0.0, eigenvalue)
    order = np.argsort(eigenvalue, kind="stable")[:number]
    eigenvalue, error, shape = eigenvalue[order], error[order], shape[order]
    strain, kinetic = _core.energy(model.chain, shape)
    own = kinetic.argmax(axis=1)
    size = _largest(shape, own)
    shape /= size[:, None, None]
    strain, kinetic = strain / size[:, None] ** 2, kinetic / size[:, None] ** 2
    omega = np.sqrt(np.maximum(eigenvalue, 0.0))
    return Modes(
        coordinates=model.coordinates,
        x=model.x,
        frequency=omega / (2 * math.pi),
        eigenvalue=eigenvalue,
        growth=np.sqrt(np.maximum(-eigenvalue, 0.0)),
        rounding_error=_in_hertz(eigenvalue, error),
        damping_ratio=_damping_ratio(model, omega, strain, kinetic),
        family=np.array([FAMILY[model.coordinates[k]] for k in own], dtype=np.str_),
        modal_mass=kinetic.sum(axis=1),
        shape=shape,
        energy=_fractions(model, eigenvalue, strain, kinetic),
        cost=cost,
    )


def _largest(shape: NDArray[np.float64], own: NDArray[np.intp]) -> NDArray[np.float64]:
    """Return the value of the largest component of the family's own coordinate, with its sign."""
    rows = np.arange(len(shape))
    moved = shape[rows, :, own]
    return moved[rows, np.abs(moved).argmax(axis=1)]


def _in_hertz(eigenvalue: NDArray[np.float64], error: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the largest change of the frequency while the eigenvalue changes by its error."""
    low = np.sqrt(np.maximum(eigenvalue - error, 0.0))
    high = np.sqrt(np.maximum(eigenvalue + error, 0.0))
    omega = np.sqrt(np.maximum(eigenvalue, 0.0))
    return np.maximum(high - omega, omega - low) / (2 * math.pi)


def _damping_ratio(
    model: Model,
    omega: NDArray[np.float64],
    strain: NDArray[np.float64],
    kinetic: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Return zeta = shape^T Im(dynamic stiffness) shape / (2 omega^2 modal mass) at omega."""
    part = np.stack(
        [
            strain[:, : STRAINS.index("tension")].sum(axis=1),
            strain[:, STRAINS.index("tension")],
            strain[:, STRAINS.index("spring")],
            kinetic.sum(axis=1),
        ],
        axis=1,
    )
    lost = (damping.factors(model.scene.dampings, omega).imag * part).sum(axis=1)
    return np.divide(lost, 2 * omega**2 * part[:, 3], out=np.zeros_like(omega), where=omega > 0)


def _fractions(
    model: Model,
    eigenvalue: NDArray[np.float64],
    strain: NDArray[np.float64],
    kinetic: NDArray[np.float64],
) -> dict[str, NDArray[np.float64]]:
    """Return shares of the strain and of the kinetic energy."""
    total = strain.sum(axis=1)
    moves = (eigenvalue != 0) & (total != 0)
    energy = {}
    stores = {"spring": {"spring", "hinge"}}
    for k, name in enumerate(STRAINS):
        if stores.get(name, {name}) & set(model.scene.effects):
            share = np.divide(strain[:, k], total, out=np.zeros_like(total), where=moves)
            energy[name] = share
    for k, name in enumerate(model.coordinates):
        energy[name] = kinetic[:, k] / kinetic.sum(axis=1)
    return energy
