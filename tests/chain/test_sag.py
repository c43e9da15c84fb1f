"""Sag under gravity: Irvine's cable in closed form, with bending in many digits, and as a chain."""

import math

import mpmath
import numpy as np
import pytest
from conftest import EPS
from exact_chain import condition as chain_condition
from exact_chain import error_over_condition, omega_of, relative
from exact_span import Continuum, coupled
from mpmath import mpf
from parabolas import parabola
from random_scene import log_uniform
from spans import is_counted, worst_error

import ropedyn as rd

TENSION, DENSITY, LENGTH = 100.0, 0.1, 1.0
CROSSOVER = 4 * math.pi**2
DIGITS = 50


def hanging(parameter, *, axial=None, inclination=0.0, **more):
    """Return a scene of nearly this lambda^2, the sag below an eighth of the span."""
    slope2 = parameter * TENSION / axial if axial else min(0.01, parameter)
    axial = axial or parameter * TENSION / slope2
    g = math.sqrt(slope2 / (1 - slope2 / 8)) * TENSION / (DENSITY * LENGTH)
    rope = rd.Rope(LENGTH, DENSITY, axial_stiffness=axial, **more.pop("rope", {}))
    gravity = rd.Gravity(
        g / math.cos(inclination), inclination=inclination, own_weight=inclination == 0
    )
    return rd.Scene(rope, tension=TENSION, gravity=gravity, **more)


def beam(parameter, stiff, **more):
    """The same with T L^2/B = stiff."""
    return hanging(parameter, rope={"bending_stiffness": TENSION * LENGTH**2 / stiff}, **more)


def exact_parameter(scene):
    """lambda^2 of the scene's own numbers."""
    T, EA, g = mpf(scene.tension), mpf(scene.rope.axial_stiffness), mpf(scene.gravity.g)
    slope = mpf(scene.rope.linear_density) * g * mpmath.cos(mpf(scene.gravity.inclination))
    slope *= mpf(scene.rope.length) / T
    return slope**2 * EA / (T * (1 + slope**2 / 8))


def irvine(scene, number):
    """Frequencies of a string that hangs [Hz], as they come: symmetric, antisymmetric.

    tan x = x - 4 x^3/lambda^2 with x = Omega/2 has one root in each of (pi/2, 3 pi/2), ...;
    without the poles of the tangent: sin x - x cos x + 4 x^3/lambda^2 cos x = 0.
    """
    with mpmath.workdps(DIGITS):
        lam2 = exact_parameter(scene)

        def function(x):
            return mpmath.sin(x) - x * mpmath.cos(x) + 4 / lam2 * x**3 * mpmath.cos(x)

        unit = mpmath.sqrt(mpf(scene.tension) / mpf(scene.rope.linear_density))
        unit /= 2 * mpmath.pi * mpf(scene.rope.length)
        roots = [
            mpmath.findroot(function, (k * mpmath.pi / 2, (k + 2) * mpmath.pi / 2), "anderson")
            for k in range(1, 2 * number, 2)
        ]
        return [
            [2 * x * unit for x in roots],
            [2 * k * mpmath.pi * unit for k in range(1, number + 1)],
        ]


def errors(frequency, exact):
    with mpmath.workdps(DIGITS):
        return max(float(abs(mpf(f) / e - 1)) for f, e in zip(frequency, exact, strict=True))


# strings -----------------------------------------------------------------------------------------

PARAMETERS = [1e-12, 1e-3, 1.0, 30.0, 39.0, 40.0, 300.0, 1e4, 1e6, 1e9]


