"""How many roots a circle surrounds, by the argument principle."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...base.array import Complex, Real
from ...chain.chain import Chain
from .characteristic import Characteristic

FIRST = 16  # A half circle begins with so many arcs at least.
MOST_HALVINGS = 40
MOST_ARCS = 10_000  # More arcs at a time are those that rounding makes.
LARGEST = 0.8  # A change of the logarithm along half an arc is believed below this.
CLEAR = 1e3  # A value so many times its rounding has a known argument.


@dataclass(frozen=True)
class Winding:
    """What a walk around the circle |s| = radius tells."""

    radius: float  # [rad/s]
    count: int  # roots inside
    point: Complex  # (arcs, 2) ends of arcs, of a half circle where the roots come in pairs
    change: Complex  # (arcs,) of the function's logarithm along each
    paired: bool  # whether the roots come in conjugate pairs

    def moments(self, known: Complex, number: int) -> Complex:
        """Return sums of powers 1 .. number of root/radius over unknown roots, to some per cent."""
        # with the factors s - s_j of the known ones taken out little is left that changes along an
        # arc: 2 pi i sum s^k is the integral of s^k over the change of the logarithm
        begin, end = self.point[:, :1] - known, self.point[:, 1:] - known
        change = self.change - np.log(end / begin).sum(axis=1)
        powers = np.arange(1, number + 1)
        weight = ((self.point[:, :, None] / self.radius) ** powers).mean(axis=1)
        total = change @ weight
        return np.asarray(total.imag / np.pi + 0j if self.paired else total / (2j * np.pi))


def winding(function: Characteristic, radius: float) -> Winding | None:
    """Count the roots with |s| < radius."""
    # the argument of the function turns 2 pi times the number of roots on the way round. The walk
    # begins with arcs along which waves on the rope turn by a radian or so. Each is halved until
    # its two halves turn as much as the whole does, and the logarithm changes little along both:
    # what turns once more in between would show in one of them
    paired = function.is_paired
    whole = np.pi if paired else 2 * np.pi
    # pieces turn by 1.2 at most, and twice that between s and -s
    arcs = max(FIRST, 2 * len(function.chain.coordinate) * function.steps)
    arcs += turning(function.chain, radius)
    angle = np.linspace(0.0, whole, 1 + (arcs if paired else 2 * arcs))
    value, magnitude = function(radius * np.exp(1j * angle))
    end = np.stack([angle[:-1], angle[1:]])
    v, m = np.stack([value[:-1], value[1:]]), np.stack([magnitude[:-1], magnitude[1:]])
    points: list[Real] = []
    changes: list[Complex] = []
    for _ in range(MOST_HALVINGS):
        middle = end.mean(axis=0)
        value, magnitude = function(radius * np.exp(1j * middle))
        if not min(np.abs(value).min(), np.abs(v).min()) > CLEAR * function.rounding:
            return None
        first = _change(v[0], m[0], value, magnitude)
        second = _change(value, magnitude, v[1], m[1])
        over = _change(v[0], m[0], v[1], m[1])
        known = np.maximum(np.abs(first), np.abs(second)) < LARGEST
        known &= np.abs(first + second - over) < 1.0
        halves = np.stack([end[0], middle, middle, end[1]])
        points.append(halves[:, known].reshape(2, -1, order="F").T)
        changes.append(np.stack([first, second])[:, known].ravel(order="F"))
        rest = ~known
        if not rest.any():
            break
        if rest.sum() > MOST_ARCS:
            return None
        end = halves[:, rest].reshape(2, -1, order="F")
        v = np.stack([v[0], value, value, v[1]])[:, rest].reshape(2, -1, order="F")
        m = np.stack([m[0], magnitude, magnitude, m[1]])[:, rest].reshape(2, -1, order="F")
    else:
        return None
    point: Complex = radius * np.exp(1j * np.concatenate(points))
    change: Complex = np.concatenate(changes)
    count = float(change.sum().imag) / whole
    if abs(count - round(count)) > 1e-3:
        return None
    return Winding(radius, round(count), point, change, paired)


def turning(chain: Chain, radius: float) -> int:
    """Return how many radians structures alone turn the function by on a half circle, and more."""
    # as many times pi as they have modes there with their feet held: a resonator one, a broken wire
    # x/pi where x^4 = m radius^2/k (csrc/chain/attached.h)
    if chain.attached_value is None:
        return 0
    mass, spring = chain.attached_value[:, :2].T
    return int(np.ceil(2 * math.pi * (1 + (radius**2 * mass / spring) ** 0.25 / math.pi)).sum())


def _change(value: Complex, magnitude: Real, later: Complex, greater: Real) -> Complex:
    """Return the change of the logarithm, its imaginary part within -pi .. pi."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.log(later / value) + (greater - magnitude))
