"""The mixed form by band LU: an oracle that shares no formula with the sweep but the triples."""

import math

import exact_mixed
import mpmath
import numpy as np
import pytest
from conftest import EPS
from exact_chain import omega_of, relative
from mpmath import mpf
from test_rounding_error import error_and_estimate
from test_sweep_frf import BENDING, DAMPINGS, DENSITY, LENGTH, WIDE, pinned_middle

import ropedyn as rd

KINDS = ["difference", "rigid", "tensed"]


# seeds other than those of the sweep's own sample
SAMPLE = range(1000, 1100)


@pytest.fixture(scope="module")
def sample():
    return np.array([error_and_estimate(seed, "band") for seed in SAMPLE])


@pytest.mark.parametrize("seed", SAMPLE)
def test_rounding_error_bounds_the_true_error_of_a_line(sample, seed):
    error, estimate = sample[seed - SAMPLE[0]]
    assert error <= estimate


def test_rounding_error_is_no_useless_bound(sample):
    # within 10^3 of the true error in the median; an error below half an ulp is luck
    error, estimate = sample.T
    assert np.median(estimate / np.maximum(error, EPS / 2)) < 1e3


@pytest.mark.parametrize("f", [0.01, 1.0, 111.0, 1111.0])
@pytest.mark.parametrize("tension", [0.0, 30.0, 2830.0])
@pytest.mark.parametrize("n", [10, 100, 1000, 10**4])
def test_error_of_a_long_pinned_chain_grows_no_faster_than_its_length(n, tension, f):
    ends = ("pinned", "pinned")
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING)
    model = rd.Scene(rope, tension=tension, ends=ends).compile(elements=n, element="rigid")
    frf = model.frf(f, drive=("z", LENGTH / 2), solver="band")
    with mpmath.workdps(60):
        h = pinned_middle(n, tension, f)
        step = mpf(10) ** -20
        slope = abs(pinned_middle(n, tension, mpf(f) * (1 + step)) / h - 1) / step
        error = relative(frf.value[0, 0], h)
    # condition of the scaled mixed form: about n; measured 0.1 n eps at most
    assert error <= n * EPS * float(1 + slope)
    # |y|^T |M| |x| adds n blocks of one sign: its own growth is n, 8 n eps measured
    assert error <= frf.rounding_error[0, 0] <= 40 * n * EPS * float(1 + slope)


def rich(seed):
    """A scene of all that a chain can carry, width 1 to 4."""
    random = np.random.default_rng(seed)
    ends = tuple(random.choice(["clamped", "pinned", "free"], 2).tolist())
    rope = WIDE.replace(
        lay_coupling=None if random.random() < 0.5 else -200.0,
        lay_slope=None if random.random() < 0.5 else 0.3,
    )
    parts = [
        rd.PointMass(0.3, float(10 ** random.uniform(-3, 3)), rotary_inertia=1e-3),
        rd.Spring(0.7, float(10 ** random.uniform(0, 4))),
        rd.Spring(0.7, 3.0, coordinate="beta"),
        rd.Support(1.0, coordinate=str(random.choice(["z", "alpha", "beta"]))),
    ]
    damping = DAMPINGS[str(random.choice(list(DAMPINGS)))]
    # critical loads of the stretches between the supports are above 40 N
    tension = float(random.choice([0.0, 60.0, -10.0]))
    return rd.Scene(rope, tension=tension, ends=ends, parts=parts, damping=damping)


@pytest.mark.parametrize("n", [5, 64, 1000])
@pytest.mark.parametrize("element", KINDS)
@pytest.mark.parametrize("seed", range(4))
def test_band_and_sweep_agree_to_their_rounding_errors(seed, element, n):
    scene = rich(seed)
    if element == "difference":
        scene = scene.without("tension")
    model = scene.compile(elements=n, element=element)
    # off the nodes too
    points = [("z", 0.3), ("beta", 0.9), ("x", 0.123), ("alpha", 0.9), ("z", 1.234)]
    f = np.array([0.5, 37.0, 411.0, 2222.0])
    sweep, band = (model.frf(f, drive=points, response=points, solver=s) for s in ("sweep", "band"))
    allowed = sweep.rounding_error + band.rounding_error
    both = np.isfinite(allowed)
    difference = np.abs(band.value - sweep.value)
    assert (difference[both] <= (allowed * np.abs(sweep.value))[both]).all()
    # infinite only where the value is 0 in both
    assert (difference[~both] == 0).all()
    assert band.rounding_error[both].max() < 1e-6


