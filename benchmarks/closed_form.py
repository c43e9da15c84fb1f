"""A uniform clamped rope in closed form, as it is written by hand in NumPy and SciPy.

B (1 + i omega gamma) w'''' - T w'' - mu omega^2 w = 0 has waves exp(-i k x) and exp(-a x).
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq


class Part(NamedTuple):
    """A mass [kg] and a spring [N/m] at a place [m]."""

    x: float
    mass: float = 0.0
    stiffness: float = 0.0


class Waves(NamedTuple):
    """Of one frequency each: i k, a, and what a unit force sends either way of both."""

    omega: np.ndarray
    section: np.ndarray
    ik: np.ndarray
    a: np.ndarray
    q1: np.ndarray
    q2: np.ndarray


@dataclass(frozen=True)
class Span:
    """Length [m], linear density [kg/m], bending stiffness [N m^2], tension [N], gamma [s]."""

    length: float
    density: float
    bending: float
    tension: float
    gamma: float = 0.0

    def receptance(self, x: float, frequency: np.ndarray, parts: Sequence[Part] = ()) -> np.ndarray:
        """Return z at x per force there [m/N], for parts elsewhere, by reflections of waves.

        The force sends q either way, R_l and R_r send it back: s goes to the right,
        (I - R_l R_r) s = (I + R_l) q, and z = (1, 1) (I + R_r) s. No exponential grows, so that
        none overflows.
        """
        waves = self._waves(2 * np.pi * frequency)
        left = [(p.x, p) for p in parts if p.x < x]
        right = [(self.length - p.x, p) for p in parts if p.x > x]
        l11, l12, l21, l22 = L = self._reflection(waves, sorted(left), x)
        r11, r12, r21, r22 = R = self._reflection(waves, sorted(right), self.length - x)
        m11, m12 = 1 - l11 * r11 - l12 * r21, l11 * r12 + l12 * r22
        m21, m22 = l21 * r11 + l22 * r21, 1 - l21 * r12 - l22 * r22
        (s1, s2), _ = _sent(L, waves)
        _, (t1, t2) = _sent(R, waves)
        return (t1 * (m22 * s1 + m12 * s2) + t2 * (m21 * s1 + m11 * s2)) / (m11 * m22 - m12 * m21)

    def _waves(self, omega: np.ndarray) -> Waves:
        section = 1 + 1j * self.gamma * omega
        bending = self.bending * section
        half = self.tension / (2 * bending)
        inertia = omega * omega * (self.density / bending)
        square = half + np.sqrt(half * half + inertia)
        a, ik = np.sqrt(square), 1j * np.sqrt(inertia / square)
        each = 0.5 / (bending * (square - ik * ik))
        return Waves(omega, section, ik, a, each / ik, -each / a)

    def _reflection(
        self, waves: Waves, parts: list[tuple[float, Part]], length: float
    ) -> tuple[np.ndarray, ...]:
        """Return R of what lies behind, to a clamp that is so far away.

        A clamp reflects [[-c, -1 - c], [c - 1, c]], c = (a + ik)/(a - ik); over a length R becomes
        P R P, P = diag(e^{-ikl}, e^{-al}); a force -N z at a part adds to it
        -N (I + R) q (1, 1) (I + R)/(1 + N (1, 1) (I + R) q).
        """
        clamp = (waves.a + waves.ik) / (waves.a - waves.ik)
        R = (-clamp, -1 - clamp, clamp - 1, clamp)
        here = 0.0
        for place, part in parts:
            R = _carried(R, waves, place - here)
            (s1, s2), (t1, t2) = _sent(R, waves)
            N = part.stiffness * waves.section - part.mass * (waves.omega * waves.omega)
            N = N / (1 + N * (s1 + s2))
            s1, s2 = N * s1, N * s2
            R = (R[0] - s1 * t1, R[1] - s1 * t2, R[2] - s2 * t1, R[3] - s2 * t2)
            here = place
        return _carried(R, waves, length - here)

    def brentq(self, number: int) -> np.ndarray:
        """Return the lowest undamped frequencies [Hz], each the one zero between k L = j pi and on.

        2 k a (cosh aL cos kL - 1) = (a^2 - k^2) sinh aL sin kL, parted into odd and even shapes and
        scaled to kL/2 = j pi/2 + atan(k/a coth(aL/2)), for even j tanh; a^2 = k^2 + T/B.
        """
        ratio, half = self.tension / self.bending, self.length / 2

        def odd(k: float, start: float) -> float:
            a = math.sqrt(k * k + ratio)
            return k * half - start - math.atan(k / (a * math.tanh(a * half)))

        def even(k: float, start: float) -> float:
            a = math.sqrt(k * k + ratio)
            return k * half - start - math.atan(k / a * math.tanh(a * half))

        step, last = math.pi / self.length, 4 * np.finfo(float).eps
        found = [
            brentq(odd if j % 2 else even, j * step, (j + 1) * step, (j * math.pi / 2,), rtol=last)
            for j in range(1, number + 1)
        ]
        return self._frequency(np.array(found))

    def newton(self, number: int) -> np.ndarray:
        """Return the same as `brentq` by five Newton steps, all frequencies at once."""
        ratio, half = self.tension / self.bending, self.length / 2
        j = np.arange(1, number + 1)
        way = np.where(j % 2, -1.0, 1.0)
        k = j * (math.pi / self.length)
        for _ in range(5):
            a = np.sqrt(k * k + ratio)
            y = k / a * np.tanh(a * half) ** way
            # coth and tanh change slowly: left out of the slope
            slope = half - ratio / (a * a * a * (1 + y * y))
            k = k - (k * half - j * (math.pi / 2) - np.arctan(y)) / slope
        return self._frequency(k)

    def _frequency(self, k: np.ndarray) -> np.ndarray:
        square = (self.tension + self.bending * k * k) / self.density
        return k * np.sqrt(square) / (2 * np.pi)


def _carried(R: tuple[np.ndarray, ...], waves: Waves, length: float) -> tuple[np.ndarray, ...]:
    wave, near = np.exp(-length * waves.ik), np.exp(-length * waves.a)
    both = wave * near
    return R[0] * (wave * wave), R[1] * both, R[2] * both, R[3] * (near * near)


def _sent(R: tuple[np.ndarray, ...], waves: Waves) -> tuple[tuple[np.ndarray, np.ndarray], ...]:
    """Return (I + R) q and (1, 1) (I + R)."""
    q1, q2 = waves.q1, waves.q2
    column = q1 + R[0] * q1 + R[1] * q2, q2 + R[2] * q1 + R[3] * q2
    return column, (1 + R[0] + R[2], 1 + R[1] + R[3])
