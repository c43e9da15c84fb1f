"""Poles of a phase: their motions are those of the exponential of its matrix."""

import numpy as np
import pytest
from scipy.linalg import expm

from ropedyn.motion.phases.poles import poles_of

STIFF = np.array([[900.0, 40.0], [40.0, 2500.0]])
DAMPED = {
    "none": np.zeros((2, 2)),
    "alike": 3.0 * np.eye(2),
    "coupled": np.array([[2.0, 5.0], [5.0, 20.0]]),
    "without turns": np.array([[80.0, 5.0], [5.0, 2.0]]),
}
"""Of the last the first mode creeps back: two of its poles are real."""


@pytest.mark.parametrize("how", DAMPED)
@pytest.mark.parametrize("coupled", [True, False])
def test_sum_over_poles_is_the_exponential_of_the_matrix(how, coupled):
    """x(t) = Re sum right e^(rate t) left x(0)."""
    stiffness = STIFF if coupled else np.diag(np.diag(STIFF))
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness, -DAMPED[how]]])
    poles = poles_of(A, 2, 1.0)
    for t in (0.0, 0.01, 0.3):
        motion = ((poles.right * np.exp(poles.rate * t)) @ poles.left).real
        size = np.outer([1.0, 1.0, 60.0, 60.0], [1.0, 1.0, 1 / 30.0, 1 / 30.0])
        # 40 eps of matrices of condition 60
        assert np.abs((motion - expm(A * t)) / size).max() < 1e-13
