"""The force at the left end of an element, from what its right end and its motion say."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.array import Complex, Flags, Real
from ..base.unit import FORCE
from .chain import CHANNELS, KINDS, PLANE, Chain
from .port import Point, is_force, locate

BENDING = CHANNELS["beta"]


class LeftEnd(NamedTuple):
    """f_a = E f_b - Q u_a + P u_b, each (.., width, width).

    That is F^T f_b - Q u_a, except in a strut, whose triple has a pole where the chain has none.
    There the moment is the one that bends the element by what its ends turn, whatever the string
    beside it does, and its other forces are those on the right end:

        M_a = 2/(S_bb l) (beta_b - beta_a) - M_b - 2 sum of S_cb/S_bb f_c
    """

    E: NDArray[Any]
    Q: NDArray[Any]
    P: NDArray[Any]


def at_start(x: Real, point: Point) -> bool:
    """Whether an internal force is asked for at the left end, where no element ends."""
    return is_force(point) and locate(x, point[1])[0] == 0


def tellers(coordinates: Sequence[str], x: Real) -> list[Point]:
    """Return what the force at the left end follows from: motion of nodes 0 and 1, force at 1."""
    motion = [(c, float(at)) for at in x[:2] for c in coordinates]
    return motion + [(FORCE[c], float(x[1])) for c in coordinates]


def left_ends(chain: Chain) -> LeftEnd:
    """Return that of each distinct element, at rest."""
    strut = _is_strut(chain)
    if chain.rise is None:
        # the triple of a strut is not used, and may not exist
        F, _, Q = _core.triples(chain._replace(tension=np.where(strut, 0.0, chain.tension)))
    else:
        still = np.array([[1.0], [1.0], [1.0], [0.0], [0.0]], dtype=np.complex128)
        each = [_core.triple(chain, e, still) for e in range(len(chain.length))]
        F, Q = (np.array([one[k][0].real for one in each]) for k in (0, 2))
    E, P = np.ascontiguousarray(F.transpose(0, 2, 1)), np.zeros_like(Q)
    for e in np.flatnonzero(strut):
        E[e], Q[e] = _strut(chain, int(e))
        P[e] = Q[e]
    return LeftEnd(E, Q, P)


def first_left_end(chain: Chain, factor: Complex) -> LeftEnd:
    """Return that of the first element at the factors (5, f)."""
    e = int(chain.element[0])
    if _is_strut(chain)[e]:
        E, bent = _strut(chain, e)
        Q = factor[0, :, None, None] * bent
        return LeftEnd(np.broadcast_to(E, Q.shape), Q, Q)
    F, _, Q = _core.triple(chain, e, np.ascontiguousarray(factor))
    return LeftEnd(F.transpose(0, 2, 1), Q, np.zeros_like(Q))


def _is_strut(chain: Chain) -> Flags:
    """Whether each distinct element is one: see csrc/sweep/kernel/kernel.h, sweep_is_strut."""
    if chain.kind != KINDS.index("rigid") or PLANE.index("beta") not in chain.coordinate:
        return np.zeros(len(chain.length), dtype=np.bool_)
    return -chain.tension * chain.flexibility[:, BENDING, BENDING] * chain.length**2 > 1


def _strut(chain: Chain, e: int) -> tuple[Real, Real]:
    """Return E and Q = P of a strut."""
    channel = [CHANNELS[PLANE[c]] for c in chain.coordinate]
    S = chain.flexibility[e]
    E, Q = np.eye(len(channel)), np.zeros((len(channel),) * 2)
    E[-1] = [-2 * S[c, BENDING] / S[BENDING, BENDING] if c != BENDING else 0.0 for c in channel]
    E[-1, -1] = -1.0
    Q[-1, -1] = 2 / (S[BENDING, BENDING] * chain.length[e])
    return E, Q
