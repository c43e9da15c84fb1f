"""What a fit says beside its numbers when it is read: other ends, and formulas of the field."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from ...base.answer import Frozen, axes
from ...base.array import Real
from ...base.errors import RopedynError
from ...scene.scene import Scene
from ..fitting.solution import LEAST_NOISE
from .told import Told

WORDS = ("pinned", "clamped")
"""Ends that are tried in place of those that were given."""
LEVEL = 0.95
"""Level of the test whether something fits worse."""


@dataclass(frozen=True, eq=False)
class Remarks(Frozen):
    """Sentences that cost something."""

    said_of_ends: tuple[str, ...] = ()
    cross_checks: tuple[str, ...] = ()
    said_of_prior: tuple[str, ...] = ()
    fixity: Real | None = field(default=None, metadata=axes("fixity"))
    likelihood_of_fixity: Real | None = field(default=None, metadata=axes("end", "fixity"))


def other_ends(scene: Scene, unknown: tuple[str, ...], tell: Callable[[Scene], Told]) -> list[str]:
    """Say what both ends pinned and both clamped would tell of the same peaks."""
    axis = scene.rope.axis
    has_none = "beta" not in scene.coordinates or (axis is not None and axis.closed)
    if has_none or any("ends[" in path for path in unknown):
        return []
    first = tell(scene)
    shown = [end if isinstance(end, str) else "as described" for end in scene.ends]
    said = [" and ".join(shown)]
    for word in WORDS:
        if scene.ends != (word, word):
            try:
                other = tell(scene.replace(ends=(word, word)))
            except RopedynError as error:
                said.append(f"{word} ends do not fit ({error})")
            else:
                said.append(_compared(word, unknown, first, other))
    return said


def _compared(word: str, unknown: tuple[str, ...], first: Told, other: Told) -> str:
    """Say how other ends fit, and what they change."""
    verdict = _verdict(first, other)
    told = np.isfinite(first.std) & np.isfinite(other.std) & (first.value != 0)
    each = [
        f"{path} {100 * (there / here - 1):+.2g} %"
        for path, here, there, there_is in zip(unknown, first.value, other.value, told)
        if there_is
    ]
    but = "but" if verdict == "as well" else "and"
    return f"{word} ends fit {verdict}" + (f" {but} give {', '.join(each)}" if each else "")


def _verdict(first: Told, other: Told) -> str:
    """Say how another fit compares, by chi-square or, where the noise is not known, by F."""
    from scipy.special import chdtri, fdtri

    if not np.isnan(first.probability):
        most = float(chdtri(1, 1 - LEVEL))
        return _said(other.chi_square - first.chi_square, -most, most)
    if first.freedom is None or first.freedom < 0.5:
        return "as well"
    most = float(fdtri(first.freedom, first.freedom, LEVEL))
    ratio = _rms(other) / max(_rms(first), LEAST_NOISE)
    return _said(ratio**2, 1 / most, most)


def _rms(told: Told) -> float:
    """Return the root mean square of relative residuals."""
    off: Real = (told.residual / told.calculated)[~np.isnan(told.calculated)]
    return float(np.sqrt(np.mean(off**2)))


def _said(value: float, low: float, high: float) -> str:
    if value > high:
        return "worse"
    return "better" if value < low else "as well"
