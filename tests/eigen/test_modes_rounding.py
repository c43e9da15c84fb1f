"""`rounding_error` of modes bounds the true error and is no useless bound: random scenes."""

import dataclasses

import numpy as np
import pytest
from exact_counts import ExactChain, eigenvalue_bound, exact_chain, is_bounded
from exact_scene import places
from random_scene import random_scene

import ropedyn as rd

EPS = float(np.finfo(float).eps)
ELEMENTS = (1, 2, 3, 4, 5, 8, 12, 20, 33)
MOST = 6
"""Modes of a scene."""

EXACT = "counts in 80 digits: tests/support/exact_counts.py"
FEW, MANY = 100, 2500
"""Scenes; the many have 10^4 modes."""

HARD = (38, 449, 483, 637, 1084, 1628, 2010, 2124, 2183)
"""Of the many: waves beside growth 10^7 times as fast, or a few weakly held modes together."""


@dataclasses.dataclass
class Sample:
    """What the modes of random scenes showed."""

    modes: int = 0
    unbounded: list = dataclasses.field(default_factory=list)
    """(seed, mode)."""
    uncertified: list = dataclasses.field(default_factory=list)
    refused: dict = dataclasses.field(default_factory=dict)
    """Seeds by what was said."""
    overestimate: list = dataclasses.field(default_factory=list)
    """Bound over error, of the first mode that moves in every fourth scene."""


def random_model(seed):
    """Springs of both signs, masses to 1e6 kg, compression, any ends and supports."""
    random = np.random.default_rng(seed)
    scene = random_scene(random, int(random.choice([1, 2, 3, 4], p=[0.2, 0.5, 0.2, 0.1])))
    stations = len(set(places(scene))) + 1
    n = max(int(random.choice(ELEMENTS)), stations)
    return scene.compile(elements=n, element=str(random.choice(["rigid", "tensed"])))


def lowest(model):
    """Return the lowest modes by sweep, as many as exist; None where there is none."""
    for number in range(min(MOST, model.size), 0, -1):
        try:
            return model.modes(number, solver="sweep")
        except rd.SolveError as refusal:
            if "must be at most" not in str(refusal):
                raise
    return None


def take(seeds):
    sample = Sample()
    for seed in seeds:
        model = random_model(seed)
        try:
            modes = lowest(model)
        except rd.SolveError as refusal:
            sample.refused.setdefault(str(refusal), []).append(seed)
            continue
        if modes is None:
            continue
        exact = exact_chain(model, 80)
        sample.modes += len(modes.frequency)
        if not modes.certified:
            sample.uncertified.append(seed)
        bounded = is_bounded(exact, modes)
        sample.unbounded += [(seed, k) for k in np.flatnonzero(~bounded).tolist()]
        moves = np.flatnonzero(modes.eigenvalue)
        if seed % 4 == 0 and len(moves) > 0 and bounded.all():
            k = int(moves[0])
            size = abs(modes.eigenvalue[k])
            # an error below half an ulp is luck
            error = max(exact.error(k, modes.eigenvalue[k]), EPS / 2 * size)
            sample.overestimate.append(eigenvalue_bound(modes)[k] / error)
    return sample


def truly_without_lowest_mode(seeds):
    """Whether these scenes have a massless coordinate with negative stiffness: counts at -1e40."""
    return all(ExactChain(random_model(seed).chain, 120).count(-1e40) > 0 for seed in seeds)


@pytest.fixture(scope="module")
def few():
    return take(range(FEW))


@pytest.fixture(scope="module")
def many():
    return take(range(MANY))


def test_rounding_error_bounds_the_true_error_of_random_modes(few):
    assert few.modes > 3 * FEW
    assert few.unbounded == []


def test_random_modes_are_certified(few):
    assert few.uncertified == []


def test_refusals_of_random_scenes_are_right(few):
    assert all("without mass" in said for said in few.refused), few.refused
    assert truly_without_lowest_mode(seed for seeds in few.refused.values() for seed in seeds)


def test_rounding_error_is_no_useless_bound(few):
    assert np.median(few.overestimate) <= 10.0


@pytest.mark.parametrize("seed", HARD)
def test_rounding_error_bounds_the_true_error_where_scales_meet(seed):
    sample = take([seed])
    assert sample.modes > 0
    assert sample.unbounded == []


@pytest.mark.slow
@pytest.mark.claim(
    f"rounding_error of a mode bounds the true error: share of the modes of {MANY} random scenes "
    "beyond it",
    reference=EXACT,
    accepted=0.0,
)
def test_rounding_error_bounds_the_true_error_of_very_many_modes(many, claim):
    assert many.modes >= 10_000
    claim(len(many.unbounded) / many.modes)


@pytest.mark.slow
def test_very_many_modes_are_certified(many):
    assert len(many.uncertified) <= 1e-3 * MANY, many.uncertified


@pytest.mark.slow
def test_refusals_of_very_many_scenes_are_right(many):
    assert all("without mass" in said for said in many.refused), many.refused
    assert truly_without_lowest_mode(seed for seeds in many.refused.values() for seed in seeds)


@pytest.mark.slow
@pytest.mark.claim(
    f"rounding_error of a mode over the true error, median over {MANY} random scenes",
    reference=EXACT,
    accepted=10.0,
)
def test_rounding_error_of_very_many_modes_is_no_useless_bound(many, claim):
    claim(np.median(many.overestimate))
