"""How the tips of broken wires move, from how their roots do."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..base.array import Complex, Flags, Real
from ..base.unit import WIRE
from ..scene.parts.broken_wire import BrokenWire
from ..scene.parts.part import standing
from .chain import ATTACHED
from .compiled import Compiled
from .port import Point, locate, moving
from .rate import Weights
from .wide import tip_rows


class Tip(NamedTuple):
    """A tip: what is asked in its place."""

    structure: int  # of the model's chain
    root: list[Point]  # the coordinates that move its root


EPS = float(np.finfo(float).eps)


def is_tip(point: Point) -> bool:
    """Whether the point asks for the tip of a wire, such as ("wire", 0)."""
    return point[0] == WIRE


def tip_of(model: Compiled, point: Point) -> Tip:
    """Return the tip of the wire with this number among the broken wires of the scene."""
    chain, scene = model.chain, model.scene
    assert chain.attached_kind is not None
    assert chain.attached_row is not None
    kind = ATTACHED.index(BrokenWire.kind)
    wires = (p for p in standing(scene.parts) if isinstance(p, BrokenWire))
    nodes = [locate(model.x, wire.x)[0] for wire in wires]
    # the chain has them by their place, those of one place as the scene has them
    order = sorted(range(len(nodes)), key=nodes.__getitem__)
    rank = order.index(int(point[1]))
    each = 2 if "y" in model.coordinates else 1  # that along z is the first
    structure = int(np.flatnonzero(chain.attached_kind == kind)[each * rank])
    node = chain.feet[structure]
    moved = chain.attached_row[structure].any(axis=0)
    root = [(c, float(model.x[node])) for c, moves in zip(model.coordinates, moved) if moves]
    return Tip(structure, root)


def carrier(model: Compiled, point: Point) -> str:
    """Return the coordinate of a point, of a tip one that moves its root."""
    return moving(tip_of(model, point).root[0] if is_tip(point) else point)


def _tip(model: Compiled, structure: int, factor: Complex) -> Complex:
    """Ask the core in the plane of z, where a structure may have another number."""
    plane, kinds = model.chain.planes[0], model.chain.attached_kind
    assert kinds is not None
    numbers = np.arange(len(kinds))[plane.carried]
    return _core.tip(plane.chain, int(numbers.searchsorted(structure)), factor)


def root_rows(model: Compiled, tip: Tip, factor: Complex) -> Complex:
    """Return the motion of a tip per motion of its root, (3, roots, f), see `_core.tip`."""
    assert model.chain.attached_row is not None
    kept = [model.coordinates.index(c) for c, _ in tip.root]
    row = model.chain.attached_row[tip.structure][:, kept]
    return np.einsum("klf,lc->kcf", _tip(model, tip.structure, factor), row)


def row_slope(
    model: Compiled, point: Point, factor: Complex, weights: Weights, stiffer: Complex
) -> Complex:
    """Return how fast the motion of a tip per motion of its root changes, (roots, f).

    The wire is `stiffer`, (f,), relative, beside what the weights say.
    """
    assert model.chain.attached_row is not None
    k, root = tip_of(model, point)
    kept = [model.coordinates.index(c) for c, _ in root]
    own, by_stiffness, by_ratio = _tip(model, k, factor)
    change = by_stiffness * (weights.stiffer[k] - weights.heavier[k] + stiffer)
    change = change + by_ratio * weights.damped[k]
    moved = np.einsum("lf,lc->cf", own, weights.moves[k][:, kept])
    slope: Complex = moved + np.einsum("lf,lc->cf", change, model.chain.attached_row[k][:, kept])
    return slope


def spread(model: Compiled, responses: Sequence[Point]) -> list[Point]:
    """Return the responses with the motion of the root in place of that of each tip."""
    asked: list[Point] = []
    for point in responses:
        asked += tip_of(model, point).root if is_tip(point) else [point]
    return asked


def gather(model: Compiled, responses: Sequence[Point], factor: Complex, value: Complex) -> Complex:
    """Return what was asked for from the answers to `spread`."""
    return _gathered(model, responses, value, lambda tip: root_rows(model, tip, factor)[0])


def gather_error(
    model: Compiled, responses: Sequence[Point], factor: Complex, value: Complex, error: Real
) -> Real:
    """Return the absolute errors of what `gather` returns."""
    told = _gathered(model, responses, error, lambda tip: np.abs(root_rows(model, tip, factor)[0]))
    if not any(map(is_tip, responses)):
        return told
    size = np.abs(value)
    rows = _gathered(model, responses, size, lambda tip: _row_error(model, tip, factor))
    tips = np.array([is_tip(point) for point in responses])
    return told + rows * tips[:, None]


def _row_error(model: Compiled, tip: Tip, factor: Complex) -> Real:
    """Return the absolute error of the motion of a tip per motion of its root, (roots, f)."""
    row = root_rows(model, tip, factor)[0]
    kept = [model.coordinates.index(c) for c, _ in tip.root]
    # factors are numbers that a frequency rounds to
    wide = [tip_rows(model, tip.structure, factor * more, kept) for more in (1, 1 + 4 * EPS)]
    if wide[0] is None or wide[1] is None:
        return 8 * EPS * np.abs(row)
    off = np.abs(row - wide[0]) + np.abs(wide[1] - wide[0])
    return np.asarray(off.astype(float) + 2 * EPS * np.abs(row))


def gather_flags(model: Compiled, responses: Sequence[Point], flags: Flags) -> Flags:
    """Return whether all that `gather` makes an answer of is so."""
    wrong = _gathered(model, responses, (~flags).astype(float), lambda tip: np.ones(1)[:, None])
    return np.asarray(wrong == 0)


def _gathered(
    model: Compiled,
    responses: Sequence[Point],
    told: NDArray[Any],
    row_of: Callable[[Tip], NDArray[Any]],
) -> NDArray[Any]:
    values = np.zeros((len(told), len(responses), told.shape[2]), dtype=told.dtype)
    at = 0
    for r, point in enumerate(responses):
        if not is_tip(point):
            values[:, r] = told[:, at]
            at += 1
            continue
        tip = tip_of(model, point)
        part = slice(at, at + len(tip.root))
        at = part.stop
        values[:, r] = (row_of(tip) * told[:, part]).sum(axis=1)
    return values
