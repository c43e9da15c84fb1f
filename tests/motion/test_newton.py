"""Forces that Python computes at a stage, against the linear equations that they solve."""

from types import SimpleNamespace

import numpy as np
import pytest

from ropedyn.motion.direct.newton import ENOUGH, Stage, solve_stage

STIFFNESS, DAMPING = np.array([300.0, 50.0]), np.array([0.2, 0.4])
COMPLIANCE = np.array([[2e-3, 5e-4], [5e-4, 4e-3]])


def stage_of(count, power=1):
    """Return a stage with springs and dashpots at points, and how often they were asked."""
    asked = []

    def law(k):
        def call(t, u, v):
            asked.append(k)
            return float(-STIFFNESS[k] * u**power - DAMPING[k] * v)

        return SimpleNamespace(law=k, part=k, call=call)

    lumps = SimpleNamespace(calls=[law(k) for k in range(count)])
    x, q = np.array([0.01, -0.03]), np.array([0.2, 0.1])
    some = slice(count)
    return Stage(lumps, 0.05, 1.0, x[some], COMPLIANCE[some, some], q[some]), asked


@pytest.mark.parametrize("count", [1, 2])
def test_springs_and_dashpots_are_met_in_few_steps(count):
    """f = -k (q + d) - c d/theta with d = x + C f; slopes by differences are exact to 1e-8."""
    stage, asked = stage_of(count)
    force, velocity = solve_stage(stage, np.zeros(count))
    k, c = STIFFNESS[:count], DAMPING[:count] / stage.theta
    matrix = np.eye(count) + (k + c)[:, None] * stage.C
    expected = np.linalg.solve(matrix, -k * (stage.q + stage.x) - c * stage.x)
    np.testing.assert_allclose(force, expected, rtol=10 * ENOUGH)
    moved = stage.x + stage.C @ expected
    np.testing.assert_allclose(velocity, moved / stage.theta, rtol=1e-10)
    # once each to begin, once for the slope and once after each of two steps at most
    assert len(asked) <= 5 * count


@pytest.mark.parametrize("count", [1, 2])
def test_what_is_guessed_right_is_not_asked_again(count):
    stage, asked = stage_of(count, power=3)
    force, _ = solve_stage(stage, np.zeros(count))
    asked.clear()
    again, _ = solve_stage(stage, force)
    np.testing.assert_array_equal(again, force)
    assert len(asked) == count
