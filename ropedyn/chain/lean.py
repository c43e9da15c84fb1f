"""Continuous spans without the nodes at which nothing stands, as a mass of 0 or a factor of 1."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..base.array import Flags, Index
from .chain import Chain


def lean(chain: Chain) -> tuple[Chain, Index]:
    """Join spans that nothing parts; return the chain and which nodes are left."""
    joined = _joined(chain) if chain.rise is None else np.zeros(1, dtype=np.bool_)
    if not joined.any():
        return chain, np.arange(chain.nodes)
    begin, nodes = np.flatnonzero(np.append(True, ~joined)), np.diff(chain.first)
    size, several = np.add.reduceat(nodes, begin), np.diff(begin, append=len(nodes)) > 1
    section, whole = (
        chain.element[begin],
        np.add.reduceat(chain.length[chain.element] * nodes, begin),
    )
    length = np.where(several, whole, chain.length[section])
    _, source, element = np.unique(
        np.stack([section, length]), axis=1, return_index=True, return_inverse=True
    )
    term = np.append(chain.term[begin], chain.term[-1])
    changed: dict[str, Any] = {n: array[section[source]] for n, array in _along(chain).items()}
    if chain.attached_term is None:
        # structures name the terms that carry them by number; else only those stay that stand
        stand, term = np.unique(term, return_inverse=True)
        names = ("mass", "stiffness", "held", "damping", "hinge")
        given = {n: getattr(chain, n) for n in names}
        changed |= {n: array[stand] for n, array in given.items() if array is not None}
    found = chain._replace(
        length=length[source],
        first=np.append(0, np.cumsum(np.where(several, 1, size))).astype(np.int32),
        element=element.ravel().astype(np.int32),
        term=term.astype(np.int32),
        **changed,
    )
    starts = np.isin(np.arange(chain.nodes - 1), chain.first[begin])
    return found, np.flatnonzero(np.append(~np.repeat(several, size) | starts, True))


def _along(chain: Chain) -> dict[str, NDArray[Any]]:
    """Return what the distinct elements have beside a length."""
    names = ("tension", "flexibility", "inertia", "drag", "sag")
    return {n: getattr(chain, n) for n in names if getattr(chain, n) is not None}


def _joined(chain: Chain) -> Flags:
    """Return between which stretches nothing stands and nothing changes, shape (stretches - 2,)."""
    if chain.inertia is None or len(chain.first) < 3:
        return np.zeros(len(chain.first) - 2, dtype=np.bool_)
    stands: NDArray[np.bool_] = np.any(chain.held, axis=1)
    for array in (chain.mass, chain.stiffness, chain.damping, chain.hinge):
        if array is not None:
            stands |= array.reshape(len(array), -1).any(axis=1)
    if chain.attached_term is not None:
        stands[chain.attached_term] = True
    bare: NDArray[np.bool_] = ~stands[chain.term[1:-1]]
    for array in _along(chain).values() if bare.any() else ():
        same = array[chain.element[:-1]] == array[chain.element[1:]]
        bare &= same.reshape(len(same), -1).all(axis=1)
    return bare
