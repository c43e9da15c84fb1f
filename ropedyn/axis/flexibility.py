"""The flexibility of an element's end by the integral of its energy along the axis."""

from __future__ import annotations

import itertools

import numpy as np

from ..base.array import Real
from .axis import Axis

RELATIVE = 1e-14  # Of the quadrature, where pieces are cut in two until it is met.

SIGN = np.array([1.0, 1.0, 1.0, 1.0, -1.0, 1.0])
"""Of vectors along x, y, z the coordinates and forces: beta = -theta_y, M_beta = -m_y."""


def end_flexibility(axis: Axis, stiffness: tuple[float, float, float]) -> Real:
    """Return that of the right end, the left one held, by the stiffnesses of alpha, beta, gamma.

    With W(s) the moments (M_alpha, M_beta, M_gamma) there of unit forces on the end
    G = int W^T diag(1/C, 1/B, 1/A) W ds.
    """
    from scipy.integrate import quad_vec

    soft = 1 / np.array(stiffness)
    end, forces = axis.position(axis.length), axis.frame(axis.length)

    def density(s: float) -> Real:
        own = axis.frame(s)
        by_force = np.cross(end - axis.position(s), forces.T) @ own
        W = np.hstack([by_force.T, own.T @ forces]) * SIGN[3:, None] * SIGN
        return (W.T * soft) @ W

    # quadrature has no nodes at the joints, where the frame may jump
    how = {"epsabs": 0.0, "epsrel": RELATIVE, "norm": "max"}
    parts = [quad_vec(density, a, b, **how)[0] for a, b in itertools.pairwise(axis.joints)]
    total: Real = np.sum(parts, axis=0)
    return total
