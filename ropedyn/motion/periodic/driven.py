"""A driven scene as harmonic balance takes it: its points, what acts there, and what they move.

Points where dry friction acts are held: their motion is 0, and the force that this takes is H too.
It is compared with what friction can hold when the motion is known.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ... import _core
from ...base.array import Complex, Real
from ...base.computed import computed
from ...base.errors import SceneError, SolveError
from ...chain.port import Point
from ...response.frf import FRF
from ...response.harmonic import solve_harmonic
from ...scene.tension import Tension
from ..acting import ActingLaw, acting_laws
from .asked import SteppedSine
from .balance import HarmonicBalance
from .laws import PointForces, StringTension, asked_law
from .transfer import PanelledTransfer

TOGETHER = 1000  # What acts and the drive must both begin anew within so many periods.
WHOLE = 1e-12  # A number of periods is whole if it is as near to a whole number.
ALIKE = 1e-9  # A law of time comes back if its forces are as near, relative.
SHARES = (0.0, 0.1, 0.37, 0.61, 0.83)  # Of a period: when a law is looked at.


@dataclass(frozen=True, eq=False)
class Driven:
    """A scene under a sine."""

    asked: SteppedSine
    laws: tuple[ActingLaw, ...]  # those of points that move
    held: tuple[Point, ...]  # by friction
    grip: Real  # (held,) what friction holds [N, N m]
    points: tuple[Point, ...]  # that move
    tension: StringTension | None

    @classmethod
    def of(cls, asked: SteppedSine) -> Driven:
        """Sort what acts on the points of a scene."""
        laws = acting_laws(asked.model)
        sticking = [one for one in laws if one.is_friction]
        held = tuple(dict.fromkeys(one.point for one in sticking))
        grip = np.zeros(len(held))
        for one in sticking:
            # what is less than dry friction holds nothing
            grip[held.index(one.point)] += one.law.value[0] * (one.law.value[1] == 0)
        moving = tuple(one for one in laws if one.point not in held)
        nodes, tension = _string(asked, held)
        points = tuple(dict.fromkeys([*nodes, *(one.point for one in moving)]))
        if tension is not None:
            wider = np.zeros((len(tension.length), len(points)))
            wider[:, : len(nodes)] = tension.free
            tension = StringTension(tension.length, wider, tension.stretching, tension.pulsation)
        return cls(asked, moving, held, grip, points, tension)

    @property
    def is_linear(self) -> bool:
        """Whether nothing acts but what is in proportion to motion."""
        return not self.points and not self.held

    @computed
    def force(self) -> PointForces:
        """What acts on the points."""
        at = [self.points.index(one.point) for one in self.laws]
        return PointForces(self.laws, at, len(self.points), self.tension)

    @computed
    def transfer(self) -> PanelledTransfer:
        """What points and drive move, (points and held, points and drive); forces where held."""
        return PanelledTransfer(
            lambda omega: self._holding(self._moved(omega).value.transpose(2, 1, 0)),
            lambda omega: known_to(self._moved(omega)),
        )

    def _moved(self, omega: Real) -> FRF:
        pushed = [*self.points, *self.held, self.asked.drive]
        return self._asked(omega / (2 * np.pi), pushed, [*self.points, *self.held])

    def _asked(self, frequency: Real, drives: list[Point], responses: list[Point]) -> FRF:
        model = self.asked.model
        return solve_harmonic(
            model, frequency, drive=drives, response=responses, threads=1, tight=False
        )

    def _holding(self, H: Complex) -> Complex:
        """Hold what friction holds: (f, points and held, points, held and drive) to fewer."""
        m, h = len(self.points), len(self.held)
        if not h:
            return H
        free = [*range(m), m + h]
        grip = -np.linalg.solve(H[:, m:, m : m + h], H[:, m:][..., free])
        return np.concatenate([H[:, :m][..., free] + H[:, :m, m : m + h] @ grip, grip], axis=1)

    def balance(self, harmonics: int, turn: int = 1) -> HarmonicBalance:
        """Return what is balanced, with harmonics of the drive up to some."""
        points, amplitude = len(self.points), self.asked.amplitude
        return HarmonicBalance(self.transfer, self.force, points, harmonics * turn, amplitude, turn)

    @computed
    def growing(self) -> int:
        """How many motions grow without what is not linear."""
        model = self.asked.model
        zero = np.zeros(1)
        counts = [_core.count(model.chain.only(c), zero)[0] for c in model.components]
        return int(sum(counts))

    @computed
    def keeps_time(self) -> bool:
        """Whether nothing but the drive depends on time."""
        tension = self.asked.model.scene.tension
        pulsates = self.tension is not None and isinstance(tension, Tension) and tension.pulsates
        return not pulsates and all(self._comes_back(one, 0.0) for one in self.laws)

    def turn(self, frequency: float) -> int:
        """Return after how many periods of the drive everything begins anew."""
        if self.keeps_time:
            return 1
        tension = self.asked.model.scene.tension
        for n in range(1, TOGETHER + 1):
            if isinstance(tension, Tension) and tension.pulsates:
                turns = tension.frequency / frequency * n
                if abs(turns - round(turns)) > WHOLE * max(turns, 1.0):
                    continue
            if all(self._comes_back(one, n / frequency) for one in self.laws):
                return n
        what = "a law depends on time"
        if isinstance(tension, Tension) and tension.pulsates:
            what = f"the tension pulsates at {tension.frequency!r} Hz"
        raise SolveError(
            f"frequency {frequency!r} Hz has no steady state: {what}, and both do not begin anew "
            f"together within {TOGETHER} periods"
        )

    def _comes_back(self, one: ActingLaw, period: float) -> bool:
        """Whether a law says the same after a period, or at all times where that is 0."""
        if one.law.kind != "call":
            return True
        f = float(self.asked.frequency[0])
        early = np.array(SHARES) / f
        late = early + period if period else np.zeros_like(early)
        u, v = self._moves(one.point) * np.array([[1.0], [2 * np.pi * f]])
        before, after = (asked_law(one, time, u, v) for time in (early, late))
        near = ALIKE * np.abs(np.append(before, after)).max()
        return bool((np.abs(after - before) <= near).all())

    def _moves(self, point: Point) -> Real:
        """Return some motion of a point, as large as without laws."""
        H = self._asked(self.asked.frequency[:1], [self.asked.drive], [point]).value
        size = float(np.abs(H).max()) * self.asked.amplitude or 1.0
        return size * np.linspace(0.3, 1.0, len(SHARES))

    @computed
    def size(self) -> float:
        """How much points move at the mean frequency without what is not linear."""
        omega = 2 * np.pi * float(self.asked.frequency.mean())
        H = self.transfer.at(np.array([omega]))[0, : len(self.points), -1]
        return float(np.linalg.norm(H)) * self.asked.amplitude / 2

    def linear_motion(self, balance: HarmonicBalance, omega: float) -> Real:
        """Return the motion of the points without what is not linear."""
        H = balance.transfer.at(balance.order * omega)[:, : balance.points, -1]
        return balance.real(H.T * balance.driven())

    def hold(self, balance: HarmonicBalance | None, x: Real, omega: float) -> Real:
        """Return the largest force that holds each held point, (held,)."""
        m = len(self.points)
        if balance is None:
            H = self.transfer.at(np.array([omega]))[0, m:, -1]
            return np.abs(H) * self.asked.amplitude
        H = balance.transfer.at(balance.order * omega)[:, m:]
        push = np.concatenate([balance.forces(x, omega), balance.driven()[None]])
        force = np.einsum("khp,pk->hk", H, push)
        samples = np.fft.irfft(force, balance.samples, axis=1) * balance.samples
        return np.asarray(np.abs(samples).max(axis=1))

    def responses(self, frequency: Real, push: Complex, off: Complex) -> tuple[Complex, Real]:
        """Return what is watched per amplitude, from the forces of points per amplitude.

        push and how far each is off (points, f); value and error (responses, f), absolute.
        """
        m, h = len(self.points), len(self.held)
        pushed = [*self.points, *self.held, self.asked.drive]
        found = self._asked(frequency, pushed, list(self.asked.responses))
        push = np.concatenate([push, np.ones((1, len(frequency)))])
        wrong = np.abs(np.concatenate([off, np.zeros((1, len(frequency)))]))
        if h:
            H = self.transfer.at(2 * np.pi * frequency)[:, m:]
            grip, lost = (np.einsum("fhp,pf->hf", *one) for one in ((H, push), (np.abs(H), wrong)))
            push, wrong = (
                np.concatenate([one[:m], held, one[m:]])
                for one, held in ((push, grip), (wrong, lost))
            )
        share = found.value * push[:, None]
        known = found.rounding_limit
        if self.asked.model.element == "continuous":
            beside = np.where(found.value == 0, 0.0, found.mesh_error)
            known = known + beside * np.abs(found.value)
        moves = np.array([[one not in self.held] for one in self.asked.responses])
        error = np.abs(push[:, None]) * known + np.abs(found.value) * wrong[:, None]
        return moves * share.sum(axis=0), moves * error.sum(axis=0)


def known_to(found: FRF) -> Real:
    """Return the relative error of responses, of the largest ones at each frequency, (f,)."""
    size = np.abs(found.value).reshape(-1, len(found.frequency))
    wrong = found.rounding_limit.reshape(size.shape)
    return wrong.max(axis=0) / np.maximum(size.max(axis=0), np.finfo(float).tiny)


def _string(
    asked: SteppedSine, held: tuple[Point, ...]
) -> tuple[list[Point], StringTension | None]:
    """Return the nodes that tension beside its mean pushes, and how."""
    model, scene = asked.model, asked.model.scene
    tension = scene.tension
    if "z" not in model.coordinates or not isinstance(tension, Tension) or tension.is_constant:
        return [], None
    if model.element == "continuous":
        raise SceneError(
            "elements must be given where the tension pulsates or is stretching, such as "
            "compile(elements=16): its work is summed up over nodes"
        )
    chain, own = model.chain, [c for c in ("z", "y") if c in model.coordinates]
    # the planes one after another: what stretches the rope adds up
    every = [(c, k) for c in own for k in range(len(model.x))]
    rises = np.asarray(np.kron(np.eye(len(own)), np.diff(np.eye(len(model.x)), axis=0)))
    stays = chain.held[chain.term_of][:, [model.coordinates.index(c) for c in own]] != 0
    free = np.flatnonzero(~stays.T.ravel())
    stretching = (scene.rope.axial_stiffness or 0.0) / (2 * scene.rope.length)
    nodes: list[Point] = [(every[k][0], float(model.x[every[k][1]])) for k in free]
    kept = [k for k, node in enumerate(nodes) if node not in held]
    return [nodes[k] for k in kept], StringTension(
        np.tile(chain.length[chain.element_of], len(own)),
        rises[:, free[kept]],
        stretching if tension.stretching else 0.0,
        tension.pulsation,
    )
