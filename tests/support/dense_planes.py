"""Frequencies of a rope in both planes by Ritz's method on polynomials, with dense matrices.

Nothing of the core: tension along the rope, torque and what stands on it are read from the scene.
"""

import itertools
import math

import numpy as np
import scipy.linalg

import ropedyn as rd

DEGREE = 8
TURNING = {"z": "beta", "y": "gamma"}
WIDER = 3.0
"""So many times as long as the one before is an element away from a boundary layer."""
NODE, WEIGHT = np.polynomial.legendre.leggauss(DEGREE + 1)


def of(value, plane):
    """The number of a plane."""
    return value[plane == "y"] if isinstance(value, tuple) else value


def _edges_of(part):
    return (part.start, part.stop) if hasattr(part, "start") else ()


class Line:
    """Elements of a rope, with their properties at its points of integration.

    They are as short as layers of bending in these planes: shorter ones would cost digits.
    """

    def __init__(self, scene, planes="zy"):
        rope = self.rope = scene.rope
        self.scene, self.bends = scene, rope.bending_stiffness is not None
        self.planes = planes
        parts = scene.parts
        stand = [part.x for part in parts if hasattr(part, "x")]
        edges = [
            edge for part in parts if hasattr(part, "start") for edge in (part.start, part.stop)
        ]
        self.station = np.unique([0.0, rope.length, *stand, *edges])
        self._cut(self.station)
        tension = self.tension()
        self._cut(self._edges(np.abs(tension).max(), tension.min()))

    def _cut(self, edge):
        self.edge = edge
        left, length = edge[:-1, None], np.diff(edge)[:, None]
        self.length, self.x = length, left + length * (1 + NODE) / 2
        self.dx = length * WEIGHT / 2
        self.density = self.section("linear_density", "z")
        for part in self.scene.parts:
            if isinstance(part, rd.AddedMass):
                self.density += self._within(part) * part.linear_density

    def _edges(self, most, least_tension):
        """Stations, and between them places that lie closer where bending ends in a layer."""
        layer = self.rope.length / 8
        if self.bends:
            least = min(of(self.rope.bending_stiffness, plane) for plane in self.planes)
            least *= min([1.0, *(min(p.bending) for p in self._changes())])
            layer = min(layer, 2 * math.sqrt(least / max(most, 1e-300)))
            if self.scene.torque:
                layer = min(layer, 2 * least / abs(self.scene.torque))
        elif least_tension > 0:  # waves are short where a string is nearly slack
            layer = min(layer, self.rope.length * least_tension / most)
        longest = 2 * layer if self.scene.torque or least_tension < 0 else math.inf
        edge = []
        for a, b in itertools.pairwise(self.station):
            half = [0.0]
            step = min(layer, (b - a) / 4)
            while half[-1] + step < (b - a) / 2 * (1 - 1e-9):
                half.append(half[-1] + step)
                step = min(WIDER * step, (b - a) / 4, longest)
            steps = np.array(half)
            edge += [*(a + steps), (a + b) / 2, *(b - steps[:0:-1])]
        return np.array([*edge, self.station[-1]])

    def _changes(self):
        return [part for part in self.scene.parts if isinstance(part, rd.LocalChange)]

    def _within(self, part):
        return (self.x > part.start) & (self.x < part.stop)

    def section(self, name, plane):
        """A property of the rope of each point, changed over stretches."""
        value = of(getattr(self.rope, name), plane)
        found = np.full_like(self.x, 0.0 if value is None else value)
        for part in self._changes():
            factor = of(part.bending, plane) if name == "bending_stiffness" else part.density
            found *= 1 + self._within(part) * (factor - 1)
        return found

    def tension(self):
        """At points: what is said at its place, and the weight below and above it."""
        gravity, tension = self.scene.gravity, self.scene.tension
        mean = tension.mean if isinstance(tension, rd.Tension) else tension
        if gravity is None:
            return np.full_like(self.x, mean)
        place = tension.at if isinstance(tension, rd.Tension) else "middle"
        along = gravity.g * math.sin(gravity.inclination)
        where = {"start": 0.0, "middle": self.rope.length / 2, "end": self.rope.length}
        at = where.get(place, place)
        own = np.append(0.0, np.cumsum((self.density * self.dx).sum(axis=1)))

        def weight(x):
            k = min(np.searchsorted(self.edge, x, side="right") - 1, len(self.x) - 1)
            below = own[k] + self.density[k, 0] * (x - self.edge[k])
            hung = [p.mass for p in self.scene.parts if hasattr(p, "mass") and p.x < x]
            return along * (below + sum(hung))

        return mean + np.vectorize(weight)(self.x) - weight(at)


def values(degree, length, at=None):
    """Legendre polynomials and two derivatives, shape (3, elements, points, degree + 1)."""
    at = NODE if at is None else np.asarray(at, dtype=float)
    rows = []
    for order in range(3):
        unit = np.eye(degree + 1)
        series = [np.polynomial.legendre.legder(one, order) if order else one for one in unit]
        own = np.stack(
            [np.polynomial.legendre.legval(at, c) * np.ones_like(at) for c in series], -1
        )
        rows.append(own[None] * (2 / length)[:, :, None] ** order)
    return np.stack(rows)


def frequencies(scene, number):
    """The lowest frequencies [Hz] of a scene without sag, and what rounding leaves of each."""
    if not scene.torque:
        apart = [_plane(Line(scene, plane), plane) for plane in "zy"]
        found = [_solved(K, M, number) for K, M, _ in apart]
        frequency, error = np.concatenate(found, axis=1)
        order = np.argsort(frequency)[:number]
        return frequency[order], error[order]
    line = Line(scene)
    z, y = (_plane(line, plane) for plane in "zy")
    across = y[2].T @ _torque(line) @ z[2]
    K = np.block([[z[0], across.T], [across, y[0]]])
    return _solved(K, scipy.linalg.block_diag(z[1], y[1]), number)


