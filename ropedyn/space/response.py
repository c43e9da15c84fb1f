"""The frequency response of a rope on an axis."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.answer import Cost
from ..base.array import Complex, Index, Real
from ..base.computed import Late, computed
from ..base.errors import SceneError, SolveError
from ..base.unit import QUANTITIES, WIRE
from ..chain.place import moved_end
from ..chain.port import Point, is_force, moving
from ..chain.wide import LINEAR, RUNS, SLIGHT, apart
from ..response.bands import bands, is_many
from ..response.frf import FRF, MeshOfResponse, RoundingOfResponse
from ..response.question import OnResonance
from ..scene import damping
from ..scene.parts.broken_wire import BrokenWire
from ..scene.scene import Scene
from .assembly import ROUNDINGS, Assembly, LoadedFields, assemble, bound
from .between import MISSED, Between
from .compile import finer_rope, method_of
from .rope import SIX, Factors, SpaceRope

AT_ONCE = 128  # Lines are assembled together at most,
FIRST = 16  # so many at first,
TOGETHER = 1 << 17  # and of their parts so many.
MOST_WORK = 1 << 17  # Lines times pieces of one answer beyond which rounding is bounded alone.


def checked_points(
    scene: Scene, given: Any, name: str, *, seen: bool = False
) -> tuple[tuple[Point, ...], bool]:
    """Return one or several points, and whether a list was given.

    What is seen may be internal forces and tips of wires, what drives the motion of ends.
    """
    several = isinstance(given, (list, tuple)) and len(given) > 0 and not isinstance(given[0], str)
    found = []
    for k, one in enumerate(given if several else (given,)):
        called = f"{name}[{k}]" if several else name
        if check.is_end(one) and not seen:
            if scene.rope.axis is not None and scene.rope.axis.closed:
                raise SceneError(
                    f"{called} must not be an end of an axis that is closed: it has none"
                )
            found.append(moved_end(scene, one, called))
            continue
        own, wires = (scene.coordinates, scene.rope.length), wires_of(scene) if seen else None
        found.append(check.point(one, called, *own, forces=seen, wires=wires))
    return tuple(found), several


def watched(scene: Scene, given: Any, drives: tuple[Point, ...]) -> tuple[Point, ...]:
    """Return what is watched: the drives where nothing else is said."""
    if given is not None:
        return checked_points(scene, given, "response", seen=True)[0]
    if not drives or any(map(check.is_end, drives)):
        what = "an end is moved" if drives else "nothing is driven"
        raise SceneError(f"response must be given where {what}, got None")
    return drives


def wires_of(scene: Scene) -> int:
    """Return how many broken wires it has."""
    return sum(isinstance(part, BrokenWire) for part in scene.parts)


def solve_frf(
    scene: Scene,
    rope: SpaceRope,
    frequency: Any,
    *,
    drive: Any,
    response: Any,
    quantity: str,
    decay: float = 0.0,
) -> FRF:
    """Compute the frequency response; see `SpaceModel.frf`."""
    check.one_of(quantity, "quantity", QUANTITIES)
    f = check.frequencies(frequency)
    drives, several = checked_points(scene, drive, "drive")
    responses = watched(scene, response, drives)
    decay = check.number(decay, "decay", "1/s", sign="nonnegative")
    asked = Request.of(scene, rope, f, drives, responses, decay=decay)
    answered = slice(None) if several else 0
    receptance = asked.receptance()
    power = (2j * math.pi * f + decay) ** QUANTITIES[quantity]
    value = (receptance * power)[answered]

    @cache
    def rounding() -> RoundingOfResponse:
        return RoundingOfResponse.of(value, (asked.error(receptance) * np.abs(power))[answered])

    def bounded() -> Real:
        limit = (asked.rounding() * np.abs(power))[answered]
        return RoundingOfResponse.of(value, limit).rounding_error

    def mesh() -> MeshOfResponse:
        finer = finer_rope(scene, rope)
        if finer is None:
            return MeshOfResponse(np.zeros(value.shape))
        other = Request.of(scene, finer, f, drives, responses, decay=decay).receptance()
        size = np.abs(other)
        off = np.abs(receptance - other)
        error = np.divide(off, size, where=size > 0, out=np.where(off > 0, np.inf, 0.0))
        return MeshOfResponse(error[answered])

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
        rounding_bound=Late(bounded),
        mesh=Late(mesh),
        solve_rates=_refuse_rates,
        decay=decay,
    )


def _refuse_rates() -> Any:
    raise SceneError("derivatives are not carried for a rope on an axis or its catenary")


def _place(rope: SpaceRope, point: tuple[Any, ...]) -> float:
    """Return where a point is [m]."""
    if check.is_end(point):
        return float(rope.x[-point[1]])
    if point[0] == WIRE:
        return float(rope.x[rope.carried[int(point[1])].node])
    return float(point[1] * rope.longer)


class SpacePorts(NamedTuple):
    """What points see of motion and force, and its rounding: rows (n, points, width)."""

    node: Index  # (points,) whose motion,
    motion: Complex
    motion_doubt: Real
    part: Index  # (points,) and whose force
    force: Complex
    force_doubt: Real


class AskedPart(NamedTuple):
    """What of a request moves together."""

    which: Index  # (1,)
    own: list[str]  # its coordinates
    pairs: Any  # its drives and responses in the answer
    node: list[Index]  # of drives and of responses
    point: list[list[Point]]

    def at(self, lines: Index) -> tuple[Index, ...]:
        """Return where its answers at some lines are among all."""
        return *(one[..., None] for one in self.pairs), lines


@dataclass(frozen=True, eq=False)
class Request:
    """What is asked for: a rope with nodes at the points, and the lines."""

    rope: SpaceRope
    factors: Factors
    frequency: Real
    node: tuple[Index, Index]  # of drives and of responses
    point: tuple[tuple[Point, ...], tuple[Point, ...]]
    factors_at: Callable[[Real], Factors] | None  # other frequencies; None: these are on no line
    kept: Index  # nodes, wherever it is cut besides

    @classmethod
    def of(
        cls,
        scene: Scene,
        rope: SpaceRope,
        frequency: Real,
        drives: Sequence[Point],
        responses: Sequence[Point],
        *,
        decay: float | Real = 0.0,
    ) -> Request:
        """Cut the rope at the points; motion is e^(s t), s = 2 pi i frequency + decay."""

        def factors_at(frequency: Real, decay: Any) -> Factors:
            omega = 2 * math.pi * frequency - 1j * decay
            by = damping.factors(scene.dampings, omega).T
            return Factors(*by, *np.ones((1, len(omega)), dtype=np.complex128))

        points, both = (tuple(drives), tuple(responses)), len(drives)
        places = [_place(rope, point) for point in (*drives, *responses)]
        cut, node = rope.cut(np.array(places), check.NEAR * scene.rope.length)
        same = np.ptp(decay) == 0
        return cls(
            cut,
            factors_at(frequency, decay),
            frequency,
            (node[:both], node[both:]),
            points,
            partial(factors_at, decay=np.ravel(decay)[0]) if same else None,
            np.arange(len(cut.length) + 1),
        )

    def receptance(self) -> Complex:
        """Return motion and internal force per unit force or motion, (drives, responses, f)."""
        return self._answered()[0]

    def _answered(self) -> tuple[Complex, Real]:
        """Return also how large motion is at the nodes that are kept, scaled, (drives, f)."""
        value, size = np.zeros(self._shape, dtype=np.complex128), np.zeros(self._shape[::2])
        for side, lines, system in self._systems():
            one, ports = self._solved(system, side, lines, 0), self._ports(system, side, 1)
            seen = np.einsum("lrc,lrcd->drl", ports.motion, one.u[:, ports.node])
            if ports.force.any():
                seen += np.einsum("lrc,lrcd->drl", ports.force, one.f[:, ports.part])
            value[side.at(lines)] = seen
            size[side.pairs[0], lines] = np.abs(one.u[:, system.node[self.kept]]).max(axis=(1, 2)).T
        return value, size

    def rounding(self) -> Real:
        """Bound what rounding does to it: |x|^T |dA| |y| of motion by drives and responses."""
        limit = np.zeros(self._shape)
        for side, lines, system in self._systems():
            one, other = (self._solved(system, side, lines, i) for i in (0, 1))
            ports = self._ports(system, side, 1)
            seen = np.einsum("lrc,lrcd->drl", ports.motion_doubt, np.abs(one.u[:, ports.node]))
            seen += np.einsum("lrc,lrcd->drl", ports.force_doubt, np.abs(one.f[:, ports.part]))
            with np.errstate(all="ignore"):
                moved = bound(system, one, other).transpose(1, 2, 0) + seen
            # a response that pushes what nothing holds, where no drive does, has no bound
            limit[side.at(lines)] = np.where(np.isfinite(moved), moved, np.inf)
        return limit

    def error(self, value: Complex) -> Real:
        """Bound what rounding did to a receptance by those of numbers that are a little off."""
        if len(self.frequency) * len(self.rope.length) > MOST_WORK:
            return self.rounding()
        try:
            runs = [self.nudged(np.random.default_rng(seed))._answered() for seed in range(RUNS)]
        except SolveError:  # some line is as close to a resonance as numbers are known
            if len(self.frequency) == 1:
                return np.full(self._shape, np.inf)
            halves = np.array_split(np.arange(len(self.frequency)), 2)
            return np.concatenate([self.at(k).error(value[..., k]) for k in halves], axis=2)
        every, size = (np.stack(one) for one in zip(*runs))
        error = apart(value, every)
        # where no digit of a field is left the truth may lie beyond all that others are
        lost = np.ptp(size, axis=0) > LINEAR * size.min(axis=0)
        return np.where(lost[:, None], np.inf, error)

    def at(self, lines: Index) -> Request:
        """Return the question of some of the lines."""
        factors = Factors(*(one[lines] for one in self.factors))
        return replace(self, factors=factors, frequency=self.frequency[lines])

    def nudged(self, random: np.random.Generator) -> Request:
        """Return the question of a rope and of factors that are a little off."""
        rope, at = self.rope.nudged(random)
        off = 1 + SLIGHT * random.uniform(-1, 1, len(Factors._fields))

        def moved(factors: Factors) -> Factors:
            return Factors(*(one * by for one, by in zip(factors, off)))

        asked = self.factors_at
        return replace(
            self,
            rope=rope,
            factors=moved(self.factors),
            node=(at[self.node[0]], at[self.node[1]]),
            kept=at,
            factors_at=asked and (lambda frequency: moved(asked(frequency))),
        )

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
            at = [[i for i, p in enumerate(of) if moving(p) in (*own, WIRE)] for of in self.point]
            if all(at):
                node = [one[there] for one, there in zip(self.node, at)]
                point = [[of[i] for i in there] for of, there in zip(self.point, at)]
                found.append(AskedPart(np.array([k]), own, np.ix_(*at), node, point))
        return found

    def _systems(self) -> Iterator[tuple[AskedPart, Index, Assembly]]:
        for side in self.components:
            for lines, between in self._bands(side.which):
                first, count = 0, FIRST
                while first < len(lines):
                    at_once = slice(first, first + count)
                    system = self.assembled(side, lines[at_once], between, at_once)
                    yield side, lines[at_once], system
                    first += count
                    count = max(1, min(AT_ONCE, TOGETHER // system.parts))

    def assembled(
        self,
        side: AskedPart,
        lines: Index | slice,
        between: Between | None = None,
        at_once: slice = slice(None),
    ) -> Assembly:
        """Return a component at some of the lines, which lie so in a band."""
        factors = Factors(*(one[lines] for one in self.factors))
        z = self.rope.scale(side.which, np.abs(factors.inertia))
        parts = between.at(at_once, z) if between else None
        return assemble(self.rope, side.which, factors, z, parts)

    def _bands(self, which: Index) -> Iterator[tuple[Index, Between | None]]:
        """Yield lines, and between which others they lie where they are many."""
        # inertia far below others would have the roundings of theirs
        left = list(bands(self.frequency, few=1))
        while left:
            lines = left.pop()
            frequency = self.frequency[lines]
            if self.factors_at is None or not is_many(frequency):
                yield lines, None
                continue
            between = Between.of(self.rope, which, frequency, self.factors_at)
            if between.missed.max() <= MISSED:
                yield lines, between
            else:
                left += np.array_split(lines, 2)

    def _solved(self, system: Assembly, side: AskedPart, lines: Index, end: int) -> LoadedFields:
        """Return motion and force of unit loads on drives (0) or responses (1)."""
        ports, n = self._ports(system, side, end), len(system.D)
        columns = np.arange(len(ports.node))
        load = np.zeros((n, system.parts + 1, system.width, len(columns)), dtype=np.complex128)
        slip = np.zeros((n, system.parts, system.width, len(columns)), dtype=np.complex128)
        load[:, ports.node, :, columns] = ports.motion.swapaxes(0, 1)
        slip[:, ports.part, :, columns] = ports.force.swapaxes(0, 1)
        moved = np.zeros_like(load)
        for k, point in enumerate(side.point[end]):
            if check.is_end(point):
                # of a held coordinate that is given, A takes a known part
                moved[:, :, :, k], load[:, :, :, k] = load[:, :, :, k], 0.0
        slip[np.broadcast_to(system.absent[:, None], slip.shape[:3])] = 0.0
        right, apart = load, slip
        if moved.any():
            right = load - system.N @ moved
            right[:, :-1] -= system.Q @ moved[:, :-1]
            apart = slip - np.diff(moved, axis=1) + system.D @ moved[:, :-1]
        load[system.held] = right[system.held] = 0.0
        rows = system.together(right, apart)
        u, force = system.apart(system.respond(rows))
        field = LoadedFields(u + moved, force, load, slip)
        if end == 0 and (lost := field.lost(system, rows)).any():
            there = [c for c in side.own if not self.rope.absent[SIX.index(c)]]
            raise OnResonance(float(self.frequency[lines][lost.argmax()]), there)
        return field

    def _ports(self, system: Assembly, side: AskedPart, end: int) -> SpacePorts:
        """Return what points see of their nodes and of the part left of them."""
        points, node = side.point[end], system.node[side.node[end]]
        motion = np.zeros((len(system.z), len(points), system.width), dtype=np.complex128)
        ports = SpacePorts(
            node,
            motion,
            np.zeros(motion.shape),
            (node - 1) % system.parts if system.closed else np.maximum(node - 1, 0),
            np.zeros_like(motion),
            np.zeros(motion.shape),
        )
        for k, point in enumerate(points):
            if point[0] == WIRE:
                foot = system.feet[int(point[1])]
                ports.motion[:, k] = foot.seen * system.z
                ports.motion_doubt[:, k] = foot.seen_doubt * system.z
                continue
            along = side.own.index(moving(point))
            z = system.z[:, along]
            if is_force(point):
                self._see_force(system, ports, k, along)
            else:
                ports.motion[:, k, along] = 1 / z if check.is_end(point) else z
                # of what is seen of an end that moves by 1, nothing else is rounded
                ports.motion_doubt[:, k, along] = np.finfo(float).eps * z
        return ports

    @staticmethod
    def _see_force(system: Assembly, ports: SpacePorts, k: int, along: int) -> None:
        """See what the rope right of a node puts on the part left of it, of the first on the end.

        On the end that is f_a = F^T f_b - Q u_a. Left of the first of what is closed is the last.
        """
        over = 1 / system.z[:, along, None]
        if system.closed or ports.node[k] > 0:
            ports.force[:, k, along] = over[:, 0]
            return
        D, Q = system.D[:, 0], system.Q[:, 0]
        one = np.eye(system.width)[along]
        ports.force[:, k] = over * (one + D[:, :, along])
        ports.motion[:, k] = -over * Q[:, along]
        limit = ROUNDINGS * np.finfo(float).eps * over
        ports.force_doubt[:, k] = limit * (1 + np.abs(D).max((1, 2))[:, None])
        ports.motion_doubt[:, k] = limit * np.abs(Q).max((1, 2))[:, None]
