"""What is asked of a model over time, checked once."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.array import Real
from ..base.errors import SceneError
from ..base.progress import reporter, silent
from ..base.unit import MOTIONS, push_unit
from ..chain.compiled import Compiled
from ..chain.place import observed, points
from ..chain.port import Point, is_held
from ..response.moved_end import is_end
from ..scene.force import Force, Impulse, Step, forces
from ..scene.tension import Tension
from .acting import scene_laws
from .line.transfer import Transfer, TransferFunctions
from .start import Begun, kicked, released

EVENTS = "events"
TOLERANCE = 1e-3
"""Part of the largest value of each response that errors keep to where none is given."""
METHODS = ("auto", "modal", "line", EVENTS)


@dataclass(frozen=True, eq=False)
class Run:
    """Motion over time, as solvers are asked for it; see `Model.transient`."""

    model: Compiled  # linear or not
    time: Real  # (t,) [s], increasing; motion begins at the first
    # a coordinate and a position, or ("end", 0 or 1, coordinate): motion of an end is given
    drives: tuple[Point, ...]
    forces: tuple[Force, ...]  # one for each
    responses: tuple[Point, ...]  # Motion, internal forces, tips of wires
    method: str = "auto"  # as it was asked for
    is_linear: bool = True  # whether sums tell the motion
    order: int = 0  # how often the displacement is differentiated
    # under which the rope rests before the first time, when it is let go
    loads: Mapping[Point, float] = field(default_factory=dict)
    kicks: Mapping[Point, float] = field(default_factory=dict)  # impulses at the first time
    coarse: Run | None = None  # the same with shapes and velocities at fewer places
    snapshots: Real = field(default_factory=lambda: np.zeros(0))  # (s,) looks at all of it [s]
    modes: int | None = None  # of each component, that the modal method sums
    tolerance: float | None = None  # of the largest value of each response
    together: bool = False  # of all responses of one coordinate instead,
    least: Real | float = 0.0  # or of this (responses,) where it is more
    progress: Callable[[float], Any] = silent  # takes the fraction that is done
    partial: bool = False  # whether what was computed until the numbers fail is an answer
    # of the model, drives and responses; other kinds of ropes have their own
    transfer: Callable[[Any, tuple[Any, ...], tuple[Point, ...]], TransferFunctions] = Transfer

    @classmethod
    def of(
        cls,
        model: Any,
        time: Any,
        kind: Kind,
        *,
        drive: Any,
        force: Any,
        response: Any,
        quantity: str,
        start: Any,
        velocity: Any,
        method: str,
        modes: int | None,
        tolerance: float | None,
        snapshots: Any,
        progress: Any,
        partial: bool,
    ) -> Run:
        """Check what is asked."""
        chosen, is_linear = kind.chosen(model, method, modes, partial)
        check.one_of(quantity, "quantity", MOTIONS)
        t = checked_times(time)
        drives, given = _driven(model, kind, drive, force, t)
        loads, kicks = kind.released(model, start), kind.kicked(model, velocity)
        for name, begun in (("start", loads), ("velocity", kicks)):
            refuse_held(model, kind, begun.given, name)
        run = cls(
            model,
            t,
            drives,
            given,
            responses=kind.observed(model, response, drives),
            method=chosen,
            is_linear=is_linear,
            order=MOTIONS[quantity],
            snapshots=_checked_snapshots(snapshots, t),
            modes=None if modes is None else check.count(modes, "modes", most=1_000_000),
            tolerance=check.optional(tolerance, "tolerance", sign="positive"),
            progress=reporter(progress),
            partial=check.instance(partial, "partial", bool, "True or False"),
            transfer=kind.transfer,
        )
        return run.beginning(loads, kicks)

    def beginning(self, loads: Begun, kicks: Begun) -> Run:
        """Return the same from this beginning, and from it at fewer places."""
        run = replace(self, loads=loads.given, kicks=kicks.given)
        if loads.coarse is None and kicks.coarse is None:
            return run
        fewer = [one if one.coarse is None else one.coarse for one in (loads, kicks)]
        return replace(run, coarse=self.beginning(*fewer))

    def but(self, **fields: Any) -> Run:
        """Return the same with other fields, also from the beginning at fewer places."""
        coarse = None if self.coarse is None else self.coarse.but(**fields)
        return replace(self, **({"coarse": coarse} | fields))

    def look(self, drives: tuple[Any, ...], responses: tuple[Point, ...]) -> TransferFunctions:
        """Return transfer functions of the model."""
        return self.transfer(self.model, drives, responses)

    @property
    def struck(self) -> Run:
        """The same with the impulses that begin motion among the forces."""
        drives, given = (*self.drives, *self.kicks), (*self.forces, *self.blows)
        return replace(self, drives=drives, forces=given, kicks={})

    @property
    def places(self) -> list[Any]:
        """What forces and loads act on."""
        return [*self.drives, *self.kicks, *self.loads]

    @property
    def pushes(self) -> list[Force | float]:
        """What acts there: forces, and loads that are let go."""
        return [*self.forces, *self.blows, *self.loads.values()]

    @property
    def as_forces(self) -> tuple[Force, ...]:
        """The same as forces: a load that is let go is a step back from the rest under it."""
        begin = float(self.time[0])
        loads = [Step(-load, time=begin) for load in self.loads.values()]
        return (*self.forces, *self.blows, *loads)

    @property
    def blows(self) -> list[Force]:
        """The impulses that begin motion."""
        return [Impulse(size, time=float(self.time[0])) for size in self.kicks.values()]

    @property
    def push(self) -> Real:
        """What drives, at the times, shape (drives, t)."""
        still = np.zeros((0, len(self.time)))
        return np.stack([one.value(self.time) for one in self.forces]) if self.forces else still

    @property
    def kept(self) -> Run:
        """The same for what is computed later: it says nothing, and pickles."""
        return replace(self, progress=silent)

    @property
    def told(self) -> dict[str, Any]:
        """What a history says of it."""
        return {
            "drive": self.drives,
            "response": self.responses,
            "quantity": list(MOTIONS)[self.order],
            "coordinates": self.model.coordinates,
            "time": self.time,
            "force": self.push,
            "law": self.forces,
            "released": bool(self.loads),
            "snapshot_time": self.snapshots,
        }


class Kind(NamedTuple):
    """How a kind of model takes what is asked over time."""

    # model, method, modes and partial as they are given: the method, and whether sums tell motion
    chosen: Callable[[Any, Any, Any, Any], tuple[str, bool]]
    driven: Callable[[Any, Any], tuple[tuple[Point, ...], bool]]  # and whether a list is given
    holds: Callable[[Any, Point], bool]
    observed: Callable[[Any, Any, tuple[Point, ...]], tuple[Point, ...]]
    released: Callable[[Any, Any], Begun]
    kicked: Callable[[Any, Any], Begun]
    transfer: Callable[[Any, tuple[Any, ...], tuple[Point, ...]], TransferFunctions]


def _chosen(model: Compiled, method: Any, modes: Any, _partial: Any) -> tuple[str, bool]:
    """Say whether the model is linear; refuse what tells linear motion where it is not."""
    chosen: str = check.one_of(method, "method", METHODS)
    if chosen == "line" and modes is not None:
        raise SceneError(f'modes must be left out where method is "line", got {modes!r}')
    why = why_not_linear(model)
    if method in ("modal", "line") and why:
        raise SceneError(f'method must be "auto" or "events" where {why}, got "{method}"')
    return chosen, not why


def why_not_linear(model: Compiled) -> str:
    """Say why modes do not tell the motion, with nothing where they do."""
    for one in scene_laws(model.scene):
        return f"{one.name} is not linear"
    tension = model.scene.tension
    if isinstance(tension, Tension) and not tension.is_constant:
        return "the tension pulsates" if tension.pulsates else "the tension is stretching"
    return ""


def checked_times(given: Any) -> Real:
    """Return times that increase."""
    t = check.numbers(given, "time", "s", sign="nonnegative")
    if len(t) < 2:
        raise SceneError(f"time must hold two times at least [s], got {len(t)}")
    falls = np.flatnonzero(~(np.diff(t) > 0))
    if len(falls):
        k = int(falls[0])
        raise SceneError(
            f"time must increase, got time[{k}] = {float(t[k])!r} and time[{k + 1}] = "
            f"{float(t[k + 1])!r} s"
        )
    return t


def _driven(
    model: Any, kind: Kind, drive: Any, force: Any, time: Real
) -> tuple[tuple[Point, ...], tuple[Force, ...]]:
    """Return what is driven and by which forces."""
    if (drive is None) != (force is None):
        raise SceneError("give both drive and force, or neither")
    if drive is None:
        return (), ()
    drives, several = kind.driven(model, drive)
    refuse_held(model, kind, drives, "drive")
    return drives, _acting_forces(drives, force, time, several=several)


def refuse_held(model: Any, kind: Kind, places: Iterable[Point], name: str) -> None:
    """Refuse to push what a support holds; ends are moved."""
    for point in places:
        if not is_end(point) and kind.holds(model, point):
            raise SceneError(f"{name} must be free to move, got {point}, which a support holds")


def _acting_forces(
    drives: tuple[Point, ...], force: Any, time: Real, *, several: bool
) -> tuple[Force, ...]:
    """Return the force on each drive; several: whether a list of them is given."""
    if not several:
        return (forces(force, "force", time, push_unit(drives[0])),)
    if not isinstance(force, (tuple, list, np.ndarray)) or len(force) != len(drives):
        raise SceneError(
            f"force must be one for each of the {len(drives)} drives, got {check.shown(force)}"
        )
    return tuple(
        forces(one, f"force[{k}]", time, push_unit(drive))
        for k, (one, drive) in enumerate(zip(force, drives))
    )


def _checked_snapshots(given: Any, time: Real) -> Real:
    """Return times within others, none where none are given."""
    if given is None:
        return np.zeros(0)
    when = check.numbers(given, "snapshots", "s", sign="nonnegative")
    if (when < time[0]).any() or (when > time[-1]).any() or (np.diff(when) <= 0).any():
        raise SceneError(
            f"snapshots must increase within time, {float(time[0])!r} to {float(time[-1])!r} s, "
            f"got {check.shown(given)}"
        )
    return when


def _holds(model: Compiled, point: Point) -> bool:
    return is_held(model.chain, model.x, model.coordinates, point)


DRIVEN = partial(points, name="drive", forces=False, ends=True)
STRAIGHT = Kind(_chosen, DRIVEN, _holds, observed, released, kicked, Transfer)
"""Of chains and spans of a straight rope."""
