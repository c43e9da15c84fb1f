"""Natural frequencies as functions of independent standard normal variables: what is known first.

A number p of factor e^u about its guess has u = mean + spread v, v ~ N(0, 1); a rotational spring
at an end nobody knows is kappa = c sqrt(T B), ln c ~ N(0, 3^2): pinned, c << 1, to clamped, c >> 1.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...base.array import Flags, Real
from ...base.errors import RopedynError, SceneError
from ...scene.bench.prior import Prior
from ...scene.end import end_of
from ...scene.path import unit_of, value_at
from ...scene.scene import Scene
from ..fitting.natural_frequencies import NaturalFrequencies
from ..fitting.unknown import Unknowns

TENSION, BENDING = "tension", "bending_stiffness"
SPREAD = 1.1  # Of the logarithm of a tension about its guess, where nobody says more;
OTHERS = 1.2  # of any other number,
SPRING = 3.0  # and of springs at ends, which nobody guesses well.
PLACE = 0.1  # Of a position, in lengths of the rope.
HOMOGENEOUS = 1e-9  # Slopes of frequencies that scale are 1/2 but for rounding.

Known = Mapping[str, tuple[float, float]]
"""Mean and standard deviation of numbers, by their paths."""


@dataclass(frozen=True, eq=False)
class Standardised:
    """Natural frequencies of the scenes that are possible: v = 0 is what is expected."""

    calculated: NaturalFrequencies  # as functions of u = centre + mixing v
    centre: Real  # (p,)
    mixing: Real  # (p, p) du/dv
    spread: Real  # (p,) of ln p, or of ln c
    spring: Flags  # (p,) which are rotational springs at ends
    stiff: Flags  # (p,) which are other stiffnesses
    main: Flags  # (p,) which numberings feel most: tension, bending stiffness and the lead
    lead: int  # the variable whose number makes numberings differ: the tension, where it is sought

    @classmethod
    def of(
        cls,
        scene: Scene,
        unknown: Sequence[str],
        prior: Known,
        *,
        any_ends: bool,  # nobody knows them
        elements: int | None = None,
        element: str | None = None,
    ) -> Standardised:
        """Take what is sought, what else is not certain, and the ends where nobody knows them."""
        beside = tuple(path for path in prior if path not in unknown and _felt(scene, path))
        known = {*unknown, *beside}
        ends = tuple(path for path in _free_ends(scene) if path not in known) if any_ends else ()
        scene = _sprung(scene, ends)
        unknowns = Unknowns.of(scene, (*unknown, *beside, *ends))
        paths = unknowns.paths
        mean, spread = np.array([_told(unknowns, i, prior) for i in range(len(paths))]).T
        mixing = _mixing(paths, spread, prior)
        for i in range(len(paths) - len(ends), len(paths)):
            for j in (k for k, path in enumerate(paths) if path in (TENSION, BENDING)):
                mixing[i] += 0.5 * mixing[j]
                mean[i] += 0.5 * mean[j]
        spring = np.array([path.endswith(".spring.beta") for path in paths])
        stiff = np.array([unit_of(path).startswith("N") for path in paths]) & ~spring
        lead = paths.index(TENSION) if TENSION in unknown else 0
        calculated = NaturalFrequencies.of(unknowns, elements, element)
        main = np.array([path in {TENSION, BENDING, paths[lead]} for path in paths])
        return cls(calculated, mean, mixing, spread, spring, stiff, main, lead)

    def __len__(self) -> int:
        return len(self.centre)

    def __call__(self, v: Real, count: int) -> tuple[Real, Real]:
        """Return ln f, (n, count), and its slopes, (n, count, p), of rows v; NaN where none is."""
        frequency, slope = self.calculated(self.centre + v @ self.mixing.T, count)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.log(frequency), (slope / frequency[:, :, None]) @ self.mixing

    def value(self, v: Real) -> Real:
        """Return the numbers of the paths."""
        return self.calculated.unknowns.value(self.centre + v @ self.mixing.T)

    def lead_of(self, v: Real) -> Real:
        """Return u of the number that makes numberings differ, (n,)."""
        return self.centre[self.lead] + v @ self.mixing[self.lead]

    @property
    def closed(self) -> bool:
        """Whether frequencies have a closed form."""
        return self.calculated.family.closed

    def common(self, count: int) -> Real | None:
        """Return the change of v that raises ln f of all modes by 1/2, None where there is none.

        So does a common factor of all that is stiff, where all of it is sought.
        """
        stiff = (self.stiff | self.spring).astype(np.float64)
        direction: Real = np.asarray(np.linalg.solve(self.mixing, stiff), dtype=np.float64)
        _, slope = self(np.zeros((1, len(self))), count)
        same = np.abs(slope[0] @ direction - 0.5) < HOMOGENEOUS
        return direction if bool(same.all()) and self.stiff[self.lead] else None


def _free_ends(scene: Scene) -> tuple[str, ...]:
    """Return the rotational springs of ends whose deflection something holds."""
    if "beta" not in scene.coordinates:
        return ()
    ends = [end_of(end) for end in scene.ends]
    held = [i for i, end in enumerate(ends) if end.holds("z") or "z" in end.spring]
    return tuple(f"ends[{i}].spring.beta" for i in held)


def _sprung(scene: Scene, ends: Sequence[str]) -> Scene:
    """Return a scene with springs sqrt(T B), half-way between pinned and clamped, at these ends.

    Where there is hardly a tension the half wave pi/L of a beam stands for it.
    """
    if not ends:
        return scene
    tension, bending = abs(value_at(scene, TENSION)), value_at(scene, BENDING)
    stiffness = math.sqrt(bending * (tension + bending * (math.pi / scene.rope.length) ** 2))
    return scene.family(ends).scene_of(np.full(len(ends), stiffness))


def _told(unknowns: Unknowns, i: int, prior: Known) -> tuple[float, float]:
    """Return mean and standard deviation of u: a number by factor is log-normal, by its moments."""
    path, start, scale = unknowns.paths[i], unknowns.start[i], unknowns.scale[i]
    if path not in prior:
        if scale:
            return 0.0, PLACE
        is_spring = path.startswith("ends[")
        return 0.0, SPREAD if path == TENSION else SPRING if is_spring else OTHERS
    mean, std = prior[path]
    if scale:
        return (mean - start) / scale, std / scale
    if not mean / start > 0:
        raise SceneError(
            f"prior[{path!r}] must have a mean of the sign of the scene's {start:g}, got {mean:g}"
        )
    square = math.log1p((std / mean) ** 2)
    return math.log(mean / start) - square / 2, math.sqrt(square)


def _mixing(paths: Sequence[str], spread: Real, prior: Known) -> Real:
    """Return du/dv: what a prior says of numbers together they have together."""
    mixing = np.diag(spread)
    if isinstance(prior, Prior) and prior.covariance is not None:
        at = [i for i, path in enumerate(paths) if path in prior]
        rows = prior.law.apart.spread[[list(prior).index(paths[i]) for i in at]]
        share = (spread[at] / np.linalg.norm(rows, axis=1))[:, None] * rows
        mixing[np.ix_(at, at)] = np.linalg.cholesky(share @ share.T)
    return mixing


def _felt(scene: Scene, path: str) -> bool:
    """Say whether the scene has a number and the first frequencies feel it."""
    try:
        value = value_at(scene, path)
    except SceneError:
        if unit_of(path):
            return False
        raise
    try:
        found = scene.family([path]).modes([[value]], 3, derivative=True, threads=1)
    except RopedynError:
        return False
    return found.derivative is not None and bool((np.abs(found.derivative) > 0).any())
