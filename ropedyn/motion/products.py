"""Residues of modes as products of how points are pushed and how they are seen.

Each residue of a mode is one, push times seen, of points that move as they are pushed. Modes that
lie close together have the products of their sum, of which each has shares: these are all that they
do, so only which mode does what is known the worse the closer they are.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..base.array import Index, Real
from ..signal import contour
from .undamped import Parted

LOST, NONE = 1.0, 1e-9
"""Products below this part of what rounding may be are none, and shares below that of them."""
KNOWN = 1e-13  # Above this share of what points yield rounding leaves digits.

State = tuple[Real, Real]
"""How it is pushed, (inputs,), and how it is seen, (outputs,)."""


def factored(
    parted: Parted,
    eigenvalue: Real,
    circles: contour.Circles,
    points: tuple[list[Any], list[Any]],
    *,
    turned: bool,
) -> tuple[Index, Real, Real, Real]:
    """Return of each state its mode, its push, and how it is and may be seen, of drives, responses.

    Shapes (k,), (k, inputs), (outputs, k) and (outputs, k). Modes that are one have no shapes of
    their own: others that they may have are `turned`.
    """
    drives, responses = points
    twin = np.array([responses.index(p) if p in responses else -1 for p in drives], dtype=np.intp)
    most, soft = parted.yields(), np.abs(parted.soft)
    innermost = circles.some(circles.innermost)
    own: list[int] = []
    states: list[State] = []
    for k, members in enumerate(circles.outer.members):
        if len(members) == 1:
            size = most / soft[members[0]]
            found = _products(parted.residue[:, :, members[0]], 1, size, twin)
            own += members.tolist() * len(found)
            states += [(one.push, one.seen) for one in found]
            continue
        inner = innermost.some(np.flatnonzero([g[0] in members for g in innermost.members]))
        outer = circles.outer.some(np.array([k]))
        whole, *parts = (
            _Part.of(parted.residue, eigenvalue, *one)
            for some in (outer, inner)
            for one in zip(some.center, some.radius, some.members)
        )
        for group, each in zip(inner.members, _told(whole, parts, len(members), twin)):
            own += [int(group[min(k, len(group) - 1)]) for k in range(len(each))]
            states += _turned(each) if turned and len(group) > 1 else each
    push = np.array([one for one, _ in states], dtype=np.float64).reshape(len(own), len(drives))
    seen = np.array([one for _, one in states], dtype=np.float64).reshape(len(own), len(responses))
    number = np.array(own, dtype=np.intp)
    i = max(np.flatnonzero(twin >= 0), key=lambda i: most[i, twin[i]], default=None)
    yields = np.zeros(len(responses))
    if i is not None:
        yields = most[i] / np.sqrt(most[i, twin[i]] or np.inf)
    return number, push, seen.T, np.divide.outer(yields, np.sqrt(soft[number]))


def _turned(states: list[State]) -> list[State]:
    """Return orthogonal sums of states, which together do the same."""
    from scipy.fft import dct

    turn = dct(np.eye(len(states)), norm="ortho", axis=0)
    push, seen = (turn @ np.array(one) for one in zip(*states))
    return list(zip(push, seen))


class _Part(NamedTuple):
    """Residues of the modes in a circle."""

    residue: Real  # (inputs, outputs)
    size: Real  # of rounding beside what is outside
    near: float  # what of the modes themselves rounding is larger by

    @classmethod
    def of(
        cls, residue: Real, eigenvalue: Real, center: float, radius: float, members: Index
    ) -> _Part:
        """Sum them."""
        others = np.abs(np.delete(residue, members, axis=2))
        away = np.abs(np.delete(eigenvalue, members) - center)
        whole = residue[:, :, members].sum(axis=2)
        size = contour.ROUNDED * (others @ (radius / away) + np.abs(whole))
        return cls(whole, size, abs(center / radius))


class _Together(NamedTuple):
    """Products that the modes in a circle have together, (points, products)."""

    push: Real
    seen: Real
    at: tuple[list[int], list[int]]  # the input and the output where each is known best
    size: Real  # (inputs, outputs) of rounding

    @classmethod
    def of(cls, found: list[_Product], size: Real) -> _Together:
        """Put some side by side."""
        push, seen, at = zip(*found)
        i, o = (list(one) for one in zip(*at))
        return cls(np.array(push).T, np.array(seen).T, (i, o), size)

    @property
    def weight(self) -> Real:
        """By how far each stands out of rounding, (products,)."""
        i, o = self.at
        own = np.abs(self.push[i].diagonal() * self.seen[o].diagonal())
        return np.sqrt(own / self.size[i, o])

    def shares(self, residue: Real) -> Real:
        """Return what a mode is of them, (states, products).

        What does not stand out of rounding takes nothing from others.
        """
        i, o = self.at
        part, weight = residue[np.ix_(i, o)], self.weight
        own = np.linalg.solve(self.push[i], np.linalg.solve(self.seen[o], part.T).T)
        lost, axes = np.linalg.eigh(weight[:, None] * (own + own.T) / 2 * weight)
        return np.asarray((axes[:, lost > NONE] * np.sqrt(lost[lost > NONE])).T[::-1] / weight)

    def unknown(self, share: Real, twin: Index) -> State:
        """Return how far push and seen of such shares are off at each point.

        By rounding of products, and as much as one may have that rounding hides.
        """
        t = np.flatnonzero(twin >= 0)
        root = np.sqrt(self.size[t, twin[t]])
        push, seen = np.zeros(len(twin)), np.zeros((self.size.shape[1], len(t)))
        push[t] = root
        np.divide(self.size[t].T, root, where=root > 0, out=seen)
        hidden, (a, b) = math.sqrt(LOST), self.rounded
        return hidden * push + a @ np.abs(share), hidden * seen.max(axis=1) + b @ np.abs(share)

    @property
    def rounded(self) -> tuple[Real, Real]:
        """How far push and seen are off by rounding of residues, (points, products)."""
        i, o = self.at
        stands = np.abs(self.push[i].diagonal())
        return self.size[:, o] / stands, self.size[i].T / stands

    def all_of(self, found: list[list[State]]) -> list[list[State]]:
        """Return states of modes whose sum is that of the products, but within rounding."""
        both = [np.array(one) for one in zip(*(one for states in found for one in states))]
        own = np.linalg.solve(self.push[self.at[0]], both[0][:, self.at[0]].T).T
        none, weight = np.eye(len(self.weight)), self.weight
        off = np.linalg.cholesky(own.T @ own) - none
        off[np.abs(off) * np.multiply.outer(weight, weight) <= 1] = 0.0
        kept = np.linalg.solve(none + off, own.T).T
        for k, (product, rounded) in enumerate(zip((self.push, self.seen), self.rounded)):
            beside = both[k] - own @ product.T
            # which adds up to nothing, too
            more = beside.T @ kept
            more[np.abs(more) <= rounded] = 0.0
            both[k] = beside + kept @ (product - more).T
        every = iter(zip(*both))
        return [[next(every) for _ in states] for states in found]


def _told(whole: _Part, parts: list[_Part], most: int, twin: Index) -> list[list[State]]:
    """Return the states of each of close modes, `most` in all or fewer seen at points."""
    several = _products(whole.residue, most, whole.size, twin)
    if not several:
        return [[] for _ in parts]
    both = _Together.of(several, whole.size)
    found: list[list[State]] = []
    for part in parts:
        shares = both.shares(part.residue)
        states = [(both.push @ one, both.seen @ one) for one in shares]
        if states:
            states[0] = _alone(part, states, both.unknown(shares[0], twin), twin)
        found.append(states)
    return both.all_of(found)


def _alone(part: _Part, states: list[State], unknown: State, twin: Index) -> State:
    """Return the first state of a mode by what its own residues know better of it."""
    push, seen = states[0]
    size = part.size * part.near
    t = np.flatnonzero(twin >= 0)
    own, rounded = push[t] ** 2, size[t, twin[t]]
    i = int(t[np.divide(own, rounded, out=np.zeros_like(own), where=rounded > 0).argmax()])
    o, here = twin[i], push[i]
    if here == 0:
        return states[0]
    left = part.residue - sum(np.multiply.outer(a, b) for a, b in states)
    half = left[i, o] / (2 * here)
    more = (left[:, o] - push * half) / here, (left[i] - seen * half) / here
    lost = size[:, o] / np.abs(here), size[i] / np.abs(here)
    a, b = (
        x * np.divide(r**2, r**2 + w**2, out=np.zeros_like(x), where=r > 0)
        for x, r, w in zip(more, unknown, lost)
    )
    a[t] = b[twin[t]] = (a[t] + b[twin[t]]) / 2
    return push + a, seen + b


class _Product(NamedTuple):
    """Residues of a state."""

    push: Real  # (inputs,)
    seen: Real  # (outputs,)
    at: tuple[int, int]  # where it is known best


def _products(R: Real, most: int, size: Real, twin: Index) -> list[_Product]:
    """Return the products that residues are the sum of, as many as are not rounding."""
    found: list[_Product] = []
    for _ in range(most):
        one = _largest(R, size, twin, alone=most == 1)
        if one is None or any(i == one.at[0] or o == one.at[1] for i, o in (f.at for f in found)):
            break  # rounding is left where a product was known best
        found.append(one)
        R = R - np.multiply.outer(one.push, one.seen)
    return found


def _largest(R: Real, size: Real, twin: Index, *, alone: bool) -> _Product | None:
    """Return the largest product in the residues of modes."""
    share = np.divide(np.abs(R), size, out=np.zeros_like(R), where=size > 0)
    if not share.any():
        return None
    i, o = np.unravel_index(int(share.argmax()), share.shape)
    if not alone:
        # of several shapes only points that are pushed and watched leave products of such
        own = [share[i, o] if o >= 0 and R[i, o] > 0 else 0.0 for i, o in enumerate(twin)]
        best = int(np.argmax(own))
        if own[best] <= LOST:
            return None
        i, o = np.intp(best), twin[best]
    push, seen = _scaled(R, size, share, twin, (int(i), int(o)))
    return _Product(push, seen, (int(i), int(o)))


def _scaled(
    R: Real, size: Real, share: Real, twin: Index, at: tuple[int, int]
) -> tuple[Real, Real]:
    """Return push and seen from a pivot: points move by what they are pushed with."""
    i, o = at
    root = np.sqrt(np.abs(R[at]))
    push, seen = R[:, o] * (np.sign(R[at]) / root), R[i] / root
    t = np.flatnonzero(twin >= 0)
    if not len(t):
        return push, seen
    w = twin[t]
    a, b = share[t, o], share[i, w]  # what has the larger share is known better
    k = int(np.minimum(a, b).argmax())
    if min(a[k], b[k]) > KNOWN:
        one, other = push[t[k]], seen[w[k]]
    else:  # none of them: as far as rounding moves those that move most
        own = np.sqrt(np.maximum(size[t, w], np.finfo(float).tiny))
        one, other = (np.max(np.abs(x) / own) for x in (push[t], seen[w]))
    ratio = np.sqrt(np.abs(other / one)) if one and other else 1.0
    push, seen = push * ratio, seen / ratio
    known = np.divide(a**2, a**2 + b**2, out=np.full(len(t), 0.5), where=a + b > 0)
    push[t] = seen[w] = seen[w] + (push[t] - seen[w]) * known
    return push, seen
