"""How motion begins: loads that are let go and impulses, also from shapes and velocities."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.errors import SceneError
from ..chain.chain import TRANSVERSE
from ..chain.compiled import Compiled
from ..chain.port import Point
from ..response.critical import refuse_critical
from ..response.deflection import Deflection, checked_loads
from .line.transfer import Transfer

Shape = Callable[[Any], Any]
"""What a user gives: motion at a position x [m]."""
PARTS = (128, 64, 32)
"""Continuous spans take a shape at so many places, and at fewer to tell the error."""
ROUND = 1e-9  # A shape is 0 where it is this part of its largest value,
FLAT = 1e-3  # and has no slope where it is this part of that over the length.
STEP = 1e-6  # Of a slope, over the length.


class Begun(NamedTuple):
    """What acts at the first time; `coarse` is what the shapes are with fewer places."""

    given: dict[Point, float]
    coarse: Begun | None = None


def released(model: Compiled, start: Any) -> Begun:
    """Return the loads that are let go [N, N m]."""
    if start is None:
        return Begun({})
    if isinstance(start, Deflection):
        return Begun(dict(start.load))
    shapes = _shapes(model, start, "start")
    if not shapes:
        loads = checked_loads(model, start, "start")
        refuse_critical(model, loads, "start takes Model.static(.., unstable=True) all the same")
        return Begun(loads)
    _refuse_support(model, shapes)
    return _at_places(model, lambda parts: _loads(model, shapes, parts))


def kicked(model: Compiled, velocity: Any) -> Begun:
    """Return the impulses that begin motion [N s, N m s]."""
    if velocity is None:
        return Begun({})
    shapes = _shapes(model, velocity, "velocity")
    if not shapes:
        return Begun(checked_loads(model, velocity, "velocity", over=" s"))
    return _at_places(model, lambda parts: _impulses(model, shapes, parts))


def _at_places(model: Compiled, at: Callable[[int], dict[Point, float]]) -> Begun:
    if model.element != "continuous":
        return Begun(at(0))
    fine, coarse, coarser = map(at, PARTS)
    return Begun(fine, Begun(coarse, Begun(coarser)))


def _shapes(model: Compiled, given: Any, name: str) -> dict[str, Shape]:
    """Return the function of each coordinate, none where loads are given."""
    if callable(given):
        given = {"z": given}
    if not isinstance(given, Mapping) or not any(map(callable, given.values())):
        return {}
    for coordinate, shape in given.items():
        check.one_of(coordinate, f"{name}'s coordinate", check.COORDINATES)
        if coordinate not in model.coordinates:
            raise check.absent(f"{name}'s coordinate must be one", model.coordinates, coordinate)
        check.instance(shape, f"{name}[{coordinate!r}]", Callable, "a function of x")  # type: ignore[arg-type]
    return dict(given)


def _values(shape: Shape, x: Real, name: str) -> Real:
    """Return a shape at places."""
    return check.numbers([shape(at) for at in x.tolist()], f"{name} at x", "m, rad, or these per s")


def _places(model: Compiled, parts: int) -> Real:
    """Return the nodes, of continuous spans so many parts of the rope as well."""
    x = model.x
    if not parts:
        return x
    length = float(x[-1])
    pieces = np.maximum(np.ceil(np.diff(x) / length * parts), 1).astype(np.intp)
    return np.concatenate(
        [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(x[:-1], x[1:], pieces)] + [x[-1:]]
    )


def _held(model: Compiled, coordinate: str) -> Real:
    """Return where a coordinate is held [m]."""
    at = model.coordinates.index(coordinate)
    return model.x[model.chain.held[model.chain.term_of][:, at] != 0]


def _refuse_support(model: Compiled, shapes: Mapping[str, Shape]) -> None:
    """Refuse what supports do not let."""
    length = float(model.x[-1])
    for coordinate, shape in shapes.items():
        most = np.abs(_values(shape, _places(model, PARTS[0]), "start")).max()
        for x in _held(model, coordinate):
            value = float(_values(shape, np.array([x]), "start")[0])
            if abs(value) > ROUND * most:
                raise SceneError(
                    f"start must be 0 where {coordinate} is held, got {value!r} at {float(x)!r} m"
                )
        turns = dict(TRANSVERSE).get(coordinate)
        if turns in model.coordinates:
            for x in _held(model, turns):
                slope = float(_slope(shape, np.array([x]), length)[0])
                if abs(slope) * length > FLAT * most:
                    raise SceneError(
                        f"start must have no slope where {turns} is held, got "
                        f"{slope:.3g} at {float(x)!r} m"
                    )


def _slope(shape: Shape, x: Real, length: float) -> Real:
    """Return the slope of a shape, one-sided at the ends."""
    left, right = np.maximum(x - STEP * length, 0.0), np.minimum(x + STEP * length, length)
    rise = _values(shape, right, "shape") - _values(shape, left, "shape")
    return np.asarray(rise / (right - left))


def _loads(model: Compiled, shapes: Mapping[str, Shape], parts: int) -> dict[Point, float]:
    """Return the loads under which the rope rests in these shapes at the places."""
    points: list[Point] = []
    value: list[float] = []
    for coordinate, shape in shapes.items():
        x = np.setdiff1d(_places(model, parts), _held(model, coordinate))
        points += [(coordinate, float(at)) for at in x]
        value += _values(shape, x, "start").tolist()
    asked = tuple(points)
    still = Transfer(model, asked, asked).at(np.zeros(1, dtype=np.complex128))
    compliance = still[..., 0].real
    force = np.linalg.solve(compliance, np.array(value))
    return dict(zip(points, force.tolist()))


def _impulses(model: Compiled, shapes: Mapping[str, Shape], parts: int) -> dict[Point, float]:
    """Return the momentum of these velocities, gathered at the places."""
    chain, names = model.chain, model.coordinates
    length = float(model.x[-1])
    moves = {name: shapes[name] for name in names if name in shapes}

    def rate(x: Real) -> Real:
        each = [_values(moves[c], x, "velocity") if c in moves else 0 * x for c in names]
        for z, beta in TRANSVERSE:
            if z in moves and beta in names and beta not in moves:
                each[names.index(beta)] = _slope(moves[z], x, length)
        return np.stack(each, axis=1)

    momentum = np.einsum("nij,nj->ni", chain.mass[chain.term_of], rate(model.x))
    gathered = {(c, float(x)): p for x, row in zip(model.x, momentum) for c, p in zip(names, row)}
    for at, some in _along(model, rate, parts):
        for c, p in zip(names, some):
            gathered[c, at] = gathered.get((c, at), 0.0) + p
    held = {(c, float(x)) for c in names for x in _held(model, c)}
    return {point: float(p) for point, p in gathered.items() if p != 0 and point not in held}


def _along(
    model: Compiled, rate: Callable[[Real], Real], parts: int
) -> Iterator[tuple[float, Real]]:
    """Yield the momentum of what spans have along them, by Gauss's rule between the places."""
    chain = model.chain
    if chain.inertia is None or not parts:
        return
    node, weight = np.polynomial.legendre.leggauss(2)
    x = _places(model, parts)
    for a, b in pairwise(x.tolist()):
        element = int(np.searchsorted(model.x, (a + b) / 2)) - 1
        per_length = chain.inertia[chain.element_of[element]]
        at = a + (b - a) * (node + 1) / 2
        for one, share, moved in zip(at, weight * (b - a) / 2, rate(at)):
            yield float(one), share * per_length * moved
