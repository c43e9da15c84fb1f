"""Kinds of damping against closed forms, and what they have in common."""

import math

import mpmath
import numpy as np
import pytest
from conftest import EPS, LAID
from exact_chain import DIGITS, Exact, condition, omega_of, relative
from exact_span import Continuum, Law, coupled
from mpmath import mpf
from random_scene import WIDTHS, damped, frequency, random_scene

import ropedyn as rd

T, MU, L, B = 100.0, 0.1, 1.0, 2.0
STRING = rd.Rope(L, MU)
BEAM = rd.Rope(L, MU, bending_stiffness=B)
FREQUENCY = np.array([0.01, 3.0, 15.8, 47.3, 333.3])
KNOWN = 32 * EPS
"""Error over the condition of the answer: a few roundings along the walk; measured 3 eps."""
EVERY = {
    "stiffness": rd.StiffnessDamping(1e-4),
    "rayleigh": rd.RayleighDamping(2.0, 1e-5),
    "loss": rd.LossFactor(0.05),
    "viscous": rd.ViscousDamping(0.7),
}


def errors(model, drive, response, exact):
    """Errors over 1 + |d ln h/d ln omega|, each within its bound; `exact` of omega."""
    frf = model.frf(FREQUENCY, drive=drive, response=response)
    found = []
    with mpmath.workdps(50):
        for k, f in enumerate(FREQUENCY):
            omega, step = omega_of(f), mpf(10) ** -20
            h = exact(omega)
            error = relative(frf.value[0, k], h)
            assert error <= frf.rounding_error[0, k]
            found.append(error / float(1 + abs(exact(omega * (1 + step)) / h - 1) / step))
    return found


def beam_green(x, y, stiffness, q):
    """Deflection at x of a pinned beam per force at y >= x, B z'''' - T z'' - q z = force."""
    h = mpf(T) / (2 * stiffness)
    r = mpmath.sqrt(h * h + q / stiffness)
    a, k = mpmath.sqrt(r + h), mpmath.sqrt(q / (stiffness * (r + h)))
    x, y = mpf(x), mpf(y)
    wave = mpmath.sin(k * x) * mpmath.sin(k * (L - y)) / (k * mpmath.sin(k * L))
    near = mpmath.sinh(a * x) * mpmath.sinh(a * (L - y)) / (a * mpmath.sinh(a * L))
    return (wave - near) / (stiffness * (k * k + a * a))


# viscous damping ---------------------------------------------------------------------------------


@pytest.mark.parametrize("coefficient", [1e-6, 0.7, 1e3])
@pytest.mark.parametrize("elements", [None, 10, 1000])
def test_string_in_a_viscous_fluid_responds_as_its_wave(elements, coefficient):
    # h = sin(k x) sin(k (L - y))/(T k sin k L), T k^2 = mu omega^2 - i omega c;
    # lumped: 4 T sin^2(theta/2) = l^2 of the same, and T k becomes T sin(theta)/l
    scene = rd.Scene(STRING, tension=T, damping=rd.ViscousDamping(coefficient))

    def exact(omega):
        q = mpf(MU) * omega**2 - 1j * omega * mpf(coefficient)
        k = mpmath.sqrt(q / mpf(T))
        pull = mpf(T) * k
        if elements:
            part = mpf(L) / elements
            theta = 2 * mpmath.asin(k * part / 2)
            k, pull = theta / part, mpf(T) * mpmath.sin(theta) / part
        x, y = (mpf(2) / 10, mpf(7) / 10) if elements else (mpf(0.2), mpf(0.7))
        return mpmath.sin(k * x) * mpmath.sin(k * (1 - y)) / (pull * mpmath.sin(k))

    assert max(errors(scene.compile(elements=elements), ("z", 0.7), ("z", 0.2), exact)) <= KNOWN


@pytest.mark.parametrize("coefficient", [1e-6, 0.7, 1e3])
def test_pinned_beam_in_a_viscous_fluid_responds_as_its_waves(coefficient):
    ends = ("pinned", "pinned")
    scene = rd.Scene(BEAM, tension=T, ends=ends, damping=rd.ViscousDamping(coefficient))

    def exact(omega):
        return beam_green(0.25, 0.75, mpf(B), mpf(MU) * omega**2 - 1j * omega * mpf(coefficient))

    assert max(errors(scene.compile(), ("z", 0.75), ("z", 0.25), exact)) <= KNOWN


