"""Undamped responses at, next to and within an ulp of resonances of the whole and of its parts."""

import math

import mpmath
import pytest
from exact_chain import Exact, error_over_condition, omega_of, relative
from mpmath import mpf
from stored import stored

import ropedyn as rd

LENGTH, BENDING, DENSITY = 1.35, 1.54, 0.1017
ROPE = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING)
EXACT = "mpmath, 40 digits: tests/support/exact_chain.py"
DIGITS = 40


def secant(function, near):
    """The zero of a function close to a good guess, to 25 digits."""
    a, b = mpf(near), mpf(near) * (1 + mpf(10) ** -9)
    fa, fb = function(a), function(b)
    while fb not in (0, fa) and abs(b / a - 1) > mpf(10) ** -25:
        a, b = b, b - fb * (b - a) / (fb - fa)
        fa, fb = fb, function(b)
    return b


@stored
def tip_resonances(n, k, tension, most):
    """Doubles next to the lowest resonances of the first k of n clamped elements, tip free [Hz]."""
    length = LENGTH / n
    tip = [rd.PointMass(k * length, DENSITY * length / 2)]
    cantilever = rd.Scene(
        ROPE.replace(length=k * length), tension=tension, ends=("clamped", "free"), parts=tip
    )
    model = cantilever.compile(elements=k, element="rigid")
    exact = Exact(model, ("z", "beta"))

    def resistance(f):
        try:
            return 1 / exact.receptance(omega_of(f), ("z", k), [("z", k)])[0]
        except ZeroDivisionError:
            # the resonance to the last digit
            return mpf(0)

    return [float(secant(resistance, f)) for f in model.modes(min(k, most)).frequency.tolist()]


PARTS = [
    *[(8, k) for k in range(1, 8)],
    *[(16, k) for k in (1, 3, 8, 13, 15)],
    *[(64, k) for k in (1, 21, 40, 63)],
]


@pytest.mark.parametrize(("n", "k"), PARTS)
@pytest.mark.parametrize("tension", [0.0, 300.0])
@pytest.mark.claim(
    "FRF within an ulp of clamped-free resonances of the first k of n = 8, 16, 64 elements: "
    "error / condition",
    reference=EXACT,
    accepted=4e-14,
)
def test_response_is_exact_where_a_part_of_the_chain_resonates(n, k, tension, claim):
    model = rd.Scene(ROPE, tension=tension).compile(elements=n, element="rigid")
    with mpmath.workdps(DIGITS):
        worst = max(
            error_over_condition(model, f, ("z", n // 2), digits=DIGITS)[0]
            for f in tip_resonances(n, k, tension, 8)
        )
    claim(worst)


def pinned_frequency(n, wave):
    """The double next to the frequency of so many half waves of the pinned rigid chain [Hz].

    lambda = 24 (1 - c) - 144 (1 - c^2)/(8 + 4 c), c = cos(wave pi/n), in units of B/(mu a^4):
    the dispersion relation of `conftest.pinned_rigid_chain` without rotary inertia.
    """
    with mpmath.workdps(DIGITS):
        a, c = mpf(LENGTH) / n, mpmath.cos(wave * mpmath.pi / n)
        lam = 24 * (1 - c) - 144 * (1 - c * c) / (8 + 4 * c)
        omega = mpmath.sqrt(lam * mpf(BENDING) / (mpf(DENSITY) * a**4))
        return float(omega / (2 * mpmath.pi))


def error_over_estimate(model, f, drive):
    """Error over `rounding_error`, 0 where the frequency is refused by name."""
    x = model.x.tolist()
    try:
        frf = model.frf(f, drive=(drive[0], x[drive[1]]), solver="sweep")
    except rd.SolveError as refusal:
        assert repr(f) in str(refusal)
        return 0.0
    with mpmath.workdps(DIGITS):
        exact = Exact(model, model.component_of(drive[0]))
        (h,) = exact.receptance(omega_of(f), drive, [drive])
    assert frf.value[0, 0].imag == 0
    return relative(frf.value[0, 0], h) / frf.rounding_error[0, 0]


def steps(f):
    """At, one ulp beside and next to a frequency."""
    return [f, math.nextafter(f, 0), math.nextafter(f, math.inf), f * (1 - 1e-9), f * (1 + 1e-12)]


@pytest.mark.parametrize("wave", [1, 2, 3, 4, 5, 6])
@pytest.mark.parametrize("n", [8, 64])
@pytest.mark.claim(
    "Undamped FRF at, within an ulp of and next to a resonance of the whole, driven at a bulge or "
    "a node of the mode: refused by name or known to rounding_error, error / rounding_error",
    reference=f"closed-form frequency; {EXACT}",
    accepted=1.0,
    wide="of the bound that the answer states, and none may be beyond it",
)
def test_response_next_to_a_resonance_is_known_to_its_rounding_error(n, wave, claim):
    # the middle is a node of even waves
    model = rd.Scene(ROPE, ends=("pinned", "pinned")).compile(elements=n, element="rigid")
    f = pinned_frequency(n, wave)
    claim(max(error_over_estimate(model, g, ("z", n // 2)) for g in steps(f)))


@pytest.mark.parametrize("between", [0.0, 1e-12, 1e-6])
@pytest.mark.claim(
    "Undamped FRF next to two nearly equal resonances, two spans about a heavy mass: "
    "error / rounding_error",
    reference=EXACT,
    accepted=1.0,
    wide="of the bound that the answer states, and none may be beyond it",
)
def test_response_between_nearly_repeated_resonances_is_known_to_its_rounding_error(between, claim):
    heavy = rd.PointMass(LENGTH / 2, 1e9, rotary_inertia=1e9 * (between == 0) + 1e3)
    model = rd.Scene(ROPE, tension=30.0, parts=[heavy]).compile(elements=16, element="tensed")
    f = rd.Scene(ROPE.replace(length=LENGTH / 2), tension=30.0).compile(
        elements=8, element="tensed"
    )
    one_span = float(f.modes(1).frequency[0])
    claim(
        max(
            error_over_estimate(model, g, ("z", 4))
            for g in [*steps(one_span), one_span * (1 + between)]
        )
    )


@pytest.mark.claim(
    "Undamped FRF at the double eigenvalue of a clamped beam with T = -10 pi^2 B/L^2: "
    "error / rounding_error",
    reference=EXACT,
    accepted=1.0,
    wide="of the bound that the answer states, and none may be beyond it",
)
@pytest.mark.parametrize("n", [8, 64])
def test_response_at_the_double_eigenvalue_of_a_compressed_beam(n, claim):
    tension = -10 * math.pi**2 * BENDING / LENGTH**2
    model = rd.Scene(ROPE, tension=tension).compile(elements=n, element="tensed")
    eigenvalue = model.modes(3).eigenvalue
    positive = [math.sqrt(v) / (2 * math.pi) for v in eigenvalue.tolist() if v > 0]
    claim(max(error_over_estimate(model, g, ("z", n // 2 - 1)) for f in positive for g in steps(f)))
