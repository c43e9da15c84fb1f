"""Derivatives of frequency responses against closed forms and differences."""

import functools
import re

import mpmath
import numpy as np
import pytest
from conftest import EVERYTHING
from mpmath import mpc, mpf
from parabolas import parabola
from ridders import frf_difference

import ropedyn as rd

LENGTH, DENSITY, BENDING, TENSION = 1.3, 0.1, 2.0, 300.0
DRIVE, RESPONSE = 0.3, 0.9
EXACT = 1e-11
"""Relative to the largest: 1e-14 of the fields, times how much sharper resonances make them."""


def error(value, expected):
    """Return the largest error in units of the largest expected."""
    return np.abs(value - expected).max() / np.abs(expected).max()


# --- closed forms -----------------------------------------------------------------------------


def string(omega, T, mu, L, c=0):
    """Receptance of a held string with drag c: sin(k x) sin(k (L - y))/(T k sin(k L))."""
    k = mpmath.sqrt((omega**2 * mu - 1j * omega * c) / T)
    return mpmath.sin(k * DRIVE) * mpmath.sin(k * (L - RESPONSE)) / (T * k * mpmath.sin(k * L))


def pinned_beam(omega, T, B, mu, L, gamma=0):
    """The same of a beam: what a string has of its waves less what it has of their decay."""
    B = B * (1 + 1j * omega * gamma)
    h = T / (2 * B)
    r = mpmath.sqrt(h * h + mu * omega**2 / B)
    a, k = mpmath.sqrt(r + h), mpmath.sqrt(r - h)
    waves = mpmath.sin(k * DRIVE) * mpmath.sin(k * (L - RESPONSE)) / (k * mpmath.sin(k * L))
    decay = mpmath.sinh(a * DRIVE) * mpmath.sinh(a * (L - RESPONSE)) / (a * mpmath.sinh(a * L))
    return (waves - decay) / (B * (a * a + k * k))


def by(receptance, frequency, given, name):
    """Differentiate a receptance in 40 digits, shape (f,)."""
    with mpmath.workdps(40):
        given = {key: mpf(value) for key, value in given.items()}
        found = []
        for f in frequency:
            omega = 2 * mpmath.pi * mpf(f)

            def at(p, omega=omega):
                return mpc(receptance(omega, **(given | {name: p})))

            found.append(complex(mpmath.diff(at, given[name])))
    return np.array(found)


LINES = np.linspace(3.0, 250.0, 12)
MIDDLE = {"drive": ("z", LENGTH / 2)}
WHERE = {"drive": ("z", DRIVE), "response": ("z", RESPONSE)}


@pytest.mark.claim(
    "d(receptance)/dp of a damped string, p its tension, density, length and drag",
    reference="closed form differentiated in 40 digits",
    accepted=1e-12,
)
def test_string_response_changes_as_its_formula(claim):
    given = {"T": TENSION, "mu": DENSITY, "L": LENGTH, "c": 0.7}
    scene = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION, damping=rd.ViscousDamping(0.7))
    frf = scene.compile().frf(LINES, **WHERE)
    paths = {"T": "tension", "mu": "linear_density", "L": "length", "c": "damping.coefficient"}
    for name, path in paths.items():
        claim(error(frf.derivative(path)[0], by(string, LINES, given, name)))


