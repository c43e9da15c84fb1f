"""Motion of a rope on an axis over time: its transfer functions, inverted."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ..base import check
from ..base.array import Complex, Real
from ..base.computed import Late, changed
from ..base.errors import SceneError, SolveError
from ..base.progress import reporter
from ..base.unit import push_unit
from ..chain.port import Point
from ..motion.history import History
from ..motion.line.transfer import growth_below
from ..motion.linear import solve_linear, within_tolerance
from ..motion.modal.expansion import refuse_losses
from ..motion.request import Kind, Run, refuse_held
from ..motion.start import Begun
from ..response.deflection import Deflection, summed_loads
from ..response.frf import FRF
from ..scene.agree import in_space
from .compile import finer_rope
from .response import Request, checked_points, solve_frf, watched
from .rope import SIX
from .spectrum import growing
from .static import refuse_growing

if TYPE_CHECKING:
    from .model import SpaceModel

METHODS = ("auto", "line")
WORK, LEAST = 1 << 23, 32  # Parts of all rates, each with so many more: half a minute.


def solve_transient(model: SpaceModel, time: Any, **asked: Any) -> History:
    """Find the motion over time; see `SpaceModel.transient`."""
    run: Any = Run.of(model, time, IN_SPACE, **asked)
    history = solve_linear(run)
    return changed(
        history,
        mesh_error=Late(partial(_mesh, run.kept, history.value)),
        balance=partial(_refuse_energy, in_space(model.scene)),
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
    f = check.frequencies(frequency, sign="positive")
    refuse_held(model, IN_SPACE, drives, "drive")
    check.number(amplitude, "amplitude", push_unit(drives[0]), sign="positive")
    check.optional(tolerance, "tolerance", sign="positive")
    refuse_losses(model)  # type: ignore[arg-type]  # of a scene
    if len(growing(model.rope)):
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

    @property
    def growth(self) -> float:
        """How fast motion grows at most [1/s]."""
        scene, rope = self.model.scene, self.model.rope
        least = float(growing(rope).min(initial=0.0))
        pushes = bool((np.linalg.eigvalsh(rope.springs) < 0).any())
        return growth_below(least, scene.dampings, pushes=pushes)

    @property
    def ahead(self) -> float:
        """How fast motion fades before what causes it: none does."""
        return math.inf

    def most(self, omega: float, _resolved: int) -> int:
        """Return how many rates are looked at: each takes as long as its parts."""
        asked = self._asked(np.array([1j * omega]))
        try:
            parts = sum(asked.assembled(side, slice(1)).parts for side in asked.components)
        except SolveError:  # too many
            return 0
        return int(WORK / (LEAST + parts))

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


def _chosen(model: SpaceModel, method: Any, modes: Any, partial: Any) -> tuple[str, bool]:
    """Refuse methods that need a chain, and what belongs to them."""
    what = in_space(model.scene)
    if method not in METHODS:
        raise SceneError(
            f'method must be "line" or "auto" for {what}, of which exact transfer functions are '
            f"known and no chain or modal sum, got {check.shown(method)}"
        )
    for name, value, left_out in (("modes", modes, None), ("partial", partial, False)):
        if value != left_out:
            raise SceneError(
                f"{name} must be left out for {what}, whose motion the line finds without it, got "
                f"{check.shown(value)}"
            )
    return "line", True


def _points(model: SpaceModel, given: Any) -> tuple[tuple[Point, ...], bool]:
    return checked_points(model.scene, given, "drive")


def _holds(model: SpaceModel, point: Point) -> bool:
    near = check.NEAR * model.scene.rope.length
    cut, node = model.rope.cut(np.array([point[1] * model.rope.longer]), near)
    return bool(cut.held[node[0], SIX.index(point[0])])


def _observed(model: SpaceModel, given: Any, drives: tuple[Point, ...]) -> tuple[Point, ...]:
    return watched(model.scene, given, drives)


def _released(model: SpaceModel, start: Any) -> Begun:
    """Return the loads that are let go [N, N m]."""
    if start is None:
        return Begun({})
    if isinstance(start, Deflection):
        return Begun(dict(start.load))
    loads = _loads(model, start, "start")
    refuse_growing(model.rope, "start takes SpaceModel.static(.., unstable=True) all the same")
    return Begun(loads)


def _kicked(model: SpaceModel, velocity: Any) -> Begun:
    """Return the impulses that begin motion [N s, N m s]."""
    return Begun({} if velocity is None else _loads(model, velocity, "velocity", " s"))


IN_SPACE = Kind(_chosen, _points, _holds, _observed, _released, _kicked, SpaceTransfer)


def _loads(model: SpaceModel, given: Any, name: str, over: str = "") -> dict[Point, float]:
    shapes = given.values() if isinstance(given, dict) else [given]
    if any(map(callable, shapes)):
        raise SceneError(
            f"{name} must be loads at points for {in_space(model.scene)}: a shape along it would "
            "have to keep what its curvature ties together"
        )
    return summed_loads(given, model.coordinates, model.scene.rope.length, name, over=over)


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
