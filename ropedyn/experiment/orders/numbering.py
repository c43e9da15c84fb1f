"""Which mode each peak is: numberings by their evidence."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ...base import check
from ...base.array import Flags, Index, Integer, Real
from ...base.errors import SceneError
from ...scene.scene import Scene
from .chances import AS_MODE, Chances
from .evidence import Evidence
from .search import SortedPeaks, search
from .sensed import Sensed
from .standardised import Standardised

SAME = 0.05  # Numberings whose tensions differ by less mean the same.
SURE = 0.95  # An order that a smaller share of these has is left out.
LEAST = 2  # Orders tell a tension if they are so many.
UNLIKELY = 1e-6  # What is less probable is not named.
MODES, MOST_MODES = 20, 80  # Each peak may be one of so many, at least and at most,
BEYOND = 6  # and so many more may be there unseen.
FINER = 1.5  # Modes are at most so many times closer than peaks are.
TRUSTED, RIVAL, ENOUGH = 0.95, 0.05, 3
"""Of what is trusted: its probability, the share of it no other has, and peaks that are modes."""


@dataclass(frozen=True, eq=False)
class Numbering:
    """One way to see peaks as modes."""

    orders: tuple[int, ...]  # of each peak from 1; 0 where it is no mode, or which is not certain
    probability: float  # with all numberings that mean the same tension
    ln_evidence: float  # of these together
    value: tuple[float, ...]  # rough numbers of the unknown paths: the start of a fit


def numberings(
    scene: Scene,
    unknown: Sequence[str],
    frequency: ArrayLike,
    std: ArrayLike | None,
    *,
    prior: Mapping[str, tuple[float, float]] | None = None,
    ends: str = "unknown",
    sensors: Sequence[tuple[str, float]] | None = None,
    shape: ArrayLike | None = None,
    kind: Sequence[str] | None = None,
    model_std: float = 0.0,
    elements: int | None = None,
    element: str | None = None,
) -> tuple[Numbering, ...]:
    """Find which mode each peak is, the likeliest first; none where peaks show no modes.

    `frequency` and `std` [Hz], `kind` and rows of `shape`, a column for each sensor, are of peaks.
    """
    check.one_of(ends, "ends", ("unknown", "given"))
    measured = np.asarray(frequency, dtype=float)
    if len(measured) < LEAST:
        return ()
    order = np.argsort(measured, kind="stable")
    kinds = np.array(["mode"] * len(order) if kind is None else list(kind))[order]
    noise = None if std is None else np.asarray(std, dtype=float)[order]
    peaks = SortedPeaks.of(measured[order], noise, kinds == "double", model_std)
    shapes = None if shape is None else np.asarray(shape)[order]
    chances = _chances(scene, measured[order], kinds, sensors, shapes)
    standardised = Standardised.of(
        scene,
        unknown,
        prior or {},
        any_ends=ends == "unknown",
        elements=elements,
        element=element,
    )
    found = search(standardised, peaks, chances)
    none = float(chances(np.zeros((1, len(order)), dtype=np.int64))[0])
    return _clusters(found, standardised, none, len(unknown), np.argsort(order))


def decided(found: Sequence[Numbering]) -> str:
    """Say whether one numbering can be trusted, several are possible, or peaks show no modes.

    "trusted" has three modes, more than 95 % of the probability, and no rival of a twentieth of it.
    """
    if not found or sum(n > 0 for n in found[0].orders) < LEAST:
        return "refused"
    best, *others = found
    alone = all(one.probability < RIVAL * best.probability for one in others)
    enough = sum(n > 0 for n in best.orders) >= ENOUGH
    return "trusted" if best.probability > TRUSTED and alone and enough else "ambiguous"


def _chances(
    scene: Scene,
    frequency: Real,
    kinds: np.ndarray[Any, Any],
    sensors: Sequence[tuple[str, float]] | None,
    shapes: np.ndarray[Any, Any] | None,
) -> Chances:
    """Return what is known of modes and strays before frequencies are compared."""
    count, k = _modes(frequency), len(frequency)
    visible, of_mode = np.ones(count), np.zeros((k, count))
    if shapes is not None and shapes.shape != (k, len(sensors or ())):
        raise SceneError(
            f"shape must have a row for each of {k} peaks and a column for each of "
            f"{len(sensors or ())} sensors, got shape {shapes.shape}"
        )
    if sensors:
        sensed = Sensed.of(scene, sensors, count)
        visible = sensed.visible
        if shapes is not None:
            of_mode = sensed.likeness(shapes)
    for i, kind in enumerate(kinds.tolist()):
        of_mode[i] += np.log(AS_MODE[check.one_of(kind, f"kind[{i}]", tuple(AS_MODE))])
    return Chances.of(visible, frequency, of_mode)


def _modes(frequency: Real) -> int:
    """Return how many modes to look at: the usual distance of peaks may be that of modes."""
    gap = float(np.median(np.diff(frequency)))
    asked = FINER * float(frequency[-1]) / max(gap, float(frequency[-1]) / MOST_MODES)
    return int(np.clip(np.ceil(asked), MODES, MOST_MODES)) + BEYOND


def _clusters(
    found: Evidence, standardised: Standardised, none: float, unknown: int, back: Index
) -> tuple[Numbering, ...]:
    """Join what means the same, and drop what is unlikely; none if that no peak is a mode is not.

    Of an order that not all of these share it is the share that counts: a peak that is perhaps a
    stray does not divide them, and is left out.
    """
    if not len(found.orders) or found.likelihood[0] <= none:
        return ()
    total = np.logaddexp(np.logaddexp.reduce(found.likelihood), none)
    u, value = standardised.lead_of(found.v), standardised.value(found.v)
    left = np.ones(len(u), dtype=bool)
    numbered: list[Numbering] = []
    while left.any():
        first = int(left.argmax())
        orders, likelihood = found.orders[first], found.likelihood
        same = left & ((np.abs(u - u[first]) < SAME) | _nested(found.orders, orders))
        share = np.exp(likelihood[same] - np.logaddexp.reduce(likelihood[same]))
        certain = share @ (found.orders[same] == orders) >= SURE
        if np.count_nonzero(orders[certain]) < LEAST:
            # these do not agree: each is named alone
            same, certain = np.arange(len(u)) == first, np.ones(len(orders), dtype=bool)
        left &= ~same
        ln = float(np.logaddexp.reduce(likelihood[same]))
        numbered.append(
            Numbering(
                orders=tuple(np.where(certain, orders, 0)[back].tolist()),
                probability=float(np.exp(ln - total)),
                ln_evidence=ln,
                value=tuple(value[first, :unknown].tolist()),
            )
        )
    ranked = sorted(numbered, key=lambda one: -one.ln_evidence)
    return tuple(one for one in ranked if one is ranked[0] or one.probability > UNLIKELY)


def _nested(orders: Integer, one: Integer) -> Flags:
    """Say which orders differ from one only by peaks that either leaves out, shape (h,)."""
    seen, there = orders > 0, one > 0
    more, fewer = (seen >= there).all(axis=1), (seen <= there).all(axis=1)
    return (more | fewer) & ((orders == one) | ~(seen & there)).all(axis=1)
