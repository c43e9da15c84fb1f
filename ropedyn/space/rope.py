"""A rope on an axis as arrays: what changes motion and force along each of its uniform pieces."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..base.array import Complex, Flags, Index, Real

SIX = ("x", "y", "z", "alpha", "beta", "gamma")

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


@dataclass(frozen=True, eq=False)
class SpaceRope:
    """Uniform pieces one after another; matrices over the six coordinates.

    Attributes
    ----------
    length : ndarray, shape (pieces,)
        [m].
    bend : ndarray, shape (pieces, 6, 6)
        Of the axis: u' = bend u where nothing is strained.
    soft : ndarray, shape (pieces, 6, 6)
        Section flexibility.
    initial, stress : ndarray, shape (pieces, 6, 6)
        Gamma and K of the initial force and moment.
    inertia, drag : ndarray, shape (pieces, 6, 6)
        Per length.
    turn : ndarray, shape (pieces, 6, 6)
        Components on the left of the node where it begins to those on the right.
    springs, masses, dashpots : ndarray, shape (pieces + 1, 6, 6)
        At nodes.
    held : ndarray of bool, shape (pieces + 1, 6)
    """

    length: Real
    bend: Matrices
    soft: Matrices
    initial: Matrices
    stress: Matrices
    inertia: Matrices
    drag: Matrices
    turn: Matrices
    springs: Matrices
    masses: Matrices
    dashpots: Matrices
    held: Flags

    @property
    def x(self) -> Real:
        """Where the nodes stand [m]."""
        return np.concatenate([[0.0], np.cumsum(self.length)])

    @property
    def unknowns(self) -> int:
        """How many coordinates of nodes can move."""
        return int((~self.held).sum())

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
        arrays = {name: getattr(self, name)[piece] for name in PIECEWISE}
        arrays["turn"] = np.where(begins[:, None, None], self.turn[piece], np.eye(6))
        at = np.searchsorted(stations, x - near)
        for name in NODAL:
            old = getattr(self, name)
            new = np.zeros((len(stations), *old.shape[1:]), dtype=old.dtype)
            new[at] = old
            arrays[name] = new
        cut = replace(self, length=np.diff(stations), **arrays)
        return cut, np.abs(stations - np.asarray(places)[:, None]).argmin(axis=1)

    def rates(self, factors: Factors) -> Complex:
        """Return Phi, S and q, shape (n, pieces, 3, 6, 6)."""
        section, tension, _, inertia, drag = (of_lines(one) for one in factors)
        initial, S = tension * self.initial, self.soft / section
        SH = S @ initial
        q = tension * self.stress + inertia * self.inertia + drag * self.drag
        q = q - initial.swapaxes(2, 3) @ SH
        return np.stack(np.broadcast_arrays(self.bend + SH, S + 0j, q), axis=2)

    def nodes(self, factors: Factors) -> Complex:
        """Return the stiffness of what stands at the nodes, shape (n, pieces + 1, 6, 6)."""
        _, _, springs, inertia, drag = (of_lines(one) for one in factors)
        return springs * self.springs + inertia * self.masses + drag * self.dashpots

    def scale(self, eigenvalue: float) -> Real:
        """Return z (6,), u = z u^ and f = f^/z, so that what a wave does is of size 1."""
        # z^2 is the receptance of a long straight beam of wavenumbers k and a, 1/(B k (k^2 + a^2))
        # across it and 1/(B a) of rotation; none of both is less than curvature and length tell
        soft = np.diagonal(self.soft, axis1=1, axis2=2)[:, 4:].min()
        load = abs(eigenvalue) * self.inertia[:, 1, 1].max() * soft
        half = soft * self.stress[:, 4, 4].max() / 2
        least = np.abs(self.bend[:, :3, :3]).max() ** 2 + 1 / self.length.sum() ** 2
        both = math.hypot(half, math.sqrt(load))
        large, small = both + abs(half), load / (both + abs(half)) if load > 0 else 0.0
        k2, a2 = ((small, large) if half >= 0 else (large, small)) + np.full(2, least)
        across = 1 / math.sqrt(k2) / (k2 + a2)
        return np.repeat(np.sqrt(soft * np.array([across, 1 / math.sqrt(a2)])), 3)

    def core(self, eigenvalue: float) -> tuple[Any, ...]:
        """Return what the core counts by, scaled for an eigenvalue."""
        z = self.scale(eigenvalue)
        phi, S, q = self.rates(unforced([0.0]))[0].real.swapaxes(0, 1) * _scaled(z)
        both = np.outer(z, z)
        mass = self.inertia * both
        norm = size_of(phi, S, q - eigenvalue * mass)
        nodes = (self.springs * both, self.masses * both)
        arrays = (phi, S, q, mass, self.turn * np.outer(1 / z, z), *nodes)
        whole = tuple(np.ascontiguousarray(one) for one in arrays)
        held = np.ascontiguousarray(self.held.astype(np.uint8))
        return (self.length, halvings(norm * self.length), *whole, held)


PIECEWISE = ("bend", "soft", "initial", "stress", "inertia", "drag")
NODAL = ("springs", "masses", "dashpots", "held")


def unforced(eigenvalue: Real | list[float], step: float = 0.0) -> Factors:
    """Return the factors of free motion, lambda + i step."""
    inertia = -(np.asarray(eigenvalue) + 1j * step)
    one = np.ones_like(inertia)
    return Factors(one, one, one, inertia, 0 * one)


def of_lines(factor: Complex) -> Complex:
    """Return a factor of each line beside pieces or nodes and their matrices."""
    return np.asarray(factor)[:, None, None, None]


def _scaled(z: Real) -> Real:
    """Return what scaling multiplies Phi, S and q by, shape (3, 1, 6, 6)."""
    return np.stack([np.outer(1 / z, z), np.outer(1 / z, 1 / z), np.outer(z, z)])[:, None]


def scaled_rates(rates: Complex, z: Real) -> Complex:
    """Return Phi, S, q of scaled coordinates."""
    return rates * _scaled(z).swapaxes(0, 1)


def size_of(phi: Complex, S: Complex, q: Complex) -> Real:
    """Return the largest singular value of each [[Phi, S], [q, -Phi^T]]."""
    E = np.concatenate(
        [np.concatenate([phi, S], axis=-1), np.concatenate([q, -phi.swapaxes(-1, -2)], axis=-1)],
        axis=-2,
    )
    return np.linalg.norm(E, 2, axis=(-2, -1))


def halvings(radians: Real) -> NDArray[np.int32]:
    """Return how often pieces are halved for their series."""
    return np.maximum(np.ceil(np.log2(np.maximum(radians, 1e-300) / RADIANS)), 0).astype(np.int32)


RADIANS = 0.5  # Of the first piece that is summed as a series.
