"""Counts of ropes on an axis against frames of straight elements, which know nothing of curves."""

import math

import numpy as np
import pytest
from support import frame_elements, random_axes

import ropedyn as rd

ELEMENTS, NUMBER = 40, 16


def frame(rng):
    """A round rope along a random arc, helix or polyline, which nothing loads."""
    axis, B = random_axes.axis(rng, rng.integers(4)), 10 ** rng.uniform(0, 2)
    rope = rd.Rope(
        axis,
        10 ** rng.uniform(-1, 1),
        bending_stiffness=B,
        torsional_stiffness=B * 10 ** rng.uniform(-1, 1),
        axial_stiffness=B / axis.length**2 * 10 ** rng.uniform(2, 5),
        rotary_inertia=1e-4 * axis.length**2 * rng.uniform(0, 1),
        polar_inertia=1e-3 * axis.length**2 * rng.uniform(0.1, 1),
    )
    ends = tuple(rng.choice(["clamped", "pinned", "free"], 2).tolist())
    return rd.Scene(rope, planes="both", ends=ends)


def miscounted(rng):
    """How many counts between modes that frames tell apart are wrong, and how many there are."""
    scene = frame(rng)
    model, each = scene.compile(), math.ceil(ELEMENTS / len(scene.rope.axis.pieces))
    coarse, fine = (
        frame_elements.eigenvalues(scene, each * twice)[: NUMBER + 1] for twice in (1, 2)
    )
    # of elements half as long a quarter of the error is left, of 1e-12 of the stiffest at least
    off = np.abs(coarse - fine) + 1e-6 * fine[-1]
    told = [k for k in range(NUMBER) if fine[k + 1] - fine[k] > 4 * max(off[k], off[k + 1])]
    wrong = 0
    for k in told:
        between = math.sqrt((fine[k] + fine[k + 1]) / 2) / (2 * math.pi)
        wrong += model.count(below=between) != k + 1
    return wrong, len(told)


def test_counts_are_those_of_frames_of_straight_elements():
    wrong, told = np.sum([miscounted(np.random.default_rng((5, k))) for k in range(10)], axis=0)
    assert wrong == 0
    assert told > 60  # of 160


@pytest.mark.slow
@pytest.mark.claim(
    "400 random ropes along arcs, helices and polylines in space: counts between their lowest "
    "modes that are wrong",
    reference="space frames of straight finite elements, dense, of which two divisions tell which "
    "modes they know apart: tests/support/frame_elements.py",
    accepted=0.0,
)
def test_very_many_counts_are_those_of_frames_of_straight_elements(claim):
    claim(sum(miscounted(np.random.default_rng((6, k)))[0] for k in range(400)))
