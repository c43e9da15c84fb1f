"""Residues of a function at its poles, from its values on circles around them.

On a circle of radius rho about c with no other poles in it, t = (z - c)/rho, rho times the mean of
f(z) t is the sum of the residues inside. Of a residue at a distance d outside n points see the
share x/(1 + x), x = (rho/d)^n: little, but it may be many times larger, so that this is taken off.

Poles that lie close together are in one circle, and in that are circles of their own, around such
as lie closer still and around one. Each residue is known the worse the closer the next pole is; the
sum of all is that of the outer circle, so that only which pole has what depends on it, by as much
as the poles are one.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
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
CLOSER = 16.0  # Poles in one circle that lie closer than this part of their width have their own.
TOLD = 384.0  # Poles that differ by so many times their errors are one: between, f has no digits.
MOST = 1 << 21  # So many numbers are computed at a time.


class Circles(NamedTuple):
    """Around poles, with no others in them; those inside of others come after these."""

    center: Real  # (n,)
    radius: Real  # (n,)
    points: Index  # (n,)
    members: list[Index]  # which poles, n arrays
    parent: Index  # (n,) which circle each is inside of, or -1

    @property
    def rounding(self) -> Real:
        """What rounding does to residues of poles with little room, relative, shape (poles,)."""
        outer = self.outer
        narrow = outer.points == TOGETHER
        share = np.divide(np.abs(outer.center), outer.radius, out=0 * outer.radius, where=narrow)
        return np.repeat(ROUNDED * share, outer.size)

    @property
    def outer(self) -> Circles:
        """Those that are in no other."""
        return self.some(np.flatnonzero(self.parent < 0))

    @property
    def size(self) -> Index:
        """How many poles each has in it, shape (n,)."""
        return np.array([len(one) for one in self.members], dtype=np.intp)

    @property
    def innermost(self) -> Index:
        """Which have no others in them: their poles are one."""
        return np.setdiff1d(np.arange(len(self.members)), self.parent)

    def some(self, which: Index) -> Circles:
        """Return some of them."""
        arrays = self.center[which], self.radius[which], self.points[which]
        return Circles(*arrays, [self.members[k] for k in which], self.parent[which])


def on_a_line(pole: Real, error: Real, beyond: float) -> Circles:
    """Draw circles around real poles, in order, the next of which is beyond."""
    gap = np.concatenate([[np.inf], np.diff(pole), [beyond - pole[-1:].sum()]])[: len(pole) + 1]
    size = np.maximum(np.abs(pole[1:]), np.abs(pole[:-1]))
    one = gap[1:-1] <= TOLD * (error[1:] + error[:-1])  # not told apart
    inside = np.concatenate([[np.inf], np.where(one, 0.0, gap[1:-1]), [np.inf]])[: len(gap)]
    found = _apart(gap, inside, (0, len(pole)), ALIKE * size) if len(pole) else []
    parent = [-1] * len(found)
    for k, (i, j) in enumerate(found):  # which grows
        if inside[i + 1 : j].any():
            limit = min((pole[j - 1] - pole[i]) / CLOSER, inside[i + 1 : j].max() / 2)
            within = _apart(gap, inside, (i, j), np.full(j - i - 1, limit))
            found += within
            parent += [k] * len(within)
    room = np.array([min(gap[i], gap[j]) for i, j in found])
    return _circles(pole, [np.arange(i, j) for i, j in found], room, parent)


def _apart(gap: Real, inside: Real, some: tuple[int, int], limit: Real) -> list[tuple[int, int]]:
    """Part poles from i to j where gaps are beyond a limit, and where they do not stand apart."""
    i, j = some
    cuts = [i, *(np.flatnonzero(inside[i + 1 : j] > limit) + i + 1).tolist(), j]
    left, found = list(pairwise(cuts)), []
    while left:
        i, j = left.pop()
        within = inside[i + 1 : j]
        if within.any() and APART * gap[i + 1 : j].sum() > min(gap[i], gap[j]):
            k = i + 1 + int(within.argmax())
            left += [(i, k), (k, j)]
        else:
            found.append((i, j))
    return sorted(found)


def _circles(pole: Real, members: list[Index], room: Real, parent: list[int]) -> Circles:
    """Draw circles around poles that have so much room."""
    several = np.array([len(one) > 1 for one in members], dtype=np.bool_)
    center, spread = pole[[one[0] for one in members]], np.zeros(len(members))
    for k in np.flatnonzero(several).tolist():
        center[k] = pole[members[k]].mean()
        spread[k] = np.abs(pole[members[k]] - center[k]).max()
    size = np.abs(center)
    room = np.where(size > 0, np.minimum(room, size), np.where(np.isfinite(room), room, 1.0))
    narrow = several | (room <= NARROW * size)
    radius = np.where(narrow, WIDE, RADIUS) * room
    radius[several] = np.maximum(radius, np.sqrt(spread * room))[several]
    points = np.where(narrow, TOGETHER, ALONE)
    return Circles(center, radius, points, members, np.array(parent, dtype=np.intp))


def residues(function: Function, pole: Real, circles: Circles) -> Real:
    """Return residues whose sum is right, shape (..., poles); poles in no circle have none."""
    each = [np.flatnonzero(circles.points == points) for points in (ALONE, TOGETHER)]
    found = [_within(function, circles.some(which)) for which in each if len(which)]
    value = np.concatenate(found)[np.argsort(np.concatenate(each))]
    first = _told(len(pole), circles, value)
    return _told(len(pole), circles, value - _seen_too(pole, circles, first))


def _within(function: Function, circles: Circles) -> Real:
    """Return the sums of residues in circles of as many points, shape (circles, ...)."""
    points = int(circles.points[0])
    half = points // 2  # the other half is conjugate
    t = np.exp(2j * np.pi * (np.arange(half) + 0.5) / points)
    every: list[Real] = []
    step, at = 1, 0
    while at < len(circles.center):
        center, radius = (one[at : at + step, None] for one in circles[:2])
        z = center + radius * t
        value = function(z.ravel())
        mean = radius[:, 0] * (value.reshape(*value.shape[:-1], *z.shape) @ (t / half))
        every.append(np.moveaxis(mean.real, -1, 0))
        at += step
        step = max(1, MOST * len(z) // max(value.size, 1))
    return np.concatenate(every)


def _told(poles: int, circles: Circles, value: Real) -> Real:
    """Return the residues that sums in circles tell, shape (..., poles)."""
    value = value.copy()
    for k in np.unique(circles.parent[circles.parent >= 0]).tolist():
        # what inner sums miss of the outer one is what rounding did to them
        inner = np.flatnonzero(circles.parent == k)
        share = (1 / circles.radius[inner]) / (1 / circles.radius[inner]).sum()
        value[inner] += np.multiply.outer(share, value[k] - value[inner].sum(axis=0))
    result, size = np.zeros((*value.shape[1:], poles)), circles.size
    innermost = circles.innermost
    members = np.concatenate(circles.some(innermost).members)
    each = np.repeat(innermost, size[innermost])
    result[..., members] = np.moveaxis(value[each], 0, -1) / size[each]
    return result


def _seen_too(pole: Real, circles: Circles, residue: Real) -> Real:
    """Return what residues at poles outside add to the sums in circles."""
    away = pole - circles.center[:, None]
    away[np.repeat(np.arange(len(away)), circles.size), np.concatenate(circles.members)] = np.inf
    share = np.square(np.square(np.square(circles.radius[:, None] / away)))  # of ALONE points
    many = circles.points == TOGETHER
    share[many] **= TOGETHER // ALONE
    return np.tensordot(share / (1 + share), residue, (1, residue.ndim - 1))


def clusters(near: Flags) -> list[Index]:
    """Gather what is near, or near to what is near, and so on."""
    from scipy.sparse.csgraph import connected_components

    count, label = connected_components(near, directed=False)
    return [np.flatnonzero(label == k) for k in range(count)]
