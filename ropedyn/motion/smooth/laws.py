"""Smooth laws of points, as the core's collocation takes them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ...base import check
from ...base.array import Real
from ...base.errors import SolveError
from ...chain.compiled import Compiled
from ...scene.parts.node import Law
from ..acting import ActingLaw, acting_laws, core_laws, scene_laws
from ..states import without_dashpots

BESIDE, ASIDE = (-0.7, 0.0, 0.7), 1e-3  # Parts of a motion where slopes are looked at, and of them.
SAME = 1e-9  # Values of a law that takes arrays are these parts of those one by one apart.


def laws_on(model: Compiled, component: tuple[str, ...]) -> list[ActingLaw]:
    """Return the laws of a component where something moves, and what else its points resist."""
    found = acting_laws(model, component)
    _, resisting = without_dashpots(model, component) if found else (model, ())
    for point, damping in resisting:
        found.append(ActingLaw(-1, point, Law(point[0], "power", (damping, 1.0))))
    return found


def why_not_smooth(model: Compiled) -> str:
    """Say why the laws of a scene are not for collocation, with nothing where they are."""
    for one in scene_laws(model.scene):
        if one.law.kind == "stop":
            return f"{one.name} is a stop"
        if one.law.kind == "power" and one.law.value[1] <= 1:
            return f"the force of {one.name} jumps or is steep where its velocity turns"
    return ""


# --- as the core takes them ---------------------------------------------------------------------


def smooth_laws(acting: list[ActingLaw], time: Real, size: Real) -> tuple[Any, ...]:
    """Return the laws, after a look at which of them take arrays; size (3, laws) of the motion."""
    _, value, calls = core_laws(acting)
    called = np.array([call is not None for call in calls], dtype=np.int32)
    arrays = [takes_arrays(call, time, size[:, d]) for d, call in enumerate(calls)]
    return called, value[:, :2].copy(), calls, np.array(arrays, dtype=np.uint8)


def takes_arrays(call: Callable[..., Any] | None, time: Real, size: Real) -> bool:
    """Whether a law says of arrays what it says one by one."""
    if call is None:
        return False
    count = 6
    t = np.linspace(time[0], time[-1], count)
    u = size[0] * np.array([0.0, 1.0, -0.7, 0.3, -1.0, 0.5])
    v = size[1] * np.array([0.4, -1.0, 0.0, 1.0, -0.6, 0.8])
    try:
        whole = call(t.copy(), u.copy(), v.copy())
        if not isinstance(whole, np.ndarray) or whole.shape != (count,):
            return False
        each = np.array([call(*map(float, one)) for one in zip(t, u, v)], dtype=np.float64)
        wrong = np.abs(np.asarray(whole, dtype=np.float64) - each)
    except Exception:  # the law is asked again where it acts, and says there what is wrong
        return False
    return bool((wrong <= SAME * np.abs(each).max()).all())


def slopes(law: Law, time: Real, size: Real) -> tuple[float, float]:
    """Return by how much a force changes at most with displacement and velocity [N/m, N s/m].

    As far as a few motions within its size (3,) tell.
    """
    u, v, _ = size.tolist()
    if law.kind == "stop" or (law.kind == "power" and law.value[1] < 1):
        return 0.0, 0.0
    if law.call is None:
        return 0.0, law.value[0] * law.value[1] * v ** (law.value[1] - 1)
    at = [(t, x * u, y * v) for t in time[[0, -1]].tolist() for x in BESIDE for y in BESIDE]

    def most(du: float, dv: float) -> float:
        assert law.call is not None
        ends = [[law.call(t, x + s * du, y + s * dv) for s in (-1, 1)] for t, x, y in at]
        return float(np.abs(np.diff(np.array(ends, dtype=np.float64))).max()) / 2

    try:
        return most(ASIDE * u, 0.0) / (ASIDE * u or 1.0), most(0.0, ASIDE * v) / (ASIDE * v or 1.0)
    except Exception:  # what is wrong is said where it acts
        return 0.0, 0.0


class LawFailure(NamedTuple):
    """Where a law failed."""

    error: BaseException | None  # what it raised; None of what is no number
    law: int
    time: float
    u: float
    v: float

    def told(self, laws: list[ActingLaw]) -> BaseException:
        """Return the error with what it is of."""
        one = laws[self.law]
        where = f"{one.name}.law(t={self.time!r}, u={self.u!r}, v={self.v!r})"
        if self.error is not None:
            if isinstance(self.error, Exception):
                self.error.add_note(f"raised by {where}")
            return self.error
        assert one.law.call is not None
        try:
            check.number(one.law.call(self.time, self.u, self.v), where, "N or N m")
        except (TypeError, ValueError) as error:
            refusal = SolveError(str(error).replace("must be", "must return"))
            refusal.__cause__ = error
            return refusal
        return SolveError(f"{where} must return the same number twice")
