"""Derivatives of a frequency response with respect to numbers of the scene.

The dynamic stiffness Z(omega) is symmetric, damped or not. So with the motion u_d that a drive
causes and the motion u_r that a unit load on the response would, the receptance h has

    dh/dp = -u_r^T (dZ/dp) u_d,

and nothing is solved again: the slopes of the form u_r^T Z u_d (csrc/energy/sensitivity.h) times
how fast what the chain is made of changes (chain/rate.py). An end that is moved has the field of
that motion as u_d, and u_r is that with the end held.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..base.array import Complex, Index, Real
from ..base.check import NEAR
from ..base.computed import computed
from ..base.errors import SceneError
from ..base.unit import QUANTITIES
from ..chain import tip
from ..chain.compile import dragged
from ..chain.compiled import Compiled
from ..chain.port import Point, moving
from ..chain.rate import ENTRIES, Places, Rate, Weights, asked, rates_of
from ..chain.wide import RUNS, SLIGHT, apart, nudged
from ..scene import damping
from ..scene.damping import Damping
from .fields import Fields, PairSlopes
from .measured import measured
from .modal_sum import ModalParts, sum_slope
from .moved_end import is_end
from .question import Question
from .rounding import EPS, radians
from .solvers import in_slices

TENSION, LENGTH, SAG, INERTIA = 6, 7, 8, 9
"""Numbers of these slopes of an element, behind those of its section."""
OF_WIRES = 4.0  # Numbers of wires, which are made of several, may be so many roundings off.
Term = tuple[Complex, Real, Any]  # slopes (pairs, .., f), how fast what they are by changes, factor
SLICE = 1 << 19  # Numbers of the fields of one call of the core: a look for Ctrl-C between them.


@dataclass(frozen=True, eq=False)
class ComponentRates:
    """How the response of one component changes."""

    places: Places  # of the model
    fields: Fields  # of its loads
    still: Sequence[Point]  # loads that stay where they are; those on wires go with them

    def nudged(self, random: np.random.Generator) -> ComponentRates:
        """Return those of a chain, and of factors, all of whose numbers are a little off."""
        question = self.fields.question
        factor = nudged(question.factor, random)
        if self.fields.chain.inertia is None:
            off = self._lost * random.uniform(-1, 1, factor.shape[1])
            factor[damping.INERTIA] *= 1 + off
        question = dataclasses.replace(question, factor=factor)
        return dataclasses.replace(self, fields=Fields(question, int(random.integers(1 << 32))))

    @computed
    def _lost(self) -> Real:
        """How far inertia is off where equal elements all lose digits of 1 - (kl)^2, (f,)."""
        chain = self.fields.chain
        first = chain.first.astype(np.intp)
        count = np.diff(first)
        turn = radians(chain, first, self.fields.question.factor).max(axis=1) / count[:, None]
        least = turn[count > 1].min(axis=0, initial=1.0)
        return np.asarray(SLIGHT / np.maximum(least**2, SLIGHT ** (1 / 3)))

    @computed
    def slopes(self) -> PairSlopes:
        """Of all pairs of fields at all lines."""
        fields, question = self.fields, self.fields.question
        loads = len(question.drives) + len(question.responses)
        size = max(2 * fields.chain.nodes * len(question.component) * loads, 1)
        parts = in_slices(fields.slopes, len(question.frequency), size, SLICE, question.workers)
        return PairSlopes(*parts)

    @computed
    def _kept(self) -> Index:
        """The component's coordinates among all."""
        every = self.places.model.coordinates
        return np.array([every.index(c) for c in self.fields.question.component], dtype=np.intp)

    @computed
    def _carried(self) -> Index:
        """The structures that it moves among all."""
        rows = self.places.model.chain.attached_row
        return np.flatnonzero([] if rows is None else rows[..., self._kept].any(axis=(1, 2)))

    @computed
    def _source(self) -> Index:
        """The model's stretch from whose elements those of each stretch come."""
        model, x, first = self.places.model, self.fields.x, self.fields.chain.first
        middle = (x[first[:-1]] + x[first[:-1] + 1]) / 2
        element = np.searchsorted(model.x, middle) - 1
        return np.asarray(np.searchsorted(model.chain.first, element, side="right") - 1)

    @computed
    def _own(self) -> tuple[Index, Index]:
        """The stretches whose nodes are the model's, and which of its stretches those are."""
        model, fields = self.places.model, self.fields
        begin = fields.x[fields.chain.first]
        node = np.minimum(np.searchsorted(model.x, begin), len(model.x) - 1)
        own = np.flatnonzero(model.x[node] == begin)
        return own, np.searchsorted(model.chain.first, node[own], side="right") - 1

    def receptance(self, weights: Weights, by_p: Complex) -> Complex:
        """Return dh/dp where the chain and the factors, (5, f), change, (drives, responses, f)."""
        slopes, question = self.slopes, self.fields.question
        terms = [*self._along(slopes, weights, by_p), *self._at_nodes(slopes, weights, by_p)]
        terms += self._on_structures(slopes, weights, by_p)
        total = sum(_dot(slope, weight) * by for slope, weight, by in terms)
        return -np.reshape(total, (len(question.drives), len(question.responses), -1))

    def _along(self, slopes: PairSlopes, weights: Weights, by_p: Complex) -> Iterator[Term]:
        """Yield what the elements give."""
        factor, chain = self.fields.question.factor, self.fields.chain
        source = self._source
        element = weights.element_in(self.fields.question.component)[source]
        element[:, LENGTH] = self._longer(weights)
        yield slopes.element[:, :, :INERTIA], element, 1.0
        width = len(self._kept)
        inertia = slopes.element[:, :, INERTIA : INERTIA + width]
        moving = weights.moving[source][:, self._kept]
        yield inertia, moving, factor[damping.INERTIA]
        if chain.inertia is not None:
            drag = weights.dragging[source][:, self._kept]
            yield inertia, drag, factor[damping.DASHPOT]
            yield inertia, chain.inertia[chain.element], by_p[damping.INERTIA]
        # S/section, T tension
        section = chain.flexibility[chain.element][:, ENTRIES[0], ENTRIES[1]]
        share = by_p[damping.SECTION] / factor[damping.SECTION]
        yield slopes.element[:, :, :TENSION], section, -share
        share = by_p[damping.TENSION] / factor[damping.TENSION]
        pull = chain.tension[chain.element][:, None]
        yield slopes.element[:, :, TENSION : TENSION + 1], pull, share

    def _longer(self, weights: Weights) -> Real:
        """Return how fast the elements of each stretch grow."""
        model, fields = self.places.model, self.fields
        grows = np.repeat(weights.element[:, LENGTH], np.diff(model.chain.first))
        moves = np.append(0.0, np.cumsum(grows))
        if not moves.any():
            return np.zeros(len(self._source))
        self._refuse_loads_at(model.x[moves != 0])
        anchor = np.union1d(model.x, [p[1] for p in fields.loads])
        shift = np.zeros(len(anchor))
        shift[np.searchsorted(anchor, model.x)] = moves
        # how the pieces between two of them share what they grow by does not matter
        middle = (fields.x[:-1] + fields.x[1:]) / 2
        between = np.searchsorted(anchor, middle) - 1
        count = np.bincount(between, minlength=len(anchor) - 1)
        each = np.diff(shift) / np.maximum(count, 1)
        return np.asarray(each[between[fields.chain.first[:-1]]])

    def _refuse_loads_at(self, places: Real) -> None:
        margin = NEAR * self.places.model.scene.rope.length
        for point in self.still:
            if (np.abs(places - point[1]) <= margin).any():
                raise SceneError(
                    f"drive and response must not stand where the scene changes, got {point}: what "
                    "moves there would be left of it or right of it"
                )

    def _at_nodes(self, slopes: PairSlopes, weights: Weights, by_p: Complex) -> Iterator[Term]:
        """Yield what stands at nodes and moves there, and hinges."""
        factor, chain, model = self.fields.question.factor, self.fields.chain, self.places.model
        own, of = self._own
        square = np.ix_(of, self._kept, self._kept)
        node, place = slopes.node[:, own], weights.place[:, 0]
        self._refuse_loads_at(model.x[model.chain.first[place != 0]])
        yield slopes.place[:, own, 0], place[of], 1.0
        yield node, weights.node[square], factor[damping.SPRING]
        yield node, weights.mass[square], factor[damping.INERTIA]
        yield node, weights.dashpot[square], factor[damping.DASHPOT]
        yield node, chain.stiffness[chain.term[own]], by_p[damping.SPRING]
        yield node, chain.mass[chain.term[own]], by_p[damping.INERTIA]
        if chain.hinge is not None:
            own, of = own[own < len(chain.element)], of[own < len(chain.element)]
            jump = slopes.jump[:, own]
            yield jump, weights.jump[of][:, self._kept], 1.0
            soft = chain.hinge[chain.term[own]]
            stiff = np.divide(1, soft, out=np.zeros_like(soft), where=soft != 0)
            yield jump, stiff, by_p[damping.SPRING] / factor[damping.SPRING]

    def _on_structures(self, slopes: PairSlopes, weights: Weights, by_p: Complex) -> Iterator[Term]:
        """Yield what the structures give that nodes carry."""
        these, inertia = self._carried, self.fields.question.factor[damping.INERTIA]
        if not len(these):
            return
        mass, stiffness, loss, mass_loss = np.moveaxis(slopes.number, 2, 0)
        heavier = weights.heavier[these]
        yield mass, heavier, inertia
        yield mass_loss, heavier, 1.0
        yield stiffness, weights.stiffer[these], 1.0
        yield loss, weights.damped[these], 1.0
        yield mass, np.ones(len(these)), by_p[damping.INERTIA]
        yield slopes.row, weights.foot[these][..., self._kept], 1.0