@pytest.mark.claim(
    "d(receptance)/dp of a pinned beam, p its tension, bending stiffness, density, length, damping",
    reference="closed form differentiated in 40 digits",
    accepted=EXACT,
)
@pytest.mark.parametrize(
    ("tension", "bending"), [(300.0, 2.0), (0.0, 2.0), (-5.0, 2.0), (300.0, 1e-3), (300.0, 1e-6)]
)
def test_beam_response_changes_as_its_formula(tension, bending, claim):
    """Without tension, under compression, and with layers of L/500 and L/17000 at the ends."""
    given = {"T": tension, "B": bending, "mu": DENSITY, "L": LENGTH, "gamma": 1e-4}
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=bending)
    damping = rd.StiffnessDamping(1e-4)
    scene = rd.Scene(rope, tension=tension, ends=("pinned", "pinned"), damping=damping)
    lines = LINES + 1.7  # off the resonances that thin ropes hardly damp
    frf = scene.compile().frf(lines, **WHERE)
    paths = {
        "T": "tension",
        "B": "bending_stiffness",
        "mu": "linear_density",
        "L": "length",
        "gamma": "damping.gamma",
    }
    for name, path in paths.items():
        expected = by(pinned_beam, lines, given, name)
        # of a rope that hardly bends little depends on that: some 1e-16 of the whole is rounding
        size = np.abs(frf.value).max() / (given[name] or 1.0)
        off = np.abs(frf.derivative(path)[0] - expected).max()
        claim(off / max(np.abs(expected).max(), 1e-2 * size))


def test_waves_of_many_nodes_change_as_their_formula():
    given = {"T": TENSION, "mu": DENSITY, "L": LENGTH, "c": 0.7}
    scene = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION, damping=rd.ViscousDamping(0.7))
    lines = np.linspace(10e3, 30e3, 5)
    frf = scene.compile().frf(lines, **WHERE)
    assert error(frf.derivative("tension")[0], by(string, lines, given, "T")) < 1e-10


def test_static_receptance_has_derivatives():
    """L/4 T of a string at its middle, L^3/48 B of a pinned beam."""
    f = [0.0]
    held = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION).compile()
    frf = held.frf(f, drive=("z", LENGTH / 2))
    np.testing.assert_allclose(frf.derivative("tension"), [[-LENGTH / 4 / TENSION**2]], rtol=1e-13)
    assert frf.derivative("linear_density") == 0
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING)
    frf = rd.Scene(rope, ends=("pinned", "pinned")).compile().frf(f, drive=("z", LENGTH / 2))
    expected = -(LENGTH**3) / 48 / BENDING**2
    np.testing.assert_allclose(frf.derivative("bending_stiffness"), [[expected]], rtol=1e-13)


def test_opening_hinge_meets_its_first_stiffness():
    """Two pinned halves and a hinge of stiffness k at the middle: half a turn of either per N."""
    rope = rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING)
    scene = rd.Scene(
        rope, tension=TENSION, parts=[rd.Hinge(0.5)], damping=rd.StiffnessDamping(1e-4)
    )
    frf = scene.compile().frf(LINES, **WHERE)
    h = 1e-3
    stiffer = [
        scene.replace(parts=[rd.Hinge(0.5, stiffness=k)]).compile().frf(LINES, **WHERE).value
        for k in (h, 2 * h, 3 * h)
    ]
    quotient = (-11 * frf.value + 18 * stiffer[0] - 9 * stiffer[1] + 2 * stiffer[2]) / (6 * h)
    assert error(frf.derivative("parts[0].stiffness"), quotient) < 1e-9


# --- differences ------------------------------------------------------------------------------

QUOTIENT = 2e-9
"""Relative error of extrapolated differences."""

FULL = EVERYTHING.replace(
    damping=(
        rd.StiffnessDamping(1e-5),
        rd.RayleighDamping(2.0, 1e-5),
        rd.LossFactor(0.03),
        rd.ViscousDamping(0.5),
    ),
    parts=(
        *EVERYTHING.parts,
        rd.Dashpot(0.3, 0.7),
        rd.LocalChange(0.2, 0.5, bending=0.8, density=0.9),
        rd.AddedMass(0.45, 0.6, 0.05, polar_inertia=1e-7),
    ),
    ends=(
        rd.End(beta="free", spring={"beta": 5.0}, dashpot={"beta": 0.01}),
        rd.End(z="free", spring={"z": 2e3}, mass={"z": 0.01}),
    ),
)
HANGING = rd.Scene(
    rd.Rope(100.0, 2.0, axial_stiffness=2e7, bending_stiffness=1e4),
    tension=1e4,
    gravity=rd.Gravity(inclination=0.3, own_weight=False),
    damping=(rd.LossFactor(0.02), rd.RayleighDamping(0.1, 1e-3)),
    parts=[rd.LocalChange(30.0, 50.0, density=1.5)],
)


