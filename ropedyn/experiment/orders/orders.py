"""Which mode each peak is where somebody says it, or where the lowest are meant."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ...base import check
from ...base.array import Index
from ...base.errors import SceneError
from ...curves.peaks import Peaks


def given_orders(orders: Any, peaks: Peaks) -> Index | None:
    """Return the modes of the peaks where somebody says them, from 1, 0 where they are none."""
    k = np.size(peaks.frequency)
    what = f'"auto", None or {k} whole numbers, one for each peak, those from 1 different'
    if orders is None:
        return None
    if isinstance(orders, str):
        check.one_of(orders, "orders", ("auto",))
        return None if peaks.order is None else np.array(peaks.order, dtype=np.intp)
    check.instance(orders, "orders", (Sequence, np.ndarray), what)
    most = np.iinfo(np.int32).max
    each = [check.count(n, f"orders[{i}]", least=0, most=most) for i, n in enumerate(orders)]
    modes = [n for n in each if n > 0]
    if len(each) != k or len(set(modes)) < len(modes) or not modes:
        raise SceneError(f"orders must be {what}, got {check.shown(orders)}")
    return np.array(each, dtype=np.intp)
