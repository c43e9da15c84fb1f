"""How many critical loads a rope at rest exceeds: negative eigenvalues of its stiffness."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from .. import _core
from ..base.array import Real
from ..base.errors import SolveError
from ..chain.chain import Chain
from ..chain.compile import compile_scene
from ..chain.compiled import EXACT, Compiled
from ..chain.port import Point

NEAR = 64 * np.finfo(float).eps
"""What compression and springs that push must be away from a critical load, relatively: twenty
times as far as counts were seen to be wrong next to one."""


def critical_loads(model: Compiled, loads: Collection[Point]) -> int:
    """Count the critical loads that are exceeded, or met to rounding, where these points move."""
    if not _pushes(model.chain):
        return 0
    if model.element in EXACT and model.element != "continuous":
        model = compile_scene(model.scene)  # a rope buckles between its nodes too
    moving = {name for name, _ in loads}
    return sum(_exceeded(model.chain.only(c)) for c in model.components if moving & set(c))


def refuse_critical(model: Compiled, loads: Collection[Point], instead: str) -> None:
    """Refuse loads under which a rope rests where it does not stay."""
    exceeded = critical_loads(model, loads)
    if exceeded:
        raise SolveError(f"the rope does not stay at rest: {exceeds(exceeded)}; {instead}")


def exceeds(count: int) -> str:
    """Say how many critical loads are exceeded, or met to rounding."""
    return f"{count} critical load{' is' if count == 1 else 's are'} met or exceeded"


def _pushes(chain: Chain) -> bool:
    """Whether anything makes the stiffness less."""
    springs = np.diagonal(chain.stiffness, axis1=1, axis2=2)
    return bool((chain.tension < _grows(chain)).any() or (springs < 0).any())


def _grows(chain: Chain) -> Real | float:
    """Return how far the tension of elements is from their mean at most [N]."""
    return 0.0 if chain.rise is None else np.abs(chain.rise) / 2


def _exceeded(chain: Chain) -> int:
    """Count the negative eigenvalues of a stiffness made less by what rounding may hide."""
    if not _pushes(chain):
        return 0
    less = chain.undamped._replace(
        tension=chain.tension - NEAR * (np.abs(chain.tension) + _grows(chain)),
        stiffness=chain.stiffness - NEAR * np.abs(chain.stiffness),
    )
    return int(_core.count(less, np.zeros(1))[0])