def _solved(K, M, number):
    """Frequencies that a dense solver finds, growing motion as 0 Hz."""
    most = min(number, len(K)) - 1
    found = scipy.linalg.eigh(K, M, eigvals_only=True, subset_by_index=(0, most))
    largest = scipy.linalg.eigh(K, M, eigvals_only=True, subset_by_index=(len(K) - 1,) * 2)[0]
    frequency = np.sqrt(np.maximum(found, 0.0)) / (2 * math.pi)
    rounding = 10 * len(K) * np.finfo(float).eps * largest
    return frequency, np.sqrt(np.maximum(found, 0.0) + rounding) / (2 * math.pi) - frequency


def _torque(line):
    """Of twice the energy M int y' z'' - z' y'' dx, with y on the left and z on the right."""
    shape, many, count = values(DEGREE, line.length), len(line.x), DEGREE + 1
    own = np.einsum("eqi,eqj,eq->eij", shape[1], shape[2], line.dx)
    cross = np.zeros((many, count, many, count))
    cross[np.arange(many), :, np.arange(many)] = own - own.transpose(0, 2, 1)
    return line.scene.torque / 2 * cross.reshape(many * count, -1)


def _plane(line, plane):
    """Stiffness and mass of a plane, and the motions that its joints allow."""
    shape = values(DEGREE, line.length)
    many, count = len(line.x), DEGREE + 1
    K, M = np.zeros((2, many, count, many, count))
    each = np.arange(many)
    for order, weight in ((2, line.section("bending_stiffness", plane)), (1, line.tension())):
        K[each, :, each] += _products(shape[order], weight * line.dx)
    inertia = line.section("rotary_inertia", plane)
    for order, weight in ((0, line.density), (1, inertia)):
        M[each, :, each] += _products(shape[order], weight * line.dx)
    K, M = K.reshape(many * count, -1), M.reshape(many * count, -1)
    return _standing(line, plane, K, M)


def _products(shape, weight):
    return np.einsum("eqi,eqj,eq->eij", shape, shape, weight)


def _rows(line):
    """Values and slopes at both ends of elements, shape (2 orders, 2 sides, elements, unknowns)."""
    shape = values(DEGREE, line.length, [-1.0, 1.0])[:2]
    many, count = len(line.x), DEGREE + 1
    rows = np.zeros((2, 2, many, many, count))
    each = np.arange(many)
    rows[:, :, each, each] = shape.transpose(0, 2, 1, 3)
    return rows.reshape(2, 2, many, -1)


def _standing(line, plane, K, M):
    """Add what stands on the rope, and leave what its joints allow."""
    rows, scene, turning = _rows(line), line.scene, TURNING[plane]
    hinges = {p.x: p.stiffness for p in scene.parts if _is_of(p, rd.Hinge, plane)}
    ties = [rows[0, 1, :-1] - rows[0, 0, 1:]]
    if line.bends:
        whole = ~np.isin(line.edge[1:-1], list(hinges))
        ties.append((rows[1, 1, :-1] - rows[1, 0, 1:])[whole])

    def at(x, order):
        k = int(np.searchsorted(line.edge, x - 1e-12))
        return rows[order, 0, k] if k < len(line.x) else rows[order, 1, -1]

    masses = []
    for part in scene.parts:
        if isinstance(part, rd.PointMass):
            across, turned = at(part.x, 0), at(part.x, 1)
            M = M + part.mass * np.outer(across, across)
            if line.bends:
                M += of(part.rotary_inertia, plane) * np.outer(turned, turned)
        elif isinstance(part, (rd.Spring, rd.Support)) and part.coordinate in (plane, turning):
            row = at(part.x, int(part.coordinate == turning))
            if isinstance(part, rd.Support):
                ties.append(row[None])
            else:
                K = K + part.stiffness * np.outer(row, row)
        elif _is_of(part, rd.Hinge, plane):
            k = int(np.searchsorted(line.edge, part.x - 1e-12))
            jump = rows[1, 1, k - 1] - rows[1, 0, k]
            K = K + part.stiffness * np.outer(jump, jump)
        elif _is_of(part, rd.Resonator, plane):
            masses.append(
                (part.mass, part.mass * (2 * math.pi * part.frequency) ** 2, at(part.x, 0))
            )
    for side, given in enumerate(scene.ends):
        end = rd.End() if given == "clamped" else given
        for order, c in enumerate((plane, turning) if line.bends else (plane,)):
            row = rows[order, side, -side]
            if end.holds(c):
                ties.append(row[None])
            else:
                K = K + end.spring.get(c, 0.0) * np.outer(row, row)
    ties = np.concatenate(ties)
    free = scipy.linalg.null_space(ties / np.linalg.norm(ties, axis=1, keepdims=True))
    K, M = free.T @ K @ free, free.T @ M @ free
    for mass, stiffness, foot in masses:
        lever = np.append(foot @ free, np.zeros(len(K) - free.shape[1]))
        K = np.block(
            [
                [K + stiffness * np.outer(lever, lever), -stiffness * lever[:, None]],
                [-stiffness * lever[None], np.array([[stiffness]])],
            ]
        )
        M = scipy.linalg.block_diag(M, mass)
    return K, M, free


def _is_of(part, kind, plane):
    return isinstance(part, kind) and getattr(part, "plane", plane) in (plane, "both", None)
