"""Laws of single points, as the core takes them and as Python does."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...base.array import Real
from ...chain.chain import Chain
from ...chain.port import ports
from ..acting import ActingLaw, core_numbers


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


def laws_of(
    chain: Chain, x: Real, component: tuple[str, ...], acting: list[ActingLaw]
) -> tuple[Laws, tuple[PythonLaw, ...]]:
    """Return the laws of a chain, and those among them that Python knows."""
    where = ports(chain, x, component, [one.point for one in acting])
    calls = tuple(
        PythonLaw(k, one.part, one.law.call) for k, one in enumerate(acting) if one.law.call
    )
    return Laws(where.node, where.row, *core_numbers([one.law for one in acting])), calls
