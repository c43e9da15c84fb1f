"""How far a motion of elements is from that of the continuous spans of the same scene."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..base.array import Real
from ..base.errors import SceneError, SolveError
from ..chain.compile import compile_scene
from .history import History
from .moved import Moved
from .request import Run

NONE = np.zeros(0)


def against_spans(run: Run, value: Real, solve: Callable[[Run], History | Moved]) -> Real:
    """Return the distance and the error of that, as value; infinite where there is no answer."""
    if run.model.element == "continuous":
        return np.zeros(value.shape)
    try:
        true = solve(replace(run, model=compile_scene(run.model.scene), snapshots=NONE))
    except (SceneError, SolveError):
        return np.full(value.shape, np.inf)
    return np.abs(value - true.value) + true.error
