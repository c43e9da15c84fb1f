"""Responses of ropes under compression, to 1e-12 of the chain's own critical load and beyond."""

import math

import mpmath
import pytest
from conftest import slow
from exact_chain import DIGITS, Exact, error_over_condition, omega_of
from mpmath import mpf
from stored import stored
from test_hard_resonances import secant

import ropedyn as rd

ROPE = rd.Rope(1.35, 0.1017, bending_stiffness=1.54)
EULER = 4 * math.pi**2 * 1.54 / 1.35**2
"""Of the clamped rope [N]."""
KINDS = pytest.mark.parametrize("element", ["rigid", "tensed"])


def pushed(element, n, load):
    return rd.Scene(ROPE, tension=-load).compile(elements=n, element=element)


@stored
def critical_load(element, n):
    """Load at which the chain itself loses its stiffness [N]: a zero of 1/h at rest.

    Not in the middle, where symmetry makes 1/h a quotient of two zeros.
    """
    exact = Exact(pushed(element, n, EULER), ("z", "beta"))
    node = ("z", n // 4)

    def resistance(times):
        exact.nudge = (mpf(1), times, mpf(1), mpf(1), mpf(1))
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
    reference="mpmath, 40 digits: tests/support/exact_chain.py; load by the secant method",
    accepted=1e-13,
)
def test_response_next_to_and_beyond_the_critical_load(share, n, element, claim):
    model = pushed(element, n, float(critical_load(element, n) * mpf(share)))
    claim(
        max(
            error_over_condition(model, f, ("z", n // 2), digits=40)[0]
            for f in (0.0, 0.01, 5.0, 300.0)
        )
    )


CHAINS = [
    ("pinned", 2, 1),
    ("clamped", 4, 2),
    ("pinned", 3, 1),
    ("clamped", 3, 1),
    ("pinned", 8, 3),
    ("clamped", 8, 3),
]
"""Ends, elements, driven node: nowhere a node of the mode that buckles. The first two chains are
critical where one of their elements is as a cantilever."""


def load_of(whose, element, ends, n):
    """Critical load -T of an element's own cantilever or of the chain [N].

    Rigid: 3 B/l^2; the chain with z_j = Re e^(i phi j), beta_j = Re b e^(i phi j) has the stiffness
    (24 + 2 theta) (1 - c) B/l^3, (8 + 4 c) B/l and 12 i s B/l^2 between them, c + i s = e^(i phi):
    theta = -6 (1 - c)/(2 + c). Tensed: exact in statics, pi^2 B/4 l^2 and Euler's.
    """
    angle = (1 if ends == "pinned" else 2) * math.pi / n
    if whose == "element":
        theta = 3 if element == "rigid" else math.pi**2 / 4
    elif element == "rigid":
        theta = 6 * (1 - math.cos(angle)) / (2 + math.cos(angle))
    else:
        theta = angle**2
    return theta * 1.54 / (1.35 / n) ** 2


@KINDS
@pytest.mark.parametrize("whose", ["element", "chain"])
@pytest.mark.parametrize(("ends", "n", "node"), CHAINS)
@pytest.mark.parametrize("away", [1e-2, *slow(-1e-4, 1e-6), -1e-9, 1e-12, -1.3])
@pytest.mark.claim(
    "FRF under compression next to the critical load of one element's own cantilever, and of the "
    "chain, pinned and clamped, 2 to 8 elements: error / condition",
    reference="mpmath, 40 digits: tests/support/exact_chain.py; closed-form loads",
    accepted=1e-13,
)
def test_element_next_to_its_own_critical_load_keeps_its_digits(
    away, ends, n, node, whose, element, claim
):
    load = load_of(whose, element, ends, n) * (1 - away)
    model = rd.Scene(ROPE, tension=-load, ends=(ends, ends)).compile(elements=n, element=element)
    other = ("beta", 0 if ends == "pinned" else n - 1)
    worst = 0.0
    for f in (0.0, 1.0, 50.0, 500.0):
        for response in (("z", node), other):
            # two critical loads at once, an element's and the chain's, leave 40 digits four
            digits = DIGITS if n <= 4 else 40
            error, covered = error_over_condition(model, f, ("z", node), response, digits=digits)
            assert covered <= 1, "rounding_error is no bound"
            worst = max(worst, error)
    claim(worst)


@pytest.mark.parametrize("share", [0.9, 1 - 1e-9, 1.0, 1.1])
@pytest.mark.parametrize("lay", [0.0, 0.3])
@pytest.mark.claim(
    "Forces at the left end of a rigid chain at an element's own critical load: what is left of "
    "the equilibrium of the first element, relative",
    reference="equilibrium: M_a = M_b + l F_b - T (z_b - z_a), F_a = F_b",
    accepted=1e-13,
)
def test_left_end_is_in_equilibrium_at_an_element_s_own_critical_load(lay, share, claim):
    rope = ROPE.replace(torsional_stiffness=1.0, polar_inertia=1e-5, lay_slope=lay)
    n, x = 3, 1.35 / 3
    flexibility = rd.Scene(rope, tension=0.0).compile(elements=n, element="rigid").chain.flexibility
    T = -3 * share / (float(flexibility[0, 2, 2]) * x**2)
    scene = rd.Scene(rope, tension=T, damping=rd.StiffnessDamping(1e-5))
    model = scene.compile(elements=n, element="rigid")
    points = [("M_beta", 0.0), ("F_z", 0.0), ("M_beta", x), ("F_z", x), ("z", x)]
    answer = model.frf([0.0, 30.0, 400.0], drive=("z", x), response=points, solver="sweep")
    moment, force, M, F, z = answer.value
    # terms of like size, each good to 1e-13 times a condition of about 10
    left = abs(moment - (M + x * F - T * z)).max() / abs(T * z).max()
    claim(max(left, abs(force / F - 1).max()))


@pytest.mark.parametrize("share", [0.9, 1 - 1e-9, 1.0, 1.1])
def test_reactions_at_an_element_s_own_critical_load_are_those_of_the_assembled_chain(share):
    T = -share * load_of("element", "rigid", "clamped", 3)
    model = rd.Scene(ROPE, tension=T).compile(elements=3, element="rigid")
    sweep, lapack = (model.static({("z", 0.45): 1.0}, solver=s) for s in ("sweep", "lapack"))
    # three elements: the assembled condition is below a hundred
    assert abs(sweep.force - lapack.force).max() <= 1e-13 * abs(lapack.force).max()


@pytest.mark.parametrize(("n", "times"), [(4, 1.216), (8, 1.052), (64, 1.0008)])
@pytest.mark.claim(
    "Critical load of clamped rigid chains of 4, 8, 64 elements over Euler's: difference from "
    "1.216, 1.052, 1.0008",
    reference="design.md section 5, printed digits",
    accepted=5e-4,
)
def test_critical_load_of_a_rigid_chain_is_above_eulers(n, times, claim):
    claim(abs(float(critical_load("rigid", n)) / EULER - times))
