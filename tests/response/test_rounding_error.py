"""`rounding_error` of a response bounds the true error and is no useless bound.

Of random lines, and of undamped ones at and next to frequencies where a response changes its sign,
through 0 or infinity.
"""

import copy
import math
import pickle

import mpmath
import numpy as np
import pytest
from conftest import EPS, samples
from exact_chain import DIGITS, Exact, condition, omega_of, response
from exact_span import Continuum, coupled
from random_scene import damped, random_line, random_spans
from resonant_line import error_and_limit, exact_line, kept_lines

import ropedyn as rd

FEW, MANY, RESONANT_MANY, FEW_SPANS = 100, 10_000, 5_000, 60
RESONANT = 1e11
"""Condition of an answer that may be refused: times the n eps of a long chain it has no digit."""
EXACT = "mpmath, 60 digits, from the numbers of the scene: tests/support/exact_chain.py"


def answer(line, solver):
    """Value and estimated relative error."""
    x = line.model.x.tolist()
    (c, i), (d, j) = line.drive, line.response
    frf = line.model.frf(
        line.frequency, drive=(c, x[i]), response=(d, x[j]), threads=1, solver=solver
    )
    return frf.value[0, 0], frf.rounding_error[0, 0]


def is_rounding(exact, omega, drive, response):
    """Whether the reference is rounding, of 0 or of what is singular, that more digits change."""
    (h,) = exact.receptance(omega, drive, [response])
    with mpmath.workdps(DIGITS + 20):
        (finer,) = exact.receptance(omega, drive, [response])
    return abs(h - finer) > 1e-9 * abs(finer)


def has_no_answer(exact, line):
    """Whether motion of the driven node changes by all its digits with the model's numbers."""
    omega, node = omega_of(line.frequency), line.drive[1]
    for c in exact.coordinates:
        place = c, node
        try:
            if is_rounding(exact, omega, place, place):
                return True
            if condition(exact, omega, place, place) > RESONANT:
                return True
        except ZeroDivisionError:
            return True
    return False


def error_and_estimate(seed, solver="sweep"):
    """Both over the value itself, (0, 1) where a resonance was refused rightly."""
    line = random_line(seed)
    with mpmath.workdps(DIGITS):
        exact = Exact(line.model, line.model.component_of(line.drive[0]))
        try:
            value, estimate = answer(line, solver)
        except rd.SolveError:
            # an assembled stiffness may have lost all digits where the chain has them
            refuses = solver == "lapack" or has_no_answer(exact, line)
            assert refuses, f"refused without need: {seed}"
            return 0.0, 1.0
        h = response(exact, line.frequency, line.drive, line.response)
        if value == 0:
            # 0, or less than there are numbers
            omega = omega_of(line.frequency)
            is_zero = abs(h) < np.finfo(float).tiny
            is_zero = is_zero or is_rounding(exact, omega, line.drive, line.response)
            return (0.0 if is_zero else np.inf), estimate
        return float(abs(h / mpmath.mpmathify(complex(value)) - 1)), estimate


def sample(count, solver):
    """Errors and estimates of so many lines."""
    return np.array([error_and_estimate(seed, solver) for seed in range(count)]).T


def median_of_ratio(error, estimate):
    # an error below half an ulp is luck, and a refusal estimates nothing
    some = estimate < 1
    return np.median(estimate[some] / np.maximum(error[some], EPS / 2))


SOLVERS = ("sweep", "band", "lapack")


@pytest.fixture(scope="module", params=SOLVERS)
def few(request):
    return sample(FEW, request.param)


@pytest.fixture(scope="module", params=SOLVERS)
def many(request):
    return sample(MANY, request.param)


@pytest.mark.claim(
    f"rounding_error of an FRF bounds the true error: share of {FEW} random lines beyond it",
    reference=EXACT,
    accepted=0.0,
)
def test_rounding_error_bounds_the_true_error_of_random_lines(few, claim):
    error, estimate = few
    claim(np.mean(error > estimate))


@pytest.mark.claim(
    f"rounding_error of an FRF over the true error, median of {FEW} random lines",
    reference=EXACT,
    accepted=10.0,
)
def test_rounding_error_is_no_useless_bound(few, claim):
    claim(median_of_ratio(*few))


