"""Motion of a rope on an axis over time: its transfer functions, inverted."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from ..base import check
from ..base.array import Complex, Real
from ..base.computed import Late, changed
from ..base.errors import SceneError, SolveError
from ..base.progress import reporter
from ..base.unit import MOTIONS, push_unit
from ..chain.port import Point
from ..motion.history import History
from ..motion.line.transfer import growth_below
from ..motion.linear import solve_linear, within_tolerance
from ..motion.modal.expansion import refuse_losses
from ..motion.request import Run, acting_forces, checked_snapshots, checked_times
from ..response.critical import exceeds
from ..response.deflection import Deflection, summed_loads
from ..response.frf import FRF
from ..scene.agree import in_space
from .compile import finer_rope
from .response import Request, checked_points, solve_frf, watched
from .rope import SIX
from .spectrum import count_below, lowest

if TYPE_CHECKING:
    from .model import SpaceModel

METHODS = ("auto", "line")
ALONE = {"modes": None, "partial": False}
"""What belongs to methods of straight ropes, and what it is where nothing is said of it."""


def solve_transient(
    model: SpaceModel,
    time: Any,
    *,
    drive: Any,
    force: Any,
    response: Any,
    quantity: str,
    start: Any,
    velocity: Any,
    method: str,
    tolerance: float | None,
    snapshots: Any,
    progress: Any,
    **others: Any,
) -> History:
    """Find the motion over time; see `SpaceModel.transient`."""
    what, t = in_space(model.scene), checked_times(time)
    check.one_of(quantity, "quantity", MOTIONS)
    _refuse_others(what, method, others)
    drives, forces = _driven(model, drive, force, t)
    run: Any = Run(
        model,  # type: ignore[arg-type]  # of a chain only its own methods ask for more
        t,
        drives,
        forces,
        watched(model.scene, response, drives),
        method="line",
        order=MOTIONS[quantity],
        loads=_released(model, start),
        kicks=_kicked(model, velocity),
        snapshots=checked_snapshots(snapshots, t),
        tolerance=check.optional(tolerance, "tolerance", sign="positive"),
        progress=reporter(progress),
        transfer=SpaceTransfer,
    )
    history = solve_linear(run)
    return changed(
        history,
        mesh_error=Late(partial(_mesh, run.kept, history.value)),
        balance=partial(_refuse_energy, what),
    )


def solve_stepped(
    model: SpaceModel,
    frequency: Any,
    *,
    drive: Any,
    amplitude: float,
    branches: bool,
    tolerance: float | None,
    progress: Any,
    **asked: Any,
) -> FRF:
    """Find the steady motion under a sine; see `SpaceModel.stepped_sine`."""
    drives, several = checked_points(model.scene, drive, "drive")
    if several:
        raise SceneError(f"drive must be one point, got {len(drives)}")
    if branches is not False:
        raise SceneError(
            f"branches must be False for {in_space(model.scene)}, whose linear motion has one, got "
            f"{check.shown(branches)}"
        )
    f = check.frequencies(frequency)
    if not f.min() > 0:
        raise SceneError(f"frequency must be > 0 [Hz], got {float(f.min())!r}: that is `static`")
    check.number(amplitude, "amplitude", push_unit(drives[0]), sign="positive")
    check.optional(tolerance, "tolerance", sign="positive")
    refuse_losses(model)  # type: ignore[arg-type]  # of a scene
    if count_below(model.rope, 0.0):
        raise SolveError("there is no steady state: the compression is beyond critical")
    frf = solve_frf(model.scene, model.rope, f, drive=drives[0], **asked)
    reporter(progress)(1.0)
    return changed(frf, stable=np.ones(len(f), dtype=np.bool_))


@dataclass(frozen=True, eq=False)
class SpaceTransfer:
    """What responses are to drives, in the rate s of a motion e^(s t)."""

    model: SpaceModel
    drives: tuple[Point, ...]
    responses: tuple[Point, ...]
    most: ClassVar[int] = 1 << 15  # each takes a hundred times as long as one of a straight rope

    @property
    def growth(self) -> float:
        """How fast motion grows at most [1/s]."""
        scene, rope, least = self.model.scene, self.model.rope, 0.0
        if count_below(rope, 0.0):
            least = min(least, float(lowest(rope, 1, math.inf).eigenvalue[0]))
        pushes = bool((np.linalg.eigvalsh(rope.springs) < 0).any())
        return growth_below(least, scene.dampings, pushes=pushes)

    def at(self, s: Complex) -> Complex:
        """Return it, shape (drives, responses, n)."""
        return self._asked(s).receptance()

    def rounding(self, s: Complex) -> Real:
        """Return what bounds its rounding, shape (drives, responses, n)."""
        return self._asked(s).rounding()

    def _asked(self, s: Complex) -> Request:
        model, frequency = self.model, s.imag / (2 * math.pi)
        ends = self.drives, self.responses
        return Request.of(model.scene, model.rope, frequency, *ends, decay=s.real)


def _refuse_others(what: str, method: str, others: dict[str, Any]) -> None:
    """Refuse methods that need a chain, and what belongs to them."""
    if method not in METHODS:
        raise SceneError(
            f'method must be "line" or "auto" for {what}, of which exact transfer functions are '
            f"known and no chain or modal sum, got {check.shown(method)}"
        )
    for name, value in others.items():
        if value != ALONE[name]:
            raise SceneError(
                f"{name} must be left out for {what}, whose motion the line finds without it, got "
                f"{check.shown(value)}"
            )


def _driven(
    model: SpaceModel, drive: Any, force: Any, time: Real
) -> tuple[tuple[Point, ...], tuple[Any, ...]]:
    """Return what is driven, and by which forces."""
    if (drive is None) != (force is None):
        raise SceneError("give both drive and force, or neither")
    if drive is None:
        return (), ()
    drives, several = checked_points(model.scene, drive, "drive")
    pushed = [point for point in drives if not check.is_end(point)]
    near = check.NEAR * model.scene.rope.length
    cut, node = model.rope.cut(np.array([at for _, at in pushed]), near)
    for at, point in zip(node, pushed):
        if cut.held[at, SIX.index(point[0])]:
            raise SceneError(f"drive must be free to move, got {point}, which a support holds")
    return drives, acting_forces(drives, force, time, several=several)


def _released(model: SpaceModel, start: Any) -> dict[Point, float]:
    """Return the loads that are let go [N, N m]."""
    if start is None:
        return {}
    if isinstance(start, Deflection):
        return dict(start.load)
    loads = _loads(model, start, "start")
    critical = count_below(model.rope, -1e-13 * model.rope.unit)
    if critical:
        raise SolveError(
            f"the rope does not stay at rest: {exceeds(critical)}; start takes "
            "SpaceModel.static(.., unstable=True) all the same"
        )
    return loads


def _kicked(model: SpaceModel, velocity: Any) -> dict[Point, float]:
    """Return the impulses that begin motion [N s, N m s]."""
    return {} if velocity is None else _loads(model, velocity, "velocity")


def _loads(model: SpaceModel, given: Any, name: str) -> dict[Point, float]:
    shapes = given.values() if isinstance(given, dict) else [given]
    if any(map(callable, shapes)):
        raise SceneError(
            f"{name} must be loads at points for {in_space(model.scene)}: a shape along it would "
            "have to keep what its curvature ties together"
        )
    return summed_loads(given, model.coordinates, model.scene.rope.length, name)


def _mesh(run: Run, value: Real) -> Real:
    """Return the distance to the motion of shorter pieces and the error of that, as value."""
    model: Any = run.model
    finer = finer_rope(model.scene, model.rope)
    if finer is None:
        return np.zeros(value.shape)
    other: Any = replace(model, rope=finer)
    true = within_tolerance(replace(run, model=other, snapshots=np.zeros(0)))
    return np.abs(value - true.value) + true.error


def _refuse_energy(what: str) -> Any:
    raise SceneError(
        f"energy is not carried for {what}: it is a sum over modes, and its motion is found "
        "without them"
    )
