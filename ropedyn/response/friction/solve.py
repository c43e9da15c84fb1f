"""The response of a rope with friction between wires, at one amplitude of the drive."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from ...base import check
from ...base.answer import Cost
from ...base.array import Complex, Real
from ...base.errors import SceneError, SolveError
from ...base.unit import FORCE, QUANTITIES, push_unit
from ...chain.compile import compile_scene
from ...chain.compiled import Compiled, rubbing
from ...chain.place import observed, points
from ...chain.port import Point, moving
from ...scene.damping import WireFriction
from ...scene.parts.part import stretches
from ...scene.parts.stretch import RopeChange, changes
from ...scene.scene import Scene
from ...scene.tension import Tension
from ..frf import MeshOfResponse, RoundingOfResponse
from ..harmonic import solve_harmonic
from .answer import FrictionResponse
from .balance import Layers, SlipBalance
from .cells import edges, wave_number

BLOCK = 32  # Frequencies whose transfer functions are kept at once.
OTHERS = {"solver": "sweep", "decay": 0.0, "harmonic": 1, "branches": False, "tolerance": None}
"""What else is asked of responses must be so."""
MOMENT = FORCE["beta"]
BENDING = RopeChange._fields.index("bending")


class Parts(NamedTuple):
    """Transfer functions of cells, at some frequencies."""

    driven: Complex  # (f, cells) curvature per drive
    moved: Complex  # (f, cells, cells) per moment
    free: Complex  # (f, responses) per drive
    felt: Complex  # (f, responses, cells) per moment

    @classmethod
    def of(cls, H: Complex, x: Real, step: int) -> Parts:
        """Take them from H, drives and responses at all edges first; every `step`-th is one."""
        n, length = len(x), np.diff(x[::step])[:, None]
        pairs = np.diff(H[:n:step], axis=0).T
        turned, bent = np.diff(H[n, :n:step], axis=0), np.diff(pairs[:, :n:step], axis=1)
        return cls((turned / length).T, bent / length, H[n, n:].T, pairs[:, n:])


@dataclass(frozen=True, eq=False)
class Rubbing:
    """A scene whose wires rub, and what is asked of it."""

    linear: Compiled  # whose wires stick
    friction: WireFriction
    drive: Point
    amplitude: float
    responses: tuple[Point, ...]
    x: Real  # edges of cells
    threads: int | None

    def parts(self, frequency: Real, steps: tuple[int, ...]) -> list[Parts]:
        """Solve for the transfer functions of cells of so many."""
        x = self.x[:: min(steps)]
        turns: list[Point] = [("beta", float(at)) for at in x]
        H = solve_harmonic(
            self.linear,
            frequency,
            drive=[*turns, self.drive],
            response=[*turns, *self.responses],
            threads=self.threads,
        ).value
        return [Parts.of(H, x, step // min(steps)) for step in steps]

    def layers(self, step: int) -> Layers:
        """Return what sticks in each cell; a changed stretch changes it as its rope."""
        x, scene = self.x[::step], self.linear.scene
        stations, middle = self.linear.x, (x[1:] + x[:-1]) / 2
        factor = changes(stretches(scene.parts), stations)[:, BENDING]
        factor = factor[stations.searchsorted(middle) - 1]
        first = np.array(self.friction.slip) * max(scene.mean_tension, 0.0)
        stiffness = factor[:, None] * np.array(self.friction.stiffness)
        return Layers(stiffness, np.tile(first, (len(middle), 1)))

    def own(self, step: int) -> Real:
        """Return of which cell a response feels the moment itself, (responses, cells)."""
        edge = self.x[::step]
        own = np.zeros((len(self.responses), len(edge) - 1))
        for row, (name, at) in zip(own, self.responses):
            # an internal force is told just left of its place
            row[max(int(edge.searchsorted(at)) - 1, 0)] = name == MOMENT
        return own


class CellCourse:
    """The frequencies of one size of cells, one after another."""

    def __init__(self, asked: Rubbing, step: int) -> None:
        self.asked, self.layers, self.own = asked, asked.layers(step), asked.own(step)
        self.kappa: list[Complex] = []
        self.value: list[Complex] = []
        self.several: list[bool] = []

    def take(self, frequency: Real, parts: Parts, near: list[Complex] | None = None) -> None:
        """Find the motion at some frequencies, near some where that is given."""
        A = self.asked.amplitude
        for k, (f, driven, moved, free, felt) in enumerate(zip(frequency.tolist(), *parts)):
            balance = SlipBalance(self.layers, A * driven, moved)
            start = self.kappa[-1:] if near is None else [near[k]]
            found = balance.found(start, alone=near is not None)
            if found is None:
                raise SolveError(
                    f"frequency {f!r} Hz: no steady motion was found with friction between wires "
                    f"at the amplitude {A!r}"
                )
            self.kappa.append(found.kappa)
            self.several.append(found.several)
            lack = balance.lack(found.kappa)
            self.value.append(free + (self.own - felt) @ lack / A)


def solve_rubbing(
    model: Compiled,
    frequency: ArrayLike,
    *,
    drive: Any,
    amplitude: float | None,
    response: Any = None,
    quantity: str = "receptance",
    threads: int | None = None,
    **others: Any,
) -> FrictionResponse:
    """Compute the response with friction between wires; see `Model.frf`."""
    check.one_of(quantity, "quantity", QUANTITIES)
    for name, got in others.items():
        if got != OTHERS[name]:
            raise SceneError(
                f"{name} must be {OTHERS[name]!r} with friction between wires, got {got!r}"
            )
    f = check.frequencies(frequency)
    asked = _asked(model, f, drive, amplitude, response=response, threads=threads)
    fine, coarse = CellCourse(asked, 1), CellCourse(asked, 2)
    third: list[float] = []
    for block in np.split(f, range(BLOCK, len(f), BLOCK)):
        begin, (small, large) = len(fine.kappa), asked.parts(block, (1, 2))
        fine.take(block, small)
        coarse.take(block, large, [(one[::2] + one[1::2]) / 2 for one in fine.kappa[begin:]])
        third += _third(asked, coarse, block, coarse.kappa[begin:])
    power = (2j * np.pi * f) ** QUANTITIES[quantity]
    value, other = np.array(fine.value).T * power, np.array(coarse.value).T * power
    error = np.abs(value - other) + np.array(third) * np.abs(value)
    rounding = RoundingOfResponse.of(value, error)
    return FrictionResponse(
        (asked.drive,),
        asked.responses,
        quantity=quantity,
        frequency=f,
        value=value,
        rounding=rounding,
        rounding_bound=rounding.rounding_error,
        mesh=MeshOfResponse(np.zeros(value.shape)),
        cost=Cost("friction", len(asked.linear.x) - 1, 2 * (len(asked.x) - 1), sweeps=4 * len(f)),
        drive_amplitude=asked.amplitude,
        x=asked.x,
        third_harmonic=np.array(third),
        several=np.array(fine.several),
        **_equivalent(asked, fine),
    )


def _asked(
    model: Compiled, f: Real, drive: Any, amplitude: Any, *, response: Any, threads: int | None
) -> Rubbing:
    """Check what is asked."""
    _refuse(model)
    drives, several = points(model, drive, "drive", forces=False, ends=True)
    if several:
        raise SceneError(f"drive must be one point with friction between wires, got {len(drives)}")
    if moving(drives[0]) not in model.component_of("beta"):
        raise SceneError(f"drive must bend the rope with friction between wires, got {drives[0]}")
    if amplitude is None:
        raise SceneError(
            "amplitude must be given with friction between wires, on which stiffness and loss "
            f"depend [{push_unit(drives[0])}], got None"
        )
    A = check.number(amplitude, "amplitude", push_unit(drives[0]), sign="positive")
    scene, friction = model.scene, rubbing(model)
    assert friction is not None
    linear = compile_scene(scene.without(WireFriction.kind))
    x = _edges(scene, friction, linear.x, drives[0], 2 * np.pi * float(f.max()))
    return Rubbing(linear, friction, drives[0], A, observed(model, response, drives), x, threads)


def _edges(
    scene: Scene, friction: WireFriction, stations: Real, drive: Point, omega: float
) -> Real:
    """Return where cells end, with the least B that the rope may have."""
    rope, T = scene.rope, scene.mean_tension
    B = rope.bending_stiffness
    assert isinstance(B, float)
    if drive[0] != "end":
        stations = np.append(stations, drive[1])
    stations = np.unique(stations)
    near = np.append(True, np.diff(stations) > check.NEAR * rope.length)
    sliding = B - sum(friction.stiffness)
    wave = wave_number(sliding, T, rope.linear_density, omega)
    return edges(stations[near], sliding, T, wave)


def _refuse(model: Compiled) -> None:
    """Refuse what friction between wires is not known with."""
    where, scene = "with friction between wires", model.scene
    if model.element != "continuous":
        raise SceneError(f"elements must be left out {where}, which is known on continuous spans")
    if isinstance(scene.tension, Tension) and not scene.tension.is_constant:
        raise SceneError(f"tension must be constant {where}, got {check.shown(scene.tension)}")
    if scene.is_graded:
        raise SceneError(f"gravity must not change the tension {where}: say own_weight=False")
    if "hinge" in scene.effects:
        raise SceneError(f"parts must not hold a hinge {where}, whose curvature is not told")
    if model._nonlinear:
        raise SceneError(f"{model._nonlinear} {where}: nothing else may be nonlinear beside it")


def _third(asked: Rubbing, coarse: CellCourse, f: Real, kappas: list[Complex]) -> list[float]:
    """Return the curvature at three times the frequency that is left out, relative."""
    try:
        (parts,) = asked.parts(3 * f, (2,))
    except SolveError:
        if len(f) == 1:
            return [np.inf]
        return [_third(asked, coarse, f[k : k + 1], [one])[0] for k, one in enumerate(kappas)]
    found = []
    for kappa, moved in zip(kappas, parts.moved):
        size = np.abs(kappa)
        loops = coarse.layers.at(size)
        phase = np.divide(kappa, size, out=np.zeros_like(kappa), where=size > 0)
        moment = loops.third * size * phase**3
        held = np.eye(len(kappa)) + moved * (loops.first - coarse.layers.whole)
        found.append(
            float(np.abs(np.linalg.solve(held, moved @ moment)).max() / (size.max() or 1.0))
        )
    return found


def _equivalent(asked: Rubbing, course: CellCourse) -> dict[str, Any]:
    """Return curvature, B and loss factor in each cell, (cells, f)."""
    kappa = np.abs(np.array(course.kappa)).T
    layers = np.array([course.layers.at(one).first for one in kappa.T]).T
    B = asked.linear.scene.rope.bending_stiffness
    assert isinstance(B, float)
    sliding = course.layers.whole[:, None] * (B / sum(asked.friction.stiffness) - 1)
    B_cell = layers.real + sliding
    return {"curvature": kappa, "bending_stiffness": B_cell, "loss_factor": layers.imag / B_cell}
