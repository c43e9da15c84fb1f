"""Which calculated frequency each measured one is, if any."""

from __future__ import annotations

import math

import numpy as np

from ...base.array import Integer, Real

# Calculated frequencies nearer than this part of their mean distance are close to each other.
CLOSE = 0.1
ALONE = math.log(2.0)  # A frequency without neighbour is spaced like the first two of a string.
SPREAD = 3.0  # A measured frequency may be off by so many standard uncertainties.


def reach(calculated: Real) -> Real:
    """Return how far away a partner may be: half the distance to a neighbour, in logarithms.

    Of two neighbours the farther one counts; modes close to each other are one.
    """
    log = np.log(calculated)
    mean = (log[-1] - log[0] + ALONE) / len(log)
    place = np.append(0, np.cumsum(np.diff(log) > CLOSE * mean))
    gap = np.diff(np.bincount(place, log) / np.bincount(place))
    if len(gap) == 0:
        return np.full(len(log), ALONE / 2)
    wider = np.maximum(np.append(gap[0], gap), np.append(gap, gap[-1]))
    return np.asarray(wider[place] / 2)


def paired(
    measured: Real, calculated: Real, *, std: Real | None = None, within: float | None = None
) -> Integer:
    """Return which calculated frequency each measured one is, from 1; 0 of what is none.

    The sum of d^2, d = log(measured/calculated), and of the squared reach of what is left out is
    smallest. As d^2 is convex, no two pairs cross.
    """
    from scipy.optimize import linear_sum_assignment

    order = np.zeros(len(measured), dtype=np.int64)
    if len(measured) == 0 or len(calculated) == 0:
        return order
    distance = np.abs(np.log(np.divide.outer(measured, calculated)))
    price = reach(calculated) ** 2 + np.zeros_like(distance)
    if within is not None:
        spread = np.zeros(len(measured)) if std is None else SPREAD * np.nan_to_num(std) / measured
        price = np.minimum(price, (math.log1p(within) + spread[:, None]) ** 2)
    saved = np.maximum(price - distance**2, 0.0)
    row, column = linear_sum_assignment(saved, maximize=True)
    close = saved[row, column] > 0
    order[row[close]] = column[close] + 1
    return order
