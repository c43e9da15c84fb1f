"""Other ends of a rope that its peaks may fit as well."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...base.errors import RopedynError
from ...scene.scene import Scene
from .fit import Alternative, Fit
from .solution import LEAST_NOISE

WORDS = ("pinned", "clamped")  # Ends that are tried in place of each other.
LEVEL = 0.95  # Level of the test whether something fits worse.


def alternatives_of(
    fit: Fit, scene: Scene, instead: Callable[[Scene], Fit]
) -> tuple[Alternative, ...]:
    """Fit with both ends pinned and with both clamped, where the scene's are such words."""
    if "beta" not in scene.coordinates or not all(end in WORDS for end in scene.ends):
        return ()
    found = []
    for word in WORDS:
        if scene.ends != (word, word):
            try:
                other = instead(_guess(fit, scene, word))
            except RopedynError:
                continue
            found.append(Alternative(word, other, _verdict(fit, other), _change(fit, other)))
    return tuple(found)


def _change(fit: Fit, other: Fit) -> dict[str, float]:
    """Return relative changes of the numbers that both tell."""
    before, after = dict(fit.value), dict(other.value)
    told = np.isfinite(fit.std) & np.isfinite(other.std)
    return {
        path: float(after[path] / before[path] - 1) for path, one in zip(fit.unknown, told) if one
    }


def _guess(fit: Fit, scene: Scene, word: str) -> Scene:
    """Return the scene with other ends and, where nothing went to 0 or infinity, what was found."""
    found = scene if fit.value_is_bound else fit.scene
    return found.replace(ends=(word, word))


def _verdict(fit: Fit, other: Fit) -> str:
    """Say how another fit compares, by chi-square or, where the noise is not known, by F."""
    from scipy.special import chdtri, fdtri

    if fit.freedom is None:
        most = float(chdtri(1, 1 - LEVEL))
        return _said(other.chi_square - fit.chi_square, -most, most)
    if fit.freedom < 0.5:
        return "as well"
    most = float(fdtri(fit.freedom, fit.freedom, LEVEL))
    return _said((other.rms / max(fit.rms, LEAST_NOISE)) ** 2, 1 / most, most)


def _said(value: float, low: float, high: float) -> str:
    if value > high:
        return "worse"
    return "better" if value < low else "as well"
