"""Harmonics of the moment of layers whose curvature is a sine, by how far it goes beyond slip.

At the curvature a cos t the moment of a layer runs through Masing's loop, of its first curve F

    M(t) = F(a) - 2 F(a sin^2(t/2)), 0 <= t <= pi,  M(t + pi) = -M(t)
    M_k = 2/pi int_0^pi M e^(-i k t) dt,

of which M_1/a is the equivalent complex stiffness b (1 + i eta): eta b is that of the work that the
loop encloses, and b what the same quarter of the motion feels. With u = a/kappa_1 both are one
function for all layers.
"""

from __future__ import annotations

from functools import cache
from typing import Any, NamedTuple

import numpy as np

from ...base.array import Complex, Real
from ...scene.construction.friction import Grip

NODES, WEIGHTS = np.polynomial.legendre.leggauss(24)
LEAST, MOST, POINTS = 1e-6, 1e8, 1500
"""Of u - 1, between which curves are told; below nothing slips, beyond hardly anything holds."""


class Loops(NamedTuple):
    """Moments of all layers per curvature, and how they change with the amplitude."""

    first: Complex  # (cells,) M_1/a [N m^2]
    slope: Complex  # (cells,) by a
    third: Complex  # (cells,) M_3/a


def loops(stiffness: Real, first: Real, amplitude: Real) -> Loops:
    """Return those of layers that slip from some curvatures, both (cells, k), at amplitudes."""
    slips = amplitude[:, None] > first * (1 + LEAST)
    # where nothing holds at all u is beyond all numbers
    least = np.maximum(first, amplitude[:, None] / MOST)
    beyond = np.where(slips, amplitude[:, None] / np.where(slips, least, 1.0) - 1, 1.0)
    beyond = np.clip(beyond, LEAST, MOST)
    curve = _curves()
    one, three = np.moveaxis(curve(np.log(beyond)), -1, 0)
    slope = np.moveaxis(curve(np.log(beyond), 1), -1, 0)[0] / np.where(slips, beyond * least, 1.0)
    return Loops(
        (stiffness * np.where(slips, one, 1.0)).sum(axis=1),
        (stiffness * np.where(slips, slope, 0.0)).sum(axis=1),
        (stiffness * np.where(slips, three, 0.0)).sum(axis=1),
    )


@cache
def _curves() -> Any:
    """Return the spline over ln(u - 1) of M_1/a and M_3/a of a layer of stiffness 1."""
    from scipy.interpolate import CubicSpline

    log = np.linspace(np.log(LEAST), np.log(MOST), POINTS)
    return CubicSpline(log, harmonics(1 + np.exp(log)))


def harmonics(u: Real) -> Complex:
    """Return M_1/a and M_3/a of a layer of stiffness 1 that slips from 1, at amplitudes > 1."""
    layer = Grip(np.ones(1), np.ones(1))
    # the loop bends where slip begins and where it is whole
    bends = np.minimum(np.array([0.0, 1.0, np.pi / 2, np.inf]) / u[:, None], 1.0)
    edge = 2 * np.arcsin(np.sqrt(bends))
    half = np.diff(edge)[..., None] / 2
    t = (edge[:, :-1, None] + half * (1 + NODES)).reshape(len(u), -1)
    weight = (half * WEIGHTS).reshape(len(u), -1)
    M = layer.moment(u)[:, None] - 2 * layer.moment(u[:, None] * np.sin(t / 2) ** 2)
    turned = np.exp(-1j * np.multiply.outer([1, 3], t))
    return np.asarray(2 / np.pi * (turned * weight * M).sum(axis=-1) / u).T