@pytest.mark.parametrize("parameter", PARAMETERS)
@pytest.mark.claim(
    "Nine frequencies of a hanging string, sag parameter 1e-12 to 1e9: relative error",
    reference="Irvine and Caughey 1974, roots of tan(Omega/2) in 50 digits: test_sag.py",
    accepted=1e-14,
)
def test_hanging_string_has_irvines_frequencies(parameter, claim):
    scene = hanging(parameter)
    modes = parabola(scene).modes(9)
    assert modes.certified
    symmetric, antisymmetric = irvine(scene, 5)
    exact = sorted([*symmetric, *antisymmetric])[:9]
    # T, mu, w, EA and L round: half their logarithmic derivatives, 3 eps, and their sums
    claim(errors(modes.frequency, exact))
    # in many digits: exact frequencies that are rounded themselves are off by as much
    for frequency, bound, root in zip(modes.frequency, modes.rounding_error, exact, strict=True):
        with mpmath.workdps(DIGITS):
            assert abs(mpf(frequency) - root) <= bound


@pytest.mark.parametrize("parameter", [1e-6, 1.0, 30.0, 1e3, 1e8])
def test_sag_does_not_change_antisymmetric_modes(parameter):
    # the axial modes of the rope without sag are far above
    scene = hanging(parameter, axial=1e10)
    sagging, straight = (parabola(s).modes(7).frequency for s in (scene, scene.without("sag")))
    for antisymmetric in straight[1::2]:
        # rounding of two walks of a few pieces each
        assert np.abs(sagging / antisymmetric - 1).min() <= 1e-14


def test_first_symmetric_mode_passes_the_first_antisymmetric_one_at_the_crossover():
    below, above = (parabola(hanging(CROSSOVER * q)).modes(2) for q in (0.99, 1.01))
    assert below.energy["stretch"][0] > 0.1 > 1e-3 > below.energy["stretch"][1]
    assert above.energy["stretch"][1] > 0.1 > 1e-3 > above.energy["stretch"][0]


def test_both_modes_of_the_crossover_are_found_and_counted():
    scene = hanging(CROSSOVER)
    model = parabola(scene)
    modes = model.modes(3)
    twice = math.sqrt(TENSION / DENSITY) / LENGTH
    # d ln Omega/d ln lambda^2 is below 1, and lambda^2 is off by the rounding of its factors
    np.testing.assert_allclose(modes.frequency[:2], twice, rtol=10 * EPS)
    assert modes.certified
    assert [model.count(below=twice * q) for q in (1 - 1e-9, 1 + 1e-9)] == [0, 2]
    # one of them stretches the rope, whichever combination is shown
    assert modes.energy["stretch"][:2].max() > 0.1


def test_inextensible_string_has_the_root_of_the_tangent():
    # tan x = x: Omega = 2.8606 pi; lambda^2 = 1e12 leaves 16 x^2/lambda^2 of it
    frequency = parabola(hanging(1e12)).modes(2).frequency
    root = float(mpmath.findroot(lambda x: mpmath.sin(x) - x * mpmath.cos(x), 4.49))
    assert round(2 * root / math.pi, 4) == 2.8606
    assert frequency[0] == pytest.approx(math.sqrt(TENSION / DENSITY) / LENGTH, rel=10 * EPS)
    assert frequency[1] == pytest.approx(
        2 * root / (2 * math.pi) * math.sqrt(TENSION / DENSITY), rel=1e-10
    )


@pytest.mark.parametrize("inclination", [-1.2, 0.4, 1.5])
def test_inclined_rope_hangs_by_the_part_of_its_weight_across_it(inclination):
    level, inclined = hanging(20.0), hanging(20.0, inclination=inclination)
    first, second = (parabola(s).modes(4).frequency for s in (level, inclined))
    # g/cos cos: two roundings of g, whose logarithmic derivative is below 1
    np.testing.assert_allclose(second, first, rtol=20 * EPS)


def test_turning_gravity_round_turns_motion_along_the_rope_alone():
    scene = beam(20.0, 100.0)
    turned = scene.replace(gravity=rd.Gravity(-scene.gravity.g))
    first, second = (parabola(s).modes(4) for s in (scene, turned))
    # two searches begin elsewhere and end within the rounding of one walk
    np.testing.assert_allclose(second.frequency, first.frequency, rtol=10 * EPS)
    # either sign of an antisymmetric shape has a largest component of 1
    first, second = (m.shape[..., :1] * m.shape[..., 1:] for m in (first, second))
    np.testing.assert_allclose(second, -first, rtol=0, atol=1e-12)