@pytest.mark.slow
@pytest.mark.claim(
    f"rounding_error of an FRF bounds the true error: share of {MANY} random lines beyond it",
    reference=EXACT,
    accepted=0.0,
)
def test_rounding_error_bounds_the_true_error_of_very_many_lines(many, claim):
    error, estimate = many
    claim(np.mean(error > estimate))


@pytest.mark.slow
@pytest.mark.claim(
    f"rounding_error of an FRF over the true error, median of {MANY} random lines",
    reference=EXACT,
    accepted=10.0,
)
def test_rounding_error_of_very_many_lines_is_no_useless_bound(many, claim):
    claim(median_of_ratio(*many))


@pytest.mark.parametrize(
    "seed",
    [
        pytest.param(500288, id="bending fades within an element"),
        pytest.param(500404, id="bending fades over two"),
        pytest.param(501668, id="pushed, twist and bending nearly one"),
        pytest.param(503597, id="twist and pull nearly one"),
        pytest.param(115, id="faded to nothing at rest", marks=pytest.mark.slow),
        pytest.param(486, id="singular at rest", marks=pytest.mark.slow),
        pytest.param(701, id="faded behind heavy masses", marks=pytest.mark.slow),
        pytest.param(5497, id="faded along equal elements"),
        pytest.param(4693, id="free to turn at rest"),
    ],
)
@pytest.mark.parametrize("solver", SOLVERS)
def test_rounding_error_bounds_lines_that_bounds_to_first_order_missed(seed, solver):
    error, estimate = error_and_estimate(seed, solver)
    assert error <= estimate


def span_error_and_limit(seed):
    """Absolute error and bound of a damped response of continuous spans; None where refused."""
    scene, f, drive, other = random_spans(seed)
    scene = damped(np.random.default_rng([seed, 3]), scene)
    with mpmath.workdps(DIGITS):
        try:
            frf = scene.compile().frf(f, drive=drive, response=other, threads=1)
            exact = Continuum(scene, coupled(scene, drive[0]))
            h = exact.receptance(omega_of(f), drive, [other])[0]
        except (rd.SolveError, ZeroDivisionError):
            return None
        value = complex(frf.value[0, 0])
        if value == 0 and abs(h) < 1e-100:
            h = 0  # by symmetry, but for 60 digits
        error = float(abs(mpmath.mpmathify(value) - h))
    return error, frf.rounding_limit[0, 0], abs(value)


@pytest.mark.parametrize("seeds", samples(FEW_SPANS, MANY))
@pytest.mark.claim(
    "rounding_limit of an FRF of damped continuous spans over the true error, median of random "
    "lines, none of which is beyond it",
    reference="mpmath, 60 digits, from the numbers of the scene: tests/support/exact_span.py",
    accepted=10.0,
)
def test_rounding_limit_bounds_responses_of_damped_spans_and_is_no_useless_bound(seeds, claim):
    found = np.array([one for one in map(span_error_and_limit, seeds) if one])
    error, limit, value = found.T
    assert len(found) > 0.8 * len(seeds)
    assert (error <= limit).all()
    moves = value > 0
    claim(np.median(limit[moves] / np.maximum(error, EPS / 2 * value)[moves]))


@pytest.mark.parametrize("share", [1e-3, 1e-6, 1e-9])
@pytest.mark.parametrize("solver", SOLVERS)
def test_tensed_chain_just_short_of_its_critical_load_is_known_to_its_rounding_error(share, solver):
    # clamped and free, of two elements: k l of each is just short of pi, and its tip hardly moves
    length, B = 1.0, 1.0
    load = 4 * math.pi**2 * B * (1 - share)
    rope = rd.Rope(length, 0.1, bending_stiffness=B)
    scene = rd.Scene(rope, tension=-load, ends=("clamped", "free"))
    model = scene.compile(elements=2, element="tensed")
    frf = model.frf(0.0, drive=("z", 1.0), solver=solver)
    with mpmath.workdps(50):
        # tip of a cantilever that is pushed: (tan k L/k - L)/P, P = B k^2
        P = mpmath.mpf(load)
        k = mpmath.sqrt(P / B)
        exact = (mpmath.tan(k * length) / k - length) / P
        error = float(abs(mpmath.mpf(frf.value[0, 0].real) - exact))
        near = mpmath.mpf(load) * (1 + mpmath.mpf(10) ** -20)
        other = mpmath.sqrt(near / B)
        moved = (mpmath.tan(other * length) / other - length) / near
        condition = 1 + float(abs(moved / exact - 1)) * 1e20
    assert error <= frf.rounding_limit[0, 0]
    if solver != "lapack":  # whose entries are 1e2 times what the chain resists with
        assert frf.rounding_limit[0, 0] <= 50 * EPS * condition * float(abs(exact))


