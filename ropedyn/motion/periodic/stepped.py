"""Steady states under a sine whose frequency is stepped, see `Model.stepped_sine`."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial
from itertools import groupby, islice

import numpy as np

from ...base.answer import Cost
from ...base.array import Complex, Flags, Real
from ...base.computed import Late
from ...base.errors import SolveError
from ...response.frf import FRF
from ...response.harmonic import solve_harmonic
from .asked import SteppedSine
from .balance import HarmonicBalance
from .continuation import ENOUGH, ROUGHLY, Branch, Place, Stuck
from .driven import Driven, known_to
from .slipping import slipping
from .stability import growing
from .state import HARMONICS, MOST, SMALL, SteadyState, by_frequency, settled
from .transfer import PanelledTransfer

FIRST = 1e-3  # Share of the amplitude from which it is raised.
STEPS = 4000  # A branch is followed for so many at most on the way to one frequency,
FALLEN = 100  # of which so many after motion fell off it,
QUICKLY = 128  # where so many harmonics at most tell what is stable.
TOGETHER = 16  # States are made exact so many at a time.
WAY = 3.0  # It may go so far beyond the frequencies that are asked for, times.
UNDAMPED = 8.0  # Undamped motion up to so many times the highest frequency is looked for.


def solve_stepped(asked: SteppedSine) -> FRF:
    """Find the steady states in the order of the frequencies."""
    driven = Driven.of(asked)
    if driven.is_linear:
        return _linear(asked, driven)
    try:
        states = _followed(driven) if driven.points else []
        does_slip = slips(driven, states)
    except SolveError:
        does_slip = bool(driven.held)  # nothing is found while all friction holds
        if not does_slip:
            raise
    if does_slip:
        return slipping(asked, driven.turn)
    value, error = watched(driven, asked.frequency, states)
    unknowns = max((len(state.place.x) for state in states), default=0)
    lines = driven.transfer.lines + len(asked.frequency)
    cost = Cost("balance", len(asked.model.x) - 1, unknowns, sweeps=2 * lines)
    stable = Late(partial(holding, driven, states))
    return asked.answer(asked.frequency, value, error, cost, stable)


def watched(driven: Driven, frequency: Real, states: list[SteadyState]) -> tuple[Complex, Real]:
    """Return what is watched per amplitude, (responses, f), and its relative error."""
    push = off = np.zeros((0, len(frequency)), dtype=np.complex128)
    if states:
        push = np.stack([state.push for state in states], axis=1)
        off = np.stack([state.change for state in states], axis=1)
    value, error = driven.responses(frequency, push, off)
    size = np.abs(value)
    relative = np.where(error == 0, 0.0, np.inf)
    return value, np.divide(error, size, out=relative, where=size > 0)


def holding(driven: Driven, states: list[SteadyState]) -> Flags:
    """Return which motions come back to themselves; folds do not."""
    if not states:
        return np.full(len(driven.asked.frequency), driven.growing == 0)
    return np.array(
        [
            one.kind != "fold"
            and growing(one.balance, one.place.x, one.place.p, driven.growing) == 0
            for one in states
        ]
    )


def _linear(asked: SteppedSine, driven: Driven) -> FRF:
    """Return the response of a linear scene, where it has a steady state."""
    if driven.growing:
        raise SolveError("there is no steady state: the compression is beyond critical")
    f = asked.frequency
    solve = partial(solve_harmonic, asked.model, drive=asked.drive, response=asked.responses)
    solve = partial(solve, threads=1, tight=False)

    PanelledTransfer(
        lambda omega: solve(omega / (2 * np.pi)).value.T,
        lambda omega: known_to(solve(omega / (2 * np.pi))),
    ).cover(2 * np.pi * UNDAMPED * float(f.max()))
    found = solve(f)
    cost = Cost("sweep", found.cost.elements, found.cost.unknowns, found.cost.sweeps)
    error = found.rounding_error
    if asked.model.element == "continuous":
        error = error + found.mesh_error
    return asked.answer(f, found.value, error, cost, np.ones(len(f), dtype=np.bool_))


def slips(driven: Driven, states: list[SteadyState]) -> bool:
    """Whether friction does not hold at all frequencies."""
    if not driven.held:
        return False
    if driven.points:
        force = [driven.hold(one.balance, one.place.x, one.place.p) for one in states]
    else:
        omega = 2 * np.pi * driven.asked.frequency
        force = [driven.hold(None, np.zeros(0), one) for one in omega.tolist()]
    return bool((np.array(force) > driven.grip).any())


def _followed(driven: Driven) -> list[SteadyState]:
    """Return the steady states with as many harmonics as they need."""
    asked, harmonics = driven.asked, HARMONICS
    while True:
        path = Path(driven, driven.balance(harmonics)) if driven.keeps_time else None
        states = (_state(driven, path, harmonics, f) for f in asked.frequency.tolist())
        finer: list[SteadyState] = []
        for alike in _alike(states):
            found = settled(driven, alike)
            if found is None:
                break
            finer += found
            asked.progress(len(finer) / len(asked.frequency))
        else:
            return finer
        harmonics *= 2
        if harmonics >= MOST:
            raise SolveError(f"{harmonics} harmonics do not tell where the branch leads")


def _alike(states: Iterable[SteadyState]) -> Iterator[list[SteadyState]]:
    """Gather states that follow each other and have as many harmonics, some at a time."""
    for _, alike in groupby(states, lambda one: one.balance.harmonics):
        while several := list(islice(alike, TOGETHER)):
            yield several


def _state(driven: Driven, path: Path | None, harmonics: int, frequency: float) -> SteadyState:
    """Return the state on the way through the frequencies, or from rest where time is kept."""
    if path is not None:
        balance, x = path.balance, path.to(frequency)
    else:
        balance = driven.balance(harmonics, driven.turn(frequency))
        x = at_rest(driven, balance, frequency)
    return SteadyState(balance, Place(x, 2 * np.pi * frequency / balance.turn, x, 0.0))


def at_rest(driven: Driven, balance: HarmonicBalance, frequency: float) -> Real:
    """Return the motion that is reached when the amplitude of the drive is raised from 0.

    Where that way does not begin or gets lost, as beside a stop that is met at every amplitude, the
    forces of the laws are raised from 0 instead.
    """
    omega = 2 * np.pi * frequency / balance.turn

    def by_amplitude(x: Real, share: Real | float) -> tuple[Real, Real, Real]:
        about, by_share = balance.at(x, np.full(np.shape(share), omega), share)
        return about.gap, about.jacobian, by_share

    def by_laws(x: Real, part: Real | float) -> tuple[Real, Real, Real]:
        about, _ = balance.at(x, np.full(np.shape(part), omega))
        # gap = x - linear - part H f
        part, laws = np.asarray(part)[..., None], about.gap - x + linear
        whole, still = part[..., None], np.eye(x.shape[-1])
        return x - linear + part * laws, still + whole * (about.jacobian - still), laws

    linear = driven.linear_motion(balance, omega)
    small = SMALL * float(np.linalg.norm(linear))
    nowhere = Place(np.zeros(0), FIRST, np.zeros(0), 0.0)
    for linearise, begin in (by_amplitude, FIRST * linear), (by_laws, linear):
        with np.errstate(all="ignore"):  # steps that lead out of all numbers are taken back
            x = _raised(Branch(linearise, nowhere, 1.0, small, str, step=0.25), begin, linear)
        if x is not None:
            return x
    raise SolveError(f"frequency {frequency!r} Hz: no steady state was found on the way from rest")


def _raised(branch: Branch, begin: Real, end: Real) -> Real | None:
    """Return where a branch leads at p = 1 from about a motion at p = FIRST, if it does."""
    x = branch.settle(begin, FIRST)
    if x is None:
        return branch.settle(end, 1.0)
    branch.place = Place(x, FIRST, x, 0.0)
    branch.turned(1.0)
    for _ in range(STEPS):
        before = branch.place
        try:
            after = branch.advance()
        except Stuck:
            return None
        if after.p >= 1:
            found = branch.settle(branch.between(before, after, 1.0), 1.0)
            if found is not None:
                return found
    return None


@dataclass(eq=False)
class Path:
    """The way through the frequencies, from rest at the first."""

    driven: Driven
    balance: HarmonicBalance
    branch: Branch = field(init=False)
    now: float = 0.0  # the frequency that was answered last [rad/s]
    x: Real = field(default_factory=lambda: np.zeros(0))  # the motion there
    heading: float = 0.0  # whether the frequency goes up or down
    piece: tuple[Place, Place] | None = None  # of the branch, on which that is
    beyond: tuple[Place, Place] | None = None  # the next piece, where a fold parts a step

    def __post_init__(self) -> None:
        self.branch = by_frequency(self.driven, self.balance)

    def to(self, frequency: float) -> Real:
        """Go to a frequency and return the motion there."""
        omega = 2 * np.pi * frequency
        if omega == self.now:
            return self.x
        heading = float(np.sign(omega - self.now))
        if self.piece is None:
            return self._begun(frequency)
        if heading != self.heading:
            self._head(heading)
        left, fallen, asked = STEPS, False, 2 * np.pi * self.driven.asked.frequency
        while left > 0:
            x = self._crossing(omega)
            if x is not None and (not fallen or self._catches(x, omega)):
                self.x, self.now = x, omega
                return x
            reached = self.piece[1].p
            if not asked.min() / WAY <= reached <= asked.max() * WAY:
                break
            try:  # the next piece
                self.piece, self.beyond = self.beyond, None
                if self.piece is None:
                    self.piece, self.beyond = pieces(self.branch, enough=ROUGHLY * self.branch.step)
            except Stuck:
                break
            left -= 1
            if not fallen and not self._ahead:
                left, fallen = FALLEN, True
        return self._begun(frequency)

    @property
    def _ahead(self) -> bool:
        """Whether the piece leads where the frequency goes."""
        assert self.piece is not None
        before, after = self.piece
        return (after.p - before.p) * self.heading >= 0

    def _begun(self, frequency: float) -> Real:
        """Begin at rest."""
        self.x = at_rest(self.driven, self.balance, frequency)
        self.now = 2 * np.pi * frequency
        self._head(1.0)
        return self.x

    def _head(self, heading: float) -> None:
        """Turn where the last answer is."""
        self.branch.place = Place(self.x, self.now, self.x, 0.0)
        self.branch.turned(heading)
        self.heading, self.beyond = heading, None
        self.piece = self.branch.place, self.branch.place

    def _crossing(self, omega: float) -> Real | None:
        assert self.piece is not None
        before, after = self.piece
        if not min(before.p, after.p) <= omega <= max(before.p, after.p):
            return None
        return self.branch.between(before, after, omega)

    def _catches(self, x: Real, omega: float) -> bool:
        """Whether motion that fell off its branch stays here."""
        if not self._ahead:
            return False
        return growing(self.balance, x, omega, self.driven.growing, QUICKLY) == 0


def pieces(
    branch: Branch, *, enough: float = ENOUGH
) -> tuple[tuple[Place, Place], tuple[Place, Place] | None]:
    """Take a step; return it, parted where the parameter turns.

    One on which no steps lead to where it turns is taken back, and a shorter one is taken.
    """
    before, bend = branch.place, branch.bend
    while True:
        step, after = branch.step, branch.advance()
        if before.up * after.up >= 0:
            return (before, after), None
        fold = branch.fold(before, after, enough=enough)
        if fold is not None:
            return (before, fold), (fold, after)
        branch.place, branch.bend, branch.step = before, bend, step / 2
