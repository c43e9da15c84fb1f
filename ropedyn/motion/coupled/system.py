"""All modes of a chain, and what couples them.

With the mean tension's modes of unit mass, of both planes where there are two, G the integral of
the products of their slopes in a plane, and C what dampers couple,

    q_k'' + 2 sigma_k q_k' + square_k q_k = drive_k - (t G q + C q' - laws)_k,
    t = pulsation + EA/(2 L) q^T G q.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...base.array import Flags, Real
from ...base.errors import SceneError
from ...chain.compiled import Compiled
from ...chain.port import Point, is_force, local, locate, moving, ports
from ...chain.tip import is_tip
from ...response.moved_end import is_end
from ...scene.tension import Tension
from ..acting import acting_laws, held_of
from ..modal.superposition import sizes
from ..request import Run
from ..smooth.collocation import Oscillating
from ..smooth.laws import slopes
from ..smooth.system import LawSystem, OutputTimes, shifted
from .modes import AllModes

FIRST = 512  # A run has so many steps at least.


@dataclass(frozen=True, eq=False)
class CoupledSystem(LawSystem):
    """Components whose modes are coupled; the amplitudes are the first of its outputs."""

    row: Real  # (laws, k) how modes move the laws' points
    push: Real  # (drives, k) and what drives
    pulled: Real  # (outputs, k) what those asked for see per amplitude and tension beside the mean
    form: Real  # (k, k) G
    coupling: Real | None  # (k, k) C
    stretching: float  # EA/L [N/m]; 0: motion does not stretch
    pulsation: Callable[[Real], Real] | None  # [N] at times [s]
    pulsates_at: float  # [Hz]

    @classmethod
    def coupled(
        cls,
        run: Run,
        component: tuple[str, ...],
        outputs: Sequence[Point],
        looks: Sequence[OutputTimes],
    ) -> CoupledSystem:
        """Find the modes of a chain, in one plane or both, and what couples them."""
        model, rope = run.model, run.model.scene.rope
        drive = [k for k, p in enumerate(run.places) if moving(p) in component]
        places = [run.places[k] for k in drive]
        acting = acting_laws(model, component)
        refuse_points(model, [*places, *(one.point for one in acting)], outputs, run.order)
        modes, varies = AllModes.of(model, component), tension_of(model, component)
        count, stretches = len(modes.sigma), varies is not None and varies.stretching
        seen, swept, pulled = modes.rows(outputs)
        seen = np.concatenate([np.eye(count), seen])
        swept = np.concatenate([np.zeros((count, count)), swept])
        looks = [look._replace(output=shifted(look.output, count)) for look in looks]
        if varies and pulled.any():  # which the first look alone asks for
            looks.append(OutputTimes(slice(0, count), looks[0].time, 0))
        push = modes.rows(places)[0]
        return cls(
            laws=acting,
            modes=Oscillating(modes.sigma, modes.system.eigenvalue, np.eye(count), seen, swept),
            driven=[modes.driven(one, seen, swept) for one in push],
            pushes=[run.pushes[k] for k in drive],
            time=run.time,
            looks=looks,
            beyond=np.inf,
            row=modes.rows([one.point for one in acting])[0],
            push=push,
            pulled=pulled,
            form=modes.system.geometric,
            coupling=modes.system.coupling,
            stretching=(rope.axial_stiffness or 0.0) / rope.length if stretches else 0.0,
            pulsation=varies.pulsation if varies and varies.pulsates else None,
            pulsates_at=varies.frequency if varies and varies.pulsates else 0.0,
        )

    @property
    def points(self) -> slice:
        """Outputs that are the amplitudes."""
        return slice(0, len(self.modes.sigma))

    @property
    def is_plain(self) -> bool:
        """Whether nothing but the tension couples modes."""
        return not self.laws and self.coupling is None

    @property
    def falls(self) -> float:
        """By how much half the step divides errors at least."""
        if self.is_plain:
            return super().falls
        return 2.0 if self.is_sharp else 4.0

    @property
    def is_sharp(self) -> bool:
        """Whether some law is."""
        return any(one.is_sharp for one in self.laws)

    def held(self, points: Sequence[Point], largest: Real) -> Flags:
        """Say which points laws hold, whose forces have been so large [N]."""
        return held_of(points, self.laws, largest)

    @property
    def finer(self) -> float:
        """How much shorter the next steps are: ends of others would see a turn as they did."""
        return 2.2 if self.is_sharp else super().finer

    @property
    def first_step(self) -> float:
        """The longest step to begin with [s]."""
        span = float(self.time[-1] - self.time[0])
        plain = min(super().first_step, span / FIRST)
        return min(plain, 1 / (4 * self.pulsates_at)) if self.pulsates_at else plain

    def unmoved(self, h: float, size: Real) -> Real:
        """Return what steps do not see of laws and of coupling by dampers, first look, (o,).

        The forces of a mode that turns within a step add up to nothing in it: its own frequency is
        off, and others are moved by a share of it.
        """
        omega, span = np.sqrt(np.abs(self.modes.square)), float(self.time[-1] - self.time[0])
        fast, look = omega * h > 1, self.looks[0]
        if not fast.any():
            return np.zeros(1)
        each = [sizes(one, 0, push, self.time, 0) for one, push in zip(self.driven, self.pushes)]
        most = sum(each, np.zeros(self.modes.seen.shape))[self.points].diagonal()
        row, w = np.abs(self.row), omega[fast]
        at_laws = np.stack([row @ (most * omega**n) for n in range(3)]).T
        laws = [slopes(one.law, self.time, moves) for one, moves in zip(self.laws, at_laws)]
        stiff, damps = np.abs(np.array(laws)).reshape(-1, 2).T
        C = (row.T * damps) @ row[:, fast] + (row.T * stiff) @ row[:, fast] / w
        C += 0.0 if self.coupling is None else np.abs(self.coupling[:, fast])
        apart = np.maximum(np.abs(np.subtract.outer(omega**2, w**2)), 4 * w / span)
        moved = np.minimum(1.0, 2 * C * w / apart) @ most[fast]
        moved[fast] += np.minimum(1.0, span / 2 * w * (C**2 / apart).sum(axis=0)) * most[fast]
        seen = np.abs(self.modes.seen) + np.abs(self.modes.swept) * omega
        return np.asarray(seen[look.output] @ (moved * omega**look.order))

    def added(self, time: Real) -> Real:
        """Return what pulsation adds to the tension [N]."""
        return np.zeros(np.shape(time)) if self.pulsation is None else self.pulsation(time)

    def told(self, looked: list[Real]) -> list[Real]:
        """Return what was looked at, with what internal forces feel of a tension that varies."""
        if self.looks[-1].output != self.points:
            return looked
        first, *others, Q = looked
        return [first + self.pull(self.looks[0].time, Q)[: len(first)], *others]

    def pull(self, time: Real, Q: Real) -> Real:
        """Return what internal forces feel of the tension beside its mean, (outputs, t)."""
        bent = np.einsum("kt,kl,lt->t", Q, self.form, Q, optimize=True)
        return np.asarray((self.added(time) + self.stretching / 2 * bent) * (self.pulled @ Q))


def tension_of(model: Compiled, component: tuple[str, ...]) -> Tension | None:
    """Return the tension where it varies and acts on a component."""
    tension = model.scene.tension
    across = not {"y", "z"}.isdisjoint(component)
    varies = isinstance(tension, Tension) and not tension.is_constant
    return tension if across and varies and isinstance(tension, Tension) else None


def moving_together(model: Compiled) -> list[tuple[str, ...]]:
    """Return the components, as one those that stretching couples."""
    tension = model.scene.tension
    stretches = isinstance(tension, Tension) and tension.stretching
    planes = [one for one in model.components if stretches and tension_of(model, one)]
    others = [one for one in model.components if one not in planes]
    return [*([sum(planes, ())] if planes else []), *others]


# --- points ---------------------------------------------------------------------------------------


def refuse_points(
    model: Compiled, places: Sequence[Any], outputs: Sequence[Point], order: int
) -> None:
    """Refuse what amplitudes of modes do not tell."""
    why = (
        "where steps follow all modes of a chain, as they do where the tension varies, energy is "
        "asked for, or steady friction slips that is not followed from event to event"
    )
    if model.element == "continuous":
        raise SceneError(f"elements must be given {why}, such as compile(elements=64)")
    if model.element == "difference" and "beta" in model.coordinates:
        raise SceneError(f'element must not be "difference" where the rope bends {why}')
    for kind in model.chain.carried:
        if kind == "broken wire":
            raise SceneError(
                f"parts must not have a broken wire {why}; a Resonator of its first frequency "
                "comes near it"
            )
    for point in outputs:
        if is_tip(point):
            raise SceneError(f"response must be of a point of the rope {why}, got {point}")
        if is_force(point) and order:
            raise SceneError(f'quantity must be "displacement" of {point} {why}')
        if is_force(point) and locate(model.x, point[1])[1] is not None:
            raise SceneError(f"response must be an internal force at a node {why}, got {point}")
    for point in places:
        if is_end(point):
            raise SceneError(f"drive must not be the motion of an end {why}, got {point}")
        _refuse_place(model, point, outputs, why)


def _refuse_place(model: Compiled, place: Point, outputs: Sequence[Point], why: str) -> None:
    """Refuse forces that something follows at once."""
    component = next(c for c in model.components if moving(place) in c)
    chain = model.chain.only(component)
    at = ports(chain, model.x, component, [place])
    term = chain.term_of[at.node[0] : at.node[0] + 2]
    inertia = np.einsum("tii->ti", chain.mass)[term] + chain.held[term]
    if (at.row[0][: len(term)][inertia == 0] != 0).any():
        raise SceneError(f"forces and laws must act on coordinates with inertia {why}, got {place}")
    own = [p for p in outputs if moving(p) in component]
    element, inside = locate(model.x, place[1])
    if any(
        local(chain, model.x, component, place, p)
        or (is_force(p) and inside is not None and element == max(locate(model.x, p[1])[0] - 1, 0))
        for p in own
    ):
        raise SceneError(
            f"a response must not lie between the nodes beside a force {why}, got {place}"
        )
