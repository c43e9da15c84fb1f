"""Pieces of an axis: how the frame turns along each, and where that leads."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from ..base.array import Real


class UniformPiece(NamedTuple):
    """A line, an arc or a helix: curvature towards z and torsion are constant."""

    length: float  # [m]
    torsion: float = 0.0  # [rad/m]
    curvature: float = 0.0  # [rad/m]

    def rates(self, s: Real) -> Real:
        """Return (tau, kz, ky) at arc lengths, shape (s, 3) [rad/m]."""
        return np.tile([self.torsion, self.curvature, 0.0], (len(s), 1))

    def bending(self, s: Real) -> Real:
        """Return how curvature changes along it [rad/m^2]."""
        return 0 * s

    def turned(self, s: Any) -> Any:
        """Return the angle that the tangent turns by up to arc lengths [rad]."""
        return self.curvature * s

    def travel(self, s: Real) -> tuple[Real, Real]:
        """Return positions and frames there in the frame of the start, (s, 3) and (s, 3, 3)."""
        # with W the cross product with omega = (tau, -kz, 0) and t = |omega| s
        #     exp(W s) = 1 + sin(t)/t W s + (1 - cos t)/t^2 (W s)^2, and its integral of e_x
        W = np.array(
            [
                [0.0, 0.0, -self.curvature],
                [0.0, 0.0, -self.torsion],
                [self.curvature, self.torsion, 0.0],
            ]
        )
        t = math.hypot(self.torsion, self.curvature) * s
        first = W * s[:, None, None]
        second = first @ first
        sine, half = np.sinc(t / np.pi)[:, None, None], np.sinc(t / (2 * np.pi))[:, None, None]
        frame = np.eye(3) + sine * first + half**2 / 2 * second
        mean = np.eye(3) + half**2 / 2 * first + _cubic(t)[:, None, None] * second
        return s[:, None] * mean[:, :, 0], frame

    def backward(self) -> UniformPiece:
        """Return what it is from its other end."""
        return self


class CatenaryPiece(NamedTuple):
    """What hangs under its own weight, from an arc length behind its lowest point on."""

    length: float  # [m]
    parameter: float  # horizontal tension over weight per length, H/w [m]
    begin: float  # [m]

    def rates(self, s: Real) -> Real:
        """Return (tau, kz, ky) at arc lengths, shape (s, 3) [rad/m]."""
        kz = self.parameter / (self.parameter**2 + (self.begin + s) ** 2)
        return np.stack([0 * s, kz, 0 * s], axis=1)

    def bending(self, s: Real) -> Real:
        """Return how curvature changes along it [rad/m^2]."""
        along: Real = self.begin + s
        return -2 * self.parameter * along / (self.parameter**2 + along**2) ** 2

    def turned(self, s: Any) -> Any:
        """Return the angle that the tangent turns by up to arc lengths [rad]."""
        c = self.parameter
        return np.arctan2(self.begin + s, c) - np.arctan2(self.begin, c)

    def pull(self, s: Any) -> Any:
        """Return the tension over weight per length there [m]."""
        return np.hypot(self.parameter, self.begin + np.asarray(s))

    @property
    def mean_pull(self) -> float:
        """Its mean along the piece [m]."""
        c = self.parameter
        whole = [u * math.hypot(c, u) + c**2 * math.asinh(u / c) for u in (self.begin, self.end)]
        return (whole[1] - whole[0]) / (2 * self.length)

    @property
    def end(self) -> float:
        """How far behind its lowest point it ends [m]."""
        return self.begin + self.length

    def travel(self, s: Real) -> tuple[Real, Real]:
        """Return positions and frames there in the frame of the start, (s, 3) and (s, 3, 3)."""
        at = np.concatenate([[0.0], s])
        place = np.stack([self.over(at), 0 * at, np.hypot(self.parameter, self.begin + at)], axis=1)
        slope = np.arctan2(self.begin + at, self.parameter)
        frame = np.zeros((len(at), 3, 3))
        frame[:, 1, 1] = 1.0
        frame[:, 0, 0] = frame[:, 2, 2] = np.cos(slope)
        frame[:, 2, 0] = np.sin(slope)
        frame[:, 0, 2] = -frame[:, 2, 0]
        return (place[1:] - place[0]) @ frame[0], frame[0].T @ frame[1:]

    def over(self, s: Real) -> Real:
        """Return how far arc lengths lie from the lowest point in the level [m]."""
        level: Real = self.parameter * np.arcsinh((self.begin + s) / self.parameter)
        return level

    def backward(self) -> CatenaryPiece:
        """Return what it is from its other end."""
        return self._replace(begin=-self.begin - self.length)


Piece = UniformPiece | CatenaryPiece


def _cubic(t: Real) -> Real:
    """Return (t - sin t)/t^3, by its series where that cancels."""
    small = np.minimum(t, 1.0) ** 2
    terms = range(1, 11)
    series = sum((-1) ** (k + 1) * small ** (k - 1) / math.factorial(2 * k + 1) for k in terms)
    large = np.maximum(t, 1.0)
    return np.where(t < 1, series, (large - np.sin(large)) / large**3)
