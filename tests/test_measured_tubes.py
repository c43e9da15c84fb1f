"""Tubes of known length, mass, stiffness and tension: prediction without a fit."""

import numpy as np
import pytest
from measured_ropes import STRAW_FREQUENCY, STRAW_LENGTH, STRAW_TENSION, straw

SOURCE = "J. Bono, Mu2e-doc-6392: tests/measured_ropes.py"


def first_frequency(length, tension):
    return float(straw(length, tension).compile().modes(1).frequency[0])


@pytest.fixture(scope="module")
def differences():
    predicted = [[first_frequency(a, t) for t in STRAW_TENSION] for a in STRAW_LENGTH]
    return predicted / STRAW_FREQUENCY - 1


@pytest.mark.claim(
    "First frequency of clamped tubes of known tension, 5 lengths and 7 tensions, nothing fitted: "
    "relative difference, root mean square",
    reference=SOURCE,
    accepted=0.025,
)
def test_tubes_of_known_tension_have_their_measured_frequencies(differences, claim):
    claim(np.sqrt(np.mean(differences**2)))


@pytest.mark.claim(
    "The same: mean of the relative difference, all tubes together",
    reference=SOURCE,
    accepted=0.005,
)
def test_prediction_of_tubes_is_not_biased(differences, claim):
    claim(abs(differences.mean()))


@pytest.mark.claim(
    "The same: the largest relative difference, the shortest tube under the least tension",
    reference=SOURCE,
    accepted=0.06,
    limit=True,
)
def test_shortest_tube_under_least_tension_is_predicted_worst(differences, claim):
    worst = np.unravel_index(np.abs(differences).argmax(), differences.shape)
    assert worst == (np.argmin(STRAW_LENGTH), np.argmin(STRAW_TENSION))
    claim(np.abs(differences).max())
