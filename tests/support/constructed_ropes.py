"""Ropes of constructions at random, a few of whose peaks are known: what a prior tells of them."""

import numpy as np

import ropedyn as rd

NAMES = ("1x19", "7x7", "6x19S", "6x36WS")
UNKNOWN = ["tension", "bending_stiffness"]


def constructed(seed, peaks):
    """Return a guess, the truth, some of its eight lowest peaks, their orders, and the prior.

    The truth has the bending stiffness of one of the sections that the catalogue line may mean.
    """
    random = np.random.default_rng(seed)
    name, d = NAMES[random.integers(len(NAMES))], random.uniform(6e-3, 30e-3)
    section = rd.Construction.standard(name, diameter=d).section()
    may_be = section.spread(400, seed=seed).bending_stiffness
    length = random.uniform(60, 250) * d
    tension = section.area * random.uniform(50e6, 500e6)
    rope = rd.Rope(length, section.mass, bending_stiffness=float(np.exp(np.log(may_be).mean())))
    guess = rd.Scene(rope, tension=tension * np.exp(0.5 * random.standard_normal()))
    bending = float(may_be[random.integers(len(may_be))])
    truth = guess.replace(tension=tension, rope=rope.replace(bending_stiffness=bending))
    seen = np.sort(random.choice(8, size=peaks, replace=False))
    noise = 10 ** random.uniform(-3.3, -2.3)
    frequency = truth.compile().modes(8).frequency[seen]
    measured = rd.Peaks(
        frequency * (1 + noise * random.standard_normal(peaks)), std=noise * frequency
    )
    prior = section.priors(n=2000).marginal(["bending_stiffness"])
    return guess, truth, measured, seen + 1, prior


def told(seed, peaks=4):
    """Return without the prior and with it: status, whether orders are right, widths, inside."""
    guess, truth, measured, orders, prior = constructed(seed, peaks)
    rows = []
    for known in (None, prior):
        fit = rd.identify(guess, measured, UNKNOWN, ends="given", prior=known)
        used = fit.orders > 0
        right = bool(used.any() and (fit.orders == orders)[used].all())
        bounds = np.full((2, 2), np.nan)
        if fit.status == "trusted":
            bounds = np.array(fit.interval(0.95))
        exact = np.array([truth.tension, truth.rope.bending_stiffness])
        inside = (bounds[:, 0] < exact) & (exact < bounds[:, 1])
        rows.append((fit.status, right, np.diff(bounds)[:, 0] / exact, inside))
    return rows
