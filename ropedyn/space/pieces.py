"""The pieces of a rope: kinematics of the axis, section, initial force and moment."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..axis.axis import Axis
from ..axis.piece import CatenaryPiece, Piece
from ..base.array import Real
from ..base.chebyshev import nodes_of
from .rope import SAMPLED, SIGN, SIX, SpaceRope
from .samples import SAMPLES, tail

FOLLOWED = 1e-11
"""The last two coefficients of what changes along a piece, relative, which a polynomial is cut at.

Frequencies of catenaries and strips were 5e-14 off with them at most."""
ROUNDED = 2e-15  # Cosines that are less are 0 but for rounding.
FINER = 1e-14  # The same of a rope that others are held against.


class SpaceSection(NamedTuple):
    """What a rope in space is made of; infinite stiffnesses are absent effects."""

    bending: tuple[float, float] | None  # of beta and of gamma [N m^2]; None: a string
    torsion: float | None  # [N m^2]
    density: float  # [kg/m]
    axial: float | None = None  # [N]
    shear: float | None = None  # k_s G A [N]
    coupling: float = 0.0  # D [N m]
    slope: float = 0.0  # of the lay
    rotary: tuple[float, float] = (0.0, 0.0)  # of beta and of gamma [kg m]
    polar: float = 0.0  # [kg m]
    angle: tuple[tuple[float, ...], tuple[float, ...]] = ((0.0,), (0.0,))  # of principal axes, by s

    def flexibility(self, s: Real) -> Real:
        """Return S over the six forces, shape (s, 6, 6)."""
        S, own = np.zeros((6, 6)), [0, 3, 4]
        if self.bending is None:
            S[0, 0] = 1 / self.axial if self.axial else 0.0
            return np.tile(S, (len(s), 1, 1))
        across, other = self.bending
        S[np.ix_(own, own)] = _core.section(
            self.axial or 0.0, self.torsion or 0.0, across, self.coupling, self.slope
        )
        S[5, 5] = 1 / other
        if self.shear is not None:
            S[1, 1] = S[2, 2] = 1 / self.shear
        turn = np.tile(np.eye(6), (len(s), 1, 1))
        angle = np.interp(s, *self.angle)
        turn[:, 4, 4] = turn[:, 5, 5] = np.cos(angle)
        turn[:, 4, 5], turn[:, 5, 4] = np.sin(angle), -np.sin(angle)
        return turn @ S @ turn.swapaxes(1, 2)

    def inertia(self) -> Real:
        """Return the inertia per length, shape (6, 6)."""
        return np.diag([*[self.density] * 3, self.polar, *self.rotary])


def bend_of(rates: Real) -> Real:
    """Return how motion that strains nothing changes along the axis, u' = A u, shape (s, 6, 6).

    rates : (s, 3) tau, kz, ky.
    """
    bend = np.zeros((len(rates), 6, 6))
    bend[:, :3, :3] = -cross(rates * [1.0, -1.0, 1.0])
    bend[:, 3:, 3:] = SIGN[3:, 3:] @ bend[:, :3, :3] @ SIGN[3:, 3:]
    bend[:, 1, 5] = bend[:, 2, 4] = 1.0
    return bend


def cross(v: Any) -> Real:
    """Return the matrices of cross products with vectors (.., 3)."""
    found = np.zeros((*np.shape(v), 3))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        found[..., k, j], found[..., j, k] = v[..., i], -v[..., i]
    return found


def initial_of(force: Real, moment: Real) -> tuple[Real, Real]:
    """Return Gamma and K of initial forces (T, V) and moments (s, 3), vectors along x, y, z.

    Gamma = [[0, [n]], [0, [m]/2]] and K = T (1 - t t^T) - (V t^T + t V^T)/2 of rotations.
    """
    gamma, stress = np.zeros((2, len(force), 6, 6))
    gamma[:, :3, 3:], gamma[:, 3:, 3:] = cross(force), cross(moment) / 2
    stress[:, 4, 4] = stress[:, 5, 5] = force[:, 0]
    stress[:, 3, 4:] = stress[:, 4:, 3] = -force[:, 1:] / 2
    return SIGN @ gamma @ SIGN, SIGN @ stress @ SIGN


def moment_at_rest(
    section: SpaceSection, bent: bool, torque: float, rates: Real, slope: Real
) -> tuple[Real, Real]:
    """Return shear and moment (s, 3) that a torque and bending from straight leave in a rope.

    m = (M + C tau, -B kz, 0), of what is naturally as its axis (M, 0, 0), and with kz' the balance
    m' + omega x m + t x n = 0 asks for V = (0, kz tau (B - C) - kz M, -B kz').
    """
    tau, kz, none = rates[:, 0], rates[:, 1], 0 * slope
    B, C = (section.bending or (0.0,))[0] * bent, (section.torsion or 0.0) * bent
    shear = np.stack([none, kz * (tau * (B - C) - torque), -B * slope], axis=1)
    return shear, np.stack([torque + C * tau, -B * kz, none], axis=1)


def kink_of(turn: Real) -> Real:
    """Return what a rotation of vectors does to the six coordinates."""
    both = np.zeros((6, 6))
    # what frames leave of a zero would tie the planes of a plane curve
    both[:3, :3] = both[3:, 3:] = np.where(np.abs(turn) > ROUNDED, turn, 0.0)
    return SIGN @ both @ SIGN


class Rest(NamedTuple):
    """The state about which a rope moves."""

    tension: float = 0.0  # [N], but where it hangs
    weight: float = 0.0  # along catenaries [N/m]
    friction: float = 0.0  # of sheaves
    ahead: float = 0.0  # angle by which the axis turns up to where the tension is so [rad]
    torque: float = 0.0  # [N m]
    axial: float = 0.0  # along the cylinder of a helix [N]
    bent: bool = False  # from what is straight when nothing loads it

    def pull(self, piece: Piece, s: Real, turned: float) -> Real:
        """Return the tension at arc lengths of a piece, turned by so much at its left end [N]."""
        if self.weight and isinstance(piece, CatenaryPiece):
            return np.asarray(self.weight * piece.pull(s))
        angle = turned + piece.turned(s) - self.ahead
        return self.tension * np.exp(self.friction * angle)

    def load(self, tau: Real, kz: Real) -> tuple[Real, Real]:
        """Return shear and moment (s, 3) that a force P along the cylinder of a helix leaves.

        n = P c, c = (tau, -kz, 0)/omega along the cylinder, and m = -r x n = P R (-c_y, c_x, 0) at
        r = -R z from its axis, R = kz/omega^2.
        """
        omega = np.copysign(np.hypot(tau, kz), tau)
        across, along, none = -kz / omega, tau / omega, 0 * kz
        arm = self.axial * kz / omega**2
        return (
            np.stack([none, self.axial * across, none], axis=1),
            np.stack([-arm * across, arm * along, none], axis=1),
        )


def rope_of(
    axis: Axis,
    section: SpaceSection,
    rest: Rest,
    absent: tuple[str, ...] = (),
    *,
    followed: float = FOLLOWED,
) -> SpaceRope:
    """Return the pieces of an axis, nothing at their nodes."""
    blocks = [
        one for k in range(len(axis.pieces)) for one in _blocks(axis, k, section, rest, followed)
    ]
    begins, lengths = (np.array([one[k] for one in blocks]) for k in (0, 1))
    count, few = len(blocks), slice(None if any(one.changes for one in blocks) else 1)
    arrays: dict[str, Any] = {
        name: np.array([one.along[name][few] for one in blocks]) for name in SAMPLED
    }
    turn = np.tile(np.eye(6), (count, 1, 1))
    for kink in axis.kinks:
        turn[np.abs(begins - kink.s).argmin()] = kink_of(kink.turn)
    springs, masses, dashpots = (np.zeros((count + 1, 6, 6)) for _ in range(3))
    gone = np.array([c in absent for c in SIX])
    return SpaceRope(
        length=lengths,
        share=np.ones(count),
        inertia=np.tile(section.inertia(), (count, 1, 1)),
        drag=np.zeros((count, 6, 6)),
        turn=turn,
        springs=springs,
        masses=masses,
        dashpots=dashpots,
        held=np.tile(gone, (count + 1, 1)),
        absent=gone,
        **arrays,
    )


class FollowedBlock(NamedTuple):
    """A part of an axis that polynomials follow, by its arc length."""

    begin: float
    length: float
    along: dict[str, Real]  # what there is at its samples
    changes: bool


def _blocks(
    axis: Axis, k: int, section: SpaceSection, rest: Rest, followed: float
) -> Iterator[FollowedBlock]:
    """Yield those of piece k."""
    piece, start = axis.pieces[k], float(axis.joints[k])
    corners = np.array(section.angle[0]) - start
    inside = corners[(corners > 1e-9 * piece.length) & (corners < (1 - 1e-9) * piece.length)]
    left = list(itertools.pairwise([0.0, *inside, piece.length]))[::-1]
    while left:
        begin, end = left.pop()
        s = begin + (end - begin) * nodes_of(SAMPLES)
        given = _along(axis, k, s, section, rest)
        changing = [values for values in given.values() if (values != values[0]).any()]
        missed = max((tail(values) for values in changing), default=0.0)
        if missed > followed and end - begin > 1e-6 * piece.length:
            left += [((begin + end) / 2, end), (begin, (begin + end) / 2)]
            continue
        yield FollowedBlock(start + begin, end - begin, given, bool(changing))


def _along(axis: Axis, k: int, s: Real, section: SpaceSection, rest: Rest) -> dict[str, Real]:
    """Return what belongs to arc lengths of piece k, arrays (s, 6, 6)."""
    piece, start = axis.pieces[k], axis.joints[k]
    tension, rates = rest.pull(piece, s, float(axis.turned(start))), piece.rates(s)
    bend = bend_of(rates)
    string, initial, stress = (np.zeros((len(s), 6, 6)) for _ in range(3))
    if section.bending is None:
        bend[:, 3:] = bend[:, :, 3:] = 0.0
        string[:, 1, 1] = string[:, 2, 2] = 1 / tension
    else:
        force, moment = moment_at_rest(section, rest.bent, rest.torque, rates, piece.bending(s))
        if rest.axial:
            loaded = rest.load(*rates[:, :2].T)
            force, moment = force + loaded[0], moment + loaded[1]
        force[:, 0] += tension
        initial, stress = initial_of(force, moment)
    soft = section.flexibility(start + s)
    return {"bend": bend, "soft": soft, "string": string, "initial": initial, "stress": stress}
