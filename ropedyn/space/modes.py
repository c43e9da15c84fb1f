"""The modes of a rope on an axis: frequencies first, shapes and energies when they are read."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from ..base import check
from ..base.answer import Cost
from ..base.array import Index, Real
from ..base.computed import Late, computed
from ..base.errors import SceneError, SolveError
from ..base.unit import FAMILY
from ..chain.wide import LINEAR, RUNS, apart
from ..eigen.eigen import check_asked, no_mesh
from ..eigen.modes import Modes, OnCatenary, UndampedMesh, UndampedVectors
from ..eigen.spectrum import error_in_hertz
from ..eigen.vectors import largest, within
from ..scene import damping
from ..scene.scene import Scene
from .assembly import MOST_PARTS, Assembly, assemble, parts_at
from .compile import axis_of, finer_rope, method_of
from .rope import SIX, Factors, SpaceRope, unforced
from .sensitivity import SpaceSensitivity
from .spectrum import (
    AT_ONCE,
    BESIDE,
    MORE,
    STEP,
    TOGETHER,
    Lowest,
    counts_at,
    lowest,
    ritz,
    start,
)

BESIDE_FEET = 1e-10  # From a mode, where feet of wires have poles as close to it as 1e-6.
STILL = 1e-11  # So close to a mode of a wire that is held, relative, a mode is that.
SEEN = 1e-9  # Shares of kinetic energy above it are motion.


def solve_modes(
    scene: Scene,
    rope: SpaceRope,
    number: int | None,
    *,
    below: float | None,
    points: int | None,
) -> Modes:
    """Find natural frequencies and shapes; see `SpaceModel.modes`."""
    limit = check_asked(number, below)
    check_points(rope, points)
    found = lowest(rope, number, limit)
    value = np.where(np.abs(found.eigenvalue) <= found.error, 0.0, found.eigenvalue)
    shapes = SpaceShapes(scene, rope, value, found, points or points_for(rope, value))
    frequency = np.sqrt(np.maximum(value, 0.0)) / (2 * math.pi)
    return Modes(
        coordinates=rope.coordinates,
        certified=True,
        x=within(rope.x, shapes.points) / rope.longer,
        frequency=frequency,
        eigenvalue=value,
        growth=np.sqrt(np.maximum(-value, 0.0)),
        rounding_error=Late(lambda: error_in_hertz(value, shapes.unsure())),
        rounding_bound=error_in_hertz(value, found.error),
        plane=Late(lambda: shapes.plane),
        cost=Cost(method_of(scene), len(rope.length), rope.unknowns, sweeps=found.counts),
        vectors=Late(partial(vectors_of, shapes)),
        mesh=partial(_mesh, scene, rope, value, frequency),
        hanging=partial(OnCatenary, np.zeros_like(frequency), frequency),
        solve_shapes=partial(_again, scene, shapes),
        line=partial(axis_of, scene),
    )


def _mesh(scene: Scene, rope: SpaceRope, eigenvalue: Real, frequency: Real) -> UndampedMesh:
    """Hold frequencies against those of shorter pieces."""
    finer = finer_rope(scene, rope)
    if finer is None or not len(eigenvalue):
        return no_mesh(frequency)
    other = lowest(finer, len(eigenvalue), math.inf).eigenvalue
    limit = np.sqrt(np.maximum(other, 0.0)) / (2 * math.pi)
    return UndampedMesh(
        mesh_error=error_in_hertz(eigenvalue, np.abs(other - eigenvalue)), limit=limit
    )


def _again(scene: Scene, shapes: SpaceShapes, points: int | None = None) -> Any:
    """Return what derivatives are computed from."""
    if scene.sags:
        raise SceneError("derivatives and damage are not carried for a rope on its catenary")
    return SpaceSensitivity(shapes)


def check_points(rope: SpaceRope, points: int | None) -> None:
    """Check how many parts of each piece an answer is given at."""
    if points is not None:
        check.count(points, "points", most=MOST_PARTS // len(rope.length))


def points_for(rope: SpaceRope, eigenvalue: Real) -> int:
    """Return how many parts of each piece show the highest mode."""
    wave = rope.waves(np.abs(eigenvalue).max(initial=0.0))
    most, least = MOST_PARTS // len(rope.length), 32
    if rope.changes:
        # blocks that polynomials follow are shorter than the pieces of the axis
        least = math.ceil(2 * least / len(rope.length))
    return int(min(max(least, math.ceil(16 * wave * rope.length.max() / math.pi)), most))


class ShapeBatch(NamedTuple):
    """Modes whose vectors are found at once."""

    clusters: list[Index]  # the numbers of those that are found together
    system: Assembly
    own: Real  # (clusters, rows, columns) of unit mass, as many columns as the largest cluster
    lines: tuple[Index, Factors, Real]  # components, factors and scales


class SpaceShapes:
    """Shapes of modes at equal parts of each piece, and forms of them."""

    def __init__(
        self, scene: Scene, rope: SpaceRope, eigenvalue: Real, found: Lowest, points: int
    ) -> None:
        self.scene, self.rope, self.points = scene, rope, points
        self.eigenvalue, self.error, self.component = eigenvalue, found.error, found.component

    def on(self, rope: SpaceRope) -> SpaceShapes:
        """Return the same modes on the rope with nodes elsewhere."""
        found = Lowest(self.eigenvalue, self.error, self.component, 0)
        return SpaceShapes(self.scene, rope, self.eigenvalue, found, 1)

    def unsure(self) -> Real:
        """Bound what rounding did to eigenvalues by those of numbers that are a little off."""
        every = []
        for random in map(np.random.default_rng, range(RUNS)):
            one = self.on(self.rope.nudged(random)[0])
            try:
                every.append(one.again(random.uniform(0.5, 1.0)))
            except SolveError:  # of parts that end at a resonance
                return self.error
        found = apart(self.eigenvalue, np.stack(every))
        told = found <= LINEAR * np.abs(self.eigenvalue)
        return np.where(told, found, self.error)

    def again(self, nearer: float) -> Real:
        """Return the eigenvalues found once more, from closer by."""
        found = np.full(len(self.eigenvalue), np.nan)
        for clusters, (which, means, beside, z) in self._lines():
            at = means + nearer * beside
            system = self._assembled(self.rope, (which, unforced(at, STEP), z))
            sizes = [len(one) for one in clusters]
            for k, near in enumerate(ritz(system, start(system, max(sizes) + MORE), sizes)):
                found[clusters[k]] = at[k] + near.shift
        return found

    def clusters(self) -> Iterator[Index]:
        """Yield the numbers of modes that are found together."""
        for component in np.unique(self.component):
            own = np.flatnonzero(self.component == component)
            value = self.eigenvalue[own]
            near = TOGETHER * np.abs(value) + self.error[own]
            yield from np.split(own, np.flatnonzero(np.diff(value) > near[1:] + near[:-1]) + 1)

    @computed
    def batches(self) -> list[ShapeBatch]:
        """Vectors of unit mass of modes that are found together, so many clusters at a time."""
        self._refuse_still()
        found = []
        for clusters, (which, means, beside, z) in self._lines():
            system = self._assembled(self.rope, (which, unforced(means + beside, STEP), z))
            own = self._found(system, [len(one) for one in clusters])
            found.append(ShapeBatch(clusters, system, own, (which, unforced(means), z)))
        return found

    def _lines(self) -> Iterator[tuple[list[Index], tuple[Index, Real, Real, Real]]]:
        """Yield clusters, whose they are, where, how far beside they are sought, and scales."""
        every = list(self.clusters())
        for first in range(0, len(every), AT_ONCE):
            clusters = every[first : first + AT_ONCE]
            means = np.array([self.eigenvalue[one].mean() for one in clusters])
            spread = np.array([np.ptp(self.eigenvalue[one]) for one in clusters])
            near = BESIDE_FEET if self.rope.carried else BESIDE
            beside = np.maximum(8 * spread, near * np.maximum(np.abs(means), self.rope.unit))
            which = self.component[[one[0] for one in clusters]]
            yield clusters, (which, means, beside, self.rope.scale(which, means))

    def _assembled(self, rope: SpaceRope, lines: Any) -> Assembly:
        which, factors, z = lines
        return assemble(rope, which, factors, z, parts_at(rope, which, factors, z, self.points))

    @computed
    def solved(self) -> tuple[Real, dict[str, Real]]:
        """Shapes of unit modal mass (k, nodes, 6), and twice the energies of each."""
        shape = np.zeros((len(self.eigenvalue), len(self.rope.length) * self.points + 1, 6))
        variants = self.variants
        energy = {name: np.zeros(len(self.eigenvalue)) for name in variants}
        for clusters, system, own, lines in self.batches:
            which, _, z = lines
            u, _ = system.apart(own)
            u = z[:, None, :, None] * u[:, system.shown(self.points)]
            forms = {k: self.form(one, lines, own) for k, one in variants.items()}
            for k, cluster in enumerate(clusters):
                moves = self.rope.own[which[k]]
                shape[cluster[:, None], :, moves] = u[k, :, :, : len(cluster)].transpose(2, 1, 0)
                for name, form in forms.items():
                    energy[name][cluster] = form[k, : len(cluster)]
        return shape, energy

    def _refuse_still(self) -> None:
        """Refuse shapes of modes in which wires move and their feet do not."""
        sides = self.eigenvalue[:, None] * (1 + STILL * np.array([-1.0, 1.0]))
        for one in self.rope.carried:
            held = counts_at(one.rope, np.zeros(sides.size, np.intp), sides.ravel()).reshape(-1, 2)
            still = np.flatnonzero(held[:, 0] != held[:, 1])
            if len(still):
                raise SolveError(
                    f"mode {still[0] + 1} is that of a broken wire whose root stands still: it "
                    "has a frequency and no shape along the rope"
                )

    def _found(self, system: Assembly, sizes: list[int]) -> Real:
        x = start(system, max(sizes) + MORE)
        for again in range(2):
            found = ritz(system, x, sizes)
            for k, near in enumerate(found if again == 0 else []):
                x[k, :, : near.around.shape[1]] = near.around
        own = np.zeros((*x.shape[:2], max(sizes)))
        for k, near in enumerate(found):
            own[k, :, : near.own.shape[1]] = near.own
        return own

    @property
    def variants(self) -> dict[str, SpaceRope]:
        """Ropes of which one thing has a small imaginary part, that of its energy in x^T A x."""
        rope, step = self.rope, 1j * STEP
        found = {}
        for name, own in SECTION.items():
            # flexibilities store what they are, with the other sign
            soft = np.where(own, rope.soft, 0.0)
            if soft.any():
                found[name] = replace(rope, soft=rope.soft - step * soft)
        found["tension"] = replace(
            rope,
            stress=rope.stress * (1 + step),
            initial=rope.initial * (1 + step),
            string=rope.string * (1 - step),
        )
        found["spring"] = replace(rope, springs=rope.springs * (1 + step))
        found["drag"] = replace(
            rope,
            stress=rope.stress + step * rope.drag[:, None],
            springs=rope.springs + step * rope.dashpots,
        )
        if rope.carried:
            found |= self._carried(step)
        for k, name in enumerate(SIX):
            own = np.zeros((6, 6))
            own[k, k] = step.imag
            found[name] = replace(
                rope,
                stress=rope.stress + 1j * own * rope.inertia[:, None],
                springs=rope.springs + 1j * own * rope.masses,
            )
        return found

    def _carried(self, step: complex) -> dict[str, SpaceRope]:
        wires = self.rope.carried
        softer = [replace(w.rope, soft=w.rope.soft * (1 - step)) for w in wires]
        heavier = [
            replace(w.rope, stress=w.rope.stress + step * w.rope.inertia[:, None]) for w in wires
        ]
        losing = [replace(w.rope, soft=w.rope.soft * (1 - w.loss * step)) for w in wires]
        return {
            name: replace(
                self.rope, carried=tuple(w._replace(rope=own) for w, own in zip(wires, owns))
            )
            for name, owns in zip(CARRIED, (softer, heavier, losing))
        }

    def form(self, varied: SpaceRope, lines: Any, own: Real) -> Real:
        """Return what an imaginary part adds to x^T A x of vectors (n, rows, columns)."""
        form: Real = self.products(varied, lines, own).sum(1)
        return form

    def products(self, varied: SpaceRope, lines: Any, own: Real) -> Real:
        """Return the products, row by row, that these are sums of."""
        system = self._assembled(varied, lines)
        return np.asarray(own * system.apply(own).imag / STEP)

    @property
    def kinetic(self) -> Real:
        """Modal mass by coordinate, shape (k, 6)."""
        energy = self.solved[1]
        return np.stack([energy[c] for c in SIX], axis=1)

    @property
    def plane(self) -> Any:
        """In which each mode moves across: on a plane curve what its component moves in."""
        rope = self.rope
        if len(rope.own[0]) < len(SIX) and rope.bend[:, :, 0, 2].all():
            return np.array(["z" if SIX.index("z") in own else "y" for own in rope.own])[
                self.component
            ]
        shares = self.kinetic / self.kinetic.sum(axis=1, keepdims=True)
        y = shares[:, [1, 5]].sum(axis=1) > SEEN
        z = shares[:, [2, 4]].sum(axis=1) > SEEN
        return np.select([y & z, y, z], ["space", "y", "z"], "")


CARRIED = ("broken wire", "broken wire mass", "broken wire loss")
"""Strain energy, modal mass and what is lost of wires that are carried."""

SECTION = {
    "bending": np.diag([0, 0, 0, 0, 1, 1]).astype(bool),
    "twist": np.diag([0, 0, 0, 1, 0, 0]).astype(bool),
    "stretch": np.diag([1, 0, 0, 0, 0, 0]).astype(bool),
    "shear": np.diag([0, 1, 1, 0, 0, 0]).astype(bool),
    "lay": ~np.eye(6, dtype=bool),
}
"""Entries of the section flexibility that store each kind of strain energy."""


def vectors_of(shapes: SpaceShapes) -> UndampedVectors:
    """Return what follows from the shapes."""
    shape, energy = shapes.solved
    kinetic = shapes.kinetic
    own = kinetic.argmax(axis=1)
    size = largest(shape, own)
    # a mode that stands still at all points keeps its unit modal mass
    size = np.where(np.abs(size) > 1e-8 * np.abs(shape).max(axis=(1, 2)), size, 1.0)
    return UndampedVectors(
        damping_ratio=_damping_ratio(shapes, energy, kinetic),
        family=np.array([FAMILY[SIX[k]] for k in own], dtype=np.str_),
        modal_mass=(kinetic.sum(axis=1) + _of(energy, "broken wire mass")) / size**2,
        shape=(shape / size[:, None, None])[:, :, ~shapes.rope.absent],
        energy=_fractions(shapes, energy, kinetic),
    )


def _damping_ratio(shapes: SpaceShapes, energy: dict[str, Real], kinetic: Real) -> Real:
    """Return zeta = x^T Im(dynamic stiffness) x/(2 omega^2 x^T M x), to first order."""
    omega = np.sqrt(np.maximum(shapes.eigenvalue, 0.0))
    mass = kinetic.sum(axis=1) + _of(energy, "broken wire mass")
    section = sum((energy[name] for name in SECTION if name in energy), np.zeros_like(omega))
    part = np.stack([section, energy["tension"], energy["spring"], mass, energy["drag"]], axis=1)
    lost = (damping.factors(shapes.scene.dampings, omega).imag * part).sum(axis=1)
    lost += _of(energy, "broken wire loss")
    ratio = np.zeros_like(omega)
    return np.divide(lost, 2 * omega**2 * mass, where=omega > 0, out=ratio)


def _fractions(shapes: SpaceShapes, energy: dict[str, Real], kinetic: Real) -> dict[str, Real]:
    """Return shares of the strain and of the kinetic energy."""
    strains = (*SECTION, "tension", "spring", "broken wire")
    stored = {name: energy[name] for name in strains if name in energy}
    stored = {name: one for name, one in stored.items() if np.any(one)}
    total = sum(stored.values(), np.zeros(len(kinetic)))
    moves = (shapes.eigenvalue != 0) & (total != 0)
    none = np.zeros_like(total)
    found = {k: np.divide(v, total, where=moves, out=none.copy()) for k, v in stored.items()}
    own = [(k, c) for k, c in enumerate(SIX) if not shapes.rope.absent[k]]
    moving = {c: kinetic[:, k] for k, c in own}
    moving |= {name: energy[name] for name in ("broken wire mass",) if name in energy}
    whole = sum(moving.values(), np.zeros(len(kinetic)))
    return found | {name: one / whole for name, one in moving.items()}


def _of(energy: dict[str, Real], name: str) -> Any:
    return energy.get(name, 0.0)