def _dot(slopes: Complex, weights: Real) -> Complex:
    """Contract (pairs, .., f) with (..), shape (pairs, f)."""
    pairs, lines = slopes.shape[0], slopes.shape[-1]
    flat: Complex = weights.ravel() @ slopes.reshape(pairs, -1, lines)
    return flat


class Answered(NamedTuple):
    """A question to a component, and of a sum over modes what it was made of."""

    question: Question
    parts: ModalParts | None


@dataclass(frozen=True, eq=False)
class FrequencyRates:
    """How a frequency response changes."""

    model: Compiled  # that was asked
    omega: Real | Complex  # (f,) -i s [rad/s]
    drives: tuple[Point, ...]  # that were asked for
    responses: tuple[Point, ...]  # that were asked for
    answered: Sequence[Answered]  # of the components that take part
    value: Complex  # (drives, asked, f) receptance, of tips of wires that of their roots

    @computed
    def places(self) -> Places:
        """Where spans and stations are."""
        return Places(self.model)

    @computed
    def components(self) -> list[ComponentRates]:
        """Of the questions, of a sum over modes at the lines that its residues come from."""
        still = [p for p in self.drives if not is_end(p)]
        still += [p for p in self.responses if not tip.is_tip(p)]
        return [
            ComponentRates(
                self.places,
                Fields(question if parts is None else parts.lines),
                [point for point in still if moving(point) in question.component],
            )
            for question, parts in self.answered
        ]

    @computed
    def paths(self) -> dict[str, Callable[[], Rate]]:
        """What each number that there are derivatives by does; dampings change factors."""
        by_damping = {name: partial(self._of_damping, *at) for name, at in self._dampings.items()}
        return rates_of(self.places) | by_damping

    @computed
    def _dampings(self) -> dict[str, tuple[int, str]]:
        """Return number and argument of what dampings are made of, by path."""
        dampings = self.model.scene.dampings
        found = {}
        for i, one in enumerate(dampings):
            for item in dataclasses.fields(one):  # type: ignore[arg-type]
                if isinstance(getattr(one, item.name), float):
                    found[f"damping[{i}].{item.name}"] = (i, item.name)
                    if len(dampings) == 1:
                        found[f"damping.{item.name}"] = (i, item.name)
        return found

    def _of_damping(self, number: int, name: str) -> Rate:
        """Return that of the drag along the rope."""
        rate = Rate(self.places)
        rate.drag += damping.drag([self._unit(number, name)]) * dragged(self.model.scene)
        return rate

    def _unit(self, number: int, name: str) -> Damping:
        """Return a damping with one of its numbers 1 and no other: it is in proportion to all."""
        one = self.model.scene.dampings[number]
        floats = [f.name for f in dataclasses.fields(one)]  # type: ignore[arg-type]
        alone = {k: float(k == name) for k in floats if isinstance(getattr(one, k), float)}
        return dataclasses.replace(one, **alone)  # type: ignore[type-var]

    def receptance(self, path: str, seed: int | None = None) -> Complex:
        """Return d(receptance)/dp, with a seed that of numbers which are all a little off."""
        if self.model.chain.rise is not None:
            raise SceneError(
                "elements must be given for derivatives of a response where the tension grows "
                "along the rope, such as compile(elements=64)"
            )
        weights = asked(self.paths, path)().weights(self.places)
        own = [self._unit(*self._dampings[path])] if path in self._dampings else []
        value, components = np.zeros_like(self.value), self.components
        random = None if seed is None else np.random.default_rng(seed)
        if random is not None:
            off = {
                f.name: nudged(getattr(weights, f.name), random)
                for f in dataclasses.fields(weights)
            }
            weights = dataclasses.replace(weights, **off)
            components = [component.nudged(random) for component in components]
        for (question, parts), component in zip(self.answered, components):
            lines = component.fields.question
            by_p = (damping.factors(own, lines.omega) - damping.factors([], lines.omega)).T
            found = component.receptance(weights, by_p)
            if parts is not None:
                own_parts = parts if random is None else parts.nudged(random)
                found = sum_slope(own_parts, found, float(damping.ratios(own, 1)[0]))
            value[self._places_of(question)] = found
        return self._at_tips(weights, own, value, random)

    def _at_tips(
        self,
        weights: Weights,
        own: Sequence[Damping],
        value: Complex,
        random: np.random.Generator | None,
    ) -> Complex:
        """Take roots together to tips, t^T u/e of which both change."""
        if not any(map(tip.is_tip, self.responses)):
            return value
        omega, at_roots = self.omega, self.value
        factor = np.ascontiguousarray(damping.factors(self.model.scene.dampings, omega).T)
        more = (damping.factors(own, omega) - damping.factors([], omega))[:, damping.INERTIA]
        if random is not None:
            factor[damping.INERTIA] *= 1 + OF_WIRES * EPS * random.uniform(-1, 1, len(omega))
            off = random.uniform(-1, 1, (2, *at_roots.shape))
            at_roots = at_roots + self._unsure * (off[0] + 1j * off[1] * (at_roots.imag != 0))
        inertia = factor[damping.INERTIA]
        lighter = np.divide(-more, inertia, out=np.zeros_like(more), where=inertia != 0)
        changed = tip.gather(self.model, self.responses, factor, value)
        at = 0
        for r, point in enumerate(self.responses):
            count = len(tip.tip_of(self.model, point).root) if tip.is_tip(point) else 1
            if tip.is_tip(point):
                root = at_roots[:, at : at + count]
                slope = tip.row_slope(self.model, point, factor, weights, lighter)
                changed[:, r] += np.einsum("cf,dcf->df", slope, root)
            at += count
        return changed

    @computed
    def _unsure(self) -> Real:
        """What of the value is rounding, infinite where there are no wider numbers."""
        error = np.full(self.value.shape, np.inf)
        for question, _ in self.answered:
            at = self._places_of(question)
            found = measured(question, self.value[at])
            error[at] = np.inf if found is None else found.error
        return error

    def _places_of(self, question: Question) -> Any:
        """Return what of the value a question is about."""
        asked = self.drives, tip.spread(self.model, self.responses)
        return np.ix_(
            *([k for k, p in enumerate(of) if moving(p) in question.component] for of in asked)
        )

    def of(self, path: str, quantity: str) -> Complex:
        """Return the derivative of a quantity, shape (drives, responses, f)."""
        return self.receptance(path) * (1j * self.omega) ** QUANTITIES[quantity]

    def error(self, path: str, quantity: str) -> Real:
        """Return the error of that, shape (drives, responses, f): see docs/theory/errors.md."""
        value = self.receptance(path)
        every = np.stack([self.receptance(path, seed) for seed in range(RUNS)])
        error = np.nan_to_num(apart(value, every), nan=np.inf)
        return np.asarray(error * np.abs(self.omega) ** QUANTITIES[quantity])
