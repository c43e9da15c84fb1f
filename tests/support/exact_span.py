"""The exact harmonic motion of a rope of continuous spans, in many digits.

With u the motion of a section, and f the force of the rope on its right on the rope on its left,
(u, f)' = E (u, f) along a span,

    E = [[Phi, S'], [q, -Phi^T]],   Phi_z,beta = 1,   q = diag(-lambda mu, -lambda mu, -lambda p,
                                                                T - lambda j),  lambda = omega^2

over (x, z, alpha, beta); S' is the section's flexibility, zero in z. Row by row: z' = beta, the
section bends by beta' = S_bb M + ..., what moves needs F_z' = -lambda mu z, and the moments on a
slice, T beta - F_z - M' = lambda j beta, include the tension's. Without bending T z' = F_z instead:
S'_zz = 1/T and no Phi_z,beta. Gravity adds Phi_x,z = w/T, w the weight per length, and takes the
inertia along x. Damping puts its factors on S, T, springs and -lambda, and drag joins -lambda mu.

S', mu, p and j may differ from span to span.

At a node f grows by N u, N of springs and inertia, then beta by the compliance of a hinge times M.
A held coordinate, or a free hinge, asks for zero and lets the conjugate be anything.
"""

import dataclasses
import itertools

import mpmath
from exact_motions import Motions
from exact_scene import (
    CHANNEL,
    drag,
    factors,
    inertia_of,
    parts_at,
    places,
    rope_at,
    sag,
    section_of,
    standing,
)
from mpmath import mpf
from stored import stored

import ropedyn as rd

FORCE = {"F_x": "x", "F_z": "z", "M_alpha": "alpha", "M_beta": "beta"}
REACH = 40
"""Wavenumber times length of a piece: motions grow apart by exp(40) there, 17 digits."""
GUARD = 50
"""Digits beyond the present ones: what pieces, and scales far apart, take away."""


def coupled(scene, coordinate):
    """The coordinates that move together with this one."""
    rope, groups = scene.rope, [{"x"}, {"z", "beta"}, {"alpha"}]
    if rope.lay_coupling:
        groups = [{"x", "alpha"}, {"z", "beta"}]
    if rope.lay_slope:
        groups = (
            [{"x", "z", "alpha", "beta"}] if rope.lay_coupling else [{"x"}, {"z", "alpha", "beta"}]
        )
    if scene.gravity is not None:
        hangs = [g for g in groups if g & {"x", "z"}]
        groups = [set().union(*hangs), *(g for g in groups if g not in hangs)]
    group = next(g for g in groups if coordinate in g)
    return tuple(c for c in scene.coordinates if c in group)


