"""What measurements do not tell about what is sought, in words."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...base.array import Flags, Index, Integer, Real
from ...chain.compile import compile_scene
from ...eigen.eigen import solve_modes
from ...scene.scene import Scene
from ..fitting.solution import Solution

INVOLVED = 1e-6  # A number takes part in a direction from this share on.


class Data(NamedTuple):
    """What was measured, in words."""

    name: str
    does: str
    tells: str


PEAKS = Data("the peaks", "do", "tell")
RESPONSE = Data("the response", "does", "tells")


def noteworthy(solution: Solution) -> Flags:
    """Say of which ropes something was not told, shape (n,)."""
    silent = (solution.side != 0) | solution.uncertainty.blind
    return silent.any(axis=1) | np.isinf(solution.noise) | solution.refuted


def notes_of(solution: Solution, data: Data = PEAKS) -> tuple[str, ...]:
    """Return a sentence for each thing that was not told of one rope."""
    return (*_gone(solution, data), *_blind(solution, data), *_noise(solution))


def _gone(solution: Solution, data: Data) -> list[str]:
    """Name the numbers that went to 0 or infinity."""
    found = []
    for path, side in zip(solution.unknowns.paths, solution.side[0]):
        if side:
            where = "0" if side < 0 else "infinity"
            found.append(
                f"{path} goes to {where}: {data.name} {data.does} not show it, its interval has "
                "one bound"
            )
    return found


def _blind(solution: Solution, data: Data) -> list[str]:
    """Name numbers that cannot be told apart, and the combinations that can."""
    at = np.flatnonzero(solution.uncertainty.blind[0] & (solution.side[0] == 0))
    if not len(at):
        return []
    names = [solution.unknowns.paths[i] for i in at]
    silent = ", ".join(names[:-1]) + " and " + names[-1] if len(names) > 1 else names[0]
    if len(at) == 1:
        return [f"{data.name} {data.does} not depend on {silent} near the value given"]
    told = [_shown(solution, at, power) for power in combinations(solution, at)]
    apart = f"{data.name} cannot tell {silent} apart: all have an infinite std"
    if not told:
        return [f"{apart}; another number must be known"]
    return [f"{apart}; what {data.name} {data.tells} is {', '.join(told)}"]


def combinations(solution: Solution, at: Index) -> list[Real]:
    """Return exponents, small fractions, of products that are told: null space in echelon form."""
    if not solution.unknowns.by_factor[at].all():
        return []
    basis = solution.uncertainty.basis[0][at]
    inertia = solution.record["slope"][0][:, at].sum(axis=0) * solution.value[0][at] < 0
    null = np.linalg.svd(basis.T)[2][np.linalg.matrix_rank(basis, tol=INVOLVED) :]
    pivots: list[int] = []
    for row in range(len(null)):
        # others are divided by one that takes part as much as any, by inertia rather than stiffness
        share = np.abs(null[row])
        share[pivots] = 0.0
        pivot = int(np.argmax((share > 0.999 * share.max()) * (1 + inertia)))
        null[row] /= null[row, pivot]
        for other in range(len(null)):
            if other != row:
                null[other] -= null[other, pivot] * null[row]
        pivots.append(pivot)
    found = []
    for i in range(len(at)):
        if i not in pivots:
            power = np.zeros(len(at))
            power[i], power[pivots] = 1.0, -null[:, i]
            if np.abs(4 * power - np.round(4 * power)).max() > 1e-3:
                return []
            found.append(np.round(4 * power) / 4)
    return found


def _shown(solution: Solution, at: Index, power: Real) -> str:
    """Return a product with its value and standard deviation."""
    value = float(np.prod(solution.value[0][at] ** power))
    direction = np.zeros(len(solution.unknowns))
    direction[at] = power
    std = float(solution.noise[0] * np.sqrt(direction @ solution.uncertainty.unit[0] @ direction))
    name = _product([solution.unknowns.paths[i] for i in at], power)
    return f"{name} = {value:.6g} +- {abs(value) * std:.2g}"


def _product(names: list[str], power: Real) -> str:
    def factor(name: str, exponent: float) -> str:
        return name if exponent == 1 else f"{name}^{exponent:g}"

    above = [factor(n, p) for n, p in zip(names, power) if p > 0]
    below = [factor(n, -p) for n, p in zip(names, power) if p < 0]
    over = "/".join(["*".join(above) or "1", *([] if not below else ["*".join(below)])])
    return over if len(below) < 2 else over.replace("/", "/(") + ")"


def _noise(solution: Solution) -> list[str]:
    """Say where nothing tells the noise, or where there is more of it than was said."""
    if not np.isfinite(solution.noise[0]):
        return ["as many unknown as peaks, and no std: nothing tells how uncertain they are"]
    if not solution.refuted[0]:
        return []
    freedom, off = solution.record["freedom"][0], solution.off[0] / solution.nominal[0] ** 2
    wider = solution.noise[0] / solution.nominal[0]
    return [
        f"the peaks are off by more than their std: chi-square {off:.3g} of {freedom:.3g} degrees "
        "of freedom; something else acts, the orders are wrong, or their std is larger: intervals "
        f"are {wider:.3g} times as wide as their std says, and of Student's t"
    ]


def sag_note(scene: Scene, orders: Integer, relative: Real) -> str:
    """Say which mode the parabola is off by more than its peak is known, nothing where none is."""
    # `relative`, shape (k,): standard deviations of the peaks with that of the model
    used = orders > 0
    if not scene.sags or not used.any():
        return ""
    # of the parabola, which is what was fitted
    modes = solve_modes(compile_scene(scene), int(orders.max()), below=None, solver="sweep")
    off = (modes.model_error / modes.frequency)[orders[used] - 1]
    worst = int((off / relative[used]).argmax())
    if off[worst] <= relative[used][worst]:
        return ""
    mode = orders[used][worst]
    if np.isinf(off[worst]):
        return "how far the parabola of sag is off is not known here: give sag=False or a model_std"
    return (
        f"the parabola of sag is off by {off[worst]:.2g} of mode {mode}, more than its peak is: "
        f"model_std={off.max():.1g} widens the intervals as far"
    )