def test_viscous_damping_acts_on_transverse_and_axial_motion_alone():
    model = rd.Scene(LAID, tension=T, damping=rd.ViscousDamping(0.7)).compile(elements=4)
    damping = model.damping_matrix().toarray().diagonal().reshape(3, 4)
    # x, z, alpha, beta of three nodes, a quarter of the rope each
    np.testing.assert_array_equal(damping, np.tile([0.7 / 4, 0.7 / 4, 0.0, 0.0], (3, 1)))
    np.testing.assert_array_equal(model.scene.compile().chain.drag, [[0.7, 0.7, 0.0, 0.0]])


# loss factor -------------------------------------------------------------------------------------


@pytest.mark.parametrize("eta", [1e-6, 0.05, 1.0])
def test_pinned_beam_with_a_loss_factor_has_a_complex_bending_stiffness(eta):
    scene = rd.Scene(BEAM, tension=T, ends=("pinned", "pinned"), damping=rd.LossFactor(eta))

    def exact(omega):
        return beam_green(0.25, 0.75, mpf(B) * (1 + 1j * mpf(eta)), mpf(MU) * omega**2)

    assert max(errors(scene.compile(), ("z", 0.75), ("z", 0.25), exact)) <= KNOWN


@pytest.mark.parametrize("solver", ["sweep", "lapack", "band"])
def test_loss_factor_divides_the_static_response_of_sections_and_springs(solver):
    parts = [rd.Spring(0.5, 300.0), rd.Hinge(0.25, stiffness=3.0)]
    scene = rd.Scene(BEAM, ends=("pinned", "clamped"), parts=parts)
    points = [("z", 0.3), ("beta", 1 / 3)]
    plain, lossy = (
        one.compile(elements=12).frf(0.0, drive=points, response=points, solver=solver)
        for one in (scene, scene.replace(damping=rd.LossFactor(0.3)))
    )
    # static: the condition of 12 assembled elements, 50 (12/pi)^4 eps = 2e-12, is the largest
    np.testing.assert_allclose(lossy.value * (1 + 0.3j), plain.value, rtol=1e-11)


def test_loss_factor_of_a_string_is_none():
    scene = rd.Scene(STRING, tension=T)
    plain, lossy = (
        one.compile().frf(FREQUENCY, drive=("z", 0.3))
        for one in (scene, scene.replace(damping=rd.LossFactor(0.3)))
    )
    np.testing.assert_array_equal(plain.value, lossy.value)


# what all have in common -------------------------------------------------------------------------


def rich():
    """A scene with every damping that can act with others, and dashpots of every place."""
    end = rd.End(
        x="free", z="free", alpha="free", beta="free", spring={"z": 900.0}, dashpot={"z": 0.4}
    )
    parts = [
        rd.Dashpot(0.3, 2.0),
        rd.Dashpot(0.3, 1e-3, coordinate="alpha"),
        rd.PointMass(0.6, 0.05),
        rd.Spring(0.6, 400.0),
    ]
    return rd.Scene(
        LAID, tension=40.0, ends=("clamped", end), parts=parts, damping=tuple(EVERY.values())
    )


@pytest.mark.parametrize("element", ["rigid", "tensed"])
def test_solvers_agree_on_every_damping_at_once(element):
    model = rich().compile(elements=10, element=element)
    points = [("z", 0.3), ("alpha", 0.5), ("x", 0.9), ("beta", 1.0)]
    sweep, *others = (
        model.frf(FREQUENCY, drive=points, response=points, solver=s)
        for s in ("sweep", "band", "lapack")
    )
    for other in others:
        allowed = (sweep.rounding_error + other.rounding_error) * np.abs(sweep.value)
        assert (np.abs(sweep.value - other.value) <= allowed).all()


