"""Derivatives of the modes of a rope on an axis with respect to numbers of its scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, NoReturn

import numpy as np

from ..base import check
from ..base.array import Index, Real
from ..base.errors import SceneError, SolveError
from ..chain.port import Point
from ..eigen.sensitivity import clusters_of, root_slope
from .rope import SIX, unforced
from .slope import apart, slope_of, stepped
from .spectrum import STEP

if TYPE_CHECKING:
    from .modes import SpaceShapes

FITTED = 2e-13  # What polynomials leave of the slopes of arrays, relative.
MIXED = 2.0  # Times what rounding mixes into a shape changes a form.


@dataclass(frozen=True, eq=False)
class SpaceSensitivity:
    """Derivatives of eigenvalues: dlambda/dp = x^T (dA/dp) x of vectors of unit mass.

    dA/dp is that of the band matrix by a complex step along the slope of the rope's arrays.
    """

    shapes: SpaceShapes  # of the modes

    @property
    def sensitivity(self) -> SpaceSensitivity:
        """What derivatives are computed from."""
        return self

    @property
    def clusters(self) -> NoReturn:
        """Of the shapes of a chain, which maps of damage need."""
        raise SceneError(
            "damage is not carried for a rope on an axis: its parts are not those of a chain"
        )

    def shapes_at(self, points: Sequence[Point]) -> Real:
        """Return the shapes at points of the axis, shape (k, points)."""
        near = check.NEAR * self.shapes.scene.rope.length
        cut, node = self.shapes.rope.cut(np.array([at for _, at in points]), near)
        shape, _ = self.shapes.on(cut).solved
        own = [SIX.index(c) for c, _ in points]
        most = np.abs(self.shapes.solved[0]).max(axis=(1, 2))
        return np.asarray(shape[:, node, own] / most[:, None])

    def eigenvalue(self, path: str) -> Real:
        """Return dlambda/dp; increasing among modes that rounding cannot tell apart."""
        change = np.zeros(len(self.shapes.eigenvalue))
        for cluster, form, _ in self._forms(path):
            value, error = self.shapes.eigenvalue[cluster], self.shapes.error[cluster]
            for own in clusters_of(value, error):
                change[cluster[own]] = np.linalg.eigvalsh(form[np.ix_(own, own)])
        if (rigid := self.shapes.eigenvalue == 0).any():
            # nothing is strained: what is left is rounding
            change[rigid & (np.abs(change) <= self.error(path, "eigenvalue"))] = 0.0
        return change

    def frequency(self, path: str) -> Real:
        """Return df/dp [Hz per unit], 0 where motion grows."""
        slope = root_slope(path, self.eigenvalue(path), self.shapes.eigenvalue, 1.0)
        return slope / (2 * np.pi)

    def growth(self, path: str) -> Real:
        """Return d sqrt(-lambda)/dp [1/s per unit], 0 where motion does not grow."""
        return root_slope(path, self.eigenvalue(path), self.shapes.eigenvalue, -1.0)

    def error(self, path: str, of: str) -> Real:
        """Bound the error of a derivative: of slopes that are fitted, and of shapes."""
        value, size = self.shapes.eigenvalue, np.zeros(len(self.shapes.eigenvalue))
        for cluster, _, most in self._forms(path):
            size[cluster] = most.max()
        wrong = FITTED * size + MIXED * self._mixed(size)
        if of == "eigenvalue":
            return wrong
        unit, own = (2 * np.pi, value) if of == "frequency" else (1.0, -value)
        root = 2 * unit * np.sqrt(np.maximum(own, 0.0))
        share = np.divide(self.shapes.error, 2 * np.abs(value), out=0 * value, where=value != 0)
        wrong += np.abs(self.eigenvalue(path)) * share
        return np.divide(wrong, root, out=np.zeros_like(wrong), where=root > 0)

    def _mixed(self, size: Real) -> Real:
        """Return what other modes bring into forms of such sizes, by their distances."""
        value, error = self.shapes.eigenvalue, self.shapes.error
        brought = np.zeros_like(size)
        for own in (np.flatnonzero(self.shapes.component == k) for k in (0, 1)):
            away = np.abs(np.subtract.outer(value[own], value[own]))
            away[away <= np.add.outer(error[own], error[own])] = np.inf
            share = np.sqrt(np.outer(error[own], error[own])) / away
            # those beyond are no nearer to it than a mode's own value to its neighbours' twice
            brought[own] = 2 * share.sum(axis=1) * np.sqrt(size[own] * size[own].max(initial=0.0))
        return brought

    def _forms(self, path: str) -> list[tuple[Index, Real, Real]]:
        """Return clusters with x^T (dA/dp) x between their modes, and what it is the sum of."""
        shapes, slope = self.shapes, slope_of(self.shapes.scene, self.shapes.rope, path)
        if len(shapes.rope.own) > 1:
            slope, tied = apart(slope)
            self._refuse_tied(path, tied=tied)
        varied, found = stepped(shapes.rope, slope, 1j * STEP), []
        for clusters, _, given, lines in shapes.batches:
            which, factors, z = lines
            beside = unforced(-factors.inertia.real, STEP)
            # vectors have unit mass where they were iterated, a little beside their values
            mass = -shapes.form(shapes.rope, (which, beside, z), given)
            own = given / np.sqrt(np.where(mass > 0, mass, 1.0))[:, None]
            most = max(map(len, clusters))
            pairs = list(combinations(range(most), 2))
            sums = [own[:, :, i] + own[:, :, j] for i, j in pairs]
            both = np.concatenate([own, *(x[..., None] for x in sums)], axis=2)
            products = shapes.products(varied, lines, both)
            form, size = products.sum(1), np.abs(products[:, :, :most]).sum(1)
            matrix = form[:, :most, None] * np.eye(most)
            for (i, j), one in zip(pairs, form[:, most:].T):
                matrix[:, i, j] = matrix[:, j, i] = (one - form[:, i] - form[:, j]) / 2
            for k, cluster in enumerate(clusters):
                mine = matrix[k, : len(cluster), : len(cluster)]
                found.append((cluster, mine, size[k, : len(cluster)]))
        return found

    def _refuse_tied(self, path: str, *, tied: bool) -> None:
        """Refuse what parts modes that coincide in both planes."""
        value, error = self.shapes.eigenvalue, self.shapes.error
        same = (np.unique(self.shapes.component[one]) for one in clusters_of(value, error))
        if tied and any(len(one) > 1 for one in same):
            raise SolveError(
                f"modes that coincide in both planes have no derivative by {path}, which ties them"
            )