def test_without_a_hold_along_the_rope_sag_stiffens_nothing():
    sliding = rd.End(x="free", beta="free")
    scene = beam(100.0, 50.0, ends=("pinned", sliding))
    assert parabola(scene).modes(3).frequency == pytest.approx(
        scene.without("sag").compile().modes(3).frequency, rel=20 * EPS
    )


def test_rope_that_nothing_lifts_moves_across_itself_and_along():
    # z = 1 all along moves the sliding end by w L/T, and nothing resists it
    rising = rd.End(z="free", beta="free")
    scene = beam(30.0, 50.0, ends=(rising, "free"))
    modes = parabola(scene).modes(3)
    assert modes.frequency[0] == 0
    x, z, _ = modes.shape[0, -1]
    slope = DENSITY * scene.gravity.g * LENGTH / TENSION
    assert x / z == pytest.approx(slope, rel=1e-12)
    straight = scene.without("sag").compile().modes(10)
    across = straight.frequency[straight.family == "transverse"][:3]
    np.testing.assert_allclose(modes.frequency, across, rtol=1e-13)


# with bending ------------------------------------------------------------------------------------


def pinned(scene, near):
    """A frequency of a pinned beam that hangs [Hz] from the sum over the modes without sag.

    1 + (EA/L_e)(w/T)^2 sum over odd n of 8 L/(n^2 pi^2 mu (omega_n^2 - omega^2)) = 0.
    """
    with mpmath.workdps(30):
        L, T, mu = (mpf(v) for v in (scene.rope.length, scene.tension, DENSITY))
        B = mpf(scene.rope.bending_stiffness)
        # (EA/L_e)(w/T)^2 = lambda^2 T/L^3
        unit = exact_parameter(scene) * T / L**3 * 8 * L / (mpmath.pi**2 * mu)

        def function(f):
            def term(k):
                n = 2 * k + 1
                q = (n * mpmath.pi / L) ** 2
                return 1 / (n**2 * ((B * q + T) * q / mu - (2 * mpmath.pi * f) ** 2))

            return 1 + unit * mpmath.nsum(term, [0, mpmath.inf])

        return mpmath.findroot(function, (mpf(near) * (1 - mpf(10) ** -9), mpf(near)))


@pytest.mark.parametrize(("parameter", "stiff"), [(0.01, 1e2), (20.0, 1e2)])
def test_pinned_beam_has_the_roots_of_its_sum_over_modes(parameter, stiff):
    scene = beam(parameter, stiff, ends=("pinned", "pinned"))
    modes = parabola(scene).modes(4)
    symmetric = np.flatnonzero(modes.energy["stretch"] > 1e-9)
    assert len(symmetric) >= 2
    exact = [pinned(scene, modes.frequency[k]) for k in symmetric]
    # as for strings; the secant begins 1e-9 away and must not leave
    assert errors(modes.frequency[symmetric], exact) <= 1e-14


def beam_error(parameter, stiff, end):
    """Largest error of two eigenvalues of a hanging beam over their sensitivity."""
    scene = beam(parameter, stiff, ends=(end, end))
    modes = parabola(scene).modes(3)
    assert modes.certified
    return worst_error(scene, modes, [0, 2])


@pytest.mark.parametrize(
    ("parameter", "stiff", "end"), [(0.01, 1e2, "pinned"), (1e4, 1e3, "clamped")]
)
@pytest.mark.claim(
    "Frequencies of hanging beams, sag parameter 0.01 and 1e4: error of an eigenvalue over its "
    "sensitivity",
    reference="zeros of the determinant in 60 digits: tests/support/exact_roots.py",
    accepted=2e-14,
)
def test_hanging_beam_has_its_exact_frequencies(parameter, stiff, end, claim):
    claim(beam_error(parameter, stiff, end))


