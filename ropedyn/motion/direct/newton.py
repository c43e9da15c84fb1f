"""Forces that Python computes from the motion of a point: Newton's method at a stage."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ... import _core
from ...base import check
from ...base.array import Real
from ...base.errors import SolveError
from .lumped import Lumps
from .point_law import PythonLaw

MOST = 50  # A stage takes so many Newton steps at most.
ENOUGH = 1e-12  # A stage holds where the residual is this part of the terms of its forces,
LEAST = 1e-9  # or this one where rounding lets it fall no more.
LEAST_SHARE = 1e-3  # A Newton step is halved down to this part of it.
STEP = 1e-7  # Numerical derivatives take this part of what moves as their step.


class Stage(NamedTuple):
    """A stage without the forces of laws, and what unit forces of them change."""

    # increments of the points are x + C force, their velocity is that over theta

    lumps: Lumps
    theta: float  # [s]
    time: float  # [s]
    x: Real  # (laws,)
    C: Real  # (laws, laws)
    q: Real  # (laws,) displacement that increments start from

    @property
    def calls(self) -> list[int]:
        """Numbers of Python's laws."""
        return [one.law for one in self.lumps.calls]

    def increment(self, given: Real) -> tuple[Real, Real]:
        """Return how the points move under given forces of Python's laws, and all the forces."""
        full = np.zeros(len(self.x))
        full[self.calls] = given
        if len(self.calls) < len(full):
            full, residual = _core.march_laws(
                self.lumps.laws[2:], self.theta, self.x, self.C, self.q, full
            )
            if not residual <= LEAST:
                raise SolveError(
                    f"the laws of the stage at t = {self.time!r} s do not converge: the residual "
                    f"is {residual:.3g} of their terms"
                )
        return self.x + self.C @ full, full


def solve_stage(stage: Stage, guess: Real) -> tuple[Real, Real]:
    """Return the forces of all laws at a stage, and the velocities of their points."""
    if len(stage.x) == 1:
        return _solve_alone(stage, float(guess[0]))
    given = guess.copy()
    best, worst = math.inf, math.inf
    moved, full = stage.increment(given)
    wanted = _forces(stage, moved)
    for _ in range(MOST):
        size = np.abs(given) + np.abs(wanted)
        gap = wanted - given
        worst = float(np.max(np.abs(gap) / np.where(size > 0, size, 1.0)))
        if worst <= ENOUGH or (worst <= LEAST and worst >= best / 2):
            return full, moved / stage.theta
        best = min(best, worst)
        given, moved, full, wanted = _improved(stage, given, moved, wanted)
    raise _does_not_converge(stage, worst)


def _does_not_converge(stage: Stage, residual: float) -> SolveError:
    parts = ", ".join(f"parts[{one.part}]" for one in stage.lumps.calls)
    return SolveError(
        f"the law of {parts} does not converge at t = {stage.time!r} s: the residual is "
        f"{residual:.3g} of the forces; laws without jumps do, in steps that are short enough"
    )


def _solve_alone(stage: Stage, force: float) -> tuple[Real, Real]:
    """Return the force of the only law and its point's velocity; slopes are those of secants."""
    one, x, C = stage.lumps.calls[0], float(stage.x[0]), float(stage.C[0, 0])
    moved = x + C * force
    wanted = _force(stage, one, moved)
    slope, best, worst = math.nan, math.inf, math.inf
    for _ in range(MOST):
        gap, size = wanted - force, abs(force) + abs(wanted)
        worst = abs(gap) / size if size > 0 else 0.0
        if worst <= ENOUGH or (worst <= LEAST and worst >= best / 2):
            return np.array([force]), np.array([moved / stage.theta])
        best = min(best, worst)
        if math.isnan(slope):
            slope = float(_slopes(stage, np.array([moved]), np.array([wanted]))[0])
        change = gap / (1 - slope * C) if slope * C != 1 else gap
        least, before, was = abs(change) * LEAST_SHARE, moved, wanted
        while True:
            moved = x + C * (force + change)
            wanted = _force(stage, one, moved)
            if abs(wanted - force - change) < abs(gap) or abs(change) < least:
                break
            change /= 2
        force += change
        if moved != before:
            slope = (wanted - was) / (moved - before)
    raise _does_not_converge(stage, worst)


def _improved(
    stage: Stage, given: Real, moved: Real, wanted: Real
) -> tuple[Real, Real, Real, Real]:
    """Return forces after a step of Newton's method, halved until the gap falls."""
    calls = stage.calls
    slope = _slopes(stage, moved, wanted)
    jacobian = np.eye(len(calls)) - slope[:, None] * stage.C[np.ix_(calls, calls)]
    gap = wanted - given
    try:
        change = np.linalg.solve(jacobian, gap)
    except np.linalg.LinAlgError:
        change = gap
    size = float(np.abs(gap).max())
    share = 1.0
    while True:
        tried = given + share * change
        moved, full = stage.increment(tried)
        wanted = _forces(stage, moved)
        if float(np.abs(wanted - tried).max()) < size or share < LEAST_SHARE:
            return tried, moved, full, wanted
        share /= 2


def _forces(stage: Stage, moved: Real) -> Real:
    """Return what Python's laws say."""
    return np.array([_force(stage, one, float(moved[one.law])) for one in stage.lumps.calls])


def _force(stage: Stage, one: PythonLaw, moved: float) -> float:
    """Return what a law says where its point has moved."""
    u, v = float(stage.q[one.law]) + moved, moved / stage.theta
    try:
        value = one.call(stage.time, u, v)
    except Exception as error:
        error.add_note(f"raised by parts[{one.part}].law(t={stage.time!r}, u={u!r}, v={v!r})")
        raise
    if type(value) is float and math.isfinite(value):
        return value
    where = f"parts[{one.part}].law(t={stage.time!r}, u={u!r}, v={v!r})"
    try:
        return check.number(value, where, "N or N m")
    except (TypeError, ValueError) as error:
        raise SolveError(str(error).replace("must be", "must return")) from error


def _slopes(stage: Stage, moved: Real, wanted: Real) -> Real:
    """Return how fast each law's force grows with its point's increment, by u and by v."""
    slopes = np.zeros(len(wanted))
    for k, (one, force) in enumerate(zip(stage.lumps.calls, wanted)):
        j = one.law
        at = float(moved[j])
        step = STEP * max(abs(at), abs(float(stage.q[j])), abs(float(stage.C[j, j] * force)))
        if step > 0:
            slopes[k] = (_force(stage, one, at + step) - force) / step
    return slopes
