"""What a method of linear motion answers."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..base.array import Real


class Moved(NamedTuple):
    """Motion with an error that covers it."""

    value: Real  # (responses, t)
    error: Real  # absolute, as value
    method: str  # "modal" or "line"
    modes: int = 0  # that were summed
    lines: int = 0  # rates that were looked at

    def shares(self, kinds: list[str] | None = None) -> Real:
        """Return the largest error of each response over its largest value, (responses,).

        With `kinds`, over that of all responses of its kind.
        """
        size = np.abs(self.value).max(axis=1)
        if kinds is not None:
            same = np.array(kinds)[:, None] == np.array(kinds)
            size = np.where(same, size, 0.0).max(axis=1)
        error = self.error.max(axis=1)
        none = np.where(error > 0, np.inf, 0.0)
        return np.divide(error, size, out=none, where=size > 0)
