"""Chains of uniform spans that have a closed form: their numbers as the core takes them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..base.array import Flags, Real
from ..scene.rope import ACROSS
from .chain import CHANNELS, PLANE, Chain, roles
from .rate import Places, Rate

BENT, PLAIN = 4, 2
"""Numbers of a station: inertia and springs across and against turning, or along one coordinate."""

PLAIN_STIFFNESS = {"z": "tension", "alpha": "torsional_stiffness", "x": "axial_stiffness"}
"""What carries the waves of a coordinate that moves alone."""


BENDING = "bending_stiffness"


class Spans(NamedTuple):
    """A component between nodes that nothing moves, of spans in closed form.

    A span that bends has the numbers length, inertia, tension and bending stiffness, a plain one
    length, inertia and stiffness; stations have inertias and then springs, infinite where held.
    """

    coordinates: tuple[str, ...]  # ("z", "beta"), or one alone, in the plane of y as in that of z
    span: Real  # (spans, 4 or 3)
    station: Real  # (spans + 1, 4 or 2)
    hinged: NDArray[np.uint8]  # (spans + 1,) where the rope turns freely beside the node

    @property
    def number(self) -> Real:
        """All numbers in the core's order, shape (numbers,)."""
        return np.concatenate([self.span.ravel(), self.station.ravel()])


def spans_of(chain: Chain) -> Spans | None:
    """Return the spans of a component of a chain, None where they have no closed form."""
    names = tuple(PLANE[k] for k in chain.coordinate)
    bends = names == ("z", "beta")
    if not (bends or len(names) == 1) or chain.inertia is None or chain.sag is not None:
        return None
    if (
        chain.rise is not None
        or chain.attached_kind is not None
        or chain.damping is not None
        or chain.drag is not None
    ):
        return None
    mass, stiffness = (_diagonal(array, chain.term) for array in (chain.mass, chain.stiffness))
    inertia, hinged = chain.inertia[chain.element], _hinges(chain, bends)
    if mass is None or stiffness is None or hinged is None or (bends and inertia[:, 1].any()):
        return None
    length = chain.length[chain.element] * np.diff(chain.first)
    tension = chain.tension[chain.element]
    channel = CHANNELS[names[-1]]
    soft = chain.flexibility[chain.element, channel, channel]
    if names == ("z",):
        numbers = [length, inertia[:, 0], tension]
    elif not (soft > 0).all():
        return None
    elif bends:
        numbers = [length, inertia[:, 0], tension, 1 / soft]
    else:
        numbers = [length, inertia[:, 0], 1 / soft]
    spring = np.where(chain.held[chain.term] != 0, np.inf, stiffness)
    return Spans(names, np.column_stack(numbers), np.hstack([mass, spring]), hinged)


def _diagonal(array: Real, term: NDArray[np.int32]) -> Real | None:
    """Return the diagonals of symmetric matrices of width 1 or 2, None with something beside."""
    width = array.shape[1]
    if width > 1 and array[term, 0, 1].any():
        return None
    return np.stack([array[term, k, k] for k in range(width)], axis=1)


def _hinges(chain: Chain, bends: bool) -> NDArray[np.uint8] | None:
    """Return where the rope turns freely, None where a hinge has a stiffness or breaks z."""
    stations = len(chain.term)
    if chain.hinge is None:
        return np.zeros(stations, dtype=np.uint8)
    hinge = chain.hinge[chain.term]
    free: Flags = np.isinf(hinge)
    if not bends or free[:, 0].any() or not (free | (hinge == 0)).all():
        return None
    return free[:, 1].astype(np.uint8)


def rates_of_spans(rate: Rate, places: Places, coordinates: Sequence[str]) -> Real:
    """Return how fast the numbers of `spans_of` change, shape (numbers,)."""
    kept = [places.model.coordinates.index(c) for c in coordinates]
    own = {"tension": rate.tension} | rate.rope
    carries = ["tension", ACROSS[BENDING] if "gamma" in coordinates else BENDING]
    if "beta" not in roles(coordinates):
        carries = [PLAIN_STIFFNESS[roles(coordinates)[0]]]
    along = [own.get(name, np.zeros(len(places.counts))) for name in carries]
    span = np.column_stack([rate.length, rate.inertia(places)[:, kept[0]], *along])
    station = np.hstack([rate.mass[:, kept], rate.stiffness[:, kept]])
    return np.concatenate([span.ravel(), station.ravel()])
