"""Variables that are sampled, and how the numbers of a scene follow from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from ...base.array import Flags, Real
from ...base.errors import SceneError
from ...scene.end import End, end_of
from ...scene.parts.part import PointMass, Support
from ...scene.parts.stretch import AddedMass
from ...scene.path import value_at
from ...scene.rope import own_number
from ...scene.scene import Scene
from .belief import Belief
from .task import PosteriorTask

TENSION, STIFFNESS = "tension", "bending_stiffness"
LAMBDA, OFF = "lambda", "z"
SPRINGS = ("ends[0].spring.beta", "ends[1].spring.beta")

LIMITS = float(np.log(10.0)), float(np.log(1e8))
"""Of ln lambda, lambda = T L^2/B."""

SOFTEST = float(np.log(1e-4))
"""ln c of the softest spring, c = kappa/sqrt(T B); the stiffest is 1/c."""

TIED = 0.6
"""Probability that both ends are alike."""

Fixed = Literal["pinned", "clamped"]
WORDS = {"pinned": -np.inf, "clamped": np.inf, "": np.nan}
"""ln kappa of ends that are words."""


@dataclass(frozen=True, eq=False)
class Space:
    """Variables u, and logarithms (or values) of numbers of a scene, v = A u + a ln T + b.

    The variables are, where they are there: ln lambda, uniform; ln c of each end, uniform; those of
    a belief, normal; z, Student's, by which the tension is off what the peaks alone say.
    """

    paths: tuple[str, ...]  # (r,) of the numbers
    by_factor: Flags  # (r,) whether v is a logarithm
    matrix: Real  # A, (r, d)
    of_tension: Real  # a, (r,)
    constant: Real  # b, (r,)
    low: Real  # (d,) of uniform variables, -inf of others
    high: Real  # (d,)
    belief: Belief  # of the last variables but z
    about_tension: Belief | None  # of the same and the tension, where that has a prior
    springs: tuple[int, ...]  # columns of ln c
    tension: float  # [N] where it is not sought, and where the search begins
    pivot: bool  # whether the tension is sought
    stiff: bool  # whether ln lambda is the first variable
    scales: bool  # whether f^2 grows as the tension where the variables stay

    @property
    def size(self) -> int:
        """Number of variables d."""
        return self.matrix.shape[1]

    @property
    def tieable(self) -> bool:
        """Whether both ends may be alike."""
        return len(self.springs) == 2

    @property
    def believed(self) -> slice:
        """Columns of the belief."""
        start = int(self.stiff) + len(self.springs)
        return slice(start, start + len(self.belief))

    def draw(self, rng: np.random.Generator, n: int, freedom: float) -> tuple[Real, Flags]:
        """Draw variables before anything was measured, (n, d), and which ends are alike."""
        u = np.empty((n, self.size))
        flat = np.isfinite(self.low)
        u[:, flat] = rng.uniform(self.low[flat], self.high[flat], (n, int(flat.sum())))
        u[:, self.believed] = self.belief.draw(rng, n)
        if self.about_tension is not None:
            u[:, -1] = rng.standard_t(freedom, n)
        tied = np.zeros(n, dtype=bool)
        if self.tieable:
            tied = rng.random(n) < TIED
            u[tied, self.springs[1]] = u[tied, self.springs[0]]
        return u, tied

    def log_density(self, u: Real, freedom: float) -> Real:
        """Return ln of the density that `draw` has, up to a constant, shape (n,)."""
        found = self.belief.log_density(u[:, self.believed])
        found[((u < self.low) | (u > self.high)).any(axis=1)] = -np.inf
        if self.about_tension is not None:
            found -= (freedom + 1) / 2 * np.log1p(u[:, -1] ** 2 / freedom)
        return found

    @property
    def precision(self) -> Real:
        """What is known of the variables beforehand, as an inverse covariance, shape (d, d)."""
        flat = np.isfinite(self.low)
        width = np.where(flat, self.high - np.where(flat, self.low, 0.0), 1.0)
        found = np.diag(np.where(flat, 12 / width**2, 1.0))
        found[self.believed, self.believed] = self.belief.precision
        return found

    def reflected(self, u: Real) -> Real:
        """Return variables with the uniform ones reflected at their bounds, shape (n, d)."""
        flat = np.isfinite(self.low)
        low, width = self.low[flat], (self.high - self.low)[flat]
        found = u.copy()
        phase = np.mod(u[:, flat] - low, 2 * width)
        found[:, flat] = low + np.minimum(phase, 2 * width - phase)
        return found

    def directions(self, *, tied: bool) -> Real:
        """Return the directions that points may move in, as columns, shape (d, d or d - 1)."""
        axes = np.eye(self.size)
        if tied:
            first, second = self.springs
            axes[:, first] += axes[:, second]
            axes = np.delete(axes, second, axis=1)
        return axes

    def values(self, u: Real, log_tension: Real) -> Real:
        """Return the numbers of rows of a family, shape (n, r)."""
        v = u @ self.matrix.T + log_tension[:, None] * self.of_tension + self.constant
        return np.where(self.by_factor, np.exp(np.where(self.by_factor, v, 0.0)), v)


def space_of(task: PosteriorTask, fixed: Fixed | None = None) -> Space:
    """Return the variables of a task; its loose ends are both pinned, or clamped, if so wished."""
    scene, unknown = task.scene, task.unknown
    pivot, guess = TENSION in unknown, value_at(scene, TENSION)
    if guess <= 0:
        raise SceneError(
            f"tension must be > 0 where ends are unknown [N], got {guess:g}; of a beam without "
            'tension say ends="given"'
        )
    stiff = STIFFNESS in unknown and STIFFNESS not in task.prior
    loose = [i for i in range(2) if _is_loose(task, i)]
    own = {TENSION, *(SPRINGS[i] for i in loose), *([STIFFNESS] if stiff else [])}
    known = Belief.of(scene, task.prior, [path for path in unknown if path not in own])
    belief = known.only([path for path in known.paths if not (pivot and path == TENSION)])
    off = pivot and TENSION in task.prior
    sampled = () if fixed else tuple(SPRINGS[i] for i in loose)
    names = [*([LAMBDA] if stiff else []), *sampled, *belief.paths, *([OFF] if off else [])]
    rows = _numbers(scene, names, belief, pivot)
    for i in loose:
        path = SPRINGS[i]
        rows[path] = rows[path] if path in rows else _constant(names, WORDS[fixed or ""])
    shown = {path: row for path, row in rows.items() if row[:-1].any() or path in SPRINGS}
    form = np.array(list(shown.values()))
    uniform = len(sampled) + int(stiff)
    low = np.repeat([SOFTEST, -np.inf], [uniform, len(names) - uniform])
    high = -low
    if stiff:
        low[0], high[0] = LIMITS
    normal = [path for path, factor in zip(belief.paths, belief.by_factor) if not factor]
    return Space(
        paths=tuple(shown),
        by_factor=np.array([path not in normal for path in shown], dtype=bool),
        matrix=form[:, :-2],
        of_tension=form[:, -2],
        constant=form[:, -1],
        low=low,
        high=high,
        belief=belief,
        about_tension=known if off else None,
        springs=tuple(range(int(stiff), uniform)),
        tension=guess,
        pivot=pivot,
        stiff=stiff,
        scales=pivot and _scales(scene, stiff, loose, belief),
    )


def _constant(names: Sequence[str], value: float) -> Real:
    """Return a number as a form in (u, ln T, 1)."""
    return np.append(np.zeros(len(names) + 1), value)


def _numbers(scene: Scene, names: Sequence[str], belief: Belief, pivot: bool) -> dict[str, Real]:
    """Return numbers by their paths, each as a form in (u, ln T, 1)."""
    axis = dict(zip(names, np.eye(len(names), len(names) + 2)))
    found = {path: axis[path] for path in belief.paths}
    if pivot:
        found[TENSION] = np.eye(1, len(names) + 2, len(names))[0]
    tension = found.get(TENSION, _constant(names, np.log(value_at(scene, TENSION))))
    length = found.get("length", _constant(names, np.log(scene.rope.length)))
    if LAMBDA in axis:
        found[STIFFNESS] = tension + 2 * length - axis[LAMBDA]
    stiffness = own_number(scene.rope, STIFFNESS)
    if stiffness is not None:
        guess = _constant(names, np.log(stiffness))
        root = (tension + found.get(STIFFNESS, guess)) / 2
        found |= {path: axis[path] + root for path in SPRINGS if path in axis and path not in found}
    return found


def _is_loose(task: PosteriorTask, i: int) -> bool:
    """Whether the rotational spring of an end is not known, nor said what it is about."""
    if "beta" not in task.scene.coordinates or SPRINGS[i] in task.prior:
        return False
    end: End = end_of(task.scene.ends[i])
    stands = end.holds("z") or "z" in end.spring
    return SPRINGS[i] in task.unknown or (task.ends and stands)


def _scales(scene: Scene, stiff: bool, loose: Sequence[int], belief: Belief) -> bool:
    """Whether all that is elastic grows with the tension: then f^2 does, at the same lambda."""
    rope, free = scene.rope, {"z", "beta"}
    bends = rope.bending_stiffness is not None
    return (
        set(scene.coordinates) <= free
        and (stiff or not bends)
        and scene.gravity is None
        and all(isinstance(part, (PointMass, AddedMass, Support)) for part in scene.parts)
        and all(not end_of(end).spring or i in loose for i, end in enumerate(scene.ends))
        and all(not (set(end_of(end).spring) - {"beta"}) for end in scene.ends)
        and not any(path in SPRINGS for path in belief.paths)
    )
