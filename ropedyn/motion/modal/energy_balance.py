"""Where the energy of a sum over modes is.

A mode that a force of 1 at the drive d moves by phi_d eta_d has r = phi_d phi_e of two drives, so

    kinetic    sum of r_de eta_d' eta_e'/2,      dissipated   integral of 2 sigma r_de eta_d' eta_e'
    strain     sum of r_de square eta_d eta_e/2 + rest_de y_d y_e/2
    input      integral of f_d (r_de eta_e' + rest_de y_e'),

y = f where what is left out of the modes follows at once, and y + gamma y' = f where stiffness is
damped; without blows at an instant, which would put infinite energy there. Integrals are Gauss's,
between all that jumps, of pieces below the period of the modes they are of and of the forces; what
decays fast after a jump has pieces that grow from its time on. So a mode of omega takes 4 omega
values of itself a second, or 16 and more between two times.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from ...base.array import Index, Real
from ...base.errors import SceneError
from ...eigen.damped.proportional import proportional
from ...eigen.damped.rates import Rates
from ...response.moved_end import is_end
from ...scene import damping
from ...scene.force import Force, Sum
from ..history import Balance
from ..request import Run
from .convolution import felt, motion_under
from .expansion import Expansion, Share, expand

NAMES = ("kinetic", "strain", "input", "dissipated")

NODES, RADIANS = 8, 2.0
"""Gauss's rule of so many nodes is right to 1e-13 where mode and force turn by so much."""
BLOCK, ALIKE = 64, 4.0
"""So many modes at most are integrated together, whose rates differ by this factor at most."""
MOST = 1 << 21  # So many numbers are computed at a time.


def balance(run: Run, resolved: float) -> Balance:
    """Return the energies over time."""
    refuse_moved_ends(run)
    energy = {name: np.zeros(len(run.time)) for name in NAMES}
    shares = expand(
        run.model, run.places, run.places, modes=run.modes, resolved=resolved, bound=False
    )
    for share in shares:
        for name, part in zip(NAMES, DrivenModes.of(run, share).energies()):
            energy[name] += part
    return Balance(energy)


def refuse_moved_ends(run: Run) -> None:
    """Refuse motion of ends, which no force of a drive tells the work of."""
    if any(map(is_end, run.drives)):
        raise SceneError("energy is not told where an end is moved")


def divided(edges: Real, parts: Index) -> tuple[Real, Real]:
    """Return where pieces begin and how long they are, so many between two edges each."""
    step = np.repeat(np.diff(edges) / parts, parts)
    number = np.arange(len(step)) - np.repeat(np.cumsum(parts) - parts, parts)
    return np.repeat(edges[:-1], parts) + step * number, step


def tells_energy(run: Run) -> bool:
    """Whether modes have energies of their own: damping does not couple them."""
    rates, chain = Rates.of(run.model.scene.dampings), run.model.chain
    if damping.having(run.model.scene.dampings, "ratio"):
        return True
    return all(proportional(chain.only(c), rates) is not None for c in run.model.components)


class AlikeModes(NamedTuple):
    """Modes that are integrated together."""

    modes: Index
    rate: float  # Highest angular frequency, or rate of slow decay or growth [rad/s]
    decay: float  # Fastest rate of what only decays [1/s], 0 of none


