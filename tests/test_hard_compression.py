"""Responses of ropes under compression, to 1e-12 of the chain's own critical load and beyond."""

import math

import mpmath
import pytest
from exact_chain import Exact, error_over_condition, omega_of
from mpmath import mpf
from test_hard_resonances import secant

import ropedyn as rd

ROPE = rd.Rope(1.35, 0.1017, bending_stiffness=1.54)
EULER = 4 * math.pi**2 * 1.54 / 1.35**2
"""Of the clamped rope [N]."""
KINDS = pytest.mark.parametrize("element", ["rigid", "tensed"])


def pushed(element, n, load):
    return rd.Scene(ROPE, tension=-load).compile(elements=n, element=element)


def critical_load(element, n):
    """Load at which the chain itself loses its stiffness [N]: a zero of 1/h at rest.

    Not in the middle, where symmetry makes 1/h a quotient of two zeros.
    """
    exact = Exact(pushed(element, n, EULER), ("z", "beta"))
    node = ("z", n // 4)

    def resistance(times):
        exact.nudge = (mpf(1), times, mpf(1), mpf(1))
        return 1 / exact.receptance(omega_of(0.0), node, [node])[0]

    with mpmath.workdps(60):
        # design.md section 5: 1.216, 1.052, 1.0008 times Euler's at n = 4, 8, 64 if rigid
        guess = 1 if element == "tensed" else {4: 1.216, 8: 1.052, 64: 1.0008}[n]
        return secant(resistance, mpf(guess) * (1 + mpf(10) ** -4)) * mpf(EULER)


@KINDS
@pytest.mark.parametrize("n", [8, 64])
@pytest.mark.parametrize("share", [0.5, 1 - 1e-6, 1 - 1e-12, 1 + 1e-12, 1.5, 3.7, 30.0])
@pytest.mark.claim(
    "FRF and static answer under compression up to 1 - 1e-12 of the chain's own critical load and "
    "beyond it: error / condition",
    reference="mpmath, 40 digits: tests/exact_chain.py; load by the secant method",
    accepted=1e-13,
)
def test_response_next_to_and_beyond_the_critical_load(share, n, element, claim):
    model = pushed(element, n, float(critical_load(element, n) * mpf(share)))
    claim(
        max(
            error_over_condition(model, f, ("z", n // 2), enough=2e-15, digits=40)[0]
            for f in (0.0, 0.01, 5.0, 300.0)
        )
    )


@pytest.mark.parametrize("away", [1e-2, -1e-4, 1e-6, 1e-9, -1e-12])
@pytest.mark.claim(
    "FRF and static answer of tensed elements next to their own cantilever critical load, "
    "pi^2 B/4 l^2: error / condition",
    reference="mpmath, 60 digits: tests/exact_chain.py",
    accepted=1e-13,
)
def test_tensed_element_next_to_its_own_critical_load_keeps_its_digits(away, claim):
    # four elements between clamps: the load is the rope's own too
    model = pushed("tensed", 4, EULER * (1 + away))
    claim(max(error_over_condition(model, f, ("z", 2))[0] for f in (0.0, 5.0)))


@pytest.mark.parametrize("away", [1e-4, -1e-4])
@pytest.mark.claim(
    "A rigid element near its own cantilever critical load, 3 B/l^2, loses digits as the square "
    "of the distance, and rounding_error does not know: FRF error / condition at 1e-4; use more "
    "or tensed elements",
    reference="mpmath, 60 digits: tests/exact_chain.py",
    accepted=1e-7,
    limit=True,
)
def test_rigid_element_next_to_its_own_critical_load_loses_digits(away, claim):
    # F, G and Q are 1e4 times their size and as much less exact: eps 1e8 = 2e-8, and a few
    model = pushed("rigid", 4, 48 / (4 * math.pi**2) * EULER * (1 + away))
    claim(max(error_over_condition(model, f, ("z", 2))[0] for f in (0.0, 5.0)))


@pytest.mark.parametrize(("n", "times"), [(4, 1.216), (8, 1.052), (64, 1.0008)])
@pytest.mark.claim(
    "Critical load of clamped rigid chains of 4, 8, 64 elements over Euler's: difference from "
    "1.216, 1.052, 1.0008",
    reference="design.md section 5, printed digits",
    accepted=5e-4,
)
def test_critical_load_of_a_rigid_chain_is_above_eulers(n, times, claim):
    claim(abs(float(critical_load("rigid", n)) / EULER - times))
