"""A rope on an axis as arrays: what changes motion and force along each of its pieces."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..base.array import Complex, Flags, Index, Real
from ..base.check import NEAR
from ..base.computed import computed
from ..chain.wide import SLIGHT, nudged
from .samples import coefficients, resampled, series_of

SIX = ("x", "y", "z", "alpha", "beta", "gamma")

ALL = np.arange(6)[None]
PLANES = np.array([[0, 2, 4], [1, 3, 5]])
"""Coordinates that move together where a curve is plane and nothing ties its planes."""

SIGN = np.diag([1.0, 1.0, 1.0, 1.0, -1.0, 1.0])
"""Between coordinates and vectors along x, y, z: beta = -theta_y, M_beta = -m_y."""


Matrices = NDArray[Any]


class Factors(NamedTuple):
    """What stiffnesses, inertia and drag are multiplied by, one for each of n lines."""

    section: Complex
    tension: Complex
    springs: Complex
    inertia: Complex
    drag: Complex
    loss: Complex  # of what is carried: 0 or 1 times its own


class Carried(NamedTuple):
    """A wire that a node carries, clamped to it at its left end."""

    node: int
    arm: Real  # (6, 6) motion of its left end per motion of the node
    aim: Real  # (6,) of its right end, what is seen of its motion
    rope: SpaceRope
    loss: float  # of its stiffness


@dataclass(frozen=True, eq=False)
class SpaceRope:
    """Pieces one after another; matrices over the six coordinates.

    What may change along a piece is given at samples (`samples.py`), one where it does not.

    Attributes
    ----------
    length : ndarray, shape (pieces,)
        [m].
    share : ndarray, shape (pieces,)
        Of what was cut into pieces, along which a polynomial has few waves.
    bend : ndarray, shape (pieces, samples, 6, 6)
        Of the axis: u' = bend u where nothing is strained.
    soft : ndarray, shape (pieces, samples, 6, 6)
        Section flexibility.
    string : ndarray, shape (pieces, samples, 6, 6)
        What a rope without bending gives way by across its tension.
    initial, stress : ndarray, shape (pieces, samples, 6, 6)
        Gamma and K of the initial force and moment.
    inertia, drag : ndarray, shape (pieces, 6, 6)
        Per length.
    turn : ndarray, shape (pieces, 6, 6)
        Components on the left of the node where it begins to those on the right.
    springs, masses, dashpots : ndarray, shape (pieces + 1, 6, 6)
        At nodes.
    held : ndarray of bool, shape (pieces + 1, 6)
    absent : ndarray of bool, shape (6,)
        Coordinates that it does not have anywhere.
    carried : tuple of Carried
        Wires at nodes.
    closed : bool
        Whether its ends are one node, the first: nothing stands at the last.
    longer : float
        Than places along it are told by, times: of one on its catenary, arc over chord.
    """

    length: Real
    share: Real
    bend: Matrices
    soft: Matrices
    string: Matrices
    initial: Matrices
    stress: Matrices
    inertia: Matrices
    drag: Matrices
    turn: Matrices
    springs: Matrices
    masses: Matrices
    dashpots: Matrices
    held: Flags
    absent: Flags
    carried: tuple[Carried, ...] = ()
    closed: bool = False
    longer: float = 1.0

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Those it has."""
        return tuple(c for c, gone in zip(SIX, self.absent) if not gone)

    @property
    def x(self) -> Real:
        """Where the nodes stand [m]."""
        return np.concatenate([[0.0], np.cumsum(self.length)])

    @property
    def changes(self) -> bool:
        """Whether something changes along a piece."""
        return self.bend.shape[1] > 1

    @property
    def unknowns(self) -> int:
        """How many coordinates of nodes can move."""
        return int((~self.held[: len(self.held) - self.closed]).sum())

    @computed
    def own(self) -> Index:
        """Coordinates of each component, (components, width): all six, or three of each plane."""
        inside, across = PLANES
        ties = (np.s_[..., inside[:, None], across], np.s_[..., across[:, None], inside])
        tied = any(getattr(self, name)[tie].any() for name in MATRICES for tie in ties)
        if tied or self.carried:
            return ALL
        return PLANES[~self.absent[PLANES].all(axis=1)]

    @computed
    def blocks(self) -> SpaceRope:
        """It with the matrices (components, .., width, width) of each component in place of its."""
        own = self.own
        rows, columns = own[:, :, None], own[:, None, :]
        blocks: dict[str, Any] = {
            k: np.stack([getattr(self, k)[..., r, c] for r, c in zip(rows, columns)])
            for k in MATRICES
        }
        held, absent = self.held[:, own].swapaxes(0, 1), self.absent[own]
        return replace(self, held=held, absent=absent, **blocks)

    def has_inertia(self, coordinates: tuple[str, ...]) -> bool:
        """Whether any of some coordinates has inertia."""
        at = [SIX.index(c) for c in coordinates]
        of = (self.inertia, self.masses)
        return any(bool(one[:, at, at].any()) for one in of)

    def cut(self, places: Real, near: float) -> tuple[SpaceRope, Index]:
        """Return it with nodes at places too, and which nodes these are."""
        x = self.x
        away = [p for p in np.unique(places) if np.abs(x - p).min() > near]
        stations = np.sort(np.concatenate([x, away]))
        piece = np.clip(np.searchsorted(x, stations[:-1] + near) - 1, 0, len(self.length) - 1)
        begins = np.isin(stations[:-1], x)
        inside = (np.stack([stations[:-1], stations[1:]]) - x[piece]) / self.length[piece]
        arrays = {name: getattr(self, name)[piece] for name in PIECEWISE}
        arrays |= {name: resampled(getattr(self, name)[piece], *inside) for name in SAMPLED}
        arrays["turn"] = np.where(begins[:, None, None], self.turn[piece], np.eye(6))
        at = np.searchsorted(stations, x - near)
        for name in NODAL:
            old = getattr(self, name)
            new = np.zeros((len(stations), *old.shape[1:]), dtype=old.dtype)
            new[at] = old
            arrays[name] = new
        arrays["held"] |= self.absent
        arrays["carried"] = tuple(c._replace(node=int(at[c.node])) for c in self.carried)
        share = self.share[piece] * (inside[1] - inside[0])
        cut = replace(self, length=np.diff(stations), share=share, **arrays)
        return cut, cut.node_at(places)

    def nudged(self, random: np.random.Generator) -> tuple[SpaceRope, Index]:
        """Return it with every number a little off and cut elsewhere, and where its nodes are."""
        x, near = self.x, NEAR * self.length.sum()
        one, _ = self.cut(x[:-1] + random.uniform(0.2, 0.8, len(x) - 1) * self.length, near)
        off: dict[str, Any] = {k: nudged(getattr(one, k), random) for k in ("length", *MATRICES)}
        # entries of a rotation are as sure as its largest
        turned = (one.turn != np.eye(6)).any((1, 2))[:, None, None] & (one.turn != 0)
        off["turn"] = one.turn + turned * SLIGHT * random.uniform(-1, 1, one.turn.shape)
        wires = tuple(w._replace(rope=w.rope.nudged(random)[0]) for w in one.carried)
        return replace(one, **off, carried=wires), np.searchsorted(one.x, x - near)

    def node_at(self, places: ArrayLike) -> Index:
        """Return the nodes next to places [m]."""
        node = np.abs(self.x - np.asarray(places)[..., None]).argmin(axis=-1)
        return node % len(self.length) if self.closed else node

    def rates(self, which: Index, factors: Factors) -> Complex:
        """Return Phi, S and q of components at lines, (n, pieces, samples, 3, width, width)."""
        section, tension, _, inertia, drag = (of_lines(one)[..., None] for one in factors[:5])
        own = self.blocks
        found = np.empty((len(section), *own.bend.shape[1:3], 3, *own.bend.shape[3:]), complex)
        phi, S, q = (found[:, :, :, k] for k in range(3))
        S[:] = own.soft[which] / section
        if own.string.any():
            S += own.string[which] / tension
        phi[:] = own.bend[which]
        q[:] = tension * own.stress[which] + inertia * own.inertia[which][:, :, None]
        if own.drag.any():
            q += drag * own.drag[which][:, :, None]
        if own.initial.any():
            # a string, which gives by 1/T, has none
            SH, HSH = own.with_initial
            phi += tension / section * SH[which]
            q -= tension**2 / section * HSH[which]
        return found

    @computed
    def with_initial(self) -> tuple[Matrices, Matrices]:
        """Return S Gamma and Gamma^T S Gamma of the section's flexibility."""
        SH = self.soft @ self.initial
        return SH, self.initial.swapaxes(-1, -2) @ SH

    def nodes(self, which: Index, factors: Factors) -> Complex:
        """Return the stiffness of what stands at the nodes, shape (n, pieces + 1, width, width)."""
        _, _, springs, inertia, drag = (of_lines(one) for one in factors[:5])
        own = self.blocks
        return (
            springs * own.springs[which] + inertia * own.masses[which] + drag * own.dashpots[which]
        )

    @computed
    def kinks(self) -> list[int]:
        """Pieces that begin with one."""
        return [int(p) for p in np.flatnonzero((self.turn != np.eye(6)).any((1, 2)))]

    @computed
    def softest(self) -> tuple[float, float]:
        """Flexibilities of bending and of a string, the largest [1/N m^2, 1/N]."""
        soft, string = (np.diagonal(one.real, axis1=2, axis2=3) for one in (self.soft, self.string))
        return float(soft[..., 4:].max()), float(string[..., 1:3].max())

    @computed
    def unit(self) -> float:
        """The eigenvalue that its stiffness gives a length like the rope's [rad^2/s^2]."""
        bends, gives = self.softest
        length, mass = self.length.sum(), self.inertia[:, 1, 1].max()
        return float(1 / (mass * (bends * length**4 if bends > 0 else gives * length**2)))

    def at_wave(self, wavenumber: float) -> float:
        """Return the eigenvalue of a wave of a long straight rope [rad^2/s^2]."""
        bends, gives = self.softest
        mass, square = self.inertia[:, 1, 1].max(), wavenumber**2
        if bends == 0:
            return float(square / (gives * mass))
        return float(square * (square / bends + max(self.pull, 0.0)) / mass)

    def waves(self, eigenvalue: float) -> float:
        """Return the largest wavenumber of a long straight rope [rad/m]."""
        bends, gives = self.softest
        load = abs(eigenvalue) * self.inertia[:, 1, 1].max()
        if bends == 0:
            return float(np.sqrt(load * gives))
        half = bends * max(float(self.stress[..., 4, 4].min()), 0.0) / 2
        large = half + np.hypot(half, np.sqrt(load * bends))
        return float(np.sqrt(load * bends / large)) if large > 0 else 0.0

    @computed
    def pull(self) -> float:
        """The largest tension [N]."""
        return float(self.stress[..., 4, 4].real.max())

    @computed
    def of_waves(self) -> tuple[float, float, float, float, float]:
        """Mass, flexibility of bending (the least), T/2 of it and flexibility of a string.

        Last the square of what mean curvature and length tell of wavenumbers [rad^2/m^2].
        """
        soft = float(np.diagonal(self.soft.real, axis1=2, axis2=3)[..., 4:].min())
        bent = np.abs(self.bend[..., :3, :3]).max(axis=(1, 2, 3))
        least = float(((bent @ self.length) ** 2 + 1) / self.length.sum() ** 2)
        mass, gives = float(self.inertia[:, 1, 1].real.max()), self.softest[1]
        return mass, soft if self.softest[0] > 0 else 0.0, soft * self.pull / 2, gives, least

    def scale(self, which: Index, eigenvalue: ArrayLike) -> Real:
        """Return z (n, width), u = z u^ and f = f^/z, so that what a wave does is of size 1."""
        # z^2 is the receptance of a long straight beam of wavenumbers k and a, 1/(B k (k^2 + a^2))
        # across it and 1/(B a) of rotation, of a string 1/(T k); none of these wavenumbers is less
        # than curvature and length tell
        mass, soft, half, gives, least = self.of_waves
        load = np.abs(eigenvalue) * mass
        z = np.empty((len(load), 2))
        if soft > 0:
            large = np.hypot(half, np.sqrt(load * soft)) + abs(half)
            small = load * soft / np.maximum(large, TINY)
            k2, a2 = (small + least, large + least)[:: 1 if half >= 0 else -1]
            z[:, 0], z[:, 1] = soft / (np.sqrt(k2) * (k2 + a2)), soft / np.sqrt(a2)
        else:
            z[:, 0], z[:, 1] = gives / np.sqrt(load * gives + least), 1.0
        z = np.sqrt(z)
        return z[np.arange(len(z))[:, None], self.own[which] // 3]

    @computed
    def at_rest(self) -> Real:
        """Phi, S and q where nothing moves, of each component as `rates` of a line."""
        every = np.arange(len(self.own))
        return np.ascontiguousarray(self.rates(every, unforced([0.0] * len(every))).real)

    @computed
    def least_radians(self) -> Real:
        """What pieces count as at least, so that the series of what changes converge, (pieces,)."""
        return self.share * (RADIANS * PARTS if self.changes else 0.0)

    @computed
    def alike(self) -> tuple[Any, ...]:
        """What the core counts by that no eigenvalue changes."""
        one = self.blocks
        beside = one.inertia, one.turn, one.springs, one.masses, one.held.astype(np.uint8)
        return (coefficients(self.at_rest), *(np.ascontiguousarray(array) for array in beside))

    def core(self, which: Index, eigenvalues: Real) -> tuple[tuple[Any, ...], Real]:
        """Return what the core counts components by at eigenvalues, and the scale of each."""
        z, samples = self.scale(which, eigenvalues), self.bend.shape[1]
        halved = np.zeros(len(self.length), dtype=np.int32)
        if self.changes:
            rates = self.at_rest[which]
            inertia = self.blocks.inertia[which]
            rates[:, :, :, 2] -= eigenvalues[:, None, None, None, None] * inertia[:, :, None]
            radians = size_of(scaled_rates(rates, z)).max(axis=(0, 2)) * self.length
            halved = halvings(np.maximum(radians, self.least_radians))
        series = [series_of(length, int(n), samples) for length, n in zip(self.length, halved)]
        nodes = np.array([len(one) for one in series], dtype=np.int32)
        fields, *beside = self.alike
        return (self.length, halved, nodes, fields, np.concatenate(series), *beside, self.closed), z


SAMPLED = ("bend", "soft", "string", "initial", "stress")
PIECEWISE = ("inertia", "drag")
NODAL = ("springs", "masses", "dashpots", "held")
MATRICES = (*SAMPLED, *PIECEWISE, "turn", *NODAL[:3])


def unforced(eigenvalue: Real | list[float], step: float = 0.0) -> Factors:
    """Return the factors of free motion, lambda + i step."""
    inertia = -(np.asarray(eigenvalue) + 1j * step)
    one = np.ones_like(inertia)
    return Factors(one, one, one, inertia, 0 * one, 0 * one)


def of_lines(factor: Complex) -> Complex:
    """Return a factor of each line beside pieces or nodes and their matrices."""
    return np.asarray(factor)[:, None, None, None]


def scaled_rates(rates: Matrices, z: Real) -> Matrices:
    """Return Phi, S, q of scaled coordinates of each line."""
    over, by = 1 / z[:, :, None], z[:, :, None]
    other = z[:, None, :]
    return rates * np.stack([over * other, over / other, by * other], axis=1)[:, None, None]


def size_of(rates: Matrices) -> Real:
    """Return a norm of each [[Phi, S], [q, -Phi^T]], the lesser of those by rows and by columns."""
    phi, S, q = np.moveaxis(np.abs(rates), -3, 0)
    rows, columns = phi.sum(-1), phi.sum(-2)
    by_rows = np.maximum(rows + S.sum(-1), q.sum(-1) + columns).max(-1)
    by_columns = np.maximum(columns + q.sum(-2), S.sum(-2) + rows).max(-1)
    return np.minimum(by_rows, by_columns)


def halvings(radians: Real) -> NDArray[np.int32]:
    """Return how often pieces are halved for their series."""
    return np.maximum(np.ceil(np.log2(np.maximum(radians, TINY) / RADIANS)), 0).astype(np.int32)


SPRINGS = 7  # Where they stand among what the core counts by.
PARTS = 8  # Of a block that changes: terms of their series fall by 8 each.
TINY = 1e-300
RADIANS = 0.5  # Of the first piece that is summed as a series.
