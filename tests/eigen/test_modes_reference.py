"""The exact counts that modes are checked with, themselves against closed forms."""

import math
from decimal import Decimal

import numpy as np
import pytest
from conftest import LAID, LENGTH, beam, pinned_rigid_chain, reference
from exact_counts import ExactChain
from exact_waves import pinned_tensed_chain
from mpmath import mpf

import ropedyn as rd

CASES = [case for case in reference("rigid_chain")["cases"] if case["n"] == 8]
LAGRANGE = reference("lumped_chains")


def eigenvalue(frequency):
    return (2 * math.pi * frequency) ** 2


@pytest.mark.parametrize("case", CASES, ids=lambda c: f"{c['ends']} T={c['tension']:g}")
def test_counts_stand_on_both_sides_of_the_dispersion_relation(case):
    scene = beam(case["n"], tension=case["tension"], ends=(case["ends"],) * 2)
    exact = ExactChain(scene.compile(elements=case["n"], element="rigid").chain)
    for k, f in enumerate(case["f"]):
        # the stored frequencies have 16 digits, so has the scene's mu (L/n)^2/12
        assert exact.holds(k, eigenvalue(f) * (1 - 1e-14), eigenvalue(f) * (1 + 1e-14))


@pytest.mark.parametrize("n", [1, 2, 8])
def test_counts_stand_on_both_sides_of_lagranges_string(n):
    length = (n + 1) * LAGRANGE["a"]
    rope = rd.Rope(length, LAGRANGE["m"] / LAGRANGE["a"])
    exact = ExactChain(rd.Scene(rope, tension=LAGRANGE["T"]).compile(elements=n + 1).chain)
    for k, f in enumerate(LAGRANGE["string"]["held-held"][str(n)]):
        assert exact.holds(k, eigenvalue(f) * (1 - 1e-14), eigenvalue(f) * (1 + 1e-14))


def test_error_is_the_distance_from_the_closed_form():
    n, tension = 6, 300.0
    exact = ExactChain(
        beam(n, tension=tension, ends=("pinned", "pinned"))
        .compile(elements=n, element="rigid")
        .chain
    )
    value = pinned_rigid_chain(n, 1, tension)[0]
    for off in (1e-12, -1e-6, 1e-3):
        # the closed form has 16 digits, `error` tells to one per cent
        assert exact.error(0, value * (1 + off)) == pytest.approx(
            abs(off) * value, rel=0.011, abs=1e-14 * value
        )
    found = exact.eigenvalue(0, value * 0.9, value * 1.1)
    assert float(abs(found / mpf(value) - 1)) < 1e-14


@pytest.mark.parametrize("tension", [0.0, 300.0, -200.0])
def test_counts_stand_on_both_sides_of_a_pinned_tensed_chain(tension):
    n = 5
    rope = rd.Rope(LENGTH, 0.1, bending_stiffness=54.626)
    scene = rd.Scene(rope, tension=tension, ends=("pinned", "pinned"))
    exact = ExactChain(scene.compile(elements=n, element="tensed").chain)
    for k in range(1, n):
        right = float(pinned_tensed_chain(rope, tension, n, k))
        assert exact.holds(k - 1, right * (1 - 1e-14), right * (1 + 1e-14))


@pytest.mark.parametrize("element", ["rigid", "tensed"])
@pytest.mark.parametrize("tension", [0.0, 70.0, -30.0])
def test_elements_are_those_of_the_library(element, tension):
    # the same formulas in two arithmetics, lay and stretch coupled: a slip in one shows
    scene = rd.Scene(LAID, tension=tension, parts=[rd.PointMass(0.3, 0.2)])
    model = scene.compile(elements=5, element=element)
    exact = ExactChain(model.chain)
    values = np.linalg.eigvals(
        np.linalg.solve(model.mass_matrix().toarray(), model.stiffness_matrix().toarray())
    )
    values = np.sort(values.real[values.real > 0])
    # dense eigenvalues are right to eps of the largest, which is 1e6 times the lowest
    for k, value in enumerate(values.tolist()):
        assert exact.holds(k, Decimal(value) * Decimal("0.999999"), value * 1.000001)
