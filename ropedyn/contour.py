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
from numpy.typing import NDArray

Real = NDArray[np.float64]
Complex = NDArray[np.complex128]
Index = NDArray[np.intp]
Function = Callable[[Complex], Complex]
"""Takes points, shape (n,), and returns values, shape (..., n)."""

ALONE, TOGETHER = 8, 32
"""Points of a circle around one pole, and around several."""

RADIUS = 1 / 50
"""Of a circle over the distance to the next pole: 50^-8 of that is seen."""

ALIKE = 1e-5
"""Poles that differ by this share are in one circle."""

MOST = 1 << 21
"""Numbers at a time."""


class Circle(NamedTuple):
    """Around poles with no others in it."""

    center: complex
    radius: float
    members: Index
    """Which poles."""


def on_a_line(pole: Real, error: Real, beyond: float) -> list[Circle]:
    """Draw circles around real poles, in order, the next of which is beyond."""
    limit = ALIKE * np.maximum(np.abs(pole[1:]), np.abs(pole[:-1])) + 4 * (error[1:] + error[:-1])
    groups = np.split(np.arange(len(pole)), np.flatnonzero(np.diff(pole) > limit) + 1)
    if len(pole) == 0:
        return []
    first, last = (np.array([pole[group[k]] for group in groups]) for k in (0, -1))
    left = first - np.append(-np.inf, last[:-1])
    right = np.append(first[1:], beyond) - last
    return [_circle(pole, *one) for one in zip(groups, np.minimum(left, right).tolist())]


def in_the_plane(pole: Complex, error: Real, beyond: float) -> list[Circle]:
    """Draw circles around poles, all there are but for those beyond a modulus."""
    size = np.abs(pole)
    near = np.abs(pole[:, None] - pole) <= ALIKE * np.maximum.outer(size, size) + 4 * np.add.outer(
        error, error
    )
    left, circles = set(range(len(pole))), []
    while left:
        own = {min(left)}
        while (more := set(np.flatnonzero(near[sorted(own)].any(axis=0)).tolist())) != own:
            own = more
        left -= own
        members = np.array(sorted(own))
        rest = np.delete(pole, members)
        center = pole[members].mean()
        room = float(np.abs(rest - center).min(initial=beyond - abs(center)))
        circles.append(_circle(pole, members, room))
    return circles


def _circle(pole: Complex | Real, members: Index, room: float) -> Circle:
    center = complex(pole[members].mean())
    spread = float(np.abs(pole[members] - center).max())
    size = abs(center) if center != 0 else 1.0
    room = min(room, size) if center != 0 or not np.isfinite(room) else room
    radius = max(RADIUS * room, np.sqrt(spread * room)) if len(members) > 1 else RADIUS * room
    return Circle(center, float(radius), members)


def moments(function: Function, circles: list[Circle], count: int) -> list[Complex]:
    """Return the sums of r_k ((p_k - c)/rho)^j in each circle, j < count.

    Parameters
    ----------
    function : callable
        Conjugate at conjugate points.
    circles : list of Circle
        Of real center together, and others.
    count : int
        How many.

    Returns
    -------
    list of ndarray, shape (count, ...)
    """
    every: list[Complex] = []
    points = ALONE if all(len(circle.members) == 1 for circle in circles) else TOGETHER
    is_real = all(circle.center.imag == 0 for circle in circles)
    half = points // 2 if is_real else points
    t = np.exp(2j * np.pi * (np.arange(half) + 0.5) / points)
    step, at = 1, 0
    while at < len(circles):
        part = circles[at : at + step]
        radius = np.array([circle.radius for circle in part])[:, None]
        z = np.array([circle.center for circle in part])[:, None] + radius * t
        value = function(z.ravel())
        value = value.reshape(*value.shape[:-1], *z.shape)
        power = t[:, None] ** np.arange(1, count + 1)
        mean = radius * (value @ power) / half  # (..., circles, count)
        mean = np.moveaxis(mean, (-2, -1), (0, 1))
        every.extend(mean.real.astype(np.complex128) if is_real else mean)
        at += step
        step = max(1, MOST // max(value.size // len(part), 1))
    return every


def residues(function: Function, pole: Complex | Real, circles: list[Circle]) -> Complex:
    """Return residues whose sum is right, shape (..., poles); poles in no circle have none."""
    alone = [circle for circle in circles if len(circle.members) == 1]
    parts: list[tuple[Circle, Complex]] = []
    for some in _alike(alone):
        parts += zip(some, moments(function, some, 1))
    for circle in circles:
        if len(circle.members) > 1:
            parts.append((circle, moments(function, [circle], len(circle.members))[0]))
    assert parts
    result = np.zeros((*parts[0][1].shape[1:], len(pole)), dtype=np.complex128)
    for circle, moment in parts:
        result[..., circle.members] = _split(pole, circle, moment)
    return result


def _alike(circles: list[Circle]) -> list[list[Circle]]:
    """Part those of real center from the others."""
    real = [circle for circle in circles if circle.center.imag == 0]
    other = [circle for circle in circles if circle.center.imag != 0]
    return [some for some in (real, other) if some]


def _split(pole: Complex | Real, circle: Circle, moment: Complex) -> Complex:
    """Return the residues of least size that have these moments, shape (..., members)."""
    if len(circle.members) == 1:
        return np.moveaxis(moment, 0, -1)
    place = (pole[circle.members] - circle.center) / circle.radius
    powers = place ** np.arange(len(place))[:, None]
    flat = moment.reshape(len(moment), -1)
    own = np.linalg.lstsq(powers, flat, rcond=1e-13)[0]
    return np.moveaxis(own.reshape(moment.shape), 0, -1)
