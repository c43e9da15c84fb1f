"""Motions of all nodes under unit loads, of whose products derivatives of responses are made.

The load whose field has, anywhere, the motion that a unit force there causes in a response: of a
motion a unit force, of an internal force a dislocation between the element and the node on its
right. At the left end of the rope, where no element ends, that is what follows from its right end
(chain/reaction.py).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.array import Complex, Flags, Real
from ..base.computed import computed
from ..base.errors import SceneError
from ..chain.chain import Chain
from ..chain.compiled import EXACT
from ..chain.port import Point, Ports, cut, is_force, locate, moving, ports, stops
from ..chain.reaction import at_start, first_left_end, tellers
from ..chain.wide import nudged_chain
from .moved_end import is_end, released
from .question import Question

NOWHERE, PUSHED = (-1, 0, 0), 2  # What a load does not part or pushes, see csrc/energy/lines.h.


class PairSlopes(NamedTuple):
    """Of the form of pairs of fields, drives times responses; see csrc/energy/sensitivity.h."""

    element: Complex  # (pairs, stretches - 1, 13, f)
    jump: Complex  # (pairs, stretches - 1, width, f)
    node: Complex  # (pairs, stretches, width, width, f)
    place: Complex  # (pairs, stretches, 2, f), and of what size its terms are
    number: Complex  # (pairs, attached, 4, f)
    row: Complex  # (pairs, attached, 2, width, f)


@dataclass(frozen=True, eq=False)
class Fields:
    """One component with its loads, cut where they stand."""

    question: Question
    seed: int | None = None  # by which every number of the chain is moved a little

    @computed
    def cut(self) -> tuple[Chain, Real]:
        """The chain, and where its nodes stand."""
        question = self.question
        model, given = question.model, [*question.drives, *question.responses]
        chain = model.chain.only(question.component)
        inside = [p for p in given if not is_end(p) and locate(model.x, p[1])[1] is not None]
        if inside and model.element not in EXACT:
            raise SceneError(
                f"drive and response must stand at nodes of {model.element!r} elements for a "
                f"derivative, got {inside[0]} between them"
            )
        positions = [p[1] for p in inside]
        if model.element == "tensed":
            positions += stops(chain, model.x)
        if self.seed is None:
            return cut(chain, model.x, positions)
        if model.element == "continuous":
            # other pieces round otherwise
            share = np.random.default_rng(self.seed).uniform(0.2, 0.8, len(model.x) - 1)
            positions += (model.x[:-1] + share * np.diff(model.x)).tolist()
        chain, x = cut(chain, model.x, positions)
        return nudged_chain(chain, self.seed), x

    @property
    def chain(self) -> Chain:
        """The chain that is cut."""
        return self.cut[0]

    @property
    def x(self) -> Real:
        """Where its nodes stand [m]."""
        return self.cut[1]

    @computed
    def pair(self) -> NDArray[np.int32]:
        """Drives with responses, (pairs, 2) numbers of loads."""
        drives, responses = len(self.question.drives), len(self.question.responses)
        drive, response = np.indices((drives, responses), dtype=np.int32).reshape(2, -1)
        return np.stack([drive, response + np.int32(drives)], axis=1, dtype=np.int32)

    @computed
    def slip(self) -> NDArray[np.int32]:
        """What each load parts or pushes, see csrc/energy/lines.h, (loads, 3)."""
        return np.array([self._slip(p) for p in self._given], dtype=np.int32).reshape(-1, 3)

    def _slip(self, point: Point) -> tuple[int, int, int]:
        if is_end(point):
            return NOWHERE
        node, at = locate(self.x, point[1])[0], self.question.component.index(moving(point))
        if not is_force(point):
            return (node, PUSHED, at)
        return (0, 0, at) if at_start(self.x, point) else (node - 1, 1, at)

    @property
    def loads(self) -> list[Point]:
        """Forces and dislocations, which stand where they are whatever moves."""
        return [point for point in self._given if not is_end(point)]

    @property
    def _given(self) -> list[Point]:
        return [*self.question.drives, *self.question.responses]

    @computed
    def _nodes(self) -> Ports:
        """What is told of each node, see csrc/energy/lines.h: motion, of continuous spans force."""
        count, width = self.chain.nodes, len(self.question.component)
        told = 2 if self.question.model.element == "continuous" else 1
        node = np.arange(count)
        row = np.zeros((count, told, width, 2, width))
        row[node, 0, :, (node == count - 1).astype(int)] = np.eye(width)
        left = np.broadcast_to(np.minimum(node, count - 2)[:, None, None], row.shape[:3]).copy()
        if told == 1:
            return Ports(left.ravel().astype(np.int32), row.reshape(-1, 2, width), None)
        force = np.zeros((count, told, width, width))
        force[1:, 1] = np.eye(width)
        left[1:, 1] = node[:-1, None]
        return Ports(
            left.ravel().astype(np.int32), row.reshape(-1, 2, width), force.reshape(-1, width)
        )

    @computed
    def _held(self) -> Flags:
        """What cannot move of what is told, (nodes width,) or twice that."""
        held = self.chain.held[self.chain.term_of].astype(np.bool_)
        if self.question.model.element == "continuous":
            held = np.concatenate([held, np.zeros_like(held)], axis=1)
        return held.ravel()

    def slopes(self, part: slice) -> PairSlopes:
        """Return those of pairs of loads at some of the lines."""
        factor = np.ascontiguousarray(self.question.factor[:, part])
        asked = (self.chain, factor, self.at(part), self.pair, self.slip)
        found = PairSlopes(*_core.pair_slopes(*asked), *_core.carried_pair_slopes(*asked))
        # only rounding is there too, but of slopes by damping
        for slope in found._replace(number=found.number[:, :, :2]):
            slope.imag[..., ~self.question.is_damped[part]] = 0.0
        return found

    def at(self, part: slice) -> Complex:
        """Return the fields at some of the lines, (loads, told, f)."""
        forces = [k for k, point in enumerate(self._given) if not is_end(point)]
        factor = np.ascontiguousarray(self.question.factor[:, part])
        value = np.zeros((len(self._given), len(self._held), factor.shape[1]), dtype=np.complex128)
        value[forces] = self._loaded([self._given[k] for k in forces], factor, part)
        for k in (k for k in range(len(value)) if k not in forces):
            value[k] = self._moved(self._given[k], factor, part)
        value.imag[..., ~self.question.is_damped[part]] = 0.0  # only rounding is there
        return value

    def _loaded(self, given: Sequence[Point], factor: Complex, part: slice) -> Complex:
        """Return the fields of forces and dislocations; what is held does not move."""
        whole = [point for point in given if not at_start(self.x, point)]
        start = tellers(self.question.component, self.x) if len(whole) < len(given) else []
        basis = list(dict.fromkeys([*whole, *start]))
        if not basis:
            return np.zeros((0, len(self._held), factor.shape[1]), dtype=np.complex128)
        found = self._solve(self.chain, basis, factor, part)
        found[:, self._held] = 0.0
        reaction = (
            self._reactions(found[[basis.index(p) for p in start]], factor) if start else None
        )
        fields = []
        for point in given:
            if reaction is not None and at_start(self.x, point):
                fields.append(reaction[self.question.component.index(moving(point))])
            else:
                fields.append(found[basis.index(point)])
        return np.stack(fields)

    def _reactions(self, told: Complex, factor: Complex) -> Complex:
        """Combine what tells the forces at the left end, (width, told, f)."""
        left, right, force = np.split(told, 3)
        of = first_left_end(self.chain, factor)
        value = np.einsum("kij,jnk->ink", of.E, force) - np.einsum("kij,jnk->ink", of.Q, left)
        return value + np.einsum("kij,jnk->ink", of.P, right)

    def _moved(self, end: Point, factor: Complex, part: slice) -> Complex:
        """Return the field of an end that moves by 1."""
        model, own = released(self.question.model, end)
        loose = dataclasses.replace(self.question, model=model)
        chain = dataclasses.replace(self, question=loose).chain
        value = self._solve(chain, [own], factor, part)[0]
        told = len(self._held) // self.chain.nodes
        at = locate(self.x, own[1])[0] * told + self.question.component.index(own[0])
        held = self._held.copy()
        held[at] = False
        value[held] = 0.0
        moved: Complex = value / value[at]
        return moved

    def _solve(self, chain: Chain, given: Sequence[Point], factor: Complex, part: slice) -> Complex:
        """Ask the sweep."""
        pushed = ports(chain, self.x, self.question.component, given)
        value, _, solved = _core.sweep(chain, factor, pushed, self._nodes)
        if solved < factor.shape[1]:
            raise self.question.resonance((part.start or 0) + solved)
        return np.asarray(value)
