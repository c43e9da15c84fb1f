"""A free beam that others measured: its file, its peaks, and the ratios of its frequencies."""

from pathlib import Path

import numpy as np
import pytest

import ropedyn as rd

FILE = Path(__file__).parent.parent / "reference/measured/ladisk_free_beam_accelerance_3pt.uff"
SOURCE = "Ladisk, pyuff, data/meas_point_1.txt to _3.txt: tests/reference/measured/README.md"
FITTED = np.array([51.52, 142.18, 278.67, 460.40, 687.17, 958.54])
"""Frequencies by a fit of one mode each with other software, in which three points differ by
0.02 Hz [Hz]."""


@pytest.fixture(scope="module")
def peaks():
    # where the points are is not stated, and no peak depends on it; one moved the hammer
    where = {1: 0.1, 2: 0.2, 3: 0.3}
    options = {"unit": "(m/s^2)/N", "coordinate": "z", "positions": where, "reciprocal": True}
    return rd.Peaks.of(rd.Measured.read(FILE, **options))


@pytest.mark.claim(
    "Peaks of a measured free beam, six in three responses, line spacing 1 Hz and damping 1e-4: "
    "largest difference from frequencies fitted with other software [Hz]",
    reference=SOURCE,
    accepted=0.02,
)
def test_peaks_of_a_measured_beam_are_those_of_other_software(peaks, claim):
    assert len(peaks.frequency) == len(FITTED)
    claim(np.abs(peaks.frequency - FITTED).max())


@pytest.mark.claim(
    "Ratios of the six frequencies of the same beam, whose size nobody stated: largest relative "
    "difference from a free beam with one scale fitted",
    reference=SOURCE,
    accepted=0.002,
)
def test_frequencies_of_a_measured_beam_have_the_ratios_of_a_free_one(peaks, claim):
    free = rd.End(z="free", beta="free")
    beam = rd.Scene(rd.Rope(1.0, 1.0, bending_stiffness=1.0), ends=(free, free))
    # the first two move the beam as a rigid body
    ratio = peaks.frequency / beam.compile().modes(8).frequency[2:]
    claim(np.abs(ratio / ratio.mean() - 1).max())
