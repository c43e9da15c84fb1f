"""Bounds by profile likelihood where they are known in closed form."""

import math

import numpy as np
import pytest

from ropedyn.experiment.fitting.profile_interval import CLOSE, Profile

SLOPE = np.array([[2.0, 1.0], [0.5, 3.0], [1.0, -1.0]])
AIM = np.array([1.0, 2.0, 0.5])
BEST, LEAST = (x[..., 0] for x in np.linalg.lstsq(SLOPE, AIM[:, None], rcond=None)[:2])
COVARIANCE = np.linalg.inv(SLOPE.T @ SLOPE)
ROOT = np.array([0.5, 2.0, 3.0])


class Linear:
    """Residuals A u - b."""

    asked = 0

    def __call__(self, rows, u):
        self.asked += len(rows)
        return u @ SLOPE.T - AIM, np.broadcast_to(SLOPE, (len(rows), *SLOPE.shape))


class Logarithmic(Linear):
    """Residuals A ln-factors, of x = exp(u): (x - 1)/s alone."""

    def __call__(self, rows, u):
        x = np.exp(u)
        return 4.0 * (x - 1.0), 4.0 * x[:, :, None]


def profile(misfit, i, path, count, **more):
    given = {"best": np.tile(BEST, (count, 1)), "least": np.full(count, LEAST)}
    given |= {"by_factor": np.zeros(2, dtype=bool), "limit": np.full(count, 50.0)} | more
    rows = np.zeros(count, dtype=np.intp)
    return Profile(misfit, rows, i=np.full(count, i), path=np.tile(path, (count, 1)), **given)


@pytest.mark.parametrize("i", [0, 1])
@pytest.mark.parametrize("guessed", [True, False], ids=["along the valley", "straight on"])
def test_bounds_of_linear_least_squares_are_those_of_the_covariance(i, guessed):
    """The growth is (u_i - best)^2/var_i, wherever the others are looked for first."""
    path = COVARIANCE[i] / COVARIANCE[i, i] if guessed else np.eye(2)[i]
    side = np.array([-1, 1, 1])
    found = profile(Linear(), i, path, 3).bounds(side, ROOT, np.full(3, 0.1))
    expected = BEST[i] + side * ROOT * math.sqrt(COVARIANCE[i, i])
    np.testing.assert_allclose(found - BEST[i], expected - BEST[i], rtol=1e-6)


def test_where_the_guess_of_the_others_is_right_it_is_not_sought():
    """A linear root needs two distances: the first one and what it leads to."""
    misfit = Linear()
    profile(misfit, 0, COVARIANCE[0] / COVARIANCE[0, 0], 1).bounds(
        np.array([1]), ROOT[1:2], np.full(1, 0.5)
    )
    assert misfit.asked == 2


def test_bounds_of_a_factor_are_as_far_as_it_is_linear_in_it():
    """4 (x - 1) = root: x = 1 + root/4 above and 1 - root/4 below, infinite where that is < 0."""
    side, root = np.array([-1, 1, -1]), np.array([2.0, 2.0, 5.0])
    given = {"best": np.zeros((3, 1)), "least": np.zeros(3), "by_factor": np.ones(1, dtype=bool)}
    found = profile(Logarithmic(), 0, np.ones(1), 3, **given).bounds(side, root, np.full(3, 0.2))
    np.testing.assert_allclose(np.exp(found[:2]), [0.5, 1.5], rtol=CLOSE)
    assert found[2] == -np.inf


def test_no_bound_is_looked_for_beyond_the_limit():
    given = {"limit": np.full(1, 0.25)}
    some = profile(Linear(), 0, COVARIANCE[0] / COVARIANCE[0, 0], 1, **given)
    assert some.bounds(np.array([1]), ROOT[2:], np.full(1, 0.1)) == [np.inf]
