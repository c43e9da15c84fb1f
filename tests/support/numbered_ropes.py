"""Peaks of made ropes with strays and modes that nobody saw, and what a numbering makes of them.

Ropes of 2 to 60 m, ends pinned, clamped or on springs of 0.01 to 100 sqrt(T B), T L^2/B from 50 to
1e7, noise of 0.05 to 1 %; tension and stiffness are guessed within a factor of 3.
"""

import time
from dataclasses import dataclass

import numpy as np
from tensed_beam import frequencies

import ropedyn as rd
from ropedyn.experiment.orders.numbering import decided, numberings

BOTH = ("tension", "bending_stiffness")
FACTOR = 3.0
"""Guesses are off by at most so much, their logarithms uniform."""
TOLD = 4.0
"""A stray peak nearer to an unseen mode, in standard deviations of noise, is that mode to all."""
MAINS = 50.0
"""[Hz]."""


@dataclass(frozen=True)
class Case:
    """A rope, its peaks, and which mode each is."""

    scene: rd.Scene  # with guesses
    frequency: np.ndarray  # [Hz]
    std: np.ndarray  # [Hz]
    orders: np.ndarray  # from 1; 0 of strays
    exact: np.ndarray  # of all modes up to the highest [Hz]
    tension: float  # [N]

    @property
    def missing(self):
        """How many modes below the highest that is seen are not."""
        return self.orders.max() - np.count_nonzero(self.orders)


def made(rng, *, seen=None, strays=0, hum=False, missing=0, step=1, sprung=False):
    """Every `step`-th of the lowest modes but some, with noise, strays and hum or its alias.

    `sprung`: no end is pinned or clamped.
    """
    length, density = rng.uniform(2, 60), rng.uniform(0.5, 60)
    tension, ratio = 10 ** rng.uniform(3, 7), 10 ** rng.uniform(np.log10(50), 7)
    bending = tension * length**2 / ratio
    ends = [(0.0, 0.0), (np.inf, np.inf), tuple(10 ** rng.uniform(-2, 2, 2))]
    ends = ends[2 if sprung else rng.integers(3)]
    springs = tuple(c * np.sqrt(tension * bending) for c in ends)
    number = (int(rng.integers(4, 11)) if seen is None else seen) + missing
    exact = frequencies(
        step * number,
        length=length,
        density=density,
        tension=tension,
        bending=bending,
        springs=springs,
    )
    orders = step * (1 + np.delete(np.arange(number), rng.choice(number, missing, replace=False)))
    noise = 10 ** rng.uniform(np.log10(5e-4), -2)
    peaks = exact[orders - 1] * (1 + noise * rng.standard_normal(len(orders)))
    low, high = 0.5 * peaks.min(), 1.1 * peaks.max()
    others = list(np.exp(rng.uniform(np.log(low), np.log(high), strays)))
    rate = 2.2 * high
    alias = abs(MAINS - rate * np.round(MAINS / rate))
    if hum and low < alias < high:
        others.append(alias)
    peaks, orders = np.append(peaks, others), np.append(orders, np.zeros(len(others), dtype=int))
    order = np.argsort(peaks)
    off = FACTOR ** rng.uniform(-1, 1, 2)
    rope = rd.Rope(length, density, bending_stiffness=bending * off[1])
    scene = rd.Scene(rope, tension=tension * off[0], ends=("clamped", "clamped"))
    return Case(scene, peaks[order], noise * peaks[order], orders[order], exact, tension)


def mixed(rng, **options):
    """Any rope: strays, hum and modes that nobody saw."""
    return made(
        rng,
        strays=int(rng.integers(4)),
        hum=bool(rng.integers(2)),
        missing=int(rng.integers(4)),
        **options,
    )


def wrong(case, orders):
    """Whether some peak has an order that is not its own, and could be told."""
    at = np.flatnonzero((orders > 0) & (orders != case.orders))
    stray = at[case.orders[at] == 0]
    if len(stray) < len(at):
        return True
    beyond = orders[stray] > len(case.exact)
    off = np.abs(case.frequency[stray] - case.exact[np.where(beyond, 1, orders[stray]) - 1])
    return bool((~beyond & (off > TOLD * case.std[stray])).any())


@dataclass(frozen=True)
class Tally:
    """What became of many ropes, as shares of them."""

    wrong: float  # trusted, and an order is not that of the peak
    ambiguous: float
    refused: float
    seconds: float  # in the median


def tally(cases, std=True):
    """Number the peaks of ropes."""
    status, silent, seconds = [], [], []
    for case in cases:
        start = time.perf_counter()
        found = numberings(case.scene, BOTH, case.frequency, case.std if std else None)
        seconds.append(time.perf_counter() - start)
        status.append(decided(found))
        silent.append(status[-1] == "trusted" and wrong(case, np.array(found[0].orders)))
    shares = [np.mean([one == word for one in status]) for word in ("ambiguous", "refused")]
    return Tally(float(np.mean(silent)), *map(float, shares), float(np.median(seconds)))
