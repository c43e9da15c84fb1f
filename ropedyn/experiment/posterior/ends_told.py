"""What peaks say of the ends of a rope."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...base.answer import Frozen, axes
from ...base.array import Real
from .limits import best_with
from .ridge import Cloud, Ridge
from .space import SOFTEST, Fixed
from .task import PosteriorTask

STEPS_OF_FIXITY = 10
"""Steps between pinned and clamped at which the likelihood is told."""

AS_LIKELY = 20.0
"""Ends that are less likely by this factor are told from others."""

WORDS: tuple[Fixed, ...] = ("pinned", "clamped")


@dataclass(frozen=True, eq=False)
class EndsTold(Frozen):
    """Likelihood of fixities, c/(1 + c) with c = kappa/sqrt(T B): 0 is pinned, 1 is clamped.

    Attributes
    ----------
    fixity : ndarray, shape (b,)
        Middles of steps from 0 to 1; nothing where no end is unknown.
    likelihood : ndarray, shape (ends, b)
        ln of the likelihood of each unknown end, the most likely step 0; -inf where no point is.
    number : ndarray, shape (2,)
        The first unknown with both ends pinned, and with both clamped; NaN without a rope.
    relative : ndarray, shape (2,)
        ln of the likelihood of these two, over that of the likeliest ends.
    """

    fixity: Real = field(metadata=axes("fixity"))
    likelihood: Real = field(metadata=axes("end", "fixity"))
    number: Real = field(metadata=axes("limit"))
    relative: Real = field(metadata=axes("limit"))

    @property
    def told(self) -> bool:
        """Whether the peaks tell pinned from clamped ends."""
        pinned, clamped = self.relative
        return bool(abs(pinned - clamped) > np.log(AS_LIKELY))

    def words(self, unit: str) -> str:
        """Say whether the peaks tell the ends, and the number with either; "" without ends.

        Examples
        --------
        >>> import numpy as np
        >>> found = EndsTold(np.empty(0), np.empty((0, 0)), np.array([5.05e6, 4.92e6]), np.zeros(2))
        >>> found.words("N")
        'not told by the peaks (pinned alone 5.05e+06 N, clamped alone 4.92e+06 N)'
        """
        if not np.isfinite(self.number).any():
            return ""
        alone = ", ".join(
            f"{word} alone {x:.4g} {unit}".rstrip() for word, x in zip(WORDS, self.number)
        )
        if not self.told:
            far = self.relative.max() < -np.log(AS_LIKELY)
            return f"{'neither pinned nor clamped' if far else 'not told by the peaks'} ({alone})"
        worse = int(np.argmin(self.relative))
        times = np.exp(self.relative[worse] - self.relative[1 - worse])
        return (
            f"{WORDS[worse]} ends are {times:.1g} times as likely as {WORDS[1 - worse]} ({alone})"
        )


def ends_told(
    task: PosteriorTask, ridge: Ridge, cloud: Cloud, rng: np.random.Generator
) -> EndsTold:
    """Count points by fixity, and find the likeliest rope with either limit."""
    space = ridge.space
    if not space.springs:
        return EndsTold(np.empty(0), np.empty((0, 0)), np.full(2, np.nan), np.full(2, np.nan))
    best = float((cloud.base + cloud.likelihood).max())
    number, relative = np.full(2, np.nan), np.full(2, -np.inf)
    for i, word in enumerate(WORDS):
        limit = best_with(task, word, rng)
        if limit is not None:
            number[i] = limit.ridge.numbers(limit.cloud, task.unknown)[0][0, 0]
            relative[i] = float(limit.cloud.base[0] + limit.cloud.likelihood[0])
    fixity, likelihood = _by_fixity(cloud.u[:, list(space.springs)])
    return EndsTold(fixity, likelihood, number, relative - max(best, float(relative.max())))


def _by_fixity(log_c: Real) -> tuple[Real, Real]:
    """Return middles of steps, and ln of the points there over those beforehand."""
    edge = np.linspace(0.0, 1.0, STEPS_OF_FIXITY + 1)
    with np.errstate(divide="ignore"):
        at = np.clip(np.log(edge) - np.log1p(-edge), SOFTEST, -SOFTEST)
        counts = np.array([np.histogram(one, at)[0] for one in log_c.T])
        likelihood = np.log(counts / np.diff(at))
    return (edge[1:] + edge[:-1]) / 2, likelihood - likelihood.max(axis=1, keepdims=True)