@dataclass(frozen=True, eq=False)
class DrivenModes:
    """Modes of one component under all that drives it."""

    time: Real  # (t,) [s]
    given: list[Force | float]  # Forces, and loads that are let go
    own: Expansion  # of the motion where they act
    lag: float  # gamma [s]
    rest: Real  # (drives, drives)

    @classmethod
    def of(cls, run: Run, share: Share) -> DrivenModes:
        """Take what drives a component."""
        own = share.expansion
        rest = own.late if own.lag else own.rest
        return cls(run.time, [run.pushes[d] for d in share.drive], own, own.lag, rest)

    @classmethod
    def without(cls, run: Run, drive: Sequence[int], rest: Real, lag: float) -> DrivenModes:
        """Take what follows some of all that drives without any mode."""
        own = _nothing(0, len(drive))
        none = np.zeros((*rest.shape, 0))
        return cls(
            run.time, [run.pushes[d] for d in drive], own._replace(a=none, b=none), lag, rest
        )

    def energies(self) -> tuple[Real, Real, Real, Real]:
        """Return kinetic, strain, input and dissipated, each (t,)."""
        kinetic, strain = np.zeros(len(self.time)), np.zeros(len(self.time))
        for first in range(0, len(self.own.sigma), BLOCK):
            part = slice(first, min(first + BLOCK, len(self.own.sigma)))
            q, v = (self._modes(part, self.time, order) for order in (0, 1))
            r = self.own.a[..., part]
            kinetic += np.einsum("dek,dkt,ekt->t", r, v, v, optimize=True) / 2
            stiff = r * self.own.square[part]
            strain += np.einsum("dek,dkt,ekt->t", stiff, q, q, optimize=True) / 2
        y = self._rest(self.time, 0)
        still = np.einsum("de,dt,et->t", self.rest, y, y) / 2
        given, lost = self._blows(), np.zeros(len(self.time))
        for group in self._groups():
            given += self._integral(partial(self._power, group.modes), group)
            if self.own.sigma[group.modes].any():
                lost += self._integral(partial(self._loss, group.modes), group)
        if self.lag:
            rest = AlikeModes(np.zeros(0, dtype=np.intp), 0.0, 1 / self.lag)
            given += self._integral(self._power_of_rest, rest)
            lost += self._integral(self._loss_of_rest, rest)
        return kinetic, strain + still, given if self.lag else given + still, lost

    def _groups(self) -> list[AlikeModes]:
        """Return modes of like rates."""
        sigma, omega = self.own.sigma, np.sqrt(np.abs(self.own.square))
        split = np.sqrt(np.maximum(sigma**2 - self.own.square, 0.0))
        creeps = (sigma > omega) & (self.own.square > 0)
        decay = np.where(creeps, sigma + split, 0.0)
        rate = np.divide(self.own.square, decay, out=omega + np.abs(sigma), where=creeps)
        groups, order = [], np.argsort(rate)
        while len(order):
            alike = rate[order[:BLOCK]] <= ALIKE * rate[order[0]]
            modes, order = order[: alike.sum()], order[alike.sum() :]
            groups.append(AlikeModes(modes, float(rate[modes[-1]]), float(decay[modes].max())))
        return groups

    def _power(self, modes: Index, time: Real) -> Real:
        """Return what forces do to some modes."""
        velocity = self._velocity(np.append(self.time[0], time), modes)[:, 1:]
        return np.asarray((self._force(time) * velocity).sum(axis=0))

    def _loss(self, modes: Index, time: Real) -> Real:
        """Return what dampers take from some modes."""
        v = self._modes(modes, np.append(self.time[0], time), 1)[..., 1:]
        r = 2 * self.own.sigma[modes] * self.own.a[..., modes]
        return np.asarray(np.einsum("dek,dkt,ekt->t", r, v, v, optimize=True))

    def _power_of_rest(self, time: Real) -> Real:
        """Return what forces do to what lags."""
        y = self._rest(np.append(self.time[0], time), 1)[:, 1:]
        return np.asarray((self._force(time) * (self.rest @ y)).sum(axis=0))

    def _loss_of_rest(self, time: Real) -> Real:
        """Return what dampers take from what lags."""
        y = self._rest(np.append(self.time[0], time), 1)[:, 1:]
        return np.asarray(self.lag * np.einsum("de,dt,et->t", self.rest, y, y))

    def _velocity(self, time: Real, modes: Index | slice) -> Real:
        """Return what some modes have of the velocity of each drive, (drives, t)."""
        own, still = self.own, np.zeros(self.rest.shape)
        a, b = own.a[..., modes], own.b[..., modes]
        some = own._replace(sigma=own.sigma[modes], square=own.square[modes], a=a, b=b)
        some = some._replace(rest=still, late=still, lag=0.0)
        moved = [motion_under(some, d, one, time, 1) for d, one in enumerate(self.given)]
        return np.asarray(np.sum(moved, axis=0))

    def _modes(self, part: Index | slice, time: Real, order: int) -> Real:
        """Return the motion of each mode per drive, (drives, modes, t)."""
        sigma, square = self.own.sigma[part], self.own.square[part]
        k = len(sigma)
        unit = _nothing(k, k)._replace(sigma=sigma, square=square, a=np.eye(k)[None])
        unit = unit._replace(b=np.zeros((1, k, k)))
        return np.stack([motion_under(unit, 0, one, time, order) for one in self.given])

    def _rest(self, time: Real, order: int) -> Real:
        """Return y of each drive, (drives, t)."""
        if not self.lag:
            return self._force(time)
        unit = _nothing(0, 1)._replace(late=np.ones((1, 1)), lag=self.lag)
        return np.stack([motion_under(unit, 0, _smooth(one), time, order)[0] for one in self.given])

    def _force(self, time: Real) -> Real:
        still, begin = np.zeros(len(time)), float(self.time[0])
        return np.stack(
            [still if isinstance(f, float) else felt(f, begin, time) for f in self.given]
        )

    @property
    def _forces(self) -> list[Force]:
        return [force for force in self.given if not isinstance(force, float)]

    def _integral(self, power: Callable[[Real], Real], group: AlikeModes) -> Real:
        """Integrate from the first time to each, shape (t,)."""
        edges = self._edges(group.decay)
        fastest = max([group.rate, *(2 * math.pi * force.highest for force in self._forces)])
        parts = np.ceil(np.diff(edges) * fastest / RADIANS).astype(np.intp) + 1
        begin, step = divided(edges, parts)
        node, weight = np.polynomial.legendre.leggauss(NODES)
        sums = np.zeros(len(step))
        most = max(1, MOST // (NODES * BLOCK * max(len(self.given), 1)))
        for k in range(0, len(step), most):
            some = slice(k, k + most)
            at = begin[some, None] + step[some, None] * (node + 1) / 2
            sums[some] = power(at.ravel()).reshape(at.shape) @ weight * step[some] / 2
        total = np.concatenate([[0.0], np.cumsum(sums)])[np.append(0, np.cumsum(parts))]
        return np.asarray(total[np.searchsorted(edges, self.time)])

    def _edges(self, decay: float) -> Real:
        """Return times, what jumps between, and after each of them pieces that double [s]."""
        # samples bend at the times themselves
        breaks = [at for force in self._forces for at in force.breaks]
        inside = [at for at in breaks if self.time[0] < at < self.time[-1]]
        edges = np.unique(np.concatenate([self.time, inside]))
        length = np.diff(edges)
        doublings = math.ceil(math.log2(max(length.max() * decay / RADIANS, 1.0)))
        after = [edges]
        for k in range(doublings):
            piece = 2.0**k * RADIANS / decay
            after.append(edges[:-1][length > piece] + piece)
        return np.unique(np.concatenate(after))

    def _blows(self) -> Real:
        """Return what blows at an instant put in: their impulse times the mean velocity."""
        blows: dict[float, Real] = {}
        for d, force in enumerate(self.given):
            for when, impulse in () if isinstance(force, float) else force.blows:
                if when >= self.time[0]:
                    blows.setdefault(when, np.zeros(len(self.given)))[d] += impulse
        total, r = np.zeros(len(self.time)), self.own.a.sum(axis=-1)
        for when, kick in blows.items():
            since = np.array([self.time[0], when]) if when > self.time[0] else self.time[:2]
            at = int(when > self.time[0])
            after = self._velocity(since, slice(None))[:, at]
            total[self.time >= when] += kick @ (after - r @ kick / 2)
        return total


def _nothing(modes: int, responses: int) -> Expansion:
    """Return an expansion of one drive in which nothing moves."""
    rate, real, still = np.zeros(modes), np.zeros((1, responses, modes)), np.zeros((1, responses))
    return Expansion(rate, rate, real, real, still, still)


def _smooth(given: Force | float) -> Force | float:
    """Return a force without blows at an instant."""
    if isinstance(given, float) or not given.blows:
        return given
    if not isinstance(given, Sum):
        return Sum(())
    return Sum(tuple(one for one in map(_smooth, given.forces) if not isinstance(one, float)))
