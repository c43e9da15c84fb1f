"""A chain as it is marched through time: plain lumps, and what stands beside them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ...base.array import Flags, Index, Real
from ...base.errors import SceneError, SolveError
from ...chain.chain import TENSED, Chain, roles
from ...chain.compiled import Compiled
from ...chain.port import Point, Ports, cut, is_force, local, locate, moving, ports, stops
from ...response.deflection import nodal
from ...response.moved_end import is_end
from ...scene.damping import having
from ...scene.force import Force
from ...scene.tension import Tension
from ..acting import ActingLaw, acting_laws
from ..request import Run
from .beside import Beside, plain_lumps, pulsation_of
from .point_law import Laws, PythonLaw, laws_of
from .readout import Readout, readout


class State(NamedTuple):
    """A motion, changed in place."""

    u: Real  # (nodes, width) displacement
    v: Real  # (nodes, width) velocity
    f: Real  # (nodes - 1, width) elastic force on the right ends of elements
    y: Real  # (attached,) displacement of the masses of resonators
    w: Real  # (attached,) their velocity

    def copy(self) -> State:
        """Return one of its own."""
        return State(*(array.copy() for array in self))


@dataclass(frozen=True, eq=False)
class Lumps:
    """The chain of coordinates that move together, and what acts on it."""

    coordinates: tuple[str, ...]  # of every node
    # without correction of its lumps; its damping is all that is in proportion to velocity
    chain: Chain
    x: Real  # (nodes,) where nodes stand [m]
    kept: Index  # those that the model has
    beside: Beside
    laws: Laws
    calls: tuple[PythonLaw, ...]  # those among them that Python knows
    drives: Ports  # of the forces
    forces: tuple[Force, ...]  # one for each
    moved: NDArray[np.int32]  # (moved, 2) node and coordinate of ends whose motion is given
    motions: tuple[Force, ...]  # one for each
    readout: Readout  # what is watched
    # (responses, drives) how far forces between nodes move what is watched in the same element at
    # once
    local: Real
    number: Index  # which of the responses of the run each is
    massless: Flags  # (nodes, width) free coordinates without inertia
    pulsation: Callable[[Real], Real] | None  # what is added to the tension at times [s]
    start: State  # where the motion begins
    released: bool  # whether loads on coordinates without inertia are let go

    @property
    def is_damped(self) -> bool:
        """Whether all motion is damped along the chain."""
        damping = self.chain.damping
        if damping is None:
            return bool(self.beside.rate.all())
        free = (self.chain.held == 0) & (np.einsum("tii->ti", self.chain.mass) > 0)
        along = np.einsum("tii->ti", damping)[free]
        return bool(self.beside.rate.all()) or bool(len(along) and along.all())

    @property
    def is_bare(self) -> Flags:
        """Whether each force acts on a coordinate without inertia, shape (drives,)."""
        return self._without_mass(self.drives)

    def _without_mass(self, points: Ports) -> Flags:
        """Whether each point moves with a coordinate without inertia, shape (points,)."""
        node, row, none = points.node, points.row != 0, self.massless
        return np.asarray((row & np.stack([none[node], none[node + 1]], axis=1)).any(axis=(1, 2)))

    @property
    def follows(self) -> bool:
        """Whether something is watched that has no inertia where a force acts on such."""
        return bool(self.is_bare.any() and self._without_mass(self.readout.ports).any())

    def values(self, read: Real, time: Real, order: int) -> Real:
        """Return the responses, shape (times, responses), of what the core read at these times."""
        value = self.readout.values(read, time, order)
        if self.local.any():
            verb = ("value", "rate")[order]
            value = value + np.array([getattr(f, verb)(time) for f in self.forces]).T @ self.local.T
        return value


def lumped_chains(run: Run) -> list[Lumps]:
    """Return the chains that are pushed in a run, with what is asked of each."""
    model = run.model
    found = []
    for component in model.components:
        laws = acting_laws(model, component)
        drives = [k for k, d in enumerate(run.drives) if moving(d) in component]
        loads = {p: load for p, load in run.loads.items() if p[0] in component}
        if drives or loads or any(one.law.kind == "call" for one in laws):
            found.append(_lumps(run, component, laws, drives, loads))
            _refuse_pushes(run, found[-1])
    return found


def _refuse_pushes(run: Run, lumps: Lumps) -> None:
    """Refuse what has no meaning where forces act: each says what and why."""
    if lumps.calls and (lumps.pulsation is not None or lumps.beside.stretching != 0):
        raise SceneError(
            f"parts[{lumps.calls[0].part}] must not be a NodeForce where the tension pulsates or "
            "is stretching: dashpots and stops may stand there"
        )
    if any(force.blows and bare for force, bare in zip(lumps.forces, lumps.is_bare)):
        raise SceneError(
            "force must not be an Impulse at an instant where the coordinate has no mass: give "
            "it a duration"
        )
    if any(motion.blows for motion in lumps.motions):
        raise SceneError(
            "force must not be an Impulse at an instant where the motion of an end is given"
        )
    # accelerations of what follows a force at once are second derivatives of the force
    if run.order == 2 and lumps.follows:
        raise SceneError(
            'quantity must be "displacement" or "velocity" where a force acts, and a response '
            'lies, on a coordinate without mass and the method is "direct"'
        )


def _lumps(
    run: Run,
    component: tuple[str, ...],
    laws_there: list[ActingLaw],
    driving: list[int],
    loads: dict[Point, float],
) -> Lumps:
    model = run.model
    pushed = [k for k in driving if not is_end(run.drives[k])]
    ends = [k for k in driving if is_end(run.drives[k])]
    watched = [k for k, r in enumerate(run.responses) if moving(r) in component]
    points = [run.drives[k] for k in pushed]
    motions: list[Any] = [run.drives[k] for k in ends]
    asked = [run.responses[k] for k in watched]
    whole, x = _cut(model, component, points, asked)
    chain, beside = plain_lumps(model, component, whole)
    laws, calls = laws_of(chain, x, component, laws_there)
    load = nodal(whole, x, component, loads)
    start = _start(whole, component, load, beside)
    pulsation = pulsation_of(model, component)
    drives = ports(chain, x, component, points)._replace(force=None)
    moved = [((chain.nodes - 1) * end, component.index(c)) for _, end, c in motions]
    inside = np.array([[local(chain, x, component, p, r) for p in points] for r in asked])
    inside = inside.reshape(len(asked), len(points))
    if inside.any():
        # the shape inside a driven element is to follow forces at once and steadily
        bends = "beta" in roles(component)
        changes = not bends and (pulsation is not None or beside.stretching != 0)
        if changes or beside.rate.any() or run.order == 2:
            raise SceneError(
                f'element must be "tensed", got {model.element!r}, where a response lies between '
                "nodes beside a force and is an acceleration, or stiffness is damped or changes"
            )
    no_mass = (np.einsum("tii->ti", chain.mass) == 0) & (chain.held == 0)
    massless = no_mass[chain.term_of]
    kept = np.flatnonzero(np.isin(x, model.x))
    forces = tuple(run.forces[k] for k in pushed)
    what = (component, chain, x, kept, beside, laws, calls, drives, forces)
    return Lumps(
        *what,
        moved=np.array(moved, dtype=np.int32).reshape(-1, 2),
        motions=tuple(run.forces[k] for k in ends),
        readout=readout(chain, x, component, asked, beside=beside, pulsation=pulsation),
        local=inside,
        number=np.array(watched, dtype=np.intp),
        massless=massless,
        pulsation=pulsation,
        start=start,
        released=bool(((load != 0) & massless).any()),
    )


def _cut(
    model: Compiled, component: tuple[str, ...], drives: list[Point], responses: list[Point]
) -> tuple[Chain, Real]:
    """Return the component's chain, with nodes where forces act and are asked for."""
    chain, x = model.chain.only(component), model.x
    inside = [p for p in (*drives, *filter(is_force, responses)) if locate(x, p[1])[1] is not None]
    if chain.kind != TENSED:
        if any(map(is_force, inside)):
            raise SceneError(
                "response of an internal force must stand at a node unless elements are "
                f'"tensed", got {next(filter(is_force, inside))} between nodes of '
                f"{model.element!r} elements"
            )
        return chain, x
    if stops(chain, x):
        most = np.sqrt(np.abs(chain.tension) * chain.flexibility[:, 2, 2]) * chain.length
        raise SceneError(
            "elements must be more, or rigid, so that the compression bends none by itself: they "
            f"must be shorter than sqrt(B/|T|), got {most.max():.3g} of it"
        )
    return cut(chain, x, [p[1] for p in inside])


