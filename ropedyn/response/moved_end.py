"""Response to the motion of a held end.

Let go and held by a spring and a dashpot instead, an end moves by H_ee under a unit force on it and
the rope by H_re. So per motion of the end the rope moves by

    T = H_re/H_ee,

whatever the spring and the dashpot are: they only keep both away from resonances of their own.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from functools import partial
from typing import Any

import numpy as np

from .. import _core
from ..base.array import Complex, Real
from ..base.errors import SceneError
from ..base.unit import END
from ..chain.chain import Chain
from ..chain.compiled import Compiled
from ..chain.port import Point
from .question import Bound, Question, Solver
from .rounding import EPS

STILL = 1e-8  # Motion of an end over that under the spring alone, of which digits may be lost.


def is_end(drive: tuple[Any, ...]) -> bool:
    """Whether the drive is the motion of an end, such as ("end", 0, "z")."""
    return bool(drive[0] == END)


def refuse_moved_ends(drives: Iterable[tuple[Any, ...]]) -> None:
    """Refuse the motion of ends where damping is modal."""
    if any(map(is_end, drives)):
        raise SceneError(
            "damping must not be modal where an end is moved: a ratio does not say whether it is "
            "of motion past the ground or past the end"
        )


def moves_ends(solver: Solver) -> Solver:
    """Return a solver that takes the motion of ends as drives beside forces."""

    def solve(question: Question) -> tuple[Complex, Bound]:
        drives, count = question.drives, len(question.frequency)
        ends = [k for k, drive in enumerate(drives) if is_end(drive)]
        if not ends:
            return solver(question)
        shape = (len(drives), len(question.responses), count)
        value = np.zeros(shape, dtype=np.complex128)
        bounds: list[tuple[Any, Bound]] = []
        forces = [k for k in range(len(drives)) if k not in ends]
        if forces:
            pushed = [drives[k] for k in forces]
            value[forces], bound = solver(dataclasses.replace(question, drives=pushed))
            bounds.append((forces, bound))
        for k in ends:
            value[k], bound = _transmitted(question, drives[k], solver)
            bounds.append((k, bound))
        return value, partial(gathered, shape, bounds)

    return solve


def gathered(shape: tuple[int, ...], bounds: Iterable[tuple[Any, Bound]]) -> Real:
    """Put bounds of some drives beside each other."""
    error = np.zeros(shape)
    for which, bound in bounds:
        error[which] = bound()
    return error


def _transmitted(question: Question, end: Point, solver: Solver) -> tuple[Complex, Bound]:
    """Return the response per motion of one end, (responses, f), and what bounds its rounding."""
    model, own = released(question.model, end)
    responses = question.responses
    asked = [own, *responses]
    freed = dataclasses.replace(question, model=model, drives=[own], responses=asked)
    value, bound = solver(freed)
    _refuse_still(question, freed, value[0, 0], solver)
    ratio = value[0, 1:] / value[0, :1]
    same = [k for k, point in enumerate(responses) if point == own]
    ratio[same] = 1.0
    still = dataclasses.replace(question, drives=[], responses=responses)
    ratio.imag[:, ~still.is_damped] = 0.0  # only rounding is there

    def bound_of_ratio() -> Real:
        error, size = bound()[0], np.abs(ratio)
        wrong = (error[1:] + size * error[:1]) / np.abs(value[0, :1]) + 2 * EPS * size
        wrong[same] = 0.0
        return np.asarray(wrong)

    return ratio, bound_of_ratio


def _refuse_still(question: Question, freed: Question, motion: Complex, solver: Solver) -> None:
    """Refuse lines where no digit is left of the motion of an end that a force moves."""
    # it stands still on the resonances of the rope whose end is held
    spring, _ = _hold(question.model, freed.drives[0][0])
    small = np.flatnonzero(np.abs(motion) * spring < STILL)
    if not small.size:
        return
    alone = dataclasses.replace(
        freed,
        responses=freed.drives,
        frequency=freed.frequency[small],
        factor=np.ascontiguousarray(freed.factor[:, small]),
    )
    value, bound = solver(alone)
    lost = small[np.abs(value[0, 0]) <= bound()[0, 0]]
    if lost.size:
        raise question.resonance(int(lost[0]))


def released(model: Compiled, end: tuple[Any, ...]) -> tuple[Compiled, Point]:
    """Return the model whose end a spring and a dashpot hold, and where that end is."""
    chain = model.chain
    at = model.coordinates.index(end[2])
    term = int(chain.term[-1 if end[1] else 0])
    spring, dashpot = _hold(model, end[2])
    held, stiffness = chain.held.copy(), chain.stiffness.copy()
    damping = np.zeros_like(chain.mass) if chain.damping is None else chain.damping.copy()
    held[term, at] = 0
    stiffness[term, at, at] += spring
    damping[term, at, at] += dashpot
    loose = chain._replace(held=held, stiffness=stiffness, damping=damping)
    place = (str(end[2]), float(model.x[-1 if end[1] else 0]))
    return dataclasses.replace(model, chain=loose), place


def _hold(model: Compiled, coordinate: str) -> tuple[float, float]:
    """Return a spring as soft as the elements one after another, and a dashpot."""
    # the rope's inertia on that spring takes as long as the dashpot on it
    component = model.component_of(coordinate)
    chain = model.chain.only(component)
    soft = _softness(chain)
    spring = 1 / soft[component.index(coordinate)]
    return float(spring), float(spring * np.sqrt((_inertia(chain) * soft).max()))


def _softness(chain: Chain) -> Real:
    """Return the flexibilities of the elements on each coordinate, added up, shape (width,)."""
    G = _core.triples(chain._replace(rise=None).at_rest)[1]
    sum_ = np.abs(np.einsum("eii->ei", G)[chain.element_of]).sum(axis=0)
    return np.where(np.isfinite(sum_) & (sum_ > 0), sum_, 1.0)


def _inertia(chain: Chain) -> Real:
    """Return the inertia on each coordinate, shape (width,)."""
    total = np.einsum("nii->ni", chain.mass)[chain.term_of].sum(axis=0)
    if chain.inertia is not None:
        total = total + (chain.inertia * chain.length[:, None])[chain.element_of].sum(axis=0)
    return np.asarray(total)
