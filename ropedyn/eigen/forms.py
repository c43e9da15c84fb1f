"""Energies and slopes of shapes, of each component where the core does not take them together."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from .. import _core
from ..base.array import Real
from ..base.check import COORDINATES
from ..chain.chain import Chain, components

STRAINS = ("bending", "twist", "stretch", "lay", "tension", "spring")  # That store energy.

SECTIONS = 9
"""An element has so many slopes (section, tension, length, sag) before those of its inertia."""


def _parts(chain: Chain) -> Iterator[tuple[Chain, list[int]]]:
    """Return the components of a chain whose tension grows along it, with their coordinates."""
    names = [COORDINATES[k] for k in chain.coordinate]
    for group in components(chain, names):
        yield chain.only(group), [names.index(c) for c in group]


def energy(chain: Chain, shape: Real, eigenvalue: Real) -> tuple[Real, Real, Real]:
    """Return twice the energies of shapes, see `_core.energy`."""
    if chain.rise is None:
        return _core.energy(chain, shape, eigenvalue)
    strain, kinetic = np.zeros((len(shape), len(STRAINS))), np.zeros((len(shape), shape.shape[2]))
    dragged = np.zeros(len(shape))
    for part, at in _parts(chain):
        own = np.ascontiguousarray(shape[:, :, at])
        stored, kinetic[:, at], lost = _core.energy(part, own, eigenvalue)
        strain, dragged = strain + stored, dragged + lost
    return strain, kinetic, dragged


def slopes(
    chain: Chain, shape: Real, motion: Real, eigenvalue: Real
) -> tuple[Real, Real, Real, Real]:
    """Return the slopes of the forms of shapes, see `_core.sensitivity`."""
    if chain.rise is None:
        return _core.sensitivity(chain, shape, motion, eigenvalue)
    modes, nodes, width = shape.shape
    element, jump = (
        np.zeros((modes, nodes - 1, SECTIONS + width)),
        np.zeros((modes, nodes - 1, width)),
    )
    node, place = np.zeros((modes, nodes, width, width)), np.zeros((modes, nodes, 2))
    for part, at in _parts(chain):
        own = np.ascontiguousarray(shape[:, :, at])
        still = np.zeros((modes, 0 if part.attached_kind is None else len(part.attached_kind)))
        told = _core.sensitivity(part, own, still, eigenvalue)
        element[:, :, :SECTIONS] += told[0][:, :, :SECTIONS]
        element[:, :, [SECTIONS + c for c in at]] = told[0][:, :, SECTIONS : SECTIONS + len(at)]
        jump[:, :, at] = told[1]
        node[:, :, np.array(at)[:, None], at] = told[2]
        place += told[3]
    return element, jump, node, place
