"""Shapes and energies of modes of a rope of continuous spans, from the exact reference.

Next to a simple eigenvalue, 1e-30 of it away, any response is the mode's shape to 30 digits, unless
the force stands where the mode does not move.
"""

import dataclasses
import functools
import itertools

import mpmath
import numpy as np
from exact_scene import CHANNEL, inertia_of, parts_at, places, rope_at, section_of, standing
from exact_span import FORCE, Continuum, Law, backward
from mpmath import mpf
from stored import stored

DIGITS = 90
NEAR = mpf(1) + mpf(10) ** -30
INTERVALS, COARSE = 256, 16
"""Equal ones on each span, and the first of Romberg's rule: (k h)^10 is left of k h = 0.1."""
STRAINS = ("bending", "twist", "stretch", "lay", "tension", "spring")


@dataclasses.dataclass
class Mode:
    """Motion and forces of an undamped mode of a `Continuum`."""

    exact: Continuum
    eigenvalue: mpf

    @functools.cached_property
    def stations(self):
        """Where spans meet [m]."""
        scene = self.exact.scene
        return sorted({0.0, scene.rope.length, *places(scene)})

    @functools.cached_property
    def middles(self):
        """Places inside the spans [m]."""
        return [(a + b) / 2 for a, b in itertools.pairwise(self.stations)]

    @functools.cached_property
    def along(self):
        """By coordinate and by force: arrays of shape (spans, INTERVALS + 1)."""
        scene, c = self.exact.scene, self.exact.coordinates
        force = {k: f for f, k in FORCE.items()}
        names = [*c, *(force[k] for k in c)]
        with mpmath.workdps(DIGITS):
            ends = self._right_ends(names, self.eigenvalue)
            laws = [Law(scene, c, 1, 1, -self.eigenvalue, at=at) for at in self.middles]
            lengths = [mpf(b) - mpf(a) for a, b in itertools.pairwise(self.stations)]
            spans = [_carried(*span) for span in zip(laws, lengths, ends)]
        return {
            name: np.array([[float(y[k]) for y in span] for span in spans])
            for k, name in enumerate(names)
        }

    def _right_ends(self, names, eigenvalue):
        """(u, f) at the right end of each span."""
        c, length = self.exact.coordinates, self.exact.scene.rope.length
        # imaginary where motion grows
        omega = mpmath.sqrt(eigenvalue * NEAR)
        drive = ("z" if "z" in c else c[-1], 0.3819 * length)
        points = list(itertools.product(self.stations[1:], names))
        undamped = dataclasses.replace(self.exact, scene=self.exact.scene.replace(damping=None))
        value = undamped.receptance(omega, drive, [drive, *((name, x) for x, name in points)])
        value = [mpmath.re(v / value[0]) for v in value[1:]]
        n = len(names)
        return [value[i : i + n] for i in range(0, len(value), n)]

    def shape(self, points):
        """Shape at so many equal intervals of each span, the largest of its own coordinate 1.

        Returns
        -------
        ndarray, shape (places, coordinates)
        """
        return np.array(self._shape(points))

    @stored
    def _shape(self, points):
        return self._drawn(points) / self._largest(points)

    @stored
    def modal_mass(self, points):
        """Of the shape at so many intervals [kg, kg m^2]."""
        _, kinetic = self._stored()
        return sum(kinetic.values()) / self._largest(points) ** 2

    @stored
    def energy(self):
        """Fractions of strain energy by what stores it, and of kinetic energy by coordinate."""
        return {k: v / sum(kind.values()) for kind in self._stored() for k, v in kind.items()}

    def _drawn(self, points):
        step = INTERVALS // points
        # where spans meet the motion is that left of a hinge, at the right end of a span
        return np.stack(
            [
                np.concatenate([self.along[k][0, :1], self.along[k][:, step::step].ravel()])
                for k in self.exact.coordinates
            ],
            axis=1,
        )

    def _largest(self, points):
        """Value of the largest motion in the coordinate with the most kinetic energy."""
        _, kinetic = self._stored()
        own = self._drawn(points)[
            :, max(range(len(kinetic)), key=list(kinetic.values()).__getitem__)
        ]
        return own[np.abs(own).argmax()]

    def _stored(self):
        """Twice the strain energy, and twice the kinetic energy over omega^2.

        Integrals over the spans: section flexibility on forces, tension T beta^2 or F_z^2/T
        without bending, inertia on motion; springs and masses at their places.
        """
        scene, c = self.exact.scene, self.exact.coordinates
        weight = np.outer(np.diff(self.stations), romberg())
        ropes = [rope_at(scene, x) for x in self.middles]
        strain, kinetic = _along(scene, ropes, c, self.along, weight)
        at = {k: np.append(self.along[k][:1, 0], self.along[k][:, -1]) for k in self.along}
        _add_parts(scene, c, self.stations, at, strain, kinetic)
        return strain, kinetic


def _carried(law, length, right):
    """(u, f) at INTERVALS + 1 places of a span, from its right end."""
    transition, count = law.across(length / INTERVALS)
    back, states = backward(transition), [right]
    for _ in range(INTERVALS):
        y = states[-1]
        for _ in range(count):
            y = [sum(a * b for a, b in zip(row, y)) for row in back]
        states.append(y)
    return states[::-1]


def romberg():
    """Weights of INTERVALS + 1 equal steps over the unit interval."""
    rows, step = [], 1
    while step <= INTERVALS // COARSE:
        weight = np.zeros(INTERVALS + 1)
        weight[::step] = step / INTERVALS
        weight[[0, -1]] /= 2
        rows.insert(0, weight)
        step *= 2
    # rows from the coarsest to the finest
    order = 4.0
    while len(rows) > 1:
        rows = [fine + (fine - coarse) / (order - 1) for coarse, fine in itertools.pairwise(rows)]
        order *= 4
    return rows[0]


def _along(scene, ropes, c, y, weight):
    """Integrals of twice the energies, over spans of these ropes."""
    S = np.array([[[float(s) for s in row] for row in section_of(scene, rope)] for rope in ropes])
    force = {CHANNEL[k]: y[f] for f, k in FORCE.items() if k in c and k != "z"}
    strain = dict.fromkeys(STRAINS, 0.0)
    for (i, f), (j, g) in itertools.product(force.items(), repeat=2):
        name = ("stretch", "twist", "bending")[i] if i == j else "lay"
        strain[name] += (weight * S[:, i, j, None] * f * g).sum()
    T = scene.tension
    if "beta" in c:
        strain["tension"] = (weight * T * y["beta"] ** 2).sum()
    elif "z" in c:
        strain["tension"] = (weight * y["F_z"] ** 2).sum() / T
    own = [inertia_of(scene, rope) for rope in ropes]
    return strain, {
        k: (weight * np.array([[float(one[k])] for one in own]) * y[k] ** 2).sum() for k in c
    }


def _add_parts(scene, c, stations, y, strain, kinetic):
    """Add springs, hinges (by the moment that opens them) and masses."""
    ends = {0: scene.ends[0], len(stations) - 1: scene.ends[1]}
    for i, x in enumerate(stations):
        here = standing(c, parts_at(scene, x), ends.get(i))
        for k in c:
            strain["spring"] += float(here.stiffness[k]) * y[k][i] ** 2
            kinetic[k] += float(here.mass[k]) * y[k][i] ** 2
        if here.hinge is not None and not mpmath.isinf(here.hinge):
            # the moment left of the node opens the hinge where nothing else takes of it
            assert not (here.stiffness["beta"] or here.mass["beta"] or "beta" in here.held)
            strain["spring"] += float(here.hinge) * y["M_beta"][i] ** 2