def _start(chain: Chain, component: tuple[str, ...], load: Real, beside: Beside) -> State:
    """Return the rest under loads on nodes, about the mean tension and without laws."""
    u, f = np.zeros_like(load), np.zeros_like(load[1:])
    if load.any():
        try:
            u, f = _core.mixed_deflection(chain.at_rest, load)
        except SolveError as error:
            raise SolveError(
                f"({', '.join(component)}): there is no rest under the loads of start: a rigid "
                "motion is free or the compression is critical"
            ) from error
        if "z" in (names := roles(component)):
            z, each = names.index("z"), chain.element_of
            f[:, z] -= beside.string[each] / chain.length[each] * np.diff(u[:, z])
    y = np.zeros(0)  # how far the feet of resonators are moved
    if chain.attached_row is not None:
        y = np.einsum("kc,kc->k", chain.attached_row[:, 0], u[chain.feet])
    return State(u, np.zeros_like(u), f, y, np.zeros_like(y))


def refuse_model(model: Compiled) -> None:
    """Refuse what the direct method does not take, by name and with what to do."""
    scene = model.scene
    if model.element == "continuous":
        raise SceneError(
            'elements must be given where the method is "direct", such as compile(elements=64): '
            "continuous spans have no steps"
        )
    grows = isinstance(scene.tension, Tension) and scene.tension.stretching
    if grows and scene.planes == "both":
        raise SceneError(
            'method must be "auto", and damping proportional, where the tension is stretching and '
            'planes is "both": steps along the chain follow each plane alone'
        )
    for one in having(scene.dampings, "loss", "ratio"):
        raise SceneError(
            'damping must be in proportion to velocity where the method is "direct", such as '
            f"StiffnessDamping, got {one}"
        )
    if not model.separable:
        raise SceneError(
            'element must be "rigid" where sections and tension are damped apart and the method '
            f'is "direct", got {model.element!r} with {scene.damping}'
        )
    kinds = model.chain.carried
    if "broken wire" in kinds:
        raise SceneError(
            'parts must not have a broken wire where the method is "direct": its inertia is spread '
            "along it; a Resonator of its first frequency comes near it"
        )
