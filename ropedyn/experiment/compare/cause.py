"""Which number of the scene the differences of frequencies prove to be another one."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ...base.array import Index, Integer, Real
from ...base.computed import computed
from ...base.errors import SceneError, SolveError
from ...base.unit import FAMILY
from ...chain.compile import remeshed
from ...chain.compiled import Compiled
from ...chain.rate import rates_of
from ...eigen.modes import Modes
from ...eigen.spectrum import spectrum
from ...scene.path import value_at, with_values
from .calculated import CalculatedPeaks

LIKELY = 0.05  # What explains differences leaves some that chance exceeds at least so often.
EXCLUDED = 1e-3  # What leaves some that chance exceeds more rarely does not explain them.
FEWEST = 3  # Fewer pairs are explained by one number too easily.
MOST = 4  # At most so many numbers that explain the same are named, more say nothing.
ITERATIONS = 20

FARTHEST = 3.0  # A number is not looked for beyond exp(3) = 20 times what it is.
NOTHING = 1e-12  # Relative changes below this are made by rounding.
SETTLED = 1e-3  # A number stops when it moves by less than this share of its standard uncertainty.


class Cause(NamedTuple):
    """One number that makes calculated frequencies the measured ones."""

    path: str
    factor: float  # of the number, as the measurement has it over the scene's
    std: float  # relative, of the factor
    chi2: float  # what is left, in squares of standard uncertainties


def likely_cause(found: CalculatedPeaks, order: Integer, measured: Real, std: Real) -> str:
    """Say which one number of the scene explains all differences, where they prove it."""
    # Chance must exceed the differences in less than one of 1000 cases, what the number leaves in
    # 5 % and more, and random differences be explained as well in less than one of 1000 (F test).
    from scipy.special import fdtrc

    at = order[order > 0] - 1
    spread = np.hypot(std[order > 0], found.error[at])
    known = np.isfinite(spread) & (spread > 0)
    if found.modes is None or not found.has_shapes or known.sum() < FEWEST:
        return ""
    at, target = at[known], measured[order > 0][known]
    wanted = np.log(target / found.frequency[at])
    weight = (target / spread[known]) ** 2
    rest = len(wanted) - 1
    before = float((weight * wanted**2).sum())
    if chance(len(wanted), before) > EXCLUDED:
        return ""
    tracked = Tracked(found.modes, found.number[at])
    paths = rates_of(found.modes.sensitivity.places)
    causes = [one for path in paths if (one := _fitted(tracked, path, wanted, weight))]
    possible = [one for one in causes if chance(rest, one.chi2) >= EXCLUDED]
    best = min(possible, key=lambda one: one.chi2, default=None)
    if best is None or len(possible) > MOST or chance(rest, best.chi2) < LIKELY:
        return ""
    gain = (before - best.chi2) / max(best.chi2, NOTHING * before) * rest
    if fdtrc(1, rest, gain) * len(causes) > EXCLUDED:
        return ""
    return _words(possible, wanted, weight)


def chance(freedom: int, chi2: float) -> float:
    """Return how often chance alone leaves more than that."""
    from scipy.special import chdtrc

    return float(chdtrc(freedom, chi2))


def _words(causes: list[Cause], wanted: Real, weight: Real) -> str:
    """Say what the shifts are like and what explains them."""
    mean = float((weight * wanted).sum() / weight.sum())
    if chance(len(wanted) - 1, float((weight * (wanted - mean) ** 2).sum())) >= LIKELY:
        alike = f"measured are {math.exp(mean):.5g} times the calculated frequencies"
        start = f"All shifts are alike within their uncertainty: {alike}."
    elif (np.diff(np.abs(wanted)) > 0).all():
        start = "The shifts grow with the order."
    else:
        start = "The shifts are beyond their uncertainty."
    each = [
        f"{c.path} {c.factor:.5g} times the scene's (std {c.factor * c.std:.1g})" for c in causes
    ]
    return (
        f"{start} One number alone explains them: {', or '.join(each)}; no other number of the "
        "scene does."
    )


def _fitted(tracked: Tracked, path: str, wanted: Real, weight: Real) -> Cause | None:
    """Fit one number, by Gauss and Newton, then chords, if it has a value and shifts anything."""
    slope = tracked.slope(path)
    if slope is None or not np.abs(slope).max() > NOTHING:
        return None
    log, shift = 0.0, np.zeros_like(wanted)
    for _ in range(ITERATIONS):
        size = float((weight * slope**2).sum())
        step = float((weight * slope * (wanted - shift)).sum()) / size
        log += min(max(step, -1.0), 1.0)
        moved = tracked.shift(path, math.exp(log)) if abs(log) <= FARTHEST else None
        if moved is None:
            return None
        shift = moved
        if abs(step) <= max(SETTLED / math.sqrt(size), NOTHING):
            left = float((weight * (wanted - shift) ** 2).sum())
            return Cause(path, math.exp(log), 1 / math.sqrt(size), left)
        slope = shift / log
    return None


@dataclass(frozen=True, eq=False)
class Tracked:
    """Some modes while a number of the scene changes, known by their numbers in their component."""

    modes: Modes  # of a model
    number: Index  # (k,) which of them, from 0

    @computed
    def model(self) -> Compiled:
        """That the modes are of, of continuous spans a finer one."""
        return self.modes.sensitivity.shapes.model

    @computed
    def parts(self) -> list[tuple[tuple[str, ...], Index, Index]]:
        """Components, which of the tracked modes are theirs, and their numbers in them."""
        coordinate = {name: c for c, name in FAMILY.items()}
        own = [self.model.component_of(coordinate[name]) for name in self.modes.family]
        found = []
        for component in self.model.components:
            mine = np.array([one == component for one in own])
            at = np.flatnonzero(mine[self.number])
            if len(at):
                found.append((component, at, np.cumsum(mine)[self.number[at]] - 1))
        return found

    def slope(self, path: str) -> Real | None:
        """Return d log f/d log p, shape (k,), or None where there is no such derivative."""
        try:
            value = value_at(self.model.scene, path)
            change = self.modes.derivative(path, of="eigenvalue")[self.number]
            return value * change / (2 * self.modes.eigenvalue[self.number])
        except (SceneError, SolveError):
            return None

    def shift(self, path: str, factor: float) -> Real | None:
        """Return log f of the number times a factor less log f, or None where there is none."""
        model = self.model
        try:
            scene = with_values(model.scene, {path: factor * value_at(model.scene, path)})
            changed = remeshed(model, scene)
            frequency = np.zeros(len(self.number))
            for component, at, number in self.parts:
                eigenvalue, _ = spectrum(changed, component, int(number.max()) + 1)
                frequency[at] = np.sqrt(np.maximum(eigenvalue[number], 0.0)) / (2 * np.pi)
        except (SceneError, SolveError, IndexError):
            return None
        if not (frequency > 0).all():
            return None
        return np.asarray(np.log(frequency / self.modes.frequency[self.number]))