@functools.cache
def full():
    """The response of FULL."""
    points = [("z", 0.33), ("beta", 0.8), ("alpha", 1.0), ("x", 0.33)]
    return FULL.compile().frf([20.0, 77.0, 140.0], drive=[("z", 0.33), ("x", 1.2)], response=points)


@functools.cache
def hanging():
    """The response of HANGING."""
    return parabola(HANGING).frf([0.0, 0.6, 3.1], drive=("z", 33.0), response=[("z", 70.0)])


def paths_of(scene):
    """Every number of a scene that acts, but of parts at one place."""
    from ropedyn.response.frf_rate import FrequencyRates

    rates = FrequencyRates(scene.compile(), np.zeros(0), (), (), [], np.zeros((0, 0, 0)))
    return [path for path in rates.paths if path not in ("parts[2].x", "parts[3].x")]


@pytest.mark.parametrize("path", paths_of(FULL))
def test_derivative_is_what_differences_tend_to(path):
    frf = full()
    rates = frf.rates
    expected = frf_difference(rates.model, path, frf.frequency, frf.drive, frf.response)
    assert error(frf.derivative(path), expected) < QUOTIENT


@pytest.mark.parametrize("path", paths_of(HANGING))
def test_derivative_of_a_rope_that_hangs(path):
    frf = hanging()
    rates = frf.rates
    expected = frf_difference(rates.model, path, frf.frequency, frf.drive, frf.response)
    assert error(frf.derivative(path), expected[0]) < QUOTIENT


# --- chains, structures, forces, ends, tips -------------------------------------------------------

KINDS = {
    "continuous": {},
    "tensed": {"elements": 26},
    "rigid": {"elements": 26, "element": "rigid"},
}
CARRYING = FULL.replace(
    damping=FULL.damping[:2],
    parts=(
        rd.PointMass(0.25, 0.03),
        rd.Hinge(0.8, stiffness=5.0),
        rd.Resonator(0.35, 0.02, 60.0, damping_ratio=0.05),
        rd.BrokenWire(0.55, 0.1, 1e-3, radius=0.01, damping_ratio=0.01),
        rd.LocalChange(0.2, 0.5, bending=0.8, density=0.9),
    ),
)
HELD = rd.Scene(
    rd.Rope(LENGTH, DENSITY, bending_stiffness=BENDING),
    tension=TENSION,
    damping=rd.LossFactor(0.03),
    parts=[rd.PointMass(0.4, 0.05)],
)
MODAL = HELD.replace(damping=rd.ModalDamping(0.02))
ASKED = {
    "motion": (CARRYING, [("z", 0.25), ("alpha", 0.7)], [("z", 0.25), ("beta", 0.7)]),
    "forces": (CARRYING, [("z", 0.25)], [("F_z", 0.0), ("M_beta", 0.7), ("F_z", LENGTH)]),
    "tip": (CARRYING, [("z", 0.25)], [("wire", 0), ("z", 0.7)]),
    "end": (HELD, [("end", 0, "z"), ("z", 0.6)], [("z", 0.9), ("F_z", 0.0), ("M_beta", 0.9)]),
    "modal": (MODAL, [("z", 0.6)], [("z", 0.9), ("z", 0.6)]),
}


def check_against_differences(scene, kind, drive, response, every):
    """Every so many numbers of a scene, those apart at which a difference cannot be taken."""
    model = scene.compile(**KINDS[kind])
    frf = model.frf([20.0, 140.0], drive=drive, response=response)
    compared = 0
    for path in list(frf.rates.paths)[::every]:
        try:
            found = frf.derivative(path)
            expected = frf_difference(model, path, frf.frequency, frf.drive, frf.response)
        except rd.SceneError as refusal:
            assert re.search("must not be 0|must not stand", str(refusal))
            continue
        compared += 1
        if expected.any():
            assert error(found, expected) < 2 * QUOTIENT, path
        else:
            assert not found.any()
    return compared


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("what", ASKED)
def test_derivative_is_that_of_every_kind_of_question(what, kind):
    scene, drive, response = ASKED[what]
    every = 3 if scene is CARRYING else 1
    assert check_against_differences(scene, kind, drive, response, every) > 3


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("what", ASKED)
def test_derivative_is_that_of_every_number(what, kind):
    scene, drive, response = ASKED[what]
    assert check_against_differences(scene, kind, drive, response, 1) > 3


