"""Which number of the scene the differences of frequencies prove to be another one."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...base.array import Integer, Real
from ...chain.rate import rates_of
from .calculated import CalculatedPeaks
from .ends import Give, fitted_ends
from .tracked import Tracked

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
    unknowns: int = 1

    def __str__(self) -> str:
        return f"{self.path} {self.factor:.5g} times the scene's (std {self.factor * self.std:.1g})"


def likely_cause(found: CalculatedPeaks, order: Integer, measured: Real, std: Real) -> str:
    """Say which one number of the scene explains all differences, where they prove it."""
    # Chance must exceed the differences in less than one of 1000 cases, what the number leaves in
    # 5 % and more, and random differences be explained as well in less than one of 1000 (F test).
    from scipy.special import fdtrc

    at = order[order > 0] - 1
    spread = np.hypot(std[order > 0], found.error[at])
    known = np.isfinite(spread) & (spread > 0)
    if found.modes is None or known.sum() < FEWEST or not found.is_followed:
        return ""
    at, target = at[known], measured[order > 0][known]
    wanted = np.log(target / found.frequency[at])
    weight = (target / spread[known]) ** 2
    before = float((weight * wanted**2).sum())
    if chance(len(wanted), before) > EXCLUDED:
        return ""
    tracked = Tracked(found.modes, found.number[at])
    paths = rates_of(found.modes.sensitivity.places)
    causes = [one for path in paths if (one := _fitted(tracked, path, wanted, weight))]
    give = fitted_ends(tracked, wanted, weight)
    tried: list[Cause | Give] = [*causes, *([] if give is None else [give])]
    possible = [one for one in tried if _chance_of(one, len(wanted)) >= EXCLUDED]
    best = max(possible, key=lambda one: _chance_of(one, len(wanted)), default=None)
    numbers = [one for one in possible if isinstance(one, Cause)]
    if best is None or len(numbers) > MOST or _chance_of(best, len(wanted)) < LIKELY:
        return ""
    rest = len(wanted) - best.unknowns
    gain = (before - best.chi2) / max(best.chi2, NOTHING * before) * rest / best.unknowns
    if fdtrc(best.unknowns, rest, gain) * len(tried) > EXCLUDED:
        return ""
    return f"{_start(wanted, weight)} {_words(numbers, give, gives=give in possible)}"


def tension_alone(found: CalculatedPeaks, order: Integer, measured: Real) -> str:
    """Say which tension would do where no uncertainties are known, with what it would leave."""
    at = order[order > 0] - 1
    if found.modes is None or not found.is_followed:
        return ""
    tracked = Tracked(found.modes, found.number[at])
    wanted = np.log(measured[order > 0] / found.frequency[at])
    cause = _fitted(tracked, "tension", wanted, np.ones(len(at)))
    if cause is None:
        return ""
    left = 100 * math.sqrt(cause.chi2 / len(at))
    return f"a tension {cause.factor:.3g} times the scene's would leave {left:.2g} %"


def _chance_of(cause: Cause | Give, pairs: int) -> float:
    """Return how often chance alone leaves more than a cause does."""
    return chance(pairs - cause.unknowns, cause.chi2)


def chance(freedom: int, chi2: float) -> float:
    """Return how often chance alone leaves more than that."""
    from scipy.special import chdtrc

    return float(chdtrc(freedom, chi2))


def _start(wanted: Real, weight: Real) -> str:
    """Say what the shifts are like."""
    mean = float((weight * wanted).sum() / weight.sum())
    if chance(len(wanted) - 1, float((weight * (wanted - mean) ** 2).sum())) >= LIKELY:
        alike = f"measured are {math.exp(mean):.5g} times the calculated frequencies"
        return f"All shifts are alike within their uncertainty: {alike}."
    if (np.diff(np.abs(wanted)) > 0).all():
        return "The shifts grow with the order."
    return "The shifts are beyond their uncertainty."


def _words(causes: list[Cause], give: Give | None, *, gives: bool) -> str:
    """Say what explains the shifts."""
    numbers = f"One number alone explains them: {', or '.join(map(str, causes))}"
    if not gives:
        nor = "" if give is None else ", nor do springs at its ends"
        return f"{numbers}; no other number of the scene does{nor}."
    if not causes:
        return f"No number of the scene explains them alone: {give} do."
    return f"{numbers}; but {give} do as well: these peaks cannot tell them apart."


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
