"""A construction as plain numbers: bars on an axis and rings of elements in helices around it.

Every number may be an array over draws; all arrays have one shape.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ...base.array import Real

SENSES = {"Z": 1, "S": -1}  # Right-hand and left-hand lay.

Number = Any
"""A float, or an array over draws."""


class Bar(NamedTuple):
    """A straight bar: a wire, or fibre, which has mass alone."""

    EA: Number  # [N]
    C: Number  # G J [N m^2]
    B: Number  # E I [N m^2]
    mass: Number  # [kg/m]
    polar: Number  # [kg m]
    area: Number  # of metal [m^2]
    diameter: Number  # [m]


class Helix(NamedTuple):
    """A helix, and what strains of the rope do to an element along it.

    Strains of the rope: extension, twist per length [1/m], relative growth of radii.
    """

    S: Number  # sine of its angle to the section: length of rope per length of helix
    c: Number  # cosine with the sign of its sense
    radius: Number  # [m]
    turn: Number  # angle around the axis per length of it [rad/m]
    curvature: Number  # [1/m]
    a: Real  # (..., 3) extension of the element per strain
    g: Real  # (..., 3) change of its curvature [1/m]
    h: Real  # (..., 3) change of its twist per length [1/m]


class Ring(NamedTuple):
    """Elements side by side in helices of one radius."""

    n: int
    element: Bar | Strand
    on: Helix


class Strand(NamedTuple):
    """What lies on one axis, from inside to outside."""

    bars: tuple[Bar, ...]
    rings: tuple[Ring, ...]
    core: int = 0  # so many rings belong to the core

    @property
    def diameter(self) -> Number:
        """Of the circle around it [m]."""
        sizes = [bar.diameter for bar in self.bars]
        sizes += [2 * ring.on.radius + ring.element.diameter for ring in self.rings]
        return np.maximum.reduce(sizes)


def helix(radius: Number, lay: Number, sense: int) -> Helix:
    """Return a helix; sense 1 is right-handed, -1 left-handed.

    a = (S^2, r S c, c^2), d = (S c, -r S^2, 0),
    g = -2 S c/r d + c^2/r a, h = (1 - 2 S^2)/r d + S c/r a, but S^2 c^2/r and -S c^3/r of radii
    """
    r, around = radius, 2 * np.pi * radius
    along = np.hypot(lay, around)
    S, c = lay / along, sense * around / along
    a, d = (S * S, r * S * c), (S * c, -r * S * S)
    g = [-2 * S * c / r * di + c * c / r * ai for ai, di in zip(a, d)]
    h = [(1 - 2 * S * S) / r * di + S * c / r * ai for ai, di in zip(a, d)]
    rows = (*a, c * c), (*g, S * S * c * c / r), (*h, -S * c**3 / r)
    strains = np.empty((3, *np.shape(along), 3))
    for k, row in enumerate(rows):
        for i, number in enumerate(row):
            strains[k, ..., i] = number
    return Helix(S, c, r, 2 * np.pi * sense / lay, c * c / r, *strains)
