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
    begin = np.flatnonzero(np.append(True, ~joined))
    end = np.append(begin[1:], len(chain.element))
    several = end - begin > 1
    count = np.where(several, 1, np.diff(chain.first)[begin])
    length = np.add.reduceat(chain.length[chain.element] * np.diff(chain.first), begin)
    # an element of its own for each span that was joined
    own = np.append(chain.element[begin[~several]], chain.element[begin[several]])
    used, which = np.unique(own[: int((~several).sum())], return_inverse=True)
    source = np.append(used, own[int((~several).sum()) :])
    element = np.empty(len(begin), dtype=np.int32)
    element[~several] = which
    element[several] = len(used) + np.arange(int(several.sum()))
    kept = np.ones(chain.nodes, dtype=np.bool_)
    for first, last in zip(chain.first[begin[several]], chain.first[end[several]]):
        kept[first + 1 : last] = False
    chain, term = _terms(chain, np.append(chain.term[begin], chain.term[-1]))
    changed: dict[str, Any] = {name: array[source] for name, array in _along(chain).items()}
    found = chain._replace(
        length=np.append(chain.length[used], length[several]),
        first=np.append(0, np.cumsum(count)).astype(np.int32),
        element=element,
        term=term,
        **changed,
    )
    return found, np.flatnonzero(kept)


def _terms(chain: Chain, term: NDArray[np.int32]) -> tuple[Chain, NDArray[np.int32]]:
    """Keep those node terms that stand somewhere; structures name theirs by number."""
    if chain.attached_term is not None:
        return chain, term
    kept, which = np.unique(term, return_inverse=True)
    names = ("mass", "stiffness", "held", "damping", "hinge")
    own: dict[str, Any] = {
        n: getattr(chain, n)[kept] for n in names if getattr(chain, n) is not None
    }
    return chain._replace(**own), which.astype(np.int32)


def _along(chain: Chain) -> dict[str, NDArray[Any]]:
    """Return what the distinct elements have beside a length."""
    names = ("tension", "flexibility", "inertia", "drag", "sag")
    return {n: getattr(chain, n) for n in names if getattr(chain, n) is not None}


def _joined(chain: Chain) -> Flags:
    """Return between which stretches nothing stands and nothing changes, shape (stretches - 2,)."""
    if chain.inertia is None or len(chain.first) < 3:
        return np.zeros(max(len(chain.first) - 2, 0), dtype=np.bool_)
    stands: NDArray[np.bool_] = np.any(chain.held, axis=1)
    for array in (chain.mass, chain.stiffness, chain.damping, chain.hinge):
        if array is not None:
            stands |= array.reshape(len(array), -1).any(axis=1)
    if chain.attached_term is not None:
        stands[chain.attached_term] = True
    bare: NDArray[np.bool_] = ~stands[chain.term[1:-1]]
    if bare.any():
        left, right = chain.element[:-1], chain.element[1:]
        for array in _along(chain).values():
            same = array[left] == array[right]
            bare &= same.reshape(len(same), -1).all(axis=1)
    return bare