@pytest.mark.slow
@pytest.mark.parametrize("end", ["clamped", "pinned"])
@pytest.mark.parametrize("stiff", [1e2, 1e4, 1e7])
@pytest.mark.parametrize("parameter", [0.01, 30.0, 1e4])
@pytest.mark.claim(
    "Frequencies of hanging beams, sag parameter 0.01 to 1e4, T L^2/B 1e2 to 1e7: error of an "
    "eigenvalue over its sensitivity",
    reference="zeros of the determinant in 60 digits: tests/support/exact_roots.py",
    accepted=1e-13,
)
def test_hanging_beams_of_any_stiffness_have_their_exact_frequencies(parameter, stiff, end, claim):
    claim(beam_error(parameter, stiff, end))


@pytest.mark.slow
@pytest.mark.parametrize("parameter", [5.0, 1e3])
def test_no_mode_of_a_hanging_beam_is_missed(parameter):
    scene = beam(parameter, 1e2, parts=[rd.PointMass(0.3, 0.05)])
    assert is_counted(scene, parabola(scene).modes(5))


LAID = {
    "bending_stiffness": 0.8,
    "torsional_stiffness": 0.3,
    "lay_coupling": 4.0,
    "lay_slope": 0.3,
    "polar_inertia": 1e-6,
}


def test_sag_joins_all_coordinates_of_a_laid_rope():
    scene = hanging(30.0, rope=LAID)
    modes = parabola(scene).modes(4)
    assert parabola(scene).components == (("x", "z", "alpha", "beta"),)
    # a sum over half waves and pieces of four coordinates, as for beams
    assert worst_error(scene, modes, [1]) <= 1e-13


def test_sag_joins_stretch_and_bending_and_not_twist():
    scene = beam(30.0, 1e2)
    scene = scene.replace(rope=scene.rope.replace(torsional_stiffness=0.3, polar_inertia=1e-6))
    assert parabola(scene).components == (("x", "z", "beta"), ("alpha",))
    assert scene.without("sag").compile().components == (("x",), ("z", "beta"), ("alpha",))


# answers -----------------------------------------------------------------------------------------


def some_scene(random):
    """A rope that hangs, and a frequency [Hz]."""
    stiff = log_uniform(random, 1.0, 1e7)
    width = int(random.choice([2, 3, 4]))
    rope = {} if width == 2 else {"bending_stiffness": TENSION / stiff}
    if width == 4:
        rope["torsional_stiffness"] = rope["bending_stiffness"] * log_uniform(random, 0.1, 10)
        rope |= {"lay_slope": random.uniform(-1, 1), "polar_inertia": 1e-6}
    coordinates = ["x", "z"]
    parts = [
        rd.PointMass(random.uniform(0.1, 0.9), log_uniform(random, 1e-3, 1.0)),
        rd.Support(random.uniform(0.1, 0.9), coordinate=str(random.choice(coordinates))),
        rd.Spring(random.uniform(0.1, 0.9), 500.0, coordinate=str(random.choice(coordinates))),
    ]
    sliding = rd.End(x="free", beta="free")
    ends = ("clamped", sliding if random.random() < 0.3 else "pinned")
    damping = rd.RayleighDamping(1.0, log_uniform(random, 1e-7, 1e-4))
    scene = hanging(
        log_uniform(random, 1e-6, 1e6),
        rope=rope,
        parts=[part for part in parts if random.random() < 0.5],
        ends=ends,
        damping=damping if random.random() < 0.5 else None,
    )
    return scene, math.sqrt(TENSION / DENSITY) * log_uniform(random, 0.05, 15.0)


def span_error(scene, f, drive, response):
    """Relative error of a response of continuous spans over the condition of the answer."""
    frf = parabola(scene).frf(f, drive=drive, response=response, threads=1)
    with mpmath.workdps(60):
        exact = Continuum(scene, coupled(scene, "z"))
        (value,) = exact.receptance(omega_of(f), drive, [response])
        error = relative(frf.value[0, 0], value)
        assert error <= frf.rounding_error[0, 0]
        if error > 1e-14:
            error /= chain_condition(exact, omega_of(f), drive, response)
    return error


