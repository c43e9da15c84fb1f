"""Laws of single points, as the core takes them and as Python does."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...base.array import Real
from ...chain.chain import Chain
from ...chain.compiled import Compiled
from ...chain.port import is_held, ports
from ...scene.parts.node import Law
from ...scene.parts.part import standing

KINDS = ("power", "stop", "call")  # The laws are in the core's order.


class Laws(NamedTuple):
    """Laws of single points as the core takes them; see csrc/law/law.h."""

    node: NDArray[np.int32]
    row: Real
    kind: NDArray[np.int32]
    value: Real


class PythonLaw(NamedTuple):
    """A law in Python."""

    law: int  # Number among the laws
    part: int  # Number among the parts
    call: Callable[[float, float, float], float]


class StandingLaw(NamedTuple):
    """A law of a scene."""

    part: int  # Number among the parts
    x: float  # Where it acts [m]
    law: Law


def standing_laws(model: Compiled, component: tuple[str, ...]) -> list[StandingLaw]:
    """Return the laws that act on a component."""
    found = []
    for i, part in enumerate(model.scene.parts):
        for one in standing([part]):
            found += [StandingLaw(i, one.x, law) for law in one.term().laws]
    return [one for one in found if one.law.coordinate in component]


def laws_of(
    chain: Chain, x: Real, component: tuple[str, ...], laws: list[StandingLaw]
) -> tuple[Laws, tuple[PythonLaw, ...]]:
    """Return the laws where something can move, and those among them that Python knows."""
    points = [(one.law.coordinate, one.x) for one in laws]
    free = [one for one, p in zip(laws, points) if not is_held(chain, x, component, p)]
    where = ports(chain, x, component, [(law.coordinate, at) for _, at, law in free])
    value = np.zeros((len(free), 4))
    for k, (_, _, law) in enumerate(free):
        value[k, : len(law.value)] = law.value
    kind = np.array([KINDS.index(law.kind) for _, _, law in free], dtype=np.int32)
    calls = tuple(PythonLaw(k, i, law.call) for k, (i, _, law) in enumerate(free) if law.call)
    return Laws(where.node, where.row, kind, value), calls
