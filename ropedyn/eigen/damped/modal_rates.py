"""Complex modes where each mode has a damping ratio of its own."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import partial

import numpy as np

from ...base.array import Complex, Index, Real
from ...base.errors import SceneError, SolveError
from ...chain.compiled import Compiled
from ...scene.damping import having, ratios
from ..eigen import solve_modes
from ..free_motion import MeshOfModes, Vectors
from ..modes import Modes
from .damped_modes import DampedModes

EPS = float(np.finfo(float).eps)
OF_RATE = 3.0  # Roundings from a frequency and a damping ratio to a rate.


def solve_modal(
    model: Compiled, number: int | None, *, below: float | None, points: int | None
) -> DampedModes:
    """Find the rates omega (-zeta +- sqrt(zeta^2 - 1)) of undamped modes."""
    dampings, effects = model.scene.dampings, model.scene.effects
    others = [one.kind for one in having(dampings, "rate", "loss", "drag")]
    others += ["dashpot"] if "dashpot" in effects else []
    others += model.chain.carried if model.chain.resists else []
    if others:
        raise SceneError(
            "damping must not be modal damping beside another that is not 0 for damped modes, "
            f"which that would couple, got {', '.join(others)}"
        )
    given = np.concatenate([np.ravel(one.term().ratio) for one in having(dampings, "ratio")])
    # an overdamped mode has a rate smaller than its frequency: those may be the lowest
    spread = float(np.exp(np.arccosh(max(1.0, float(np.sum(given))))))
    wanted = None if number is None else number + (len(given) if spread > 1 else 0)
    undamped = solve_modes(
        model,
        wanted,
        below=None if below is None else below * spread,
        solver="sweep",
        points=points,
        strict=False,
    )
    omega = np.sqrt(np.maximum(undamped.eigenvalue, 0.0))
    ratio = ratios(dampings, len(omega))
    limit = math.inf if below is None else 2 * math.pi * below
    needed = np.abs(undamped.eigenvalue) < (spread * limit) ** 2
    if np.isnan(ratio[needed][:number]).any():
        known = int(np.isnan(ratio).argmax())
        raise SceneError(
            "damping ratio must be one number or one for each mode, got "
            f"{known} for {int(needed.sum())} modes"
        )
    return _answer(undamped, omega, np.nan_to_num(ratio), number, limit)


def _answer(
    undamped: Modes, omega: Real, ratio: Real, number: int | None, limit: float
) -> DampedModes:
    # near critical damping 1 - ratio^2 would lose the digits that ratio has
    root: Complex = np.sqrt(np.asarray((ratio - 1) * (ratio + 1), dtype=np.complex128))
    # of an overdamped mode the slow rate as the product over the fast one
    fast = -omega * (ratio + root)
    slow = np.where(ratio < 1, fast.conj(), -omega / (ratio + root))
    # what grows has no ratio
    s = np.stack([slow + undamped.growth, fast - undamped.growth], axis=-1) + 0.0
    kept = (s.imag >= 0) & (np.abs(s) < limit)
    kept[:, 1] &= s[:, 1] != 0
    mode, _ = np.nonzero(kept)
    value = np.asarray(s[kept], dtype=np.complex128)
    order = np.argsort(np.abs(value), kind="stable")[:number]
    if number is not None and len(order) < number:
        raise SolveError(
            f"number must be at most {len(order)}, the damped modes there are, got {number}"
        )
    value, mode = value[order], mode[order]
    size = np.maximum(omega, undamped.growth)[mode]
    # the frequency is all that is not exact, but for a few roundings
    scale = np.divide(np.abs(value), size, out=np.ones_like(size), where=size > 0)
    searched = limit if number is None else float(np.abs(value[-1]))
    return DampedModes(
        coordinates=undamped.coordinates,
        certified=undamped.certified,
        searched=searched / (2 * math.pi),
        x=undamped.x,
        eigenvalue=value,
        rounding_error=partial(_rounding, undamped, value, mode, scale),
        rounding_bound=undamped.rounding_bound[mode] * scale,
        plane=undamped.plane[mode],
        cost=replace(undamped.cost),
        vectors=partial(_vectors, undamped, mode, value, (ratio * omega)[mode]),
        mesh=partial(_mesh, undamped, mode, scale),
        line=undamped.line,
    )


def _vectors(undamped: Modes, mode: Index, value: Complex, decay: Real) -> Vectors[np.complex128]:
    """Shapes without damping; D' is m (2 s + 2 zeta omega)."""
    share = np.divide(decay, value, out=np.zeros_like(value), where=value != 0)
    return Vectors(
        family=undamped.family[mode],
        modal_mass=undamped.modal_mass[mode] * (1 + share),
        shape=undamped.shape[mode].astype(np.complex128),
        energy={name: part[mode] for name, part in undamped.energy.items()},
    )


def _rounding(undamped: Modes, value: Complex, mode: Index, scale: Real) -> Real:
    few = OF_RATE * EPS * np.abs(value) / (2 * math.pi)
    return np.asarray(undamped.rounding_error[mode] * scale + few)


def _mesh(undamped: Modes, mode: Index, scale: Real) -> MeshOfModes:
    return MeshOfModes(undamped.mesh_error[mode] * scale)
