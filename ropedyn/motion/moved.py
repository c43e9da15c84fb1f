"""What a method of linear motion answers, and how far elements are from continuous spans."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ..base.array import Real
from ..base.errors import SceneError, SolveError
from ..chain.compile import compile_scene
from ..chain.port import Point
from .history import History
from .request import Run


class Moved(NamedTuple):
    """Motion with an error that covers it."""

    value: Real  # (responses, t)
    error: Real  # absolute, as value
    method: str  # "modal" or "line"
    modes: int = 0  # that were summed
    lines: int = 0  # rates that were looked at
    rounding: Real | float = 0.0  # of sums over modes, a part of the error

    def shares(self, run: Run) -> Real:
        """Return the largest error of each response over what it is a share of, (responses,)."""
        size = np.abs(self.value).max(axis=1)
        if run.together:
            size = of_kinds(size, run.responses)
        size = np.maximum(size, run.least)
        error = self.error.max(axis=1)
        none = np.where(error > 0, np.inf, 0.0)
        return np.divide(error, size, out=none, where=size > 0)


def of_kinds(size: Real, responses: Sequence[Point]) -> Real:
    """Return the largest size of all responses of the same kind, such as all forces along z."""
    kinds = np.array([point[0] for point in responses])
    return np.asarray(np.where(kinds[:, None] == kinds, size, 0.0).max(axis=1, initial=0.0))


def against_spans(run: Run, value: Real, solve: Callable[[Run], History | Moved]) -> Real:
    """Return the distance and the error of that, as value; infinite where there is no answer."""
    if run.model.element == "continuous":
        return np.zeros(value.shape)
    try:
        true = solve(replace(run, model=compile_scene(run.model.scene), snapshots=np.zeros(0)))
    except (SceneError, SolveError):
        return np.full(value.shape, np.inf)
    return np.abs(value - true.value) + true.error
