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

from ...base.array import Real
from ...base.errors import SceneError
from ...chain.compiled import Compiled
from ...chain.port import Point, is_force, local, moving, ports
from ...chain.tip import is_tip
from ...response.moved_end import is_end
from ...scene.tension import Tension
from ..acting import ActingLaw, acting_laws
from ..modal.expansion import Expansion
from ..modal_system import ChainModes, chain_modes
from ..request import Run
from ..smooth.collocation import Oscillating
from ..smooth.laws import SmoothLaw
from ..smooth.system import LawSystem, OutputTimes, shifted

FIRST = 512  # A run has so many steps at least.


@dataclass(frozen=True, eq=False)
class CoupledSystem(LawSystem):
    """Components whose modes are coupled; the amplitudes are the first of its outputs."""

    acting: list[ActingLaw]
    row: Real  # (laws, k) how modes move the laws' points
    push: Real  # (drives, k) and what drives
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
        from scipy.linalg import block_diag

        model = run.model
        drive = [k for k, p in enumerate(run.places) if moving(p) in component]
        places = [run.places[k] for k in drive]
        acting = acting_laws(model, component)
        refuse_points(model, [*places, *(one.point for one in acting)], outputs)
        parts = [one for one in model.components if {*one} <= {*component}]
        each = [chain_modes(model, part) for part in parts]
        damping = [np.diag(one.system.damping) / 2 for one in each]
        couplings = [one.system.coupling for one in each]
        eigenvalue = np.concatenate([one.system.eigenvalue for one in each])
        sigma, count = np.concatenate(damping), len(eigenvalue)

        def moved(points: Sequence[Point]) -> Real:
            rows = [_moved(model, c, one, points) for c, one in zip(parts, each)]
            return np.concatenate(rows, axis=1)

        push, seen = moved(places), np.concatenate([np.eye(count), moved(outputs)])
        plain, none = np.zeros_like(seen), np.zeros((1, len(seen)))
        of_none = {"b": plain[None], "p": np.zeros(0), "r": none[..., None][..., :0]}
        of_none |= {"rest": none, "bound": none}
        varies = tension_of(model, component)
        coupled = any(c is not None for c in couplings)
        return cls(
            laws=[SmoothLaw(one.name, one.law.call) for one in acting],
            modes=Oscillating(sigma, eigenvalue, np.eye(count), seen, plain),
            driven=[
                Expansion(sigma, eigenvalue, a=(seen * one)[None], beyond=np.inf, **of_none)
                for one in push
            ],
            pushes=[run.pushes[k] for k in drive],
            time=run.time,
            looks=[look._replace(output=shifted(look.output, count)) for look in looks],
            beyond=np.inf,
            acting=acting,
            row=moved([one.point for one in acting]),
            push=push,
            form=block_diag(*(one.system.geometric for one in each)),
            coupling=block_diag(
                *(
                    np.zeros_like(one.system.geometric) if c is None else c
                    for one, c in zip(each, couplings)
                )
            )
            if coupled
            else None,
            stretching=_stretching(model) if varies and varies.stretching else 0.0,
            pulsation=varies.pulsation if varies and varies.pulsates else None,
            pulsates_at=varies.frequency if varies and varies.pulsates else 0.0,
        )

    @property
    def points(self) -> slice:
        """Outputs that are the amplitudes."""
        return slice(len(self.modes.sigma))

    @property
    def is_plain(self) -> bool:
        """Whether nothing but the tension couples modes."""
        return not self.acting and self.coupling is None

    @property
    def falls(self) -> float:
        """By how much half the step divides errors at least."""
        if self.is_plain:
            return super().falls
        sharp = any(one.law.kind == "stop" or one.is_friction for one in self.acting)
        return 2.0 if sharp else 4.0

    @property
    def first_step(self) -> float:
        """The longest step to begin with [s]."""
        span = float(self.time[-1] - self.time[0])
        plain = min(super().first_step, span / FIRST)
        return min(plain, 1 / (4 * self.pulsates_at)) if self.pulsates_at else plain

    def added(self, time: Real) -> Real:
        """Return what pulsation adds to the tension [N]."""
        return np.zeros(np.shape(time)) if self.pulsation is None else self.pulsation(time)


def _stretching(model: Compiled) -> float:
    return (model.scene.rope.axial_stiffness or 0.0) / model.scene.rope.length


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


def _moved(
    model: Compiled, component: tuple[str, ...], modes: ChainModes, points: Sequence[Point]
) -> Real:
    """Return how modes of a component move points, (points, k)."""
    rows = np.zeros((len(points), len(modes.shape)))
    mine = [k for k, point in enumerate(points) if moving(point) in component]
    at = ports(model.chain.only(component), model.x, component, [points[k] for k in mine])
    for k, node, row in zip(mine, at.node, at.row):
        rows[k] = np.einsum("knc,nc->k", modes.shape[:, node : node + 2], row)
    return rows


def refuse_points(model: Compiled, places: Sequence[Any], outputs: Sequence[Point]) -> None:
    """Refuse what amplitudes of modes do not tell."""
    why = "where steps follow all modes of a chain: the tension varies, or energy is asked for"
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
        if is_force(point) or is_tip(point):
            raise SceneError(f"response must be the motion of a point {why}, got {point}")
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
    if any(local(chain, model.x, component, place, p) for p in own):
        raise SceneError(
            f"a response must not lie between the nodes beside a force {why}, got {place}"
        )