def response_errors(seed):
    """Errors over conditions of a response of a random hanging rope and of a chain of it."""
    random = np.random.default_rng(seed)
    scene, f = some_scene(random)
    a, b = (str(random.choice(["x", "z"])) for _ in range(2))
    first = span_error(scene, f, (a, random.uniform(0.1, 0.9)), (b, random.uniform(0.1, 0.9)))
    n = int(random.choice([5, 9, 16]))
    model = parabola(scene, elements=n, element=str(random.choice(["tensed", "rigid"])))
    drive, response = (a, int(random.integers(1, n))), (b, int(random.integers(1, n)))
    second, covered = error_over_condition(model, f, drive, response)
    assert covered <= 1
    return max(first, second)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.claim(
    "Responses of hanging ropes and of chains of them: error / condition",
    reference="the spans and the discrete system in 60 digits: exact_span.py, exact_chain.py",
    accepted=1e-13,
)
def test_hanging_rope_responds_as_the_exact_one(seed, claim):
    claim(response_errors(seed))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4, 60))
@pytest.mark.claim(
    "Responses of 56 random hanging ropes and of chains of them, sag parameter 1e-6 to 1e6: error "
    "/ condition",
    reference="the spans and the discrete system in 60 digits: exact_span.py, exact_chain.py",
    accepted=1e-12,
)
def test_random_hanging_ropes_respond_as_the_exact_ones(seed, claim):
    claim(response_errors(seed))


@pytest.mark.parametrize("seed", range(1, 5))
def test_forces_inside_a_hanging_rope_are_the_exact_ones(seed):
    random = np.random.default_rng(300 + seed)
    scene, f = some_scene(random)
    # beside an end that slides the tension does not change: 0, which has no digits
    scene = scene.replace(ends=("clamped", "pinned"))
    force = ("F_x", "F_z")[seed % 2], random.uniform(0.1, 0.9)
    # as for motion
    assert span_error(scene, f, ("z", random.uniform(0.1, 0.9)), force) <= 1e-12


@pytest.mark.parametrize("parameter", [1e4, 1e9])
@pytest.mark.parametrize("stiff", [None, 1e5])
def test_rounding_of_modes_grows_neither_with_the_chain_nor_with_sag(parameter, stiff):
    scene = hanging(parameter) if stiff is None else beam(parameter, stiff)
    modes = parabola(scene, elements=4096).modes(6)
    assert modes.certified
    # that of a straight chain of as many elements, 1e-13, and room for sums over them
    assert (modes.rounding_error <= 1e-12 * modes.frequency).all()


@pytest.mark.parametrize("seed", range(12))
def test_two_cuts_of_a_hanging_rope_are_the_same_rope(seed):
    random = np.random.default_rng(100 + seed)
    scene, _ = some_scene(random)
    whole, cut = parabola(scene), parabola(scene, elements=13, element="continuous")
    first, second = (model.modes(5) for model in (whole, cut))
    assert (np.abs(first.frequency - second.frequency) <= first.rounding_error * 2).all()
    middle = (first.frequency[:-1] + first.frequency[1:]) / 2
    apart = np.diff(first.frequency) > 1e-6 * middle
    counts = [whole.count(below=f) for f in middle[apart]]
    assert counts == (1 + np.flatnonzero(apart)).tolist()


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("element", ["tensed", "rigid"])
def test_solvers_agree_on_hanging_chains(seed, element):
    random = np.random.default_rng(200 + seed)
    scene, f = some_scene(random)
    model = parabola(scene, elements=12, element=element)
    at, to = ("z", float(model.x[5])), ("x", float(model.x[7]))
    sweep, band, assembled = (
        model.frf(f, drive=at, response=[at, to], solver=s) for s in ("sweep", "band", "lapack")
    )
    # what the answers say of themselves, and for the assembled one n^2 of them and lambda^2 1e6
    bound = (sweep.rounding_error + band.rounding_error)[..., 0]
    assert (np.abs(band.value / sweep.value - 1)[..., 0] <= bound).all()
    np.testing.assert_allclose(assembled.value[0], sweep.value[0], rtol=1e-6)