@pytest.mark.parametrize("f", [3.0, 31.0, 170.0])
def test_power_that_goes_in_is_what_the_dampings_dissipate(f):
    # u^H Im(D) u omega/2 of each damping alone, and -omega Im(h)/2 of the unit force
    scene, omega = rich(), 2 * np.pi * f
    model = scene.compile(elements=10, element="rigid")
    drive = ("z", 0.6)
    points = [(c, float(x)) for x in model.x for c in model.coordinates]
    frf = model.frf(f, drive=drive, response=points)
    u = frf.value[(model.chain.held[model.chain.term_of] == 0).ravel(), 0]

    def power(scene):
        C = scene.compile(elements=10, element="rigid").damping_matrix().toarray()
        return omega**2 / 2 * (u.conj() @ C @ u).real

    bare = scene.without(*(d.kind for d in scene.dampings), "dashpot")
    bare = bare.replace(parts=[*bare.parts, rd.PointMass(0.3, 0.0)])  # the same nodes
    constant = ("stiffness", "rayleigh", "viscous")
    dissipated = {name: power(bare.replace(damping=EVERY[name])) for name in constant}
    dissipated["dashpots"] = power(scene.replace(damping=None))
    # eta K = (eta/omega) of the matrix of unit stiffness damping, per i omega
    elastic = bare.replace(damping=rd.StiffnessDamping(1.0))
    dissipated["loss"] = power(elastic) * EVERY["loss"].eta / omega
    assert min(dissipated.values()) > 0
    value = frf.value[points.index(("z", float(model.x[6]))), 0]
    # u^H C u adds numbers of one sign; Im(h) is a tenth of h at least
    assert sum(dissipated.values()) == pytest.approx(-omega / 2 * value.imag, rel=1e-11)


@pytest.mark.parametrize("elements", [None, 10])
def test_frequencies_and_shapes_do_not_know_of_damping(elements):
    scene = rich()
    plain = scene.without(*(d.kind for d in scene.dampings), "dashpot")
    plain = plain.replace(parts=[*plain.parts, rd.PointMass(0.3, 0.0)])  # the same nodes
    one, other = (s.compile(elements=elements) for s in (scene, plain))
    assert one.count(below=300.0) == other.count(below=300.0)
    one, other = one.modes(6), other.modes(6)
    assert (one.damping_ratio > 0).all()
    assert (other.damping_ratio == 0).all()
    for name in ("frequency", "eigenvalue", "rounding_error", "shape", "modal_mass"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))
    load = {("z", 0.4): 3.0}
    one, other = (s.compile(elements=elements).static(load) for s in (scene, plain))
    np.testing.assert_array_equal(one.displacement, other.displacement)


@pytest.mark.parametrize("kind", [rd.LossFactor, rd.ModalDamping])
def test_damping_that_is_not_in_proportion_to_velocity_has_no_matrix(kind):
    scene = rd.Scene(BEAM, damping=(rd.StiffnessDamping(1e-4), kind(0.05)))
    with pytest.raises(rd.SceneError, match=rf"damping must be .* got {kind.__name__}\("):
        scene.compile(elements=4).damping_matrix()
    zero = scene.replace(damping=(rd.StiffnessDamping(1e-4), kind(0.0))).compile(elements=4)
    assert zero.damping_matrix().nnz > 0


# damping ratios ----------------------------------------------------------------------------------


@pytest.mark.parametrize("elements", [None, 64])
def test_damping_ratio_of_a_string_in_a_viscous_fluid(elements):
    # every mode loses c/mu: zeta = c/(2 mu omega)
    modes = rd.Scene(STRING, tension=T, damping=rd.ViscousDamping(0.7)).compile(elements=elements)
    modes = modes.modes(5)
    exact = 0.7 / (2 * MU * 2 * np.pi * modes.frequency)
    np.testing.assert_allclose(modes.damping_ratio, exact, rtol=64 * EPS)


def test_drag_does_not_act_on_masses():
    # z = sin(k x) to the mass M in the middle: zeta = c I/(2 omega (mu I + M z^2)), I = int z^2
    M = 0.3
    scene = rd.Scene(STRING, tension=T, parts=[rd.PointMass(0.5, M)])
    modes = scene.replace(damping=rd.ViscousDamping(0.7)).compile().modes(3)
    omega = 2 * np.pi * modes.frequency[::2]
    k = omega * math.sqrt(MU / T)
    inside, top = 0.5 - np.sin(k) / (2 * k), np.sin(k / 2) ** 2
    exact = 0.7 * inside / (2 * omega * (MU * inside + M * top))
    # sin(k) loses as 1/k at most, k > 1
    np.testing.assert_allclose(modes.damping_ratio[::2], exact, rtol=256 * EPS)


@pytest.mark.parametrize("elements", [None, 16])
def test_damping_ratio_of_a_loss_factor_is_half_of_it(elements):
    scene = rd.Scene(BEAM, ends=("pinned", "clamped"), damping=rd.LossFactor(0.04))
    ratio = scene.compile(elements=elements).modes(4).damping_ratio
    # elastic over kinetic energy, whose shapes have 1e-12 with 16 elements
    np.testing.assert_allclose(ratio, 0.02, rtol=1e-10)