# resonances and antiresonances -------------------------------------------------------------------


@pytest.fixture(scope="module", params=["chain", "span"])
def resonant(request):
    return np.array([error_and_limit(*line) for line in kept_lines(request.param)]).T


@pytest.mark.claim(
    "rounding_limit of an FRF at and next to resonances and antiresonances: share of a few lines "
    "beyond it",
    reference=EXACT,
    accepted=0.0,
)
def test_rounding_limit_bounds_the_true_error_where_a_response_changes_its_sign(resonant, claim):
    error, limit, _ = resonant
    assert len(error) >= 5
    claim(np.mean(error > limit))


@pytest.mark.claim(
    "rounding_limit of an FRF at and next to resonances and antiresonances over the true error, "
    "median of a few lines",
    reference=EXACT,
    accepted=10.0,
)
def test_rounding_limit_is_no_useless_bound_where_a_response_changes_its_sign(resonant, claim):
    error, limit, value = resonant
    claim(np.median(limit / np.maximum(error, EPS / 2 * value)))


@pytest.mark.slow
@pytest.mark.claim(
    f"rounding_limit of an FRF at and next to resonances and antiresonances: share of the lines of "
    f"{RESONANT_MANY} random scenes of each kind beyond it",
    reference=EXACT,
    accepted=0.0,
)
@pytest.mark.parametrize("kind", ["chain", "span"])
def test_rounding_limit_bounds_very_many_lines_where_a_response_changes_its_sign(kind, claim):
    lines = (exact_line(seed, kind) for seed in range(10_000, 10_000 + RESONANT_MANY))
    error, limit, _ = np.array([error_and_limit(*line) for line in lines if line]).T
    claim(np.mean(error > limit))


DRIVE = ("z", 0.5)


@pytest.mark.parametrize("beside", [1e-3, 1e-5, 1e-6, 1e-9, 0.0])
def test_antiresonance_of_a_loaded_string_is_known_to_its_rounding_error(beside):
    # the part of the string to the right of its middle is half a wave long at 100 Hz
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0, parts=[rd.PointMass(0.3, 0.1)])
    f = 100.0 * (1 + beside)
    frf = scene.compile().frf(f, drive=DRIVE)
    with mpmath.workdps(40):
        h = _loaded_string(mpmath.mpf(f), mpmath.mpf(0.3), mpmath.mpf(0.1))
        error = float(abs(mpmath.mpf(frf.value[0, 0].real) - h))
    assert error <= frf.rounding_limit[0, 0] <= 200 * EPS * 1e-4
    assert frf.rounding_error[0, 0] >= error / abs(frf.value[0, 0])


def _loaded_string(f, at, mass):
    """z(0.5) per force there of a string of 1 m, 0.1 kg/m, 1000 N with a mass."""
    tension, omega = mpmath.mpf(1000), 2 * mpmath.pi * f
    k = omega * mpmath.sqrt(mpmath.mpf(0.1) / tension)
    # stiffness left of the middle, carried over the mass, and right of it
    left = tension * k * mpmath.cot(k * at) - mass * omega**2
    gap, wave = mpmath.mpf(0.5) - at, tension * k
    s, c = mpmath.sin(k * gap), mpmath.cos(k * gap)
    left = wave * (left * c - wave * s) / (left * s + wave * c)
    return 1 / (left + wave * mpmath.cot(k / 2))


