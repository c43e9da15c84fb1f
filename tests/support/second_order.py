"""Second order of a rope that its slopes stretch, by assembled matrices with quadratic terms.

Hermite beams across, linear bars along and about the axis: strains E = (x' + z'^2/2, alpha', beta')
of the energy 1/2 E^T K E + 1/2 T z'^2. To first order u = Re(U e^(i omega t)); what is of second
order at 2 omega solves the same matrices under minus the gradient of the cubic energy, 1/2 N z'^2.
"""

from typing import NamedTuple

import numpy as np

GAUSS, WEIGHT = np.polynomial.legendre.leggauss(4)
GAUSS, WEIGHT = (GAUSS + 1) / 2, WEIGHT / 2
WIDTH = 4  # x, z, alpha, beta


class Rope(NamedTuple):
    """A rope with its section stiffness (axial, torsion, bending) and inertia per length."""

    length: float
    section: np.ndarray  # (3, 3)
    tension: float
    inertia: tuple  # of x, z, alpha, beta
    gamma: float  # stiffness damping
    drag: float  # of x and z
    held: tuple  # coordinates held at each end, by number
    masses: tuple = ()  # (x, mass) of point masses


def shapes(h, t):
    """Return z, z' and z'' by z_a, beta_a, z_b, beta_b at a share t of an element."""
    value = [1 - 3 * t**2 + 2 * t**3, h * (t - 2 * t**2 + t**3)]
    value += [3 * t**2 - 2 * t**3, h * (t**3 - t**2)]
    slope = [6 * (t**2 - t) / h, 1 - 4 * t + 3 * t**2, 6 * (t - t**2) / h, 3 * t**2 - 2 * t]
    bend = [(12 * t - 6) / h**2, (6 * t - 4) / h, (6 - 12 * t) / h**2, (6 * t - 2) / h]
    return value, slope, bend


def rows(h, t):
    """Return strains (3, 8), z' (8,) and motion (4, 8) by the motion of both nodes."""
    value, slope, bend = shapes(h, t)
    strain, z, motion = np.zeros((3, 8)), np.zeros(8), np.zeros((4, 8))
    across = [1, 3, 5, 7]
    strain[0, [0, 4]] = strain[1, [2, 6]] = -1 / h, 1 / h
    strain[2, across] = bend
    z[across] = slope
    motion[0, [0, 4]] = motion[2, [2, 6]] = 1 - t, t
    motion[1, across] = value
    motion[3, across] = slope
    return strain, z, motion


class Second:
    """A rope of n equal elements."""

    def __init__(self, rope, n):
        self.rope, self.n, self.h = rope, n, rope.length / n
        size = WIDTH * (n + 1)
        self.K, self.G, self.M, self.C = (np.zeros((size, size)) for _ in range(4))
        elastic, string, mass, drag = (np.zeros((8, 8)) for _ in range(4))
        for t, w in zip(GAUSS, WEIGHT * self.h):
            strain, slope, motion = rows(self.h, t)
            elastic += w * strain.T @ rope.section @ strain
            string += w * rope.tension * np.outer(slope, slope)
            mass += w * motion.T @ np.diag(rope.inertia) @ motion
            drag += w * rope.drag * motion[:2].T @ motion[:2]
        for e in range(n):
            at = slice(WIDTH * e, WIDTH * e + 8)
            for whole, part in zip((self.K, self.G, self.M, self.C), (elastic, string, mass, drag)):
                whole[at, at] += part
        for x, m in rope.masses:
            for k in (0, 1):
                at = self.number(k, x)
                self.M[at, at] += m
        held = list(rope.held[0]) + [WIDTH * n + k for k in rope.held[1]]
        self.free = np.setdiff1d(np.arange(size), held)

    def number(self, coordinate, x):
        return WIDTH * round(x / self.h) + coordinate

    def dynamic(self, s):
        return self.K * (1 + self.rope.gamma * s) + self.G + s * self.C + s**2 * self.M

    def solve(self, s, load):
        motion = np.zeros(len(load), dtype=complex)
        inside = np.ix_(self.free, self.free)
        motion[self.free] = np.linalg.solve(self.dynamic(s)[inside], load[self.free])
        return motion

    def load(self, s, first):
        """Return minus the gradient of the cubic energy at twice the frequency."""
        load = np.zeros(len(first), dtype=complex)
        K = self.rope.section
        for e in range(self.n):
            at = slice(WIDTH * e, WIDTH * e + 8)
            for t, w in zip(GAUSS, WEIGHT * self.h):
                strain, slope, _ = rows(self.h, t)
                z, tension = (
                    slope @ first[at],
                    (1 + self.rope.gamma * s) * K[0] @ strain @ first[at],
                )
                stress = (1 + 2 * self.rope.gamma * s) * K[0] @ strain
                load[at] -= w * (stress * z**2 / 4 + tension * slope * z / 2)
        return load

    def twice(self, frequency, drive, load=1.0):
        """Return the motion at twice the frequency, and tension and torque on the left end."""
        s = 2j * np.pi * frequency
        push = np.zeros(len(self.K), dtype=complex)
        push[self.number(*drive)] = load
        first = self.solve(s, push)
        second = self.load(s, first)
        motion = self.solve(2 * s, second)
        reaction = self.dynamic(2 * s) @ motion - second
        return motion, -reaction[[0, 2]]
