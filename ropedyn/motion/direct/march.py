"""One chain moving: its state, and steps that lead on."""

from __future__ import annotations

import math
from collections import OrderedDict
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ... import _core
from ...base.array import Real
from ...base.errors import SolveError
from ...chain.chain import Chain
from ...chain.port import Ports
from .beside import Beside
from .lumped import Lumps, State
from .newton import Stage, solve_stage
from .point_law import Laws

KEEPS = 0.25  # The scheme with this stage keeps energy,
FORGETS = 1 - math.sqrt(0.5)  # and this one lets what has no inertia follow at once.
PLANS = 8  # So many factorisations are kept, each of a length of steps.
KINETIC, STRAIN, INPUT, DISSIPATED, LAWS = ENERGIES = range(5)


System = tuple[Chain, Beside, Laws, NDArray[np.uint8], float, float, State]


def stage_of(spectral_radius: float) -> float:
    """Return g of the scheme that multiplies infinitely fast motion by rho in each step."""
    # (1 - rho) g^2 - 2 g + 1/2 = 0, see csrc/march/form/march.h; 1/4 for rho = 1
    return 1 / (2 * (1 + math.sqrt((1 + spectral_radius) / 2)))


class Push(NamedTuple):
    """What pushes a chain during steps."""

    force: Real  # (steps, 2, drives) at the stages [N, N m]
    speed: Real  # (steps, 2, moved) of ends [m/s, rad/s]
    extra: Real | None  # (steps, 2) tension [N]


@dataclass(frozen=True, eq=False)
class Stride:
    """Where steps led."""

    # (done, 3, responses) displacement (or internal force), velocity and acceleration at the ends
    # of steps
    read: Real
    # (done, 5) kinetic and strain energy there; input, dissipated and what laws took during the
    # step [J]
    energy: Real
    error: BaseException | None = None  # what stopped the step after those

    def then(self, other: Stride) -> Stride:
        """Return it and the steps after it."""
        read = np.concatenate([self.read, other.read])
        return Stride(read, np.concatenate([self.energy, other.energy]), other.error)


