"""What of a family has a closed form, and its rows in the core."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ..base.array import Flags, Real
from ..base.errors import RopedynError
from ..chain.chain import Chain
from ..chain.compiled import Compiled
from ..chain.rate import Places, rates_of
from ..chain.spans import Spans, rates_of_spans, spans_of
from ..eigen.closed import ClosedModes, ClosedSpans, closed_form
from .rows import Filled
from .template import SPRING, Template

PROBE = 2.0**-10
"""By so much of themselves values are changed to see whether numbers follow from them linearly."""


class Component(NamedTuple):
    """A component in closed form whose numbers are linear in the values of a row."""

    coordinates: tuple[str, ...]  # what moves in it
    chain: Chain  # of the scene, damping included
    spans: Spans  # of the scene
    form: ClosedSpans
    fixed: Real  # (numbers,) what they are where all values are 0
    jacobian: Real  # (numbers, values)

    def numbers(self, rows: Real) -> Real:
        """Return the numbers of each row, shape (rows, numbers)."""
        found = np.tile(self.fixed, (len(rows), 1))
        for j, c in zip(*np.nonzero(self.jacobian)):
            # an infinite value of another number must not be multiplied by 0
            found[:, j] += self.jacobian[j, c] * rows[:, c]
        return found

    def parted(self, numbers: Real) -> tuple[Real, Real]:
        """Return rows of numbers as those of spans and of stations, a matrix each."""
        spans, stations = np.split(numbers, [self.spans.span.size], axis=1)
        return (
            spans.reshape(-1, *self.spans.span.shape),
            stations.reshape(-1, *self.spans.station.shape),
        )

    def modes(self, rows: Real, number: int, *, sloped: bool) -> ClosedModes:
        """Find the lowest modes of each row."""
        return self.form.modes(self.numbers(rows), number, self.jacobian if sloped else None)


def components_of(template: Template) -> tuple[Component, ...]:
    """Return what moves in closed form: nothing where some does not, or a path does not act."""
    elements = template.elements is not None or template.element not in (None, "continuous")
    if elements or template.scene.is_spatial:
        return ()
    row = template.row
    probe = row + PROBE * np.arange(1, len(row) + 1) * row
    try:
        here, there = (_linearised(template, one) for one in (row, probe))
    except RopedynError:
        return ()
    if here is None or there is None or len(here) != len(there):
        return ()
    for one, other in zip(here, there):
        if not np.array_equal(one.jacobian, other.jacobian):
            return ()
    acting = np.any([one.jacobian.any(axis=0) for one in here], axis=0)
    return here if acting.all() else ()


def _linearised(template: Template, row: Real) -> tuple[Component, ...] | None:
    """Return the components at a row, None where one has no closed form."""
    model = template.compiled(row)
    places = Places(model)
    rates = rates_of(places)
    found = []
    for names in model.components:
        chain = model.chain.only(names)
        spans = spans_of(chain.undamped)
        if spans is None:
            return None
        columns = []
        for path in template.paths:
            if end := SPRING.fullmatch(path):
                columns.append(_of_spring(model, names, int(end[1]), end[2]))
            elif path in rates:
                columns.append(rates_of_spans(rates[path](), places, names))
            else:
                return None
        jacobian = np.stack(columns, axis=1)
        number = spans.number
        for j, c in zip(*np.nonzero(jacobian)):
            number[j] = 0.0 if np.isinf(row[c]) else number[j] - jacobian[j, c] * row[c]
        varied: Flags = np.any(jacobian, axis=1)
        form = closed_form(spans, varied)
        found.append(Component(names, chain, spans, form, number, jacobian))
    return tuple(found)


def _of_spring(model: Compiled, names: Sequence[str], end: int, coordinate: str) -> Real:
    """Return how fast numbers change with a spring at an end, whether there is one or not."""
    spans, width = len(model.x) - 1, len(names)
    rate = np.zeros((spans + 1, 2 * width))
    if coordinate in names:
        rate[-end, width + names.index(coordinate)] = 1.0
    return np.append(np.zeros(spans * (4 if width == 2 else 3)), rate)


def closed_modes(
    components: Sequence[Component], number: int, derivative: bool, rows: Real
) -> Filled:
    """Find the modes of the rows that are certified."""
    found = [one.modes(rows, number, sloped=derivative) for one in components]
    omega, error, slope = _lowest(found, number)
    certified = np.logical_and.reduce([one.certified for one in found])
    at = np.flatnonzero(certified)
    if len(at) < len(rows):
        omega, error, slope = omega[at], error[at], None if slope is None else slope[at]
    frequency = omega / (2 * np.pi)
    error = frequency * (error + np.finfo(float).eps)
    answer = frequency, omega * omega, error, certified[at]
    return Filled(at, answer if slope is None else (*answer, slope * frequency[..., None]), {})


def _lowest(found: Sequence[ClosedModes], number: int) -> tuple[Real, Real, Real | None]:
    """Return the lowest frequencies of several components, and what goes with them."""
    if len(found) == 1:
        return found[0][:3]
    omega, error = (np.concatenate([one[k] for one in found], axis=1) for k in (0, 1))
    order = np.argsort(omega, axis=1, kind="stable")[:, :number]
    omega, error = (np.take_along_axis(one, order, axis=1) for one in (omega, error))
    slopes = [one.slope for one in found if one.slope is not None]
    if not slopes:
        return omega, error, None
    slope = np.concatenate(slopes, axis=1)
    return omega, error, np.take_along_axis(slope, order[..., None], axis=1)


def closed_counts(components: Sequence[Component], omega: float, rows: Real) -> Filled:
    """Count the modes of the rows where that is certain."""
    counts = np.array([one.form.counts(one.numbers(rows), omega) for one in components])
    at = np.flatnonzero((counts >= 0).all(axis=0))
    return Filled(at, (counts.sum(axis=0)[at],), {})