class Law:
    """y' = E y of a scene at one frequency, at a place, and its solutions over pieces."""

    def __init__(self, scene, coordinates, of_section, tension, of_inertia, dashpot=0, at=0.0):
        rope, c = rope_at(scene, at), coordinates
        w = len(c)
        S = [[s / of_section for s in row] for row in section_of(scene, rope)]
        T = mpf(scene.tension) * tension
        q = {k: m * of_inertia for k, m in inertia_of(scene, rope).items()}
        for k, along in drag(scene).items():
            q[k] = q[k] + along * dashpot if along else q[k]
        self.E = mpmath.zeros(2 * w)
        for i, a in enumerate(c):
            self.E[w + i, i] = q[a]
            for j, b in enumerate(c):
                if "z" not in (a, b):
                    self.E[i, w + j] = S[CHANNEL[a]][CHANNEL[b]]
        if "beta" in c:
            z, beta = c.index("z"), c.index("beta")
            self.E[z, beta], self.E[w + beta, w + z] = mpf(1), mpf(-1)
            self.E[w + beta, beta] += T
        elif "z" in c:
            z = c.index("z")
            self.E[z, w + z] = 1 / T
        if "x" in c and "z" in c:
            x, z = c.index("x"), c.index("z")
            self.E[x, z] = sag(scene, rope)[0]
            self.E[w + z, w + x] = -self.E[x, z]
        self._measure(scene, c, S, T, q)
        self._pieces = {}

    def _measure(self, scene, c, S, T, q):
        """Set units of u and f, each pair of one work, and the largest wavenumber."""
        least, bb = 1 / mpf(scene.rope.length), abs(S[2][2])
        wave, unit = {}, {}
        for a in c:
            soft = abs(S[CHANNEL[a]][CHANNEL[a]]) if a != "z" else 1 / abs(T) if T else mpf(0)
            wave[a] = max(least, mpmath.sqrt(abs(q[a]) * soft))
        work = mpf(1)
        if "beta" in c:
            bend = max(least, mpmath.sqrt(abs(T) * bb), mpmath.root(abs(q["z"]) * bb, 4))
            wave["z"] = wave["beta"] = bend = max(bend, mpmath.sqrt(abs(q["beta"]) * bb))
            work = bend**3 / bb
            unit = {"z": mpf(1), "beta": bend}
        elif "z" in c:
            unit["z"] = 1 / mpmath.sqrt(abs(T) * wave["z"])
        for a in c:
            if a in ("x", "alpha"):
                unit[a] = mpmath.sqrt(work * abs(S[CHANNEL[a]][CHANNEL[a]]) / wave[a])
        self.units = [unit[a] for a in c] + [work / unit[a] for a in c]
        self.wavenumber = max(wave.values())

    def across(self, length):
        """Transition over a piece of the span, and how many pieces it has."""
        count = max(1, int(mpmath.ceil(length * self.wavenumber / REACH)))
        piece = length / count
        if piece not in self._pieces:
            n, u = len(self.units), self.units
            scaled = self.E.copy()
            for i, j in itertools.product(range(n), repeat=2):
                scaled[i, j] *= piece * u[j] / u[i]
            e = mpmath.expm(scaled)
            self._pieces[piece] = [[e[i, j] * u[i] / u[j] for j in range(n)] for i in range(n)]
        return self._pieces[piece], count


def backward(transition):
    """Inverse of a symplectic transition: [[D^T, -B^T], [-C^T, A^T]] of [[A, B], [C, D]]."""
    w = len(transition) // 2
    return [
        [
            (1 if (i < w) == (j < w) else -1) * transition[(j + w) % (2 * w)][(i + w) % (2 * w)]
            for j in range(2 * w)
        ]
        for i in range(2 * w)
    ]


@dataclasses.dataclass
class Continuum:
    """A scene with continuous spans, from its numbers alone."""

    scene: rd.Scene
    coordinates: tuple[str, ...]
    nudge: tuple[mpf, ...] = (mpf(1),) * 5
    """Times section, tension, springs, inertia, dashpots: what the condition of an answer asks."""

    @stored
    def receptance(self, omega, drive, responses):
        """Motion, or internal force, at points (name, x) per unit force at (coordinate, x)."""
        with mpmath.extradps(GUARD):
            strength = [p * q for p, q in zip(factors(self.scene, omega), self.nudge)]
            return Walk(self, strength, [drive, *responses]).response(drive, responses)

    def determinant(self, eigenvalue):
        """An entire function of omega^2 [rad^2/s^2], zero at the undamped natural frequencies."""
        with mpmath.extradps(GUARD):
            strength = [p * q for p, q in zip((1, 1, 1, -eigenvalue, 0), self.nudge)]
            walk, w = Walk(self, strength, []), len(self.coordinates)
            last = len(walk.x) - 1
            motions = walk.rightward(last)
            walk.pass_node(motions, last)
            # no force beyond the last node
            return motions.volume * mpmath.det(mpmath.matrix(motions.rows[w:]))


