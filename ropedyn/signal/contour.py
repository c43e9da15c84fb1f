"""Residues of a function at its poles, from its values on circles around them.

On a circle of radius rho about c with no other poles in it, t = (z - c)/rho,

    rho (mean of f(z) t^(j+1)) = sum over the poles inside of r_k ((p_k - c)/rho)^j,

to the power SAMPLES of the ratio of rho to the distance of the next pole. Poles that lie close
together are in one circle: each residue of them is known the worse the closer they are, but what
they are together is not.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from ..base.array import Complex, Flags, Index, Real

Function = Callable[[Complex], Complex]
"""Takes points, shape (n,), and returns values, shape (..., n)."""
ALONE, TOGETHER = 8, 32
"""Points of a circle around one pole, and around several or one that has little room."""
RADIUS = 1 / 50  # Radius of a circle over the distance to the next pole: 50^-8 of that is seen,
NARROW, WIDE = 0.05, 1 / 4  # or so much where that is less than this part of the pole: 4^-32.
ALIKE, APART = 1e-3, 8.0
"""Poles that differ by this share are in one circle, if others are so many times further away."""
ROUNDED = 64 * np.finfo(float).eps  # A function near a pole is known to this of the pole.
MOST = 1 << 21  # So many numbers are computed at a time.


class Circles(NamedTuple):
    """Around poles, with no others in them."""

    center: Real  # (n,)
    radius: Real  # (n,)
    points: Index  # (n,)
    members: list[Index]  # which poles, n arrays

    @property
    def rounding(self) -> Real:
        """What rounding does to residues of poles with little room, relative, shape (poles,)."""
        narrow = self.points == TOGETHER
        share = np.divide(np.abs(self.center), self.radius, out=0 * self.radius, where=narrow)
        return np.repeat(ROUNDED * share, self.size)

    def some(self, which: Index) -> Circles:
        """Return some of them."""
        members = [self.members[k] for k in which]
        return Circles(self.center[which], self.radius[which], self.points[which], members)

    @property
    def size(self) -> Index:
        """How many poles each has in it, shape (n,)."""
        return np.array([len(one) for one in self.members], dtype=np.intp)


def on_a_line(pole: Real, error: Real, beyond: float) -> Circles:
    """Draw circles around real poles, in order, the next of which is beyond."""
    gap = np.concatenate([[np.inf], np.diff(pole), [beyond - pole[-1:].sum()]])[: len(pole) + 1]
    size = np.maximum(np.abs(pole[1:]), np.abs(pole[:-1]))
    one = gap[1:-1] <= 4 * (error[1:] + error[:-1])  # not told apart
    found: list[tuple[int, int]] = []
    far = np.flatnonzero(~one & (gap[1:-1] > ALIKE * size)) + 1
    left = list(zip([0, *far.tolist()], [*far.tolist(), len(pole)])) if len(pole) else []
    while left:
        i, j = left.pop()
        inside = np.where(one[i : j - 1], 0.0, gap[i + 1 : j])
        if inside.any() and APART * (pole[j - 1] - pole[i]) > min(gap[i], gap[j]):
            k = i + 1 + int(inside.argmax())
            left += [(i, k), (k, j)]
        else:
            found.append((i, j))
    found.sort()
    room = np.array([min(gap[i], gap[j]) for i, j in found])
    return _circles(pole, [np.arange(i, j) for i, j in found], room)


def _circles(pole: Real, members: list[Index], room: Real) -> Circles:
    """Draw circles around poles that have so much room."""
    first = np.array([one[0] for one in members], dtype=np.intp)
    center, spread = pole[first].copy(), np.zeros(len(members))
    several = [k for k, one in enumerate(members) if len(one) > 1]
    for k in several:
        center[k] = pole[members[k]].mean()
        spread[k] = np.abs(pole[members[k]] - center[k]).max()
    size = np.abs(center)
    room = np.where(size > 0, np.minimum(room, size), np.where(np.isfinite(room), room, 1.0))
    narrow = room <= NARROW * size
    radius = np.where(narrow, WIDE, RADIUS) * room
    radius[several] = np.maximum(RADIUS * room, np.sqrt(spread * room))[several]
    narrow[several] = True
    return Circles(center, radius, np.where(narrow, TOGETHER, ALONE), members)


def moments(function: Function, circles: Circles, count: int, points: int) -> Real:
    """Return the sums of r_k ((p_k - c)/rho)^j in each circle, j < count."""
    half = points // 2  # the other half is conjugate
    t = np.exp(2j * np.pi * (np.arange(half) + 0.5) / points)
    power = t[:, None] ** np.arange(1, count + 1) / half
    every: list[Complex] = []
    step, at = 1, 0
    while at < len(circles.center):
        center, radius = (one[at : at + step, None] for one in circles[:2])
        z = center + radius * t
        value = function(z.ravel())
        mean = radius * (value.reshape(*value.shape[:-1], *z.shape) @ power)
        every.append(np.moveaxis(mean, (-2, -1), (0, 1)))
        at += step
        step = max(1, MOST * len(z) // max(value.size, 1))
    return np.concatenate(every).real


def residues(function: Function, pole: Real, circles: Circles) -> Real:
    """Return residues whose sum is right, shape (..., poles); poles in no circle have none."""
    count = circles.size
    parts: list[tuple[Index, Real]] = []
    for points in (ALONE, TOGETHER):
        some = circles.some(np.flatnonzero((count == 1) & (circles.points == points)))
        if some.members:
            own = moments(function, some, 1, points)[:, 0]
            parts.append((np.concatenate(some.members), np.moveaxis(own, 0, -1)))
    for several in np.unique(count[count > 1]).tolist():
        some = circles.some(np.flatnonzero(count == several))
        for k, moment in enumerate(moments(function, some, several, TOGETHER)):
            one = some.some(np.array([k]))
            parts.append((one.members[0], _split(pole, one, moment)))
    assert parts
    result = np.zeros((*parts[0][1].shape[:-1], len(pole)))
    for members, own in parts:
        result[..., members] = own
    return result


def _split(pole: Real, circle: Circles, moment: Real) -> Real:
    """Return the residues of least size that have these moments, shape (..., members)."""
    place = (pole[circle.members[0]] - circle.center[0]) / circle.radius[0]
    powers = place ** np.arange(len(place))[:, None]
    own = np.linalg.lstsq(powers, moment.reshape(len(moment), -1), rcond=1e-13)[0]
    return np.moveaxis(own.reshape(moment.shape), 0, -1)


def clusters(near: Flags) -> list[Index]:
    """Gather what is near, or near to what is near, and so on."""
    from scipy.sparse.csgraph import connected_components

    count, label = connected_components(near, directed=False)
    return [np.flatnonzero(label == k) for k in range(count)]