def test_response_that_is_0_has_an_infinite_relative_and_a_finite_absolute_bound():
    frf = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile().frf(30.0, drive=DRIVE)
    nothing = type(frf.rounding).of(np.zeros((1, 1), dtype=complex), frf.rounding_limit)
    assert np.isinf(nothing.rounding_error).all()
    assert np.isfinite(nothing.rounding_limit).all()


@pytest.mark.parametrize("beside", [1e-3, 1e-6, 1e-9, 1e-12, 1e-15])
@pytest.mark.parametrize("solver", SOLVERS)
def test_light_and_slow_resonator_near_its_own_frequency_is_known_to_its_error(beside, solver):
    # what is left of its spring less its inertia has lost the digits, whoever solves the chain
    own, mass, at = 1e-3, 1e-3, 4
    scene = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0)
    model = scene.replace(parts=[rd.Resonator(at / 10, mass, own)]).compile(elements=10)
    f = own * (1 + beside)
    frf = model.frf(f, drive=("z", model.x[at]), solver=solver)
    with mpmath.workdps(40):
        # sin(j theta) solves the string of beads, cos theta = 1 - omega^2 m l/2T
        bead, pull = mpmath.mpf(0.1) / 10, mpmath.mpf(1000.0) * 10
        theta = mpmath.acos(1 - omega_of(f) ** 2 * bead / (2 * pull))
        h = mpmath.sin(at * theta) * mpmath.sin((10 - at) * theta)
        h /= pull * mpmath.sin(theta) * mpmath.sin(10 * theta)
        inertia, spring = -(omega_of(f) ** 2) * mass, omega_of(own) ** 2 * mass
        h /= 1 + h * inertia * spring / (spring + inertia)
        error = float(abs(h - mpmath.mpf(frf.value[0, 0].real)))
    assert error <= frf.rounding_limit[0, 0]
    assert error <= frf.rounding_bound[0, 0] * abs(frf.value[0, 0])
    assert frf.rounding_limit[0, 0] <= 10 * max(error, EPS * float(abs(h)))


WAYS = {
    "copied": lambda frf, folder: copy.deepcopy(frf),
    "unpickled": lambda frf, folder: pickle.loads(pickle.dumps(frf)),
    "loaded": lambda frf, folder: (frf.save(folder / "frf.nc"), rd.load(folder / "frf.nc"))[1],
}


@pytest.mark.parametrize("is_read", [False, True], ids=["unread", "read"])
@pytest.mark.parametrize("way", WAYS)
def test_errors_and_bounds_travel_with_a_response(way, is_read, tmp_path):
    model = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile()
    frf, here = (model.frf([30.0, 70.0], drive=DRIVE) for _ in range(2))
    if is_read:
        assert frf.rounding_error.shape == frf.rounding_bound.shape
    there = WAYS[way](frf, tmp_path)
    for name in ("rounding_error", "rounding_limit", "rounding_measured", "rounding_bound"):
        assert getattr(there, name).tobytes() == getattr(here, name).tobytes()
        assert not getattr(there, name).flags.writeable
    assert (there.rounding_bound > there.rounding_error).all()


def test_motion_that_stands_still_has_no_bound_of_what_it_was():
    # at 0 Hz velocity and acceleration are 0, and nothing rounds there
    frf = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile().frf([0.0, 70.0], drive=DRIVE)
    turned = frf.to("accelerance")
    assert (frf.rounding_bound > 0).all()
    assert turned.rounding_bound[0].tolist() == [0.0, pytest.approx(frf.rounding_bound[0, 1])]
    assert turned.rounding_error[0, 0] == turned.rounding_limit[0, 0] == 0


def test_bounds_follow_the_quantity():
    frf = rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0).compile().frf([30.0, 70.0], drive=DRIVE)
    asked, turned = (
        rd.Scene(rd.Rope(1.0, 0.1), tension=1000.0)
        .compile()
        .frf([30.0, 70.0], drive=DRIVE, quantity="accelerance"),
        frf.to("accelerance"),
    )
    np.testing.assert_allclose(turned.rounding_limit, asked.rounding_limit, rtol=1e-14)
    np.testing.assert_allclose(turned.rounding_error, frf.rounding_error, rtol=1e-14)
    np.testing.assert_allclose(turned.rounding_bound, asked.rounding_bound, rtol=1e-14)
