"""Assembled matrices over the free coordinates, as SciPy sparse arrays."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from .. import _core
from ..base.array import Real
from ..scene.damping import DASHPOT, INERTIA, SECTION, SPRING, TENSION, Damping, factors
from .chain import Chain

if TYPE_CHECKING:
    import scipy.sparse as sp


def stiffness(chain: Chain) -> sp.csr_array:
    """Assemble sections, tension and springs."""
    elastic, elastic_coupling, string, string_coupling, springs, _, _ = _assembled(chain)
    return _sparse(chain, elastic + string + springs, elastic_coupling + string_coupling)


def mass(chain: Chain) -> sp.csr_array:
    """Assemble the inertia."""
    inertia = _assembled(chain)[5]
    return _sparse(chain, inertia, np.zeros((len(inertia) - 1, *inertia.shape[1:])))


def damping(chain: Chain, dampings: Sequence[Damping]) -> sp.csr_array:
    """Assemble what the dampings add to the dynamic stiffness per i omega."""
    # every damping here is i omega times a constant on each part
    share = factors(dampings, np.array(1.0)).imag
    parts = _assembled(chain)
    elastic, elastic_coupling, string, string_coupling, springs, inertia, dashpots = parts
    diagonal = (
        share[SECTION] * elastic
        + share[TENSION] * string
        + share[SPRING] * springs
        + share[INERTIA] * inertia
        + share[DASHPOT] * dashpots
    )
    coupling = share[SECTION] * elastic_coupling + share[TENSION] * string_coupling
    return _sparse(chain, diagonal, coupling)


def _assembled(chain: Chain) -> tuple[Real, ...]:
    """Return what the core assembles of each plane, over all coordinates."""
    width, couplings = chain.mass.shape[-1], (1, 3)
    whole = [np.zeros((chain.nodes - (k in couplings), width, width)) for k in range(7)]
    for plane in chain.planes:
        for into, part in zip(whole, _core.assemble(plane.chain)):
            into[:, *plane.square] = part
    return tuple(whole)


def _sparse(chain: Chain, diagonal: Real, coupling: Real) -> sp.csr_array:
    """Turn a block tridiagonal matrix into a sparse one without the held coordinates."""
    import scipy.sparse as sp

    nodes, width, _ = diagonal.shape
    free = (chain.held[chain.term_of] == 0).ravel()
    number = np.where(free, np.cumsum(free) - 1, -1).reshape(nodes, width)
    blocks = [
        (diagonal, number, number),
        (coupling, number[:-1], number[1:]),
        (coupling.transpose(0, 2, 1), number[1:], number[:-1]),
    ]
    rows, columns, values = [], [], []
    for block, above, beside in blocks:
        i, j = np.broadcast_arrays(above[:, :, None], beside[:, None, :])
        kept = (i >= 0) & (j >= 0) & (block != 0)
        rows.append(i[kept])
        columns.append(j[kept])
        values.append(block[kept])
    size = int(free.sum())
    entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    return sp.csr_array(entries, shape=(size, size))
