"""What a posterior takes for granted, and what it does not know, in words."""

from __future__ import annotations

import numpy as np

from ...base.array import Real
from ...scene.path import unit_of, value_at
from .ridge import Cloud, Ridge
from .space import LIMITS, SOFTEST, SPRINGS, STIFFNESS, TENSION, TIED, Space
from .task import FLOOR, NOISE, PosteriorTask
from .tempering import Tempered

EXACT = ("linear_density", "length", "bending_stiffness")
"""Numbers whose uncertainty users forget, known exactly where nothing is said of them."""

UNLIKELY = 0.01
"""Probability of a fit so bad that it is noted."""

SLUGGISH = 0.02
"""Share of accepted moves below which the points may not have settled."""


def assumed(task: PosteriorTask, space: Space) -> tuple[str, ...]:
    """Return everything that was taken for granted."""
    said = [*_of_tension(space), *_of_stiffness(space), *_of_ends(task, space)]
    said += space.belief.said
    rope = task.scene.rope
    known = [
        path for path in EXACT if path not in space.paths and getattr(rope, path, None) is not None
    ]
    said += [f"{p} {value_at(task.scene, p):.6g} {unit_of(p)}, exactly" for p in known]
    return (*said, _of_noise(task))


def _of_tension(space: Space) -> list[str]:
    if space.about_tension is not None:
        return [space.about_tension.only([TENSION]).said[0]]
    if space.pivot:
        return ["tension of any size, its logarithm uniform"]
    return [] if TENSION in space.paths else [f"tension {space.tension:.6g} N, exactly"]


def _of_stiffness(space: Space) -> list[str]:
    if not space.stiff:
        return []
    low, high = np.exp(LIMITS)
    return [f"lambda = T L^2/B from {low:.3g} to {high:.3g}, its logarithm uniform"]


def _of_ends(task: PosteriorTask, space: Space) -> list[str]:
    if not space.springs:
        return ["ends as the scene has them, exactly"] if "beta" in task.scene.coordinates else []
    loose = [i for i, path in enumerate(SPRINGS) if path in space.paths]
    low = np.exp(SOFTEST)
    each = f"from {low:.3g} to {1 / low:.3g} sqrt(T B), its logarithm uniform"
    if space.tieable:
        alike = f"alike with probability {TIED:g}"
        return [f"a rotational spring at both ends, {each}, {alike}"]
    return [f"a rotational spring at end {i}, {each}" for i in loose]


def _of_noise(task: PosteriorTask) -> str:
    known = f"known as of {task.freedom:g} degrees of freedom"
    if task.std is None:
        said = f"noise of the peaks estimated, about {100 * NOISE:.2g} % of each before, {known}"
    else:
        said = f"std of the peaks as given, at least {100 * FLOOR:.2g} % of each, {known}"
    return said + (f"; the model off by {100 * task.model_std:.3g} %" if task.model_std else "")


def notes_of(
    task: PosteriorTask, found: Tempered, ridge: Ridge, reaches: Real, probability: float
) -> tuple[str, ...]:
    """Return what the peaks cannot tell, and where the answer is doubtful."""
    notes = []
    for path, (low, high) in zip(task.unknown, reaches):
        if low > 0 or high < 1:
            side = "from 0" if high == 1 else "to infinity" if low == 0 else "either way"
            notes.append(f"the peaks do not limit {path} {side}: only what is assumed does")
    if probability < UNLIKELY:
        notes.append(
            f"the peaks fit worse than their std allow (probability {probability:.1g}): "
            "the interval is wider for it"
        )
    if ridge.space.size and found.accepted < SLUGGISH:
        notes.append(
            f"the points moved little at last ({100 * found.accepted:.1g} % of the moves): "
            "the interval may be too narrow"
        )
    if not ridge.family.closed:
        notes.append(
            f"the scene has no closed form: {len(found.cloud)} points alone, bounds that are off "
            "by some percent of the interval by chance"
        )
    if found.refused > 0:
        share = f"{100 * found.refused:.2g} %"
        notes.append(f"{share} of what was assumed beforehand is no rope that can be solved")
    return tuple(notes)


def limit_shares(space: Space, cloud: Cloud, unknown: tuple[str, ...]) -> Real:
    """Return shares of the points at limits that only what is assumed sets, shape (p, 2).

    A variable reaches a limit where its last sixteenth before it holds a quarter as many points as
    beforehand.
    """
    shares = np.tile([0.0, 1.0], (len(unknown), 1))
    for i, path in enumerate(unknown):
        column, sign = _uniform(space, path)
        if column is None:
            continue
        part = (cloud.u[:, column] - space.low[column]) / (space.high - space.low)[column]
        part = part if sign > 0 else 1 - part
        low, high = float((part < 1 / 16).mean()), float((part > 15 / 16).mean())
        shares[i] = low if low > 1 / 64 else 0.0, 1 - high if high > 1 / 64 else 1.0
    return shares


def _uniform(space: Space, path: str) -> tuple[int | None, float]:
    """Return the uniform variable that limits a number, and which way it leads."""
    if path == STIFFNESS and space.stiff:
        return 0, -1.0
    sampled = [p for p in space.paths if p in SPRINGS and p not in space.belief.paths]
    if path in sampled and space.springs:
        return space.springs[sampled.index(path)], 1.0
    return None, 1.0
