"""Damping from hits: what an exponential window adds is in the model, not in the answer."""

import dataclasses
import functools

import hammer
import numpy as np
import pytest

import ropedyn as rd
from ropedyn.curves.measured import lines_of
from ropedyn.curves.record.hits import measured_response

LOSS, FIRST, COUNT = 0.5, 8.0, 20
"""Decay of every mode [1/s], first frequency [Hz], modes of the forward model."""
STRING = hammer.HeldString(
    COUNT,
    FIRST,
    tuple(LOSS / (2 * np.pi * FIRST * n) for n in range(1, COUNT + 1)),
    0.3,
    (0.3, 0.45),
)
SCENE = rd.Scene(rd.Rope(1.0, 1.0), tension=(2 * FIRST) ** 2, damping=rd.ViscousDamping(2 * LOSS))
GUESS = SCENE.replace(tension=265.0, damping=rd.ViscousDamping(2.0))
PATHS = ["tension", "damping.coefficient"]
HITS = tuple((1.0 + 14 * k, peak) for k, peak in enumerate((1.0, 1.3, 0.8, 1.1)))
WINDOWS = (0.0, 0.5 * LOSS, LOSS, 3 * LOSS)


@functools.cache
def measured(decay, seed, force_noise=0.0):
    """Lines of the first three modes, with 3 % of noise."""
    record = hammer.record(
        STRING, hits=HITS, duration=57.0, noise=0.03, force_noise=force_noise, seed=seed
    )
    found = measured_response(record, decay=decay)
    return lines_of(found, (found.frequency > 4.0) & (found.frequency < 28.0))


def fitted(data):
    """What is found of it."""
    return rd.identify(GUESS, data, PATHS)


def error(decay, seed):
    """Relative error of the damping."""
    return fitted(measured(decay, seed)).value["damping.coefficient"] / (2 * LOSS) - 1


@pytest.mark.parametrize("decay", [0.0, 3 * LOSS])
def test_damping_is_right_with_any_window(decay):
    # 1e-3 of noise and of what the hit before left
    assert abs(error(decay, seed=1)) < 0.01


@pytest.mark.slow
@pytest.mark.claim(
    "bias of damping identified from hits, windows of 0 to 3 times the decay of the modes",
    reference="modes of a string hit 4 times, their motion by an independent integration",
    accepted=0.01,
)
@pytest.mark.parametrize("decay", WINDOWS)
def test_damping_is_unbiased_with_any_window(decay, claim):
    claim(abs(np.mean([error(decay, seed) for seed in range(200, 212)])))


def test_damping_is_several_times_too_large_where_the_window_is_not_told():
    data = dataclasses.replace(measured(3 * LOSS, 1), decay=0.0)
    with pytest.warns(rd.IdentifyWarning, match="differs from the model by more than noise"):
        found = fitted(data).value["damping.coefficient"] / (2 * LOSS) - 1
    # decay over loss: 3, and less by what no damping explains
    assert 2.0 < found < 3.2


def z_of(decay, seeds):
    """Errors of tension and damping over their standard deviations."""
    z = []
    for seed in seeds:
        fit = fitted(measured(decay, seed))
        z.append([(fit.value[p] - true) / fit.std[p] for p, true in zip(PATHS, (256.0, 2 * LOSS))])
    return np.array(z)


@pytest.mark.slow
@pytest.mark.parametrize("decay", WINDOWS)
def test_standard_deviations_know_that_a_window_makes_lines_alike(decay):
    """Of the errors of 24 fits and 2 numbers over their std the rms is 1 +- 0.1."""
    assert 0.7 < np.sqrt((z_of(decay, range(300, 324)) ** 2).mean()) < 1.35


def test_comparison_evaluates_the_model_where_it_was_measured():
    data = measured(3 * LOSS, 1)
    wrong = dataclasses.replace(data, decay=0.0)
    assert rd.compare(SCENE.compile(), data).frac.min() > 0.999
    assert rd.compare(SCENE.compile(), wrong).frac.min() < 0.8
