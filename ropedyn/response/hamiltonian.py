"""The Hamiltonian of a continuous span: a form of motion and internal forces that all of it has.

Along a span y = (u, f), f the force of the right part on the left, obeys

    u' = Phi u + S f,   f' = q u - Phi^T f,      that is  y' = J H y,   H = | -q   Phi^T |
                                                                            | Phi  S     |

(see csrc/span/rate_matrix.h) with S the section flexibility over its complex factor, and 1/T for z
without bending; q = inertia, drag and, for beta, tension times their factors.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..base.array import Complex, Real
from ..chain.chain import CHANNELS, Chain


class Span(NamedTuple):
    """What a span is made of, or how fast that changes."""

    section: Real  # flexibility, shape (3, 3)
    tension: float  # [N]
    inertia: Real  # per length, shape (width,)
    drag: Real  # damping per length, shape (width,)
    sag: float  # curvature of the rope that hangs [1/m]

    @classmethod
    def of(cls, chain: Chain, element: int) -> Span:
        """Return that of a distinct element of a continuous chain."""
        none = np.zeros(len(chain.coordinate))
        return cls(
            section=chain.flexibility[element],
            tension=float(chain.tension[element]),
            inertia=none if chain.inertia is None else chain.inertia[element],
            drag=none if chain.drag is None else chain.drag[element],
            sag=0.0 if chain.sag is None else float(chain.sag[element]),
        )


def hamiltonian(span: Span, coordinates: Sequence[str], factor: Complex) -> Complex:
    """Return H."""
    section, tension, _, inertia, dashpot = factor
    pull = span.tension * tension
    form = _filled(
        coordinates,
        soft=span.section / section[:, None, None],
        slack=np.divide(1, pull, out=np.zeros_like(pull), where=pull != 0),
        pull=pull,
        heavy=np.outer(inertia, span.inertia) + np.outer(dashpot, span.drag),
        sag=span.sag,
    )
    if "beta" in coordinates and "z" in coordinates:
        z, beta = coordinates.index("z"), coordinates.index("beta")
        w = len(coordinates)
        form[:, w + z, beta] = form[:, beta, w + z] = 1.0
    return form


def hamiltonian_rate(
    span: Span, rate: Span, coordinates: Sequence[str], factor: Complex, factor_rate: Complex
) -> Complex:
    """Return dH/dp, shape (f, 2 width, 2 width)."""
    section, tension, _, inertia, dashpot = (one[:, None, None] for one in factor)
    by_section, by_tension, _, by_inertia, by_dashpot = (one[:, None, None] for one in factor_rate)
    pull = (span.tension * tension)[:, 0, 0]
    grows = (rate.tension * tension + span.tension * by_tension)[:, 0, 0]
    heavy = rate.inertia * inertia + span.inertia * by_inertia
    heavy = heavy + rate.drag * dashpot + span.drag * by_dashpot
    return _filled(
        coordinates,
        soft=rate.section / section - span.section * by_section / section**2,
        slack=-np.divide(grows, pull**2, out=np.zeros_like(pull), where=pull != 0),
        pull=grows,
        heavy=heavy[:, 0],
        sag=rate.sag,
    )


def _filled(
    coordinates: Sequence[str],
    *,
    soft: Complex,
    slack: Complex,
    pull: Complex,
    heavy: Complex,
    sag: float,
) -> Complex:
    """Put the parts of H where they belong, the lever of z' = beta apart."""
    w, at = len(coordinates), {c: k for k, c in enumerate(coordinates)}
    form: NDArray[Any] = np.zeros((len(pull), 2 * w, 2 * w), dtype=np.complex128)
    for c, i in at.items():
        form[:, i, i] = -heavy[:, i]
        for d, j in at.items():
            if "z" not in (c, d):
                form[:, w + i, w + j] = soft[:, CHANNELS[c], CHANNELS[d]]
    if "beta" in at:
        form[:, at["beta"], at["beta"]] -= pull
    elif "z" in at:
        form[:, w + at["z"], w + at["z"]] = slack
    if sag and {"x", "z"} <= at.keys():
        x, z = at["x"], at["z"]
        form[:, w + x, z] = form[:, z, w + x] = sag
    return form


def generator(form: Complex) -> Complex:
    """Return J H of y' = J H y."""
    w = form.shape[-1] // 2
    return np.concatenate([form[..., w:, :], -form[..., :w, :]], axis=-2)