@pytest.mark.parametrize("stiff", [3.0, 1e3])
@pytest.mark.parametrize(("element", "order"), [("tensed", 4), ("rigid", 2)])
def test_hanging_beams_keep_the_order_of_their_elements(stiff, element, order):
    scene = beam(30.0, stiff)
    true = parabola(scene).modes(3).frequency
    coarse, fine = (
        parabola(scene, elements=n, element=element).modes(3).frequency for n in (64, 128)
    )
    # the next term of the error is h^2 of it
    rate = np.log2(np.abs(coarse / true - 1) / np.abs(fine / true - 1))
    np.testing.assert_allclose(rate, order, atol=0.1)


def test_hanging_strings_keep_the_second_order():
    scene = hanging(30.0)
    true = parabola(scene).modes(3).frequency
    coarse, fine = (parabola(scene, elements=n).modes(3).frequency for n in (64, 128))
    rate = np.log2(np.abs(coarse / true - 1) / np.abs(fine / true - 1))
    np.testing.assert_allclose(rate, 2, atol=0.1)


@pytest.mark.parametrize("options", [{}, {"elements": 2}, {"elements": 8, "element": "rigid"}])
@pytest.mark.parametrize("parameter", [1e-6, 10.0, 1e6])
def test_load_in_the_middle_of_a_hanging_string(options, parameter):
    # the areas P L^2/8T under the load and L^3/12T under a unit one along the rope give
    # h = -(w/T) P L^2/8T/(L_e/EA + (w/T)^2 L^3/12T), and z = P L/4T + (w/T) h L^2/8T
    scene, load = hanging(parameter), 2.0
    with mpmath.workdps(30):
        q = exact_parameter(scene) / 12
        z = mpf(load) * LENGTH / (4 * mpf(TENSION)) * (1 - mpf(3) / 4 * q / (1 + q))
    answer = parabola(scene, **options).static({("z", LENGTH / 2): load})
    middle = int(np.abs(answer.x - LENGTH / 2).argmin())
    at = answer.coordinates.index("z")
    # a quarter is left of four: some ten eps of the entries
    assert answer.displacement[middle, at] == pytest.approx(float(z), rel=1e-13)


@pytest.mark.parametrize("options", [{}, {"elements": 6}, {"elements": 16, "element": "rigid"}])
def test_strain_energies_of_hanging_ropes_add_up(options):
    for scene in (hanging(25.0), beam(25.0, 40.0), hanging(25.0, rope=LAID)):
        modes = parabola(scene, **options).modes(4)
        strain = [v for name, v in modes.energy.items() if name not in modes.coordinates]
        # fractions of a sum; and the largest stretch of a string is two thirds
        np.testing.assert_allclose(sum(strain), 1, rtol=1e-12)
        assert 0.1 < modes.energy["stretch"].max() < 1
        np.testing.assert_array_equal(modes.energy["x"], 0)


def test_stretch_of_a_hanging_string_is_that_of_its_added_tension():
    # twice the energies: L_e h^2/EA and the integral of T z'^2; sums over the mode's own shape
    scene = hanging(10.0)
    modes = parabola(scene, elements=256, element="continuous").modes(1)
    z = modes.shape[0, :, modes.coordinates.index("z")]
    step = LENGTH / (len(z) - 1)
    area = step * (z[:-1] + z[1:]).sum() / 2
    stretch = float(exact_parameter(scene)) * TENSION / LENGTH**3 * area**2
    tension = TENSION * (np.diff(z) ** 2).sum() / step
    # trapezoidal and difference rules: pi^2/12 (1/256)^2 of each
    assert modes.energy["stretch"][0] == pytest.approx(stretch / (stretch + tension), rel=1e-4)


def test_mesh_error_of_a_hanging_chain_is_its_distance_to_the_spans():
    scene = beam(30.0, 50.0)
    modes = parabola(scene, elements=12).modes(3)
    true = parabola(scene).modes(3).frequency
    np.testing.assert_allclose(modes.mesh_error, np.abs(modes.frequency - true), rtol=1e-6)
    assert "tensed elements" in str(parabola(scene, tolerance=1e-5, below=true[2] * 1.01).choice)


# scenes ------------------------------------------------------------------------------------------


