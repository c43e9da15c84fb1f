"""Smooth laws of points, as the core's collocation takes them."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...base import check
from ...base.array import Real
from ...base.errors import SolveError
from ...chain.compiled import Compiled
from ...chain.port import Point
from ..acting import acting_laws, scene_laws
from ..states import without_dashpots

POWER, CALL = 0, 1  # Kinds of laws in the core's order.
BESIDE, ASIDE = (-0.7, 0.0, 0.7), 1e-3  # Parts of a motion where slopes are looked at, and of them.
SAME = 1e-9  # Values of a law that takes arrays are these parts of those one by one apart.


class SmoothLaw(NamedTuple):
    """A force on a point: -damping |v|^exponent sign(v), or what `call` says."""

    name: str  # as messages name it
    call: Callable[[Any, Any, Any], Any] | None = None
    damping: float = 0.0
    exponent: float = 1.0


class PointLaw(NamedTuple):
    """A law and where it acts."""

    point: Point
    law: SmoothLaw


def laws_on(model: Compiled, component: tuple[str, ...]) -> list[PointLaw]:
    """Return the laws of a component where something moves, and what else its points resist."""
    found = [
        PointLaw(one.point, SmoothLaw(one.name, one.law.call, *one.law.value))
        for one in acting_laws(model, component)
    ]
    if found:
        _, resisting = without_dashpots(model, component)
        found += [PointLaw(r.point, SmoothLaw("a dashpot", None, r.damping)) for r in resisting]
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


class CoreLaws(NamedTuple):
    """Laws as `_core.collocate` takes them."""

    kind: NDArray[np.int32]
    value: Real
    calls: tuple[Callable[[Any, Any, Any], Any] | None, ...]
    arrays: NDArray[np.uint8]


def core_laws(laws: list[SmoothLaw], time: Real, size: Real) -> CoreLaws:
    """Return the laws, after a look at which of them take arrays; size (3, laws) of the motion."""
    kind = np.array([CALL if law.call else POWER for law in laws], dtype=np.int32)
    value = np.array([[law.damping, law.exponent] for law in laws]).reshape(-1, 2)
    arrays = [bool(law.call) and takes_arrays(law, time, size[:, d]) for d, law in enumerate(laws)]
    return CoreLaws(kind, value, tuple(law.call for law in laws), np.array(arrays, dtype=np.uint8))


def takes_arrays(law: SmoothLaw, time: Real, size: Real) -> bool:
    """Whether a law says of arrays what it says one by one."""
    assert law.call is not None
    count = 6
    t = np.linspace(time[0], time[-1], count)
    u = size[0] * np.array([0.0, 1.0, -0.7, 0.3, -1.0, 0.5])
    v = size[1] * np.array([0.4, -1.0, 0.0, 1.0, -0.6, 0.8])
    try:
        whole = law.call(t.copy(), u.copy(), v.copy())
        if not isinstance(whole, np.ndarray) or whole.shape != (count,):
            return False
        each = np.array([law.call(*map(float, one)) for one in zip(t, u, v)], dtype=np.float64)
        wrong = np.abs(np.asarray(whole, dtype=np.float64) - each)
    except Exception:  # the law is asked again where it acts, and says there what is wrong
        return False
    return bool((wrong <= SAME * np.abs(each).max()).all())


def slopes(law: SmoothLaw, time: Real, size: Real) -> tuple[float, float]:
    """Return by how much a force changes at most with displacement and velocity [N/m, N s/m].

    As far as a few motions within its size (3,) tell.
    """
    u, v, _ = size.tolist()
    if law.call is None:
        return 0.0, law.damping * law.exponent * v ** (law.exponent - 1)
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

    def told(self, laws: list[SmoothLaw]) -> BaseException:
        """Return the error with what it is of."""
        one = laws[self.law]
        where = f"{one.name}.law(t={self.time!r}, u={self.u!r}, v={self.v!r})"
        if self.error is not None:
            if isinstance(self.error, Exception):
                self.error.add_note(f"raised by {where}")
            return self.error
        assert one.call is not None
        try:
            check.number(one.call(self.time, self.u, self.v), where, "N or N m")
        except (TypeError, ValueError) as error:
            refusal = SolveError(str(error).replace("must be", "must return"))
            refusal.__cause__ = error
            return refusal
        return SolveError(f"{where} must return the same number twice")
