"""The frequency response of a rope on an axis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.answer import Cost
from ..base.array import Complex, Index, Real
from ..base.computed import Late
from ..base.errors import SceneError, SolveError
from ..base.unit import QUANTITIES
from ..chain.port import Point
from ..response.frf import FRF, MeshOfResponse, RoundingOfResponse
from ..scene import damping
from ..scene.scene import Scene
from .assembly import Assembly, Singular, assemble
from .compile import finer_rope
from .rope import SIX, Factors, SpaceRope
from .spectrum import ROUNDINGS

AT_ONCE = 128  # That are assembled together.


def checked_points(scene: Scene, given: Any, name: str) -> tuple[tuple[Point, ...], bool]:
    """Return one or several points, and whether a list of them was given."""
    several = isinstance(given, (list, tuple)) and len(given) > 0 and not isinstance(given[0], str)
    found = []
    for k, one in enumerate(given if several else (given,)):
        called = f"{name}[{k}]" if several else name
        if check.is_end(one):
            raise SceneError(f"{called} must not be the motion of an end on an axis, got {one!r}")
        found.append(check.point(one, called, scene.coordinates, scene.rope.length))
    return tuple(found), several


def solve_frf(
    scene: Scene, rope: SpaceRope, frequency: Any, *, drive: Any, response: Any, quantity: str
) -> FRF:
    """Compute the frequency response; see `SpaceModel.frf`."""
    check.one_of(quantity, "quantity", QUANTITIES)
    f = check.frequencies(frequency)
    drives, several = checked_points(scene, drive, "drive")
    given = response is not None
    responses = checked_points(scene, response, "response")[0] if given else drives
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
            "sweep",
            len(rope.length),
            rope.unknowns,
            factorisations=len(f),
        ),
        rounding=Late(rounding),
        mesh=mesh,
        solve_rates=_refuse_rates,
    )


def _refuse_rates() -> Any:
    raise SceneError("derivatives are not carried for a rope on an axis: the rope must be straight")


class Request(NamedTuple):
    """What is asked for: a rope with nodes at the points, and the lines."""

    rope: SpaceRope
    factors: Factors
    frequency: Real
    node: tuple[Index, Index]  # of drives and of responses
    coordinate: tuple[Index, Index]

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
        factors = Factors(*damping.factors(scene.dampings, omega).T)
        places = np.array([at for _, at in (*drives, *responses)])
        cut, node = rope.cut(places, check.NEAR * scene.rope.length)
        along = np.array([SIX.index(c) for c, _ in (*drives, *responses)])
        both = len(drives)
        return cls(
            cut, factors, frequency, (node[:both], node[both:]), (along[:both], along[both:])
        )

    def receptance(self) -> Complex:
        """Return motion per unit force, shape (drives, responses, f)."""
        shape = len(self.node[0]), len(self.node[1]), len(self.frequency)
        value = np.zeros(shape, dtype=np.complex128)
        for lines, system in self._systems():
            motion, _ = self._solved(system, lines, 0)
            value[:, :, lines] = self._seen(system, motion).transpose(2, 1, 0)
        return value

    def rounding(self) -> Real:
        """Estimate what rounding does to it: |x|^T |dA| |y| of motion by drives and responses."""
        limit = np.zeros((len(self.node[0]), len(self.node[1]), len(self.frequency)))
        for lines, system in self._systems():
            one, other = (self._solved(system, lines, i) for i in (0, 1))
            limit[:, :, lines] = bound(system, one, other).transpose(1, 2, 0)
        return limit

    def _systems(self) -> Any:
        for first in range(0, len(self.frequency), AT_ONCE):
            lines = slice(first, first + AT_ONCE)
            factors = Factors(*(one[lines] for one in self.factors))
            yield lines, assemble(self.rope, factors, self.rope.scale(np.abs(factors.inertia)))

    def _solved(self, system: Assembly, lines: slice, side: int) -> tuple[Complex, Complex]:
        """Return motion and force of unit loads on drives (0) or responses (1)."""
        node, along = system.node[self.node[side]], self.coordinate[side]
        n, f = len(system.D), self.frequency[lines]
        load = np.zeros((n, system.parts + 1, 6, len(node)), dtype=np.complex128)
        load[:, node, along, np.arange(len(node))] = system.z[:, along]
        load[:, system.held] = 0.0
        none = np.zeros((n, system.parts, 6, len(node)))
        try:
            x = system.factored().solve(system.together(load, none))
            singular = np.flatnonzero(~np.isfinite(x).all(axis=(1, 2)))
        except Singular as error:
            singular = np.array([error.line])
        if len(singular):
            raise SolveError(
                f"{f[singular[0]]:g} Hz lies on an undamped resonance: there is no finite response"
            )
        return system.apart(x)

    def _seen(self, system: Assembly, motion: Complex) -> Complex:
        node, along = system.node[self.node[1]], self.coordinate[1]
        seen: Complex = motion[:, node, along] * system.z[:, along][:, :, None]
        return seen


def bound(system: Assembly, one: tuple[Any, Any], other: tuple[Any, Any]) -> Real:
    """Estimate x^T dA y, shape (n, columns of one, of other), by the parts' largest entries."""
    (u, f), (v, g) = (tuple(np.linalg.norm(w, axis=2) for w in pair) for pair in (one, other))
    D, G, Q, N = (np.abs(w).max((2, 3)) for w in (system.D, system.G, system.Q, system.N))
    left, right = u[:, :-1], v[:, :-1]
    form = "lnd,ln,lnr->ldr"
    size = np.einsum(form, u, N, v) + np.einsum(form, left, Q, right) + np.einsum(form, f, G, g)
    size += np.einsum(form, f, 1 + D, right) + np.einsum(form, left, 1 + D, g)
    limit: Real = ROUNDINGS * np.finfo(float).eps * size
    return limit
