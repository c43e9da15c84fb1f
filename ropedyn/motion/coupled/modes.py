"""All modes of some components of a chain, and how they move points and strain elements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ... import _core
from ...base.array import Real
from ...base.computed import computed
from ...chain.compiled import Compiled
from ...chain.port import Point, is_force, locate, moving, ports
from ...eigen.sensitivity import by_tension
from ...scene.damping import SECTION, TENSION, factors
from ..modal.expansion import Expansion
from ..modal_system import ChainModes, ModalSystem, chain_modes, together


@dataclass(frozen=True, eq=False)
class AllModes:
    """The modes of components that move together, one after another."""

    model: Compiled
    each: dict[tuple[str, ...], ChainModes]

    @classmethod
    def of(cls, model: Compiled, together: tuple[str, ...]) -> AllModes:
        """Find them."""
        parts = [one for one in model.components if {*one} <= {*together}]
        return cls(model, {one: chain_modes(model, one) for one in parts})

    @computed
    def system(self) -> ModalSystem:
        """Their equations, side by side."""
        return together([one.system for one in self.each.values()])

    @property
    def sigma(self) -> Real:
        """How they are damped, each for itself [1/s], (k,)."""
        return np.diag(self.system.damping) / 2

    def rows(self, points: Sequence[Point]) -> Real:
        """Return what points see per q and q' of the modes, and per q and tension beside the mean.

        Of internal forces, which the element left of their node takes, of u of its two nodes, with
        K the rows of its stiffness, G those of the derivative by the tension T and e = K - T G,

            f = K u + (gamma_section e + gamma_tension T G) u' + t G u.

        Shape (3, points, k).
        """
        total = np.zeros((3, len(points), len(self.system.eigenvalue)))
        begin = 0
        for component, one in self.each.items():
            mine = slice(begin, begin + len(one.shape))
            begin = mine.stop
            for k, point in enumerate(points):
                if moving(point) in component:
                    seen = self._strained if is_force(point) else self._moved
                    total[:, k, mine] = seen(component, one.shape, point)
        return total

    def driven(self, push: Real, seen: Real, swept: Real) -> Expansion:
        """Return what a force that pushes modes moves outputs seen q + swept q'."""
        none = np.zeros((1, len(seen)))
        a, b = (seen * push)[None], (swept * push)[None]
        return Expansion(self.sigma, self.system.eigenvalue, a, b, none, none)

    def _moved(self, component: tuple[str, ...], shape: Real, point: Point) -> Real:
        at = ports(self.model.chain.only(component), self.model.x, component, [point])
        node = int(at.node[0])
        moved = np.einsum("knc,nc->k", shape[:, node : node + 2], at.row[0])
        return np.stack([moved, np.zeros_like(moved), np.zeros_like(moved)])

    def _strained(self, component: tuple[str, ...], shape: Real, point: Point) -> Real:
        chain, right = self.model.chain.only(component), locate(self.model.x, point[1])[0]
        left, at, width = max(right - 1, 0), component.index(moving(point)), len(component)
        element = chain.between(left, left + 1)
        F, G, Q = (one[element.element_of[0]] for one in _core.triples(element.at_rest))
        stiff = np.linalg.solve(G, np.hstack([-F, np.eye(width)]))
        unit = np.eye(2 * width).reshape(-1, 2, width)
        bare = element.carrying(np.zeros(len(chain.carried), dtype=np.bool_))
        slope = by_tension(bare, unit)[width:]
        if right == 0:
            stiff, slope = F.T @ stiff - np.hstack([Q, 0 * Q]), -by_tension(bare, unit)[:width]
        K, by_t = stiff[at], slope[at]
        string = element.tension[element.element_of[0]] * by_t
        share = factors(self.model.scene.dampings, np.array(1.0)).imag
        lossy = share[SECTION] * (K - string) + share[TENSION] * string
        return np.stack([K, lossy, by_t]) @ shape[:, left : left + 2].reshape(len(shape), -1).T
