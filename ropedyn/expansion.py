"""A transfer function as a sum over modes."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Real = NDArray[np.float64]


class Expansion(NamedTuple):
    """What responses are to drives, in the rate s of a motion e^(s t).

        H(s) = rest + sum_k (a_k + b_k s)/(s^2 + 2 sigma_k s + square_k) + sum_j r_j/(s - p_j)

    Pairs are conjugate rates -sigma +- i sqrt(square - sigma^2), rigid motion (sigma = square = 0),
    modes that decay without oscillation by two rates, or grow (square < 0); p_j are real rates
    alone.
    """

    sigma: Real
    """(k,) [1/s]."""
    square: Real
    """(k,) [rad^2/s^2]."""
    a: Real
    """(drives, responses, k)."""
    b: Real
    """(drives, responses, k); 0 where damping is proportional."""
    p: Real
    """(j,) [1/s]."""
    r: Real
    """(drives, responses, j)."""
    rest: Real
    """(drives, responses) of what is left out: it follows at once."""
    bound: Real
    """(drives, responses) |H_out(0)| of the modes that are left out, at most; 0 where none is."""
    beyond: float
    """Angular frequency of the lowest that is left out [rad/s], infinite where none is."""
