"""Slopes of the forms of shapes, component by component where the core does not take them all."""

from __future__ import annotations

import numpy as np

from .. import _core
from ..base.array import Real
from ..chain.chain import Chain

STRAINS = ("bending", "twist", "stretch", "lay", "tension", "spring")  # That store energy.

SECTIONS = 9
"""An element has so many slopes (section, tension, length, sag) before those of its inertia."""


def slopes(
    chain: Chain, shape: Real, motion: Real, eigenvalue: Real
) -> tuple[Real, Real, Real, Real]:
    """Return the slopes of the forms of shapes in one plane, see `_core.sensitivity`."""
    if chain.rise is None:
        return _core.sensitivity(chain, shape, motion, eigenvalue)
    modes, nodes, width = shape.shape
    element = np.zeros((modes, nodes - 1, SECTIONS + width))
    jump = np.zeros((modes, nodes - 1, width))
    node, place = np.zeros((modes, nodes, width, width)), np.zeros((modes, nodes, 2))
    for part, at in chain.parted:
        own = np.ascontiguousarray(shape[:, :, at])
        still = np.zeros((modes, 0 if part.attached_kind is None else len(part.attached_kind)))
        told = _core.sensitivity(part, own, still, eigenvalue)
        element[:, :, :SECTIONS] += told[0][:, :, :SECTIONS]
        element[:, :, [SECTIONS + c for c in at]] = told[0][:, :, SECTIONS : SECTIONS + len(at)]
        jump[:, :, at] = told[1]
        node[:, :, np.array(at)[:, None], at] = told[2]
        place += told[3]
    return element, jump, node, place
