"""Where the energy of a chain is, by steps in which what acts on modes is constant.

Work that forces of laws and the tension do in a step is exact, so that nothing is lost where
nothing drives; of what drives, the force in the middle of a step times the way.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...base.array import Real
from ...base.errors import SceneError, SolveError
from ...chain.port import Point, local, locate, moving
from ...eigen.damped.rates import Rates, elastic
from ..acting import scene_laws
from ..history import Balance, History
from ..modal.energy_balance import DrivenModes, refuse_moved_ends
from ..moved import Moved
from ..request import TOLERANCE, Run
from ..smooth.passage import Runs, Steps, reach
from ..smooth.system import OutputTimes
from .steps import CoupledPassage, StepsTaken
from .system import CoupledSystem, moving_together, tension_of

NAMES = ("kinetic", "strain", "input", "dissipated", "laws")
MOST_STEPS = 4_000_000
FELT = 4.0  # Energies are off by so many times what motion is, relative: 0.1 to 1.6 measured.
ROUNDING = 1e-12  # Energies of less than this part of the largest are not told.

Solve = Callable[[Run], History | Moved]


def balance(run: Run, solve: Solve | None = None) -> Balance:
    """Return the energies at the times of a run on a chain; `solve` tells motion exactly."""
    refuse_moved_ends(run)
    total = np.zeros((len(NAMES), len(run.time)))
    laws = scene_laws(run.model.scene)
    calls = any(one.law.kind == "call" for one in laws)
    for component in moving_together(run.model):
        if calls or any(moving(place) in component for place in run.places):
            places = [] if solve is None else _lagging(run, component)
            looks = [OutputTimes(slice(0, len(places)), run.time, 0)] if places else []
            energies, moved = _agreed(CoupledSystem.coupled(run, component, places, looks), run)
            total += energies
            if solve is not None and places:
                exact = solve(run.but(responses=tuple(places), order=0))
                _refuse_other_motion(exact.value, moved[0], run)
    for component in run.model.components:
        total[:4] += _inside_elements(run, component)
    energy = dict(zip(NAMES, total))
    if all(one.law.kind == "power" for one in laws):
        del energy["laws"]
    return Balance(energy)


def _inside_elements(run: Run, component: tuple[str, ...]) -> Real:
    """Return the first four energies of elements that are driven between their nodes."""
    model, chain = run.model, run.model.chain.only(component)
    drive = [k for k, place in enumerate(run.places) if moving(place) in component]
    places = [run.places[k] for k in drive]
    each = [[local(chain, model.x, component, a, b) for a in places] for b in places]
    rest = np.array(each).reshape(len(drive), len(drive))
    if not rest.any():
        return np.zeros((4, len(run.time)))
    lag = _lags(run, component)
    if tension_of(model, component) or len(lag) > 1:
        raise SceneError(
            "drive must be at nodes for energy where the tension varies, or where sections and "
            f"tension are damped each in its own way, got {', '.join(map(str, places))}"
        )
    return np.stack(DrivenModes.without(run, drive, rest, lag.pop()).energies())


def _lags(run: Run, component: tuple[str, ...]) -> set[float]:
    """Return how sections and tension lag [s]: one number where both do so alike."""
    holding = elastic(run.model.chain.only(component))
    return {*Rates.of(run.model.scene.dampings).linear[holding].real}


def _lagging(run: Run, component: tuple[str, ...]) -> list[Point]:
    """Return driven nodes that dampers of first order in the tension may move otherwise."""
    if run.model.element != "tensed" or len(_lags(run, component)) == 1:
        return []
    driven = dict.fromkeys(place for place in run.places if moving(place) in component)
    return [place for place in driven if locate(run.model.x, place[1])[1] is None]


def _refuse_other_motion(exact: Real, moved: Real, run: Run) -> None:
    tolerance = TOLERANCE if run.tolerance is None else run.tolerance
    apart, most = FELT * np.abs(moved - exact).max(axis=1), np.abs(exact).max(axis=1)
    share = np.divide(apart, most, out=np.zeros_like(apart), where=most > 0)
    if share.max() > tolerance:
        raise SolveError(
            f"energy is known to {share.max():.1e} only, not to {tolerance:g}: sections of tensed "
            "elements are damped and their tension is not, which modes tell to first order. More "
            'elements, or element="rigid", help'
        )


def _agreed(system: CoupledSystem, run: Run) -> tuple[Real, list[Real]]:
    """Halve the steps until two runs agree, (names, t), and return the motion looked at too."""
    tolerance = TOLERANCE if run.tolerance is None else run.tolerance
    falls = 2.0 if system.is_sharp else 4.0
    h, before, runs = system.first_step, None, Runs()
    span = float(run.time[-1] - run.time[0])
    while True:
        passage = EnergyPassage(system, h)
        passed = passage.through(run.progress)
        if passed.error is not None and (passed.settles or span / h > MOST_STEPS):
            raise passed.error
        now = None if passed.error is not None else passage.energies(run.time)
        if now is not None and before is not None:
            off = reach(falls) * runs.apart(now, before, falls).max(initial=0.0)
            if off <= tolerance * np.abs(now).max(initial=0.0):
                plain = system.without_laws()
                return now, [one + other for one, other in zip(plain, passed.looked)]
        if span / h > MOST_STEPS:
            raise SolveError(f"energy is not known to {tolerance:g} with {MOST_STEPS} steps")
        h, before = h / system.finer, now


class EnergyPassage(CoupledPassage):
    """A run that accounts for energy at the ends of steps."""

    def __init__(self, system: CoupledSystem, h: float) -> None:
        super().__init__(system, h)
        edges = self._edges()
        self._speed = system.linear(system.points, edges, 1).T
        self._edge, self._done = edges, 0
        self._energy, self._jump = np.zeros((len(NAMES), len(edges))), np.zeros(len(edges))
        self._struck()

    def energies(self, time: Real) -> Real:
        """Return them at some times, on straight lines between the ends of steps."""
        gone = self._energy.copy()
        gone[2:] = gone[2:].cumsum(axis=1)
        jump = self._jump.cumsum()  # of what moves and of what is put in
        at = np.searchsorted(self._edge, time, side="right") - 1
        told = [np.interp(time, self._edge, one) for one in (*gone, gone[0] - jump)]
        told[0] = told.pop() + jump[at]
        told[2] += jump[at]
        return np.stack(told)

    def _record(self, block: Steps, found: StepsTaken, known: Real, is_last: bool) -> None:
        at = slice(self._done, self._done + block.number + 1)
        Q, V = known + found.state[:, 0], self._speed[at] + found.state[:, 1]
        self._energy[:2, at] = self._stored(self._edge[at], Q, V)
        into = slice(at.start + 1, at.stop)
        before = V.copy()
        for k, kick in self._blow.items():
            if at.start <= k < at.stop:
                before[k - at.start] -= kick
        self._energy[2:, into] += self._powers(block, found, Q, (V[:-1], before[1:]))
        self._jump[at.start : at.stop] += self._by_blows(at, V, is_last)
        self._done += block.number
        super()._record(block, found, known, is_last)

    def _stored(self, time: Real, Q: Real, V: Real) -> Real:
        """Return kinetic energy and strain."""
        system = self.system
        bent = np.einsum("tk,kl,tl->t", Q, system.form, Q, optimize=True)
        strain = (system.modes.square * Q**2).sum(axis=1) / 2
        strain += system.added(time) * bent / 2 + system.stretching / 8 * bent**2
        return np.stack([(V**2).sum(axis=1) / 2, strain])

    def _powers(self, block: Steps, found: StepsTaken, Q: Real, beside: tuple[Real, Real]) -> Real:
        """Return what is put in, dissipated and taken by laws in each step.

        `beside` are the velocities it begins and ends with.
        """
        system, h = self.system, block.h
        way = np.diff(Q, axis=0)
        time = block.begin + h * np.arange(block.number + 1.0)
        given = np.zeros(block.number)
        for push, force in zip(system.push, system.pushes):
            if not isinstance(force, float):
                given += force.value((time[1:] + time[:-1]) / 2) * (way @ push)
        if system.pulsation is not None:
            bent = np.einsum("tk,kl,tl->t", Q, system.form, Q, optimize=True)
            given += np.diff(system.added(time)) * (bent[1:] + bent[:-1]) / 4
        mean = way / h
        lost = h / 3 * ((beside[0] ** 2 + 4 * mean**2 + beside[1] ** 2) @ system.modes.sigma)
        if system.coupling is not None:
            lost += h * np.einsum("tk,kl,tl->t", mean, system.coupling, mean, optimize=True)
        work = found.force * (way @ system.row.T)
        for k, one in enumerate(system.laws):
            if one.law.kind == "power":
                lost -= work[:, k]
        by_laws = [k for k, one in enumerate(system.laws) if one.law.kind != "power"]
        return np.stack([given, lost, -work[:, by_laws].sum(axis=1)])

    def _struck(self) -> None:
        """Gather the blows at an instant, by the ends of steps they fall on."""
        system = self.system
        self._blow: dict[int, Real] = {}
        for push, force in zip(system.push, system.pushes):
            for when, size in () if isinstance(force, float) else force.blows:
                if self._edge[0] <= when <= self._edge[-1]:
                    at = int(np.abs(self._edge - when).argmin())
                    self._blow[at] = self._blow.get(at, 0.0) + size * push

    def _by_blows(self, at: slice, V: Real, is_last: bool) -> Real:
        """Return what blows put in: their impulses times the mean of the velocities beside."""
        given = np.zeros(len(V))
        for k, kick in self._blow.items():
            if at.start <= k < at.stop - (not is_last):
                given[k - at.start] = kick @ (V[k - at.start] - kick / 2)
        return given


def of_chain(run: Run, solve: Solve | None = None) -> Balance:
    """Return the energies of a motion that another method told."""
    if run.coarse is not None:
        raise SceneError("energy is not told where spans begin with shapes or velocities")
    return balance(run.but(snapshots=np.zeros(0)), solve)
