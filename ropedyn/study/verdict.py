"""What the price of accuracy amounts to, in two sentences."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..base.unit import duration, power

if TYPE_CHECKING:
    from .accuracy import AccuracyCost

ASKED = (1e-3, 1e-6, 1e-12)  # What to take is said for each of them.
ROUGH = 0.1  # A way that is off by more is no answer, however little it takes.


def verdict_of(cost: AccuracyCost) -> str:
    """Say what to take for each accuracy, and what the cheapest way would save and cost."""
    missed = [power(tolerance) for tolerance in ASKED if cost.cheapest_within(tolerance) is None]
    reached = ASKED[: len(ASKED) - len(missed)]
    if not reached:
        return f"Nothing that was tried is right to {power(ASKED[0])}."
    # a way that noise cannot part from a better one is that one
    best = cost.cheapest_within(reached[-1])
    assert best is not None
    row, taken = best, dict[int, list[str]]()
    for tolerance in reversed(reached):
        faster = _quicker(cost, row, tolerance)
        row = row if faster is None else faster
        taken.setdefault(row, []).insert(0, power(tolerance))
    parts = [
        f"for {'' if k else 'a relative error of '}{_and(of)}{'' if k else ' take'} "
        f"{_in_words(cost, row)} ({_told(cost, row)})"
        for k, (row, of) in enumerate(reversed(taken.items()))
    ]
    least = f"; nothing that was tried is right to {' or '.join(missed)}" if missed else ""
    return f"{_capital(_and(parts))}{least}. {_cheaper(cost, best)}"


def _quicker(cost: AccuracyCost, row: int, tolerance: float) -> int | None:
    """Return the row that takes less than another one for sure, if any is within a tolerance."""
    soonest = cost.compile_seconds[row] + cost.lower_quartile[row]
    return cost.cheapest_within(tolerance, before=float(soonest))


def _told(cost: AccuracyCost, row: int) -> str:
    """Say what a row takes, and how wrong it is."""
    count, part = cost.parts, cost.part
    each = f", {duration(cost.total_seconds[row] / count)} a {part}" if part else ""
    bound = cost.compile_seconds[row] + cost.seconds_with_bound[row]
    told = "" if np.isnan(bound) else f", with an error bar {duration(bound)}"
    return f"{duration(cost.total_seconds[row])}{each}{told}, off by {cost.error[row]:.1g}"


def _cheaper(cost: AccuracyCost, best: int) -> str:
    """Say what the cheapest way saves and costs beside the best one that is taken."""
    rough = _quicker(cost, best, ROUGH)
    if rough is None:
        return "Nothing that was tried is faster beyond the noise of the times."
    saved = cost.total_seconds[best] - cost.total_seconds[rough]
    digits = float(np.log10(cost.error[rough] / cost.error[best]))
    many = not _in_words(cost, rough).startswith("1 ")
    does = ("save", "cost", "they are") if many else ("saves", "costs", "it is")
    words = f"{_in_words(cost, rough)} {does[0]} {duration(saved)}"
    lost = f" and {does[1]} {digits:.0f} digits" if digits >= 0.5 else ""
    return f"{_capital(words)}{lost}{_with_bound(cost, rough, best, does[2])}."


def _with_bound(cost: AccuracyCost, rough: int, best: int, they: str) -> str:
    """Say how both compare when the error bar is read too."""
    with_bound = cost.compile_seconds + cost.seconds_with_bound
    if np.isnan(with_bound[[rough, best]]).any():
        return ", without an error bar" if np.isnan(with_bound[rough]) else ""
    slower = with_bound[rough] > with_bound[best]
    times = f"{duration(with_bound[rough])} to {duration(with_bound[best])}"
    return f"; with an error bar {they} {'slower' if slower else 'faster still'}, {times}"


def _in_words(cost: AccuracyCost, row: int) -> str:
    """Say which way a row is, as in a sentence."""
    solver = "" if cost.solver[row] in ("sweep", "auto") else f" by {cost.solver[row]}"
    if cost.element[row] == "continuous":
        return f"continuous spans{solver}"
    n = cost.elements[row]
    return f"{n} {cost.element[row]} element{'s' * bool(n > 1)}{solver}"


def _and(words: list[str]) -> str:
    return " and ".join([", ".join(words[:-1]), words[-1]] if len(words) > 1 else words)


def _capital(words: str) -> str:
    return words[0].upper() + words[1:]