def test_modal_damping_changes_as_its_sum():
    """h = sum 2/(mu L) sin sin/(lambda_n - omega^2 + 2 i zeta omega omega_n)."""
    # 1e-11 of it is beyond 200 000 modes, 2e-10 what the response leaves out
    scene = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION, damping=rd.ModalDamping(0.02))
    f = np.array([11.0, 21.0, 47.0])
    frf = scene.compile().frf(f, **WHERE)
    omega, n = 2 * np.pi * f, np.arange(1, 200_001)[:, None]
    own = n * np.pi / LENGTH * np.sqrt(TENSION / DENSITY)
    pole = own**2 - omega**2 + 2j * 0.02 * omega * own
    weight = np.sin(n * np.pi * DRIVE / LENGTH) * np.sin(n * np.pi * RESPONSE / LENGTH)
    weight *= 2 / (DENSITY * LENGTH)
    by_own = -weight * (2 * own + 2j * 0.02 * omega) / pole**2
    assert error(frf.derivative("tension")[0], (by_own * own / (2 * TENSION)).sum(axis=0)) < 2e-9
    by_density = -weight / pole / DENSITY - by_own * own / (2 * DENSITY)
    assert error(frf.derivative("linear_density")[0], by_density.sum(axis=0)) < 2e-9
    by_ratio = -weight * 2j * omega * own / pole**2
    assert error(frf.derivative("damping.ratio")[0], by_ratio.sum(axis=0)) < 2e-9


# --- without a form of their own ----------------------------------------------------------------


def test_resonator_changes_as_its_dynamic_stiffness():
    """Where it stands h = 1/(1/g + D), so that dh/dp = -h^2 dD/dp."""
    m, f0, z = 0.02, 60.0, 0.05
    bare = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION, damping=rd.ViscousDamping(0.7))
    with_it = bare.replace(parts=[rd.Resonator(0.4, m, f0, damping_ratio=z)])
    frf = with_it.compile().frf(LINES, drive=("z", 0.4))

    def stiffness(omega, m, f0, z):
        own = 2 * mpmath.pi * f0
        spring = m * own**2 + 2j * omega * z * m * own
        return -(omega**2) * m * spring / (spring - omega**2 * m)

    given = {"m": m, "f0": f0, "z": z}
    for name, path in (("m", "mass"), ("f0", "frequency"), ("z", "damping_ratio")):
        expected = -(frf.value[0] ** 2) * by(stiffness, LINES, given, name)
        assert error(frf.derivative(f"parts[0].{path}")[0], expected) < QUOTIENT


def test_chain_of_elements_is_differentiated_as_it_is():
    """A string of two elements is half of its mass on two springs 2 T/L."""
    model = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION).compile(elements=2)
    f = np.array([0.0, 11.0])
    omega, mass = 2 * np.pi * f, DENSITY * LENGTH / 2
    h = 1 / (4 * TENSION / LENGTH - omega**2 * mass)
    frf = model.frf(f, drive=("z", LENGTH / 2))
    assert error(frf.derivative("tension")[0], -(h**2) * 4 / LENGTH) < QUOTIENT
    assert error(frf.derivative("linear_density")[0], h**2 * omega**2 * LENGTH / 2) < QUOTIENT