class Walk:
    """The walks from both ends of a continuum at one frequency, and where they meet."""

    def __init__(self, continuum, strength, points):
        scene, c = continuum.scene, continuum.coordinates
        of_section, tension, self.spring, *others = strength
        self.of_node = (self.spring, *others)
        self.coordinates, self.points = c, {(name, mpf(x)) for name, x in points}
        self.x = sorted(
            {mpf(0), mpf(scene.rope.length), *map(mpf, places(scene))}.union(
                x for _, x in self.points
            )
        )
        # spans of the same rope share one law, and with it their pieces
        laws = {}
        self.laws = []
        for a, b in itertools.pairwise(self.x):
            rope = str(vars(rope_at(scene, (a + b) / 2)))
            if rope not in laws:
                laws[rope] = Law(scene, c, of_section, tension, *others, at=(a + b) / 2)
            self.laws.append(laws[rope])
        ends = {0: scene.ends[0], len(self.x) - 1: scene.ends[1]}
        self.here = [standing(c, parts_at(scene, x), ends.get(i)) for i, x in enumerate(self.x)]

    def response(self, drive, responses):
        """Values at points where a unit force acts at the drive."""
        k, at = self.coordinates.index(drive[0]), self.x.index(mpf(drive[1]))
        if drive[0] in self.here[at].held:
            return [mpf(0)] * len(responses)
        left, right = self.rightward(at), self.leftward(at)
        load = mpmath.zeros(2 * len(self.coordinates), 1)
        load[len(self.coordinates) + k] = mpf(-1)
        share = mpmath.lu_solve(mpmath.matrix(self._meeting(left, right, at)), load)
        value = {}
        for motions, first in ((left, 0), (right, len(self.coordinates))):
            for point, row in motions.watched.items():
                value[point] = sum(x * share[first + j] for j, x in enumerate(row))
        return [value[name, mpf(x)] for name, x in responses]

    def _meeting(self, left, right, at):
        """Rows over the shares of left and right motions: u is equal, f grows by N u less the load.

        Where a coordinate is held, u is zero on both sides.
        """
        w, none = len(self.coordinates), [mpf(0)] * len(self.coordinates)
        motion, force = [], []
        for k, name in enumerate(self.coordinates):
            u, v = left.rows[k], right.rows[k]
            if name in self.here[at].held:
                motion.append(u + none)
                force.append(none + v)
            else:
                N = self._resistance(at, name)
                motion.append(u + [-x for x in v])
                force.append([-f - N * x for f, x in zip(left.rows[w + k], u)] + right.rows[w + k])
        return motion + force

    def rightward(self, stop):
        """Motions admitted by all on the left of a node."""
        motions = Motions(self.laws[0].units)
        for i in range(stop):
            self._watch(motions, i, left=True)
            self.pass_node(motions, i)
            self._watch(motions, i, left=False)
            self._pass_hinge(motions, i)
            transition, count = self.laws[i].across(self.x[i + 1] - self.x[i])
            for _ in range(count):
                motions.cross(transition)
        self._watch(motions, stop, left=True)
        return motions

    def leftward(self, stop):
        """Motions admitted by all on the right of a node, and of a hinge there."""
        motions = Motions(self.laws[0].units)
        for i in range(len(self.x) - 1, stop, -1):
            self.pass_node(motions, i, -1)
            self._watch(motions, i, left=True)
            transition, count = self.laws[i - 1].across(self.x[i] - self.x[i - 1])
            for _ in range(count):
                motions.cross(backward(transition))
            self._pass_hinge(motions, i - 1, -1)
        self._watch(motions, stop, left=False)
        return motions

    def pass_node(self, motions, i, sign=1):
        """To the right, or to the left with sign -1."""
        w = len(self.coordinates)
        for k, name in enumerate(self.coordinates):
            if name in self.here[i].held:
                motions.replace(k, w + k)
            else:
                motions.add(w + k, sign * self._resistance(i, name), k)

    def _pass_hinge(self, motions, i, sign=1):
        compliance = self.here[i].hinge
        if compliance is None:
            return
        beta = self.coordinates.index("beta")
        moment = len(self.coordinates) + beta
        if mpmath.isinf(compliance):
            motions.replace(moment, beta)
        else:
            motions.add(beta, sign * compliance / self.spring, moment)

    def _resistance(self, i, name):
        return self.here[i].resistance(name, *self.of_node)

    def _watch(self, motions, i, *, left):
        """Remember what is asked for: u, and f left of a node, of the first one right of it."""
        w = len(self.coordinates)
        for name, x in self.points:
            if x != self.x[i]:
                continue
            if name not in FORCE and left:
                motions.watch((name, x), self.coordinates.index(name))
            elif name in FORCE and left == (i > 0):
                motions.watch((name, x), w + self.coordinates.index(FORCE[name]))
