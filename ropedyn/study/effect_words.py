"""What effects change and cost, in words."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from ..base.array import Flags

if TYPE_CHECKING:
    from .effect import EffectCost


BESIDE = {"damping ratio": ("damping ratio [1]", ""), "phase": ("phase [deg]", " deg")}
"""What can change alone: as which of the changes it is kept, and its unit in words."""


def matters(cost: EffectCost, row: int) -> str:
    """Say whether an effect changes the answer."""
    if cost.refusal[row]:
        return "no answer without it"
    if not cost.seen[row]:
        return "not seen by this question"
    what = str(cost.changed[row])
    if cost.beyond_error[row]:
        return f"yes: {what}" if what else "yes"
    if np.isinf(cost.error[row]):
        told = f"probably: {what}; not all" if what else "not told: not all"
        return f"{told} error bars are known"
    if cost.unsure[row]:
        return "not told: modes could have other partners"
    return f"none beyond {'' if cost.way.startswith('continuous') else 'mesh and '}rounding"


def verdict(cost: EffectCost) -> str:
    """Say which effects matter for a question, and which are paid for nothing."""
    return f"{_needed(cost)} {_idle(cost)}"


def _needed(cost: EffectCost) -> str:
    likely = ~cost.beyond_error & np.isinf(cost.error) & (cost.changed != "") & cost.seen
    need, more = (_with_sizes(cost, which) for which in (cost.beyond_error, likely))
    said = [f"what matters is {need or 'nothing that can be left out'}"]
    if more:
        sure = f"what matters is {need}, and probably" if need else "what matters is probably"
        said = [f"{sure} {more}, whose error bars are not all known"]
    if (cost.refusal != "").any():
        refused = _listed(cost.effect[cost.refusal != ""], "or")
        said.append(f"without {refused} there is no answer")
    return f"For {cost.question} {'; '.join(said)}."


def _with_sizes(cost: EffectCost, which: Flags) -> str:
    """Name effects, those that change most first, and by how much each changes the answer."""
    weight = np.where(np.isnan(cost.largest), np.inf, cost.largest)
    rows = [row for row in np.argsort(-weight, kind="stable") if which[row]]
    return _listed(f"{cost.effect[row]} ({_size(cost, row)})" for row in rows)


def _size(cost: EffectCost, row: int) -> str:
    """Say by how much an effect changes an answer."""
    unit = next(iter(cost.change)).partition(" ")[2]
    said = []
    if set(str(cost.changed[row]).split(", ")) - {"", *BESIDE}:
        said.append(f"{cost.largest[row]:.3g} {unit.strip('[]')}")
    said += beside(cost, row)
    if lost := int(cost.only_with[row]):
        said.append(f"{lost} only with it")
    return ", ".join(said) or "other values"


def beside(cost: EffectCost, row: int) -> list[str]:
    """Say by how much an effect changes what is not in the largest change."""
    changed = str(cost.changed[row]).split(", ")
    return [
        f"{name} {cost.change[measure][row]:.3g}{unit}"
        for name, (measure, unit) in BESIDE.items()
        if name in changed
    ]


def _idle(cost: EffectCost) -> str:
    """Say what is paid for nothing, what costs nothing, and what is not told."""
    open_ = (cost.refusal == "") & ~cost.beyond_error
    told = np.isfinite(cost.error) & (cost.unsure == 0)
    idle = open_ & cost.seen & told
    paid = np.flatnonzero(idle & (cost.costs == "more"))
    free = cost.effect[idle & (cost.costs != "more")]
    said = ["nothing is paid for nothing"]
    if len(paid):
        shares = [f"{cost.effect[row]} ({100 * cost.share[row]:.0f} % of the time)" for row in paid]
        said = [f"paid for nothing {'is' if len(paid) == 1 else 'are'} {_listed(shares)}"]
    if len(free):
        said.append(f"{_listed(free)} change{'s' * (len(free) == 1)} nothing and cost nothing")
    unseen = cost.effect[open_ & ~cost.seen]
    if len(unseen):
        said.append(f"it cannot tell {_listed(unseen, 'or')}, which motion can")
    blurred = cost.effect[open_ & cost.seen & ~told & (cost.changed == "")]
    if len(blurred):
        said.append(f"of {_listed(blurred)} it is not told")
    text = "; ".join(said)
    return f"{text[0].upper()}{text[1:]}."


def _listed(names: Iterable[str], last: str = "and") -> str:
    """Return names in a row: a, b and c; or nothing."""
    *front, end = list(names) or [""]
    return f"{', '.join(front)} {last} {end}" if front else str(end)
