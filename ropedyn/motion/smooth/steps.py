"""Steps of equal length between breaks."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from ...base.array import Real
from ..modal.exponentials import is_uniform

SNAP = 1e-9  # Times closer to the end of a step than this part of it are there.


class Steps(NamedTuple):
    """Equal steps one after another."""

    begin: float  # [s]
    h: float  # [s]
    number: int

    @property
    def end(self) -> float:
        """When the last one ends [s]."""
        return self.begin + self.h * self.number

    def parts(self, most: int) -> Iterable[Steps]:
        """Yield them, at most so many at once."""
        for first in range(0, self.number, most):
            count = min(most, self.number - first)
            yield Steps(self.begin + self.h * first, self.h, count)


def steps_between(time: Real, breaks: Iterable[float], h: float) -> list[Steps]:
    """Return steps of at most h from the first time to the last, with breaks at ends of steps."""
    # where times are even, steps are so many of their intervals or parts of one: then few places
    # within steps are looked at
    if is_uniform(time):
        dt = float(time[-1] - time[0]) / (len(time) - 1)
        h = dt * math.floor(h / dt * (1 + SNAP)) if h >= dt else dt / math.ceil(dt / h)
    inside = [at for at in breaks if time[0] < at < time[-1]]
    edges = np.unique([float(time[0]), *inside, float(time[-1])])
    near = SNAP * h
    found: list[Steps] = []
    for begin, end in zip(edges[:-1].tolist(), edges[1:].tolist()):
        count = math.floor((end - begin) / h * (1 + SNAP))
        left = end - begin - count * h
        if count:
            found.append(Steps(begin, h, count))
        if left > near or not count:
            found.append(Steps(end - left, left, 1))
    return found
