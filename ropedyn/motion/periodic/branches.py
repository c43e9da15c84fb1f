"""All steady motion that was found between two frequencies."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from ...base import check
from ...base.answer import Answer, Cost, axes
from ...base.array import Complex, Flags, Index, Real
from ...base.computed import Late, Lazy, lazy
from ...base.errors import SceneError, SolveError
from ...base.table import Table
from ...chain.port import Point
from ...response.frf import FRF, MeshOfResponse, RoundingOfResponse
from .asked import SteppedSine
from .balance import HarmonicBalance
from .continuation import Place
from .driven import Driven
from .state import HARMONICS, MOST, SteadyState, by_frequency, settled
from .stepped import STEPS, at_rest, holding, pieces, slips, watched

SWAPPED = 1e-6  # Neighbours that more harmonics swap are so close to each other, relative.
SAME = 1e-3  # Motions at one frequency that differ by less are one, relative.


@dataclass(frozen=True, eq=False)
class Branches(Answer):
    """Steady motion under a sine, by branches: a sequence of `FRF` between folds.

    Branches that are connected come one after another, each from one fold to the next. What is
    connected neither with the motion that is reached from rest at the lowest frequency nor with
    that at the highest is not found, nor is motion that repeats itself after several periods.

    Attributes
    ----------
    drive, response : tuple of points
        What is driven and watched.
    quantity : {"receptance", "mobility", "accelerance"}
        Displacement, velocity or acceleration, per amplitude of the drive.
    amplitude : float
        Of the drive [N, N m; m, rad of an end].
    first : ndarray of int, shape (branches,)
        Where each branch begins among the points.
    frequency : ndarray, shape (points,)
        [Hz], as the branches are followed.
    value : ndarray of complex, shape (responses, points)
        Motion is Re(value exp(+i omega t)) and its harmonics, per amplitude.
    rounding_error : ndarray, as value
        Estimated relative error.
    stable : ndarray of bool, shape (points,)
        Whether the motion comes back to itself when it is disturbed, computed when it is first
        asked for; False too where that cannot be told, as on folds.
    folds : ndarray, shape (f,)
        Frequencies at which a branch turns into the next [Hz], in the order they are passed.
    fold_error : ndarray, shape (f,)
        How far they are off, estimated [Hz].
    cost : Cost
        What it cost.

    Examples
    --------
    A spring that hardens: between two folds there are three motions, one of them unstable.

    >>> import ropedyn as rd
    >>> spring = rd.NodeForce(0.5, lambda t, u, v: -1e6 * u**3)
    >>> damping = rd.RayleighDamping(6.0, 0.0)
    >>> scene = rd.Scene(rd.Rope(1.0, 0.1), tension=100.0, damping=damping, parts=[spring])
    >>> model = scene.compile(elements=2)
    >>> drive = {"drive": ("z", 0.5), "amplitude": 1.0}
    >>> branches = model.stepped_sine([12.0, 24.0], **drive, branches=True)
    >>> len(branches), branches.folds.round(2), bool(branches[1].stable[5])
    (3, array([21.12, 16.95]), False)
    """

    drive: tuple[Point, ...]
    response: tuple[Point, ...]
    quantity: str
    amplitude: float
    first: Index = field(metadata=axes("branch"))
    frequency: Real = field(metadata=axes("point", unit="Hz"))
    value: Complex = field(metadata=axes("response", "point"))
    rounding_error: Real = field(metadata=axes("response", "point"))
    folds: Real = field(metadata=axes("fold", unit="Hz"))
    fold_error: Real = field(metadata=axes("fold", unit="Hz"))
    mesh_error: Real = field(metadata=axes("response", "point"))
    cost: Cost
    stable: Lazy[Flags] = lazy(np.ndarray, axes("point"))

    def __len__(self) -> int:
        return len(self.first)

    def __getitem__(self, number: int) -> FRF:
        """Return a branch."""
        least, most = -len(self), len(self) - 1
        k = check.count(number, "number of a branch", least=least, most=most) % len(self)
        ends = np.append(self.first, len(self.frequency))
        part = slice(ends[k], ends[k + 1])
        value = self.value[:, part]
        return FRF(
            self.drive,
            self.response,
            quantity=self.quantity,
            frequency=self.frequency[part],
            value=value,
            rounding=RoundingOfResponse.of_relative(value, self.rounding_error[:, part]),
            rounding_bound=self.rounding_error[:, part],
            cost=self.cost,
            mesh=MeshOfResponse(self.mesh_error[:, part]),
            stable=Late(lambda: self.stable[part]),
        )

    def __iter__(self) -> Iterator[FRF]:
        return (self[k] for k in range(len(self)))

    def table(self) -> Table:
        """Return one row for each branch: where it leads, and how much of it is stable."""
        each = list(self)
        columns: dict[str, Any] = {
            "from [Hz]": np.array([one.frequency[0] for one in each]),
            "to [Hz]": np.array([one.frequency[-1] for one in each]),
            "points": np.array([len(one.frequency) for one in each]),
            "stable [%]": np.array(
                [100 * one.stable.mean() for one in each if one.stable is not None]
            ),
        }
        for k, name in enumerate(each[0].labels):
            columns[f"largest |{name}|"] = np.array([np.abs(one.value[k]).max() for one in each])
        return Table.of("branches of steady motion", columns)


def solve_branches(asked: SteppedSine) -> Branches:
    """Follow branches between the lowest and the highest frequency."""
    driven = Driven.of(asked)
    _refuse(driven)
    harmonics = HARMONICS
    while True:
        balance = driven.balance(harmonics)
        ways = traced(driven, balance)
        found: list[list[SteadyState]] = []
        while len(found) < len(ways) and (way := settled(driven, ways[len(found)])) is not None:
            found.append(way)
            asked.progress(len(found) / len(ways))
        if len(found) == len(ways) and all(map(_is_in_order, found)):
            if any(slips(driven, way) for way in found):
                raise SceneError("branches must be False where friction slips, got True")
            return _answer(driven, found)
        harmonics *= 2
        if 2 * harmonics > MOST:
            raise SolveError(f"{harmonics} harmonics do not tell where branches lead")


def _is_in_order(way: list[SteadyState]) -> bool:
    """Whether frequencies rise or fall from fold to fold, as where none was passed unseen."""
    f = np.array([one.frequency for one in way])
    ends = [k for k, one in enumerate(way) if one.kind == "fold"]
    for begin, end in pairwise([0, *ends, len(f) - 1]):
        steps = np.diff(f[begin : end + 1]) / f[begin]
        if steps.min(initial=0.0) < -SWAPPED and steps.max(initial=0.0) > SWAPPED:
            return False
    return True


def _refuse(driven: Driven) -> None:
    """Refuse what has no branches over the frequency."""
    if len(driven.asked.frequency) < 2 or np.ptp(driven.asked.frequency) == 0:
        raise SceneError(
            "frequency must hold two at least, between which branches are followed, got "
            f"{driven.asked.frequency.tolist()}"
        )
    if not driven.points:
        raise SceneError("branches must be False where no law bends them, got True")
    if driven.asked.drive in driven.held:
        raise SceneError(
            "branches must be False where friction acts on the point that is driven, got True: it "
            "holds or slips"
        )
    if not driven.keeps_time:
        raise SceneError(
            "branches must be False where a law depends on time or the tension pulsates, got True: "
            "drive and those begin anew together at single frequencies only"
        )


def traced(driven: Driven, balance: HarmonicBalance) -> list[list[SteadyState]]:
    """Follow what is reached from rest at the lowest frequency, and then at the highest."""
    f = np.unique(driven.asked.frequency)
    up = _trace(driven, balance, f, 1)
    x = at_rest(driven, balance, float(f[-1]))
    near = [s.place for s in up if s.kind == "asked" and s.place.p == 2 * np.pi * f[-1]]
    if near:  # which are as near as steps of a branch are
        at, omega = np.array([one.x for one in near]), np.array([one.p for one in near])
        ends, known = by_frequency(driven, balance).settled(at, omega)
        apart = np.linalg.norm(ends - x, axis=1)
        if (known & (apart <= SAME * np.linalg.norm(x))).any():
            return [up]
    return [up, _trace(driven, balance, f, -1)]


def _trace(driven: Driven, balance: HarmonicBalance, f: Real, heading: int) -> list[SteadyState]:
    """Follow one branch through the frequencies until it leaves them."""
    first = float(f[::heading][0])
    omega = 2 * np.pi * f
    x = at_rest(driven, balance, first)
    branch = by_frequency(driven, balance)
    branch.place = Place(x, 2 * np.pi * first, x, 0.0)
    branch.turned(float(heading))
    states = [SteadyState(balance, branch.place)]
    for _ in range(STEPS):
        for piece in filter(None, pieces(branch)):
            for at in _passed(omega, piece):
                inside = branch.between(*piece, at)
                states.append(SteadyState(balance, Place(inside, at, inside, 0.0)))
            end = piece[1]
            if not omega[0] <= end.p <= omega[-1]:
                return states
            states.append(SteadyState(balance, end, "step" if end is branch.place else "fold"))
    raise SolveError(f"a branch does not leave the frequencies in {STEPS} steps")


def _passed(omega: Real, piece: tuple[Place, Place]) -> list[float]:
    """Return the frequencies that a piece passes, in its order."""
    begin, end = piece[0].p, piece[1].p
    inside = omega[(omega > min(begin, end)) & (omega < max(begin, end))].tolist()
    return inside if end > begin else inside[::-1]


def _answer(driven: Driven, traces: list[list[SteadyState]]) -> Branches:
    """Put the branches one after another; a fold ends one and begins the next."""
    asked = driven.asked
    states: list[SteadyState] = []
    first: list[int] = []
    for trace in traces:
        first.append(len(states))
        for state in trace:
            states.append(state)
            if state.kind == "fold":
                first.append(len(states))
                states.append(state)
    folds = [one for trace in traces for one in trace if one.kind == "fold"]
    frequency = np.array([one.frequency for one in states])
    value, error = watched(driven, frequency, states)
    unknowns = max(len(one.place.x) for one in states)
    lines = driven.transfer.lines + len(states)
    cost = Cost("balance", len(asked.model.x) - 1, unknowns, sweeps=2 * lines)
    whole = asked.answer(frequency, value, error, cost, Late(partial(holding, driven, states)))
    return Branches(
        whole.drive,
        whole.response,
        quantity=whole.quantity,
        amplitude=asked.amplitude,
        first=np.array(first),
        frequency=frequency,
        value=whole.value,
        rounding_error=whole.rounding_error,
        stable=Late(lambda: whole.stable),
        folds=np.array([one.frequency for one in folds]),
        fold_error=np.array([one.moved for one in folds]),
        mesh_error=whole.mesh_error,
        cost=cost,
    )
