"""The pieces of a rope: kinematics of the axis, section, initial force and moment."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..axis.axis import Axis
from ..base.array import Real
from .rope import SIGN, SpaceRope


class SpaceSection(NamedTuple):
    """What a rope in space is made of; infinite stiffnesses are absent effects."""

    bending: tuple[float, float]  # of beta and of gamma [N m^2]
    torsion: float  # [N m^2]
    density: float  # [kg/m]
    axial: float | None = None  # [N]
    shear: float | None = None  # k_s G A [N]
    coupling: float = 0.0  # D [N m]
    slope: float = 0.0  # of the lay
    rotary: tuple[float, float] = (0.0, 0.0)  # of beta and of gamma [kg m]
    polar: float = 0.0  # [kg m]

    def flexibility(self) -> Real:
        """Return S over the six forces, shape (6, 6)."""
        S, own = np.zeros((6, 6)), [0, 3, 4]
        across, other = self.bending
        S[np.ix_(own, own)] = _core.section(
            self.axial or 0.0, self.torsion, across, self.coupling, self.slope
        )
        S[5, 5] = 1 / other
        if self.shear is not None:
            S[1, 1] = S[2, 2] = 1 / self.shear
        return S

    def inertia(self) -> Real:
        """Return the inertia per length, shape (6, 6)."""
        return np.diag([*[self.density] * 3, self.polar, *self.rotary])


def bend_of(tau: float, kz: float, ky: float) -> Real:
    """Return how motion that strains nothing changes along the axis, u' = A u, shape (6, 6)."""
    return np.array(
        [
            [0, ky, kz, 0, 0, 0],
            [-ky, 0, tau, 0, 0, 1],
            [-kz, -tau, 0, 0, 1, 0],
            [0, 0, 0, 0, -ky, kz],
            [0, 0, 0, ky, 0, -tau],
            [0, 0, 0, -kz, tau, 0],
        ],
        dtype=np.float64,
    )


def cross(v: Any) -> Real:
    """Return the matrix of a cross product with a vector."""
    x, y, z = v
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def initial_of(force: Real, moment: Real) -> tuple[Real, Real]:
    """Return Gamma and K of an initial force (T, V) and moment, vectors along x, y, z.

    Gamma = [[0, [n]], [0, [m]/2]] and K = T (1 - t t^T) - (V t^T + t V^T)/2 of rotations.
    """
    gamma, stress = np.zeros((6, 6)), np.zeros((6, 6))
    gamma[:3, 3:], gamma[3:, 3:] = cross(force), cross(moment) / 2
    across = np.array([0.0, *force[1:]])
    stress[3:, 3:] = np.diag([0.0, force[0], force[0]])
    stress[3, 3:] -= across / 2
    stress[3:, 3] -= across / 2
    return SIGN @ gamma @ SIGN, SIGN @ stress @ SIGN


def bent_from_straight(section: SpaceSection, tau: float, kz: float) -> tuple[Real, Real]:
    """Return the shear and the moment of what is straight when nothing loads it.

    m = (C tau, -B kz, 0), and the balance m' + omega x m + t x n = 0 asks for V_y.
    """
    B, C = section.bending[0], section.torsion
    return np.array([0.0, kz * tau * (B - C), 0.0]), np.array([C * tau, -B * kz, 0.0])


def kink_of(turn: Real) -> Real:
    """Return what a rotation of vectors does to the six coordinates."""
    both = np.zeros((6, 6))
    both[:3, :3] = both[3:, 3:] = turn
    return SIGN @ both @ SIGN


def rope_of(axis: Axis, section: SpaceSection, tension: float, *, bent: bool = False) -> SpaceRope:
    """Return the pieces of an axis, nothing at their nodes; `bent`: from what is straight."""
    count = len(axis.pieces)
    S, mass = section.flexibility(), section.inertia()
    bend, string, initial, stress = (np.zeros((count, 1, 6, 6)) for _ in range(4))
    turn = np.tile(np.eye(6), (count, 1, 1))
    joints = axis.joints
    for k, (tau, kz, ky) in enumerate(axis.rates(joints[:-1])):
        bend[k, 0] = bend_of(tau, kz, ky)
        across, moment = bent_from_straight(section, tau, kz) if bent else np.zeros((2, 3))
        pull = np.array([tension, 0.0, 0.0])
        initial[k, 0], stress[k, 0] = initial_of(pull + across, moment)
    for kink in axis.kinks:
        turn[np.abs(joints - kink.s).argmin()] = kink_of(kink.turn)
    springs, masses, dashpots = (np.zeros((count + 1, 6, 6)) for _ in range(3))
    return SpaceRope(
        length=np.array([piece.length for piece in axis.pieces]),
        bend=bend,
        soft=np.tile(S, (count, 1, 1, 1)),
        string=string,
        initial=initial,
        stress=stress,
        inertia=np.tile(mass, (count, 1, 1)),
        drag=np.zeros((count, 6, 6)),
        turn=turn,
        springs=springs,
        masses=masses,
        dashpots=dashpots,
        held=np.zeros((count + 1, 6), dtype=bool),
    )