class Motion:
    """The motion of one chain."""

    def __init__(self, lumps: Lumps, *, refined: bool) -> None:
        self.lumps = lumps
        self.refined = refined
        self.state = lumps.start.copy()
        self.late = 0.0
        self.stages = 0
        self.factorisations = 0
        self._plans: OrderedDict[float, NDArray[np.uint8]] = OrderedDict()

    @property
    def rests(self) -> bool:
        """Whether nothing is deflected and nothing moves."""
        return not any(array.any() for array in self.state)

    def push(self, time: Real, h: float, g: float, begin: float, end: float) -> Push:
        """Return what pushes during steps.

        The speeds lead ends that are moved to where they are at the end of each step exactly. So
        do forces what has no inertia, by the scheme that keeps energy, of two midpoint steps: it
        takes them as means over both ends of these. Where they act there, at the middle, it would
        be off by as much at each end, with another sign each time, and its velocity more and more.
        """
        lumps = self.lumps
        stages = time[:-1, None] + h * np.array([g, 1 - g])
        force = np.zeros((len(stages), 2, len(lumps.forces)))
        inside = time.copy()
        inside[0] += begin
        inside[-1] -= end
        for k, (one, follows) in enumerate(zip(lumps.forces, lumps.is_bare)):
            if follows and g == KEEPS:
                ends, middle = one.value(inside), one.value((time[:-1] + time[1:]) / 2)
                force[..., k] = np.stack([ends[:-1] + middle, middle + ends[1:]], axis=1) / 2
            else:
                force[..., k] = one.value(stages)
        speed = np.zeros((len(stages), 2, len(lumps.motions)))
        for k, (one, place) in enumerate(zip(lumps.motions, lumps.moved)):
            where = one.value(inside)
            where[0] = self.state.u[tuple(place)]
            rate = one.rate(stages)
            speed[..., k] = rate + (np.diff(where) / h - rate.mean(axis=1))[:, None]
        extra = None if lumps.pulsation is None else lumps.pulsation(stages)
        return Push(force, speed, extra)

    def stride(self, time: Real, h: float, g: float, edges: tuple[float, float]) -> Stride:
        """Take steps under the forces of their times; see `push`."""
        return self.advance(self.push(time, h, g, *edges), time, h, g)

    def advance(
        self, push: Push, time: Real, h: float, g: float, *, refined: bool = False
    ) -> Stride:
        """Take steps from the state, which is then where they lead."""
        self.stages += 2 * len(push.force)
        if self.lumps.calls:
            return self._call(push, time, h, g)
        refined = refined or self.refined
        return self._march(push, time, h, g, drive=self.lumps.drives, refined=refined)

    def probe(self, push: Push, time: Real, h: float) -> Stride:
        """Return what a step reads and where energy is before it, without taking it."""
        state = self.state.copy()
        stride = self.advance(push, time, h, KEEPS)
        self.state = state
        if stride.error is None:
            # kept exactly by this scheme: what was there before the step
            with np.errstate(over="ignore", invalid="ignore"):
                change = stride.energy[0, [INPUT, DISSIPATED, LAWS]] @ [-1, 1, 1]
                stride.energy[0, KINETIC] += change
        return stride

    def _march(
        self, push: Push, time: Real, h: float, g: float, *, drive: Ports, refined: bool
    ) -> Stride:
        lumps = self.lumps
        system = self._system(g, h, self.state)
        pushes = (drive, push.force, lumps.moved, push.speed, push.extra)
        read, energy, taken, done, residual = _core.march(
            *system, *pushes, lumps.readout.ports, True, refined
        )
        if push.extra is not None:
            self.factorisations += 2 * done
        energies = np.column_stack([energy, np.zeros(len(energy))])
        # of what laws took dashpots dissipate
        is_dashpot = lumps.laws.kind == 0
        energies[:, DISSIPATED] += taken[:, is_dashpot].sum(axis=1)
        energies[:, LAWS] += taken[:, ~is_dashpot].sum(axis=1)
        error = None
        if done < len(push.force):
            error = SolveError(
                f"the step at t = {float(time[done])!r} s does not converge, {h:.3g} s long: the "
                f"residual is {residual:.3g} of its terms"
            )
        return Stride(read[:done], energies[:done], error)

    def _system(self, g: float, h: float, state: State) -> System:
        """Return what the core marches, with the factors of a stage."""
        lumps, theta = self.lumps, g * h
        what = (lumps.chain, lumps.beside, lumps.laws)
        if theta not in self._plans:
            self._plans[theta] = _core.march_factor(*what, theta, 0.0)
            self.factorisations += 1
            if len(self._plans) > PLANS:
                self._plans.popitem(last=False)
        self._plans.move_to_end(theta)
        return (*what, self._plans[theta], g, h, state)

    # --- laws that Python knows -----------------------------------------------------------------

    def _call(self, push: Push, time: Real, h: float, g: float) -> Stride:
        """Take steps one by one, with forces of laws that make each stage hold."""
        steps = len(push.force)
        read = np.zeros((steps, 3, len(self.lumps.readout.ports.node)))
        energy = np.zeros((steps, len(ENERGIES)))
        guess = np.zeros((2, len(self.lumps.calls)))
        for k in range(steps):
            now = Push(push.force[k : k + 1], push.speed[k : k + 1], None)
            try:
                given, taken = self._stages(now, float(time[k]), h, g, guess)
                stride = self._with_given(now, given, h, g)
            except BaseException as error:
                return Stride(read[:k], energy[:k], error)
            guess = given
            read[k], energy[k] = stride.read[0], stride.energy[0]
            energy[k, INPUT] += taken  # the laws' share of what drives put in
            energy[k, LAWS] += taken
        return Stride(read, energy)

    def _stages(
        self, push: Push, time: float, h: float, g: float, guess: Real
    ) -> tuple[Real, float]:
        """Return the forces of Python's laws at both stages of a step, and what they took [J]."""
        lumps, theta = self.lumps, g * h
        system = self._system(g, h, self.state.copy())
        calls = [one.law for one in lumps.calls]
        given, taken = np.zeros_like(guess), 0.0
        for stage, at in enumerate((time + theta, time + h - theta)):
            force, speed = push.force[0, stage], push.speed[0, stage]
            x, C, q = _core.march_stage(*system, stage, lumps.drives, force, lumps.moved, speed)
            full, velocity = solve_stage(Stage(lumps, theta, at, x, C, q), guess[stage])
            given[stage] = full[calls]
            taken -= h / 2 * float(full[calls] @ velocity[calls])
            _core.march_finish(*system, stage, full)
        return given, taken

    def _with_given(self, push: Push, given: Real, h: float, g: float) -> Stride:
        """Take a step with the forces of Python's laws as drives."""
        lumps = self.lumps
        calls = [one.law for one in lumps.calls]
        node = np.concatenate([lumps.drives.node, lumps.laws.node[calls]])
        row = np.concatenate([lumps.drives.row, lumps.laws.row[calls]])
        force = np.concatenate([push.force, given[None]], axis=2)
        drives, push = Ports(node, row, None), push._replace(force=force)
        stride = self._march(push, np.zeros(1), h, g, drive=drives, refined=True)
        if stride.error is not None:
            raise stride.error
        return stride