def test_damping_ratios_of_modes_are_those_that_were_given():
    model = rd.Scene(BEAM, tension=T, damping=rd.ModalDamping([0.01, 0.0, 0.03])).compile()
    np.testing.assert_array_equal(model.modes(4).damping_ratio, [0.01, 0.0, 0.03, math.nan])
    scene = model.scene.replace(damping=rd.ModalDamping(0.02), ends=("free", "free"))
    # rigid motion is not damped
    np.testing.assert_array_equal(scene.compile().modes(4).damping_ratio, [0.0, 0.02, 0.02, 0.02])


def test_damping_ratios_add_up():
    scene = rich()
    whole = scene.compile().modes(4).damping_ratio
    kinds = {d.kind for d in scene.dampings} | {"dashpot"}
    bare = scene.replace(parts=[*scene.parts, rd.PointMass(0.3, 0.0)])
    each = [bare.without(*(kinds - {kind})).compile().modes(4).damping_ratio for kind in kinds]
    np.testing.assert_allclose(sum(each), whole, rtol=64 * EPS)


# random scenes -----------------------------------------------------------------------------------

SEEDS = range(60)
MOST_WAVES = 60
"""Wavenumbers times length that the reference takes a moment for."""


def random_damped(seed):
    """A scene, a frequency, a drive and a response."""
    random = np.random.default_rng(seed)
    width = int(random.choice(list(WIDTHS), p=[0.3, 0.4, 0.15, 0.15]))
    scene = damped(random, random_scene(random, width))
    places = [*random.uniform(0.0, 1.0, 2).tolist(), 0.0, 1.0, *(p.x for p in scene.parts)]
    drive, response = (
        (str(random.choice(WIDTHS[width])), float(random.choice(places))) for _ in range(2)
    )
    return random, scene, frequency(random, scene) or 1.0, drive, response


@pytest.mark.parametrize("seed", SEEDS)
def test_sweep_and_band_agree_on_random_damped_chains(seed):
    random, scene, f, drive, response = random_damped(seed)
    elements = len({p.x for p in scene.parts}) + 1 + int(random.integers(0, 40))
    model = scene.compile(elements=elements, element=str(random.choice(["rigid", "tensed"])))
    sweep, band = (
        model.frf(f, drive=drive, response=response, solver=s) for s in ("sweep", "band")
    )
    allowed = (sweep.rounding_error + band.rounding_error) * np.abs(sweep.value)
    assert (np.abs(sweep.value - band.value) <= allowed).all() or (sweep.value == band.value).all()


@pytest.mark.claim(
    f"FRF of {len(SEEDS)} random damped ropes of continuous spans, dashpots and drag among them: "
    "share beyond rounding_error",
    reference="mpmath, 60 digits: tests/support/exact_span.py",
    accepted=0.0,
)
def test_random_damped_spans_respond_as_the_continuum(claim):
    beyond = []
    for seed in SEEDS:
        _, scene, f, drive, response = random_damped(seed)
        c = coupled(scene, drive[0])
        if response[0] not in c:
            continue
        with mpmath.workdps(DIGITS):
            omega = omega_of(f)
            law = Law(scene, c, 1, 1, -(omega**2), 1j * omega)
            if law.wavenumber * scene.rope.length > MOST_WAVES:
                continue
            (h,) = Continuum(scene, c).receptance(omega, drive, [response])
            frf = scene.compile().frf(f, drive=drive, response=response)
            beyond.append(relative(frf.value[0, 0], h) > frf.rounding_error[0, 0])
    assert len(beyond) >= len(SEEDS) / 2
    claim(np.mean(beyond))


@pytest.mark.parametrize("seed", SEEDS[:12])
def test_random_damped_chains_respond_as_their_exact_matrices(seed):
    random, scene, f, drive, _ = random_damped(seed)
    elements = len({p.x for p in scene.parts}) + 1 + int(random.integers(0, 8))
    model = scene.compile(elements=elements, element="rigid")
    node = int(random.integers(0, len(model.x)))
    frf = model.frf(f, drive=(drive[0], float(model.x[node])))
    with mpmath.workdps(DIGITS):
        exact, at = Exact(model, model.component_of(drive[0])), (drive[0], node)
        (h,) = exact.receptance(omega_of(f), at, [at])
        error = relative(frf.value[0, 0], h)
        assert error <= frf.rounding_error[0, 0]
        assert error <= 16 * EPS or error <= KNOWN * condition(exact, omega_of(f), at, at)
