"""Derivatives of eigenvalues with respect to numbers of the scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import combinations
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from .. import _core
from ..base.array import Index, Real
from ..base.computed import computed
from ..base.errors import SolveError
from ..chain.chain import Chain
from ..chain.rate import Places, Rate, Weights, asked, rates_of
from .forms import SECTIONS, slopes

if TYPE_CHECKING:
    from ..chain.compiled import Compiled

_Arrays = TypeVar("_Arrays", Weights, "Slopes")
BENDING, TENSION, SAG, BY_ACROSS = 2, 6, 8, 9
"""Numbers of some slopes among those of an element; in both planes one more, of the section across,
stands before those of its inertia."""
ROUNDINGS, MIXED = 32, 32
"""Shapes and forces are rounded so many times, and mixed with others by so many errors."""
NOTHING = 1e-12
"""Less than this part of the largest change that a shape of its size could make is rounding."""


@dataclass(frozen=True, eq=False)
class Shapes:
    """Modes of a model with their shapes at its nodes, lowest first."""

    model: Compiled  # of continuous spans one with elements below their own resonance
    eigenvalue: Real  # (k,) [rad^2/s^2]
    shape: Real  # (k, nodes, width)
    motion: (
        Real  # (k, attached) of the structures that nodes carry, as y in csrc/chain/attached.h [m]
    )
    # the modes in order; rounding cannot tell those of one cluster apart
    clusters: tuple[Index, ...]
    # (parts + 1,) the nodes between the parts of the rope that were asked for
    edges: Index
    error: Real  # (k,) of the eigenvalues [rad^2/s^2]
    which: Index  # (k,) the component of each
    beyond: float  # no other eigenvalue is less [rad^2/s^2]

    @property
    def sensitivity(self) -> Sensitivity:
        """What derivatives are computed from."""
        return Sensitivity(self)


def clusters_of(eigenvalue: Real, error: Real) -> tuple[Index, ...]:
    """Return which of increasing eigenvalues are not further apart than their errors."""
    if len(eigenvalue) == 0:
        return ()
    apart = np.diff(eigenvalue) > error[:-1] + error[1:]
    return tuple(np.split(np.arange(len(eigenvalue)), np.flatnonzero(apart) + 1))


@dataclass(frozen=True, eq=False)
class Slopes:
    """How the form Pi of each shape changes with the numbers of each stretch."""

    eigenvalue: Real  # (m,) of each shape
    # see csrc/energy/sensitivity.h
    element: Real  # (m, stretches - 1, 9 or 10 + width)
    jump: Real  # (m, stretches - 1, width)
    node: Real  # (m, stretches, width, width)
    # (m, stretches, 2) by the place of the first node of each, and of what size its terms are
    place: Real
    # see csrc/chain/attached.h
    stiffer: Real  # (m, attached)
    heavier: Real  # (m, attached)
    foot: Real  # (m, attached, 2, width)

    @classmethod
    def of(cls, chain: Chain, eigenvalue: Real, shape: Real, motion: Real) -> Slopes:
        """Ask the core."""
        parts = []
        for plane in chain.planes:
            u = np.ascontiguousarray(shape[..., plane.kept])
            y = np.ascontiguousarray(motion[:, plane.carried])
            element, jump, node, place = slopes(plane.chain, u, y, eigenvalue)
            nodes = plane.chain._replace(rise=None)
            number, foot = _core.carried_slopes(nodes, u, y, eigenvalue)
            element = element[..., : SECTIONS + u.shape[2]]
            heavier, stiffer = number[..., 0], number[..., 1]
            parts.append(cls(eigenvalue, element, jump, node, place, stiffer, heavier, foot))
        return parts[0] if len(parts) == 1 else cls._in_space(parts, chain, shape, motion)

    @classmethod
    def _in_space(cls, parts: Sequence[Slopes], chain: Chain, shape: Real, motion: Real) -> Slopes:
        """Return those of both planes together; bending across has a slope of its own."""
        (m, s, _), width, carried = parts[0].element.shape, shape.shape[2], motion.shape[1]
        element, jump = np.zeros((m, s, BY_ACROSS + 1 + width)), np.zeros((m, s, width))
        node, place = np.zeros((m, s + 1, width, width)), parts[0].place + parts[1].place
        stiffer, heavier = np.zeros((2, m, carried))
        foot = np.zeros((m, carried, 2, width))
        for part, plane in zip(parts, chain.planes):
            own, rows = np.arange(width)[plane.kept], np.arange(carried)[plane.carried]
            element[..., TENSION:BY_ACROSS] += part.element[..., TENSION:SECTIONS]
            element[..., BY_ACROSS + 1 + own] = part.element[..., SECTIONS:]
            jump[..., own], node[..., own[:, None], own] = part.jump, part.node
            stiffer[:, rows], heavier[:, rows] = part.stiffer, part.heavier
            foot[:, rows[:, None, None], np.arange(2)[:, None], own] = part.foot
        element[..., :TENSION] = parts[0].element[..., :TENSION]
        element[..., BY_ACROSS] = parts[1].element[..., BENDING]
        value = parts[0].eigenvalue
        return cls(value, element, jump, node, place, stiffer, heavier, foot)

    @property
    def inertia(self) -> Real:
        """Of those of each element that of its inertia, shape (m, stretches - 1, width)."""
        return self.element[..., -self.jump.shape[-1] :]

    def weigh(self, weights: Weights) -> Real:
        """Return dPi/dp, shape (m,)."""
        moving = _sum(self.inertia, weights.moving) + _sum(self.node, weights.mass)
        moving += _sum(self.heavier, weights.heavier)
        return self.weigh_stiffness(weights) - self.eigenvalue * moving

    def size(self, weights: Weights) -> Real:
        """Return the sum of the sizes of what dPi/dp is the sum of, shape (m,)."""
        of, by = sizes(self), sizes(weights)
        by = replace(by, place=by.place[:, ::-1])
        return replace(of, eigenvalue=-of.eigenvalue).weigh(by)

    def weigh_stiffness(self, weights: Weights) -> Real:
        """Return the part of dPi/dp that is not inertia, shape (m,)."""
        elastic = _sum(self.element[..., : weights.element.shape[1]], weights.element)
        elastic += _sum(self.jump, weights.jump) + _sum(self.node, weights.node)
        elastic += _sum(self.place, weights.place)
        return elastic + _sum(self.stiffer, weights.stiffer) + _sum(self.foot, weights.foot)

    def mass(self, chain: Chain) -> Real:
        """Return shape^T M shape, shape (m,)."""
        mass = _sum(self.node, chain.mass[chain.term]) + self.heavier.sum(axis=1)
        if chain.inertia is not None:
            mass += _sum(self.inertia, chain.inertia[chain.element])
        return mass


def _sum(slopes: Real, weights: Real) -> Real:
    return slopes.reshape(len(slopes), weights.size) @ weights.ravel()


@dataclass(frozen=True, eq=False)
class ModePairs:
    """Shapes, and sums and differences in a cluster: bilinear forms from quadratic ones."""

    shapes: Shapes  # the modes
    pair: Index  # (p, 2) different modes of one cluster

    @classmethod
    def of(cls, shapes: Shapes) -> ModePairs:
        """Take the modes of each cluster two by two."""
        found = [pair for cluster in shapes.clusters for pair in combinations(cluster, 2)]
        return cls(shapes, np.array(found, dtype=np.intp).reshape(-1, 2))

    def slopes(self, chain: Chain) -> Slopes:
        """Return those of the modes, of the sums and of the differences."""
        value = self.shapes.eigenvalue
        first, second = self.pair.T
        mean = (value[first] + value[second]) / 2
        u, y = (
            np.concatenate([one, one[first] + one[second], one[first] - one[second]])
            for one in (self.shapes.shape, self.shapes.motion)
        )
        return Slopes.of(chain, np.concatenate([value, mean, mean]), u, y)

    def bilinear(self, form: Real) -> tuple[Real, Real]:
        """Return forms of the modes themselves and of the pairs, shape (k, ...) and (p, ...)."""
        own, plus, minus = np.split(form, np.cumsum([len(self.shapes.shape), len(self.pair)]))
        return own, (plus - minus) / 4

    def matrix(self, form: Real) -> Real:
        """Return a bilinear form as a matrix, zero between clusters, shape (k, k)."""
        own, cross = self.bilinear(form)
        full = np.diag(own)
        first, second = self.pair.T
        full[first, second] = full[second, first] = cross
        return full


@dataclass(frozen=True, eq=False)
class Sensitivity:
    """Derivatives of the eigenvalues of a model.

    With the shape u of a mode dlambda/dp = u^T (dK/dp - lambda dM/dp) u / (u^T M u). Modes that
    rounding cannot tell apart have the eigenvalues of that form within their cluster.
    """

    shapes: Shapes  # the modes

    @computed
    def places(self) -> Places:
        """Where spans and stations are."""
        return Places(self.shapes.model)

    @computed
    def pairs(self) -> ModePairs:
        """What the clusters need."""
        return ModePairs.of(self.shapes)

    @computed
    def slopes(self) -> Slopes:
        """Of the modes and the pairs."""
        return self.pairs.slopes(self.shapes.model.chain)

    @computed
    def mass(self) -> Real:
        """u^T M u between the modes of each cluster, shape (k, k)."""
        return self.pairs.matrix(self.slopes.mass(self.shapes.model.chain))

    @computed
    def largest(self) -> Slopes:
        """Sizes of those of shapes as large as the modes that turn from node to node."""
        shapes, row = self.shapes, self.shapes.model.chain.attached_row
        u = np.abs(shapes.shape).max(axis=1, keepdims=True)
        if row is not None:
            # what moves far on a rope that hardly does sets the rounding of both
            u[:, 0] = np.maximum(u[:, 0], np.abs(shapes.motion) @ np.abs(row[:, 0]))
        sign = 1.0 - 2.0 * (np.arange(shapes.shape.shape[1]) % 2)
        turning = u * sign[:, None]
        return sizes(Slopes.of(shapes.model.chain, shapes.eigenvalue, turning, shapes.motion))

    def rate(self, path: str) -> Rate:
        """Return the rate of a path, checked."""
        return asked(rates_of(self.places), path)()

    def eigenvalue(self, path: str) -> Real:
        """Return dlambda/dp; increasing within a cluster."""
        weights = self.rate(path).weights(self.places)
        form = self.pairs.matrix(self.slopes.weigh(weights))
        change = np.diag(form) / np.diag(self.mass)
        clusters = [part for c in self.shapes.clusters for part in self._apart(c, form)]
        for cluster in (c for c in clusters if len(c) > 1):
            within = np.ix_(cluster, cluster)
            half = np.linalg.inv(np.linalg.cholesky(self.mass[within]))
            change[cluster] = np.linalg.eigvalsh(half @ form[within] @ half.T)
        rigid = self.shapes.eigenvalue == 0.0
        if rigid.any():
            bound = self.largest.weigh_stiffness(sizes(weights)) / np.diag(self.mass)
            change[rigid & (np.abs(change) <= NOTHING * bound.max(where=rigid, initial=0.0))] = 0.0
        return change

    def _apart(self, cluster: Index, form: Real) -> list[Index]:
        """Return the modes of each component, each with its own, where nothing ties them."""
        which = self.shapes.which[cluster]
        parts = [cluster[which == k] for k in np.unique(which)]
        tied = form[np.ix_(cluster, cluster)] * (which[:, None] != which)
        return [cluster] if tied.any() else parts

    def error(self, path: str, of: str) -> Real:
        """Return a bound of the error of a derivative: of shapes that are rounded and mixed."""
        value, eps = self.shapes.eigenvalue, ROUNDINGS * np.finfo(float).eps
        weights, mass = self.rate(path).weights(self.places), np.diag(self.mass)
        size = self.slopes.size(weights)[: len(value)] / mass
        noise = self.largest.size(weights) / mass
        wrong = eps * (size + 2 * np.sqrt(size * noise) + eps * noise)
        wrong += 2 * MIXED * self._mixed(size)
        for cluster in self.shapes.clusters:
            wrong[cluster] = wrong[cluster].max()
        if of == "eigenvalue":
            return wrong
        unit = 2 * np.pi if of == "frequency" else 1.0
        root = 2 * unit * np.sqrt(np.maximum(value if of == "frequency" else -value, 0.0))
        wrong += np.abs(self.eigenvalue(path)) * (eps + self.shapes.error / np.abs(2 * value))
        return np.divide(wrong, root, out=np.zeros_like(wrong), where=root > 0)

    def _mixed(self, size: Real) -> Real:
        """Return what other modes bring into forms of such sizes: by their distances."""
        shapes, most = self.shapes, size.max(initial=0.0)
        value, brought = shapes.eigenvalue, np.zeros_like(size)
        least = ROUNDINGS * np.finfo(float).eps
        for cluster in shapes.clusters:
            for j in cluster:
                others = np.delete(np.arange(len(value)), cluster)
                others = others[shapes.which[others] == shapes.which[j]]
                apart = np.append(np.abs(value[others] - value[j]), shapes.beyond - value[j])
                share = np.maximum(shapes.error[j], least * np.abs(value[j])) / apart
                cross = np.sqrt(size[j] * np.append(size[others], most))
                brought[j] = share @ (cross + share * np.append(size[others], most))
        return brought

    def frequency(self, path: str) -> Real:
        """Return df/dp [Hz per unit], 0 where motion grows."""
        return self._root(path, 1.0) / (2 * np.pi)

    def growth(self, path: str) -> Real:
        """Return d sqrt(-lambda)/dp [1/s per unit], 0 where motion does not grow."""
        return self._root(path, -1.0)

    def _root(self, path: str, sign: float) -> Real:
        """Return d sqrt(sign lambda)/dp."""
        return root_slope(path, self.eigenvalue(path), self.shapes.eigenvalue, sign)


def root_slope(path: str, change: Real, value: Real, sign: float) -> Real:
    """Return d sqrt(sign lambda)/dp of eigenvalues and their derivatives."""
    change, value = sign * change, sign * value
    leaving = np.flatnonzero((value == 0.0) & (change != 0.0))
    if len(leaving):
        raise SolveError(
            f"mode {leaving[0] + 1} has the eigenvalue 0, which changes with {path}: the root "
            'of it has no derivative there, ask for that of="eigenvalue"'
        )
    root = 2 * np.sqrt(np.maximum(value, 0.0))
    return np.divide(change, root, out=np.zeros_like(change), where=root > 0)


def sizes(of: _Arrays) -> _Arrays:
    """Return the same with the sizes of all its numbers."""
    return type(of)(*(np.abs(array) for array in vars(of).values()))


def by_tension(chain: Chain, shape: Real, times: Real | float = 1.0) -> Real:
    """Return the derivative of the stiffness by the tension, (k, k), of shapes between elements.

    Each distinct element counts so many times. Sums and differences of shapes give the products.
    """

    def slope(of: Real) -> Real:
        carried = 0 if chain.attached_kind is None else len(chain.attached_kind)
        motion = np.zeros((len(of), carried))
        element, *_ = _core.sensitivity(chain, of, motion, np.zeros(len(of)))
        return np.asarray((times * element[:, :, TENSION]).sum(axis=1))

    size = np.sqrt(np.abs(slope(shape)))
    unit = shape / np.where(size > 0, size, 1.0)[:, None, None]
    form = np.diag(slope(unit))
    for k in range(len(unit) - 1):
        others = unit[k + 1 :]
        product = (slope(unit[k] + others) - slope(unit[k] - others)) / 4
        form[k, k + 1 :] = form[k + 1 :, k] = product
    return np.asarray(form * np.outer(size, size), dtype=np.float64)
