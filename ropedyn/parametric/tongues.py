"""Where instability begins in the plane of frequency and amplitude of the tension."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import combinations_with_replacement
from typing import Any, NamedTuple

import numpy as np

from ..base.answer import Answer, Cost, axes
from ..base.array import Index, Real
from ..base.computed import waited
from ..base.table import Table
from ..motion.modal_system import ModalSystem
from .decay import damped
from .krein import NEUTRAL, Regions, Unstable, undamped
from .monodromy import rates

OUTSIDE = 3e-6  # Edges are looked for so far outside of a range, relative.
HIGHEST_ORDER = 4  # Tongues up to this order are named.


class Tongue(NamedTuple):
    """A region of instability, by where it begins at no amplitude."""

    modes: tuple[int, int]  # two numbers of modes, from 1; the same twice where one alone grows
    order: int  # n of n f = f_i + f_j
    frequency: float  # of the tension [Hz]
    # how far each side of it goes per amplitude, |Gamma_ij|/(4 pi sqrt(omega_i omega_j)), without
    # damping and to first order [Hz/N]; 0 of orders above 1, which widen more slowly
    spread: float

    @property
    def kind(self) -> str:
        """One of "principal", "sum" and "secondary"."""
        if self.order > 1:
            return "secondary"
        return "principal" if self.modes[0] == self.modes[1] else "sum"

    @property
    def label(self) -> str:
        """Such as "2 f1", "f1 + f2" or "(f1 + f2)/2"."""
        i, j = self.modes
        share = "" if self.order == 1 else f"/{self.order}"
        if i != j:
            return f"(f{i} + f{j}){share}" if share else f"f{i} + f{j}"
        if self.order % 2:
            return f"2 f{i}{share}"
        return f"f{i}" if self.order == 2 else f"f{i}/{self.order // 2}"


def tongues_of(system: ModalSystem, low: float, high: float) -> tuple[Tongue, ...]:
    """Return the tongues between two frequencies [Hz], lowest first."""
    # those of order 1 need the coupling of their modes, those of others some coupling
    found = []
    pairs = (p for block in system.blocks for p in combinations_with_replacement(block.tolist(), 2))
    for i, j in pairs:
        if system.eigenvalue[i] <= 0:
            continue
        together = float(system.omega[i] + system.omega[j]) / (2 * math.pi)
        mean = math.sqrt(system.omega[i] * system.omega[j])
        spread = float(abs(system.geometric[i, j])) / (4 * math.pi * mean)
        orders = range(1 if spread else 2, HIGHEST_ORDER + 1)
        found += [
            Tongue((i + 1, j + 1), order, together / order, spread if order == 1 else 0.0)
            for order in orders
            if low <= together / order <= high
        ]
    return tuple(sorted(found, key=lambda one: (one.frequency, one.order)))


def threshold(system: ModalSystem, frequency: Real) -> Real:
    """Return the growth ln|multiplier| over a period that counts as growth, as frequency [Hz]."""
    # where all motion decays by itself, multipliers do not meet on the circle, and any is growth
    decay = -np.linalg.eigvals(rates(system)).real.max() / frequency
    return np.where(decay > NEUTRAL, 0.0, NEUTRAL)


@dataclass(frozen=True, eq=False)
class Boundary(Answer):
    """Frequencies of the tension at which stability changes.

    Attributes
    ----------
    amplitude : float
        Of the tension [N].
    frequency : ndarray, shape (b,)
        Increasing [Hz]. Their relative error is some 1e-15, with damping too but near the tip of a
        tongue, where its two edges meet as the root of rounding.
    order : ndarray of int, shape (b,)
        n of the resonance n f = f_i + f_j whose tongue begins or ends there: of one mode how often
        it passes its rest in a period, of several what the mean rates of the two motions that meet
        there add up to, even where these return after a period and odd after two. Modes that the
        tension mixes strongly may have turned, since they left no amplitude, to the next such n.
    resonances : int
        How many of them were counted between the frequencies of the map: tongues without width
        too, and those that damping closes.
    highest_order : int
        Of a resonance between the frequencies of the map.
    proved : bool
        Whether no tongue is missed of any order up to the highest: without damping because the
        count of multipliers that come through 1 by Hill's matrix is that of the phases followed,
        with damping because polynomials stand for the function whose roots the edges are. Tongues
        narrower than 1e-13 of their frequency count as closed.
    cost : Cost
        What it cost.

    Examples
    --------
    >>> import ropedyn as rd
    >>> model = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile()
    >>> boundary = model.stability_map([40.0, 110.0], [0.0], modes=1).boundary(100.0)
    >>> boundary.frequency.round(3), boundary.order, boundary.proved
    (array([ 49.896,  50.021,  97.485, 102.484]), array([2, 2, 1, 1]), True)
    """

    amplitude: float
    frequency: Real = field(metadata=axes("edge", unit="Hz"))
    order: Index = field(metadata=axes("edge"))
    resonances: int
    highest_order: int
    proved: bool
    cost: Cost

    def table(self) -> Table:
        """Return one row for each frequency."""
        columns: dict[str, Any] = {"frequency [Hz]": self.frequency, "order": self.order}
        verdict = "none missed" if self.proved else "some may be missed"
        return Table.of(f"where stability changes at {self.amplitude:g} N, {verdict}", columns)


@waited
def boundary(system: ModalSystem, low: float, high: float, amplitude: float) -> Boundary:
    """Return where stability changes between two frequencies at an amplitude."""
    first, last = 1 / high, 1 / low
    # what begins or ends where the range does is seen from outside
    ends = first * (1 - OUTSIDE), last * (1 + OUTSIDE)
    found = [_found(system.only(block), *ends, amplitude) for block in system.blocks]
    edge = [
        (1 / period, order)
        for one in _together([region for each in found for region in each.unstable])
        for period, order in ((one.begin, one.begin_order), (one.end, one.end_order))
        if first < period < last
    ]
    edge.sort()
    highest = math.floor(float(system.omega.max()) / (math.pi * low))
    return Boundary(
        amplitude=amplitude,
        frequency=np.array([f for f, _ in edge]),
        order=np.array([n for _, n in edge], dtype=np.intp),
        resonances=sum(each.passed for each in found),
        highest_order=max(highest, *(n for _, n in edge), 0),
        proved=all(each.proved for each in found),
        cost=Cost(
            "Hill's matrix and Krein's count",
            0,
            2 * len(system.eigenvalue),
        ),
    )


def _found(system: ModalSystem, low: float, high: float, amplitude: float) -> Regions:
    """Find where motion of coupled modes grows between two periods."""
    if not system.geometric.any():
        return Regions()
    still = ModalSystem(system.eigenvalue, system.geometric, np.zeros_like(system.damping))
    free = undamped(still, low, high, amplitude)
    if not system.damping.any():
        return free
    if np.abs(system.damping).max() * high <= NEUTRAL:
        return Regions(free.unstable, free.passed, proved=False)
    # tongues narrow beside their damping are looked at by themselves
    middle = [(one.begin + one.end) / 2 for one in free.unstable]
    least = float(threshold(system, np.array(1 / high)))
    found = damped(system, (low, high), amplitude, least, np.array(middle))
    return Regions(found.unstable, free.passed, found.proved)


def _together(unstable: list[Unstable]) -> list[Unstable]:
    """Return regions of periods that are apart."""
    joined: list[Unstable] = []
    for one in sorted(unstable):
        if joined and one.begin <= joined[-1].end:
            last = joined[-1]
            if one.end > last.end:
                joined[-1] = last._replace(end=one.end, end_order=one.end_order)
        else:
            joined.append(one)
    return joined
