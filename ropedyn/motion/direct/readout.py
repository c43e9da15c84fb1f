"""What is watched while a chain marches."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ... import _core
from ...base.array import Index, Real
from ...base.errors import SceneError
from ...chain.chain import Chain
from ...chain.port import Point, Ports, moving, ports
from ...chain.reaction import at_start, tellers
from .beside import Beside


@dataclass(frozen=True, eq=False)
class Readout:
    """Responses as numbers that the core reads."""

    # that the core reads: responses, and what an internal force at the left end follows from
    ports: Ports
    direct: Index  # responses that are read as they are
    left: LeftForce | None  # what tells the others

    def values(self, read: Real, time: Real, order: int) -> Real:
        """Return the responses, shape (times, responses), of what the core read at these times."""
        if self.left is None:
            return np.asarray(read[:, order])
        count = len(self.direct)
        value = np.zeros((len(read), count + len(self.left.channel)))
        value[:, self.direct] = read[:, order, :count]
        others = np.setdiff1d(np.arange(value.shape[1]), self.direct)
        value[:, others] = self.left.values(read[..., count:], time)
        return value


@dataclass(frozen=True, eq=False)
class LeftForce:
    """Internal forces at the left end: f_a = F^T (f_b - s) + s - Q (u_a + rate v_a)."""

    # s is the force of the string beside the first element

    channel: list[int]  # Which of them are asked for
    F: Real  # (width, width)
    Q: Real
    rate: float  # [s]
    string: float  # [N/m]
    drag: float  # [N s/m]
    extra: Callable[[Real], Real]  # [N/m] at times
    z: int | None

    def values(self, read: Real, time: Real) -> Real:
        """Return them at some times from motion of nodes 0 and 1, and force on node 1."""
        width = len(self.F)
        u, v = read[:, 0, :width], read[:, 1, :width]
        beside = np.zeros_like(u)
        if self.z is not None:
            opens = np.diff(read[:, :, [self.z, width + self.z]], axis=2)[..., 0]
            stiffness = self.string + self.extra(time)
            beside[:, self.z] = stiffness * opens[:, 0] + self.drag * opens[:, 1]
        force = (read[:, 0, 2 * width :] - beside) @ self.F + beside
        force -= (u + self.rate * v) @ self.Q
        return np.asarray(force[:, self.channel])


def readout(
    chain: Chain,
    x: Real,
    coordinates: Sequence[str],
    points: list[Point],
    *,
    beside: Beside,
    pulsation: Callable[[Real], Real] | None,
) -> Readout:
    """Return what the core reads for responses on these coordinates."""
    hidden = [at_start(x, p) for p in points]
    direct = [p for p, left in zip(points, hidden) if not left]
    number = np.flatnonzero(~np.array(hidden, dtype=np.bool_))
    if len(direct) == len(points):
        return Readout(ports(chain, x, coordinates, points), number, None)
    channel = [coordinates.index(moving(p)) for p, left in zip(points, hidden) if left]
    if beside.stretching and "beta" in coordinates and coordinates.index("beta") in channel:
        raise SceneError(
            "response must not be M_beta at the left end where the tension is stretching"
        )
    e = int(chain.element[0])
    F, _, Q = (array[e] for array in _core.triples(chain.at_rest))
    length = float(chain.length[e])

    def extra(time: Real) -> Real:
        return np.zeros(len(time)) if pulsation is None else pulsation(time) / length

    string, drag = (float(one[e]) / length for one in (beside.string, beside.string_drag))
    z = coordinates.index("z") if "z" in coordinates else None
    left = LeftForce(channel, F, Q, float(beside.rate[e]), string, drag, extra, z)
    read = ports(chain, x, coordinates, direct + tellers(coordinates, x))
    return Readout(read, number, left)
