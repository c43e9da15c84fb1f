"""What of a rope has a closed form, and its rows in the core."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.array import Real
from ..scene.end import end_of
from ..scene.path import value_at
from ..scene.scene import Scene
from ..scene.tension import Tension
from .rows import Answered

Column = NDArray[np.int32]
"""Where numbers stand in a row, -1 where they are fixed."""

_BENT = ("length", "linear_density", "tension", "bending_stiffness")
_STRING = ("length", "linear_density", "tension")
_TWISTED = ("length", "polar_inertia", "torsional_stiffness")
_STRETCHED = ("length", "linear_density", "axial_stiffness")
"""Numbers of what has a closed form, before those of its springs, in the order of the core."""


class ClosedSpan(NamedTuple):
    """A component of the rope that has a closed form, its numbers as the core takes them."""

    kind: str
    fixed: tuple[float, ...]
    """Numbers, where no column has them."""
    column: tuple[int, ...]
    """Where they stand in a row of values, -1 where nowhere."""


Spans = tuple[tuple[str, Real, Column], ...]
"""Spans as the core takes them."""


def in_core(spans: Sequence[ClosedSpan]) -> Spans:
    """Return spans as the core takes them."""
    return tuple((one.kind, np.array(one.fixed), np.array(one.column, np.int32)) for one in spans)


def closed_spans(scene: Scene, paths: tuple[str, ...]) -> tuple[ClosedSpan, ...]:
    """Return the components in closed form, nothing where one has none."""
    rope, tension, ends = scene.rope, scene.tension, [end_of(end) for end in scene.ends]
    stretching = isinstance(tension, Tension) and tension.stretching
    coupled = bool(rope.lay_coupling or rope.lay_slope or rope.rotary_inertia)
    if scene.parts or scene.gravity or stretching or coupled or any(end.mass for end in ends):
        return ()
    if rope.torsional_stiffness is not None and not rope.polar_inertia:
        return ()
    spans = []
    if rope.bending_stiffness is not None:
        spans.append(_span(scene, paths, "bent", _BENT, ("z", "beta")))
    elif scene.mean_tension or "tension" in paths:
        spans.append(_span(scene, paths, "plain", _STRING, ("z",)))
    if rope.torsional_stiffness is not None:
        spans.append(_span(scene, paths, "plain", _TWISTED, ("alpha",)))
    if rope.axial_stiffness is not None:
        spans.append(_span(scene, paths, "plain", _STRETCHED, ("x",)))
    used = {column for span in spans for column in span.column}
    return tuple(spans) if used >= set(range(len(paths))) else ()


def _span(
    scene: Scene,
    paths: tuple[str, ...],
    kind: str,
    names: tuple[str, ...],
    coordinates: tuple[str, ...],
) -> ClosedSpan:
    fixed = [value_at(scene, name) for name in names]
    where = list(names)
    for at, end in enumerate(map(end_of, scene.ends)):
        for c in coordinates:
            fixed.append(np.inf if end.holds(c) else end.spring.get(c, 0.0))
            where.append(f"ends[{at}].spring.{c}")
    column = [paths.index(path) if path in paths else -1 for path in where]
    return ClosedSpan(kind, tuple(fixed), tuple(column))


def closed_modes(spans: Spans, number: int, derivative: bool, rows: Real) -> Answered:
    """Find the modes of the rows that are certified."""
    found = [_core.closed_modes(k, rows, f, c, number, derivative) for k, f, c in spans]
    certified = found[0][3]
    if len(found) > 1:
        certified = np.logical_and.reduce([one[3] for one in found])
    at = np.flatnonzero(certified)
    omega, error, slope, _ = found[0]
    if len(found) > 1:
        omega, error, slope = _lowest(found, number)
    if len(at) < len(rows):
        omega, error, slope = omega[at], error[at], None if slope is None else slope[at]
    frequency = omega / (2 * np.pi)
    error = frequency * (error + np.finfo(float).eps)
    answer = frequency, omega * omega, error, certified[at]
    return Answered(at, answer if slope is None else (*answer, slope * frequency[..., None]), {})


def _lowest(found: Sequence[tuple[Any, ...]], number: int) -> tuple[Real, Real, Real | None]:
    """Return the lowest frequencies of several components, and what goes with them."""
    omega, error = (np.concatenate([one[k] for one in found], axis=1) for k in (0, 1))
    order = np.argsort(omega, axis=1, kind="stable")[:, :number]
    omega, error = (np.take_along_axis(one, order, axis=1) for one in (omega, error))
    if found[0][2] is None:
        return omega, error, None
    slope = np.concatenate([one[2] for one in found], axis=1)
    return omega, error, np.take_along_axis(slope, order[..., None], axis=1)


def closed_counts(spans: Spans, omega: float, rows: Real) -> Answered:
    """Count the modes of the rows where that is certain."""
    counts = np.array([_core.closed_count(k, rows, f, c, omega) for k, f, c in spans])
    at = np.flatnonzero((counts >= 0).all(axis=0))
    return Answered(at, (counts.sum(axis=0)[at],), {})
