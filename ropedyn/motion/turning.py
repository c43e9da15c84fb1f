"""What a tension that varies turns: the twist of a laid rope whose tension pulsates.

A tension h(t) beside the mean, the same all along, loads the twist of a laid rope by the torque
(D/EA) h: with C_r = C - D^2/EA

    C_r alpha'' = p alpha_tt,  C_r alpha' = -(D/EA) h at ends that turn,  M = C_r alpha' + (D/EA) h

D and EA are the same all along the rope, so nothing but its ends is loaded. C_r is the torsional
stiffness at a given tension, 1/S_aa of the section flexibility S: the chain of alpha alone has it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from ..base.array import Real
from ..base.computed import changed
from ..base.errors import SceneError
from ..base.unit import OF_FORCE
from ..chain.chain import CHANNELS
from ..chain.compiled import Compiled
from ..chain.port import moving
from ..scene.end import end_of
from ..scene.force import Sine
from ..scene.parts.stretch import refuse_uneven
from ..scene.scene import Scene
from ..scene.tension import Tension
from .acting import scene_laws
from .history import Balance, History
from .linear import loosely, solve_linear
from .moved import against_spans
from .periodic.asked import SteppedSine
from .request import Run

WHY = "where lay_coupling turns the rope under a tension"


def turned(run: Run, solve: Callable[[Run], History]) -> History:
    """Follow a motion, with the twist that a pulsating tension drives in a laid rope."""
    scene = run.model.scene
    _refuse_sag(run.model)
    if not _is_laid(scene) or not isinstance(scene.tension, Tension):
        return solve(run)
    _refuse_stretching(scene)
    if not scene.tension.pulsates:
        return solve(run)
    _refuse(run.model, [moving(point) for point in run.responses if point[0] not in OF_FORCE])
    _refuse_numbered(run)
    history = solve(run)
    if turning_ends(scene):
        history = changed(history, balance=_refuse_energy)
    return _with_twist(run, history) if len(history.time) > 1 else history


def refuse_steady(asked: SteppedSine) -> None:
    """Refuse a steady state to which what the tension drives by itself would belong."""
    _refuse_sag(asked.model)
    scene = asked.model.scene
    if not _is_laid(scene) or not isinstance(scene.tension, Tension):
        return
    _refuse_stretching(scene)
    turns = {moving(point) for point in asked.responses} & {"x", "alpha"}
    if scene.tension.pulsates and turns and (asked.frequency == scene.tension.frequency).any():
        raise SceneError(
            f"frequency must not be that of the pulsating tension, {scene.tension.frequency!r} Hz, "
            f"{WHY}: what it drives by itself is no response to the drive"
        )


def _refuse_sag(model: Compiled) -> None:
    tension = model.scene.tension
    if model.chain.sag is not None and isinstance(tension, Tension) and tension.pulsates:
        raise SceneError(
            "gravity must be None or without sag where the tension pulsates: the sag would pulsate "
            f"with it, got {model.scene.gravity}"
        )


def _is_laid(scene: Scene) -> bool:
    return bool(scene.rope.lay_coupling)


def turning_ends(scene: Scene) -> list[int]:
    """Return the numbers of the ends that are free to turn."""
    return [k for k in (0, 1) if "alpha" not in end_of(scene.ends[k]).term().held]


def _refuse_stretching(scene: Scene) -> None:
    """Refuse twist that acts back on the tension that motion makes."""
    if isinstance(scene.tension, Tension) and scene.tension.stretching and turning_ends(scene):
        raise SceneError(
            f"tension must not be stretching {WHY} and an end is free to turn, which slackens it: "
            'hold alpha at both ends, or ask the scene without("lay")'
        )


def _refuse(model: Compiled, asked: list[str]) -> None:
    """Refuse what the twist cannot be told apart from."""
    scene = model.scene
    if scene.rope.lay_slope:
        raise SceneError(
            f"lay_slope must be None {WHY} that pulsates: it couples twist and bending"
        )
    refuse_uneven(scene.parts, f"{WHY} that pulsates")
    if "x" in asked:
        raise SceneError(
            f"response must not be x {WHY} that pulsates: which end gives way to it is not said"
        )
    for one in scene_laws(scene):
        if turning_ends(scene) and one.point[0] == "alpha":
            raise SceneError(f"{one.name} must be linear on alpha {WHY} that pulsates")


def _refuse_energy() -> Balance:
    raise SceneError(
        f"energy is not told {WHY} that pulsates: what that puts in depends on which end gives way "
        "to it, which is not said"
    )


def _twists(run: Run) -> bool:
    """Whether twist is asked for that the tension drives."""
    asked = len(run.snapshots) or any(moving(point) == "alpha" for point in run.responses)
    return bool(asked and turning_ends(run.model.scene))


def _refuse_numbered(run: Run) -> None:
    """Refuse ratios by number: twist at a given tension has modes of its own."""
    ratios = [damping.term().ratio for damping in run.model.scene.dampings]
    if _twists(run) and any(isinstance(ratio, tuple) for ratio in ratios):
        raise SceneError(
            f"damping ratio must be one number {WHY} that pulsates, got one for each mode: twist "
            "at a given tension has modes of its own, which Model.modes does not number"
        )


def _with_twist(run: Run, history: History) -> History:
    """Add twist, torque and tension to a motion."""
    tension, value = _pulsating(run), history.value.copy()
    extra = _pulsation(tension, history.time, run.order)
    for k, point in enumerate(run.responses):
        value[k] += {"F_x": 1.0, "M_alpha": _share(run)}.get(point[0], 0.0) * extra
    if not _twists(run):
        return changed(history, value=value)
    own = [k for k, point in enumerate(run.responses) if moving(point) == "alpha"]
    until = replace(run.kept, time=history.time, snapshots=history.snapshot_time)
    twist, error, snapshot = _twist(until), history.error.copy(), history.snapshot.copy()
    value[own] += twist.value
    error[own] += twist.error
    at = run.model.coordinates.index("alpha")
    snapshot[:, :, at] += twist.snapshot[:, :, 0]
    mesh_error = partial(_mesh_error, until, history, own, twist.value)
    return changed(history, value=value, error=error, snapshot=snapshot, mesh_error=mesh_error)


def _mesh_error(run: Run, history: History, own: list[int], twist: Real) -> Real:
    """Return that of a motion and of the twist beside it."""
    missed = history.mesh_error.copy()
    missed[own] += against_spans(run, twist, partial(loosely, _twist))
    return missed


def _pulsation(tension: Tension, time: Real, order: int) -> Real:
    """Return what pulsation adds to the tension, `order` times differentiated."""
    most = tension.amplitude * (2 * math.pi * tension.frequency) ** order
    phase = tension.phase + (1 + order) * math.pi / 2
    return Sine(most, tension.frequency, phase=phase).value(time)


def _pulsating(run: Run) -> Tension:
    tension = run.model.scene.tension
    assert isinstance(tension, Tension)
    return tension


def _share(run: Run) -> float:
    """Return D/EA [m]."""
    rope = run.model.scene.rope
    return (rope.lay_coupling or 0.0) / (rope.axial_stiffness or math.inf)


def _twist(run: Run) -> History:
    """Return the motion of twist alone, under the moments of the tension on ends that turn."""
    tension, chain = _pulsating(run), run.model.chain.only(("alpha",))
    at, own = CHANNELS["alpha"], np.zeros_like(chain.flexibility)
    own[:, at, at] = chain.flexibility[:, at, at]
    chain = chain._replace(flexibility=own)  # nothing couples it: sweeps take closed forms
    alone = replace(
        run.model,
        coordinates=("alpha",),
        components=(("alpha",),),
        chain=chain,
        unknowns=(chain.free,),
    )
    moment, phase = _share(run) * tension.amplitude, tension.phase + math.pi / 2
    ends = turning_ends(run.model.scene)
    twisting = replace(
        run,
        model=alone,
        drives=tuple(("alpha", float(run.model.x[-end])) for end in ends),
        forces=tuple(Sine((1 - 2 * end) * moment, tension.frequency, phase=phase) for end in ends),
        responses=tuple(point for point in run.responses if moving(point) == "alpha"),
        loads={},
        kicks={},
        coarse=None,
        modes=None,
    )
    return solve_linear(twisting)