def test_modal_damping_and_moved_ends_have_derivatives():
    scene = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION, damping=rd.ModalDamping(0.02))
    frf = scene.compile().frf([11.0], **MIDDLE)
    h = 1e-5
    more, less = (
        scene.replace(damping=rd.ModalDamping(0.02 + off)).compile().frf([11.0], **MIDDLE).value
        for off in (h, -h)
    )
    assert error(frf.derivative("damping.ratio"), (more - less) / (2 * h)) < 1e-6
    moved = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION, damping=rd.ViscousDamping(0.7))
    frf = moved.compile().frf([11.0], drive=("end", 0, "z"), response=("z", RESPONSE))

    def transmitted(omega, T, mu, L, c):
        k = mpmath.sqrt((omega**2 * mu - 1j * omega * c) / T)
        return mpmath.sin(k * (L - RESPONSE)) / mpmath.sin(k * L)

    given = {"T": TENSION, "mu": DENSITY, "L": LENGTH, "c": 0.7}
    expected = by(transmitted, [11.0], given, "T")
    assert error(frf.derivative("tension")[0], expected) < QUOTIENT


# --- what is asked and how ----------------------------------------------------------------------


def test_derivative_is_of_the_quantity_and_shape_that_were_asked_for():
    scene = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION, damping=rd.ViscousDamping(0.7))
    model = scene.compile()
    points = [("z", 0.3), ("z", 0.9), ("z", 1.1)]
    one = model.frf(LINES, drive=points[0], response=points)
    many = model.frf(LINES, drive=points[:2], response=points, quantity="accelerance")
    assert one.derivative("tension").shape == one.value.shape
    assert many.derivative("tension").shape == many.value.shape
    omega = 2 * np.pi * LINES
    receptance = many.derivative("tension")[0] / -(omega**2)
    assert error(one.derivative("tension"), receptance) < 1e-14
    assert error(one.to("mobility").derivative("tension"), 1j * omega * receptance) < 1e-14


def test_what_is_not_driven_has_no_derivative():
    rope = rd.Rope(LENGTH, DENSITY, torsional_stiffness=1.0, polar_inertia=1e-6)
    frf = rd.Scene(rope, tension=TENSION).compile().frf([11.0], drive=("z", 0.3))
    assert (frf.derivative("torsional_stiffness") == 0).all()
    assert frf.derivative("tension").all()
    both = frf.rates.model.frf([11.0], drive=("z", 0.3), response=[("alpha", 0.2), ("z", 0.3)])
    np.testing.assert_array_equal(both.derivative("tension"), [[0], frf.derivative("tension")[0]])


def test_paths_and_places_are_checked(tmp_path):
    scene = rd.Scene(rd.Rope(LENGTH, DENSITY), tension=TENSION, parts=[rd.PointMass(0.3, 0.0)])
    frf = scene.compile().frf([11.0], drive=("z", 0.3))
    with pytest.raises(rd.SceneError, match="path must be a number that acts in this scene, one"):
        frf.derivative("bending_stiffness")
    with pytest.raises(TypeError, match='path must be a string such as "tension", got 3'):
        frf.derivative(3)
    with pytest.raises(rd.SceneError, match="must not stand where the scene changes, got"):
        frf.derivative("parts[0].x")
    rough = scene.compile(elements=4, element="rigid").frf([11.0], drive=("z", 0.9))
    with pytest.raises(rd.SceneError, match="must stand at nodes of 'rigid' elements for a deriv"):
        rough.derivative("tension")
    frf.save(tmp_path / "frf.nc")
    with pytest.raises(rd.SceneError, match="a response from a file or from motion over time has"):
        rd.load(tmp_path / "frf.nc").derivative("tension")


def test_tip_changes_with_the_place_that_its_wire_is_moved_to():
    """The root is the load of the response, and stands where the scene changes."""
    wire = rd.BrokenWire(LENGTH / 2, 0.1, 1e-3, radius=0.0, damping_ratio=0.01)
    model = HELD.replace(parts=[wire]).compile()
    frf = model.frf([20.0, 140.0], drive=("z", 0.25), response=("wire", 0))
    expected = frf_difference(model, "parts[0].x", frf.frequency, frf.drive, frf.response)
    assert error(frf.derivative("parts[0].x"), expected) < 2 * QUOTIENT