def test_gravity_takes_the_inertia_along_the_rope():
    sagging, straight = (parabola(s) for s in (beam(5.0, 9.0), beam(5.0, 9.0).without("sag")))
    at = sagging.coordinates.index("x")
    assert (sagging.chain.inertia[:, at] == 0).all()
    assert (straight.chain.inertia[:, at] == DENSITY).all()
    assert straight.chain.sag is None
    assert set(sagging.modes(12).family) == {"transverse"}


def test_rope_that_hangs_is_longer_than_its_chord():
    scene = hanging(10.0, axial=2e4)
    slope = DENSITY * scene.gravity.g * LENGTH / TENSION
    assert scene.gravity.lengthening(scene.rope, TENSION) == pytest.approx(1 + slope**2 / 8)
    assert scene.gravity.sag_parameter(scene.rope, TENSION) == pytest.approx(10.0)


def test_no_gravity_is_no_sag():
    scene = beam(30.0, 50.0)
    weightless = scene.replace(gravity=rd.Gravity(0.0)).compile().modes(3).frequency
    straight = scene.without("sag").compile().modes(3).frequency
    # another width of the same walk: its rounding
    np.testing.assert_allclose(weightless, straight, rtol=1e-14)


ROPE = rd.Rope(1.0, 0.1, bending_stiffness=1.0, axial_stiffness=1e4)
FREE = rd.End(x="free")
REFUSED = {
    "g": (lambda: rd.Gravity(math.nan), "g must be a finite number [m/s^2], got nan"),
    "inclination": (
        lambda: rd.Gravity(inclination=1.6),
        "inclination must lie between -pi/2 and pi/2 [rad], got 1.6",
    ),
    "no axial stiffness": (
        lambda: rd.Scene(rd.Rope(1.0, 0.1), tension=1.0, gravity=rd.Gravity()),
        "gravity needs axial_stiffness of the rope [N], got None",
    ),
    "no tension": (
        lambda: rd.Scene(ROPE, gravity=rd.Gravity()),
        "tension must be > 0 where there is gravity, got 0",
    ),
    "compression": (
        lambda: rd.Scene(ROPE, tension=-1.0, gravity=rd.Gravity()),
        "tension must be > 0 where there is gravity, got -1",
    ),
    "too heavy": (
        lambda: rd.Scene(ROPE, tension=1.0, gravity=rd.Gravity(1e200)),
        "gravity must be small enough for 1 + (w L/H)^2/8 to be a number, got g = 1e+200",
    ),
    "nothing holds x": (
        lambda: rd.Scene(ROPE, tension=1.0, gravity=rd.Gravity(), ends=(FREE, FREE)),
        "ends must hold x where there is gravity",
    ),
    "no sag parameter": (
        lambda: rd.Gravity().sag_parameter(rd.Rope(1.0, 0.1), 1.0),
        "axial_stiffness must be given for a sag parameter [N], got None",
    ),
}


@pytest.mark.parametrize("what", REFUSED)
def test_gravity_without_meaning_is_refused(what):
    make, message = REFUSED[what]
    with pytest.raises(rd.SceneError) as caught:
        make()
    assert str(caught.value).startswith(message)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: rd.Gravity("9.81"), "g must be a finite number"),
        (lambda: rd.Gravity(inclination=None), "inclination must be a finite number"),
        (lambda: rd.Scene(ROPE, tension=1.0, gravity=9.81), "gravity must be a Gravity or None"),
    ],
)
def test_gravity_of_a_wrong_type_is_refused(make, message):
    with pytest.raises(TypeError, match=message):
        make()


@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_hanging_string_has_no_matrix_of_stiffness_damping(element):
    rope = rd.Rope(100.0, 2.0, axial_stiffness=2e7)
    scene = rd.Scene(
        rope, tension=2e4, gravity=rd.Gravity(), damping=rd.StiffnessDamping(1e-3)
    ).compile(elements=8, element=element)
    with pytest.raises(rd.SceneError, match="damping must scale sections and tension alike"):
        scene.damping_matrix()
