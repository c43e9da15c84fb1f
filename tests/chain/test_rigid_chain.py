"""Chains of rigid elements against their exact discrete dispersion relation."""

import math

import numpy as np
import pytest
from conftest import BENDING, EPS, LENGTH, MASS, beam, pinned_rigid_chain, reference

CASES = [case for case in reference("rigid_chain")["cases"] if case["n"] <= 64]


def rounding(elements, mode):
    """Relative error of a frequency that a few eps in K cause, eps |x||K||x|/2 x K x: K acts on z
    with up to 48 B/a^3 where the beam needs (k pi/n)^4 B/a^3 at least."""
    return EPS * 48 * (elements / (math.pi * mode)) ** 4


@pytest.mark.parametrize(
    "case", CASES, ids=lambda case: f"{case['ends']} T={case['tension']:g} n={case['n']}"
)
@pytest.mark.parametrize("k", range(5))
@pytest.mark.claim(
    "f1..f5 of clamped, pinned and free rigid chains to 64 elements: error / rounding of the "
    "assembled stiffness, which grows as n^4",
    reference="exact discrete dispersion relation: rigid_chain_exact.json",
    accepted=1.0,
)
def test_rigid_chain_has_its_exact_discrete_frequencies(case, k, claim):
    scene = beam(case["n"], tension=case["tension"], ends=(case["ends"],) * 2)
    frequency = scene.compile(elements=case["n"], element="rigid").modes(5).frequency[k]
    # and a few eps of the largest 1/lambda, which is what the solver computes
    solver = 2 * EPS * (case["f"][k] / case["f"][0]) ** 2
    tolerance = rounding(case["n"], k + 1) + solver
    # rigid motion within rounding of 0
    size = max(case["f"][k], 1e-12 / tolerance)
    claim(abs(frequency - case["f"][k]) / (tolerance * size))


@pytest.mark.parametrize("tension", [-80.0, 0.0, 300.0, 1e5])
def test_pinned_chain_has_both_branches_of_the_dispersion_relation(tension):
    # 7 waves of bending and 7 of rotation, and rotations alone at k = 0 and k = n
    n = 8
    both = [pinned_rigid_chain(n, k, tension) for k in range(1, n)]
    alone = [pinned_rigid_chain(n, 0, tension)[1]]
    # k = n: no deflection at any node, the rotations alternate: (8 - 4) 12 B/(mu a^4)
    alone.append(alone[0] / 3)
    exact = np.sort([*np.ravel(both), *alone])
    modes = (
        beam(n, tension=tension, ends=("pinned", "pinned"))
        .compile(elements=n, element="rigid")
        .modes(2 * n)
    )
    # relative to the lowest, by the condition of the whole set
    condition = np.abs(exact).max() / np.abs(exact).min()
    np.testing.assert_allclose(modes.eigenvalue, exact, rtol=EPS * 10 * condition)


@pytest.mark.parametrize("k", [1, 2, 3])
@pytest.mark.parametrize("tension", [0.0, 300.0])
def test_pinned_chain_deflects_in_sines_and_turns_in_cosines(tension, k):
    n = 16
    modes = (
        beam(n, tension=tension, ends=("pinned", "pinned"))
        .compile(elements=n, element="rigid")
        .modes(3)
    )
    wave = math.pi * k / LENGTH
    z, beta = modes.shape[k - 1].T
    sine, cosine = np.sin(wave * modes.x), np.cos(wave * modes.x)
    # the vector errs by the condition of K over the distance to the next mode, which is of its
    # own size
    tolerance = 2 * rounding(n, k)
    np.testing.assert_allclose(z / (z @ sine) * (sine @ sine), sine, atol=tolerance)
    turned = beta @ cosine / (cosine @ cosine)
    np.testing.assert_allclose(beta / turned, cosine, atol=tolerance)
    # second row of the dispersion relation: (8 + 4 c - lambda_hat/12) b = 12 s w/a
    a = LENGTH / n
    lam = pinned_rigid_chain(n, k, tension)[0] * (MASS / LENGTH) * a**4 / BENDING
    ratio = 12 * math.sin(wave * a) / (8 + 4 * math.cos(wave * a) - lam / 12) / a
    # beta = w' : the sign is that of a rising rope
    assert turned / (z @ sine / (sine @ sine)) == pytest.approx(ratio, rel=tolerance)
