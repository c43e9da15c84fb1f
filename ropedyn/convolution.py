"""Motion of a sum over modes that forces cause, without steps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .expansion import Expansion
from .force import Force

Real = NDArray[np.float64]


def convolve(expansion: Expansion, drive: int, force: Force, time: Real, order: int) -> Real:
    """Return what one force moves, from rest at the first time, shape (responses, t).

    What the force did before the first time is not felt.

    Parameters
    ----------
    expansion : Expansion
        Of the responses.
    drive : int
        Which of its drives the force acts on.
    force : Force
        Of absolute time.
    time : ndarray, shape (t,)
        [s], increasing.
    order : {0, 1, 2}
        How often the responses are differentiated.

    Raises
    ------
    SolveError
        If a growing mode leaves the numbers.
    """
    raise NotImplementedError


def release(expansion: Expansion, drive: int, load: float, time: Real, order: int) -> Real:
    """Return the motion after a static load is let go at the first time, shape (responses, t).

    Raises
    ------
    SceneError
        If a mode is rigid or grows: it has no rest under a load.
    """
    raise NotImplementedError


def left_out(force: Force, time: Real, bound: Real, beyond: float, order: int = 0) -> Real:
    """Bound what modes above an angular frequency add to their static response, as `bound`.

    Parameters
    ----------
    force : Force
        Of absolute time.
    time : ndarray, shape (t,)
        [s]; the motion begins at rest at the first.
    bound : ndarray
        Of their static response to 1 N, each mode by its magnitude.
    beyond : float
        Lowest angular frequency of them [rad/s].
    order : {0, 1, 2}
        How often the response is differentiated.
    """
    raise NotImplementedError
