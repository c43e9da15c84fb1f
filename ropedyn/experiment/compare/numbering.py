"""Which calculated frequencies the measured ones are, up to one factor, and how sure that is."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from ...base.array import Integer, Real
from .pairing import ALONE, paired

FACTOR = 0.25
"""Standard deviation of the logarithm of the factor between scene and rope: 25 %, of a tension
50 %."""
SHIFTS = np.linspace(-0.75, 0.75, 101)  # Logarithms of factors that are tried.
RIVALS = 3  # Of so many numberings each peak is left out in turn.
FEWEST = 3  # Fewer pairs say nothing about a factor, and are not trusted.
SCATTER = np.geomspace(1e-3, 0.05, 8)  # A model of the right kind is off by one of these.
FARTHEST = 4.0  # Pairs are at most so many times as far from the factor as half of them are.
ASTRAY = 0.01  # Share of pairs that are none.
STRAY = 0.1  # Share of measured peaks that are no mode.
MISSED = 0.2  # Share of modes that show no peak.
HALVED = 0.02  # Share of measurements in which every second mode shows none.
TRUSTED = 0.95  # Probability from which on a numbering is taken for the right one.
ALIKE = 3.0  # A common factor is as many times as far from 1 as peaks scatter about it.
NOTABLE = 0.01  # Smaller common factors are not worth a word.


class Pairing(NamedTuple):
    """Pairs, the factor that they have in common, and what they are worth."""

    order: Integer  # (k,) which calculated one each measured one is, from 1; 0: none
    shift: float  # logarithm of measured over calculated, the median of pairs
    near: float  # pairs are no farther from it, but for those that are none
    evidence: float  # logarithm, up to a constant

    @property
    def pairs(self) -> int:
        """How many there are."""
        return int((self.order > 0).sum())


class Verdict(NamedTuple):
    """What is said about pairs."""

    status: str  # "trusted" | "ambiguous" | "refused"
    reason: str


def numbered(measured: Real, calculated: Real, std: Real) -> list[Pairing]:
    """Return the numberings worth naming, the most probable first."""
    plain = weighed(measured, calculated, std, paired(measured, calculated))
    found = {plain.order.tobytes(): plain}
    begun: dict[bytes, Pairing] = {}
    for shift in SHIFTS.tolist():
        order = paired(measured / math.exp(shift), calculated)
        if np.count_nonzero(order) < FEWEST or order.tobytes() in begun:
            continue
        begun[order.tobytes()] = one = weighed(measured, calculated, std, order)
        # about the factor that the pairs have, and without those that scatter most
        f = measured / math.exp(one.shift)
        for order in (paired(f, calculated), paired(f, calculated, within=one.near)):
            if np.count_nonzero(order) >= FEWEST and order.tobytes() not in found:
                found[order.tobytes()] = weighed(measured, calculated, std, order)
    for one in sorted(found.values(), key=lambda one: -one.evidence)[:RIVALS]:
        # one more is no mode
        f = measured / math.exp(one.shift)
        for k in np.flatnonzero(one.order).tolist():
            order = np.insert(paired(np.delete(f, k), calculated), k, 0)
            if np.count_nonzero(order) >= FEWEST and order.tobytes() not in found:
                found[order.tobytes()] = weighed(measured, calculated, std, order)
    return sorted(found.values(), key=lambda one: -one.evidence)


def verdict(numberings: list[Pairing]) -> Verdict:
    """Say whether the first of numberings is the right one."""
    first = numberings[0]
    if first.pairs == 0:
        return Verdict("refused", "no measured peak has a partner")
    if first.pairs < FEWEST:
        return Verdict("ambiguous", f"{first.pairs} pairs, and less than {FEWEST} prove nothing")
    weight = np.exp(np.array([one.evidence for one in numberings]) - first.evidence)
    share = weight / weight.sum()
    if share[0] > TRUSTED:
        return Verdict("trusted", f"these pairs have a probability of {share[0]:.3f}")
    said = [_said(one, p) for one, p in zip(numberings, share.tolist()) if p > 1 - TRUSTED]
    return Verdict("ambiguous", "several pairings are possible: " + "; or ".join(said))


def common_factor(numbering: Pairing, measured: Real, calculated: Real) -> float | None:
    """Return the factor that all pairs have in common, None where they have none worth naming."""
    at = numbering.order > 0
    if numbering.pairs < FEWEST or abs(numbering.shift) < NOTABLE:
        return None
    rest = np.log(measured[at] / calculated[numbering.order[at] - 1]) - numbering.shift
    scatter = float(np.sqrt(np.mean(rest**2)))
    return math.exp(numbering.shift) if abs(numbering.shift) > ALIKE * scatter else None


def _said(numbering: Pairing, probability: float) -> str:
    """Return a numbering in words."""
    modes = ", ".join("-" if k == 0 else str(k) for k in numbering.order.tolist())
    return f"modes {modes} with a factor of {math.exp(numbering.shift):.4g} (p = {probability:.2f})"


def weighed(measured: Real, calculated: Real, std: Real, order: Integer) -> Pairing:
    """Return pairs with their factor and their evidence."""
    # p = sum over scatters s of prod [(1 - a) N(d; c, s^2 + std^2) + a/ln 2] x what finding c costs
    # x strays x modes that are seen and missed up to the highest; d = ln f/g
    at = order > 0
    away = np.log(measured[at] / calculated[order[at] - 1])
    shift = float(np.median(away)) if len(away) else 0.0
    if len(measured) == 0:
        return Pairing(order, 0.0, 0.0, 0.0)
    range_ = math.log(measured.max() / measured.min()) + ALONE
    strays = int(np.sum(~at)) * math.log(STRAY / range_)
    modes = len(away) * math.log(1 - MISSED) + _missed(order)
    if len(away) == 0:
        return Pairing(order, shift, 0.0, strays)
    near = FARTHEST * (float(np.median(np.abs(away - shift))) + float(SCATTER[0]))
    square = SCATTER[:, None] ** 2 + np.nan_to_num(std[at] / measured[at]) ** 2
    normal = np.exp(-((away - shift) ** 2) / (2 * square)) / np.sqrt(2 * np.pi * square)
    fit = np.log((1 - ASTRAY) * normal + ASTRAY / ALONE).sum(axis=1)
    told = np.sqrt(1 / (1 / square).sum(axis=1)) / math.hypot(FACTOR, SCATTER[-1])
    each = fit + np.log(np.minimum(told, 1.0)) - shift**2 / (2 * FACTOR**2)
    log = float(each.max() + np.log(np.mean(np.exp(each - each.max()))))
    return Pairing(order, shift, near, log + strays + modes)


def _missed(order: Integer) -> float:
    """Return the logarithm of how often modes below the highest show no peak."""
    number = np.arange(1, order.max(initial=0) + 1)
    gone = number[~np.isin(number, order)]
    each = len(gone) * math.log(MISSED)
    every_second = any(np.array_equal(gone, number[first::2]) for first in (0, 1))
    return max(each, math.log(HALVED)) if every_second else each
