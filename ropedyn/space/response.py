"""The frequency response of a rope on an axis."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.answer import Cost
from ..base.array import Complex, Index, Real
from ..base.computed import Late, computed
from ..base.errors import SceneError, SolveError
from ..base.unit import QUANTITIES, WIRE
from ..chain.port import Point
from ..response.frf import FRF, MeshOfResponse, RoundingOfResponse
from ..scene import damping
from ..scene.parts.broken_wire import BrokenWire
from ..scene.scene import Scene
from .assembly import Assembly, LoadedFields, assemble, bound, foot_of
from .compile import finer_rope, method_of
from .rope import SIX, Factors, SpaceRope

AT_ONCE = 128  # That are assembled together.


def checked_points(
    scene: Scene, given: Any, name: str, *, tips: bool = False
) -> tuple[tuple[Point, ...], bool]:
    """Return one or several points, perhaps tips of wires, and whether a list was given."""
    several = isinstance(given, (list, tuple)) and len(given) > 0 and not isinstance(given[0], str)
    found = []
    for k, one in enumerate(given if several else (given,)):
        called = f"{name}[{k}]" if several else name
        if check.is_end(one):
            raise SceneError(f"{called} must not be the motion of an end on an axis, got {one!r}")
        own = scene.coordinates, scene.rope.length
        found.append(check.point(one, called, *own, wires=wires_of(scene) if tips else None))
    return tuple(found), several


def wires_of(scene: Scene) -> int:
    """Return how many broken wires it has."""
    return sum(isinstance(part, BrokenWire) for part in scene.parts)


def solve_frf(
    scene: Scene, rope: SpaceRope, frequency: Any, *, drive: Any, response: Any, quantity: str
) -> FRF:
    """Compute the frequency response; see `SpaceModel.frf`."""
    check.one_of(quantity, "quantity", QUANTITIES)
    f = check.frequencies(frequency)
    drives, several = checked_points(scene, drive, "drive")
    given = response is not None
    responses = checked_points(scene, response, "response", tips=True)[0] if given else drives
    asked = Request.of(scene, rope, f, drives, responses)
    receptance = asked.receptance()
    power = (2j * math.pi * f) ** QUANTITIES[quantity]
    value = (receptance * power)[slice(None) if several else 0]

    def rounding() -> RoundingOfResponse:
        limit = (asked.rounding() * np.abs(power))[slice(None) if several else 0]
        return RoundingOfResponse.of(value, limit)

    def mesh() -> MeshOfResponse:
        finer = finer_rope(scene, rope)
        if finer is None:
            return MeshOfResponse(np.zeros(value.shape))
        other = Request.of(scene, finer, f, drives, responses).receptance()
        size = np.abs(other)
        off = np.abs(receptance - other)
        error = np.divide(off, size, where=size > 0, out=np.where(off > 0, np.inf, 0.0))
        return MeshOfResponse(error[slice(None) if several else 0])

    return FRF(
        drive=drives,
        response=responses,
        quantity=quantity,
        frequency=f,
        value=value,
        cost=Cost(
            method_of(scene),
            len(rope.length),
            rope.unknowns,
            factorisations=len(f) * len(asked.components),
        ),
        rounding=Late(rounding),
        mesh=mesh,
        solve_rates=_refuse_rates,
    )


def _refuse_rates() -> Any:
    raise SceneError("derivatives are not carried for a rope on an axis or its catenary")


class AskedPart(NamedTuple):
    """What of a request moves together."""

    which: Index  # (1,)
    own: list[str]  # its coordinates
    pairs: Any  # its drives and responses in the answer
    node: list[Index]  # of drives and of responses
    point: list[list[Point]]


@dataclass(frozen=True, eq=False)
class Request:
    """What is asked for: a rope with nodes at the points, and the lines."""

    rope: SpaceRope
    factors: Factors
    frequency: Real
    node: tuple[Index, Index]  # of drives and of responses
    point: tuple[tuple[Point, ...], tuple[Point, ...]]

    @classmethod
    def of(
        cls,
        scene: Scene,
        rope: SpaceRope,
        frequency: Real,
        drives: Sequence[Point],
        responses: Sequence[Point],
    ) -> Request:
        """Cut the rope at the points."""
        omega = 2 * math.pi * frequency
        by = damping.factors(scene.dampings, omega).T
        factors = Factors(*by, *np.ones((1, len(omega)), dtype=np.complex128))
        points, both = (tuple(drives), tuple(responses)), len(drives)
        places = [
            rope.x[rope.carried[int(at)].node] if c == WIRE else at * rope.longer
            for c, at in (*drives, *responses)
        ]
        cut, node = rope.cut(np.array(places), check.NEAR * scene.rope.length)
        return cls(cut, factors, frequency, (node[:both], node[both:]), points)

    def receptance(self) -> Complex:
        """Return motion per unit force, shape (drives, responses, f)."""
        value = np.zeros(self._shape, dtype=np.complex128)
        for side, lines, system in self._systems():
            motion = self._solved(system, side, lines, 0).u
            row, _ = self._rows(system, side, lines, 1)
            seen = np.einsum("lrc,lrcd->drl", row, motion[:, system.node[side.node[1]]])
            value[(*side.pairs, lines)] = seen
        return value

    def rounding(self) -> Real:
        """Bound what rounding does to it: |x|^T |dA| |y| of motion by drives and responses."""
        limit = np.zeros(self._shape)
        for side, lines, system in self._systems():
            one, other = (self._solved(system, side, lines, i) for i in (0, 1))
            _, doubt = self._rows(system, side, lines, 1)
            moved = np.abs(one.u[:, system.node[side.node[1]]])
            seen = np.einsum("lrc,lrcd->drl", doubt, moved)
            limit[(*side.pairs, lines)] = bound(system, one, other).transpose(1, 2, 0) + seen
        return limit

    @property
    def _shape(self) -> tuple[int, int, int]:
        return len(self.node[0]), len(self.node[1]), len(self.frequency)

    @computed
    def components(self) -> list[AskedPart]:
        """Those that are driven and watched."""
        found = []
        for k, along in enumerate(self.rope.own):
            own = [SIX[c] for c in along]
            # where a wire is, all six are one component
            at = [[i for i, (c, _) in enumerate(of) if c in (*own, WIRE)] for of in self.point]
            if all(at):
                node = [one[there] for one, there in zip(self.node, at)]
                point = [[of[i] for i in there] for of, there in zip(self.point, at)]
                found.append(AskedPart(np.array([k]), own, np.ix_(*at), node, point))
        return found

    def _systems(self) -> Iterator[tuple[AskedPart, slice, Assembly]]:
        for side in self.components:
            for first in range(0, len(self.frequency), AT_ONCE):
                lines = slice(first, first + AT_ONCE)
                factors = Factors(*(one[lines] for one in self.factors))
                z = self.rope.scale(side.which, np.abs(factors.inertia))
                yield side, lines, assemble(self.rope, side.which, factors, z)

    def _solved(self, system: Assembly, side: AskedPart, lines: slice, end: int) -> LoadedFields:
        """Return motion and force of unit loads on drives (0) or responses (1)."""
        node, n, f = system.node[side.node[end]], len(system.D), self.frequency[lines]
        load = np.zeros((n, system.parts + 1, system.width, len(node)), dtype=np.complex128)
        row, _ = self._rows(system, side, lines, end)
        load[:, node, :, np.arange(len(node))] = row.swapaxes(0, 1)
        load[system.held] = 0.0
        none = np.zeros((n, system.parts, system.width, len(node)))
        x = system.respond(system.together(load, none))
        singular = np.flatnonzero(~np.isfinite(x).all(axis=(1, 2)))
        if len(singular):
            raise SolveError(
                f"{f[singular[0]]:g} Hz lies on an undamped resonance: there is no finite response"
            )
        return LoadedFields(*system.apart(x), load)

    def _rows(
        self, system: Assembly, side: AskedPart, lines: slice, end: int
    ) -> tuple[Complex, Real]:
        """Return what points see of their nodes, (n, points, width), and its rounding."""
        points = side.point[end]
        row = np.zeros((len(system.z), len(points), system.width), dtype=np.complex128)
        doubt = np.zeros(row.shape)
        factors = Factors(*(one[lines] for one in self.factors))
        for k, (coordinate, at) in enumerate(points):
            if coordinate == WIRE:
                foot = foot_of(self.rope.carried[int(at)], factors)
                row[:, k], doubt[:, k] = foot.seen * system.z, foot.seen_doubt * system.z
            else:
                along = side.own.index(coordinate)
                row[:, k, along] = system.z[:, along]
        return row, doubt
