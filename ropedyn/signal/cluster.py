"""Groups of what lies near each other."""

from __future__ import annotations

import numpy as np

from ..base.array import Flags, Index


def clusters(near: Flags) -> list[Index]:
    """Gather what is near, or near to what is near, and so on."""
    from scipy.sparse.csgraph import connected_components

    count, label = connected_components(near, directed=False)
    return [np.flatnonzero(label == k) for k in range(count)]