@pytest.mark.parametrize("element", KINDS)
def test_internal_forces_are_those_of_the_exact_discrete_chain(element):
    scene = rich(3) if element != "difference" else rich(3).without("tension")
    model = scene.compile(elements=8, element=element)
    component = model.component_of("z")
    x, f, gamma = model.x.tolist(), 37.0, scene.damping.gamma
    forces = {"F_z": "z", "M_alpha": "alpha", "M_beta": "beta"}
    points = [(name, x[node]) for name in forces for node in (3, 8)]
    frf = model.frf(f, drive=("z", x[5]), response=points, solver="band")
    with mpmath.workdps(40):
        omega = omega_of(f)
        g = 1 + 1j * omega * mpf(gamma)
        exact = exact_mixed.Exact(model, component, omega, (g, 1, g)).solve(5, "z")
        for k, (name, node) in enumerate((name, node) for name in forces for node in (3, 8)):
            error = relative(frf.value[k, 0], exact.force(node, forces[name]))
            # the reader of a force is as exact as that of a motion: 1e-13 is a few condition 8
            assert error <= frf.rounding_error[k, 0] <= 1e-11


@pytest.mark.parametrize("element", KINDS)
def test_reactions_at_both_ends_are_those_of_the_sweep(element):
    model = rd.Scene(WIDE, tension=0.0).compile(elements=8, element=element)
    points = [(force, x) for force in ("F_z", "M_beta", "F_x") for x in (0.0, LENGTH)]
    drives = [("z", float(model.x[3])), ("x", float(model.x[5]))]
    sweep, band = (
        model.frf([1.0, 90.0], drive=drives, response=points, solver=s) for s in ("sweep", "band")
    )
    allowed = (sweep.rounding_error + band.rounding_error) * np.abs(sweep.value)
    known = np.isfinite(allowed)
    assert (np.abs(band.value - sweep.value)[known] <= allowed[known]).all()


@pytest.mark.parametrize("element", KINDS)
@pytest.mark.parametrize("n", [6, 500])
def test_static_band_and_sweep_agree(n, element):
    scene = rich(5) if element != "difference" else rich(5).without("tension")
    scene = scene.replace(ends=("clamped", "pinned"))
    model = scene.compile(elements=n, element=element)
    load = {("z", 0.4): 3.0, ("beta", 1.1): -0.2, ("alpha", 0.777): 0.1, ("x", 0.3): 5.0}
    sweep, band = (model.static(load, solver=s) for s in ("sweep", "band"))
    # both lose n eps at most; forces are compared with the largest of their kind
    for one, other in ((band.displacement, sweep.displacement), (band.force, sweep.force)):
        assert (np.abs(one - other).max(axis=0) <= 16 * n * EPS * np.abs(other).max(axis=0)).all()


def test_static_deflection_of_a_thousand_clamped_elements_is_the_textbook_s():
    # F L^3/192 B; the assembled stiffness loses 50 (n/pi)^4 eps = 1e-4 here
    L, B, n = 2.0, 7.0, 1000
    static = rd.Scene(rd.Rope(L, 0.1, bending_stiffness=B)).compile(elements=n)
    static = static.static({("z", L / 2): 1.0}, solver="band")
    assert static.displacement[n // 2, 0] == pytest.approx(L**3 / (192 * B), rel=n * EPS)


def test_massless_disc_and_heavy_mass_do_not_hurt():
    # a node without inertia between strings, one of 1e12 kg: h = 1/(2 T/a - omega^2 m)
    T, a = 100.0, 0.25
    rope = rd.Rope(2 * a, 1e-12)
    for mass in (0.0, 1e12):
        model = rd.Scene(rope, tension=T, parts=[rd.PointMass(a, mass)]).compile(elements=2)
        frf = model.frf(3.0, drive=("z", a), solver="band")
        exact = 1 / (2 * T / a - (6 * math.pi) ** 2 * (mass + a * 1e-12))
        # a handful of roundings, no cancellation: one term dominates
        assert frf.value[0, 0].real == pytest.approx(exact, rel=16 * EPS)


@pytest.mark.parametrize("share", [0.5, 0.9, 0.999, 0.99999, 1.00001, 1.001, 1.5])
def test_response_near_the_critical_load_is_known_to_its_rounding_error(share):
    # two pinned rigid elements of length a: 1/h = 2 (3 B/a^3 + T/a), and each is a cantilever at
    # its own critical load when the whole is
    B, a = 2.0, 0.5
    T = -share * 3 * B / a**2
    rope = rd.Rope(2 * a, 0.1, bending_stiffness=B)
    model = rd.Scene(rope, tension=T, ends=("pinned", "pinned")).compile(
        elements=2, element="rigid"
    )
    frf = model.frf(0.0, drive=("z", a), solver="band")
    error = relative(frf.value[0, 0], 1 / (2 * (3 * mpf(B) / a**3 + mpf(T) / a)))
    # the triple's own pole and the answer's: (1 - share)^-2 each eps, 1e2 of them as a bound
    assert error <= frf.rounding_error[0, 0] <= 1e2 * EPS / (1 - share) ** 2


def test_same_bits_whatever_the_threads():
    model = rich(2).compile(elements=300, element="tensed")
    f = np.linspace(1.0, 500.0, 200)
    one, four = (model.frf(f, drive=("z", 0.3), solver="band", threads=t) for t in (1, 4))
    assert (one.value == four.value).all()
    assert (one.rounding_error == four.rounding_error).all()
