"""Geometry of catalogue strands and ropes: circles that touch, and what tables say of ropes."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import numpy as np


class WireRow(NamedTuple):
    """Wires of one radius in a strand, in any unit."""

    n: int
    diameter: float
    radius: float


Layout = tuple[WireRow, ...]


def _apart(r: float, s: float, angle: float) -> float:
    """Return the distance of two points on circles around one centre."""
    return math.sqrt(r * r + s * s - 2 * r * s * math.cos(angle))


def _touching(equations: Callable[..., tuple[float, ...]], start: tuple[float, ...]) -> list[float]:
    """Return diameters and radii that leave no gap."""
    from scipy.optimize import root

    found = root(lambda x: equations(*x), start, tol=1e-15)
    assert np.abs(found.fun).max() < 1e-14
    numbers: list[float] = found.x.tolist()
    return numbers


def _inner(n: int) -> tuple[WireRow, WireRow]:
    """Return the core and n wires of diameter 1 around it: d0 = 1/sin(pi/n) - 1."""
    d0 = 1 / math.sin(math.pi / n) - 1
    return WireRow(1, d0, 0.0), WireRow(n, 1.0, (d0 + 1) / 2)


def _equal(*counts: int) -> Layout:
    """Return equal wires in layers that touch along a radius."""
    return (WireRow(1, 1.0, 0.0), *(WireRow(n, 1.0, k + 1.0) for k, n in enumerate(counts)))


def _seale(n: int) -> Layout:
    """Return 1-n-n: outer wires touch each other and lie in the valleys.

    2 r2 sin(pi/n) = d2 and |P1 P2| = (d1 + d2)/2 give d2 cos^2 = u + sqrt(u^2 - cos^4),
    u = cos + sin^2.
    """
    s, c = math.sin(math.pi / n), math.cos(math.pi / n)
    u = c + s * s
    d2 = (u + math.sqrt(u * u - c**4)) / c**2
    return (*_inner(n), WireRow(n, d2, d2 / (2 * s)))


def _warrington(n: int) -> Layout:
    """Return 1-n-(n+n): big wires in the valleys, small ones on top, in one outer circle."""
    core, first = _inner(n)
    r1, half = first.radius, math.pi / n

    def equations(big: float, r_big: float, small: float) -> tuple[float, ...]:
        r_small = r1 + (1 + small) / 2
        return (
            _apart(r1, r_big, half) - (1 + big) / 2,
            r_big + big / 2 - r_small - small / 2,
            _apart(r_big, r_small, half) - (big + small) / 2,
        )

    big, r_big, small = _touching(equations, (1.0, 1.7, 0.75))
    return core, first, WireRow(n, big, r_big), WireRow(n, small, r1 + (1 + small) / 2)


def _filler(n: int) -> Layout:
    """Return 1-n-nF-2n: filler wires in the valleys, outer wires beside them."""
    core, first = _inner(n)
    r1, half, quarter = first.radius, math.pi / n, math.pi / (2 * n)

    def equations(d2: float, fill: float, r_fill: float) -> tuple[float, ...]:
        r2 = d2 / 2 / math.sin(quarter)
        return (
            _apart(r1, r2, quarter) - (1 + d2) / 2,
            _apart(r1, r_fill, half) - (1 + fill) / 2,
            _apart(r_fill, r2, quarter) - (fill + d2) / 2,
        )

    d2, fill, r_fill = _touching(equations, (1.0, 0.4, 1.35))
    return core, first, WireRow(n, fill, r_fill), WireRow(2 * n, d2, d2 / 2 / math.sin(quarter))


def _warrington_seale(n: int) -> Layout:
    """Return 1-n-(n+n)-2n: outer wires touch each other, a big and a small one."""
    core, first = _inner(n)
    r1, half, quarter = first.radius, math.pi / n, math.pi / (2 * n)

    def equations(big: float, r_big: float, small: float, d3: float) -> tuple[float, ...]:
        r_small, r3 = r1 + (1 + small) / 2, d3 / 2 / math.sin(quarter)
        return (
            _apart(r1, r_big, half) - (1 + big) / 2,
            _apart(r_big, r_small, half) - (big + small) / 2,
            _apart(r_big, r3, quarter) - (big + d3) / 2,
            _apart(r_small, r3, quarter) - (small + d3) / 2,
        )

    big, r_big, small, d3 = _touching(equations, (1.0, 1.9, 0.77, 1.3))
    r_small, r3 = r1 + (1 + small) / 2, d3 / 2 / math.sin(quarter)
    return core, first, WireRow(n, big, r_big), WireRow(n, small, r_small), WireRow(2 * n, d3, r3)


STRANDS: dict[str, Callable[[], Layout]] = {
    "7": lambda: _equal(6),
    "19": lambda: _equal(6, 12),
    "37": lambda: _equal(6, 12, 18),
    "19S": lambda: _seale(9),
    "19W": lambda: _warrington(6),
    "25F": lambda: _filler(6),
    "36WS": lambda: _warrington_seale(7),
}
"""Strands by their wires; that of a number alone has equal wires."""

NAMES = (
    *("1x7", "1x19", "1x37", "7x7", "7x19"),
    *("6x7", "6x19", "6x19S", "6x19W", "6x25F", "6x36WS", "8x19S", "8x25F"),
)
"""Constructions that have a standard."""

CORES = ("FC", "IWRC", "WSC")

TABLES = {
    ("6x7", "FC"): (0.369, 0.345),
    ("6x19S", "FC"): (0.384, 0.359),
    ("6x19S", "IWRC"): (0.449, 0.400),
    ("6x36WS", "FC"): (0.393, 0.367),
    ("6x36WS", "IWRC"): (0.460, 0.409),
    ("8x19S", "FC"): (0.349, 0.340),
}
"""Area of metal per diameter^2, and mass per length and diameter^2 [kg/m per cm^2]: Feyrer."""


@cache
def rows(name: str) -> Layout:
    """Return the wires of a strand whose outer radius is 1."""
    found = STRANDS[name]()
    size = max(row.radius + row.diameter / 2 for row in found)
    return tuple(WireRow(n, d / size, r / size) for n, d, r in found)


def placed(n: int, diameter: float, lay: float, gap: float) -> tuple[float, float]:
    """Return radius and diameter of strands that leave a gap, in a rope of this diameter.

    R = (1 + gap) d_s sqrt(1 + tan^2(pi/2 - pi/m)/S^2)/2: their sections are ellipses nearly.
    """
    from scipy.optimize import brentq

    steep = math.tan(math.pi / 2 - math.pi / n) ** 2

    def short(R: float) -> float:
        per_S2 = 1 + (2 * math.pi * R / lay) ** 2
        return R - (1 + gap) * (diameter - 2 * R) * math.sqrt(1 + steep * per_S2) / 2

    R = float(brentq(short, 0.0, diameter / 2, xtol=1e-16 * diameter, rtol=1e-15))
    return R, diameter - 2 * R
